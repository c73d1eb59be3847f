//! Claims about friction, rotating springs and rolling moments fail by value for a small solver with planted mistakes.

use crate::own_solver::Changed;
use grainbench::dem::convention::Convention;
use grainbench::dem::solver::Dem;
use grainbench::harness::control::FailureMode;
use grainbench::harness::mistake::small_dem::{MethodMistake, SmallDem};
use grainbench::harness::verdict::{Outcome, Verdict};
use grainbench::scene::dimension::GrainShape;
use grainbench::scene::scene::Scene;
use nalgebra::Vector3;

const CASES: [&str; 5] = ["unequal-impact", "rolling-off", "carried-grain", "turning-walls", "rocking"];

fn rows(mistake: Option<MethodMistake>, cases: &[&str]) -> Vec<Verdict> {
    grainbench::judge(SmallDem { mistake }, cases).unwrap().verdicts
}

#[test]
fn the_right_laws_pass_every_claim() {
    let judgement = grainbench::judge(SmallDem::default(), &CASES).unwrap();
    let failures = judgement.failures();
    assert!(failures.is_empty() && judgement.controls.len() == judgement.verdicts.len(), "{failures:#?}\n{judgement}");
    assert!(judgement.verdicts.iter().all(|row| row.outcome == Outcome::Pass), "{judgement}");
}

#[test]
fn planted_defects_fail_claims_by_value() {
    let expected: [(MethodMistake, &[&str]); 8] = [
        (MethodMistake::SpringNotTurned, &["carried-grain", "turning-walls"]),
        (MethodMistake::TwistNotFollowed, &["carried-grain", "turning-walls"]),
        (MethodMistake::MeanArm, &["unequal-impact", "rolling-off"]),
        (MethodMistake::OneArm, &["unequal-impact", "rolling-off", "carried-grain"]),
        (MethodMistake::WrongSpin, &["rolling-off", "carried-grain"]),
        (MethodMistake::WallSpinDropped, &["turning-walls"]),
        (MethodMistake::RollingNotCut, &["rocking"]),
        (MethodMistake::SpinsDropped, &["carried-grain", "turning-walls", "rocking"]),
    ];
    for (mistake, cases) in expected {
        let (_, words) = MethodMistake::ALL.into_iter().find(|(known, _)| *known == mistake).unwrap();
        for case in cases {
            let rows = rows(Some(mistake), &[case]);
            let red: Vec<_> =
                rows.iter().filter(|row| row.red() == Some(FailureMode::Value)).map(|row| &row.quantity).collect();
            assert!(!red.is_empty(), "{mistake:?} in {case}");
            let is_named = |row: &&Verdict| row.detail.as_ref().is_some_and(|detail| detail.contains(words));
            assert_eq!(rows.iter().filter(is_named).count(), red.len(), "{mistake:?} in {case}: {rows:#?}");
            println!("{mistake:?} in {case}: {} of {} red: {red:?}", red.len(), rows.len());
        }
    }
}

/// A failed result of a solver with a mistake names this mistake and no other.
#[test]
fn a_failed_result_names_the_mistake() {
    type Wrong = (&'static str, &'static str, fn(&mut Scene));
    let expected: [Wrong; 7] = [
        ("incline-disc", "the inertia of a sphere in a disc", |scene| {
            scene.grains.iter_mut().for_each(|grain| grain.inertia *= 0.8);
        }),
        ("backspin", "the inertia of a hollow sphere", |scene| {
            if scene.grain_shape == GrainShape::Sphere {
                scene.grains.iter_mut().for_each(|grain| grain.inertia *= 5.0 / 3.0);
            }
        }),
        ("incline-disc", "gravity of 9.81 m/s²", |scene| scene.gravity *= 9.81 / scene.gravity.norm()),
        ("incline-disc", "sine and cosine of the slope exchanged", |scene| {
            scene.gravity = Vector3::new(-scene.gravity.y, -scene.gravity.x, 0.0);
        }),
        ("chung-ooi", "half the friction", |scene| {
            scene.laws.iter_mut().flatten().for_each(|law| law.friction *= 0.5);
        }),
        ("chung-ooi", "the restitution taken as the damping ratio", |scene| {
            scene.laws.iter_mut().flatten().for_each(|law| law.damping_ratio = law.restitution());
        }),
        ("rocking", "twice the rolling resistance", |scene| {
            scene.laws.iter_mut().flatten().for_each(|law| law.rolling_friction *= 2.0);
        }),
    ];
    for (case, words, wrong) in expected {
        let rows =
            grainbench::judge(Changed(Box::new(Dem::new(Convention::DEFAULT)), wrong), &[case]).unwrap().verdicts;
        let red: Vec<&Verdict> = rows.iter().filter(|row| row.red() == Some(FailureMode::Value)).collect();
        let hint = |row: &Verdict| {
            row.detail.as_deref().unwrap_or_default().split_once("as if: ").map(|hint| hint.1.to_owned())
        };
        let named = red.iter().filter(|row| hint(row).is_some_and(|hint| hint.contains(words))).count();
        let other = red.iter().filter(|row| hint(row).is_some_and(|hint| !hint.contains(words))).count();
        println!("{case}, {words}: {} red, {named} named, {other} otherwise", red.len());
        assert!(other == 0 && 4 * named >= 3 * red.len() && named > 0, "{case}, {words}: {red:#?}");
    }
}

/// Mistakes in Mindlin's law have no effect on linear springs.
#[test]
fn claims_with_linear_springs_do_not_see_mindlins() {
    for mistake in [MethodMistake::SecantSpring, MethodMistake::NotRescaled] {
        let red: Vec<_> =
            rows(Some(mistake), &["carried-grain"]).into_iter().filter(|row| row.red().is_some()).collect();
        assert!(red.is_empty(), "{mistake:?}: {red:#?}");
    }
}
