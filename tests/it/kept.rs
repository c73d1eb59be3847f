//! Stored studies of cost, stability and effects, which the first screen of a page shows.

use grainbench::cases::kept::{Provenance, cases};
use grainbench::kept::{measured, sources};
use grainbench::reports::study::Study;
use grainbench::studies::kept::place;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

fn study(name: &str) -> Study {
    serde_json::from_str(&std::fs::read_to_string(place(name)).unwrap()).unwrap()
}

/// A reader must be able to get the source tree of each stored study.
#[test]
fn stored_results_name_their_sources() {
    for name in ["cost", "stability", "effects"] {
        let study = study(name);
        assert!(!study.provenance.commit.contains("changes"), "{name} was measured of a tree that nobody has");
        assert!(!study.provenance.options.iter().any(|word| word.contains("unfinished")), "{name} is half a study");
        for solver in ["dem", "mpm", "rigid"] {
            let hash = study.sources.get(solver).unwrap_or_else(|| panic!("{name}: no hash of {solver}"));
            assert_eq!(hash.len(), sources(solver).unwrap().len());
        }
    }
}

/// A stored measurement is marked as old if the hash of a solver's sources differs from the stored one.
#[test]
fn a_changed_solver_makes_stored_results_outdated() {
    let measured = measured().unwrap();
    let (cost, stability, effects) = (measured.cost.unwrap(), measured.stability.unwrap(), measured.effects.unwrap());
    let stamps = [(&cost.stamp, "cost"), (&stability.stamp, "stability"), (&effects.stamp, "effects")];
    for (stamp, study) in stamps.map(|(stamp, name)| (stamp, study(name))) {
        for solver in ["dem", "mpm", "rigid"] {
            assert_eq!(stamp.is_old(solver), study.sources.get(solver) != sources(solver).as_ref(), "{solver}");
        }
    }
    assert!(sources("somebody's").is_none() && sources("dem") != sources("mpm"));
    assert!(cost.lines.iter().any(|line| line.solver == "mpm" && line.factors[1].is_some()));
}

/// Each stored result names a commit in the history of the repository, so that a reader can build this version.
#[test]
fn what_is_kept_of_runs_was_made_by_commits_of_this_history() {
    let mut commits: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for case in cases() {
        let Ok(folders) = std::fs::read_dir(case.directory().join("kept")) else { continue };
        for folder in folders {
            let path = folder.unwrap().path().join("provenance.toml");
            let provenance: Provenance = toml::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
            commits.entry(provenance.commit).or_default().push(provenance.title);
        }
    }
    assert!(commits.values().map(Vec::len).sum::<usize>() > 50);
    let is_hash = |commit: &str| commit.len() >= 7 && commit.bytes().all(|byte| byte.is_ascii_hexdigit());
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let is_there = |commit: &str| {
        let asked =
            Command::new("git").arg("-C").arg(root).args(["merge-base", "--is-ancestor", commit, "HEAD"]).output();
        asked.is_ok_and(|answer| answer.status.success())
    };
    // A package, or a copy with another history, contains none of the commits. A shallow copy may lack some.
    let is_whole = !root.join(".git/shallow").exists();
    let has_history = is_whole && commits.keys().any(|commit| is_hash(commit) && is_there(commit));
    for (commit, results) in &commits {
        assert!(is_hash(commit), "{commit}: {results:?}");
        assert!(!has_history || is_there(commit), "{commit} is no commit of this history: {results:?}");
    }
}
