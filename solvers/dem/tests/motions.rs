//! Prescribed motions of walls and of grains: by table, by function, and for a part of the run. Invalid motions are in
//! `tests/refusals/motions.toml`.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use grainbench_dem::convention::Convention;
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;
use std::f64::consts::TAU;
use support::{column, last, run, run_at};

const STEP: f64 = 1.0 / 1024.0;

/// Runs a single disc with the prescribed motion `driven` and no contacts.
fn carried(driven: &str) -> Record {
    let text = format!(
        "dimension = 2\nduration = 2.0\n[grains.g]\nmaterial = 'm'\nradius = 0.1\nposition = [0.0, 0.0]\n\
         [driven.d]\ngrains = 'g'\n{driven}\n[probes]\ng.grain = 'g'\n"
    );
    run_at(&text, Convention::CUNDALL_STRACK, &Resolution::TimeStep(STEP))
}

/// Returns the largest deviation of a column from an exact function of time.
fn worst(record: &Record, name: &str, exact: impl Fn(f64) -> f64) -> f64 {
    let off = record.series.time.iter().zip(column(record, name)).map(|(time, value)| (value - exact(*time)).abs());
    off.fold(0.0, f64::max)
}

/// Positions agree with the sine (amplitude A, frequency f) to the rounding of a sum of 2048 steps. Each velocity is the
/// mean of the velocities over the two adjacent steps. Its error is at most a fraction (2πfΔt)²/6 of the largest velocity
/// 2πfA.
#[test]
fn a_grain_is_carried_by_a_sine() {
    let record = carried("motion = [{ sine = { amplitude = [0.3, 0.0], frequency = 1.5 } }]");
    assert!(worst(&record, "g.x", |t| 0.3 * (TAU * 1.5 * t).sin()) < 1e-13);
    let rate = TAU * 1.5;
    let allowed = 0.3 * rate * (rate * STEP).powi(2) / 6.0;
    let moving = |t: f64| if t > 0.0 { 0.3 * rate * (rate * t).cos() } else { column(&record, "g.vx")[0] };
    let off = worst(&record, "g.vx", moving);
    assert!(off < 1.01 * allowed + 1e-10, "{off}");
    // With another phase, the motion still starts at the initial position.
    let record =
        carried("motion = [{ sine = { amplitude = [0.0, 0.2], frequency = 1.0, phase_deg = 90.0 }, start = 0.5 }]");
    let exact = |t: f64| if t < 0.5 { 0.0 } else { 0.2 * ((TAU * (t - 0.5)).cos() - 1.0) };
    assert!(worst(&record, "g.y", exact) < 1e-13);
}

#[test]
fn a_grain_is_carried_by_a_ramp_and_a_table_beside_its_velocity() {
    let ramp = "velocity = [0.0, 0.25]\nmotion = [{ velocity = [1.0, 0.0], ramp = 0.5 }]";
    let record = carried(ramp);
    let exact = |t: f64| if t < 0.5 { t * t } else { t - 0.25 };
    assert!(worst(&record, "g.x", exact) < 1e-13 && worst(&record, "g.y", |t| 0.25 * t) < 1e-13);
    let record = carried("motion = [{ table = [[0.5, 0.0, 0.0], [1.0, 0.1, 0.0], [1.5, -0.1, 0.2]] }]");
    let exact = |t: f64| match t {
        t if t < 0.5 => 0.0,
        t if t < 1.0 => 0.2 * (t - 0.5),
        t if t < 1.5 => 0.1 - 0.4 * (t - 1.0),
        _ => -0.1,
    };
    assert!(worst(&record, "g.x", exact) < 1e-13 && (last(&record, "g.y") - 0.2).abs() < 1e-13);
}

/// Runs a disc between a fixed floor and a lid with the prescribed motion `motion`.
fn pressed(motion: &str) -> Record {
    let text = format!(
        "dimension = 2\nduration = 0.5\n[grains.g]\nmaterial = 'm'\nradius = 0.1\nposition = [0.0, 0.1]\n\
         [walls.floor]\nmaterial = 'm'\nplane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}\n\
         [walls.lid]\nmaterial = 'm'\nplane = {{ point = [0.0, 0.2], normal = [0.0, -1.0] }}\n{motion}\n\
         [probes]\ng.grain = 'g'\nlid.wall = 'lid'\n"
    );
    run_at(&text, Convention::CUNDALL_STRACK, &Resolution::TimeStep(STEP / 8.0))
}

/// Returns the bits of all samples.
fn bits(record: &Record) -> Vec<u64> {
    let columns = record.series.columns.iter().flat_map(|series_column| column(record, &series_column.name));
    columns.map(|value| value.to_bits()).collect()
}

#[test]
fn a_table_that_samples_a_line_is_the_line_to_the_bit() {
    let line = pressed("motion = [{ velocity = [0.25, -0.0078125] }]");
    let table = "motion = [{ table = [[0.0, 0.0, 0.0], [0.25, 0.0625, -0.001953125], [1.0, 0.25, -0.0078125]] }]";
    assert_eq!(bits(&line), bits(&pressed(table)));
    assert!(last(&line, "lid.force_y") != 0.0);
    // A table with a point off the line gives different samples.
    assert_ne!(bits(&line), bits(&pressed(&table.replace("-0.001953125", "-0.002"))));
}

#[test]
fn a_sine_wall_presses_by_its_position() {
    let record = pressed("motion = [{ sine = { amplitude = [0.0, -1e-4], frequency = 0.5 } }]");
    // The run ends after a quarter period (.5 s). The lid has moved by 1e-4 m and is at rest. Each of the disc's two
    // contacts takes half of this slow displacement.
    let (force, y) = (last(&record, "lid.force_y"), last(&record, "g.y"));
    let slow = pressed("motion = [{ velocity = [0.0, -2e-4], ramp = 0.0625 }]");
    assert!(force > 0.0 && (0.1 - y - 0.5e-4).abs() < 0.3e-4, "{force} {y}");
    // After a ramp of T = 1/16 s, the displacement of the lid is v (t − T/2) = 2e-4 m/s · .46875 s, which is .9375 of
    // the displacement of the sine. The disc moves by half of it.
    assert!((last(&slow, "g.y") - 0.1 + 0.46875e-4).abs() < 0.3e-4);
}

#[test]
fn grains_are_driven_by_material_and_with_a_spin() {
    let text = "dimension = 2\nduration = 1.0\nmaterials.n.density = 1.0\n\
         contacts.mn = { between = ['m', 'n'], normal_stiffness = 1.0e6 }\n\
         contacts.n = { between = ['n', 'n'], normal_stiffness = 1.0e6 }\n\
         [grains.a]\nmaterial = 'm'\nradius = 0.1\nposition = [0.0, 0.0]\nspin = 9.0\n\
         [grains.b]\nmaterial = 'n'\nradius = 0.1\nlattice = { origin = [1.0, 0.0], spacing = [1.0, 1.0], count = [2, 1] }\n\
         [driven.d]\nmaterial = 'n'\nspin = -3.0\nvelocity = [0.0, 0.5]\n\
         [probes]\na.grain = 'a'\nb.grain = 'b.2'\n";
    let record = run_at(text, Convention::CUNDALL_STRACK, &Resolution::TimeStep(STEP));
    assert!(worst(&record, "b.omega", |_| -3.0) == 0.0 && worst(&record, "b.angle", |t| -3.0 * t) < 1e-12);
    assert!(worst(&record, "b.y", |t| 0.5 * t) < 1e-13 && worst(&record, "a.omega", |_| 9.0) == 0.0);
}

/// Gravity on a grain whose motion is prescribed for a part of the run (m/s²).
const GRAVITY: f64 = 10.0;
/// Upward velocity of the prescribed motion (m/s).
const SPEED: f64 = 0.5;
/// Start and end of the prescribed motion (s).
const SPAN: [f64; 2] = [0.2, 0.5];

fn thrown(driven: &str, time_step: f64) -> Record {
    let text = format!(
        "dimension = 2\nduration = 0.8\ngravity = [0.0, -{GRAVITY:?}]\n\
         [grains.g]\nmaterial = 'm'\nradius = 0.1\nposition = [0.0, 0.3]\nvelocity = [0.3, 0.0]\n{driven}\n\
         [probes]\ng.grain = 'g'\n"
    );
    run_at(&text, Convention::CUNDALL_STRACK, &Resolution::TimeStep(time_step))
}

/// The disc falls by g t²/2 before the prescribed motion, then moves along a straight line, and then flies freely,
/// starting with the prescribed velocity. The result is exact to rounding, because central differences are exact for
/// constant forces. The initial horizontal velocity lasts until the prescribed motion starts.
#[test]
fn a_disc_falls_is_lifted_and_falls_again() {
    let driven =
        format!("[driven.d]\ngrains = 'g'\nvelocity = [0.0, {SPEED}]\nstart = {}\nstop = {}", SPAN[0], SPAN[1]);
    let record = thrown(&driven, 1e-3);
    let [start, stop] = SPAN;
    let fall = |time: f64| -0.5 * GRAVITY * time * time;
    let exact = |time: f64| {
        let lifted = SPEED * (time.min(stop) - start).max(0.0);
        let after = (time - stop).max(0.0);
        0.3 + fall(time.min(start)) + lifted + SPEED * after + fall(after)
    };
    let velocity = |time: f64| if time < start { -GRAVITY * time } else { SPEED - GRAVITY * (time - stop).max(0.0) };
    for (at, time) in record.series.time.iter().enumerate() {
        let (y, vy) = (column(&record, "g.y")[at], column(&record, "g.vy")[at]);
        assert!((y - exact(*time)).abs() < 1e-12, "{time}: {y} for {}", exact(*time));
        // The velocity jumps when the prescribed motion starts, so it is not compared there.
        assert!((time - start).abs() < 1e-6 || (vy - velocity(*time)).abs() < 1e-11, "{time}: {vy}");
        let x = 0.3 * time.min(start);
        assert!((column(&record, "g.x")[at] - x).abs() < 1e-12);
    }
    // A disc whose motion is always prescribed, or never, does not follow this solution.
    let always = thrown(&format!("[driven.d]\ngrains = 'g'\nvelocity = [0.0, {SPEED}]"), 1e-3);
    assert!(
        (last(&always, "g.y") - exact(0.8)).abs() > 0.1 && (last(&thrown("", 1e-3), "g.y") - exact(0.8)).abs() > 0.1
    );
}

/// While its motion is prescribed, a disc acts on the dashpot of a contact like a wall of infinite mass. Before and
/// after, it acts with its own mass.
#[test]
fn a_disc_has_its_mass_before_and_after() {
    let rebound = |span: &str| {
        let text = format!(
            "dimension = 2\nduration = 0.4\n\
             materials.n.density = 1000.0\ncontacts.n = {{ between = ['n', 'n'], normal_stiffness = 1.0e7, restitution = 0.5 }}\n\
             [grains.free]\nmaterial = 'n'\nradius = 0.5\nposition = [-1.1, 0.0]\nvelocity = [1.0, 0.0]\n\
             [grains.held]\nmaterial = 'n'\nradius = 0.5\nposition = [0.0, 0.0]\n\
             [driven.held]\ngrains = 'held'\n{span}\n[probes]\nfree.grain = 'free'\nheld.grain = 'held'\n"
        );
        let record = run(&text);
        [last(&record, "free.vx"), last(&record, "held.vx")]
    };
    // The contact lasts from .1 s to .13 s. With e = .5 and an initial velocity of 1 m/s, a disc rebounds from a wall
    // with −.5 m/s. After a contact between equal discs, the velocities are (1 ∓ .5)/2 m/s. The error of the rebound
    // velocity is of first order in the step. With the mass of a free disc in the dashpot, it would be .618 m/s.
    for held in ["start = 0.05", "stop = 0.3", "start = 0.05\nstop = 0.3", ""] {
        let [free, other] = rebound(held);
        assert!((free + 0.5).abs() < 5e-3 && other == 0.0, "{held}: {free}, {other}");
    }
    for loose in ["start = 0.39", "stop = 0.05", "start = 0.01\nstop = 0.05"] {
        let [free, other] = rebound(loose);
        let expected = if loose == "start = 0.39" { [0.25, 0.0] } else { [0.25, 0.75] };
        assert!((free - expected[0]).abs() < 5e-3 && (other - expected[1]).abs() < 5e-3, "{loose}: {free}, {other}");
    }
}
