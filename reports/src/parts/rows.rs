//! Rows of the tables of a part, one for each snapshot, grain, contact, wall, body or material point. Units are SI, as
//! in [`grainbench_solver::record`].

use super::columns::{Columns as Visit, Row};
use grainbench_scene::columns::{Chosen, Columns};
use grainbench_solver::record::{BodyState, ContactState, GrainState, Owner, Partner, PointState, WallState};
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

impl Row for Frame {
    const TABLE: &'static str = "snapshots";

    fn visit(&mut self, columns: &mut impl Visit) {
        columns.numbers(&["low_x", "low_y", "low_z"], &mut self.bounds.0);
        columns.numbers(&["high_x", "high_y", "high_z"], &mut self.bounds.1);
        for (name, periodic) in ["periodic_x", "periodic_y", "periodic_z"].into_iter().zip(&mut self.periodic) {
            columns.flag(name, periodic);
        }
        columns.flag("contacts_told", &mut self.has_contacts);
    }
}

impl Row for GrainState {
    const TABLE: &'static str = "grains";

    fn visit(&mut self, columns: &mut impl Visit) {
        columns.whole("id", &mut self.id);
        columns.whole("material", &mut self.material);
        columns.number("radius", &mut self.radius);
        columns.number("mass", &mut self.mass);
        columns.numbers(&PLACE, &mut self.position);
        columns.numbers(&VELOCITY, &mut self.velocity);
        columns.numbers(&SPIN, &mut self.spin);
        columns.told("angle", &mut self.angle);
        columns.told_numbers(FORCE, &mut self.force);
        columns.told_numbers(TORQUE, &mut self.torque);
        columns.number("plastic_strain", &mut self.plastic_strain);
        columns.told_numbers(VIRIAL, &mut self.virial);
        columns.told_numbers(MEAN_VIRIAL, &mut self.mean_virial);
    }
}

impl Row for ContactState {
    const TABLE: &'static str = "contacts";

    fn visit(&mut self, columns: &mut impl Visit) {
        columns.whole("grain", &mut self.grain);
        let (kind, mut number) = match self.partner {
            Partner::Grain(id) => ("grain", i64::from(id)),
            Partner::Body(place) => ("body", i64::from(place)),
            Partner::Wall(place) => ("wall", i64::from(place)),
        };
        let mut kind = kind.to_owned();
        columns.word("partner", &mut kind);
        columns.whole("partner_number", &mut number);
        self.partner = match kind.as_str() {
            "grain" => Partner::Grain(number as u32),
            "body" => Partner::Body(number as u32),
            _ => Partner::Wall(number as u16),
        };
        columns.numbers(&PLACE, &mut self.point);
        columns.numbers(&["normal_x", "normal_y", "normal_z"], &mut self.normal);
        columns.number("overlap", &mut self.overlap);
        columns.number("normal_force", &mut self.normal_force);
        columns.numbers(&["shear_x", "shear_y", "shear_z"], &mut self.shear_force);
        columns.flag("slipping", &mut self.slipping);
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

    fn visit(&mut self, columns: &mut impl Visit) {
        columns.word("name", &mut self.name);
        columns.flag("infinite", &mut self.infinite);
        let mut corners = [0, 1, 2, 3].map(|at| self.corners.get(at).copied());
        CORNERS.into_iter().zip(&mut corners).for_each(|(names, corner)| columns.told_numbers(names, corner));
        self.corners = corners.into_iter().flatten().collect();
        columns.told_numbers(FORCE, &mut self.force);
    }
}

impl Row for BodyState {
    const TABLE: &'static str = "bodies";

    fn visit(&mut self, columns: &mut impl Visit) {
        columns.word("name", &mut self.name);
        columns.number("mass", &mut self.mass);
        columns.number("inertia", &mut self.inertia);
        columns.numbers(&PLACE, &mut self.position);
        columns.numbers(&VELOCITY, &mut self.velocity);
        columns.numbers(&SPIN, &mut self.spin);
        columns.number("angle", &mut self.angle);
        columns.numbers(&FORCE, &mut self.force);
    }
}

impl Row for PointState {
    const TABLE: &'static str = "points";

    fn visit(&mut self, columns: &mut impl Visit) {
        let (kind, mut number) = match self.owner {
            Owner::Grain(id) => ("grain", i64::from(id)),
            Owner::Body(place) => ("body", i64::from(place)),
        };
        let mut kind = kind.to_owned();
        columns.word("owner", &mut kind);
        columns.whole("owner_number", &mut number);
        self.owner = if kind == "grain" { Owner::Grain(number as u32) } else { Owner::Body(number as u32) };
        columns.numbers(&PLACE, &mut self.position);
        columns.numbers(&["ux", "uy", "uz"], &mut self.displacement);
        columns.numbers(&VELOCITY, &mut self.velocity);
        columns.numbers(&["sxx", "syy", "szz", "sxy", "syz", "szx"], &mut self.stress);
        columns.number("plastic_strain", &mut self.plastic_strain);
        columns.number("rotation", &mut self.rotation);
        columns.number("volume", &mut self.volume);
    }
}

/// A row with the number, the step and the time of its snapshot. Two snapshots can have the same step: the last regular
/// state and the state at a crash.
#[derive(Default)]
pub(super) struct SnapshotRow<R> {
    /// Index of the snapshot in the run, from 0.
    pub(super) snapshot: u64,
    pub(super) step: u64,
    pub(super) time: f64,
    pub(super) row: R,
}

impl<R: Row> Row for SnapshotRow<R> {
    const TABLE: &'static str = R::TABLE;

    fn visit(&mut self, columns: &mut impl Visit) {
        columns.whole("snapshot", &mut self.snapshot);
        columns.whole("step", &mut self.step);
        columns.number("time", &mut self.time);
        self.row.visit(columns);
    }
}
