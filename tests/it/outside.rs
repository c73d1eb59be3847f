//! External solvers with manifests: one that moves a grain correctly, and several with wrong output.

use crate::common::{Answer, Directory, Folder, is_here, temporary};
use rayon::prelude::*;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

const MANIFEST: &str = include_str!("../scenes/liar.toml");
const HEAD: &str = "step,id,x,y,z,vx,vy,vz,omegax,omegay,omegaz";
const CASE: &str = "incline-disc/30deg-mu.5";

fn write(folder: &Path, manifest: &str, script: &str) {
    folder.write("SOLVER.toml", manifest);
    folder.write("liar.sh", script);
}

/// Returns the command lines of all processes on this machine.
fn running() -> String {
    let running = Command::new("ps").args(["-eo", "args"]).output();
    running.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default()
}

/// Runs the claims of a case with a solver. The solver passes no claim, so that the run is red.
fn red(folder: &Path, further: &str) -> Answer {
    let answer = folder.run(format!("run {CASE} --solver SOLVER.toml --json {further}"));
    assert_eq!(answer.code, Some(1), "{}", answer.err);
    answer
}

/// Checks the outcome of all results of a solver, and a part of their message.
fn is_found_out(manifest: &str, script: &str, verdict: &str, message: &str) {
    let directory = temporary();
    write(&directory, manifest, script);
    let rows = red(&directory, "--no-controls").rows();
    assert!(!rows.is_empty(), "{script}");
    for row in rows {
        assert_eq!(row["verdict"], verdict, "{script}: {row}");
        assert!(row["detail"].as_str().unwrap_or_default().contains(message), "{script}: {row}");
    }
}

/// Each wrong output is detected, and its message helps the author of a solver.
#[test]
fn a_program_that_lies_is_found_out() {
    let row = "0,1,0,0.4995,0,0,0,0,0,0,0";
    let table = |row: &str| format!("printf '{HEAD}\\n{row}\\n' > \"$2/grains.csv\"");
    let lies = [
        // No output.
        ("exit 0".to_owned(), "grains.csv"),
        ("echo 'a,b' > \"$2/grains.csv\"; echo 'x,y' >> \"$2/grains.csv\"".to_owned(), "grains.csv:2:1"),
        (table("0,1,nan,0.4995,0,0,0,0,0,0,0"), "found `nan`"),
        (table("0,1.5,0,0.4995,0,0,0,0,0,0,0"), "expected a whole number of 0 or more"),
        (table("0,-5.5,0,0.4995,0,0,0,0,0,0,0"), "found -5.5"),
        // Other names of spins.
        (
            table(row).replace("omega", "w"),
            "expected the column `omegax`, or its name in `output.grains.map`, found `wx`",
        ),
        // An early end.
        (table(row), "expected samples to step"),
        ("sleep 1000".to_owned(), "not done after 2 s"),
        // A child that goes on, and a child in another session.
        ("sleep 1234 & exit 0".to_owned(), "grains.csv"),
        ("setsid sleep 1235 > /dev/null 2>&1 & sleep 1000".to_owned(), "not done after 2 s"),
        ("head -c 10000000000 /dev/zero > \"$2/big\"".to_owned(), "found more"),
        ("yes".to_owned(), "found more"),
        ("echo 'out of memory' >&2; exit 3".to_owned(), "it said last: out of memory"),
        ("ln -s /dev/zero \"$2/grains.csv\"".to_owned(), "expected a plain file"),
    ];
    for (script, message) in lies {
        is_found_out(MANIFEST, &script, "broken", message);
    }
    is_found_out(MANIFEST, "echo 'no friction here'; exit 64", "unsupported", "no friction here");
    assert!(!running().contains("sleep 1234"), "what it started goes with it");
    assert!(!running().contains("sleep 1235"), "and what it started in a session");
    // The files of a folder that is a symbolic link may belong to another run.
    let script = table(row).replace("\"$2/grains.csv\"", "elsewhere/grains.csv");
    let script = format!("mkdir elsewhere; {script}; ln -s \"$PWD/elsewhere\" \"$2/sub\"");
    let manifest = MANIFEST.replace("\"grains.csv\"", "\"sub/grains.csv\"");
    let message = "sub/grains.csv: expected the folder sub, found a link or a file";
    is_found_out(&manifest, &script, "broken", message);
}

/// A worker process with wrong output is detected too, and its child processes end with it.
#[test]
fn a_worker_that_lies_is_found_out() {
    let manifest =
        MANIFEST.replace("run = [\"sh\", \"liar.sh\", \"{scene}\", \"{out}\"]", "worker = [\"sh\", \"liar.sh\"]");
    let lies = [
        ("echo '{\"ran\": {}}'", "broken", "grains.csv"),
        ("echo nonsense", "broken", "found `nonsense`"),
        ("exit 0", "broken", "the worker ended"),
        ("sleep 1000", "broken", "not done after 2 s"),
        ("head -c 10000000000 /dev/zero > big", "broken", "found more"),
        ("echo '{\"failed\": {\"why\": \"a nail\", \"when\": 0.5}}'", "broken", "time 0.5, place unknown"),
        ("echo '{\"ran\": {\"seconds\": -1}}'", "broken", "expected seconds of zero or more, found -1"),
        ("echo '{\"cannot\": \"no friction here\"}'", "unsupported", "no friction here"),
    ];
    for (script, verdict, message) in lies {
        let script = format!("sleep 4321 &\nwhile read -r line; do\n{script}\ndone");
        is_found_out(&manifest, &script, verdict, message);
    }
    assert!(!running().contains("sleep 4321"), "what it started goes with it");
}

/// If the manifest does not declare an effect, scenes with this effect are not run. The results of a missing program are amber.
#[test]
fn what_is_not_declared_is_not_asked_for() {
    let path = temporary();
    let reason = |manifest: &str| {
        write(&path, manifest, "exit 0");
        let results = red(&path, "").json();
        assert!(results["controls"].as_array().unwrap().is_empty(), "what cannot be expressed has no control");
        let row = &results["verdicts"][0];
        (row["verdict"].as_str().unwrap().to_owned(), row["detail"].as_str().unwrap_or_default().to_owned())
    };
    let less = [
        ("[2, 3]", "[3]", "scenes in 2 dimensions"),
        ("[\"linear\"]", "[\"hertz-mindlin\"]", "laws `linear`"),
        ("walls = [\"plane\"]", "", "walls `plane`"),
        ("\"friction\", ", "", "effects `friction`"),
    ];
    for (declared, instead, message) in less {
        let (verdict, detail) = reason(&MANIFEST.replace(declared, instead));
        assert!(verdict == "unsupported" && detail.contains(message), "{verdict}: {detail}");
    }
    let (verdict, detail) = reason(&MANIFEST.replace("\"sh\"", "\"no-such-program\""));
    assert!(verdict == "not-available" && detail.contains("there is no `no-such-program`"), "{verdict}: {detail}");
}

/// External solvers get a resolved scene. It has the same content as JSON and as TOML.
#[test]
fn a_scene_is_printed_as_programs_are_given_it() {
    let directory = temporary();
    let print = |further: &str| directory.ok(format!("scene incline-disc/60deg-mu.9 {further}"));
    let json = print("").json();
    let toml: toml::Table = print("--format toml").out.parse().unwrap();
    assert_eq!(json, serde_json::to_value(toml).unwrap());
    assert!(json["steps"]["count"].as_u64() > Some(0), "{json}");
    let [format, column, friction] = [&json["format"], &json["columns"][0], &json["laws"][0]["friction"]];
    assert!(*format == 1 && *column == "grain.x" && *friction == 0.9, "{json}");
    let other = print("--set contacts.plane.friction=0.25").json();
    assert_eq!(other["laws"][0]["friction"], 0.25);
    // The printed scene has every key that the schema of resolved scenes requires.
    let schema = directory.ok("scene --schema=resolved").json();
    let required = schema["required"].as_array().unwrap();
    assert!(required.len() > 5 && required.iter().all(|key| json.get(key.as_str().unwrap()).is_some()), "{schema}");
}

/// Copies the files of an example to a separate folder, optionally with a defect in one file.
fn example(name: &str, file: &str, spoiled: Option<(&str, &str)>) -> Folder {
    let directory = temporary();
    directory.copy(&format!("examples/{name}"), "");
    if let Some((right, wrong)) = spoiled {
        directory.edit(file, right, wrong);
    }
    directory
}

/// Returns the exit code of a run of an example, and the number of passed results.
fn passes(folder: &Path, cases: &str, further: &str) -> (Option<i32>, usize) {
    let answer = folder.run(format!("run {cases} --solver SOLVER.toml --json {further}"));
    let rows = answer.rows();
    (answer.code, rows.iter().filter(|row| row["verdict"] == "pass").count())
}

const EASY: &str = "incline-disc/30deg-mu.5 incline-sphere/45deg-mu.495 backspin/sphere oblique-impact";

/// A solver for one grain in forty lines of Python passes its claims. A defect in any line of its physics makes claims fail.
#[test]
fn a_grain_in_python_is_judged_line_by_line() {
    if !is_here("python3") {
        return;
    }
    let whole = example("python", "", None);
    let (code, passed) = passes(&whole, EASY, "");
    assert!(code == Some(0) && passed > 5, "{passed} pass");
    let spoiled = [
        ("mass * g for", "0.99 * mass * g for"),
        ("radius - dot(plus", "0.99 * radius - dot(plus"),
        ("[-radius * part", "[-0.99 * radius * part"),
        ("plus(v, cross(spin, arm))", "plus(v, cross(spin, arm), 0.99)"),
        ("plus(slip, n, -dot(slip, n))", "plus(slip, n, -0.9 * dot(slip, n))"),
        ("stiffness[0] * overlap", "0.95 * stiffness[0] * overlap"),
        ("- dashpot[0] * dot", "- 0.9 * dashpot[0] * dot"),
        ("law[name] * mass", "0.9 * law[name] * mass"),
        ("law[\"stiffness_damping\"] * k", "0.9 * law[\"stiffness_damping\"] * k"),
        (
            "drag = plus(springs[wall[\"name\"]], slip, stiffness[1] * step), [dashpot[1]",
            "drag = plus(springs[wall[\"name\"]], slip, stiffness[1] * step), [0.9 * dashpot[1]",
        ),
        ("stiffness[1] * step", "0.95 * stiffness[1] * step"),
        ("plus([-part for part in spring], drag, -1), law", "plus([-part for part in spring], drag, 1), law"),
        ("law[\"friction\"] * max", "0.99 * law[\"friction\"] * max"),
        ("factor = min(1.0, ", "factor = min(2.0, "),
        ("plus(plus(force, n, push), friction)", "plus(plus(force, n, push), friction, 0.99)"),
        ("plus(torque, cross(arm, friction))", "plus(torque, cross(arm, friction), 0.99)"),
        ("dt / mass / 2", "dt / mass / 2.02"),
        ("dt / inertia / 2", "dt / inertia / 2.02"),
        ("x = plus(x, v, dt)", "x = plus(x, v, 0.999 * dt)"),
    ];
    spoiled.into_par_iter().for_each(|(right, wrong)| {
        let folder = example("python", "one_grain.py", Some((right, wrong)));
        let mut codes = EASY.split(' ').map(|case| passes(&folder, case, "--no-controls").0);
        assert!(codes.any(|code| code == Some(1)), "{wrong}: every row passes");
    });
}

/// A solver in C++ passes the same claims, and a defect makes them fail. The command in the manifest builds it first.
#[test]
fn a_grain_in_cpp_is_built_and_judged() {
    if !is_here("make") || !is_here("c++") {
        return;
    }
    let whole = example("cpp", "", None);
    assert!(matches!(passes(&whole, EASY, ""), (Some(0), 6..)));
    let spoiled = example("cpp", "one_grain.cpp", Some(("dot(x + -1.0", "0.99 * dot(x + -1.0")));
    assert_eq!(passes(&spoiled, EASY, "--no-controls").0, Some(1));
    let broken = example("cpp", "one_grain.cpp", Some(("int main", "int mian")));
    let answer = broken.run("run backspin --solver SOLVER.toml --json");
    assert!(answer.code == Some(1) && answer.out.contains("`make --silent` ended with 2"), "{}", answer.out);
}

/// A solver for a column and a bar in fifty lines of Python passes the claims with grid cells. A defect in any line
/// makes them fail.
#[test]
fn a_line_of_masses_is_judged_as_a_continuum() {
    if !is_here("python3") {
        return;
    }
    let bodies = "column vibrating-bar";
    let whole = example("continuum", "", None);
    assert_eq!(passes(&whole, bodies, ""), (Some(0), 7), "only its energy is not reported");
    let spoiled = [
        ("+ m * scene[\"gravity\"]", "+ 0.95 * m * scene[\"gravity\"]"),
        ("4 / 3 * material", "1 / 3 * material"),
        ("modulus * (b - a)", "0.97 * modulus * (b - a)"),
        ("0.5 if at in (0, count) else 1.0", "1.0"),
        ("wave[\"amplitude\"] * math", "0.9 * wave[\"amplitude\"] * math"),
        ("* at * h) for at", "* (at + 1) * h) for at"),
        ("(1 + scene[\"global_damping\"] * time)", "1"),
        ("held = 1 if", "held = 0 if"),
        ("x + dt * w", "x + 0.98 * dt * w"),
        ("/ h - 0.5", "/ h"),
    ];
    for (right, wrong) in spoiled {
        let folder = example("continuum", "line.py", Some((right, wrong)));
        assert_eq!(passes(&folder, bodies, "--no-controls").0, Some(1), "{wrong}: every row passes");
    }
    let reason = |manifest: &[(&str, &str)], case: &str| {
        let text = whole.read("SOLVER.toml");
        let text = manifest.iter().fold(text, |text, (right, wrong)| text.replace(right, wrong));
        whole.write("other.toml", text);
        let answer = whole.run(format!("run {case} --solver other.toml --json --no-controls"));
        let results = answer.json();
        let row = &results["verdicts"][0];
        assert_eq!(row["verdict"], "unsupported", "{row}");
        row["detail"].as_str().unwrap_or_default().to_owned()
    };
    let neo_hookean = [("\"hypoelastic\"", "\"neo-hookean\"")];
    assert!(reason(&neo_hookean, "column").contains("deformable `hypoelastic`"));
    assert!(reason(&[("\"global-damping\"", "")], "column/static").contains("effects `global-damping`"));
    assert!(reason(&neo_hookean, "incline-disc").contains("its manifest declares no output of grains"));
}

/// Results of an external solver are stored beside its manifest. The next run must have the same outcomes, also failures.
#[test]
fn a_program_must_equal_its_stored_result() {
    if !is_here("python3") {
        return;
    }
    let folder = example("continuum", "line.py", Some(("/ h - 0.5", "/ h")));
    let judge = |further: &str| folder.run(format!("run --solver SOLVER.toml --out out {further}"));
    let before = judge("--expect-stored");
    before.refused("(`--update-stored` writes the file)");
    let part = judge("--update-stored column");
    assert!(part.code == Some(2) && !folder.join("judged.json").exists(), "{}", part.err);
    assert_eq!(judge("--update-stored").code, Some(1), "stresses of other places are red");
    let kept: Value = serde_json::from_slice(&fs::read(folder.join("judged.json")).unwrap()).unwrap();
    assert!(kept["rows"].as_array().unwrap().iter().any(|row| row["verdict"] == "fail"), "{kept}");
    assert_eq!(judge("--expect-stored column vibrating-bar").code, Some(0), "it is red as it was");
    folder.edit("line.py", "x + dt * w", "x + 0.98 * dt * w");
    let other = judge("--expect-stored column vibrating-bar");
    assert!(other.code == Some(1) && other.err.contains("fail, its control red; kept: pass"), "{}", other.err);
    folder.write("judged.json", "{");
    assert_eq!(judge("--expect-stored column").code, Some(2));
}

/// Studies include an external solver in the same way as our solvers. Results of an older version of it are not used.
#[test]
fn a_program_is_timed_and_its_longest_stable_step_is_found() {
    if !is_here("make") || !is_here("c++") {
        return;
    }
    let folder = example("cpp", "", None);
    let study = |words: &str, out: &str| folder.run(format!("{words} --solver SOLVER.toml --json --out {out}")).json();
    let cost = study("cost incline-disc/60deg-mu.9", "cost");
    let points: Vec<&Value> = cost["points"].as_array().unwrap().iter().collect();
    assert!(points.len() >= 12 && points.iter().all(|point| point["solver"] == "one-grain-cpp"), "{points:#?}");
    let closest = points.iter().filter_map(|point| point["error"].as_f64()).fold(f64::INFINITY, f64::min);
    assert!(closest < 1e-4, "stiff contacts are rigid ones: {closest}");
    // The cause of its constant error is unknown to the study.
    let floors: Vec<&str> = points.iter().filter_map(|point| point["floor"].as_str()).collect();
    let unexplained = floors.iter().all(|floor| floor.starts_with("error that smaller steps"));
    assert!(!floors.is_empty() && unexplained, "{floors:?}");
    let page = folder.read("cost/index.html");
    assert!(page.contains("<th scope=\"col\">one-grain-cpp</th>"), "it has its column beside ours");
    let stability = study("stability disc-on-a-wall", "stability");
    for limit in stability["stability"]["limits"].as_array().unwrap() {
        assert!(limit["error"].as_f64().is_some_and(|error| error.abs() < 5e-3), "{limit}");
    }
    let again = folder.run("cost incline-disc/60deg-mu.9 --solver SOLVER.toml --out cost");
    assert!(again.out.contains("\n0 of "), "{}", again.out);
}

/// A study is red if all runs of a solver end with exit code 0 but without output.
#[test]
fn a_study_of_failed_runs_alone_is_red() {
    let folder = temporary();
    write(&folder, MANIFEST, "exit 0");
    for cases in ["free-pair", "mass-ratio", "free-pair mass-ratio"] {
        let answer = folder.run(format!("stability {cases} --solver SOLVER.toml"));
        assert_eq!(answer.code, Some(1), "{cases}: {}{}", answer.out, answer.err);
    }
}

/// A program that adds energy during the run and removes it before the end is detected.
#[test]
fn energy_gained_in_mid_run_is_red() {
    if !is_here("python3") {
        return;
    }
    let script = "import json, sys\n\
        scene = json.load(open(sys.argv[1]))\n\
        n, every = scene['steps']['count'], scene['steps']['sample_every']\n\
        table = open(sys.argv[2] + '/grains.csv', 'w')\n\
        print('step,id,x,y,z,vx,vy,vz,omegax,omegay,omegaz', file=table)\n\
        for k in [k for k in range(n + 1) if k % every == 0 or k == n]:\n    \
            for g in scene['grains']:\n        \
                v = [(3 if n / 4 < k < n / 2 else 1) * a for a in g['velocity']]\n        \
                print(k, g['id'], *g['position'], *v, *g['spin'], sep=',', file=table)\n";
    let folder = temporary();
    let manifest = MANIFEST.replace("[\"sh\", \"liar.sh\"", "[\"python3\", \"liar.sh\"");
    write(&folder, &manifest.replace("seconds = 2", "seconds = 20"), script);
    let mut gains = folder.run("conform SOLVER.toml --json").rows();
    gains.retain(|row| row["quantity"].as_str().unwrap().starts_with("energy gained"));
    assert!(gains.iter().any(|row| row["variant"] == "passivity/between-planes-2d"), "{gains:#?}");
    for row in gains.into_iter().filter(|row| row["verdict"] != "unsupported") {
        assert!(row["verdict"] == "fail" && row["value"].as_f64().is_some_and(|gain| gain > 1.0), "{row}");
    }
}

/// If an external solver cannot run any wrong scene, its passed results do not count.
#[test]
fn what_cannot_be_fed_with_wrong_physics_is_not_earned() {
    if !is_here("python3") {
        return;
    }
    let read = "scene = json.load(open(sys.argv[1]))\n";
    let picky = format!("{read}if scene[\"laws\"][0][\"friction\"] != 0.3: sys.exit(64)\n");
    let folder = example("python", "one_grain.py", Some((read, &picky)));
    assert_eq!(passes(&folder, "incline-disc/60deg-mu.3", "--no-controls").1, 3);
    let answer = folder.run("run incline-disc/60deg-mu.3 --solver SOLVER.toml --json");
    for row in answer.rows() {
        let says = row["detail"].as_str().unwrap_or_default();
        let message = "cannot run the negative control of this claim, friction ×1.05";
        assert!(row["verdict"] == "unsupported" && says.contains(message), "{row}");
    }
    let controls = &answer.json()["controls"];
    assert!(answer.code == Some(1) && *controls == Value::Array(Vec::new()), "{}", answer.out);
}

/// An interrupt ends a program without output immediately, and leaves no incomplete output.
#[cfg(unix)]
#[test]
fn an_interrupt_ends_a_silent_program() {
    let silent = MANIFEST.replace("seconds = 2", "seconds = 900");
    let run = "run = [\"sh\", \"liar.sh\", \"{scene}\", \"{out}\"]";
    let worker = silent.replace(run, "worker = [\"sh\", \"liar.sh\"]");
    let runs = [("31405.9", &silent, "-TERM"), ("31415.9", &worker, "-INT"), ("31425.9", &worker, "-TERM")];
    for (mark, manifest, signal) in runs {
        let folder = temporary();
        write(&folder, manifest, &format!("touch {}/begun; sleep {mark}", folder.display()));
        let mut child = folder.start(format!("run {CASE} --solver SOLVER.toml --out out -q"));
        while !folder.join("begun").exists() {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(1));
        assert!(!running().contains(mark), "it goes on");
        let results = folder.json("out/results.json");
        assert_eq!(results["verdicts"].as_array().unwrap().len(), 0, "a run that was ended is no result");
        assert!(results["provenance"]["options"].to_string().contains("interrupted: "));
    }
}
