//! Claims and benchmarks with external programs that are not installed.

use crate::common::{Answer, Directory, temporary, temporary_with};
use serde_json::Value;

#[test]
fn a_program_that_is_not_installed_is_amber_and_names_the_searched_places() {
    let directory = temporary();
    let answer = directory.run_alone("run backspin/disc --solver lammps --live --json");
    assert_eq!(answer.code, Some(1), "nothing was judged");
    let results = answer.json();
    let rows = results["verdicts"].as_array().unwrap();
    assert!(!rows.is_empty() && rows.iter().all(|row| row["verdict"] == "not-available"), "{}", answer.out);
    assert!(results["controls"].as_array().unwrap().is_empty(), "what cannot be judged has no control");
}

/// The throughput benchmark lists missing programs and too short timings. Without any timing, it is not a success.
#[test]
fn a_race_names_the_solvers_that_took_no_part() {
    let directory = temporary_with("s.toml", SCENE);
    let race = |arguments: &str| {
        let answer = directory.run_alone(format!("race s.toml --rounds 1 {arguments}"));
        let read = |name: &str| std::fs::read_to_string(directory.join("grainbench-race").join(name));
        let race = read("race.json").ok().map(|text| serde_json::from_str::<Value>(&text).unwrap());
        (answer.code, race, answer.out)
    };
    let (code, left, out) = race("--steps 10,20");
    assert_eq!(code, Some(1), "{out}");
    let results = left.unwrap()["heats"][0]["results"].as_array().unwrap().clone();
    let absent: Vec<&str> = results.iter().map(|raced| raced["absent"].as_str().unwrap()).collect();
    assert!(absent[0].starts_with("too few steps") && absent[1].contains("nowhere/lmp"), "{absent:?}");
    assert!(out.contains("\ns.toml  ") && out.contains("nowhere/liggghts"), "{out}");

    let (code, left, out) = race("--steps 10,12000000 --solver dem:lammps");
    assert_eq!(code, Some(0), "{out}");
    let raced = left.unwrap()["heats"][0]["results"][0].clone();
    assert!(raced["rates"][0].as_f64().is_some_and(|rate| rate > 0.0) && raced["absent"].is_null(), "{raced}");
}

#[test]
fn a_time_limit_that_is_no_time_is_refused() {
    let directory = temporary_with("s.toml", SCENE);
    let mut simulate = directory.program("simulate s.toml --solver lammps --time-step 1e-3");
    let answer = Answer::of(simulate.env("GRAINBENCH_TIME_LIMIT", "2s"));
    let reason = "GRAINBENCH_TIME_LIMIT: expected a whole number of seconds, found `2s`";
    assert_eq!((answer.code, answer.err), (Some(2), format!("error: lammps is not available: {reason}\n")));
}

/// If our process is killed, the external program ends, and its working folder is removed.
#[test]
#[cfg(target_os = "linux")]
fn a_program_and_its_folder_go_when_we_are_killed() {
    let path = temporary();
    let (temporary, program) = (path.join("tmp"), path.join("program"));
    std::fs::create_dir(&temporary).unwrap();
    path.script("program", "echo $$ > pid\nexec sleep 600");
    path.write("s.toml", SCENE);
    let mut child = path
        .program("simulate s.toml --solver lammps --time-step 1e-3")
        .env("GRAINBENCH_LAMMPS", &program)
        .env("TMPDIR", &temporary)
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let running = || -> Option<String> {
        let folder = std::fs::read_dir(&temporary).unwrap().flatten().next()?.path();
        std::fs::read_to_string(folder.join("pid")).ok().filter(|pid| pid.ends_with('\n'))
    };
    let wait = || std::thread::sleep(std::time::Duration::from_millis(5));
    let pid = loop {
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        match running() {
            Some(pid) => break pid.trim().to_owned(),
            None => wait(),
        }
    };
    child.kill().unwrap();
    child.wait().unwrap();
    let left = || {
        let folder = std::fs::read_dir(&temporary).unwrap().next().is_some();
        folder || std::path::Path::new("/proc").join(&pid).exists()
    };
    (0..4000).for_each(|_| {
        if left() {
            wait();
        }
    });
    assert!(!left(), "the program {pid} or its folder is left");
}

const SCENE: &str = include_str!("../scenes/flight.toml");

/// A program without documented errors would have red results in hard cases.
#[test]
fn errors_of_all_programs_are_documented() {
    use grainbench::reports::study::stability::DOCUMENTED;
    for program in grainbench::reference::deck::Program::ALL {
        assert!(DOCUMENTED.contains(&program.name()), "{}", program.name());
    }
}
