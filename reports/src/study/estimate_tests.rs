//! Tests of the statements about estimated errors.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use super::*;

/// Returns a quantity of one solver whose levels from coarse to fine have these errors. Each level takes twice the time.
fn ladder(errors: &[f64]) -> Quantity {
    let point = |(at, error): (usize, &f64)| EstimatedPoint {
        solver: "rigid".to_owned(),
        setting: format!("substeps={}", 1 << at),
        wall_seconds: f64::from(1 << at),
        value: 1.0 + error,
        error: *error,
        uncertainty: 1e-3,
        softer: false,
    };
    Quantity {
        name: "ball.x".to_owned(),
        unit: "m".to_owned(),
        scale: 1.0,
        estimates: Vec::new(),
        points: errors.iter().enumerate().map(point).collect(),
    }
}

fn cost(quantities: Vec<Quantity>) -> SceneCost {
    let points = quantities.iter().flat_map(|quantity| &quantity.points);
    let level = |point: &EstimatedPoint| Level {
        solver: point.solver.clone(),
        setting: point.setting.clone(),
        status: PointStatus::Measured,
        wall_seconds: Some(point.wall_seconds),
        repetitions: 1,
        steps: 1,
        detail: None,
    };
    SceneCost {
        scene: "scene.toml".to_owned(),
        budget: 60.0,
        spent: 50.0,
        reduction: Reduction::End,
        names: vec!["rigid".to_owned()],
        levels: points.map(level).collect(),
        quantities,
        notes: Vec::new(),
    }
}

/// The coarsest level is right by chance: the next one has a larger error. Negative control: a ladder without such a level.
#[test]
fn a_level_that_is_right_by_chance_reaches_nothing() {
    for (errors, setting) in
        [([0.002, 0.027, 0.008, 0.004], "substeps=4"), ([0.009, 0.008, 0.006, 0.003], "substeps=1")]
    {
        let quantity = ladder(&errors);
        assert_eq!(quantity.cheapest("rigid", 0.01).map(|point| point.setting.as_str()), Some(setting));
        let cost = cost(vec![quantity]);
        assert_eq!(cost.cheapest_for_all("rigid", 0.01).map(|(setting, _)| setting), Some(setting));
        assert!(cost.sentence(0.01, &[]).ends_with(&format!("with {setting}.")), "{}", cost.sentence(0.01, &[]));
    }
    // An error of the finest level above the target: the accurate coarse level is not "at best".
    let unreached = cost(vec![ladder(&[0.002, 0.027, 0.02])]);
    assert_eq!(unreached.cheapest_for_all("rigid", 0.01), None);
    assert!(unreached.sentence(0.01, &[]).contains("at best 2.1"), "{}", unreached.sentence(0.01, &[]));
}

/// A difference of 22 % with an uncertainty of 50 % is no agreement. Negative control: a small uncertainty.
#[test]
fn agreement_needs_a_small_uncertainty() {
    let words = |size, uncertainty| difference_words(&Difference { solvers: ["dem", "mpm"], size, uncertainty });
    let undecided = words(0.22, 0.5);
    assert!(undecided.contains("cannot be decided: the uncertainty is ± 50") && !undecided.contains("agree "));
    assert!(words(0.01, 0.06).contains("cannot be decided"));
    assert!(words(0.01, 0.02).starts_with("dem and mpm agree within"));
    let different = words(0.22, 0.02);
    assert!(
        different.starts_with("dem and mpm differ by 22") && different.contains("(more than their uncertainty of ± 2")
    );
    assert!(words(0.6, 0.5).contains("differ by 60"));
}

/// Each solver without a value is in the sentence, with the reason.
#[test]
fn a_solver_without_a_value_is_named() {
    let mut cost = cost(vec![ladder(&[0.04, 0.02, 0.008])]);
    let measured = cost.levels[0].clone();
    let level = |solver: &str, status| Level { solver: solver.to_owned(), status, ..measured.clone() };
    cost.names = ["rigid", "dem", "mpm", "other", "slow"].map(str::to_owned).to_vec();
    cost.levels.extend([PointStatus::Failed; 5].map(|status| level("dem", status)));
    cost.levels.push(level("mpm", PointStatus::Unsupported));
    cost.levels.push(level("slow", PointStatus::Measured));
    let sentences = [cost.sentence(0.01, &[]), cost.sentence_of(&cost.quantities[0], 0.01, &[])];
    for sentence in sentences {
        for words in [
            "dem has no value (5 levels failed)",
            "mpm has no value (cannot run the scene)",
            "other has no value (no run)",
            "slow has no value (only one level ended, and two are needed)",
        ] {
            assert!(sentence.contains(words), "{words}: {sentence}");
        }
        assert!(!sentence.contains("rigid has no value"), "{sentence}");
    }
}

/// A solver without a value of one of two quantities does not reach the target in both.
#[test]
fn a_target_in_all_quantities_needs_a_value_of_each() {
    let mut other = ladder(&[0.004, 0.002]);
    other.name = "other".to_owned();
    other.points.iter_mut().for_each(|point| point.solver = "mpm".to_owned());
    let cost = cost(vec![ladder(&[0.004, 0.002]), other]);
    assert_eq!(cost.cheapest_for_all("rigid", 0.01), None);
    let sentence = cost.sentence(0.01, &[]);
    assert!(sentence.contains("rigid reaches it in 1 of 2 (other: no value)"), "{sentence}");
}

/// A step of 0.4 is 0.87 of the smallest failed step of 0.46. Negative controls: a failed step of 1, the limit of another solver,
/// and a limit that is a lower bound because no step failed.
#[test]
fn a_step_near_the_stable_one_has_a_remark() {
    let mut quantity = ladder(&[0.002, 0.001]);
    for (point, step) in quantity.points.iter_mut().zip(["dt=0.4", "dt=0.2"]) {
        (point.solver, point.setting) = ("dem".to_owned(), step.to_owned());
    }
    let cost = SceneCost { names: vec!["dem".to_owned()], ..cost(vec![quantity]) };
    let limit = |solver: &str, unstable| Limit {
        scene: cost.scene.clone(),
        solver: solver.to_owned(),
        unit: CRITICAL_STEP.to_owned(),
        found: Some(0.45),
        unstable,
        ..Limit::default()
    };
    let remark = "with dt=0.4, which is 0.87 of the largest stable step.";
    assert!(cost.sentence(0.01, &[limit("dem", Some(0.46))]).ends_with(remark));
    assert!(cost.sentence_of(&cost.quantities[0], 0.01, &[limit("dem", Some(0.46))]).ends_with(remark));
    for control in [limit("dem", Some(1.0)), limit("rigid", Some(0.46)), limit("dem", None)] {
        assert!(cost.sentence(0.01, &[control]).ends_with("with dt=0.4."));
    }
}
