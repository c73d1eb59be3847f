//! Gates for solvers that the cases do not name: fair, felt, and red where the physics is wrong.
#![allow(clippy::unwrap_used, reason = "helpers of tests, which may panic")]

use grainbench::cases::registry::CASES;
use grainbench::cases::solvers;
use grainbench::dem::convention::Convention;
use grainbench::dem::solver::Dem;
use grainbench::harness::control::Wrong;
use grainbench::own::NotJudged;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The conventions differ in all that a scene leaves open: a gate that is fair to any solver is passed by each of them,
/// and each of them feels its wrong physics.
#[test]
fn every_convention_passes_what_is_fair_to_any_solver() {
    let has_fair_gates = |name: &&str| {
        let case = CASES.iter().find(|case| case.name == *name).unwrap();
        (case.claims)().iter().any(|claim| claim.scope.is_of_grains())
    };
    let cases: Vec<&str> = CASES.iter().map(|case| case.name).filter(has_fair_gates).collect();
    Convention::ALL.into_par_iter().for_each(|convention| {
        grainbench::judge(Dem::new(convention), &cases).unwrap().require().unwrap();
    });
}

/// Another solver or a defect of ours cannot be put into a stranger's solver.
#[test]
fn what_is_fair_to_any_solver_has_a_wrong_scene_as_its_control() {
    for case in CASES {
        for claim in (case.claims)().iter().filter(|claim| claim.scope.is_open()) {
            assert!(matches!(claim.control.wrong, Wrong::Scene(_)), "{}: {}", case.name, claim.quantity);
            let solvers: BTreeSet<&str> = claim.runs.iter().map(|run| run.solver).collect();
            assert_eq!(solvers.len(), 1, "{}: {} compares solvers", case.name, claim.quantity);
        }
    }
}

#[test]
fn a_case_that_is_not_there_or_not_fair_says_so() {
    let solver = || Dem::new(Convention::LAMMPS);
    let nothing = grainbench::judge(solver(), &["sqash"]).unwrap_err();
    assert!(matches!(nothing, NotJudged::NoSuchCase(_)) && nothing.to_string().contains("squash"), "{nothing}");
    assert_eq!(grainbench::judge(solver(), &["squash"]), Err(NotJudged::NothingFair("squash".to_owned())));
}

/// A solver that does not read the scene may give the right answer, but not to the wrong question.
#[test]
fn a_solver_that_ignores_the_scene_is_found_out() {
    use grainbench::scene::{record::Record, scene::Scene, solver::*};
    struct Deaf(Box<dyn Solver>);
    impl Solver for Deaf {
        fn name(&self) -> String {
            "deaf".to_owned()
        }
        fn run(&self, scene: &Scene, resolution: &Resolution, watch: &mut dyn Watch) -> Result<Record, RunError> {
            let mut scene = scene.clone();
            let factor = scene.grain_shape.inertia_factor();
            scene.grains.iter_mut().for_each(|grain| grain.inertia = factor * grain.mass * grain.radius.powi(2));
            self.0.run(&scene, resolution, watch)
        }
    }
    let judgement = grainbench::judge(Deaf(solvers::by_name("dem").unwrap()), &["incline-disc"]).unwrap();
    assert!(judgement.verdicts.iter().all(|row| row.outcome.word() == "pass"));
    let failures = judgement.failures();
    assert!(!failures.is_empty() && failures.iter().all(|line| line.contains("stayed green")), "{failures:#?}");
}

/// The example as a stranger has it, in a crate of its own that knows grainbench as a dependency: right as it stands,
/// red with one line of its physics spoiled.
#[test]
fn the_example_is_green_as_a_foreign_crate_and_red_when_spoiled() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let example = fs::read_to_string(root.join("examples/own_solver.rs")).unwrap();
    assert!(example.lines().count() < 100, "the example is short");
    let spoiled = [
        ("friction", "let limit = friction *", "let limit = 1.05 * friction *"),
        ("inertia", "spin += arm.cross(&impulse) / grain.inertia", "spin += 0.9 * arm.cross(&impulse) / grain.inertia"),
        ("gravity", "velocity += along * time_step", "velocity += 0.99 * along * time_step"),
    ];
    let mut programs = vec![("honest", example.clone())];
    for (name, line, wrong) in spoiled {
        assert_eq!(example.matches(line).count(), 1, "`{line}` is one line of the example");
        programs.push((name, example.replace(line, wrong)));
    }
    let foreign = Foreign::build(root, &programs);
    let honest = foreign.run("honest");
    assert_eq!(honest.status.code(), Some(0), "{honest:?}");
    let rows = String::from_utf8(honest.stdout).unwrap();
    assert!(rows.lines().filter(|line| line.starts_with("pass")).count() >= 20, "{rows}");
    for (name, ..) in spoiled {
        let output = foreign.run(name);
        assert_eq!(output.status.code(), Some(1), "{name} is spoiled and must be refused: {output:?}");
    }
}

/// A crate outside the workspace, with all programs in one executable, since linking takes longest. It shares the
/// target directory, so that dependencies are not built again.
struct Foreign {
    executable: PathBuf,
}

impl Foreign {
    fn build(root: &Path, programs: &[(&str, String)]) -> Self {
        // The folder that cargo keeps for tests lies in the target directory.
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("foreign");
        let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap();
        fs::create_dir_all(folder.join("src")).unwrap();
        write_if_new(&folder.join("Cargo.toml"), &manifest(root));
        // The versions of the workspace, which are there without a network.
        fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock")).unwrap();
        let mut main = "fn main() -> Result<(), Box<dyn std::error::Error>> {\n".to_owned();
        main += "    match std::env::args().nth(1).unwrap().as_str() {\n";
        for (name, source) in programs {
            write_if_new(&folder.join(format!("src/{name}.rs")), &source.replace("\nfn main()", "\npub fn main()"));
            main = format!("mod {name};\n{main}        {name:?} => {name}::main(),\n");
        }
        main += "        _ => unreachable!(),\n    }\n}\n";
        write_if_new(&folder.join("src/main.rs"), &main);
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.args(["build", "--offline", "--quiet"]).current_dir(&folder).env("CARGO_TARGET_DIR", target);
        if !cfg!(debug_assertions) {
            cargo.arg("--release");
        }
        let output = cargo.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let profile = if cfg!(debug_assertions) { "debug" } else { "release" };
        Self { executable: target.join(profile).join(format!("foreign{}", std::env::consts::EXE_SUFFIX)) }
    }

    fn run(&self, name: &str) -> Output {
        Command::new(&self.executable).arg(name).output().unwrap()
    }
}

/// A manifest with the profiles and the outside dependencies of the workspace: other flags or features would mean
/// another build of everything.
fn manifest(root: &Path) -> String {
    let workspace = fs::read_to_string(root.join("Cargo.toml")).unwrap();
    let section = |from: &str, to: &str| {
        let start = workspace.find(from).unwrap() + from.len();
        &workspace[start..start + workspace[start..].find(to).unwrap()]
    };
    let members: Vec<&str> = section("\nmembers = [", "]").split(", ").map(|name| name.trim_matches('"')).collect();
    let read = |member: &&str| fs::read_to_string(root.join(member).join("Cargo.toml")).unwrap();
    let manifests: String = members.iter().map(read).collect();
    let used = |line: &&str| {
        let name = line.split(" = ").next().unwrap_or_default();
        !line.contains("path = ") && manifests.contains(&format!("\n{name}.workspace"))
    };
    let outside: Vec<&str> = section("[workspace.dependencies]", "[workspace.lints").lines().filter(used).collect();
    format!(
        "[workspace]\n\n[package]\nname = \"foreign\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n\
         [dependencies]\ngrainbench = {{ path = {root:?} }}\n{}\n\n[profile.release]{}",
        outside.join("\n"),
        section("[profile.release]", "[package]")
    )
}

/// Leaves a file alone that is as it should be, so that it need not be compiled again.
fn write_if_new(path: &Path, text: &str) {
    if fs::read_to_string(path).ok().as_deref() != Some(text) {
        fs::write(path, text).unwrap();
    }
}
