//! Forces between grains from dumps of local entries: rows of two ids and a force, whatever a program calls the
//! columns.

use std::collections::{BTreeMap, BTreeSet};

use grainbench_scene::scene::{ProbeTarget, Scene};
use nalgebra::Vector3;

use crate::observer::Names;
use crate::read::digits::Digits;
use crate::read::read_error::{ReadError, quoted};
use crate::read::snapshot::DumpSnapshot;

/// A force on the first of two grains (N), and how far the printed digits may have moved any of its components.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct PairForce {
    pub(crate) force: Vector3<f64>,
    pub(crate) open: f64,
}

/// What entries tell of the contacts that the probes of a scene ask for; all others are passed over, so that memory
/// does not grow with their number.
///
/// Their columns are `id1`, `id2` and the force on the first, `force_x`, `force_y`, `force_z`; what is called
/// `tangential_x` and so on is added to it, for some programs print the two parts apart.
#[derive(Debug, Clone, Default)]
pub(crate) struct PairForces {
    /// The pairs that are asked for, by id, the smaller one first.
    asked: BTreeSet<(u64, u64)>,
    /// By step and pair; on the smaller id.
    by_step: BTreeMap<u64, BTreeMap<(u64, u64), PairForce>>,
}

/// Names of the components of the force, and of the part that may stand apart.
const FORCE: [&str; 3] = ["force_x", "force_y", "force_z"];
const TANGENTIAL: [&str; 3] = ["tangential_x", "tangential_y", "tangential_z"];

/// Where a dump of contacts has the ids of two grains, and the parts of the force on the first.
pub(crate) struct PairColumns {
    pub(crate) ids: [usize; 2],
    pub(crate) parts: [[Option<usize>; 3]; 2],
}

impl PairColumns {
    pub(crate) fn find(file: &str, snapshot: &DumpSnapshot, names: &Names) -> Result<Self, ReadError> {
        let column = |name: &str| snapshot.column(names.of(name));
        let missing = |what: &str| {
            let have: Vec<&str> = snapshot.columns.iter().map(|column| column.name.as_str()).collect();
            let expected = format!("columns {what} of contacts (`--map id1=…,id2=…,force_x=…` names them)");
            ReadError::at(file, snapshot.first_line.saturating_sub(1), expected, quoted(&have.join(" ")))
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
}

impl PairForces {
    /// Those of a scene whose grains have these ids in the dump, in the order of the scene.
    pub(crate) fn of(scene: &Scene, ids: &[u64]) -> Self {
        let asked = scene.probes.iter().filter_map(|probe| match probe.target {
            ProbeTarget::Pair(a, b) => {
                let (a, b) = (*ids.get(a)?, *ids.get(b)?);
                Some((a.min(b), a.max(b)))
            }
            _ => None,
        });
        Self { asked: asked.collect(), by_step: BTreeMap::new() }
    }

    /// Whether no step has been taken.
    pub(crate) fn is_empty(&self) -> bool {
        self.by_step.is_empty()
    }

    /// Whether any pair is asked for.
    pub(crate) fn is_asked(&self) -> bool {
        !self.asked.is_empty()
    }

    /// Whether a step has been taken.
    pub(crate) fn has(&self, step: u64) -> bool {
        self.by_step.contains_key(&step)
    }

    /// Takes the entries of a step.
    pub(crate) fn take(
        &mut self,
        file: &str,
        snapshot: &DumpSnapshot,
        names: &Names,
        digits: Option<&[Digits]>,
    ) -> Result<(), ReadError> {
        let columns = PairColumns::find(file, snapshot, names)?;
        let of_file = digits.map(|digits| digits.iter().fold(Digits::default(), |all, digits| all.with(digits)));
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
            // A list may have a pair twice, once from either side: that is one contact.
            forces.insert(pair, found);
        }
        Ok(())
    }

    /// The force of grain `b` on grain `a` at a step, nothing where they are not listed; none where the step is not.
    pub(crate) fn on(&self, step: u64, a: u64, b: u64) -> Option<PairForce> {
        let found = self.by_step.get(&step)?.get(&(a.min(b), a.max(b))).copied().unwrap_or_default();
        Some(if a < b { found } else { PairForce { force: -found.force, ..found } })
    }
}
