//! Plans whose inputs are edited after they were made, and points without a judged quantity.

use super::*;

/// A changed friction value in the sweep gives other tasks. The tasks with unchanged values stay finished.
#[test]
fn another_number_is_another_task() {
    let here = planned();
    here.ok("run --resume p");
    here.write("sweep.toml", SWEEP.replace("0.5, 0.9", "0.5, 0.8"));
    here.run("run --resume p").refused("sweep.toml: expected the file of the plan");
    here.ok("simulate sweep.toml --plan p");
    assert!(here.ok("run --resume p").out.contains("45 tasks: 30 were finished, 15 done now"));
}

/// Makes a plan, runs it, and returns the output of its report.
fn collected(here: &Path, plan: &str) -> Answer {
    here.ok(format!("{plan} --plan p"));
    here.ok("run --resume p");
    here.run("report p")
}

/// If a file on which results depend is edited, the plan is rejected, and a new plan runs its tasks again.
#[test]
fn an_edited_input_is_run_again() {
    let here = temporary();
    here.copy("examples/case", "c");
    here.copy("examples/python", "s");
    here.write("s/pkg/core.py", "FACTOR = 1.0\n");
    here.write("s/config.json", "{}");
    let edits: [(&str, &str, &str, &str); 6] = [
        ("run c", "c/claims.toml", "5/7 *", "6/7 *"),
        ("run c", "c/scene.toml", "friction = 0.5", "friction = 0.4"),
        ("run backspin/sphere --solver s/SOLVER.toml", "s/pkg/core.py", "1.0", "0.8"),
        ("run backspin/sphere --solver s/SOLVER.toml", "s/config.json", "{}", "{\"f\": 0.8}"),
        ("stability corner-of-two --solver s/SOLVER.toml", "s/one_grain.py", "import", "import os, "),
        ("run backspin/sphere --solver s/SOLVER.toml", "s/SOLVER.toml", "name", "# edited\nname"),
    ];
    for (plan, file, from, to) in edits {
        collected(&here, plan);
        here.edit(file, from, to);
        here.run("report p").refused("expected the file of the plan, found a changed file");
        here.ok(format!("{plan} --plan p"));
        let again = here.ok("run --resume p").out.clone();
        assert!(again.contains(" 0 were finished"), "{file}: {again}");
        fs::remove_dir_all(here.join("p")).unwrap();
    }
    assert!(collected(&here, "run c").out.contains("✗ c/plain"), "the claim is wrong now");
}

/// If an external solver is edited, its conformance properties are tested again.
#[test]
fn an_edited_program_owes_its_conformance_again() {
    let here = temporary();
    here.copy("examples/python", "s");
    let owed = || -> Vec<Value> {
        here.ok("run --solver s/SOLVER.toml --plan p");
        let text = here.read("p/tasks.jsonl");
        let tasks = text.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
        tasks.filter(|task| task["scene"] == "conformance").map(|task| task["id"].clone()).collect()
    };
    let before = owed();
    assert_eq!(before.len(), 1);
    assert_eq!(owed(), before);
    here.edit("s/one_grain.py", "import csv", "import os, csv");
    assert_ne!(owed(), before);
}

/// Another executable of LAMMPS counts as another solver.
#[test]
fn another_executable_is_another_task() {
    let here = temporary();
    let sweep = SWEEP.replace("solver = 'rigid'\nlevels = ['substeps=8']", "solver = 'lammps'\nlevels = ['dt=.1']");
    here.write("sweep.toml", sweep);
    let tasks = |plan: &str, text: &str| {
        here.write("lmp", text);
        Answer::of(here.program(format!("{plan} --plan p")).env("GRAINBENCH_LAMMPS", here.join("lmp"))).ok();
        here.read("p/tasks.jsonl")
    };
    let plans = [
        "simulate sweep.toml",
        "run incline-disc/60deg-mu.9 --solver lammps --live",
        "cost incline-disc/60deg-mu.9 --solver lammps --counts",
    ];
    for plan in plans {
        let before = tasks(plan, "one");
        assert_eq!(tasks(plan, "one"), before, "{plan}");
        assert_ne!(tasks(plan, "other"), before, "{plan}");
    }
}

/// A point outside its tolerance is red. A sweep with claims of which none was judged is red too. A sweep without claims is
/// red only with `--strict`.
#[test]
fn a_point_that_shows_nothing_is_not_green() {
    let here = temporary();
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
        here.write("sweep.toml", text);
        here.ok("simulate sweep.toml --plan p");
        here.ok("run --resume p");
        let answer = here.run("report p --strict");
        assert!(answer.code == Some(1) && answer.out.contains(counts), "{keys}: {}{}", answer.out, answer.err);
        assert_eq!(here.run("report p").code, Some(code), "{keys}");
    }
}
