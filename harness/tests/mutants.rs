//! Objectivity and passivity pass for a small solver with the correct method, and fail by value with a planted mistake.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use grainbench_harness::conformance::ALL;
use grainbench_harness::control::FailureMode;
use grainbench_harness::mistake::small_dem::{MethodMistake, SmallDem};
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_solver::terms::Terms;

/// Returns the results of the named properties.
fn rows(solver: SmallDem, properties: &[&str], terms: &Terms) -> Vec<Verdict> {
    let asked = ALL.iter().filter(|known| properties.contains(&known.name));
    asked.flat_map(|property| property.check(&solver, terms)).collect()
}

/// Returns the variants of the results that fail by value with a mistake.
fn failed(mistake: MethodMistake) -> Vec<String> {
    let found = rows(SmallDem { mistake: Some(mistake) }, &["objectivity", "passivity"], &Terms::SECOND_ORDER);
    let red = found.into_iter().filter(|row| row.red() == Some(FailureMode::Value));
    red.map(|row| row.variant).collect()
}

#[test]
fn the_right_laws_pass() {
    for row in rows(SmallDem::default(), &["objectivity", "passivity", "order"], &Terms::SECOND_ORDER) {
        assert_eq!(row.outcome, Outcome::Pass, "{row:#?}");
    }
}

/// Bouncing grains gain no energy in 10⁵ steps. The test runs only if `GRAINBENCH_LONG=1`.
#[test]
fn the_right_laws_gain_nothing_in_the_long_run() {
    if std::env::var_os("GRAINBENCH_LONG").is_some_and(|value| value == "1") {
        for row in rows(SmallDem::default(), &["passivity"], &Terms::SECOND_ORDER.at_length()) {
            assert_eq!(row.outcome, Outcome::Pass, "{row:#?}");
        }
    }
}

#[test]
fn planted_defects_fail_by_value() {
    let expected: [(MethodMistake, &[&str]); 6] = [
        (MethodMistake::SpringNotTurned, &["objectivity/planes-2d", "objectivity/planes-3d-along"]),
        (MethodMistake::TwistNotFollowed, &["objectivity/planes-3d-along"]),
        (MethodMistake::WallSpinDropped, &["objectivity/drum-3d", "objectivity/planes-3d-hertz"]),
        (MethodMistake::SecantSpring, &["passivity/cycle-pressed-under-shear"]),
        (MethodMistake::NotRescaled, &["passivity/cycle-relieved-under-shear"]),
        (
            MethodMistake::WrongSpin,
            &["objectivity/drum-3d", "passivity/2d-friction", "passivity/between-planes-3d-hertz"],
        ),
    ];
    for (mistake, variants) in expected {
        let failed = failed(mistake);
        for variant in variants {
            assert!(failed.iter().any(|found| found == variant), "{mistake:?} in {variant}: {failed:?}");
        }
    }
}

/// All grains of these scenes are equal, so wrong lever arms have no effect. Claims about unequal grains test the lever arms.
#[test]
fn wrong_lever_arms_are_right_between_equal_grains() {
    for mistake in [MethodMistake::MeanArm, MethodMistake::OneArm] {
        for row in rows(SmallDem { mistake: Some(mistake) }, &["objectivity"], &Terms::SECOND_ORDER) {
            assert_eq!(row.outcome, Outcome::Pass, "{mistake:?}: {row:#?}");
        }
    }
}
