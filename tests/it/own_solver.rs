//! Solver-independent claims. They apply to any solver, and their negative controls detect wrong physics.
use crate::common::{Answer, Directory, Folder, temporary};
use grainbench::cases::registry::CASES;
use grainbench::cases::solvers;
use grainbench::dem::convention::Convention;
use grainbench::dem::solver::Dem;
use grainbench::harness::case::Case;
use grainbench::harness::claim::Claim;
use grainbench::harness::control::WrongPhysics;
use grainbench::harness::mistake;
use grainbench::harness::run::Set;
use grainbench::harness::runner::Runner;
use grainbench::harness::solvers::Solvers;
use grainbench::harness::verdict::Outcome;
use grainbench::own::JudgementError;
use grainbench::scene::scene::Scene;
use grainbench::solver::Solver;
use grainbench::solver::failure::RunError;
use grainbench::solver::observer::Observer;
use grainbench::solver::record::Record;
use grainbench::solver::resolution::Resolution;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

/// Contact conventions differ in everything that a scene leaves open. With every convention, the solver-independent
/// claims pass and their controls fail. `GRAINBENCH_LONG=1` includes cases that take long.
#[test]
fn every_convention_passes_the_solver_independent_claims() {
    /// Cases with rotating contacts and walls. They fail with the conventions of external programs.
    const TURNING: [&str; 2] = ["carried-grain", "turning-walls"];
    let long = std::env::var_os("GRAINBENCH_LONG").is_some_and(|value| value == "1");
    let most = if long { Set::Long } else { Set::Main };
    let fair = |case: &Case| (case.claims)().into_iter().filter(|claim| claim.scope.is_of_grains()).collect::<Vec<_>>();
    let tried = |claims: &[Claim]| !claims.is_empty() && claims.iter().all(|claim| claim.set() <= most);
    let cases: Vec<&str> = CASES.iter().filter(|case| tried(&fair(case))).map(|case| case.name).collect();
    assert!(cases.len() > 10, "{cases:?}");
    Convention::ALL.into_par_iter().for_each(|convention| {
        let turns = convention == Convention::DEFAULT;
        let own: Vec<&str> = cases.iter().copied().filter(|case| turns || !TURNING.contains(case)).collect();
        grainbench::judge(Dem::new(convention), &own).unwrap().require().unwrap();
    });
    // In these conventions, springs do not rotate about the normal, and the rolling moment neglects the spin of walls.
    for convention in [Convention::LAMMPS, Convention::LIGGGHTS] {
        assert!(grainbench::judge(Dem::new(convention), &TURNING).unwrap().require().is_err(), "{}", convention.name);
    }
}

struct Panics;

impl Solver for Panics {
    fn name(&self) -> String {
        "panics".to_owned()
    }

    fn run(&self, _: &Scene, _: &Resolution, _: &mut dyn Observer) -> Result<Record, RunError> {
        panic!("index out of bounds")
    }
}

/// After a panic, all other results are still reported.
#[test]
fn a_panic_is_a_broken_result() {
    let judged = grainbench::judge(Panics, &["backspin"]).unwrap();
    assert!(!judged.verdicts.is_empty() && !judged.controls.is_empty());
    for row in &judged.verdicts {
        assert_eq!(row.outcome, Outcome::Broken, "{row:?}");
        assert_eq!(row.detail.as_deref(), Some("our program failed: index out of bounds"));
    }
    assert!(judged.controls.iter().all(|control| !control.turned_red), "{:?}", judged.controls);
}

/// A control cannot replace an external solver by another solver, and cannot plant a defect in it. It must be a wrong scene.
#[test]
fn solver_independent_claims_have_wrong_scenes_as_controls() {
    for case in CASES {
        for claim in (case.claims)().iter().filter(|claim| claim.scope.is_open()) {
            assert!(matches!(claim.control.wrong, WrongPhysics::Scene(_)), "{}: {}", case.name, claim.quantity);
            let solvers: BTreeSet<&str> = claim.runs.iter().map(|run| run.solver).collect();
            assert_eq!(solvers.len(), 1, "{}: {} compares solvers", case.name, claim.quantity);
        }
    }
}

#[test]
fn a_missing_or_solver_dependent_case_is_an_error() {
    let solver = || Dem::new(Convention::LAMMPS);
    let nothing = grainbench::judge(solver(), &["sqash"]).unwrap_err();
    assert!(matches!(nothing, JudgementError::NoSuchCase(_)) && nothing.to_string().contains("squash"), "{nothing}");
    assert_eq!(grainbench::judge(solver(), &["squash"]), Err(JudgementError::NothingFair("squash".to_owned())));
}

/// Solver that changes every scene before it runs it.
pub(crate) struct Changed(pub(crate) Box<dyn Solver>, pub(crate) fn(&mut Scene));

impl Solver for Changed {
    fn name(&self) -> String {
        "changed".to_owned()
    }

    fn run(&self, scene: &Scene, resolution: &Resolution, observer: &mut dyn Observer) -> Result<Record, RunError> {
        let mut scene = scene.clone();
        (self.1)(&mut scene);
        self.0.run(&scene, resolution, observer)
    }
}

/// A solver that ignores the scene may give the right result, but it also gives this result for the wrong scene of a control.
#[test]
fn a_solver_that_ignores_the_scene_is_found_out() {
    let ignoring = Changed(solvers::by_name("dem").unwrap(), |scene| {
        let factor = scene.grain_shape.inertia_factor();
        scene.grains.iter_mut().for_each(|grain| grain.inertia = factor * grain.mass * grain.radius.powi(2));
    });
    let judgement = grainbench::judge(ignoring, &["incline-disc"]).unwrap();
    assert!(judgement.verdicts.iter().all(|row| row.outcome.word() == "pass"));
    let failures = judgement.failures();
    let by_value = failures.iter().all(|line| line.contains("passed, but must fail by value"));
    assert!(!failures.is_empty() && by_value, "{failures:#?}");
}

/// With a defect, our own solver gives the same error with and without a control. The control then explains nothing.
#[test]
fn a_control_does_not_explain_a_defect_of_our_own_solver() {
    struct Spoiled;
    impl Solvers for Spoiled {
        fn find(&self, name: &str) -> Option<Arc<dyn Solver>> {
            Some(Arc::new(Changed(solvers::by_name(name)?, |scene| scene.gravity.x *= 0.0)))
        }
    }
    let case = CASES.iter().find(|case| case.name == "energy-sums").unwrap();
    let claims: Vec<Claim> = (case.claims)().into_iter().filter(|claim| claim.runs[0].variant == "thrown").collect();
    let spoiled: Arc<dyn Solvers> = Arc::new(Spoiled);
    let runner = Runner::new(case, Arc::clone(&spoiled));
    let mut rows: Vec<_> = claims.iter().map(|claim| runner.judge(claim)).collect();
    mistake::explain(case, &spoiled, &claims.iter().collect::<Vec<_>>(), &mut rows);
    let row = rows.remove(0);
    assert_eq!(row.outcome, Outcome::Fail, "{row:?}");
    assert!(row.detail.is_none_or(|detail| !detail.contains("as if")));
}

/// The example is compiled as a separate crate that depends only on grainbench. It passes its claims, and fails them
/// with a defect in one line of its physics.
#[test]
fn the_example_is_green_as_a_foreign_crate_and_red_when_spoiled() {
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/own_solver.rs");
    let example = fs::read_to_string(example).unwrap();
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
    let foreign = ForeignCrate::build(&programs);
    let rows = foreign.run("honest").ok().out;
    assert!(rows.lines().filter(|line| line.starts_with("pass")).count() >= 20, "{rows}");
    for (name, ..) in spoiled {
        let Answer { code, out, err } = foreign.run(name);
        assert_eq!(code, Some(1), "{name} is spoiled and must be refused: {out}{err}");
    }
}

/// All programs in one executable, compiled against the library of this test. For a crate outside the workspace, cargo
/// would build all crates again, which takes minutes and gives the same code.
struct ForeignCrate {
    folder: Folder,
}

impl ForeignCrate {
    fn build(programs: &[(&str, String)]) -> Self {
        let folder = temporary();
        let mut main = "fn main() -> Result<(), Box<dyn std::error::Error>> {\n".to_owned();
        main += "    match std::env::args().nth(1).unwrap().as_str() {\n";
        for (name, source) in programs {
            let module = source.replace("\nfn main()", "\npub fn main()");
            fs::write(folder.join(format!("{name}.rs")), module).unwrap();
            main = format!("mod {name};\n{main}        {name:?} => {name}::main(),\n");
        }
        main += "        _ => unreachable!(),\n    }\n}\n";
        folder.write("main.rs", &main);
        let built = std::env::current_exe().unwrap().parent().unwrap().to_owned();
        let mut rustc = Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
        rustc
            .args(["--edition", "2024", "--crate-name", "foreign", "--out-dir", ".", "main.rs"])
            .arg(format!("--extern=grainbench={}", newest(&built, "libgrainbench-").display()))
            .arg(format!("-Ldependency={}", built.display()))
            .current_dir(&folder);
        Answer::of(&mut rustc).ok();
        Self { folder }
    }

    fn run(&self, name: &str) -> Answer {
        let executable = format!("foreign{}", std::env::consts::EXE_SUFFIX);
        Answer::of(Command::new(self.folder.join(executable)).arg(name))
    }
}

/// Returns the most recent build of the library with this name. Builds with other flags may exist.
fn newest(folder: &Path, name: &str) -> PathBuf {
    let is_it = |path: &PathBuf| {
        let file = path.file_name().unwrap().to_string_lossy();
        file.starts_with(name) && file.ends_with(".rlib")
    };
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(is_it);
    files.max_by_key(|path| path.metadata().unwrap().modified().unwrap()).expect("the library that this is linked with")
}
