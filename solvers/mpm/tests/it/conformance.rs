//! Conformance properties, with the weaker limits of methods with a grid. Every named setting is tested in two
//! dimensions. With `GRAINBENCH_LONG=1`, `mpm` is also tested in three dimensions.

use grainbench_harness::conformance::failures;
use grainbench_mpm::solver::Mpm;

fn keeps(name: &str) {
    let mpm = Mpm::named(name).unwrap_or(Mpm::BEST);
    let long = std::env::var_os("GRAINBENCH_LONG").is_some_and(|value| value == "1");
    let terms = if long && mpm == Mpm::BEST { mpm.terms() } else { mpm.terms().in_the_plane() };
    assert_eq!(mpm.name, name);
    assert_eq!(failures(&mpm, &terms), Vec::<String>::new(), "{name}");
}

#[test]
fn the_best_setting_owes_less_and_that_much_it_keeps() {
    keeps("mpm");
}

#[test]
fn the_papers_contacts_owe_less_still() {
    keeps("mpm:2000");
    keeps("mpm:2001");
}

#[test]
fn other_contacts_on_hat_functions_owe_less() {
    keeps("mpm:gap");
    keeps("mpm:penalty");
    keeps("mpm:no-slip");
}
