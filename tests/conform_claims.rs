//! Claims about friction between grains, springs that turn and rolling memories see planted defects of a small solver by value.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod small_dem;

use grainbench::harness::control::Red;
use grainbench::harness::verdict::{Outcome, Verdict};
use small_dem::{Mutant, SmallDem};

const CASES: [&str; 5] = ["unequal-impact", "rolling-off", "carried-grain", "turning-walls", "rocking"];

fn rows(mutant: Option<Mutant>, cases: &[&str]) -> Vec<Verdict> {
    grainbench::judge(SmallDem { mutant }, cases).unwrap().verdicts
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
    let expected: [(Mutant, &[&str]); 8] = [
        (Mutant::SpringNotTurned, &["carried-grain", "turning-walls"]),
        (Mutant::TwistNotFollowed, &["carried-grain", "turning-walls"]),
        (Mutant::MeanArm, &["unequal-impact", "rolling-off"]),
        (Mutant::OneArm, &["unequal-impact", "rolling-off", "carried-grain"]),
        (Mutant::WrongSpin, &["rolling-off", "carried-grain"]),
        (Mutant::WallSpinDropped, &["turning-walls"]),
        (Mutant::RollingNotCut, &["rocking"]),
        (Mutant::SpinsDropped, &["carried-grain", "turning-walls", "rocking"]),
    ];
    for (mutant, cases) in expected {
        for case in cases {
            let rows = rows(Some(mutant), &[case]);
            let red: Vec<_> =
                rows.iter().filter(|row| row.red() == Some(Red::Value)).map(|row| &row.quantity).collect();
            assert!(!red.is_empty(), "{mutant:?} in {case}");
            println!("{mutant:?} in {case}: {} of {} red: {red:?}", red.len(), rows.len());
        }
    }
}

/// Defects of Mindlin's law change nothing where springs are linear.
#[test]
fn claims_with_linear_springs_do_not_see_mindlins() {
    for mutant in [Mutant::SecantSpring, Mutant::NotRescaled] {
        let red: Vec<_> =
            rows(Some(mutant), &["carried-grain"]).into_iter().filter(|row| row.red().is_some()).collect();
        assert!(red.is_empty(), "{mutant:?}: {red:#?}");
    }
}
