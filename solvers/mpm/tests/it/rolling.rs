//! Tests of a disc and a sphere on a rigid plane.

use crate::support::{change, column, incline, last, run};
use grainbench_mpm::solver::Mpm;

/// Returns the error of the displacement relative to a rigid disc (%), and the ratio of rolling to translation.
fn error(solver: &str, (slope, friction, duration): (f64, f64, f64), cells: f64, settled: bool) -> (f64, f64) {
    let record = run(solver, &incline(slope, friction, duration, settled), cells, 3);
    let angle = slope.to_radians();
    let pull =
        if angle.tan() <= 3.0 * friction { angle.sin() / 3.0 } else { 0.5 * (angle.sin() - friction * angle.cos()) };
    let rigid = 9.8 * pull * duration * duration;
    let rolled = -0.5 * last(&record, "g.omega") / last(&record, "g.vx");
    (100.0 * (change(&record, "g.x") / rigid - 1.0), rolled)
}

/// After relaxation, the displacement is compared with the elastic result. In the three cases, it differs from the rigid
/// displacement by +1.47 %, +.65 ± .1 % and −.3 ± .1 %.
#[test]
fn settled_disc_rolls_and_slips_as_an_elastic_one() {
    for (case, elastic, allowed) in [
        ((60.0, 0.3, 0.3), 1.47, [0.5, 0.35, 0.3]),
        ((60.0, 0.9, 0.3), 0.65, [7.1, 2.1, 0.7]),
        ((30.0, 0.5, 0.4), -0.3, [8.1, 3.6, 1.1]),
    ] {
        for (cells, allowed) in [2.0, 4.0, 8.0].into_iter().zip(allowed) {
            let (found, _) = error("mpm", case, cells, true);
            assert!((found - elastic).abs() < allowed, "{case:?} at {cells}: {found} against {elastic}");
        }
    }
    assert!((error("mpm", (60.0, 0.3, 0.3), 8.0, true).1 - 0.39).abs() < 0.02);
}

/// The solver reproduces the nodal contact of the papers, which acts at a distance. At two cells per radius with the
/// contact of 2000, a slipping disc does not turn, and the displacement of a rolling disc is too small by 30 to 42 %.
/// With the contact of 2001, the displacement of a slipping disc is too small by 38 to 55 %.
#[test]
fn the_papers_contact_does_not_roll_at_two_cells() {
    let (slip, turned) = error("mpm:2000", (60.0, 0.3, 0.3), 2.0, false);
    assert!(slip.abs() < 2.5 && turned.abs() < 0.05, "{slip} {turned}");
    let stick = error("mpm:2000", (60.0, 0.9, 0.3), 2.0, false).0;
    assert!((-42.0..-30.0).contains(&stick), "{stick}");
    let literal = error("mpm:2001", (60.0, 0.3, 0.3), 2.0, false).0;
    assert!((-55.0..-38.0).contains(&literal), "{literal}");
}

/// No body falls through a plane, with any method at any resolution. The force on the plane equals the weight of the
/// body.
#[test]
fn nothing_falls_through_a_plane() {
    let weight = 3000.0 * std::f64::consts::PI * 0.25 * 9.8;
    for solver in Mpm::ALL {
        for cells in [1.0, 2.0, 4.0] {
            let record = run(solver.name, &incline(0.0, 0.5, 0.3, true), cells, 2);
            let lowest = column(&record, "g.y").iter().copied().fold(f64::INFINITY, f64::min);
            assert!(lowest > 0.45, "{} at {cells}: {lowest}", solver.name);
            let force = last(&record, "w.force_y");
            assert!((force / weight + 1.0).abs() < 0.1, "{} at {cells}: {force} against {weight}", solver.name);
        }
    }
}

/// A relaxed sphere rolls without slip for a second. Its displacement differs by −.2 ± .3 % from the rigid
/// displacement.
#[test]
fn settled_sphere_rolls() {
    let pull = -10.0 * 45_f64.to_radians().cos();
    let text = format!(
        "dimension = 3\nduration = 1.0\ngravity = {{ magnitude = 10.0, slope_deg = 45.0 }}\n\
         settle = {{ duration = 0.6, damping = 20.0, gravity = [0.0, 0.0, {pull}] }}\n\
         materials.m = {{ density = 1000.0, bulk_modulus = 6.0e6, shear_modulus = 3.0e6 }}\n\
         contacts.m = {{ between = ['m', 'm'], law = 'coulomb', friction = 0.495 }}\n\
         [grains.g]\nmaterial = 'm'\nradius = 1.6\nposition = [0.0, 0.0, 1.6]\n\
         [walls.w]\nmaterial = 'm'\nplane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }}\n\
         [probes]\ng.grain = 'g'\n"
    );
    let record = run("mpm", &text, 4.0, 2);
    let rigid = 25.0 / 14.0 * 2.0_f64.sqrt();
    let found = 100.0 * (change(&record, "g.x") / rigid - 1.0);
    assert!((found + 0.2).abs() < 3.3, "{found}");
    assert!(last(&record, "g.y").abs() < 1e-3);
}
