//! Final state of a run, from which another scene can start. It contains the grains with their velocities and spins,
//! and the contact history. A LAMMPS data file does not contain this history, although a heap is stable only with its
//! friction springs.

use crate::grain::Grain;
use serde::{Deserialize, Serialize};

/// Final state of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EndState {
    /// Title of the scene, and name of the solver.
    pub of: [String; 2],
    /// Number of dimensions.
    pub dimension: usize,
    /// Time of the state (s).
    pub time: f64,
    /// Names of the materials of grains.
    pub materials: Vec<String>,
    /// Grains, in order of id. Their materials are indices in [`EndState::materials`].
    pub grains: Vec<Grain>,
    /// Contact history.
    pub springs: Springs,
}

/// Contact history in the layout of a solver.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Springs {
    /// Text that identifies the layout of the history values of a contact.
    pub layout: String,
    /// Contacts between grains: the indices of the two grains, and the history values with the sign for the first
    /// grain.
    pub pairs: Vec<(u32, u32, Vec<f64>)>,
    /// Contacts with walls: the index of the grain, the name of the wall, and the history values.
    pub walls: Vec<(u32, String, Vec<f64>)>,
}

impl Springs {
    /// Returns all data of the history as bytes, contact by contact.
    #[must_use]
    pub fn bits(&self) -> Vec<u8> {
        let Self { layout, pairs, walls } = self;
        let mut bits = [layout.as_bytes(), &pairs.len().to_le_bytes()].concat();
        let mut add = |who: &[&[u8]], numbers: &[f64]| {
            who.iter().for_each(|part| bits.extend_from_slice(part));
            bits.extend(numbers.len().to_le_bytes());
            bits.extend(numbers.iter().copied().flat_map(f64::to_le_bytes));
        };
        for (first, second, numbers) in pairs {
            add(&[&first.to_le_bytes(), &second.to_le_bytes()], numbers);
        }
        for (grain, wall, numbers) in walls {
            add(&[&grain.to_le_bytes(), &wall.len().to_le_bytes(), wall.as_bytes()], numbers);
        }
        bits
    }

    /// Returns the history with every grain index increased by `places`.
    #[must_use]
    pub fn later_by(mut self, places: u32) -> Self {
        for (first, second, _) in &mut self.pairs {
            (*first, *second) = (*first + places, *second + places);
        }
        self.walls.iter_mut().for_each(|(grain, ..)| *grain += places);
        self
    }
}
