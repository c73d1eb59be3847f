//! Deformable against deformable in space: two spheres, a sphere and a block.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use grainbench_scene::record::Record;
use support::{column, last, run};

const SPEED: f64 = 0.042_426_406_871_192_85;

/// Two equal spheres of radius 1 that approach at .01 c each from a gap (m), off centre by `offset` each.
fn collision(gap: f64, friction: f64, offset: f64) -> String {
    let half = 0.5 * ((2.0 + gap).powi(2) - (2.0 * offset).powi(2)).sqrt();
    let duration = 0.5 * gap / SPEED + 5.0;
    format!(
        "dimension = 3\nduration = {duration}\n\
         materials.m = {{ density = 1.0, bulk_modulus = 10.0, shear_modulus = 6.0 }}\n\
         contacts.m = {{ between = ['m', 'm'], law = 'coulomb', friction = {friction} }}\n\
         [grains.a]\nmaterial = 'm'\nradius = 1.0\nposition = [{}, {}, 0.1]\nvelocity = [{SPEED}, 0.0, 0.0]\n\
         [grains.b]\nmaterial = 'm'\nradius = 1.0\nposition = [{half}, {offset}, 0.1]\nvelocity = [{}, 0.0, 0.0]\n\
         [output]\nevery = 0.02\n[probes]\na.grain = 'a'\nb.grain = 'b'\nall.system = true\nc.contact = ['a', 'b']\n",
        -half, -offset, -SPEED
    )
}

fn momentum_drift(record: &Record) -> f64 {
    let columns = ["x", "y", "z"].map(|axis| column(record, &format!("all.momentum_{axis}")));
    let size = |at: usize| columns.iter().map(|column| column[at] * column[at]).sum::<f64>().sqrt();
    (0..columns[0].len()).map(size).fold(0.0, f64::max) / (4.0 / 3.0 * std::f64::consts::PI * SPEED)
}

fn energy(record: &Record) -> f64 {
    let energy = column(record, "all.total_energy");
    energy[energy.len() - 1] / energy[0]
}

/// Head on without friction: momentum is kept to rounding, and nothing starts to turn. Springs give the energy back that they took; quadratic
/// functions damp at four cells a radius.
#[test]
fn spheres_rebound() {
    for (solver, energies, restitutions) in [
        ("mpm:penalty", 0.99..1.01, 0.97..1.005),
        ("mpm", 0.94..1.01, 0.87..1.005),
        ("mpm:gap", 0.96..1.005, 0.93..1.005),
    ] {
        let record = run(solver, &collision(0.1, 0.0, 0.0), 4.0, 2);
        assert!(energies.contains(&energy(&record)), "{solver}: {}", energy(&record));
        let restitution = -last(&record, "a.vx") / SPEED;
        assert!(restitutions.contains(&restitution), "{solver}: {restitution}");
        assert!(momentum_drift(&record) < 1e-12, "{solver}: {}", momentum_drift(&record));
        assert!(last(&record, "a.omega_z").abs() < 1e-12 * SPEED, "{solver}");
    }
}

/// The criterion of 2001 along each body's own normal does not keep momentum.
#[test]
fn own_normals_do_not_keep_momentum_in_space() {
    let record = run("mpm:2001", &collision(0.1, 0.0, 0.0), 4.0, 2);
    assert!(momentum_drift(&record) > 1e-3, "{}", momentum_drift(&record));
}

/// Off centre: without friction spheres hardly start to turn, with it they turn alike.
#[test]
fn friction_turns_spheres() {
    let smooth = run("mpm", &collision(0.1, 0.0, 0.5), 4.0, 2);
    assert!(last(&smooth, "a.omega_z").abs() < 0.04 * SPEED, "{}", last(&smooth, "a.omega_z") / SPEED);
    let rough = run("mpm", &collision(0.1, 0.2, 0.5), 4.0, 2);
    let spins = [last(&rough, "a.omega_z"), last(&rough, "b.omega_z")].map(|spin| spin / SPEED);
    assert!((spins[0] - spins[1]).abs() < 1e-9 && (0.5..0.62).contains(&spins[0]), "{spins:?}");
    assert!(momentum_drift(&rough) < 1e-12 && energy(&rough) < energy(&smooth));
}
