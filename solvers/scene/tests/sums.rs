//! What the probe of a whole system adds up, of a disc and of a body that is no grain, by hand.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use grainbench_scene::record::{BodyState, GrainState, Look, Snapshot};
use grainbench_scene::recorder::Recorder;
use grainbench_scene::source::SceneSource;
use nalgebra::Vector3;
use std::path::Path;

/// A disc of 1000 kg and 125 kg m² at (2, 3) m with (4, 5) m/s and 6 rad/s, and a body of 20 kg and 7 kg m² at (1, −2) m with
/// (3, −1) m/s and −2 rad/s, under 10 m/s² downwards; 11 J within the material and 13 J in springs.
/// Motion ½ 1000 41 + ½ 20 10 + 11, turning ½ 125 36 + ½ 7 4, height 10 (1000 3 − 20 2); about the origin
/// 1000 (2·5 − 3·4) + 125·6 + 20 (1·(−1) + 2·3) − 7·2.
#[test]
fn energies_and_momenta() {
    let text = "title = 't'\ndimension = 2\nduration = 1.0\ngravity = [0.0, -10.0]\n\
                materials.m.density = 1273.2395447351628\n\
                [grains.a]\nmaterial = 'm'\nradius = 0.5\nposition = [2.0, 3.0]\n[probes]\nall.system = true\n";
    let scene = SceneSource::from_text("test", Path::new(""), text).scene(&|_| Err("no files".to_owned())).unwrap();
    let disc = GrainState {
        velocity: Vector3::new(4.0, 5.0, 0.0),
        spin: Vector3::new(0.0, 0.0, 6.0),
        ..GrainState::start(1, &scene.grains[0])
    };
    let body = BodyState {
        name: "b".to_owned(),
        mass: 20.0,
        inertia: 7.0,
        position: Vector3::new(1.0, -2.0, 0.0),
        velocity: Vector3::new(3.0, -1.0, 0.0),
        spin: Vector3::new(0.0, 0.0, -2.0),
        angle: 0.0,
        force: Vector3::zeros(),
    };
    let grains = Snapshot::of_grains(&scene, 0, 0.0, vec![disc]);
    let snapshot = Snapshot { bodies: vec![body], contacts: Some(Vec::new()), ..grains };
    let mut recorder = Recorder::new(&scene, 1.0, 1);
    recorder.take(&scene, Look { inner_kinetic_energy: 11.0, ..Look::of_rigid(snapshot, 13.0) });
    let series = recorder.finish().0;
    for (column, expected) in [
        ("kinetic_energy", 20_611.0),
        ("rotational_energy", 2264.0),
        ("elastic_energy", 13.0),
        ("gravitational_energy", 29_600.0),
        ("total_energy", 52_488.0),
        ("momentum_x", 4060.0),
        ("momentum_y", 4980.0),
        ("angular_momentum", -1164.0),
        ("contacts", 0.0),
        ("largest_spin", 6.0),
    ] {
        let found = series.column(&format!("all.{column}")).unwrap()[0];
        assert!((found - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{column}: {found} for {expected}");
    }
}
