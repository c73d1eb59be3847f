//! Tests of one body without contact: flight, rotation, vibration, manufactured motion and failures.

use crate::support::{column, last, run, scene, try_run};
use grainbench_mpm::options::{Basis, Setting, StressUpdate, Transfer};
use grainbench_scene::manufactured::Medium;
use grainbench_solver::failure::{Cause, RunError};
use grainbench_solver::resolution::Resolution;

/// A spinning disc or sphere falls freely. The fall is exact to rounding, and the spin is conserved.
#[test]
fn free_flight_keeps_momentum() {
    for (dimension, position, velocity, spin, gravity, cells) in [
        (2, "[0.0, 3.0]", "[0.5, 0.2]", "0.3", "[0.0, -0.1]", 6.0),
        (3, "[0.0, 0.0, 3.0]", "[0.5, 0.2, 0.0]", "[0.1, 0.2, 0.3]", "[0.0, 0.0, -0.1]", 3.0),
    ] {
        let text = format!(
            "dimension = {dimension}\nduration = 1.0\ngravity = {gravity}\n\
             materials.m = {{ density = 1.0, bulk_modulus = 10.0, shear_modulus = 6.0 }}\n\
             [grains.g]\nmaterial = 'm'\nradius = 1.0\nposition = {position}\nvelocity = {velocity}\nspin = {spin}\n\
             [probes]\ng.grain = 'g'\nall.system = true\n"
        );
        let record = run("mpm", &text, cells, 2);
        assert!((last(&record, "g.x") - 0.5).abs() < 1e-12);
        let (height, spin) = if dimension == 2 { ("g.y", "g.omega") } else { ("g.z", "g.omega_z") };
        let fallen = 3.0 + if dimension == 2 { 0.2 } else { 0.0 } - 0.05;
        assert!((last(&record, height) - fallen).abs() < 1e-12, "{}", last(&record, height));
        let spins = column(&record, spin);
        assert!((spins[0] - 0.3).abs() < 1e-12);
        // Lumped mass spreads a body over its nodes, so the spin is conserved only to second order in the cell size.
        assert!((last(&record, spin) / 0.3 - 1.0).abs() < 5e-3, "{}", last(&record, spin));
        if dimension == 2 {
            assert!((last(&record, "g.angle") - 0.3).abs() < 2e-3, "{}", last(&record, "g.angle"));
        }
    }
}

/// A shift of the grid by a part of a cell acts like the opposite shift of the body. The cell has a length of 1/6 m.
#[test]
fn a_shifted_grid_is_a_shifted_body() {
    let spin = |phase: [f64; 3], shift: [f64; 2]| {
        let text = format!(
            "dimension = 2\nduration = 1.0\nmaterials.m = {{ density = 1.0, bulk_modulus = 10.0, shear_modulus = 6.0 }}\n\
             [grains.g]\nmaterial = 'm'\nradius = 1.0\nposition = {shift:?}\nspin = 0.3\n[probes]\ng.grain = 'g'\n"
        );
        let record = try_run("mpm", |setting| setting.phase = phase, &text, Resolution::grid(6.0, 2)).unwrap();
        last(&record, "g.omega")
    };
    let (phase, shift) = ([0.3, 0.7, 0.0], [-0.3 / 6.0, -0.7 / 6.0]);
    let (moved, shifted, plain) = (spin([0.0; 3], shift), spin(phase, [0.0; 2]), spin([0.0; 3], [0.0; 2]));
    assert!((shifted - moved).abs() < 1e-12, "{shifted}, {moved}");
    assert!((shifted - plain).abs() > 1e-9, "{shifted}, {plain}");
}

/// Points rotate with their body, also beyond a full turn, and are contained in the requested snapshots.
#[test]
fn points_turn_with_their_body() {
    let text = "dimension = 2\nduration = 1.0\n\
        materials.m = { density = 1.0, bulk_modulus = 1e5, shear_modulus = 6e4 }\n\
        [grains.g]\nmaterial = 'm'\nradius = 1.0\nposition = [0.0, 0.0]\nspin = 8.0\n\
        [output]\nsnapshot_times = [0.25, 0.1]\n";
    let record = run("mpm", text, 4.0, 2);
    let times: Vec<f64> = record.snapshots.iter().map(|snapshot| snapshot.time).collect();
    assert_eq!(times.len(), 4);
    for (time, wanted) in times.iter().zip([0.0, 0.1, 0.25, 1.0]) {
        assert!((time - wanted).abs() < record.provenance.time_step, "{times:?}");
    }
    for snapshot in &record.snapshots {
        let angle = snapshot.grains[0].angle.unwrap();
        assert!((angle - 8.0 * snapshot.time).abs() < 0.05 * (1.0 + snapshot.time), "{angle} at {} s", snapshot.time);
        assert!(snapshot.points.iter().all(|point| (point.rotation - angle).abs() < 0.02), "{angle}");
    }
}

/// A bar with one fixed and one free end and ν = 0 has the period 10 s and the mean velocity .063662 cos ωt (exact).
#[test]
fn a_bar_vibrates_at_its_period() {
    let text = "dimension = 2\nduration = 10.0\nreference_length = 25.0\n\
        materials.m = { density = 1.0, young_modulus = 100.0, poisson_ratio = 0.0, constitutive = 'hypoelastic' }\n\
        [bodies.b]\nmaterial = 'm'\nbox = { low = [0.3, 0.1], high = [25.3, 2.1] }\nfixed = ['x-low']\n\
        wave = { amplitude = 0.1 }\n[probes]\nb.body = 'b'\nall.system = true\n\
        p.point = { body = 'b', at = [25.3, 1.1] }\n";
    let quadratic = |setting: &mut Setting| {
        setting.basis = Basis::Quadratic;
        setting.transfer = Transfer::Flip { pic: 0.0 };
    };
    let record = try_run("mpm", quadratic, text, Resolution::grid(25.0, 2)).unwrap();
    let velocity = column(&record, "b.vx");
    assert!((velocity[0] / 0.063_662 - 1.0).abs() < 1e-4);
    let crossings: Vec<f64> = (1..velocity.len())
        .filter(|&at| velocity[at - 1] * velocity[at] < 0.0)
        .map(|at| {
            let time = &record.series.time;
            let part = velocity[at - 1] / (velocity[at - 1] - velocity[at]);
            time[at - 1] + (time[at] - time[at - 1]) * part
        })
        .collect();
    assert!((2.0 * (crossings[1] - crossings[0]) / 10.0 - 1.0).abs() < 2e-3, "{crossings:?}");
    let energy = column(&record, "all.total_energy");
    assert!(energy.iter().all(|now| (now / energy[0] - 1.0).abs() < 5e-3));
    // The amplitude of the free end is v₀/ω.
    let swing = column(&record, "p.ux").iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    assert!((swing / (0.1 * 10.0 / std::f64::consts::TAU) - 1.0).abs() < 0.02, "{swing}");
}

/// Returns the root mean square error in displacement of a manufactured motion.
fn manufactured_error(basis: Basis, cells: f64, points: u32) -> f64 {
    let text = "dimension = 2\nduration = 0.5\nreference_length = 1.0\n\
        manufactured = { axis-aligned = { amplitude = 0.05 } }\n\
        domain = { low = [0.0, 0.0], high = [1.0, 1.0], periodic = [true, true] }\n\
        materials.m = { density = 1000.0, young_modulus = 1000.0, poisson_ratio = 0.3 }\n\
        [bodies.b]\nmaterial = 'm'\nbox = { low = [0.0, 0.0], high = [1.0, 1.0] }\n";
    let flip = |setting: &mut Setting| {
        setting.basis = basis;
        setting.transfer = Transfer::Flip { pic: 0.0 };
    };
    let record = try_run("mpm", flip, text, Resolution::grid(cells, points)).unwrap();
    let scene = scene(text);
    let material = scene.deformable[0].unwrap();
    let medium = Medium { density: 1000.0, lame: material.lame(), shear_modulus: material.shear_modulus };
    let motion = scene.start.manufactured.unwrap();
    let snapshot = record.snapshots.last().unwrap();
    let (sum, volume) = snapshot.points.iter().fold((0.0, 0.0), |(sum, volume), point| {
        let exact = motion.displacement(&medium, point.position - point.displacement, snapshot.time);
        (sum + (point.displacement - exact).norm_squared() * point.volume, volume + point.volume)
    });
    (sum / volume).sqrt()
}

/// GIMP converges at second order. Hat functions stagnate because points cross cells.
#[test]
fn manufactured_motion_converges_at_second_order() {
    let order = |basis, points| {
        (manufactured_error(basis, 16.0, points) / manufactured_error(basis, 64.0, points)).log2() / 2.0
    };
    let gimp = order(Basis::Gimp, 2);
    assert!(gimp > 1.88, "{gimp}");
    let hats = order(Basis::Linear, 2);
    assert!(hats < 0.5, "{hats}");
    let splines =
        (manufactured_error(Basis::Quadratic, 8.0, 4) / manufactured_error(Basis::Quadratic, 32.0, 4)).log2() / 2.0;
    assert!(splines > 1.55, "{splines}");
}

/// A run with hat functions and the stress updated last fails, with an error that names the cause.
#[test]
fn hats_with_stress_last_break_typed() {
    let last = |setting: &mut Setting| setting.stress_update = StressUpdate::Last;
    let at = Resolution::grid(4.0, 3);
    let error = try_run("mpm:penalty", last, &crate::support::incline(60.0, 0.3, 1.0, false), at).unwrap_err();
    let RunError::Broken(broken) = error else { panic!("{error}") };
    let typed = matches!(
        broken.cause,
        Cause::LeftCell { .. }
            | Cause::Inverted { .. }
            | Cause::CollapsedCell { .. }
            | Cause::NotFinite
            | Cause::GainedEnergy { .. }
    );
    assert!(typed && broken.step < 2000, "{broken}");
}

/// Unsupported scenes and invalid resolutions are rejected with a reason.
#[test]
fn what_cannot_be_run_is_refused() {
    let bare = "dimension = 2\nduration = 1.0\nmaterials.m.density = 1.0\n\
        [grains.g]\nmaterial = 'm'\nradius = 1.0\nposition = [0.0, 0.0]\n";
    let refused = |text: &str, at| try_run("mpm", |_| (), text, at).unwrap_err();
    assert!(matches!(refused(bare, Resolution::grid(4.0, 2)), RunError::Unsupported { .. }));
    let incline = crate::support::incline(30.0, 0.5, 1.0, true);
    assert!(matches!(refused(&incline, Resolution::TimeStep(1e-3)), RunError::Resolution { .. }));
    assert!(matches!(refused(&incline, Resolution::grid(f64::NAN, 2)), RunError::Resolution { .. }));
}

/// A thin ring has an initial stretch rate a and spin ω. Its kinetic energy is ½ρ(a² + ω²) π/2 (R⁴ − r⁴), and its
/// angular momentum ρω π/2 (R⁴ − r⁴). With stretch alone it vibrates with the squared angular frequency E/ρR². After an
/// eighth of the period, half of the energy is elastic.
#[test]
fn a_ring_expands_and_turns_back() {
    let ring = |more: &str, duration: f64| {
        let text = format!(
            "dimension = 2\nduration = {duration:e}\n\
             materials.m = {{ density = 1.0, young_modulus = 100.0, poisson_ratio = 0.0 }}\n\
             [bodies.ring]\nmaterial = 'm'\nannulus = {{ centre = [1.0, 2.0], inner = 0.95, outer = 1.05 }}\n{more}\n\
             [output]\nevery = {duration:e}\n[probes]\nall.system = true\n"
        );
        run("mpm", &text, 4.0, 2)
    };
    let second_moment = std::f64::consts::FRAC_PI_2 * (1.05_f64.powi(4) - 0.95_f64.powi(4));
    let eighth = std::f64::consts::FRAC_PI_4 / 10.0;
    let both = ring("stretch = [0.01, 0.01]\nspin = 0.02", eighth);
    for (name, expected) in [
        ("all.kinetic_energy", 0.5 * 1e-4 * second_moment),
        ("all.rotational_energy", 0.5 * 4e-4 * second_moment),
        ("all.angular_momentum", 0.02 * second_moment),
    ] {
        let found = column(&both, name)[0];
        assert!((found / expected - 1.0).abs() < 0.01, "{name}: {found} for {expected}");
    }
    let breathing = ring("stretch = [0.01, 0.01]", eighth);
    let energies = column(&breathing, "all.kinetic_energy");
    assert!((energies[0] / (0.5 * 1e-4 * second_moment) - 1.0).abs() < 0.01, "{energies:?}");
    let left = last(&breathing, "all.kinetic_energy") / energies[0];
    assert!((left - 0.5).abs() < 0.01, "{left}");
}
