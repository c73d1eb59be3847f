//! Tests of rapier with known solutions, and of the causes of its errors. Scenes that it cannot run are in
//! `tests/refusals/rigid.toml`.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use grainbench_rigid::settings::Settings;
use grainbench_rigid::solver::Rigid;
use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::failure::{Cause, RunError};
use grainbench_solver::record::{Cost, Partner, Record};
use grainbench_solver::resolution::Resolution;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

fn scene(text: &str) -> Scene {
    Scene::from_text("test", text).unwrap()
}

fn run(scene: &Scene, substeps: u32) -> Record {
    Rigid::new().run(scene, &Resolution::substeps(substeps), &mut ()).unwrap()
}

fn last(record: &Record, column: &str) -> f64 {
    *record.series.column(column).unwrap().last().unwrap()
}

const GRAIN: &str = include_str!("scenes/grain.toml");

/// Returns a disc at rest on a plane, with gravity tilted by an angle.
fn slope(angle_deg: f64, friction: f64) -> Scene {
    let plane = "[walls.plane]\nmaterial = \"m\"\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n";
    let mut scene = scene(&format!("{GRAIN}{plane}"));
    let (sine, cosine) = angle_deg.to_radians().sin_cos();
    scene.gravity = Vector3::new(9.8 * sine, -9.8 * cosine, 0.0);
    // A damping ratio of ½, with a coefficient of restitution e = exp(−acos ½/√¾) = .30.
    let damping = (1e6 / scene.grains[0].mass).sqrt();
    scene.change_laws(|law| (law.friction, law.normal_damping) = (friction, damping));
    scene.duration = grainbench_scene::scene::Duration::Seconds(1.0);
    scene
}

#[test]
fn free_flight_is_symplectic_euler() {
    let mut scene = scene(GRAIN);
    scene.gravity = Vector3::new(0.0, -9.8, 0.0);
    scene.grains[0].velocity = Vector3::new(1.0, 2.0, 0.0);
    scene.grains[0].spin.z = 3.0;
    let mut errors = Vec::new();
    for substeps in [2, 4, 8] {
        let record = run(&scene, substeps);
        assert!((last(&record, "g.vy") - (2.0 - 4.9)).abs() < 1e-12);
        assert_eq!(last(&record, "g.omega"), 3.0);
        // In a small step h rapier rotates the grain by atan(Ωh) instead of Ωh.
        assert!((last(&record, "g.angle") - 1.5).abs() < 1e-4);
        assert!((last(&record, "g.x") - 0.5).abs() < 1e-12);
        let small = record.provenance.time_step / f64::from(Resolution::RIGID_ITERATIONS);
        let error = last(&record, "g.y") - (0.5 + 1.0 - 4.9 * 0.25);
        assert!((error + 0.5 * 9.8 * 0.5 * small).abs() < 1e-12, "{error}");
        errors.push(error);
    }
    assert!((errors[0] / errors[1] - 2.0).abs() < 1e-9 && (errors[1] / errors[2] - 2.0).abs() < 1e-9);
}

#[test]
fn whole_turns_are_counted() {
    let mut scene = scene(GRAIN);
    scene.grains[0].spin.z = -50.0;
    assert!((last(&run(&scene, 16), "g.angle") + 25.0).abs() < 0.02);
    // The grain rotates by more than half a turn in a step: in each small step h by atan(Ωh), with Ωh = 1.2.
    let steps = f64::from(Resolution::RIGID_ITERATIONS);
    let step = run(&scene, 1).provenance.time_step;
    scene.grains[0].spin.z = -1.2 * steps / step;
    let turns = -0.5 / step * steps * 1.2_f64.atan();
    assert!(steps * 1.2_f64.atan() > PI && (last(&run(&scene, 1), "g.angle") / turns - 1.0).abs() < 1e-9);
}

#[test]
fn global_damping_decays() {
    let mut scene = scene(GRAIN);
    scene.global_damping = 2.0;
    scene.grains[0].velocity.x = 1.0;
    scene.grains[0].spin.z = 1.0;
    for column in ["g.vx", "g.omega"] {
        let error = |substeps| last(&run(&scene, substeps), column) - (-1.0_f64).exp();
        assert!(error(32).abs() < 3e-4);
        assert!((error(16) / error(32) - 2.0).abs() < 0.01, "first order");
    }
}

const PAIR: &str = include_str!("scenes/pair.toml");

#[test]
fn elastic_impact_exchanges_velocities() {
    for substeps in [1, 3, 8] {
        let record = run(&scene(PAIR), substeps);
        assert!(last(&record, "a.vx").abs() < 1e-12 && (last(&record, "b.vx") - 3.0).abs() < 1e-12);
    }
}

#[test]
fn restitution_is_that_of_each_pair() {
    // The masses differ, so pairs of these kinds of grains have no common coefficient and each pair must use its own.
    let mut scene = scene(PAIR);
    scene.grains[1].mass *= 3.0;
    scene.change_laws(|law| law.normal_damping = 20.0);
    let (a, b) = (scene.grains[0].mass, scene.grains[1].mass);
    let mass = a * b / (a + b);
    let ratio = 20.0 * mass / (2.0 * (1e4 * mass).sqrt());
    let expected = (-2.0 * ratio * ratio.acos() / (1.0 - ratio * ratio).sqrt()).exp();
    scene.walls.clear();
    let record = run(&scene, 4);
    assert!(((last(&record, "b.vx") - last(&record, "a.vx")) / 3.0 - expected).abs() < 1e-12);
    // A third grain of another mass, far away, must not change the result.
    let mut third = scene.grains[0];
    third.position = Vector3::new(0.0, 50.0, 0.0);
    third.mass *= 2.0;
    scene.grains.push(third);
    let record = run(&scene, 4);
    assert!(record.provenance.options.iter().any(|words| words.contains("pair by pair")));
    assert!(((last(&record, "b.vx") - last(&record, "a.vx")) / 3.0 - expected).abs() < 1e-12);
}

#[test]
fn two_impacts_in_one_step_do_not_keep_energy() {
    // Single elastic impacts conserve energy up to rounding errors. Here a disc collides with two discs at once.
    let mut scene = scene(PAIR);
    let mut third = scene.grains[1];
    scene.grains[1].position = Vector3::new(1.0, 1.001, 0.0);
    third.position = Vector3::new(1.0, -1.001, 0.0);
    scene.grains.push(third);
    let energy = |substeps| {
        let record = run(&scene, substeps);
        let energy = record.series.column("all.kinetic_energy").unwrap().to_vec();
        energy[energy.len() - 1] / energy[0] - 1.0
    };
    assert!(energy(4).abs() > 1e-3 && energy(64).abs() > 1e-3);
}

#[test]
fn rolls_and_slides() {
    let cases = [
        (30.0_f64, 0.5, 9.8 * 30_f64.to_radians().sin() * 2.0 / 3.0),
        (60.0, 0.3, 9.8 * (60_f64.to_radians().sin() - 0.3 * 60_f64.to_radians().cos())),
    ];
    for (angle, friction, acceleration) in cases {
        let error = |substeps| last(&run(&slope(angle, friction), substeps), "g.x") / (0.5 * acceleration) - 1.0;
        let (coarse, fine) = (error(4), error(16));
        assert!(coarse < 2e-3 && fine > 0.0 && fine < 0.25 * coarse, "{angle}°: {coarse} {fine}");
    }
}

#[test]
fn contact_forces_are_those_of_the_slope() {
    let record = run(&slope(30.0, 0.5), 16);
    let snapshot = record.snapshots.last().unwrap();
    let contact = snapshot.told_contacts()[0];
    let weight = snapshot.grains[0].mass * 9.8;
    assert_eq!((contact.grain, contact.partner, contact.slipping), (1, Partner::Wall(0), false));
    assert!((contact.normal_force / (weight * 30_f64.to_radians().cos()) - 1.0).abs() < 1e-9);
    // The friction force points up the slope: F = m g_t/3, with the component g_t of gravity along the slope.
    assert!((contact.shear_force.x / (-weight * 30_f64.to_radians().sin() / 3.0) - 1.0).abs() < 1e-3);
    assert!((contact.normal - Vector3::new(0.0, -1.0, 0.0)).norm() < 1e-12);
    assert!((snapshot.walls[0].force.unwrap() + snapshot.grains[0].force.unwrap()).norm() < 1e-9);
    assert!(run(&slope(60.0, 0.3), 16).snapshots.last().unwrap().told_contacts()[0].slipping);
}

/// The overlap at rest is that of a spring with the natural frequency of walls, whatever the time step.
#[test]
fn overlap_at_rest_is_a_setting_of_the_method() {
    let overlap = |frequency: f64, substeps| {
        let settings = Settings { wall_frequency: frequency, ..Settings::default() };
        let record = Rigid::with(settings).run(&slope(0.0, 0.5), &Resolution::substeps(substeps), &mut ()).unwrap();
        0.5 - last(&record, "g.y")
    };
    for (frequency, substeps) in [(60.0, 4), (60.0, 16), (120.0, 4), (120.0, 16)] {
        let expected = 9.8 / (TAU * frequency).powi(2);
        let found = overlap(frequency, substeps);
        assert!((found / expected - 1.0).abs() < 1e-3, "{frequency} Hz, {substeps} substeps: {found} {expected}");
    }
}

/// The contact point is fixed on the grain for a step. For a grain that rotates fast, smaller steps reduce the error,
/// but more iterations do not.
#[test]
fn lift_off_depends_on_the_step_and_not_on_the_iterations() {
    let fall = |substeps, iterations| {
        let resolution = Resolution::Rigid { step: Resolution::RIGID_STEP, substeps, iterations };
        let record = Rigid::new().run(&slope(60.0, 0.3), &resolution, &mut ()).unwrap();
        let exact = 9.8 * (60_f64.to_radians().sin() - 0.3 * 60_f64.to_radians().cos());
        // The missing friction impulse is μ m |v_n|, with the normal velocity v_n at the end.
        let (v, fall) = (last(&record, "g.vx"), last(&record, "g.vy"));
        assert!((v - exact + 0.3 * fall).abs() < 1e-9, "{substeps} {iterations}: {v} {exact} {fall}");
        -fall
    };
    assert!(fall(1, 4) > 1e-2 && fall(1, 64) > 1e-2);
    assert!(fall(16, 4).abs() < 1e-9);
}

/// With an elastic contact (e = 1) a grain that lifts off bounces, so more of the friction impulse is missing than with
/// damping.
#[test]
fn elastic_contacts_bounce_where_others_lift_off() {
    let error = |damping: f64| {
        let mut scene = slope(60.0, 0.3);
        scene.change_laws(|law| law.normal_damping *= damping);
        let exact = 9.8 * (60_f64.to_radians().sin() - 0.3 * 60_f64.to_radians().cos());
        (last(&run(&scene, 1), "g.vx") / exact - 1.0).abs()
    };
    assert!(error(0.0) > 5.0 * error(1.0));
}

#[test]
fn backspin_ends_in_rolling() {
    let mut scene = slope(0.0, 0.5);
    scene.grains[0].spin.z = -10.0;
    let record = run(&scene, 16);
    // Rolling speed v = RΩ/3 from the initial spin Ω.
    assert!((last(&record, "g.vx") / (0.5 * 10.0 / 3.0) - 1.0).abs() < 5e-5);
    assert!((last(&record, "g.omega") / (-10.0 / 3.0) - 1.0).abs() < 2e-4);
}

/// A plane that moves tangentially, like a belt, drags a disc until the slip ends.
#[test]
fn a_moving_wall_drags_a_disc() {
    let mut scene = slope(0.0, 0.5);
    let phase = grainbench_scene::motion::Phase {
        velocity: Vector3::new(1.0, 0.0, 0.0),
        spin: Vector3::zeros(),
        start: grainbench_scene::motion::Moment::Seconds(0.0),
        stop: grainbench_scene::motion::Moment::Never,
    };
    scene.walls[0].motion.phases.push(phase);
    // The slip ends when v − ΩR equals the belt speed V. Then v = iV/(1 + i) = V/3, with i = 1/2 for a disc.
    assert!((last(&run(&scene, 16), "g.vx") - 1.0 / 3.0).abs() < 1e-3);
    // A plane that moves along its normal, like a lift, ends at the exact position.
    scene.walls[0].motion.phases[0].velocity = Vector3::new(0.0, 0.5, 0.0);
    let record = run(&scene, 16);
    assert_eq!(record.snapshots.last().unwrap().walls[0].corners[0].y, 0.5);
    assert!((last(&record, "g.y") - 1.0).abs() < 1e-2 && (last(&record, "g.vy") - 0.5).abs() < 1e-2);
}

#[test]
fn finite_walls_are_hit_on_both_sides_and_missed_beside() {
    let flat = |text: &str, y: f64, speed: f64, x: f64| {
        let mut scene = scene(text);
        scene.change_laws(|law| law.friction = 0.0);
        let up = scene.dimension.count() - 1;
        scene.grains[0].position = Vector3::new(x, 0.0, 0.0);
        scene.grains[0].position[up] = y;
        scene.grains[0].velocity[up] = speed;
        let record = run(&scene, 4);
        record.snapshots.last().unwrap().grains[0].velocity[up]
    };
    let segment = format!("{GRAIN}[walls.w]\nmaterial = \"m\"\nsegment = [[-2.0, 0.0], [2.0, 0.0]]\n");
    let rectangle = format!(
        "{}[walls.w]\nmaterial = \"m\"\n\
         rectangle = {{ corner = [-2.0, -2.0, 0.0], edges = [[4.0, 0.0, 0.0], [0.0, 4.0, 0.0]] }}\n",
        GRAIN.replace("dimension = 2", "dimension = 3").replace("[0.0, 0.5]", "[0.0, 0.0, 0.5]")
    );
    for text in [&segment, &rectangle] {
        for x in [0.0, 0.7] {
            assert!((flat(text, 1.0, -3.0, x) - 3.0).abs() < 1e-9);
            assert!((flat(text, -1.0, 3.0, x) + 3.0).abs() < 1e-9);
        }
        assert_eq!(flat(text, 1.0, -3.0, 2.6), -3.0);
        // A wall that rotates slowly about a centre far from the origin stays at its position in the scene.
        let turning = text
            .replace("[-2.0, 0.0], [2.0, 0.0]", "[4.0, 0.0], [8.0, 0.0]")
            .replace("corner = [-2.0, -2.0, 0.0]", "corner = [4.0, -2.0, 0.0]");
        let is_plane = turning.contains("segment");
        let [spin, centre] = if is_plane { ["1e-9", "[6.0, 0.0]"] } else { ["[1e-9, 0.0, 0.0]", "[6.0, 0.0, 0.0]"] };
        let turning = format!("{turning}motion = [{{ spin = {spin}, centre = {centre} }}]\n");
        assert!((flat(&turning, 1.0, -3.0, 6.0) - 3.0).abs() < 1e-6, "{turning}");
        assert_eq!(flat(&turning, 1.0, -3.0, 0.0), -3.0, "{turning}");
    }
}

#[test]
fn a_sphere_has_the_forces_of_the_slope_too() {
    let text = GRAIN.replace("dimension = 2", "dimension = 3").replace("[0.0, 0.5]", "[0.0, 0.0, 0.5]");
    let plane = "[walls.plane]\nmaterial = \"m\"\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n";
    let mut scene = scene(&format!("{text}{plane}"));
    scene.gravity = Vector3::new(3.0, 2.0, -9.0);
    let record = run(&scene, 16);
    let snapshot = record.snapshots.last().unwrap();
    let (mass, contact) = (snapshot.grains[0].mass, snapshot.told_contacts()[0]);
    let expected = Vector3::new(3.0, 2.0, 0.0) * (-mass * 2.0 / 7.0);
    assert!((contact.shear_force - expected).norm() < 1e-3 * expected.norm(), "{:?} {expected:?}", contact.shear_force);
    assert!((contact.normal_force / (9.0 * mass) - 1.0).abs() < 1e-9);
}

#[test]
fn wrong_resolutions_are_errors() {
    for resolution in [
        Resolution::CriticalFraction(0.1),
        Resolution::TimeStep(1e-3),
        Resolution::substeps(0),
        Resolution::Rigid { step: f64::NAN, substeps: 1, iterations: 4 },
    ] {
        let result = Rigid::new().run(&scene(PAIR), &resolution, &mut ());
        assert!(matches!(result, Err(RunError::Resolution { .. })), "{resolution}");
    }
    assert_eq!(Resolution::substeps(8).to_string(), "substeps=8");
}

#[test]
fn a_grain_that_outruns_contact_detection_is_an_error() {
    let mut scene = scene(PAIR);
    scene.grains[0].velocity.x = 100.0;
    match Rigid::new().run(&scene, &Resolution::substeps(1), &mut ()) {
        Err(RunError::Broken(broken)) => assert!(matches!(broken.cause, Cause::Runaway { .. }), "{broken}"),
        other => panic!("{:?}", other.map(|record| record.provenance)),
    }
    assert!(Rigid::new().run(&scene, &Resolution::substeps(4), &mut ()).is_ok());
}

#[test]
fn a_rerun_gives_the_same_bits() {
    let bits = |record: Record| format!("{:?}", Record { cost: Cost { wall_seconds: 0.0, ..record.cost }, ..record });
    for scene in [slope(60.0, 0.3), scene(PAIR)] {
        assert_eq!(bits(run(&scene, 3)), bits(run(&scene, 3)));
    }
}

/// A plane in contact with a grain at rest moves along its normal and pushes the grain without a rebound. After n steps of
/// Δt, the displacement of the grain differs from V n Δt by less than V Δt/4, because the grain rests only during
/// the first of the four small steps. A plane that starts one step late, or is 1 % slower, causes a larger difference.
#[test]
fn a_pushed_grain_goes_as_far_as_its_wall() {
    for (dimension, position, along) in
        [(2, "[0.0, 0.5]", Vector3::y()), (2, "[-0.5, 0.0]", -Vector3::x()), (3, "[0.0, 0.0, 0.5]", Vector3::z())]
    {
        let vector = |by: f64| format!("{:?}", &(along * by).as_slice()[..dimension]);
        let (origin, normal, velocity) = (vector(0.0), vector(1.0), vector(0.3));
        let wall = format!(
            "[walls.w]\nmaterial = \"m\"\nplane = {{ point = {origin}, normal = {normal} }}\n\
             motion = [{{ velocity = {velocity} }}]\n"
        );
        let text = GRAIN.replace("dimension = 2", &format!("dimension = {dimension}")).replace("[0.0, 0.5]", position);
        let mut scene = scene(&format!("{text}{wall}"));
        let mass = scene.grains[0].mass;
        // A damping ratio of 30 prevents a rebound: e = exp(−60 acosh 30/√899) = 3·10⁻⁴.
        scene.change_laws(|law| law.normal_damping = 60.0 * (1e6 / mass).sqrt());
        let record = run(&scene, 4);
        let allowed = 0.3 * record.provenance.time_step / f64::from(Resolution::RIGID_ITERATIONS);
        let way = along.map(f64::abs).imax();
        let column = record.series.column(["g.x", "g.y", "g.z"][way]).unwrap();
        for (time, at) in record.series.time.iter().zip(column) {
            let off = at - along[way] * (0.5 + 0.3 * time);
            assert!(off.abs() < allowed, "{off} at {time} s, allowed {allowed}");
        }
        assert!(column.len() > 50 && (last(&record, ["g.vx", "g.vy", "g.vz"][way]) - 0.3 * along[way]).abs() < 1e-3);
    }
}
