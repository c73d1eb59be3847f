//! Forces between grains from dumps of contacts. A row has two ids and a force. The names of the columns depend on the
//! program.

use std::collections::{BTreeMap, BTreeSet};

use grainbench_scene::scene::{ProbeTarget, Scene};
use nalgebra::Vector3;

use crate::names::Names;
use crate::read::digits::Digits;
use crate::read::number_table::quoted_names;
use crate::read::read_error::ReadError;
use crate::read::snapshot::DumpSnapshot;

/// Force on the first of two grains (N), and the sum of the uncertainties of its components due to printed digits (N).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct PairForce {
    pub(crate) force: Vector3<f64>,
    pub(crate) open: f64,
}

/// Forces of the contacts that the probes of a scene request. Other contacts are skipped, so that the required memory
/// does not grow with their number.
///
/// The columns are `id1`, `id2`, and `force_x`, `force_y` and `force_z` for the force on the first grain. Columns such
/// as `tangential_x` are added to the force, because some programs print its normal and tangential part separately.
#[derive(Debug, Clone, Default)]
pub(crate) struct PairForces {
    /// Requested pairs of ids, the smaller id first.
    asked: BTreeSet<(u64, u64)>,
    /// Force on the grain with the smaller id, by step and pair.
    by_step: BTreeMap<u64, BTreeMap<(u64, u64), PairForce>>,
}

/// Our names for the columns of the force.
const FORCE: [&str; 3] = ["force_x", "force_y", "force_z"];
/// Our names for the columns of a separate tangential force.
const TANGENTIAL: [&str; 3] = ["tangential_x", "tangential_y", "tangential_z"];

/// Columns of the contact dumps that our decks write: those of LAMMPS, with separate normal and tangential forces, and
/// those of LIGGGHTS, whose column 3 is a flag for pairs across a periodic boundary.
const OF_DECKS: [&str; 2] = [
    "c_pairs[1] c_pairs[2] c_forces[1] c_forces[2] c_forces[3] c_forces[4] c_forces[5] c_forces[6]",
    "c_pairs[1] c_pairs[2] c_pairs[4] c_pairs[5] c_pairs[6]",
];

/// Indices of columns in a dump of contacts: ids of two grains, and parts of the force on the first grain.
pub(crate) struct PairColumns {
    pub(crate) ids: [usize; 2],
    pub(crate) parts: [[Option<usize>; 3]; 2],
}

impl PairColumns {
    pub(crate) fn find(file: &str, snapshot: &DumpSnapshot, names: &Names) -> Result<Self, ReadError> {
        if let Some(columns) = Self::of_deck(snapshot, names) {
            return Ok(columns);
        }
        let column = |name: &str| snapshot.column(names.in_file(name));
        let missing = |what: &str| {
            let expected = format!("columns {what} of contacts (`--map id1=…,id2=…,force_x=…` names them)");
            ReadError::at(file, snapshot.first_line.saturating_sub(1), expected, quoted_names(&snapshot.columns))
        };
        let (Some(first), Some(second)) = (column("id1"), column("id2")) else {
            return Err(missing("`id1` and `id2`"));
        };
        let force = FORCE.map(column);
        if force[0].is_none() || force[1].is_none() {
            return Err(missing("`force_x` and `force_y`"));
        }
        Ok(Self { ids: [first, second], parts: [force, TANGENTIAL.map(column)] })
    }

    /// Returns the columns of a dump that one of our decks wrote, unless the ids have other names.
    fn of_deck(snapshot: &DumpSnapshot, names: &Names) -> Option<Self> {
        let has_names = names.in_file("id1") != "id1" || names.in_file("force_x") != "force_x";
        let columns = snapshot.columns.iter().map(|column| column.name.as_str());
        let is_of_deck = !has_names && OF_DECKS.iter().any(|deck| deck.split(' ').eq(columns.clone()));
        let count = snapshot.columns.len();
        let part = |first: usize| [0, 1, 2].map(|axis| Some(first + axis).filter(|&at| at < count));
        is_of_deck.then(|| Self { ids: [0, 1], parts: [part(2), part(5)] })
    }
}

impl PairForces {
    /// Returns an empty collection for the pairs that the probes of a scene request. `ids` are the ids of its grains in
    /// the dump, in the order of the scene.
    pub(crate) fn new(scene: &Scene, ids: &[u64]) -> Self {
        let asked = scene.probes.iter().filter_map(|probe| match probe.target {
            ProbeTarget::Pair(a, b) => {
                let (a, b) = (*ids.get(a)?, *ids.get(b)?);
                Some((a.min(b), a.max(b)))
            }
            _ => None,
        });
        Self { asked: asked.collect(), by_step: BTreeMap::new() }
    }

    /// Returns true if no step has been added.
    pub(crate) fn is_empty(&self) -> bool {
        self.by_step.is_empty()
    }

    pub(crate) fn is_asked(&self) -> bool {
        !self.asked.is_empty()
    }

    /// Returns true if a step has been added.
    pub(crate) fn has(&self, step: u64) -> bool {
        self.by_step.contains_key(&step)
    }

    /// Adds the contacts of a step.
    pub(crate) fn take(
        &mut self,
        file: &str,
        snapshot: &DumpSnapshot,
        names: &Names,
        digits: Option<&[Digits]>,
    ) -> Result<(), ReadError> {
        let columns = PairColumns::find(file, snapshot, names)?;
        let of_file = digits.map(Digits::all);
        let forces = self.by_step.entry(snapshot.step).or_default();
        for at in 0..snapshot.rows() {
            let row = snapshot.row(at);
            let [a, b] = columns.ids.map(|id| row[id] as u64);
            let pair = (a.min(b), a.max(b));
            if !self.asked.contains(&pair) {
                continue;
            }
            let mut found = PairForce::default();
            for part in &columns.parts {
                for (axis, column) in part.iter().enumerate() {
                    let Some(column) = *column else { continue };
                    let value = row[column];
                    found.force[axis] += if a < b { value } else { -value };
                    if let (Some(digits), Some(of_file)) = (digits, &of_file) {
                        found.open += digits.get(column).map_or(0.0, |digits| digits.uncertainty(value, of_file));
                    }
                }
            }
            // A dump may contain a contact twice, once from each grain.
            forces.insert(pair, found);
        }
        Ok(())
    }

    /// Returns the force of grain `b` on grain `a` at a step. The force is zero if the dump does not list the pair.
    /// Returns `None` if the dump does not contain the step.
    pub(crate) fn on(&self, step: u64, a: u64, b: u64) -> Option<PairForce> {
        let found = self.by_step.get(&step)?.get(&(a.min(b), a.max(b))).copied().unwrap_or_default();
        Some(if a < b { found } else { PairForce { force: -found.force, ..found } })
    }
}
