//! Every gate of the registry, and for every gate its negative control: a test each. Those of the long set, which take
//! minutes, take part with `GRAINBENCH_LONG=1`; `GRAINBENCH_PROCESSOR` forces the path that our solvers take.

use grainbench::cases::registry::CASES;
use grainbench::cases::runner;
use grainbench::harness::claim::Claim;
use grainbench::harness::run::{Set, Standing};
use grainbench::harness::runner::Runner;
use grainbench::harness::verdict::Outcome;
use grainbench::lanes::Processor;
use libtest_mimic::{Arguments, Failed, Trial};
use std::sync::Arc;

fn main() -> std::process::ExitCode {
    // A path that this processor does not have would be another one, and judge nothing.
    if let Err(reason) = Processor::forced() {
        eprintln!("error: {reason}");
        return std::process::ExitCode::from(2);
    }
    let long = std::env::var_os("GRAINBENCH_LONG").is_some_and(|value| value == "1");
    let set = if long { Set::Long } else { Set::Tests };
    let mut trials = Vec::new();
    for case in CASES {
        let runner = Arc::new(runner(case).afresh(set));
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

/// The gate passes; where the solver must refuse the scene, it does, with a reason; a known error is still there; where
/// it is a program that is not installed, that is what the row says.
fn accept(runner: &Runner, claim: &Claim) -> Result<(), Failed> {
    let verdict = runner.judge(claim);
    let expected = match claim.standing() {
        _ if !runner.is_available(claim) => Outcome::NotAvailable,
        Standing::Passes => Outcome::Pass,
        Standing::Refused => Outcome::Unsupported,
        Standing::Known(_) => Outcome::Known,
    };
    if verdict.outcome == expected { Ok(()) } else { Err(grainbench::reports::line::verdict(&verdict).into()) }
}

/// The gate turns red when its physics is wrong, and in the way that it must: by its value, or by breaking.
fn refuse(runner: &Runner, claim: &Claim) -> Result<(), Failed> {
    if !runner.is_available(claim) {
        return Ok(());
    }
    let control = runner.control(claim);
    if control.turned_red { Ok(()) } else { Err(grainbench::reports::line::control(&control).into()) }
}
