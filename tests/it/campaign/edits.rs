//! Plans whose inputs are edited after they were made, and points without a judged quantity.

use super::*;

/// A changed friction value in the sweep gives other tasks. The tasks with unchanged values stay finished.
#[test]
fn another_number_is_another_task() {
    let directory = planned();
    let here = directory.path();
    ok(&grainbench(here, &["run", "--resume", "p"]));
    fs::write(here.join("sweep.toml"), SWEEP.replace("0.5, 0.9", "0.5, 0.8")).unwrap();
    let stale = grainbench(here, &["run", "--resume", "p"]);
    assert!(stale.code == Some(2) && stale.err.contains("sweep.toml: expected the file of the plan"), "{}", stale.err);
    ok(&grainbench(here, &["simulate", "sweep.toml", "--plan", "p"]));
    assert!(ok(&grainbench(here, &["run", "--resume", "p"])).out.contains("45 tasks: 30 were finished, 15 done now"));
}

/// Copies `examples/python` to the folder `s`, with a replacement in its files.
fn one_grain(here: &Path, replaced: (&str, &str)) {
    fs::create_dir_all(here.join("s")).unwrap();
    for name in ["SOLVER.toml", "one_grain.py"] {
        let text = fs::read_to_string(crate::common::root("examples/python").join(name)).unwrap();
        fs::write(here.join("s").join(name), text.replace(replaced.0, replaced.1)).unwrap();
    }
}

/// Makes a plan, runs it, and returns the output of its report.
fn collected(here: &Path, plan: &[&str]) -> Answer {
    ok(&grainbench(here, &[plan, &["--plan", "p"]].concat()));
    ok(&grainbench(here, &["run", "--resume", "p"]));
    grainbench(here, &["report", "p"])
}

/// If a file on which results depend is edited, the plan is rejected, and a new plan runs its tasks again.
#[test]
fn an_edited_input_is_run_again() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    fs::create_dir(here.join("c")).unwrap();
    for name in ["scene.toml", "claims.toml"] {
        fs::copy(crate::common::root("examples/case").join(name), here.join("c").join(name)).unwrap();
    }
    one_grain(here, ("", ""));
    fs::create_dir(here.join("s/pkg")).unwrap();
    fs::write(here.join("s/pkg/core.py"), "FACTOR = 1.0\n").unwrap();
    fs::write(here.join("s/config.json"), "{}").unwrap();
    let edits: [(&[&str], &str, &str, &str); 6] = [
        (&["run", "c"], "c/claims.toml", "5/7 *", "6/7 *"),
        (&["run", "c"], "c/scene.toml", "friction = 0.5", "friction = 0.4"),
        (&["run", "backspin/sphere", "--solver", "s/SOLVER.toml"], "s/pkg/core.py", "1.0", "0.8"),
        (&["run", "backspin/sphere", "--solver", "s/SOLVER.toml"], "s/config.json", "{}", "{\"f\": 0.8}"),
        (&["stability", "corner-of-two", "--solver", "s/SOLVER.toml"], "s/one_grain.py", "import", "import os, "),
        (&["run", "backspin/sphere", "--solver", "s/SOLVER.toml"], "s/SOLVER.toml", "name", "# edited\nname"),
    ];
    for (plan, file, from, to) in edits {
        collected(here, plan);
        let path = here.join(file);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{file}: {from}");
        fs::write(&path, text.replacen(from, to, 1)).unwrap();
        let stale = grainbench(here, &["report", "p"]);
        let message = "expected the file of the plan, found a changed file";
        assert!(stale.code == Some(2) && stale.err.contains(message), "{file}: {}", stale.err);
        ok(&grainbench(here, &[plan, &["--plan", "p"]].concat()));
        let again = ok(&grainbench(here, &["run", "--resume", "p"])).out.clone();
        assert!(again.contains(" 0 were finished"), "{file}: {again}");
        fs::remove_dir_all(here.join("p")).unwrap();
    }
    assert!(collected(here, &["run", "c"]).out.contains("✗ c/plain"), "the claim is wrong now");
}

/// If an external solver is edited, its conformance properties are tested again.
#[test]
fn an_edited_program_owes_its_conformance_again() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    one_grain(here, ("", ""));
    let owed = || -> Vec<Value> {
        ok(&grainbench(here, &["run", "--solver", "s/SOLVER.toml", "--plan", "p"]));
        let text = fs::read_to_string(here.join("p/tasks.jsonl")).unwrap();
        let tasks = text.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
        tasks.filter(|task| task["scene"] == "conformance").map(|task| task["id"].clone()).collect()
    };
    let before = owed();
    assert_eq!(before.len(), 1);
    assert_eq!(owed(), before);
    one_grain(here, ("import csv", "import os, csv"));
    assert_ne!(owed(), before);
}

/// Another executable of LAMMPS counts as another solver.
#[test]
fn another_executable_is_another_task() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let sweep = SWEEP.replace("solver = 'rigid'\nlevels = ['substeps=8']", "solver = 'lammps'\nlevels = ['dt=.1']");
    fs::write(here.join("sweep.toml"), sweep).unwrap();
    let tasks = |plan: &[&str], text: &str| {
        fs::write(here.join("lmp"), text).unwrap();
        let done = crate::common::program()
            .env("GRAINBENCH_LAMMPS", here.join("lmp"))
            .args([plan, &["--plan", "p"]].concat())
            .current_dir(here)
            .output()
            .unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        fs::read_to_string(here.join("p/tasks.jsonl")).unwrap()
    };
    let plans: [&[&str]; 3] = [
        &["simulate", "sweep.toml"],
        &["run", "incline-disc/60deg-mu.9", "--solver", "lammps", "--live"],
        &["cost", "incline-disc/60deg-mu.9", "--solver", "lammps", "--counts"],
    ];
    for plan in plans {
        let before = tasks(plan, "one");
        assert_eq!(tasks(plan, "one"), before, "{plan:?}");
        assert_ne!(tasks(plan, "other"), before, "{plan:?}");
    }
}

/// A point outside its tolerance is red. A sweep with claims of which none was judged is red too. A sweep without claims is
/// red only with `--strict`.
#[test]
fn a_point_that_shows_nothing_is_not_green() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let (head, solvers) =
        (SWEEP.split("[[gates]]").next().unwrap(), SWEEP.split("levels = ['dt=.1', 'dt=.05']").next());
    let solvers = &solvers.unwrap()[SWEEP.find("[[solvers]]").unwrap()..];
    let record = "[[record]]\nquantity = 'v'\nunit = 'm/s'\nvalue = 'grain.vx'\n";
    let cases = [
        ("", "0 within, 0 outside or broken, 0 amber, 15 not judged", 0),
        ("equals = '900*t'\nallowed = 2\n", "0 within, 0 outside or broken, 15 amber", 1),
        ("equals = '900*t'\nallowed = 0.5\n", "0 within, 15 outside or broken, 0 amber", 1),
        ("equals = '900*t'\nallowed = 0.5\nscale = '0 - 1e9*mu'\n", "0 within, 15 outside or broken, 0 amber", 1),
    ];
    for (keys, counts, code) in cases {
        let text = format!("{head}{record}{keys}{solvers}levels = ['dt=.1']\n");
        fs::write(here.join("sweep.toml"), text).unwrap();
        ok(&grainbench(here, &["simulate", "sweep.toml", "--plan", "p"]));
        ok(&grainbench(here, &["run", "--resume", "p"]));
        let answer = grainbench(here, &["report", "p", "--strict"]);
        assert!(answer.code == Some(1) && answer.out.contains(counts), "{keys}: {}{}", answer.out, answer.err);
        assert_eq!(grainbench(here, &["report", "p"]).code, Some(code), "{keys}");
    }
}
