//! What every solver owes, of every convention of the discrete element method.

use grainbench_dem::convention::Convention;
use grainbench_dem::solver::Dem;
use grainbench_harness::conformance::failures;

#[test]
fn every_convention_conforms() {
    for convention in Convention::ALL {
        let dem = Dem::new(convention);
        assert_eq!(failures(&dem, &Dem::TERMS), Vec::<String>::new(), "{}", convention.name);
    }
}
