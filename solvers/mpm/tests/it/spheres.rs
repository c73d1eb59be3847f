//! Tests of collisions of two deformable spheres.

use crate::support::{SPEED, column, energy, last, run};
use grainbench_solver::record::Record;

/// Returns two equal spheres of radius 1 that approach at `speed` (m/s) each from a gap (m), each with an offset of
/// `offset` (m). The run lasts gap/(2 speed) + `rest` (s).
fn collision(gap: f64, friction: f64, offset: f64, speed: f64, rest: f64) -> String {
    let half = 0.5 * ((2.0 + gap).powi(2) - (2.0 * offset).powi(2)).sqrt();
    let duration = 0.5 * gap / speed + rest;
    format!(
        "dimension = 3\nduration = {duration}\n\
         materials.m = {{ density = 1.0, bulk_modulus = 10.0, shear_modulus = 6.0 }}\n\
         contacts.m = {{ between = ['m', 'm'], law = 'coulomb', friction = {friction} }}\n\
         [grains.a]\nmaterial = 'm'\nradius = 1.0\nposition = [{}, {}, 0.1]\nvelocity = [{speed}, 0.0, 0.0]\n\
         [grains.b]\nmaterial = 'm'\nradius = 1.0\nposition = [{half}, {offset}, 0.1]\nvelocity = [{}, 0.0, 0.0]\n\
         [output]\nevery = {}\n[probes]\na.grain = 'a'\nb.grain = 'b'\nall.system = true\nc.contact = ['a', 'b']\n",
        -half,
        -offset,
        -speed,
        rest / 250.0
    )
}

fn momentum_drift(record: &Record) -> f64 {
    let columns = ["x", "y", "z"].map(|axis| column(record, &format!("all.momentum_{axis}")));
    let size = |at: usize| columns.iter().map(|column| column[at] * column[at]).sum::<f64>().sqrt();
    (0..columns[0].len()).map(size).fold(0.0, f64::max) / (4.0 / 3.0 * std::f64::consts::PI * SPEED)
}

/// In a head-on collision without friction, momentum is conserved to rounding, and no rotation starts. Springs return
/// their energy. Quadratic functions dissipate energy at four cells per radius.
#[test]
fn spheres_rebound() {
    for (solver, energies, restitutions) in [
        ("mpm:penalty", 0.99..1.01, 0.97..1.005),
        ("mpm", 0.94..1.01, 0.87..1.005),
        ("mpm:gap", 0.96..1.005, 0.93..1.005),
    ] {
        let record = run(solver, &collision(0.1, 0.0, 0.0, SPEED, 5.0), 4.0, 2);
        assert!(energies.contains(&energy(&record)), "{solver}: {}", energy(&record));
        let restitution = -last(&record, "a.vx") / SPEED;
        assert!(restitutions.contains(&restitution), "{solver}: {restitution}");
        assert!(momentum_drift(&record) < 1e-12, "{solver}: {}", momentum_drift(&record));
        assert!(last(&record, "a.omega_z").abs() < 1e-12 * SPEED, "{solver}");
    }
}

/// The 2001 criterion along each body's own normal does not conserve momentum.
#[test]
fn own_normals_do_not_keep_momentum_in_space() {
    let record = run("mpm:2001", &collision(0.1, 0.0, 0.0, SPEED, 5.0), 4.0, 2);
    assert!(momentum_drift(&record) > 1e-3, "{}", momentum_drift(&record));
}

/// In an off-centre collision, spheres hardly rotate without friction. With friction both rotate alike.
#[test]
fn friction_turns_spheres() {
    let smooth = run("mpm", &collision(0.1, 0.0, 0.5, SPEED, 5.0), 4.0, 2);
    assert!(last(&smooth, "a.omega_z").abs() < 0.04 * SPEED, "{}", last(&smooth, "a.omega_z") / SPEED);
    let rough = run("mpm", &collision(0.1, 0.2, 0.5, SPEED, 5.0), 4.0, 2);
    let spins = [last(&rough, "a.omega_z"), last(&rough, "b.omega_z")].map(|spin| spin / SPEED);
    assert!((spins[0] - spins[1]).abs() < 1e-9 && (0.5..0.62).contains(&spins[0]), "{spins:?}");
    assert!(momentum_drift(&rough) < 1e-12 && energy(&rough) < energy(&smooth));
}

/// In slow collisions waves cross the spheres many times. The contact time is then that of Hertz, 2.94 δ/v, with δ =
/// (15 m v²/(16 E* √R))^(2/5) (Johnson, Contact Mechanics, §11.4). Here m and R are half of a sphere's mass and radius,
/// E* = E/(2 (1 − ν²)) with E = 15 and ν = 1/4, and v is the approach velocity.
#[test]
fn slow_spheres_touch_for_hertz_time() {
    let touch = |softer: f64| {
        let speed = SPEED / 4.0;
        let approach = 2.0 * speed;
        let (mass, radius, modulus) = (2.0 * std::f64::consts::PI / 3.0, 0.5_f64, 8.0);
        let approached = (15.0 * mass * approach.powi(2) / (16.0 * modulus * radius.sqrt())).powf(0.4);
        let time = 2.94 * approached / approach;
        let moduli = format!("bulk_modulus = {}, shear_modulus = {}", 10.0 * softer, 6.0 * softer);
        let text = collision(0.02 * approached, 0.0, 0.0, speed, 1.4 * time)
            .replace("bulk_modulus = 10.0, shear_modulus = 6.0", &moduli);
        let record = run("mpm", &text, 8.0, 2);
        let force = column(&record, "c.normal_force");
        let mut touching =
            record.series.time.iter().zip(force).filter(|(_, force)| **force > 0.0).map(|(time, _)| *time);
        let first = touching.next().unwrap();
        (touching.next_back().unwrap() - first) / time
    };
    let slow = touch(1.0);
    assert!((slow - 1.0).abs() < 0.01, "{slow}");
    let soft = touch(0.8);
    assert!(soft > 1.06, "a fifth softer: {soft}");
}
