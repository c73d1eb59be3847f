//! A small record for tests: two discs and a wall, with one contact across a periodic boundary.

use grainbench_solver::record::{
    Column, ContactState, Cost, GrainState, Owner, Partner, PointState, Provenance, Record, Series, Snapshot, WallState,
};
use nalgebra::Vector3;

fn grain(id: u32, x: f64, y: f64) -> GrainState {
    GrainState {
        id,
        material: 0,
        radius: 0.5,
        mass: 1.25,
        position: Vector3::new(x, y, 0.0),
        velocity: Vector3::new(0.1, -2e-7, 0.0),
        spin: Vector3::new(0.0, 0.0, 3.0),
        angle: Some(0.25),
        force: Some(Vector3::new(1.0, 2.0, 0.0)),
        torque: Some(Vector3::new(0.0, 0.0, -0.125)),
        plastic_strain: 0.0,
        virial: Some(Box::new([-3.0, -2.5, 0.0, 0.125, 0.0, 0.0])),
        mean_virial: Some(Box::new([-1.0, -2.0, 0.0, 0.5, 0.0, 0.0])),
    }
}

pub(crate) fn snapshot() -> Snapshot {
    Snapshot {
        step: 10,
        time: 0.1,
        bounds: (Vector3::new(0.0, 0.0, 0.0), Vector3::new(4.0, 3.0, 0.0)),
        periodic: [true, false, false],
        grains: vec![grain(1, 3.75, 0.25), grain(2, 0.5, 0.25)],
        contacts: Some(vec![
            ContactState {
                grain: 1,
                partner: Partner::Grain(2),
                point: Vector3::new(0.125, 0.25, 0.0),
                normal: Vector3::new(1.0, 0.0, 0.0),
                overlap: 0.25,
                normal_force: 10.0,
                shear_force: Vector3::new(0.0, 1.5, 0.0),
                slipping: true,
            },
            ContactState {
                grain: 2,
                partner: Partner::Wall(0),
                point: Vector3::new(0.5, -0.125, 0.0),
                normal: Vector3::new(0.0, -1.0, 0.0),
                overlap: 0.25,
                normal_force: 20.0,
                ..ContactState::default()
            },
        ]),
        walls: vec![WallState {
            name: "floor".into(),
            corners: vec![Vector3::zeros(), Vector3::new(4.0, 0.0, 0.0)],
            infinite: false,
            force: Some(Vector3::new(0.0, -20.0, 0.0)),
        }],
        ..Snapshot::default()
    }
}

/// Returns the snapshot with two additional material points: one of a grain and one of a block.
pub(crate) fn deformable() -> Snapshot {
    let point = |owner, x: f64| PointState {
        owner,
        position: Vector3::new(x, 0.25, 0.0),
        displacement: Vector3::new(0.5, 0.0, 0.0),
        velocity: Vector3::new(0.1, -2e-7, 0.0),
        stress: [-1e3, 2e3, -0.5, 0.125, 0.0, 0.0],
        plastic_strain: 0.01,
        rotation: 0.25,
        volume: 0.0625,
    };
    Snapshot { points: vec![point(Owner::Grain(2), 0.5), point(Owner::Body(0), 1.5)], ..snapshot() }
}

pub(crate) fn series() -> Series {
    let columns = [("disc.x", "m"), ("a,b", "1")].map(|(name, unit)| Column { name: name.into(), unit: unit.into() });
    let values = vec![vec![1.0, 1.0 / 3.0], vec![-1e-300, 2e20]];
    Series { step: vec![0, 5], time: vec![0.0, 0.1 + 0.2], columns: columns.into(), values }
}

pub(crate) fn record() -> Record {
    Record {
        provenance: Provenance {
            scene: "two discs".into(),
            solver: "dem".into(),
            resolution: "dt=.1".into(),
            time_step: 0.01,
            critical_time_step: Some(0.1),
            effects: vec!["friction".into()],
            options: Vec::new(),
        },
        series: series(),
        snapshots: vec![Snapshot { step: 0, time: 0.0, contacts: Some(Vec::new()), ..snapshot() }, snapshot()],
        cost: Cost::default(),
    }
}
