//! The command line: help, tables, files, JSON and exit codes.

use crate::common::{Directory, files, temporary, temporary_with};
use grainbench::cases::registry::CASES;
use serde_json::{Value, json};
use std::process::Stdio;

/// Scene of two colliding discs, with two snapshots between the first and the last.
const SCENE: &str = include_str!("../scenes/collision.toml");

/// Returns a help text without spaces at the ends of lines. clap prints such spaces, and editors remove them.
fn help(arguments: &str) -> String {
    temporary().run(arguments).quiet().lines().map(|line| line.trim_end().to_owned() + "\n").collect()
}

#[test]
fn help_of_every_command() {
    insta::assert_snapshot!("help", help("--help"));
    for command in ["list", "run", "simulate", "deck", "check", "compare", "scene", "report"] {
        insta::assert_snapshot!(format!("help_{command}"), help(&format!("{command} --help")));
    }
}

#[test]
fn version() {
    let (version, commit) = (env!("CARGO_PKG_VERSION"), env!("GRAINBENCH_COMMIT"));
    assert_eq!(help("--version"), format!("grainbench {version} ({commit})\n"));
}

#[test]
fn list_tells_of_every_case() {
    let directory = temporary();
    let text = directory.run("list").quiet();
    for case in CASES {
        assert!(text.contains(case.name) && text.contains(case.title), "{}", case.name);
    }
    // One case represents all cases, so that a new case does not change the snapshot. Column widths depend on the longest name.
    let squash: Vec<String> = text
        .lines()
        .skip_while(|line| !line.starts_with("squash "))
        .take(3)
        .map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "))
        .collect();
    insta::assert_snapshot!(squash.join("\n"));
    let entries: Value = directory.run("list --json").quiet().parse().unwrap();
    assert_eq!(entries.as_array().unwrap().len(), CASES.len());
    for entry in entries.as_array().unwrap() {
        for key in ["name", "title", "claim", "variants", "gates", "default_level", "levels", "solvers"] {
            assert!(!entry[key].is_null() && entry[key] != "", "{key} of {entry}");
        }
    }
    assert!(files(&directory).is_empty());
}

#[cfg(unix)]
#[test]
fn a_reader_who_has_seen_enough_is_no_error() {
    let mut program =
        temporary().program("scene --schema").stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(program.stdout.take());
    let output = program.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(0), &b""[..]));
}

/// Collects the paths of all properties of a schema that have no description.
fn undocumented(schema: &Value, path: &str, found: &mut Vec<String>) {
    if let Some(properties) = schema.get("properties").and_then(Value::as_object) {
        for (name, property) in properties {
            let description = property.get("description").and_then(Value::as_str).unwrap_or_default();
            // A property with a single constant value is described together with its alternative.
            if description.trim().is_empty() && property.get("const").is_none() {
                found.push(format!("{path}.{name}"));
            }
        }
    }
    match schema {
        Value::Object(map) => map.iter().for_each(|(key, value)| undocumented(value, &format!("{path}.{key}"), found)),
        Value::Array(list) => list.iter().for_each(|value| undocumented(value, path, found)),
        _ => {}
    }
}

#[test]
fn schema_documents_every_key() {
    let directory = temporary();
    let schema: Value = directory.run("scene --schema").quiet().parse().unwrap();
    assert!(schema["properties"]["grains"].is_object());
    assert!(schema["$defs"].as_object().unwrap().len() > 5);
    let mut found = Vec::new();
    undocumented(&schema, "", &mut found);
    assert!(found.is_empty(), "without a description: {found:?}");
}

/// The schema file in the repository, which editors use, equals the schema that the program prints.
#[test]
fn the_schema_in_the_tree_is_that_of_the_program() {
    let directory = temporary();
    crate::common::expect_file("scene.schema.json", &directory.run("scene --schema").quiet());
}

#[test]
fn run_leaves_its_files_and_a_summary() {
    let directory = temporary();
    let text = directory.run("run squash --out deep/out").quiet();
    // The worst claim depends on rounding, which differs between mathematical libraries. Column widths depend on it too.
    let settled: Vec<String> = text.lines().map(without_worst).collect();
    insta::assert_snapshot!(settled.join("\n"));
    let out = directory.join("deep/out");
    let expected = "badge.svg figures/squash-elastic.csv figures/squash-elastic.svg figures/squash-forces.csv \
        figures/squash-forces.svg index.html junit.xml manifest.json points.csv report.json results.json rows.csv";
    assert_eq!(files(&out).join(" "), expected);
    assert_eq!(files(&directory).len(), files(&out).len());

    let results = out.json("results.json");
    assert_eq!(results["verdicts"].as_array().unwrap().len(), results["controls"].as_array().unwrap().len());
    assert_eq!(results["provenance"]["options"], json!(["squash"]));
    assert!(results["provenance"]["rustc"].as_str().unwrap().starts_with("rustc "));
    assert_eq!(results["points"][0]["variant"], "plain");
    let date = results["provenance"]["date"].as_str().unwrap();
    assert!(date.ends_with(" UTC") && date.len() == "2000-01-01 00:00:00 UTC".len(), "{date}");

    let page = std::fs::read(out.join("index.html")).unwrap();
    let again = directory.run("report deep/out").quiet();
    assert_eq!(again, text);
    assert_eq!(std::fs::read(out.join("index.html")).unwrap(), page);
    assert_eq!(files(&out).join(" "), expected);
}

/// Returns a line of the summary without the worst claim and without column widths.
fn without_worst(line: &str) -> String {
    let cells = line.split("  ").map(str::trim).filter(|cell| !cell.is_empty());
    let cells = cells.map(|cell| match cell {
        _ if cell.starts_with('─') => "─",
        _ if line.starts_with("squash ") && cell.contains("normal force") => "[worst]",
        _ => cell,
    });
    cells.collect::<Vec<_>>().join("  ")
}

#[test]
fn run_prints_what_it_writes_as_json() {
    let directory = temporary();
    let text = directory.run("run squash/plain --levels dt=0.05 --no-controls --json").quiet();
    assert_eq!(text, directory.read("grainbench-out/results.json"));
    let results: Value = text.parse().unwrap();
    assert!(results["verdicts"].as_array().unwrap().iter().all(|row| row["verdict"] == "pass"));
    assert_eq!(results["controls"], json!([]));
}

/// Old spellings are accepted until the next version, and a note is printed.
#[test]
fn an_old_spelling_is_reported() {
    let directory = temporary();
    let answer = directory.ok("run squash/plain --rungs=dt=0.05 --fresh --no-controls");
    for [old, new] in [["--rungs", "--levels"], ["--fresh", "--no-cache"]] {
        assert!(answer.err.contains(&format!("`{old}` is now `{new}`")), "{}", answer.err);
    }
}

#[test]
fn a_red_report_ends_with_one() {
    let directory = temporary();
    directory.run("run squash --out out").quiet();
    let text = directory.read("out/report.json");
    for (green, red) in [
        (r#""verdict":"pass""#, r#""verdict":"fail""#),
        (r#""verdict":"pass""#, r#""verdict":"broken""#),
        (r#""turned_red":true"#, r#""turned_red":false"#),
    ] {
        directory.write("out/report.json", text.replacen(green, red, 1));
        let answer = directory.run("report out");
        assert_eq!(answer.code, Some(1), "{red}");
        assert!(answer.out.contains('✗'), "{}", answer.out);
    }
    // An amber result counts neither as passed nor as failed.
    directory.write("out/report.json", text.replacen(r#""verdict":"pass""#, r#""verdict":"no-reference""#, 1));
    directory.ok("report out");
}

#[test]
fn simulate_leaves_its_record() {
    let directory = temporary_with("scene.toml", SCENE);
    let text = directory.run("simulate scene.toml --solver dem --out out").quiet();
    let settled: Vec<&str> =
        text.lines().map(|line| if line.starts_with("took ") { "took       [time]" } else { line }).collect();
    insta::assert_snapshot!(settled.join("\n"));
    let parts = |of: &str| format!("vtk/{of}-000000.vtp vtk/{of}-000001.vtp vtk/{of}-000002.vtp vtk/{of}-000003.vtp");
    let [contacts, grains] = ["contacts", "grains"].map(|of| format!("{} vtk/{of}.pvd", parts(of)));
    let expected = format!("manifest.json record.json series.csv snapshots.dump {contacts} {grains}");
    assert_eq!(files(&directory.join("out")).join(" "), expected);
    let series = directory.read("out/series.csv");
    assert_eq!(series.lines().count(), 1 + 11, "{series}");
}

/// A packing can be unstable below the critical step of one contact. Above this limit, `simulate` warns.
#[test]
fn simulate_warns_above_the_stable_fraction() {
    let scene = "title = 't'\ndimension = 2\nduration_cycles = 2\n[materials.m]\ndensity = 1000.0\n\
         [contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1e6\n\
         [grains.g]\nmaterial = 'm'\nradius = 0.1\nlattice = { origin = [0.0, 0.0], spacing = [0.3, 0.3], count = [2, 2] }\n\
         [probes]\nall = { system = true }\n";
    let directory = temporary_with("four.toml", scene);
    directory.write("two.toml", scene.replace("[2, 2]", "[2, 1]"));
    // Two grains have only one contact, whose critical step is exact.
    for (file, fraction, warns) in [("four", "0.9", true), ("four", "0.1", false), ("two", "0.9", false)] {
        let answer = directory.ok(format!("simulate {file}.toml --solver dem --time-step-fraction {fraction}"));
        assert_eq!(answer.err.contains("a packing can be unstable"), warns, "{file} {fraction}: {}", answer.err);
    }
}

#[test]
fn simulate_prints_the_run_as_json() {
    let directory = temporary_with("scene.toml", SCENE);
    let arguments = "--solver dem:liggghts --time-step 1e-4 --json --set duration_cycles=400 --set title=Longer";
    let run = directory.ok(format!("simulate scene.toml {arguments}")).json();
    assert_eq!(run["provenance"]["scene"], "Longer");
    assert_eq!(run["provenance"]["solver"], "dem:liggghts");
    assert_eq!(run["provenance"]["time_step"], 1e-4);
    assert_eq!((run["cost"]["steps"].as_u64(), run["end"]["step"].as_u64()), (Some(400), Some(400)));
    assert_eq!((run["end"]["grains"].as_u64(), run["snapshots"].as_u64()), (Some(2), Some(4)));
    // The impact of two equal discs is elastic and conserves the energy ρπR² v²/2.
    let energy = run["end"]["kinetic_energy"].as_f64().unwrap();
    assert!((energy / (0.5 * 1000.0 * std::f64::consts::PI * 0.01) - 1.0).abs() < 1e-2, "{energy}");
    assert!(directory.join("grainbench-simulate/record.json").is_file());
}

#[test]
fn report_makes_pictures_of_simulations() {
    let path = temporary_with("scene.toml", SCENE);
    for (solver, out) in [("dem", "one"), ("dem:lammps", "two")] {
        path.run(format!("simulate scene.toml --solver {solver} --out {out}")).quiet();
    }
    path.run("report one --beside two --fringe-stress 1e3").quiet();
    let page = path.read("one/index.html");
    // The page has one picture of the speed, with both solvers side by side.
    let svg = path.read("one/figures/speed.svg");
    assert!(page.contains(&svg) && svg.matches("data:image/png;base64,").count() == 2, "{}", svg.len());
    assert!(page.contains("Two discs collide") && svg.contains(">dem, t") && svg.contains(">dem:lammps, t"), "{svg}");

    // A contact with a missing grain is not drawn. An invalid record is an error that names file and position.
    let record = path.read("one/record.json");
    path.write("one/record.json", record.replace("\"grain\":1,", "\"grain\":900,"));
    path.run("report one").quiet();
    path.run("report one --beside nowhere").refused("record.json");
    path.write("two/record.json", record.replacen("\"step\":[", "\"step\":[true,", 1));
    path.run("report two").refused("at `series.step[0]`: invalid type: boolean `true`");
}
