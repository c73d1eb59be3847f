//! Tests of contact spring forces against hand calculations: at a wall, between bodies, on a belt, in a moving frame.

use crate::support::{change, column, incline, last, run, try_run};
use grainbench_mpm::options::Setting;
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;

/// Plane modulus E' = E/(1 − ν²) for E = 100 Pa and ν = .3: 100/.91 Pa.
const PLANE_MODULUS: f64 = 109.890_109_890_109_89;

/// Returns the first step of a block 2 m wide that overlaps a plane by .01 m. The plane moves at 10 m/s along x.
fn pressed_block(friction: f64, change: impl FnOnce(&mut Setting)) -> Record {
    let text = format!(
        "dimension = 2\nduration = 1.0e-3\nreference_length = 1.0\noutput.every_cycles = 1\n\
         materials.m = {{ density = 1.0, young_modulus = 100.0, poisson_ratio = 0.3 }}\n\
         contacts.m = {{ between = ['m', 'm'], law = 'coulomb', friction = {friction} }}\n\
         [bodies.b]\nmaterial = 'm'\nbox = {{ low = [0.0, -0.01], high = [2.0, 1.5] }}\n\
         [walls.w]\nmaterial = 'm'\nplane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}\n\
         motion = [{{ velocity = [10.0, 0.0] }}]\n[probes]\nw.wall = 'w'\n"
    );
    try_run("mpm", change, &text, Resolution::grid(4.0, 2)).unwrap()
}

/// Springs with the stiffness per area κ = 2.6 E'/h, h = .25 m, push a face of 2 m. At the depth g = .01 m the force is
/// κ · 2 g.
///
/// The springs are displaced tangentially by 10 m/s Δt, more than μ g. The friction force is therefore μ times the normal
/// force, and the plane receives the opposite forces. With half the stiffness, the forces are half as large. With two
/// thousandths more friction, the friction force grows by two thousandths.
#[test]
fn a_plane_pushes_and_rubs_with_its_springs() {
    let push = 2.6 * PLANE_MODULUS / 0.25 * 2.0 * 0.01;
    for (friction, penalty) in [(0.3, 2.6), (0.3, 1.3), (0.3 * 1.002, 2.6)] {
        let record = pressed_block(friction, |setting| setting.penalty = penalty);
        assert!(
            10.0 * record.provenance.time_step > 2.0 * 0.01 * friction,
            "it slips: {}",
            record.provenance.time_step
        );
        let push = push * penalty / 2.6;
        for (name, expected) in [("w.force_y", -push), ("w.force_x", -friction * push)] {
            let found = column(&record, name)[1];
            assert!((found / expected - 1.0).abs() < 1e-12, "{name}: {found} for {expected}");
        }
    }
}

/// Returns a scene of two discs of radius 1 m that overlap by .009 m, observed after the first step.
///
/// `between` is the contact law of the discs with any further tables, and `second` the material of the second disc. The
/// discs move past each other with `speed` (m/s) each.
fn two_discs(between: &str, second: &str, speed: f64) -> String {
    format!(
        "dimension = 2\nduration = 1.0e-3\noutput.every_cycles = 1\n\
         materials.m = {{ density = 1.0, young_modulus = 100.0, poisson_ratio = 0.3 }}\n{between}\
         [grains.a]\nmaterial = 'm'\nradius = 1.0\nposition = [-0.9955, 0.0]\nvelocity = [0.0, {speed}]\n\
         [grains.b]\nmaterial = '{second}'\nradius = 1.0\nposition = [0.9955, 0.0]\nvelocity = [0.0, {}]\n\
         [probes]\nc.contact = ['a', 'b']\n",
        -speed
    )
}

/// Two discs of radius R = 1 m overlap by δ = .009 m in the first step. Both have tracers with springs of ½κ per area,
/// κ = 2.6 E'/h. At the arc length s from the line of centres the depth is g = δ − s²/R. The total force is κ ∫ g ds =
/// κ (4/3) δ √(δR).
///
/// The tracer spacing ℓ is a sixth of a cell. The sum over tracers has an error of ¼ ℓ²/(δR), because the parabola ends
/// in kinks. The deviation from a parabola is of the order of δ/R. E' is the harmonic mean of both bodies: 3/2 of one
/// if the other is three times as stiff.
#[test]
fn discs_push_with_the_springs_of_both() {
    let force = |second: f64, penalty: f64| {
        let stiff =
            format!("materials.n = {{ density = 1.0, young_modulus = {}, poisson_ratio = 0.3 }}\n", 100.0 * second);
        let text = two_discs(&(stiff + "contacts.m = { between = ['m', 'n'], law = 'coulomb' }\n"), "n", 0.0);
        let at = Resolution::grid(8.0, 2);
        let record = try_run("mpm", |setting| setting.penalty = penalty, &text, at).unwrap();
        column(&record, "c.normal_force")[1]
    };
    let (overlap, cell) = (0.009_f64, 0.125);
    let expected = 2.6 * PLANE_MODULUS / cell * 4.0 / 3.0 * overlap * overlap.sqrt();
    let allowed = 0.25 * (cell / 6.0_f64).powi(2) / overlap + overlap;
    let alike = force(1.0, 2.6);
    assert!((alike / expected - 1.0).abs() < allowed, "{alike} for {expected}, within {allowed}");
    assert!((force(1.0, 1.3) / alike - 0.5).abs() < 1e-12);
    assert!((force(3.0, 2.6) / alike - 1.5).abs() < 1e-12);
}

/// Two discs move past each other at 20 m/s. All tracer springs of both discs slip in the first step, with friction
/// forces of μ times their normal forces. The first disc moves up, so its friction force points down. A downward force
/// counts as positive, because it points to the right of the line from the first to the second disc.
#[test]
fn discs_that_pass_each_other_rub_with_the_springs_of_both() {
    let force = |friction: f64, speed: f64| {
        let law = format!("contacts.m = {{ between = ['m', 'm'], law = 'coulomb', friction = {friction} }}\n");
        let text = two_discs(&law, "m", speed);
        let record = try_run("mpm", |_| (), &text, Resolution::grid(8.0, 2)).unwrap();
        column(&record, "c.shear_force")[1] / column(&record, "c.normal_force")[1]
    };
    for friction in [0.3, 0.1] {
        for (speed, sign) in [(10.0, 1.0), (-10.0, -1.0)] {
            let found = force(friction, speed);
            // The direction of friction at a tracer turns by s/R, where s is the distance from the middle of the
            // contact. The effect is at most δ/R.
            assert!((found / (sign * friction) - 1.0).abs() < 0.02, "{found} for {}", sign * friction);
        }
    }
}

/// A disc is at rest on a belt that starts at V = 6 m/s. Springs exceed the Coulomb limit μ δ at a depth δ in every
/// step. The friction is therefore μ times the normal force, and the disc gains v_x = μ (g t + v_y). Initial velocities
/// belong to half a step earlier, when no friction acted, so t is half a step longer. Sums over some hundred steps are
/// exact to 1e-10. The belt turns the disc counter-clockwise.
#[test]
fn a_belt_drags_a_disc_by_what_presses_it() {
    let (speed, time) = (6.0, 0.15);
    for friction in [0.3, 0.3 * 1.002] {
        let plane = "normal = [0.0, 1.0] }";
        let text = incline(0.0, friction, time, true)
            .replace(plane, &format!("{plane}\nmotion = [{{ velocity = [{speed}, 0.0] }}]"));
        let record = run("mpm", &format!("{text}c.contact = ['g', 'w']\n"), 4.0, 3);
        let depth = column(&record, "c.overlap").iter().copied().fold(0.0, f64::max);
        let step = record.provenance.time_step;
        assert!(2.0 * friction * depth < speed * step, "all of it slips: {depth} deep, {} in a step", speed * step);
        let expected = friction * (9.8 * (time + 0.5 * step) + last(&record, "g.vy"));
        let found = last(&record, "g.vx");
        assert!((found / expected - 1.0).abs() < 1e-9, "{found} for {expected} at a friction of {friction}");
        assert!(last(&record, "g.omega") > 0.0);
    }
}

/// The incline is tested in a moving frame. Plane and disc also move at V, and after a time t they are V t farther. The
/// remaining difference comes from crossing nodes. It is within the discretisation error of the disc at this resolution
/// (.7 % of the rigid displacement). If the plane moved 1 % faster, the rolling disc would be a third of .01 V t
/// farther, which is 4.7 %.
#[test]
fn an_incline_in_a_moving_frame_is_an_incline() {
    let (speed, time) = (4.0, 0.1);
    let at_rest = incline(60.0, 0.9, time, true);
    let rigid = 9.8 * 60_f64.to_radians().sin() / 3.0 * time * time;
    let moving = |belt: f64| {
        at_rest.replace("position = [0.0, 0.5]", &format!("position = [0.0, 0.5]\nvelocity = [{speed}, 0.0]")).replace(
            "normal = [0.0, 1.0] }",
            &format!("normal = [0.0, 1.0] }}\nmotion = [{{ velocity = [{belt}, 0.0] }}]"),
        )
    };
    let way = |text: &str| {
        let record = run("mpm", text, 8.0, 3);
        (change(&record, "g.x"), record.series.time[record.series.time.len() - 1])
    };
    let (way_at_rest, _) = way(&at_rest);
    let (way_moving, end) = way(&moving(speed));
    let off = (way_moving - speed * end - way_at_rest) / rigid;
    assert!(off.abs() < 7e-3, "{off}");
    let (way_faster, _) = way(&moving(1.01 * speed));
    assert!((way_faster - speed * end - way_at_rest).abs() / rigid > 0.03, "{}", (way_faster - way_moving) / rigid);
}

/// The torque on a disc refers to the centre of the disc. It is the same eight radii farther along the wall.
#[test]
fn a_torque_does_not_depend_on_the_place() {
    let torque = |place: &str| {
        let text = incline(30.0, 0.5, 0.05, false).replace("position = [0.0, 0.5]", &format!("position = {place}"));
        let record = run("mpm:penalty", &text, 8.0, 2);
        record.snapshots.last().unwrap().grains[0].torque.unwrap().z
    };
    let (here, there) = (torque("[0.0, 0.5]"), torque("[4.0, 0.5]"));
    assert!(here.abs() > 1.0 && (there / here - 1.0).abs() < 1e-6, "{here} and {there} N m");
}

/// Returns the change of velocity (m/s) of a block that slides at 1 m/s relative to a wall. The wall has the tangential
/// velocity `wall` (m/s).
fn braked(solver: &str, wall: f64) -> f64 {
    let text = format!(
        "dimension = 2\nduration = 0.1\ngravity = [0.0, -9.8]\nsettle = {{ duration = 0.3, damping = 60.0 }}\n\
         reference_length = 0.5\n\
         materials.m = {{ density = 3000.0, bulk_modulus = 1.0e7, shear_modulus = 2.5e6 }}\n\
         contacts.m = {{ between = ['m', 'm'], law = 'coulomb', friction = 0.5 }}\n\
         [bodies.b]\nmaterial = 'm'\nbox = {{ low = [0.0, 0.0], high = [1.0, 0.5] }}\nvelocity = [{:?}, 0.0]\n\
         [walls.w]\nmaterial = 'm'\nplane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}\n\
         motion = [{{ velocity = [{wall:?}, 0.0] }}]\n[output]\nevery = 0.1\n[probes]\nb.body = 'b'\n",
        wall + 1.0
    );
    change(&run(solver, &text, 4.0, 2), "b.vx")
}

/// Coulomb friction changes the velocity by μ g t = .49 m/s in .1 s in any frame. With a wall at −2 m/s the block moves
/// at −1 m/s. If the wall were treated as at rest, friction would have the opposite sign. The block crosses cells in
/// only one of the frames, which causes a difference of at most a tenth.
#[test]
fn a_block_is_braked_alike_in_any_frame() {
    for solver in ["mpm", "mpm:2000", "mpm:2001", "mpm:gap"] {
        let (at_rest, moving) = (braked(solver, 0.0), braked(solver, -2.0));
        println!("{solver}: {at_rest} and {moving}");
        assert!(moving < 0.0 && (moving - at_rest).abs() < 0.1 * 0.49, "{solver}: {at_rest} and {moving}");
    }
}
