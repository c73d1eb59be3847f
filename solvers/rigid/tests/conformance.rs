//! Test of the conformance properties of rapier, with its limitations.

use grainbench_harness::conformance::failures;
use grainbench_rigid::solver::Rigid;

#[test]
fn a_rigid_engine_owes_less_and_that_much_it_keeps() {
    assert_eq!(failures(&Rigid::new(), &Rigid::TERMS), Vec::<String>::new());
}
