//! Walls with a prescribed force, compared with exact solutions for a piston.

use crate::common::{self, Directory, simulated, temporary_with};
use grainbench::scene::nalgebra::{Matrix2, SymmetricEigen, Vector2};
use grainbench::solver::record::Record;
use grainbench::solver::resolution::Resolution;

/// Force on the lid (N), as in the file of the scene.
const FORCE: f64 = 30.0;
const MASS: f64 = 4.0; // mass of the lid (kg); the mass of the sphere is 1 kg
const STIFFNESS: f64 = 2e4; // contact stiffness (N/m)

/// Returns a scene with a sphere on a floor, and a lid at a distance `gap` (m) above the sphere.
fn scene(gap: f64, damping: f64, between: f64, duration: f64, motion: &str) -> String {
    let lid = include_str!("../scenes/lid.toml").replace("1.01]", &format!("{:?}]", 1.0 + gap));
    let values = [("duration", 1.0, duration), ("normal_damping", 5.0, between), (" damping", 0.5, damping)];
    let edited = |lid: String, (key, from, to)| lid.replace(&format!("{key} = {from:?}"), &format!("{key} = {to:?}"));
    values.into_iter().fold(lid, edited) + motion
}

fn run(text: &str) -> Record {
    simulated("dem", &common::scene(text), &Resolution::CriticalFraction(0.01))
}

/// Returns the largest difference between a column and its exact values.
fn apart(record: &Record, name: &str, exact: impl Fn(f64) -> f64) -> f64 {
    let values = record.series.column(name).unwrap().iter().zip(&record.series.time);
    values.map(|(value, &time)| (value - exact(time)).abs()).fold(0.0, f64::max)
}

/// Without contact, the displacement is F t²/2M. With damping c, it is F/(Mc) (t − (1 − e^(−ct))/c).
#[test]
fn a_lid_that_touches_nothing_goes_as_its_force_drives_it() {
    let free = run(&scene(2.0, 0.0, 0.0, 0.7, ""));
    assert!(apart(&free, "lid.advance", |time| 0.5 * FORCE / MASS * time * time) < 1e-12);
    let damping = 3.0;
    let exact = |time: f64| FORCE / (MASS * damping) * (time - (1.0 - (-damping * time).exp()) / damping);
    let damped = run(&scene(2.0, damping, 0.0, 0.7, ""));
    assert!(apart(&damped, "lid.advance", exact) < 1e-6);
    assert!(apart(&damped, "lid.advance", |time| 0.5 * FORCE / MASS * time * time) > 0.1);
}

/// A mass m is between two springs k, and a mass M is on the upper spring. A force F is suddenly applied to M. No
/// contact opens until the first return, and x = x₁ − M^(−½) V cos(ωt) Vᵀ M^½ x₁. The rest position is x₁ = (F/k,
/// 2F/k); V and ω² are the modes of M^(−½) K M^(−½).
#[test]
fn a_lid_on_a_grain_swings_in_their_two_modes() {
    let root = Vector2::new(1.0, MASS.sqrt());
    let stiff = Matrix2::new(2.0, -1.0, -1.0, 1.0) * STIFFNESS;
    let eigen = SymmetricEigen::new(Matrix2::from_fn(|i, j| stiff[(i, j)] / (root[i] * root[j])));
    let rest = Vector2::new(1.0, 2.0) * (FORCE / STIFFNESS);
    let exact = |time: f64, component: usize| {
        let swing = eigen.eigenvalues.map(|square| (square.sqrt() * time).cos());
        let modes = eigen.eigenvectors * Matrix2::from_diagonal(&swing) * eigen.eigenvectors.transpose();
        let start = rest.component_mul(&root);
        rest[component] - (modes * start)[component] / root[component]
    };
    let record = run(&scene(0.0, 0.0, 0.0, 0.1, ""));
    let size = 2.0 * FORCE / STIFFNESS;
    assert!(apart(&record, "lid.advance", |time| exact(time, 1)) < 1e-3 * size);
    assert!(apart(&record, "ball.z", |time| 0.5 - exact(time, 0)) < 1e-3 * size);
    // Control: a frequency higher by 5 % gives a visible difference.
    assert!(apart(&record, "lid.advance", |time| exact(time * 1.05, 1)) > 0.1 * size);
}

/// With damping, the lid comes to rest where two springs in series carry its force, also while the lid slides.
#[test]
fn a_lid_at_rest_presses_with_its_force() {
    for motion in ["", "motion = [{ velocity = [0.5, 0.0, 0.0] }]"] {
        let record = run(&scene(0.01, 4.0, 20.0, 20.0, motion));
        let last = |name: &str| record.series.column(name).unwrap().last().copied().unwrap();
        assert!((last("floor.force_z") + FORCE).abs() < 1e-6, "{}", last("floor.force_z"));
        assert!((last("on-lid.force_z") - FORCE).abs() < 1e-6, "{}", last("on-lid.force_z"));
        assert!((last("lid.advance") - (0.01 + 2.0 * FORCE / STIFFNESS)).abs() < 1e-9, "{}", last("lid.advance"));
    }
}

#[test]
fn a_run_with_a_lid_goes_on_to_the_same_bits() {
    let path = temporary_with("lid.toml", scene(0.01, 0.5, 5.0, 1.0, ""));
    path.ok("simulate lid.toml --solver dem --out one --checkpoint half --checkpoint-every 300");
    path.ok("simulate lid.toml --solver dem --out two --restart half");
    let series = |folder: &str| std::fs::read(path.join(folder).join("series.csv")).unwrap();
    assert!(series("one") == series("two"));
}
