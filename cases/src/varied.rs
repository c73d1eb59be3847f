//! Material point method with settings in its name, such as `mpm+quadratic+apic`, for claims that need other settings
//! than the defaults.

use grainbench_harness::wrapper::{Start, Wrapped, Wrapper};
use grainbench_mpm::options::{Basis, Setting, StressUpdate, Transfer};
use grainbench_mpm::solver::Mpm;
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::observer::Observer;
use grainbench_solver::record::Record;

/// Returns the solver with a name such as `mpm+apic`; `None` if the name or a word after `+` is unknown.
pub(crate) fn by_name(name: &str) -> Option<Box<dyn Solver>> {
    let (base, words) = name.split_once('+')?;
    let mut mpm = Mpm::named(base)?;
    for word in words.split('+') {
        change(&mut mpm.setting, word)?;
    }
    Some(Box::new(Wrapped(VariedMpm { name: name.to_owned(), mpm })))
}

/// Changes the setting that a word of the solver name selects; `None` if the word is unknown.
fn change(setting: &mut Setting, word: &str) -> Option<()> {
    match word {
        "linear" => setting.basis = Basis::Linear,
        "quadratic" => setting.basis = Basis::Quadratic,
        "gimp" => setting.basis = Basis::Gimp,
        "flip" => setting.transfer = Transfer::Flip { pic: 0.0 },
        "apic" => setting.transfer = Transfer::Apic,
        "spin" => setting.transfer = Transfer::Spin,
        "usf" => setting.stress_update = StressUpdate::First,
        "usl" => setting.stress_update = StressUpdate::Last,
        "musl" => setting.stress_update = StressUpdate::ModifiedLast,
        _ => {
            let (key, value) = word.split_once('=')?;
            let value = value.parse::<f64>().ok().filter(|value| value.is_finite())?;
            match key {
                "pic" if (0.0..=1.0).contains(&value) => setting.transfer = Transfer::Flip { pic: value },
                "penalty" if value > 0.0 => setting.penalty = value,
                "tracers" if value > 0.0 => setting.tracers = value,
                "phase" => setting.phase = [value; 3],
                _ => return None,
            }
        }
    }
    Some(())
}

/// The material point method with the settings in its name.
struct VariedMpm {
    name: String,
    mpm: Mpm,
}

impl Wrapper for VariedMpm {
    fn inner(&self) -> &dyn Solver {
        &self.mpm
    }

    fn name(&self) -> String {
        self.name.clone()
    }

    fn run(&self, start: Start<'_>, observer: &mut dyn Observer) -> Result<Record, RunError> {
        let mut record = start.run(&self.mpm, observer)?;
        record.provenance.solver.clone_from(&self.name);
        Ok(record)
    }
}
