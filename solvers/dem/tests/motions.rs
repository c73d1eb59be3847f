//! Prescribed motions by table and by function, of walls and of grains.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use grainbench_dem::convention::Convention;
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;
use std::f64::consts::TAU;
use support::{column, last, run_at};

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
fn a_wall_by_a_sine_presses_as_its_place_says() {
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
