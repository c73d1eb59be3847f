//! Grains whose motion is prescribed for a part of the run. During this part they have infinite mass. Before and after
//! this part they move freely.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use grainbench_dem::convention::Convention;
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;
use support::{MATERIAL, column, last, run, run_at, scene};

/// Gravity (m/s²).
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

/// Invalid times are rejected with an error that names the key and the expected value.
#[test]
fn times_that_make_no_span_are_refused() {
    let refused = |span: &str, says: &str| {
        let text = format!(
            "{MATERIAL}dimension = 2\nduration = 0.4\n[grains.g]\nmaterial = 'm'\nradius = 0.1\nposition = [0.0, 0.0]\n\
             [driven.d]\ngrains = 'g'\n{span}\n"
        );
        let error = scene(&text).unwrap_err().to_string();
        assert!(error.contains(says), "{span}: {error}");
    };
    refused("start = -1.0", "driven.d.start: expected");
    refused("start = nan", "driven.d.start: expected");
    refused("stop = 0.0", "driven.d.stop: expected");
    refused("stop = inf", "driven.d.stop: expected");
    refused("start = 0.2\nstop = 0.2", "driven.d.stop: expected a time after the start at 0.2 s");
    refused("start = 0.3\nstop = 0.2", "driven.d.stop: expected a time after the start at 0.3 s");
    refused("start = 'soon'", "driven.d.start");
}
