//! What is kept of costs and of stability for the first screen of a page.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use grainbench::kept::{measured, sources};
use grainbench::reports::study::Study;
use grainbench::studies::kept::place;

fn study(name: &str) -> Study {
    serde_json::from_str(&std::fs::read_to_string(place(name)).unwrap()).unwrap()
}

/// Whoever reads a number must be able to have the tree that gave it.
#[test]
fn what_is_kept_says_of_which_sources_it_is() {
    for name in ["cost", "stability"] {
        let study = study(name);
        assert!(!study.provenance.commit.contains("changes"), "{name} was measured of a tree that nobody has");
        assert!(!study.provenance.options.iter().any(|word| word.contains("unfinished")), "{name} is half a study");
        for solver in ["dem", "mpm", "rigid"] {
            let hash = study.sources.get(solver).unwrap_or_else(|| panic!("{name}: no hash of {solver}"));
            assert_eq!(hash.len(), sources(solver).unwrap().len());
        }
    }
}

/// Old measurements are told, whichever solver has changed: another hash is never taken for the same.
#[test]
fn a_solver_that_changed_is_told() {
    let measured = measured().unwrap();
    let (cost, stability) = (measured.cost.unwrap(), measured.stability.unwrap());
    for (stamp, study) in [(&cost.stamp, study("cost")), (&stability.stamp, study("stability"))] {
        for solver in ["dem", "mpm", "rigid"] {
            assert_eq!(stamp.is_old(solver), study.sources.get(solver) != sources(solver).as_ref(), "{solver}");
        }
    }
    assert!(sources("somebody's").is_none() && sources("dem") != sources("mpm"));
    assert!(cost.lines.iter().any(|line| line.solver == "mpm" && line.factors[1].is_some()));
}
