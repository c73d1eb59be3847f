//! A case of the user: a scene and claims in files, without Rust code.

use crate::common::{Answer, Directory, Folder, temporary};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// Copies the example case to a separate folder, with replacements in one of its files.
fn case(file: &str, replaced: &[(&str, &str)]) -> Folder {
    let directory = temporary();
    directory.copy("examples/case", "slope");
    replaced.iter().for_each(|(right, wrong)| directory.edit(format!("slope/{file}"), right, wrong));
    directory
}

fn run(folder: &Path) -> (Answer, Vec<Value>, Vec<Value>) {
    let answer = folder.run("run slope --json");
    let results = answer.json();
    let list = |name: &str| results[name].as_array().unwrap().clone();
    let (verdicts, controls) = (list("verdicts"), list("controls"));
    (answer, verdicts, controls)
}

#[test]
fn claims_in_a_file_are_judged_as_those_in_rust_are() {
    let whole = case("", &[]);
    let (answer, verdicts, controls) = run(&whole);
    assert_eq!(answer.code, Some(0), "{}", answer.err);
    assert!(verdicts.len() == 3 && verdicts.iter().all(|row| row["verdict"] == "pass"), "{verdicts:#?}");
    assert!(controls.len() == 3 && controls.iter().all(|control| control["turned_red"] == true), "{controls:#?}");
    assert_eq!([&verdicts[0]["tolerance"], &verdicts[2]["tolerance"]], ["computed", "judged"]);
    assert_eq!(verdicts[0]["evidence"], "analytic");
    // Computed by hand: 5/2 · 0.1 · 9.81 · cos 30° / 0.005 times the time of the last sample.
    let spin = 2.5 * 0.1 * 9.81 * 30.0_f64.to_radians().cos() / 0.005;
    let found = verdicts[1]["expected"].as_f64().unwrap() / spin;
    assert!((0.199..0.201).contains(&found), "{found}");
    let page = whole.read("grainbench-out/index.html");
    assert!(page.contains("A ball on a slope") && page.contains("velocity, rolling"));
}

/// A list of solvers gives one claim for each of them.
#[test]
fn a_list_of_solvers_gives_a_claim_for_each() {
    let folder = case("claims.toml", &[("unit = \"m/s\"", "unit = \"m/s\"\nsolver = [\"dem\", \"dem:lammps\"]")]);
    let (answer, verdicts, controls) = run(&folder);
    assert_eq!(answer.code, Some(0), "{verdicts:#?}");
    let claims = verdicts.iter().map(|row| (row["quantity"].as_str().unwrap(), row["solver"].as_str().unwrap()));
    let velocity = "velocity, rolling";
    assert_eq!(claims.take(2).collect::<Vec<_>>(), [(velocity, "dem"), (velocity, "dem:lammps")]);
    assert!(verdicts.len() == 4 && controls.len() == 4, "{verdicts:#?}");
}

/// A wrong scene, a wrong expectation, or a negative control with too small a change makes the run fail.
#[test]
fn what_is_wrong_is_red() {
    let red = |file: &str, replaced: &[(&str, &str)], verdicts_red: usize, controls_green: usize| {
        let folder = case(file, replaced);
        let (answer, verdicts, controls) = run(&folder);
        assert_eq!(answer.code, Some(1), "{replaced:?}");
        let count_of = |rows: &[Value], key: &str, is: Value| rows.iter().filter(|row| row[key] == is).count();
        assert_eq!(count_of(&verdicts, "verdict", "fail".into()), verdicts_red, "{replaced:?}: {verdicts:#?}");
        assert_eq!(count_of(&controls, "turned_red", false.into()), controls_green, "{replaced:?}: {controls:#?}");
    };
    red("claims.toml", &[("5/7 *", "0.71 *")], 1, 0);
    red("claims.toml", &[("5/2 *", "2.51 *")], 1, 0);
    red("claims.toml", &[("allowed = 1e-6", "allowed = 0.1")], 0, 1);
    red("claims.toml", &[("29.9 }", "29.99999 }")], 0, 1);
    // On this slope the ball rolls, although the claim expects slip.
    red("scene.toml", &[("friction = 0.1", "friction = 0.3")], 1, 0);
}

/// With a tolerance as large as the scale, almost any value passes. The result is therefore amber.
#[test]
fn a_tolerance_as_large_as_the_scale_is_amber() {
    for (allowed, verdict, strict) in [
        ("0.99", "pass", 0),
        ("1", "no-reference", 1),
        ("20", "no-reference", 1),
        ("'20*duration/0.2'", "no-reference", 1),
    ] {
        let folder = case("claims.toml", &[("allowed = 1e-6", &format!("allowed = {allowed}"))]);
        let run = |further: &str| {
            let answer = folder.run(format!("run slope --no-controls --json {further}"));
            let results = answer.json();
            (answer.code, results["verdicts"][2].clone())
        };
        let (code, row) = run("");
        assert!(code == Some(0) && row["verdict"] == verdict, "{allowed}: {row:#?}");
        let detail = row["detail"].as_str().unwrap_or_default();
        assert_eq!(detail.contains("% of the scale, 100 % or more"), verdict != "pass", "{detail}");
        assert_eq!(run("--strict").0, Some(strict), "{allowed}");
        // Writing the report again gives the exit code of the run.
        assert_eq!(folder.run("report grainbench-out").code, Some(strict), "{allowed}");
    }
}

/// Returns claims about the velocity of the ball, with an expected value and a tolerance (m/s).
fn claims(expected: &str, allowed: f64) -> String {
    format!(
        "title = \"A slope\"\n[[claims]]\nquantity = \"velocity\"\nunit = \"m/s\"\nvalue = \"ball.vx\"\n{expected}\n\
         allowed = {allowed:?}\nbecause = \"the springs yield\"\n\
         control = {{ name = \"half the weight\", set = {{ gravity.magnitude = 4.9 }} }}\n"
    )
}

/// Claims about a curve in a table, about a value at one time, and about bounds.
#[test]
fn a_claim_may_be_a_course_a_moment_or_a_bound() {
    let acceleration = 5.0 / 7.0 * 9.81 * 0.5;
    let course: String = (0..=10).map(|k| f64::from(k) / 50.0).map(|t| format!("{t},{}\n", t * acceleration)).collect();
    let column = "follows = { file = \"v.csv\", time = \"t (s)\", value = \"v (m/s)\" }";
    let printed = "printed = { work = \"Somebody (2001)\", place = \"eq. 3\" }";
    let half = 0.5 * 0.2 * acceleration;
    for (expected, evidence) in [
        (format!("{column}\nmeasured = {{ work = \"A\", place = \"B\" }}"), "experiment"),
        (format!("at = 0.1\nequals = \"{acceleration} * t\"\n{printed}"), "paper"),
        (format!("over = \"mean\"\nequals = {half}\nderived = \"v = at\""), "analytic"),
        (format!("over = \"max\"\nbetween = [{}, {}]\n{printed}", 0.19 * acceleration, 0.21 * acceleration), "paper"),
        (format!("at_least = {}\nderived = \"v = at\"", 0.199 * acceleration), "analytic"),
    ] {
        let folder = case("", &[]);
        folder.write("slope/claims.toml", claims(&expected, 0.001));
        folder.write("slope/v.csv", format!("t (s),v (m/s)\n{course}"));
        let (answer, verdicts, controls) = run(&folder);
        assert_eq!(answer.code, Some(0), "{expected}: {}{}", answer.err, answer.out);
        assert!(verdicts[0]["verdict"] == "pass" && verdicts[0]["evidence"] == evidence, "{expected}: {verdicts:#?}");
        assert_eq!(controls[0]["turned_red"], true, "{expected}: {controls:#?}");
        let says_how_far = verdicts[0]["quantity"] == "velocity, 0 to 0.2 s";
        assert_eq!(says_how_far, expected.contains("follows"), "{expected}: a row of a table says what it has");
    }
}

/// A constant belongs to one time, so a sample must lie within a time step of it. A formula with `t` takes the time of
/// the nearest sample. The samples are 2 ms apart.
#[test]
fn a_constant_at_a_time_between_samples_has_no_sample() {
    let acceleration = 5.0 / 7.0 * 9.81 * 0.5;
    let constant = format!("{}", 0.101 * acceleration);
    let (course, end) = (format!("'{acceleration} * t'"), format!("{}", 0.2 * acceleration));
    for (at, equals, verdict) in [(0.101, &constant, "fail"), (0.101, &course, "pass"), (0.2, &end, "pass")] {
        let folder = case("", &[]);
        let expected = format!("at = {at}\nequals = {equals}\nderived = \"v = at\"");
        folder.write("slope/claims.toml", claims(&expected, 0.002));
        let (_, verdicts, _) = run(&folder);
        let row = &verdicts[0];
        assert_eq!(row["verdict"], verdict, "{at} {equals}: {row:#?}");
        let has_no_sample = row["detail"].as_str().unwrap_or_default().contains("has no sample within");
        assert_eq!(has_no_sample, at == 0.101 && equals == &constant, "{row:#?}");
    }
}

/// A misspelt column is an error before the run, for every solver.
#[test]
fn a_missing_column_is_found_before_the_run() {
    for solver in ["dem", "rigid", "mpm"] {
        let wrong = format!("value = \"ball.vq\"\nsolver = \"{solver}\"");
        let resolution = if solver == "dem" { "resolution = { time_step_fraction = 0.02 }" } else { "resolution = {}" };
        let folder = case(
            "claims.toml",
            &[("value = \"ball.vx\"", &wrong), ("resolution = { time_step_fraction = 0.02 }", resolution)],
        );
        let answer = folder.run("run slope");
        let message = "value: expected one of the columns of the record, ball.x";
        answer.refused(message);
    }
}

/// A folder with the name of a built-in case must be given with `./`. Otherwise a message mentions the folder.
#[test]
fn a_folder_named_as_a_case_is_reported() {
    let whole = case("", &[]);
    fs::rename(whole.join("slope"), whole.join("squash")).unwrap();
    let of_registry = whole.run("run squash --solver rigid -q");
    assert!(of_registry.err.contains("write ./squash to select the folder"), "{}", of_registry.err);
    let own = whole.run("run ./squash -q");
    assert_eq!((own.code, own.err.as_str()), (Some(0), ""), "{}", own.out);
}
