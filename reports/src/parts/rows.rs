//! Rows of the tables of a part, one for each snapshot, grain, contact, wall, body or material point. Units are SI, as
//! in [`grainbench_solver::record`].

use super::columns::{Columns as Visit, Row, Value};
use grainbench_scene::columns::{Chosen, Columns};
use grainbench_solver::record::{BodyState, ContactState, GrainState, Owner, Partner, PointState, Snapshot, WallState};
use nalgebra::Vector3;

const PLACE: [&str; 3] = ["x", "y", "z"];
const VELOCITY: [&str; 3] = ["vx", "vy", "vz"];
const SPIN: [&str; 3] = ["omegax", "omegay", "omegaz"];
const FORCE: [&str; 3] = ["fx", "fy", "fz"];
const TORQUE: [&str; 3] = ["tqx", "tqy", "tqz"];

const VIRIAL: [&str; 6] = ["virial_xx", "virial_yy", "virial_zz", "virial_xy", "virial_yz", "virial_zx"];
const MEAN_VIRIAL: [&str; 6] =
    ["mean_virial_xx", "mean_virial_yy", "mean_virial_zz", "mean_virial_xy", "mean_virial_yz", "mean_virial_zx"];

/// Returns the names of the grain columns that the snapshots of a run do not contain.
pub(super) fn left_out(columns: &Columns) -> Vec<&'static str> {
    let columns_of: [(Chosen, Vec<&'static str>); 4] = [
        (Chosen::Spin, [&SPIN[..], &["angle"]].concat()),
        (Chosen::Force, [FORCE, TORQUE].concat()),
        (Chosen::Virial, VIRIAL.to_vec()),
        (Chosen::MeanVirial, MEAN_VIRIAL.to_vec()),
    ];
    columns_of.into_iter().filter(|(chosen, _)| !columns.has(*chosen)).flat_map(|(_, names)| names).collect()
}

/// Data of a snapshot that no other table contains.
#[derive(Default)]
pub(super) struct Frame {
    pub(super) bounds: (Vector3<f64>, Vector3<f64>),
    pub(super) periodic: [bool; 3],
    pub(super) has_contacts: bool,
}

impl Frame {
    pub(super) const fn from_snapshot(snapshot: &Snapshot) -> Self {
        Self { bounds: snapshot.bounds, periodic: snapshot.periodic, has_contacts: snapshot.contacts.is_some() }
    }
}

impl Row for Frame {
    const TABLE: &'static str = "snapshots";

    fn blank() -> Self {
        Self::default()
    }

    fn visit(&mut self, columns: &mut impl Visit) {
        columns.numbers(["low_x", "low_y", "low_z"], &mut self.bounds.0);
        columns.numbers(["high_x", "high_y", "high_z"], &mut self.bounds.1);
        for (name, periodic) in ["periodic_x", "periodic_y", "periodic_z"].into_iter().zip(&mut self.periodic) {
            columns.visit(name, Value::Flag(periodic));
        }
        columns.visit("contacts_told", Value::Flag(&mut self.has_contacts));
    }
}

impl Row for GrainState {
    const TABLE: &'static str = "grains";

    fn blank() -> Self {
        Self {
            id: 0,
            material: 0,
            radius: 0.0,
            mass: 0.0,
            position: Vector3::zeros(),
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
            angle: None,
            force: None,
            torque: None,
            plastic_strain: 0.0,
            virial: None,
            mean_virial: None,
        }
    }

    fn visit(&mut self, columns: &mut impl Visit) {
        whole(columns, "id", &mut self.id);
        whole(columns, "material", &mut self.material);
        columns.visit("radius", Value::Number(&mut self.radius));
        columns.visit("mass", Value::Number(&mut self.mass));
        columns.numbers(PLACE, &mut self.position);
        columns.numbers(VELOCITY, &mut self.velocity);
        columns.numbers(SPIN, &mut self.spin);
        columns.visit("angle", Value::Told(&mut self.angle));
        columns.told_vector(FORCE, &mut self.force);
        columns.told_vector(TORQUE, &mut self.torque);
        columns.visit("plastic_strain", Value::Number(&mut self.plastic_strain));
        columns.told_apart(VIRIAL, &mut self.virial);
        columns.told_apart(MEAN_VIRIAL, &mut self.mean_virial);
    }
}

impl Row for ContactState {
    const TABLE: &'static str = "contacts";

    fn blank() -> Self {
        Self {
            grain: 0,
            partner: Partner::Wall(0),
            point: Vector3::zeros(),
            normal: Vector3::zeros(),
            overlap: 0.0,
            normal_force: 0.0,
            shear_force: Vector3::zeros(),
            slipping: false,
        }
    }

    fn visit(&mut self, columns: &mut impl Visit) {
        whole(columns, "grain", &mut self.grain);
        let (word, mut number) = match self.partner {
            Partner::Grain(id) => ("grain", i64::from(id)),
            Partner::Body(place) => ("body", i64::from(place)),
            Partner::Wall(place) => ("wall", i64::from(place)),
        };
        let mut kind = word.to_owned();
        columns.visit("partner", Value::Word(&mut kind));
        columns.visit("partner_number", Value::Whole(&mut number));
        self.partner = match kind.as_str() {
            "grain" => Partner::Grain(number as u32),
            "body" => Partner::Body(number as u32),
            _ => Partner::Wall(number as u16),
        };
        columns.numbers(PLACE, &mut self.point);
        columns.numbers(["normal_x", "normal_y", "normal_z"], &mut self.normal);
        columns.visit("overlap", Value::Number(&mut self.overlap));
        columns.visit("normal_force", Value::Number(&mut self.normal_force));
        columns.numbers(["shear_x", "shear_y", "shear_z"], &mut self.shear_force);
        columns.visit("slipping", Value::Flag(&mut self.slipping));
    }
}

/// Columns of the points of a wall: two ends for a segment, four corners for a rectangle, point and normal for a plane.
const CORNERS: [[&str; 3]; 4] = [
    ["corner1_x", "corner1_y", "corner1_z"],
    ["corner2_x", "corner2_y", "corner2_z"],
    ["corner3_x", "corner3_y", "corner3_z"],
    ["corner4_x", "corner4_y", "corner4_z"],
];

impl Row for WallState {
    const TABLE: &'static str = "walls";

    fn blank() -> Self {
        Self { name: String::new(), corners: Vec::new(), infinite: false, force: None }
    }

    fn visit(&mut self, columns: &mut impl Visit) {
        columns.visit("name", Value::Word(&mut self.name));
        columns.visit("infinite", Value::Flag(&mut self.infinite));
        let mut corners = [0, 1, 2, 3].map(|at| self.corners.get(at).copied());
        for (names, corner) in CORNERS.into_iter().zip(&mut corners) {
            columns.told_vector(names, corner);
        }
        self.corners = corners.into_iter().flatten().collect();
        columns.told_vector(FORCE, &mut self.force);
    }
}

impl Row for BodyState {
    const TABLE: &'static str = "bodies";

    fn blank() -> Self {
        Self {
            name: String::new(),
            mass: 0.0,
            inertia: 0.0,
            position: Vector3::zeros(),
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
            angle: 0.0,
            force: Vector3::zeros(),
        }
    }

    fn visit(&mut self, columns: &mut impl Visit) {
        columns.visit("name", Value::Word(&mut self.name));
        columns.visit("mass", Value::Number(&mut self.mass));
        columns.visit("inertia", Value::Number(&mut self.inertia));
        columns.numbers(PLACE, &mut self.position);
        columns.numbers(VELOCITY, &mut self.velocity);
        columns.numbers(SPIN, &mut self.spin);
        columns.visit("angle", Value::Number(&mut self.angle));
        columns.numbers(FORCE, &mut self.force);
    }
}

impl Row for PointState {
    const TABLE: &'static str = "points";

    fn blank() -> Self {
        Self {
            owner: Owner::Body(0),
            position: Vector3::zeros(),
            displacement: Vector3::zeros(),
            velocity: Vector3::zeros(),
            stress: [0.0; 6],
            plastic_strain: 0.0,
            rotation: 0.0,
            volume: 0.0,
        }
    }

    fn visit(&mut self, columns: &mut impl Visit) {
        let (word, mut number) = match self.owner {
            Owner::Grain(id) => ("grain", i64::from(id)),
            Owner::Body(place) => ("body", i64::from(place)),
        };
        let mut kind = word.to_owned();
        columns.visit("owner", Value::Word(&mut kind));
        columns.visit("owner_number", Value::Whole(&mut number));
        self.owner = if kind == "grain" { Owner::Grain(number as u32) } else { Owner::Body(number as u32) };
        columns.numbers(PLACE, &mut self.position);
        columns.numbers(["ux", "uy", "uz"], &mut self.displacement);
        columns.numbers(VELOCITY, &mut self.velocity);
        columns.numbers(["sxx", "syy", "szz", "sxy", "syz", "szx"], &mut self.stress);
        columns.visit("plastic_strain", Value::Number(&mut self.plastic_strain));
        columns.visit("rotation", Value::Number(&mut self.rotation));
        columns.visit("volume", Value::Number(&mut self.volume));
    }
}

/// A row with the number, the step and the time of its snapshot. Two snapshots can have the same step: the last regular
/// state and the state at a crash.
pub(super) struct SnapshotRow<R> {
    /// Index of the snapshot in the run, from 0.
    pub(super) snapshot: u64,
    pub(super) step: u64,
    pub(super) time: f64,
    pub(super) row: R,
}

impl<R: Row> Row for SnapshotRow<R> {
    const TABLE: &'static str = R::TABLE;

    fn blank() -> Self {
        Self { snapshot: 0, step: 0, time: 0.0, row: R::blank() }
    }

    fn visit(&mut self, columns: &mut impl Visit) {
        whole(columns, "snapshot", &mut self.snapshot);
        whole(columns, "step", &mut self.step);
        columns.visit("time", Value::Number(&mut self.time));
        self.row.visit(columns);
    }
}

/// Visits an integer of any type. A stored value that does not fit the type leaves the integer unchanged; our own files
/// contain no such value.
fn whole<T: Copy + TryFrom<i64> + TryInto<i64>>(columns: &mut impl Visit, name: &'static str, value: &mut T) {
    let mut number = (*value).try_into().unwrap_or(i64::MAX);
    columns.visit(name, Value::Whole(&mut number));
    *value = T::try_from(number).unwrap_or(*value);
}
