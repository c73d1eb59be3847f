//! Optional columns of snapshots, and the number of digits in snapshots.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Optional column of a snapshot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Chosen {
    /// Angular velocity of every grain; in two dimensions also its angle.
    Spin,
    /// Sum of the forces (without gravity) and sum of the torques on every grain.
    Force,
    /// All contacts.
    Contacts,
    /// Product V σ of volume and mean stress of every grain (J) at the time of the snapshot.
    Virial,
    /// Product V σ of every grain (J), averaged over the time since the previous snapshot.
    MeanVirial,
}

/// Contents of the snapshots of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// Columns in addition to id, material, radius, mass, position and velocity.
    pub chosen: Vec<Chosen>,
    /// Significant digits of grain and contact data; all digits if absent. Radius and mass keep all digits.
    pub digits: Option<u8>,
    /// Steps between the samples of a time average.
    pub mean_every: u64,
}

impl Default for Columns {
    fn default() -> Self {
        Self { chosen: Self::USUAL.to_vec(), digits: None, mean_every: 1 }
    }
}

impl Columns {
    /// Columns of a scene that chooses none.
    pub const USUAL: [Chosen; 3] = [Chosen::Spin, Chosen::Force, Chosen::Contacts];

    /// Returns true if a column is chosen.
    #[must_use]
    pub fn has(&self, column: Chosen) -> bool {
        self.chosen.contains(&column)
    }
}
