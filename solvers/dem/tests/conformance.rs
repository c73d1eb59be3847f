//! Conformance properties of every convention of the discrete element method.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use grainbench_dem::convention::Convention;
use grainbench_dem::solver::Dem;
use grainbench_harness::conformance::failures;
use grainbench_harness::verdict::Outcome;

#[test]
fn every_convention_conforms() {
    for convention in Convention::ALL {
        let dem = Dem::new(convention);
        assert_eq!(failures(&dem, &dem.terms()), Vec::<String>::new(), "{}", convention.name);
    }
}

/// Runs of 10⁵ steps with bouncing grains gain no energy. They are made only if `GRAINBENCH_LONG=1` is set.
#[test]
fn nothing_gains_energy_in_the_long_run() {
    if std::env::var_os("GRAINBENCH_LONG").is_none_or(|value| value != "1") {
        return;
    }
    let passivity = grainbench_harness::conformance::ALL.iter().find(|property| property.name == "passivity").unwrap();
    for convention in Convention::ALL {
        let dem = Dem::new(convention);
        for row in passivity.check(&dem, &dem.terms().at_length()) {
            assert!(!matches!(row.outcome, Outcome::Fail | Outcome::Broken), "{}: {row:?}", convention.name);
        }
    }
}
