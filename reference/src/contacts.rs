//! Contacts from dumps, and the contacts that the probes of a scene request. A row of a dump of contacts has two ids and a
//! force. The names of the columns depend on the program.

use std::collections::{BTreeMap, BTreeSet};

use grainbench_scene::overlap::{nearest_on_rectangle, nearest_on_round, nearest_on_segment};
use grainbench_scene::scene::{Domain, ProbeTarget, Scene, WallShape};
use grainbench_solver::record::{ContactState, GrainState, Partner, Snapshot};
use nalgebra::Vector3;

use crate::names::Names;
use crate::read::digits::Digits;
use crate::read::format::dump::DumpReader;
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
            let help = "(`--map id1=…,id2=…,force_x=…` names them)";
            Err(snapshot.missing(file, format!("columns {what} of contacts {help}")))
        };
        let (Some(first), Some(second)) = (column("id1"), column("id2")) else {
            return missing("`id1` and `id2`");
        };
        let force = FORCE.map(column);
        if force[0].is_none() || force[1].is_none() {
            return missing("`force_x` and `force_y`");
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

/// Returns the contacts between the grains of a snapshot from a dump of contacts. `entries` holds the last step that
/// has been read from this dump.
pub(crate) fn contacts_of(
    snapshot: &Snapshot,
    reader: &mut DumpReader,
    entries: &mut DumpSnapshot,
    file: &str,
    names: &Names,
) -> Result<Vec<ContactState>, ReadError> {
    let step = snapshot.step;
    // The dump of contacts may have more steps than the dump of grains.
    while entries.columns.is_empty() || entries.step < step {
        if !reader.read(entries)? {
            return Err(entries.error(file, 0, format!("the contacts of step {step}"), "the end of the file"));
        }
    }
    if entries.step != step {
        let found = format!("those of step {}", entries.step);
        return Err(entries.error(file, 0, format!("the contacts of step {step}"), found));
    }
    let PairColumns { ids: [first, second], parts } = PairColumns::find(file, entries, names)?;
    let place: BTreeMap<u32, usize> = snapshot.grains.iter().enumerate().map(|(at, grain)| (grain.id, at)).collect();
    let (mut contacts, mut seen) = (Vec::new(), BTreeSet::new());
    for row in 0..entries.rows() {
        let numbers = entries.row(row);
        let find = |at: usize| {
            let known = place.get(&(numbers[at] as u32)).copied();
            let expected = || format!("the id of a grain of step {step}");
            known.ok_or_else(|| entries.error(file, row, expected(), numbers[at].to_string()))
        };
        let (one, other) = (find(first)?, find(second)?);
        // A dump may contain a contact twice, once from each grain.
        if one == other || !seen.insert((one.min(other), one.max(other))) {
            continue;
        }
        let mut force = Vector3::zeros();
        for part in &parts {
            for (axis, column) in part.iter().enumerate() {
                force[axis] += column.map_or(0.0, |column| numbers[column]);
            }
        }
        let (GrainState { id, position, radius, .. }, other) = (&snapshot.grains[one], &snapshot.grains[other]);
        let (low, high) = snapshot.bounds;
        let between = nearest_image(other.position - position, low, high, snapshot.periodic);
        let normal = between.try_normalize(0.0).unwrap_or_else(Vector3::x);
        let overlap = radius + other.radius - between.norm();
        // `compute pair/local` of LAMMPS lists all pairs within its cutoff, also those that are not in contact.
        if force == Vector3::zeros() && overlap <= 0.0 {
            continue;
        }
        contacts.push(contact(*id, Partner::Grain(other.id), *position, *radius, normal, overlap, force));
    }
    contacts.sort_by_key(|contact: &ContactState| contact.grain);
    Ok(contacts)
}

/// Returns the contacts that the probes request, if they exist. `force` returns the force on the grain, or on the first
/// grain, of a contact; `None` if the force is unknown, which counts as NaN. Normal force and magnitude of the shear force
/// are increased by `shift` times the uncertainty due to printed digits.
pub(crate) fn contacts(
    scene: &Scene,
    time: f64,
    step: u64,
    grains: &[GrainState],
    force: impl Fn(ProbeTarget) -> Option<PairForce>,
    shift: f64,
) -> Vec<ContactState> {
    let time_step = if step == 0 { 0.0 } else { time / step as f64 };
    let mut found = Vec::new();
    for probe in &scene.probes {
        let (grain, partner, (normal, distance), reach) = match probe.target {
            ProbeTarget::Pair(a, b) => {
                let reach = scene.grains[a].radius + scene.grains[b].radius;
                let between = grains[b].position - grains[a].position;
                let nearest = |domain: &Domain| nearest_image(between, domain.low, domain.high, domain.periodic);
                let between = scene.domain.as_ref().map_or(between, nearest);
                (a, Partner::Grain(b as u32 + 1), direction(between), reach)
            }
            ProbeTarget::GrainWall(grain, wall) => {
                let at = grains[grain].position;
                let (shape, motion) = (&scene.walls[wall].shape, &scene.walls[wall].motion);
                let shape = shape.moved(motion, &motion.displacement(time, time_step));
                (grain, Partner::Wall(wall as u16), to_wall(at, &shape), scene.grains[grain].radius)
            }
            _ => continue,
        };
        let (overlap, force) = (reach - distance, force(probe.target));
        // A force other than zero proves a contact, even if the computed overlap is not positive because few digits are
        // printed.
        let pushed = force.is_some_and(|known| known.force != Vector3::zeros());
        if !(overlap > 0.0 || pushed) {
            continue;
        }
        let known = force.unwrap_or(PairForce { force: Vector3::repeat(f64::NAN), open: 0.0 });
        let (centre, radius) = (grains[grain].position, scene.grains[grain].radius);
        let exact = contact(grain as u32 + 1, partner, centre, radius, normal, overlap, known.force);
        let (open, shear) = (shift * known.open, exact.shear_force.norm());
        found.push(ContactState {
            normal_force: exact.normal_force + open,
            shear_force: exact.shear_force * if shear > 0.0 { 1.0 + open / shear } else { 1.0 },
            ..exact
        });
    }
    found
}

/// Returns the direction and the length of a vector.
fn direction(line: Vector3<f64>) -> (Vector3<f64>, f64) {
    let length = line.norm();
    (line / length, length)
}

/// Returns direction and distance (m) from a grain to the nearest point of a wall. For a plane, the direction points
/// into the solid.
fn to_wall(at: Vector3<f64>, shape: &WallShape) -> (Vector3<f64>, f64) {
    match shape {
        WallShape::Plane { point, normal } => (-normal, (at - point).dot(normal)),
        WallShape::Segment { ends } => direction(nearest_on_segment(at, ends) - at),
        WallShape::Rectangle { corner, edges } => direction(nearest_on_rectangle(at, corner, edges) - at),
        WallShape::Round { axis, radii } => direction(nearest_on_round(at, axis, radii) - at),
        WallShape::Mesh(mesh) => direction(mesh.nearest(at) - at),
    }
}

/// Returns the vector `line` between two centres after the shift to the nearest image along periodic axes. `low` and `high`
/// are the corners of the box (m).
fn nearest_image(mut line: Vector3<f64>, low: Vector3<f64>, high: Vector3<f64>, periodic: [bool; 3]) -> Vector3<f64> {
    for axis in (0..3).filter(|&axis| periodic[axis]) {
        let length = high[axis] - low[axis];
        line[axis] -= length * (line[axis] / length).round();
    }
    line
}

/// Returns a contact of a grain in the direction of `normal`. `force` is the force on the grain (N).
fn contact(
    grain: u32,
    partner: Partner,
    centre: Vector3<f64>,
    radius: f64,
    normal: Vector3<f64>,
    overlap: f64,
    force: Vector3<f64>,
) -> ContactState {
    let normal_force = -force.dot(&normal);
    ContactState {
        grain,
        partner,
        point: centre + normal * (radius - 0.5 * overlap),
        normal,
        overlap,
        normal_force,
        shear_force: force + normal * normal_force,
        // Dumps do not state if a contact slips.
        slipping: false,
    }
}
