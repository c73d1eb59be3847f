//! Rotating contacts, rotating walls and changing stiffness, compared with exact solutions in the rotating frame.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use grainbench_dem::convention::Convention;
use grainbench_dem::solver::Dem;
use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::failure::{Cause, RunError};
use grainbench_solver::observer::RunOptions;
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;
use std::f64::consts::TAU;
use support::{column, last};

fn scene(text: &str) -> Scene {
    support::scene(&format!("title = 'test'\n{text}")).unwrap()
}

fn run(text: &str, fraction: f64) -> Record {
    Dem::new(Convention::DEFAULT).run(&scene(text), &Resolution::CriticalFraction(fraction), &mut ()).unwrap()
}

/// Returns the angle (rad) by which a grain named `b` moves around the z axis.
fn way_round(record: &Record) -> f64 {
    let angles: Vec<f64> = column(record, "b.y").iter().zip(column(record, "b.x")).map(|(y, x)| y.atan2(*x)).collect();
    angles.windows(2).map(|pair| (pair[1] - pair[0] + TAU + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU).sum()
}

/// Returns the scene of a sphere of mass m = ρ 4πR³/3 that sticks to the wall of a drum of radius D = 1.1 m rotating at
/// Ω = 10 rad/s. The sphere orbits at Ω with the spin Ω. Its contact force is m Ω² (D − R + δ) = k_n δ. It does not
/// roll relative to the wall, so rolling resistance does not act.
fn drum() -> String {
    let (mass, stiffness) = (2500.0 * 4.0 / 3.0 * 0.5 * TAU * 1e-3, 1.0e7);
    let place = 1.0 / (1.0 - mass * 100.0 / stiffness);
    format!(
        "dimension = 3\nduration = 0.6283185307179586\nmaterials.m.density = 2500.0\n\
         contacts.c = {{ between = ['m', 'm'], normal_stiffness = {stiffness}, tangential_stiffness = 2857142.857142857, \
         friction = 1.0, rolling_friction = 0.1 }}\n\
         grains.b = {{ material = 'm', radius = 0.1, position = [{place}, 0.0, 0.0], velocity = [0.0, {speed}, 0.0], \
         spin = [0.0, 0.0, 10.0] }}\n\
         [walls.drum]\nmaterial = 'm'\ncylinder = {{ axis = [[0.0, 0.0, -5.0], [0.0, 0.0, 5.0]], radius = 1.1 }}\n\
         motion = [{{ spin = [0.0, 0.0, 10.0], centre = [0.0, 0.0, 0.0] }}]\n\
         [output]\nevery = 0.0031415926535897933\n[probes]\nb = {{ grain = 'b' }}\n",
        speed = 10.0 * place
    )
}

/// Friction acts at the distance R from the centre of the sphere, which is δ beyond the wall. The angle of the orbit thus
/// has a relative error of δ/R. The spin has an error of 2δ/R of Ω, because the rolling spring oscillates due to the
/// initial error. If the rolling stage ignores the wall's spin, as in LAMMPS, the angle is too large by more than 3 %.
#[test]
fn a_sphere_rides_on_the_wall_of_a_turning_drum() {
    let mass = 2500.0 * 4.0 / 3.0 * 0.5 * TAU * 1e-3;
    let off = mass * 100.0 / 1.0e7 / 0.1;
    for fraction in [0.1, 0.025] {
        let record = run(&drum(), fraction);
        let missing = way_round(&record) / TAU - 1.0;
        assert!(missing.abs() < off, "{missing:e} of a turn, allowed {off:e}");
        let spin = last(&record, "b.omega_z");
        assert!((spin / 10.0 - 1.0).abs() < 2.0 * off, "{spin}");
    }
    // LAMMPS and LIGGGHTS use only the spin of the grain, so rolling resistance acts against this spin.
    let lammps = Dem::new(Convention::LAMMPS);
    let record = lammps.run(&scene(&drum()), &Resolution::CriticalFraction(0.1), &mut ()).unwrap();
    assert!(way_round(&record) / TAU - 1.0 > 0.03, "{}", way_round(&record));
}

/// A tray under a disc is tilted by .1 rad, less than the .2 rad that rolling resistance supports. Relative to the
/// tray, the disc moves only by the displacement of its springs, F/k_t + R M/k_r, with the force F < .1 m g and the
/// moment M < .1 m g R.
#[test]
fn a_disc_stays_on_a_tray_that_is_tilted() {
    let text = "dimension = 2\ngravity = [0.0, -9.81]\nduration = 1.0\nmaterials.m.density = 2500.0\n\
         contacts.c = { between = ['m', 'm'], normal_stiffness = 1.0e7, tangential_stiffness = 2857142.857142857, \
         friction = 1.0, normal_damping = 50.0, tangential_damping = 50.0, rolling_friction = 0.2, rolling_damping = 0.3 }\n\
         grains.d = { material = 'm', radius = 0.1, position = [0.0, 0.09992295244017071] }\n\
         walls.tray = { material = 'm', plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }, \
         motion = [{ spin = -0.1, centre = [0.0, 0.0] }] }\n[output]\nevery = 0.01\n[probes]\nd = { grain = 'd' }\n";
    let record = run(text, 0.1);
    let (sine, cosine) = (-0.1_f64).sin_cos();
    let along = last(&record, "d.x") * cosine + last(&record, "d.y") * sine;
    let (mass, force) = (2500.0 * 0.5 * TAU * 0.01, 2500.0 * 0.5 * TAU * 0.01 * 9.81 * 0.1);
    let rolling = 2.25 * 1.0e7 * 0.2 * 0.2 * 0.01;
    let springs = force / 2_857_142.857 + force * 0.1 / rolling * 0.1;
    // The allowed displacement is twice the static displacement, because of the initial motion, plus the effect of the
    // centrifugal and Coriolis forces of .1 rad/s.
    let allowed = 2.0 * springs + mass * 0.01 * 0.1 / 2_857_142.857;
    assert!(along.abs() < allowed, "{along:e} m along the tray, allowed {allowed:e}; R θ is .01 m");
}

/// A Hertz contact is sheared by s = 5 µm at an overlap δ of 50 µm and then pressed to 100 µm, or sheared at 100 µm and then
/// relieved to 50 µm. The force is F = k_t(50 µm) s at the end of both motions. Mindlin's k_t is 8 G* √(R δ) (N/m) with G* =
/// G/(2 (2 − ν)) and G = E/(2 (1 + ν)), for two bodies of E = 10 MPa and ν = .25. The conformance property `passivity` tests
/// that the closed cycles of both motions yield no work.
#[test]
fn a_sheared_hertz_contact_has_the_force_of_its_smaller_overlap() {
    let expected = 8.0 * (1.0e7 / 2.5) / (2.0 * 1.75) * (0.005 * 5.0e-5_f64).sqrt() * 5.0e-6;
    for [first, second] in [["5.0e-5", "1.0e-4"], ["1.0e-4", "5.0e-5"]] {
        let text = format!(
            "dimension = 3\nduration = 0.03\nmaterials.glass = {{ density = 2500.0, young_modulus = 1.0e7, \
             poisson_ratio = 0.25 }}\n\
             contacts.one = {{ between = ['glass', 'glass'], law = 'hertz', friction = 0.5 }}\n\
             grains.ball = {{ material = 'glass', radius = 0.005, position = [0.0, 0.0, 0.005] }}\n\
             driven.ball = {{ grains = 'ball', motion = [{{ table = [[0.0, 0.0, 0.0, 0.0], [0.01, 0.0, 0.0, -{first}], \
             [0.02, 5.0e-6, 0.0, -{first}], [0.03, 5.0e-6, 0.0, -{second}]] }}] }}\n\
             walls.floor = {{ material = 'glass', plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }} }}\n\
             [output]\nevery_cycles = 1\n[probes]\ntouch = {{ contact = ['ball', 'floor'] }}\n"
        );
        let force = last(&run(&text, 0.1), "touch.shear_force").abs();
        assert!((force - expected).abs() < 1e-3 * expected, "{force} N for {expected}");
    }
}

/// A sphere bounces between two plates with Hertz and Mindlin contacts that slip. Its loss of energy is the frictional work
/// plus the energy that the receding edge of the contact releases. An impact begins and ends between two evaluations. The
/// energy therefore scatters by (ω Δt)², with ω Δt = 2 · fraction. The conformance property `passivity` tests that the
/// energy never grows, with and without slip.
#[test]
fn the_loss_of_hertz_and_mindlin_contacts_is_in_the_budget() {
    let text = "dimension = 3\nduration = 3.0\nmaterials.m = { density = 2500.0, young_modulus = 1.0e9, poisson_ratio = 0.3 }\n\
         contacts.c = { between = ['m', 'm'], law = 'hertz', friction = 1.0 }\n\
         grains.b = { material = 'm', radius = 0.1, position = [0.0, 0.0, 0.11], velocity = [0.5, 0.0, -1.0] }\n\
         walls.low = { material = 'm', plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] } }\n\
         walls.high = { material = 'm', plane = { point = [0.0, 0.0, 0.22], normal = [0.0, 0.0, -1.0] } }\n\
         [output]\nevery = 0.001\n[probes]\nbudget = { budget = true }\n";
    let error = |fraction: f64| {
        let record = run(text, fraction);
        let unbalanced = column(&record, "budget.unbalanced");
        unbalanced.iter().map(|value| (value / unbalanced[0] - 1.0).abs()).fold(0.0, f64::max)
    };
    let [coarse, fine] = [0.1, 0.05].map(error);
    assert!(fine < 0.35 * coarse, "the budget converges: {coarse}, {fine}");
}

/// A sphere hits a wall obliquely. The tangential dashpot alone exceeds the Coulomb limit. The sphere slides throughout
/// and loses μ (1 + e) v_n = 1 m/s of its 4 m/s, for any dashpot. The spring never accelerates it.
#[test]
fn an_overdamped_contact_slides_as_any_other() {
    for damping in [20_000.0, 5000.0, 0.0] {
        let text = format!(
            "dimension = 3\nduration = 0.004\nmaterials.glass.density = 2500.0\n\
             contacts.wall = {{ between = ['glass', 'glass'], normal_stiffness = 2.0e5, \
             tangential_stiffness = 57142.857142857, friction = 0.5, tangential_damping = {damping} }}\n\
             grains.ball = {{ material = 'glass', radius = 0.005, position = [0.0, 0.0, 0.0051], velocity = [4.0, 0.0, -1.0] }}\n\
             walls.floor = {{ material = 'glass', plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }} }}\n\
             [probes]\nball = {{ grain = 'ball' }}\n"
        );
        let record = run(&text, 0.01);
        let (along, up) = (last(&record, "ball.vx"), last(&record, "ball.vz"));
        // Friction is μ F_n at every step except the first, in which the spring displacement starts to grow.
        assert!((4.0 - along - 0.5 * (1.0 + up)).abs() < 1e-3, "γ_t = {damping}: {along}, {up}");
        assert!((up - 1.0).abs() < 0.01 && (along - 3.0).abs() < 0.01, "γ_t = {damping}: {along}, {up}");
    }
}

/// In an oblique impact with e = .6 that sticks, the contact lasts t_c = 2 acos ζ/(ω_n √(1 − ζ²)). During this time,
/// the tangential spring is an oscillator with ω_t² = 3 k_t/m: v_x = v_0 [1 − (1 − cos ω_t t_c)/3], with the spin 2
/// (v_0 − v_x)/R. The normal rebound velocity is e times the impact velocity. If the contact slides instead, the disc
/// loses the velocity μ (1 + e) v_n.
#[test]
fn damped_impacts_stick_and_slide_as_their_closed_forms() {
    let text = |friction: f64| {
        format!(
            "dimension = 2\nduration = 0.018\nmaterials.m.density = 2500.0\n\
             contacts.c = {{ between = ['m', 'm'], normal_stiffness = 1.0e7, tangential_stiffness = 2857142.857142857, \
             friction = {friction}, restitution = 0.6 }}\n\
             grains.b = {{ material = 'm', radius = 0.1, position = [0.0, 0.1001], velocity = [0.5, -1.0] }}\n\
             walls.w = {{ material = 'm', plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }} }}\n\
             [probes]\nb = {{ grain = 'b' }}\n"
        )
    };
    let mass = 2500.0 * 0.5 * TAU * 0.01;
    // ζ with exp(−2ζ acos ζ/√(1 − ζ²)) = .6, computed separately: .180 858.
    let ratio = 0.180_858_308_f64;
    let root = (1.0 - ratio * ratio).sqrt();
    assert!(((-2.0 * ratio * ratio.acos() / root).exp() - 0.6).abs() < 1e-5);
    let lasts = 2.0 * ratio.acos() / (root * (1.0e7 / mass).sqrt());
    let swings = (3.0 * 2_857_142.857 / mass).sqrt();
    let expected = 0.5 * (1.0 - (1.0 - (swings * lasts).cos()) / 3.0);
    let errors = [0.02, 0.0025].map(|fraction| {
        let record = run(&text(1.0e6), fraction);
        let (along, spin) = (last(&record, "b.vx"), last(&record, "b.omega"));
        assert!((spin.abs() - 2.0 * (0.5 - along) / 0.1).abs() < 1e-9, "{spin}");
        [along - expected, last(&record, "b.vy") - 0.6]
    });
    // The error is of first order in the step, because the dashpot lags by half a step and the contact begins between
    // two evaluations.
    assert!(errors[0].iter().all(|error| error.abs() < 0.02), "{errors:?}");
    assert!(errors[1].iter().all(|error| error.abs() < 0.0025), "{errors:?}");
    // At the start, the normal dashpot acts while the tangential spring is not yet displaced, so friction is below its
    // limit. The spring force k_t v_t t must first reach the limit μ (k v t + c v). This reduces the loss by 2ζ²/(ρ −
    // 1) of μ m v with ρ = k_t v_t/(μ k v).
    let friction = 0.05;
    let steepness = 2_857_142.857 * 0.5 / (friction * 1.0e7);
    let record = run(&text(friction), 0.0025);
    let lost = friction * (1.0 + last(&record, "b.vy") - 2.0 * ratio * ratio / (steepness - 1.0));
    let found = 0.5 - last(&record, "b.vx");
    assert!((found - lost).abs() < 0.0025 * lost, "{found} for {lost}");
}

/// A ball rests on a ball with prescribed motion, which counts as infinitely heavy. The run must end with an error if
/// the time step exceeds the critical time step of the free ball. With R* = R/2 and δ = R/25, the contact is √2 times
/// as stiff as in the critical time step of the scene.
#[test]
fn a_contact_is_as_stiff_as_its_lighter_grain_bears() {
    let modulus = 1.0e7 / (2.0 * (1.0 - 0.09));
    let (mass, overlap) = (2500.0 * 4.0 / 3.0 * 0.5 * TAU * 1e-3, 0.004_f64);
    let gravity = 4.0 / 3.0 * modulus * 0.05_f64.sqrt() * overlap.powf(1.5) / mass;
    let scene = scene(&format!(
        "dimension = 3\nduration = 0.1\ngravity = [0.0, 0.0, -{gravity}]\n\
         materials.m = {{ density = 2500.0, young_modulus = 1.0e7, poisson_ratio = 0.3 }}\n\
         contacts.c = {{ between = ['m', 'm'], law = 'hertz' }}\n\
         grains.held = {{ material = 'm', radius = 0.1, position = [0.0, 0.0, 0.0] }}\n\
         grains.b = {{ material = 'm', radius = 0.1, position = [0.0, 0.0, 0.196] }}\ndriven.held = {{ grains = 'held' }}\n"
    ));
    let dem = Dem::new(Convention::DEFAULT);
    for (fraction, is_refused) in [(0.95, true), (0.8, false)] {
        let end = dem.run(&scene, &Resolution::CriticalFraction(fraction), &mut ());
        let broke = matches!(&end, Err(RunError::Broken(broken)) if matches!(broken.cause, Cause::StiffContact { .. }));
        assert_eq!(broke, is_refused, "{fraction}");
    }
}

/// If a Hertz contact stiffens until its critical time step is below the time step, the run ends with the error
/// `StiffContact`. The error names the time, the grain and a suitable step. The run continues if unstable steps are
/// allowed. The critical time step of a scene is computed for an overlap of R/100. Here a ball rests with an overlap of
/// R/50, where the contact is √2 times as stiff.
#[test]
fn a_contact_that_stiffens_beyond_the_step_is_refused() {
    let modulus = 1.0e7 / (2.0 * (1.0 - 0.09));
    let (mass, overlap) = (2500.0 * 4.0 / 3.0 * 0.5 * TAU * 1e-3, 0.002_f64);
    let gravity = 4.0 / 3.0 * modulus * 0.1_f64.sqrt() * overlap.powf(1.5) / mass;
    let scene = scene(&format!(
        "dimension = 3\nduration = 0.1\ngravity = [0.0, 0.0, -{gravity}]\n\
         materials.m = {{ density = 2500.0, young_modulus = 1.0e7, poisson_ratio = 0.3 }}\n\
         contacts.c = {{ between = ['m', 'm'], law = 'hertz' }}\n\
         grains.b = {{ material = 'm', radius = 0.1, position = [0.0, 0.0, 0.098] }}\n\
         walls.low = {{ material = 'm', plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }} }}\n\
         [probes]\nall = {{ system = true }}\n"
    ));
    let run = |fraction: f64, mut options: RunOptions| {
        Dem::new(Convention::DEFAULT).run(&scene, &Resolution::CriticalFraction(fraction), &mut options)
    };
    let RunError::Broken(broken) = run(0.95, RunOptions::DEFAULT).unwrap_err() else {
        panic!("expected a run that broke")
    };
    let Cause::StiffContact { stiffness } = broken.cause else { panic!("{broken}") };
    let expected = 2.0 * modulus * (0.1 * overlap).sqrt();
    assert!((stiffness / expected - 1.0).abs() < 1e-9 && broken.step == 1, "{broken}");
    assert!((broken.critical / (2.0 * (mass / stiffness).sqrt()) - 1.0).abs() < 1e-12);
    assert!(broken.to_string().contains("became so stiff"), "{broken}");
    run(0.5, RunOptions::DEFAULT).unwrap();
    let goes_on = run(0.95, RunOptions::unstable());
    assert!(!goes_on.is_err_and(|error| error.to_string().contains("became so stiff")));
}
