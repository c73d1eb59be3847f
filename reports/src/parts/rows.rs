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
pub(super) struct Frame {
    pub(super) bounds: (Vector3<f64>, Vector3<f64>),
    pub(super) periodic: [bool; 3],
    pub(super) has_contacts: bool,
}

impl Row for Frame {
    const TABLE: &'static str = "snapshots";

    fn visit(row: Option<&Self>, columns: &mut impl Visit) -> Self {
        const PERIODIC: [&str; 3] = ["periodic_x", "periodic_y", "periodic_z"];
        let low = columns.vector(["low_x", "low_y", "low_z"], row.map(|row| row.bounds.0));
        let high = columns.vector(["high_x", "high_y", "high_z"], row.map(|row| row.bounds.1));
        Self {
            bounds: (low, high),
            periodic: [0, 1, 2].map(|axis| columns.flag(PERIODIC[axis], row.map(|row| row.periodic[axis]))),
            has_contacts: columns.flag("contacts_told", row.map(|row| row.has_contacts)),
        }
    }
}

impl Row for GrainState {
    const TABLE: &'static str = "grains";

    fn visit(row: Option<&Self>, columns: &mut impl Visit) -> Self {
        let boxed = |numbers: Option<[f64; 6]>| numbers.map(Box::new);
        Self {
            id: columns.whole("id", row.map(|row| row.id)),
            material: columns.whole("material", row.map(|row| row.material)),
            radius: columns.number("radius", row.map(|row| row.radius)),
            mass: columns.number("mass", row.map(|row| row.mass)),
            position: columns.vector(PLACE, row.map(|row| row.position)),
            velocity: columns.vector(VELOCITY, row.map(|row| row.velocity)),
            spin: columns.vector(SPIN, row.map(|row| row.spin)),
            angle: columns.told("angle", row.and_then(|row| row.angle)),
            force: columns.told_vector(FORCE, row.and_then(|row| row.force)),
            torque: columns.told_vector(TORQUE, row.and_then(|row| row.torque)),
            plastic_strain: columns.number("plastic_strain", row.map(|row| row.plastic_strain)),
            virial: boxed(columns.told_numbers(VIRIAL, row.and_then(|row| row.virial.as_deref().copied()))),
            mean_virial: boxed(
                columns.told_numbers(MEAN_VIRIAL, row.and_then(|row| row.mean_virial.as_deref().copied())),
            ),
        }
    }
}

impl Row for ContactState {
    const TABLE: &'static str = "contacts";

    fn visit(row: Option<&Self>, columns: &mut impl Visit) -> Self {
        let grain = columns.whole("grain", row.map(|row| row.grain));
        let (kind, number) = match row.map_or(Partner::Wall(0), |row| row.partner) {
            Partner::Grain(id) => ("grain", i64::from(id)),
            Partner::Body(place) => ("body", i64::from(place)),
            Partner::Wall(place) => ("wall", i64::from(place)),
        };
        let (kind, number) = (columns.word("partner", Some(kind)), columns.whole("partner_number", Some(number)));
        Self {
            grain,
            partner: match kind.as_str() {
                "grain" => Partner::Grain(number as u32),
                "body" => Partner::Body(number as u32),
                _ => Partner::Wall(number as u16),
            },
            point: columns.vector(PLACE, row.map(|row| row.point)),
            normal: columns.vector(["normal_x", "normal_y", "normal_z"], row.map(|row| row.normal)),
            overlap: columns.number("overlap", row.map(|row| row.overlap)),
            normal_force: columns.number("normal_force", row.map(|row| row.normal_force)),
            shear_force: columns.vector(["shear_x", "shear_y", "shear_z"], row.map(|row| row.shear_force)),
            slipping: columns.flag("slipping", row.map(|row| row.slipping)),
        }
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

    fn visit(row: Option<&Self>, columns: &mut impl Visit) -> Self {
        let (name, infinite) =
            (columns.word("name", row.map(|row| &*row.name)), columns.flag("infinite", row.map(|row| row.infinite)));
        let corner = |at: usize| row.and_then(|row| row.corners.get(at).copied());
        let corners = CORNERS.into_iter().enumerate();
        let corners = corners.filter_map(|(at, names)| columns.told_vector(names, corner(at))).collect();
        Self { name, infinite, corners, force: columns.told_vector(FORCE, row.and_then(|row| row.force)) }
    }
}

impl Row for BodyState {
    const TABLE: &'static str = "bodies";

    fn visit(row: Option<&Self>, columns: &mut impl Visit) -> Self {
        Self {
            name: columns.word("name", row.map(|row| &*row.name)),
            mass: columns.number("mass", row.map(|row| row.mass)),
            inertia: columns.number("inertia", row.map(|row| row.inertia)),
            position: columns.vector(PLACE, row.map(|row| row.position)),
            velocity: columns.vector(VELOCITY, row.map(|row| row.velocity)),
            spin: columns.vector(SPIN, row.map(|row| row.spin)),
            angle: columns.number("angle", row.map(|row| row.angle)),
            force: columns.vector(FORCE, row.map(|row| row.force)),
        }
    }
}

impl Row for PointState {
    const TABLE: &'static str = "points";

    fn visit(row: Option<&Self>, columns: &mut impl Visit) -> Self {
        let (kind, number) = match row.map_or(Owner::Body(0), |row| row.owner) {
            Owner::Grain(id) => ("grain", i64::from(id)),
            Owner::Body(place) => ("body", i64::from(place)),
        };
        let (kind, number) = (columns.word("owner", Some(kind)), columns.whole("owner_number", Some(number)));
        Self {
            owner: if kind == "grain" { Owner::Grain(number as u32) } else { Owner::Body(number as u32) },
            position: columns.vector(PLACE, row.map(|row| row.position)),
            displacement: columns.vector(["ux", "uy", "uz"], row.map(|row| row.displacement)),
            velocity: columns.vector(VELOCITY, row.map(|row| row.velocity)),
            stress: columns.numbers(["sxx", "syy", "szz", "sxy", "syz", "szx"], row.map(|row| row.stress)),
            plastic_strain: columns.number("plastic_strain", row.map(|row| row.plastic_strain)),
            rotation: columns.number("rotation", row.map(|row| row.rotation)),
            volume: columns.number("volume", row.map(|row| row.volume)),
        }
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

    fn visit(row: Option<&Self>, columns: &mut impl Visit) -> Self {
        Self {
            snapshot: columns.whole("snapshot", row.map(|row| row.snapshot)),
            step: columns.whole("step", row.map(|row| row.step)),
            time: columns.number("time", row.map(|row| row.time)),
            row: R::visit(row.map(|row| &row.row), columns),
        }
    }
}
