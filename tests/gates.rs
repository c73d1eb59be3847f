//! Every gate of the registry, and for every gate its negative control: a test each. Those of the long set, which take minutes,
//! take part with `GRAINBENCH_LONG=1`.

use grainbench::cases::bench::Bench;
use grainbench::cases::gate::{Gate, Set, Standing};
use grainbench::cases::registry::CASES;
use grainbench::cases::verdict::Outcome;
use libtest_mimic::{Arguments, Failed, Trial};
use std::sync::Arc;

fn main() -> std::process::ExitCode {
    let long = std::env::var_os("GRAINBENCH_LONG").is_some_and(|value| value == "1");
    let set = if long { Set::Long } else { Set::Tests };
    let mut trials = Vec::new();
    for case in CASES {
        let bench = Arc::new(Bench::new(case));
        for gate in (case.gates)().into_iter().filter(|gate| gate.set() <= set) {
            let gate = Arc::new(gate);
            let run = &gate.runs[0];
            let name = format!("{}/{} {} {}: {}", case.name, run.variant, run.solver, gate.resolution(), gate.quantity);
            trials.push(trial(&name, &bench, &gate, accept));
            trials.push(trial(&format!("{name} [control: {}]", gate.control.name), &bench, &gate, refuse));
        }
    }
    libtest_mimic::run(&Arguments::from_args(), trials).exit_code()
}

fn trial(name: &str, bench: &Arc<Bench>, gate: &Arc<Gate>, test: fn(&Bench, &Gate) -> Result<(), Failed>) -> Trial {
    let (bench, gate) = (Arc::clone(bench), Arc::clone(gate));
    Trial::test(name, move || test(&bench, &gate))
}

/// The gate passes; where the solver must refuse the scene, it does, with a reason; a known error is still there; where it is
/// a program that is not installed, that is what the row says.
fn accept(bench: &Bench, gate: &Gate) -> Result<(), Failed> {
    let verdict = bench.judge(gate);
    let expected = match gate.standing() {
        _ if !bench.is_available(gate) => Outcome::NotAvailable,
        Standing::Passes => Outcome::Pass,
        Standing::Refused => Outcome::Unsupported,
        Standing::Known(_) => Outcome::Known,
    };
    if verdict.outcome == expected { Ok(()) } else { Err(grainbench::reports::line::verdict(&verdict).into()) }
}

/// The gate turns red when its physics is wrong.
fn refuse(bench: &Bench, gate: &Gate) -> Result<(), Failed> {
    if !bench.is_available(gate) {
        return Ok(());
    }
    let control = bench.control(gate);
    if control.turned_red {
        return Ok(());
    }
    Err(format!(
        "{} · {} · {}: did not notice that {}: error {:?}, allowed {:e}",
        control.case, control.solver, control.quantity, control.wrong_physics, control.error, control.allowed
    )
    .into())
}
