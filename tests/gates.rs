//! One test for each claim of the registry, and one for each negative control. `GRAINBENCH_LONG=1` adds the claims of
//! the long tier, which take minutes. `GRAINBENCH_PROCESSOR` selects the instruction set of our solvers.

use grainbench::cases::registry::CASES;
use grainbench::cases::runner;
use grainbench::harness::claim::Claim;
use grainbench::harness::control::Control;
use grainbench::harness::run::{ExpectedOutcome, Set};
use grainbench::harness::runner::{Runner, RunnerOptions};
use grainbench::harness::verdict::Outcome;
use grainbench::lanes::Processor;
use libtest_mimic::{Arguments, Failed, Trial};
use std::sync::Arc;

fn main() -> std::process::ExitCode {
    // If this processor lacks the selected instruction set, the test program must not run with another one.
    if let Err(reason) = Processor::forced() {
        eprintln!("error: {reason}");
        return std::process::ExitCode::from(2);
    }
    let long = std::env::var_os("GRAINBENCH_LONG").is_some_and(|value| value == "1");
    let set = if long { Set::Long } else { Set::Tests };
    let mut trials = Vec::new();
    for case in CASES {
        let options = RunnerOptions { repeated: Some(set), ..RunnerOptions::default() };
        let runner = Arc::new(runner(case).with(options));
        for claim in (case.claims)().into_iter().filter(|claim| claim.set() <= set) {
            let claim = Arc::new(claim);
            let run = &claim.runs[0];
            let name =
                format!("{}/{} {} {}: {}", case.name, run.variant, run.solver, claim.resolution(), claim.quantity);
            trials.push(trial(&name, &runner, &claim, accept));
            trials.push(trial(&format!("{name} [control: {}]", claim.control.name), &runner, &claim, refuse));
        }
    }
    libtest_mimic::run(&Arguments::from_args(), trials).exit_code()
}

fn trial(
    name: &str,
    runner: &Arc<Runner>,
    claim: &Arc<Claim>,
    test: fn(&Runner, &Claim) -> Result<(), Failed>,
) -> Trial {
    let (runner, claim) = (Arc::clone(runner), Arc::clone(claim));
    Trial::test(name, move || test(&runner, &claim))
}

/// Checks the expected outcome of a claim: passed, unsupported with a reason, or a known error that still exists. If an
/// external solver of the claim is not installed, the outcome must state it.
fn accept(runner: &Runner, claim: &Claim) -> Result<(), Failed> {
    let verdict = runner.judge(claim);
    let expected = match claim.standing() {
        _ if !runner.is_available(claim) => Outcome::NotAvailable,
        ExpectedOutcome::Passes => Outcome::Pass,
        ExpectedOutcome::Refused => Outcome::Unsupported,
        ExpectedOutcome::Known(_) => Outcome::Known,
    };
    // A stored result of older solver sources stays amber until the run is repeated.
    let is_expected = verdict.outcome == expected || (expected, verdict.outcome) == (Outcome::Pass, Outcome::Outdated);
    if is_expected { Ok(()) } else { Err(grainbench::reports::line::verdict(&verdict).into()) }
}

/// Checks that a claim fails under its negative control in the required way, by value or by error.
fn refuse(runner: &Runner, claim: &Claim) -> Result<(), Failed> {
    if !runner.is_available(claim) {
        return Ok(());
    }
    let control = runner.control(claim);
    if !control.turned_red {
        return Err(grainbench::reports::line::control(&control).into());
    }
    // The wrong physics must cause the failure, not the coarser resolution of the control.
    if let (Some(resolution), Some(wrong)) = (claim.control.resolution, control.error) {
        let same = Control::scene("right physics", |_| ()).coarser(resolution);
        let right = runner.control(&Claim { control: same, ..claim.clone() }).error;
        if !right.is_some_and(|right| right.abs() < (0.5 * wrong.abs()).max(control.allowed)) {
            return Err(
                format!("at {resolution}, right physics is off by {right:?}, wrong physics by {wrong:e}").into()
            );
        }
    }
    Ok(())
}
