//! Selection of claims by patterns, filters and `--retry-failed`, and comparison with an earlier report by `--against`.

use crate::common::{Answer, Directory, temporary};
use serde_json::Value;
use std::path::Path;
use std::process::Command;

const CASE: &str = "oblique-impact";

fn run(directory: &Path, arguments: &str) -> Answer {
    directory.run(format!("run {arguments} --solver dem:lammps --solver dem:liggghts --quiet"))
}

fn results(directory: &Path, out: &str) -> Value {
    directory.join(out).json("results.json")
}

fn rows<'a>(results: &'a Value, key: &str) -> Vec<&'a str> {
    results["verdicts"].as_array().unwrap().iter().map(|row| row[key].as_str().unwrap()).collect()
}

/// Writes a changed copy of the report as an earlier report.
fn changed(directory: &Path, change: impl FnOnce(&mut Value)) {
    let mut earlier = results(directory, "grainbench-out");
    change(&mut earlier);
    directory.write("old/results.json", earlier.to_string());
}

#[test]
fn rows_are_chosen_by_what_they_are() {
    let here = temporary();
    run(&here, "oblique-imp* --filter quantity=SPIN --filter evidence=analytic").ok();
    let found = results(&here, "grainbench-out");
    assert!(!rows(&found, "quantity").is_empty());
    assert!(rows(&found, "quantity").iter().all(|quantity| quantity.contains("spin")), "{found}");
    assert!(rows(&found, "evidence").iter().all(|evidence| *evidence == "analytic"));
    assert!(rows(&found, "case").iter().all(|case| *case == CASE));
    let none = run(&here, "oblique-impact --filter 'quantity=nothing of the kind'");
    assert_eq!(
        (none.code, none.err.trim()),
        (Some(2), "error: expected at least one claim that matches the filters, found none")
    );
}

/// The outcome of a claim is known only after its run, so a filter by outcome removes no failure from the exit code.
#[test]
fn rows_are_shown_by_how_they_end_and_judged_all() {
    let here = temporary();
    let all = run(&here, CASE).ok();
    let count = rows(&results(&here, "grainbench-out"), "verdict").len();
    let passes = run(&here, "oblique-impact --filter outcome=pass");
    assert_eq!((passes.code, &passes.out), (all.code, &all.out), "all of them pass");
    assert_eq!(rows(&results(&here, "grainbench-out"), "verdict").len(), count);
    let failed = run(&here, "oblique-impact --filter outcome=fail");
    // The filter changes the results that are shown, but no count.
    assert_eq!((failed.code, &failed.out), (all.code, &all.out));
    assert_eq!(rows(&results(&here, "grainbench-out"), "verdict").len(), count);
    let page = here.read("grainbench-out/index.html");
    assert!(page.contains(&format!("This page shows 0 of {count} results.")), "the page says that it is a part");
    let badge = here.read("grainbench-out/badge.svg");
    assert!(badge.contains(&format!("{count} of {count} pass")), "{badge}");
}

#[test]
fn an_earlier_report_is_compared_with() {
    let here = temporary();
    run(&here, CASE).ok();
    let against = || run(&here, "oblique-impact --against old").ok().err;
    changed(&here, |_| ());
    let nothing = "changed: nothing: every result and every control has the same outcome, value and tolerance\n";
    assert_eq!(against(), nothing);
    changed(&here, |old| old["verdicts"][0]["verdict"] = "fail".into());
    assert!(against().starts_with("changed: was fail, is pass: oblique-impact"), "{}", against());
    changed(&here, |old| drop(old["verdicts"].as_array_mut().unwrap().remove(0)));
    assert!(against().starts_with("changed: new, is pass: oblique-impact"), "{}", against());
    changed(&here, |old| old["verdicts"][0]["value"] = 7.5.into());
    assert!(against().starts_with("changed: 1 of "), "{}", against());
    changed(&here, |old| old["verdicts"][0]["allowed"] = 0.5.into());
    assert!(against().starts_with("changed: tolerance was 0.5, is "), "{}", against());
    changed(&here, |old| old["verdicts"][0]["scale"] = 7.5.into());
    assert!(against().starts_with("changed: another expected value or scale: oblique-impact"), "{}", against());
    changed(&here, |old| old["verdicts"][0]["quantity"] = "what nobody asks any more".into());
    let lines = against();
    assert!(lines.contains("changed: new, is pass") && lines.contains("changed: not judged now, was pass"), "{lines}");
}

#[test]
fn what_failed_is_run_again_alone() {
    let here = temporary();
    run(&here, CASE).ok();
    let again = || run(&here, "--retry-failed --out old");
    changed(&here, |_| ());
    let none = again();
    assert_eq!(
        (none.code, none.err.trim()),
        (Some(2), "error: expected at least one claim that was red or omitted in the earlier report, found none")
    );
    changed(&here, |old| old["verdicts"][3]["verdict"] = "fail".into());
    let wanted = results(&here, "grainbench-out")["verdicts"][3].clone();
    again().ok();
    let found = results(&here, "old");
    for key in ["variant", "solver", "quantity", "resolution"] {
        assert!(rows(&found, key).iter().all(|word| wanted[key] == **word), "{key}: {found}");
    }
    changed(&here, |old| old["controls"][0]["turned_red"] = false.into());
    let wanted = results(&here, "grainbench-out")["controls"][0]["quantity"].clone();
    again().ok();
    assert!(rows(&results(&here, "old"), "quantity").iter().all(|quantity| wanted == **quantity));
}

/// The results that an interrupted run omitted are run together with the failed ones.
#[test]
fn what_an_interrupted_run_left_out_is_run_with_what_failed() {
    let here = temporary();
    run(&here, CASE).ok();
    let quantities = |from: &str| -> Vec<String> {
        rows(&results(&here, from), "quantity").into_iter().map(str::to_owned).collect()
    };
    let all = quantities("grainbench-out");
    let interrupt = |old: &mut Value| {
        old["provenance"]["options"].as_array_mut().unwrap().push("interrupted: 1 checks left out".into());
    };
    changed(&here, |old| {
        interrupt(old);
        drop(old["verdicts"].as_array_mut().unwrap().remove(0));
    });
    run(&here, "oblique-impact --retry-failed --out old").ok();
    assert!(!quantities("old").is_empty() && quantities("old").iter().all(|quantity| *quantity == all[0]));
    // A control that was omitted is run together with its claim.
    let control = results(&here, "grainbench-out")["controls"][0]["quantity"].clone();
    changed(&here, |old| {
        interrupt(old);
        drop(old["controls"].as_array_mut().unwrap().remove(0));
    });
    run(&here, "oblique-impact --retry-failed --out old").ok();
    let again = quantities("old");
    assert!(!again.is_empty() && again.iter().all(|quantity| control == **quantity), "{again:?}");
    // Without named cases, the cases of the interrupted run are used, not the whole registry.
    changed(&here, |old| {
        interrupt(old);
        drop(old["controls"].as_array_mut().unwrap().remove(0));
    });
    run(&here, "--rerun-failed --out old").ok();
    assert_eq!(quantities("old"), again);
}

#[test]
fn shells_and_readers_of_manuals_are_served() {
    let here = temporary();
    for shell in ["bash", "zsh", "fish"] {
        let script = here.run(format!("completions {shell}"));
        assert!(script.code == Some(0) && script.out.contains("retry-failed"), "{shell}");
    }
    let page = here.run("man");
    assert!(page.code == Some(0) && page.out.contains(".TH"), "{}", page.out);
    here.ok("man --out man");
    let run = here.read("man/grainbench-run.1");
    assert!(run.contains(".TH grainbench-run") && run.contains("retry"), "{run}");
}

/// The shell steps of the GitHub action, run as in a job.
#[cfg(unix)]
#[test]
fn each_job_has_its_own_message() {
    let here = temporary();
    let program = Path::new(env!("CARGO_BIN_EXE_grainbench")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join(".github/actions/judge/judge");
    let job_in = |cases: &str, arguments: &str, out: &str| {
        let mut bash = Command::new("bash");
        bash.arg(&script)
            .current_dir(&here)
            .env("PATH", &path)
            .env("GRAINBENCH_CACHE", "off")
            .env("GITHUB_ACTIONS", "true")
            .env("GITHUB_STEP_SUMMARY", here.join("summary.md"))
            .env("GITHUB_OUTPUT", here.join("output"))
            .envs([("CASES", cases), ("SOLVER", "dem:lammps"), ("ARGUMENTS", arguments), ("OUT", out)]);
        Answer::of(&mut bash)
    };
    let job = |cases: &str, arguments: &str| job_in(cases, arguments, "judged");
    let answer = job("oblique-imp*", "--quiet --filter evidence=analytic").ok();
    assert!(!answer.out.contains("::error"), "nothing is red");
    let summary = here.read("summary.md");
    assert!(summary.starts_with("## grainbench: ") && summary.contains("| oblique-impact |"), "{summary}");
    assert_eq!(here.read("output"), "report=judged\n");
    assert!(here.join("judged/badge.svg").is_file());
    // Every line of an input is used; none is dropped.
    for (cases, arguments) in
        [("no-such-case", ""), ("oblique-impact\nno-such-case", ""), ("oblique-impact", "--quiet\n--no-such")]
    {
        assert_eq!(job(cases, arguments).code, Some(2), "{cases} {arguments}");
    }
    // Help and version options are rejected, because nothing would be judged. The directory must be one line.
    for word in ["-h", "--help", "-V", "--version", "-qh"] {
        assert_eq!(job(word, "").code, Some(2), "{word}");
        assert_eq!(job("oblique-impact", &format!("--quiet\n{word}")).code, Some(2), "{word}");
    }
    for out in ["--help", "judged\nreport=elsewhere"] {
        assert_eq!(job_in("oblique-impact", "", out).code, Some(2), "{out}");
    }
    assert!(!here.read("output").contains("elsewhere"));
    assert_eq!(here.read("summary.md"), summary, "nothing was judged");
}
