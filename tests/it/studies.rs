//! The three studies on the command line. Their results hold, also after an interruption at any time.

use crate::common::{Directory, files, temporary, temporary_with};
use grainbench::cases::registry::CASES;
use grainbench::cases::solvers::Registry;
use grainbench::harness::case::Case;
use grainbench::reports::study::stability::Hardness;
use grainbench::scene::effect::Effect;
use grainbench::store::log::Entry;
use grainbench::studies::effects::ledger::Ledger;
use grainbench::studies::stability::assembly;
use grainbench::studies::stability::hard;
use grainbench::studies::stability::limit::of_assembly;
use rayon::prelude::*;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

#[test]
fn exact_limits_are_found_to_half_a_hundredth() {
    for assembly in assembly::all().unwrap() {
        let limit = of_assembly(&assembly, (&Registry, "dem"));
        let error = limit.error.unwrap_or_else(|| panic!("{}: {}", limit.scene, limit.detail));
        assert!(error.abs() < 0.005, "{} {:?}: {:?}, exact {}", limit.scene, limit.at, limit.found, assembly.exact);
    }
}

/// Control: springs that are 5 % stiffer have a limit that is 2.5 % smaller. The test distinguishes it from the exact limit.
#[test]
fn a_limit_of_other_springs_is_not_taken_for_the_exact_one() {
    for mut assembly in assembly::all().unwrap() {
        assembly.scene.change_laws(|law| {
            law.scale_normal(1.05);
            law.scale_tangential(1.05);
        });
        let limit = of_assembly(&assembly, (&Registry, "dem"));
        assert!(limit.error.is_none_or(|error| error < -0.012), "{} {:?}: {:?}", limit.scene, limit.at, limit.error);
    }
}

/// None of our solvers ends a hard case with a wrong result and no error. `dem` solves each hard case with some time
/// step, except the case of coinciding grains, which has no solution.
#[test]
fn hard_cases_hold_or_say_why_not() {
    // This case has a million steps, which is too long for this test.
    for case in hard::all().unwrap().iter().filter(|case| !case.name.starts_with("heap")) {
        for solver in ["dem", "rigid", "mpm"] {
            let row = hard::judge(case, &Registry, solver);
            let quiet = row.standing == Hardness::QuietlyWrong || row.detail.starts_with("quietly");
            assert!(!quiet, "{} · {solver}: {}", row.case, row.detail);
            let holds = matches!(row.standing, Hardness::Holds | Hardness::HoldsAtASmallerStep);
            let must = solver.starts_with("dem") && row.case != "exactly-coincident-grains";
            assert!(holds || !must, "{} · {solver}: {}", row.case, row.detail);
        }
    }
}

/// Effects of a case whose absence no claim detects. For every other active effect, a claim must fail without it. The
/// blocks are so long that grains that roll on them stay away from the periodic ends. The metal ring spins far below
/// its yield stress, because it tests the rotation of stresses in the plastic law.
const NOT_FELT: &[(&str, Effect)] = &[
    ("rolling-on-block", Effect::PeriodicAxes),
    ("sphere-on-block", Effect::PeriodicAxes),
    ("spinning-ring", Effect::Plasticity),
    // Walls or bodies that move with the frame, and effects in variants whose claims are about something else.
    ("border", Effect::MovingWalls),
    ("driven-disc", Effect::Friction),
    ("driven-disc", Effect::Gravity),
    ("free-block", Effect::PeriodicAxes),
    ("piston", Effect::Gravity),
    ("rolling-spring", Effect::PeriodicAxes),
    ("sheared-layer", Effect::Friction),
];

#[test]
fn an_effect_that_is_needed_is_caught_when_it_is_off() {
    let wrong = |case: &&'static Case| {
        let mut wrong = Vec::new();
        let ledger = Ledger::new(case, Arc::new(Registry));
        let mut effects: Vec<Effect> =
            ledger.pieces().iter().filter(|piece| piece.key.is_some()).map(|piece| piece.effect).collect();
        effects.sort_unstable();
        effects.dedup();
        for effect in effects {
            let caught = ledger.catches(effect);
            if caught.is_none() != NOT_FELT.contains(&(case.name, effect)) {
                wrong.push(format!("{}: {:?}, {}", case.name, effect, caught.unwrap_or_else(|| "not felt".to_owned())));
            }
        }
        wrong
    };
    let wrong: Vec<String> = CASES.par_iter().flat_map_iter(wrong).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Returns the `results.json` of a directory without the values that vary from run to run.
fn results(out: &Path) -> Value {
    let mut results = out.json("results.json");
    results["provenance"] = Value::Null;
    for point in results["points"].as_array_mut().unwrap() {
        for key in ["wall_seconds", "wall_spread", "cpu_seconds", "start_up_seconds", "repetitions"] {
            point[key] = Value::Null;
        }
    }
    results
}

const COST: &str = "cost squash collision --solver dem";

#[test]
fn ended_at_any_moment_it_goes_on_to_the_same_result() {
    let folder = temporary();
    folder.ok(format!("{COST} --out whole"));
    let out = folder.join("out");
    let mut state = 12345_u64;
    for _ in 0..10 {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        let mut child = folder.start(format!("{COST} --out out"));
        std::thread::sleep(Duration::from_millis(5 + (state >> 33) % 400));
        let _ = child.kill();
        child.wait().unwrap();
        // Each JSON file is complete.
        for name in files(&folder).iter().filter(|name| name.starts_with("out/") && name.ends_with(".json")) {
            if !name.contains(".grainbench-") {
                folder.json(name);
            }
        }
    }
    folder.ok(format!("{COST} --out out"));
    assert_eq!(results(&out), results(&folder.join("whole")));
    assert!(!files(&out).iter().any(|name| name.contains(".grainbench-")), "{:?}", files(&out));
    let again = folder.run(format!("{COST} --out out"));
    assert!(again.out.contains("24 of 24 tasks were finished before"), "{}", again.out);
}

/// Sets the times of all finished points: fixed times multiplied by a factor.
fn retime(out: &Path, factor: f64) {
    let retimed = |text: &str| {
        let (id, entry) = Entry::read(text, true).unwrap();
        let mut result: Value = serde_json::from_str(&entry.json).unwrap();
        let point = &mut result["Point"];
        point["wall_seconds"] = 1e-3.into();
        for (at, timing) in point["repetitions"].as_array_mut().unwrap().iter_mut().enumerate() {
            timing["cpu"] = (factor * 1e-3 * (1.0 + 0.02 * at as f64)).into();
            timing["reference"] = 1e-3.into();
        }
        Entry { json: result.to_string().into(), ..entry }.written(id)
    };
    for entry in fs::read_dir(out.join("results")).unwrap() {
        let path = entry.unwrap().path();
        let text = fs::read_to_string(&path).unwrap();
        let (head, lines) = text.split_once('\n').unwrap();
        fs::write(path, format!("{head}\n{}", lines.lines().map(retimed).collect::<String>())).unwrap();
    }
}

/// Finished points of an earlier version are only a cache. They are not read, and a note names their folder.
#[test]
fn points_of_an_earlier_version_are_measured_again() {
    let folder = temporary_with("out/points/0.json", "{}");
    let cost = |more: &str| folder.run(format!("{COST} --out out {more}"));
    let answer = cost("");
    assert!(answer.code == Some(0) && answer.err.contains("note: out/points: finished parts"), "{}", answer.err);
    assert!(answer.out.contains("0 of 24 tasks were finished before"), "{}", answer.out);
    // With `--no-cache`, finished points are measured again.
    assert!(cost("--no-cache").out.contains("0 of 24 tasks were finished before"));
    assert!(cost("").out.contains("24 of 24 tasks were finished before"));
    assert!(folder.join("out/points/0.json").is_file());
    // The directory of a plan keeps the results of the plan.
    folder.ok(format!("{COST} --plan plan"));
    folder.run(format!("{COST} --out plan")).refused("expected a directory without a plan");
}

#[test]
fn sessions_are_told_apart_by_counts_exactly_and_by_times_with_their_spread() {
    let folder = temporary();
    let out = folder.join("out");
    let cost = |more: &str| folder.run(format!("{COST} --out out {more}"));
    assert_eq!(cost("").code, Some(0));
    retime(&out, 1.0);
    assert_eq!(cost("").code, Some(0));
    let old = out.read("results.json");
    folder.write("old.json", &old);
    let against = || cost("--against old.json");
    let answer = against();
    assert!(answer.code == Some(0) && answer.out.contains("all counts are equal"), "{}", answer.out);
    // A machine that is 5 % slower is not reported; a kernel that is 25 % slower is reported.
    retime(&out, 1.05);
    assert_eq!(against().code, Some(0));
    retime(&out, 1.25);
    let answer = against();
    assert!(answer.code == Some(1) && answer.out.contains("slower by a factor 1.25"), "{}", answer.out);
    retime(&out, 1.0);
    folder.write("old.json", old.replacen("\"steps\": ", "\"steps\": 1", 1));
    let answer = against();
    assert!(answer.code == Some(1) && answer.out.contains("steps 1"), "{}", answer.out);
}

#[test]
fn a_study_is_drawn_again_from_its_directory() {
    let folder = temporary();
    let answer = folder.ok("stability free-pair mass-ratio --solver dem --out out --json");
    let results = answer.json();
    assert_eq!(results["stability"]["limits"].as_array().unwrap().len(), 1);
    assert_eq!(results["stability"]["hard"][0]["standing"], "holds");
    let page = folder.read("out/index.html");
    folder.ok("report out");
    assert_eq!(folder.read("out/index.html"), page);
}

/// An effect that is off has no influence when it is compiled in with a neutral value.
#[test]
fn an_absent_effect_is_inert() {
    let folder = temporary();
    // The chain has Hertz contacts without friction, and the segments are joined walls.
    let scenes = "collision/gamma-zeta.1 backspin/disc hertz-chain/plain wall-ends/segments";
    let answer = folder.ok(format!("effects {scenes} --out out --json"));
    let results = answer.json();
    let worth =
        |name: &str| results["effects"].as_array().unwrap().iter().filter(|entry| entry["worth"] == name).count();
    assert!(worth("inert") >= 18 && worth("not-inert") == 0 && worth("needed") >= 3, "{}", answer.out);
}
