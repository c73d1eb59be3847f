//! Errors in the user's input and in files. Each error gives place, expected input and found input, has exit code 2 and
//! leaves no files.

use crate::common::{files, grainbench};
use grainbench::cases::registry::CASES;
use grainbench::cases::solvers;
use std::path::Path;

/// Scene of two discs on a floor, the upper one not yet in contact.
const SCENE: &str = r#"title = "Two discs on a floor"
dimension = 2
gravity = [0.0, -9.8]
duration = 0.01

[materials.rock]
density = 2600.0

[contacts.rock]
between = ["rock", "rock"]
normal_stiffness = 1e6
tangential_stiffness = 1e6
friction = 0.5

[grains.lower]
material = "rock"
radius = 0.1
position = [0.0, 0.1]

[grains.upper]
material = "rock"
radius = 0.1
position = [0.0, 0.35]

[walls.floor]
material = "rock"
plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }

[probes]
upper = { grain = "upper" }

[variants.slippery]
contacts.rock.friction = 0.1
"#;

/// Returns the error message for wrong input in a directory, after checking that the run failed without leaving files.
fn refusal(directory: &Path, arguments: &[&str]) -> String {
    let before = files(directory);
    let answer = grainbench(directory, arguments);
    assert_eq!(answer.code, Some(2), "{}{}", answer.out, answer.err);
    assert_eq!(answer.out, "");
    assert!(answer.err.starts_with("error: "), "{}", answer.err);
    assert_eq!(files(directory), before);
    answer.err
}

/// Returns the error message for a scene file that is simulated with further options.
fn refused_with(scene: &[u8], options: &[&str]) -> String {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("scene.toml"), scene).unwrap();
    let plain = ["simulate", "scene.toml", "--solver", "dem", "--out", "out"];
    let err = refusal(directory.path(), &[&plain, options].concat());
    // Known names follow below the message, one a line.
    assert_eq!(err.lines().filter(|line| !line.starts_with("  ")).count(), 1, "{err}");
    err
}

/// Returns the scene above with one part of its text replaced.
fn edited(from: &str, to: &str) -> String {
    assert!(SCENE.contains(from), "{from}");
    SCENE.replacen(from, to, 1)
}

fn refused(from: &str, to: &str) -> String {
    refused_with(edited(from, to).as_bytes(), &[])
}

/// Removes the names of all cases and solvers, which this test does not depend on.
fn without_registries(message: &str) -> String {
    let lines = |names: Vec<String>| names.iter().map(|name| format!("  {name}\n")).collect::<String>();
    let cases = lines(CASES.iter().map(|case| case.name.to_owned()).collect());
    message.replace(&cases, "  [cases]\n").replace(&lines(solvers::names()), "  [solvers]\n")
}

#[test]
fn the_scene_itself_is_fine() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    let answer = grainbench(directory.path(), &["simulate", "scene.toml", "--solver", "dem", "--variant", "slippery"]);
    assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""));
}

/// Defines a test for each edit of the scene: name, replaced text, new text.
macro_rules! refused_edits {
    ($($name:ident: $from:expr => $to:expr;)*) => {
        $(#[test]
        fn $name() {
            insta::assert_snapshot!(refused($from, $to));
        })*
    };
}

refused_edits! {
    unknown_key: "friction = 0.5" => "frction = 0.5";
    unknown_key_at_the_top: "gravity" => "gravitiy";
    wrong_type: "radius = 0.1" => "radius = \"0.1\"";
    wrong_type_of_many_forms: "gravity = [0.0, -9.8]" => "gravity = 9.8";
    negative_radius: "radius = 0.1" => "radius = -0.1";
    zero_density: "density = 2600.0" => "density = 0.0";
    negative_density: "density = 2600.0" => "density = -2600.0";
    no_density: "density = 2600.0" => "";
    mass_below_all_numbers: "radius = 0.1" => "radius = 1e-200";
    friction_not_a_number: "friction = 0.5" => "friction = nan";
    infinite_stiffness: "normal_stiffness = 1e6" => "normal_stiffness = inf";
    friction_without_tangential_stiffness: "tangential_stiffness = 1e6" => "";
    deep_overlap: "position = [0.0, 0.35]" => "position = [0.0, 0.25]";
    zero_duration: "duration = 0.01" => "duration = 0.0";
    no_duration: "duration = 0.01" => "";
    two_kinds_of_duration: "duration = 0.01" => "duration = 0.01\nduration_cycles = 10";
    duration_twice: "duration = 0.01" => "duration = 0.01\nduration = 0.02";
    four_dimensions: "dimension = 2" => "dimension = 4";
    vector_of_wrong_length: "position = [0.0, 0.35]" => "position = [0.0, 0.35, 0.0]";
    spin_of_wrong_form: "[grains.upper]" => "[grains.upper]\nspin = [0.0, 0.0, 1.0]";
    no_contact_law: "[walls.floor]\nmaterial = \"rock\"" => "[materials.steel]\n[walls.floor]\nmaterial = \"steel\"";
    unknown_material: "between = [\"rock\", \"rock\"]" => "between = [\"rock\", \"rok\"]";
    unknown_probe: "upper = { grain = \"upper\" }" => "upper = { grain = \"uper\" }";
    wall_without_direction: "normal = [0.0, 1.0]" => "normal = [0.0, 0.0]";
    segment_of_no_length: "plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }" => "segment = [[0.0, 0.0], [0.0, 0.0]]";
    periodic_without_domain: "[materials.rock]" => "[domain]\nperiodic = [true, false]\n\n[materials.rock]";
    domain_upside_down: "[materials.rock]" => "[domain]\nlow = [1.0, 0.0]\nhigh = [0.0, 1.0]\n\n[materials.rock]";
    period_shorter_than_a_grain:
        "[materials.rock]" => "[domain]\nlow = [0.0, 0.0]\nhigh = [0.19, 1.0]\nperiodic = [true, false]\n\n[materials.rock]";
    grain_outside_the_domain: "[materials.rock]" => "[domain]\nlow = [-1.0, 0.0]\nhigh = [1.0, 0.2]\n\n[materials.rock]";
    unknown_key_in_a_variant_not_asked_for: "contacts.rock.friction = 0.1" => "contacts.rock.frction = 0.1";
    more_steps_than_can_be_taken: "duration = 0.01" => "duration = 1e200";
    toml_syntax: "radius = 0.1" => "radius = = 0.1";
    missing_data_file: "radius = 0.1\nposition = [0.0, 0.1]" => "file = { path = \"no-such.data\" }";
    huge_lattice:
        "position = [0.0, 0.1]" => "lattice = { origin = [0.0, 0.1], spacing = [0.2, 0.2], count = [100000, 10000] }";
    huge_random: "position = [0.0, 0.1]" => "random = { count = 1000000000, seed = 1 }";
    packed_without_domain: "radius = 0.1\nposition = [0.0, 0.1]" => "packed = { seed = 1, radii = [[0.1, 5]] }";
    packed_with_nothing: "radius = 0.1\nposition = [0.0, 0.1]" => "packed = { seed = 1, radii = [] }";
    packed_into_too_little_room:
        "[materials.rock]" => "[domain]\nlow = [-1.0, 0.0]\nhigh = [1.0, 2.0]\n\n[grains.more]\nmaterial = \"rock\"\n\
                               packed = { seed = 1, radii = [[0.1, 500]] }\n\n[materials.rock]";
    packed_a_little_too_densely:
        "[materials.rock]" => "[domain]\nlow = [-1.0, 0.0]\nhigh = [1.0, 2.0]\n\n[grains.more]\nmaterial = \"rock\"\n\
                               packed = { seed = 1, radii = [[0.1, 112]] }\n\n[materials.rock]";
}

/// Error messages for values of a wrong shape for the floor, a grain's position or a probe.
#[test]
fn a_value_of_another_shape_is_shown_the_shape() {
    const PLANE: &str = "plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }";
    const PLACE: &str = "radius = 0.1\nposition = [0.0, 0.1]";
    const PROBE: &str = "upper = { grain = \"upper\" }";
    const TABLE: &str = "[grains.lower]";
    let edits = [
        (PLANE, "segment = [-1.0, 0.0, 1.0, 0.0]"),
        (PLANE, "segment = [[-1.0, 0.0], [1.0, 0.0], [1.0, 1.0]]"),
        (PLANE, "segment = { from = [-1.0, 0.0], to = [1.0, 0.0] }"),
        (PLANE, "segment = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]"),
        (PLANE, "plane = [0.0, 1.0]"),
        (PLANE, "plane = { point = 0.0, normal = [0.0, 1.0] }"),
        (PLANE, "plane = { point = [0.0, 0.0] }"),
        (PLANE, "plane = { point = [0.0, 0.0], normal = \"up\" }"),
        (PLANE, &format!("{PLANE}\nmotion = {{ velocity = [1.0, 0.0] }}")),
        (PLANE, &format!("{PLANE}\nmotion = [1.0, 0.0]")),
        (PLANE, &format!("{PLANE}\nmotion = [{{ velocity = 1.0 }}]")),
        (PLANE, &format!("{PLANE}\npiston = 100.0")),
        (PLANE, "cylinder = { axis = [0.0, 0.0, 1.0], radius = 0.1 }"),
        (PLANE, "rectangle = [[0.0, 0.0], [1.0, 1.0]]"),
        (PLANE, "cone = { axis = [[0.0, 0.0], [0.0, 1.0]], radii = 0.1 }"),
        (PLACE, "position = 0.1"),
        (PLACE, "radius = 0.1\nlattice = [10, 10]"),
        (PLACE, "radius = 0.1\nlattice = { origin = [0.0, 0.1], spacing = [0.2, 0.2], count = 4 }"),
        (PLACE, "radius = 0.1\nrandom = 100"),
        (PLACE, "random = { count = 10, seed = 1, radius_range = 0.1 }"),
        (PLACE, "random = { count = 10, seed = 1, radii = [0.1, 0.2] }"),
        (PLACE, "random = { count = 10, seed = 1, radii = { by_mass = { 0-1 = 0.5 } } }"),
        (PLACE, "packed = { seed = 1, radii = [0.1, 5] }"),
        (PLACE, "radius = 0.1\npoured = 10"),
        (PLACE, "file = \"grains.data\""),
        (PROBE, "upper = \"upper\""),
        (PROBE, "upper = { contact = \"upper\" }"),
        (PROBE, "upper = { point = [0.0, 0.35] }"),
        (TABLE, "[bodies.block]\nmaterial = \"rock\"\nbox = [0.0, 0.0, 1.0, 1.0]\n[grains.lower]"),
        (TABLE, "[bodies.block]\nmaterial = \"rock\"\nannulus = [0.1, 0.2]\n[grains.lower]"),
        (TABLE, "[bodies.block]\nmaterial = \"rock\"\nfixed = \"x-low\"\n[grains.lower]"),
        (TABLE, "[driven]\nface = \"y-low\"\n[grains.lower]"),
        (TABLE, "[driven.some]\nregion = [0.0, 0.0, 1.0, 1.0]\n[grains.lower]"),
        (TABLE, "[driven.some]\ngrains = \"lower\"\nvelocity = 1.0\n[grains.lower]"),
        (TABLE, "[[walls]]\nmaterial = \"rock\"\n[grains.lower]"),
        (TABLE, "[domain]\nlow = 0.0\nhigh = [1.0, 1.0]\n[grains.lower]"),
        (TABLE, "[output]\nsnapshot_times = 0.5\n[grains.lower]"),
        (TABLE, "[removal]\nlow = [0.0, 0.0]\n[grains.lower]"),
    ];
    let messages: String = edits.iter().map(|(from, to)| format!("{to}\n  {}", refused(from, to))).collect();
    insta::assert_snapshot!(messages);
}

/// Error messages for invalid motions of walls and of grains with prescribed motion.
#[test]
fn motions_that_are_none() {
    const PLANE: &str = "plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }";
    let motions = [
        "table = [[0.0, 0.0], [1.0, 1.0]]",
        "table = [[0.0, 0.0, 0.0]]",
        "table = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.5, 0.0, 0.0]]",
        "table = [[0.0, 1.0, 0.0], [1.0, 1.0, 0.0]]",
        "table = [0.0, 1.0]",
        "table = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]], start = 1.0",
        "table = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]], velocity = [1.0, 0.0]",
        "sine = { amplitude = 0.1, frequency = 1.0 }",
        "sine = { amplitude = [0.1, 0.0], frequency = 0.0 }",
        "sine = [0.1, 1.0]",
        "sine = { amplitude = [0.1, 0.0], frequency = 1.0 }, start_cycle = 3",
        "sine = { amplitude = [0.1, 0.0], frequency = 1.0 }, spin = 1.0, centre = [0.0, 0.0]",
        "ramp = 1.0",
        "ramp = -1.0, velocity = [1.0, 0.0]",
    ];
    let walls = motions.map(|part| {
        let motion = format!("{PLANE}\nmotion = [{{ {part} }}]");
        format!("{part}\n  {}", refused(PLANE, &motion))
    });
    let driven = [
        "material = \"rok\"",
        "material = \"rock\"\ngrains = \"lower\"",
        "grains = \"lower\"\nspin = [0.0, 0.0, 1.0]",
        "grains = \"lower\"\nmotion = [{ spin = 1.0, centre = [0.0, 0.0] }]",
        "grains = \"lower\"\nmotion = [{ velocity = [1.0, 0.0], stop_cycle = 3 }]",
    ];
    let driven = driven.map(|keys| {
        let message = refused("[grains.lower]", &format!("[driven.some]\n{keys}\n[grains.lower]"));
        format!("{keys}\n  {message}")
    });
    insta::assert_snapshot!(walls.concat() + &driven.concat());
}

#[test]
fn random_grains_beyond_their_room() {
    let scene = edited("[materials.rock]", "[domain]\nlow = [-1.0, 0.0]\nhigh = [1.0, 2.0]\n\n[materials.rock]");
    let random = scene.replacen("position = [0.0, 0.1]", "random = { count = 90, seed = 1 }", 1);
    insta::assert_snapshot!(refused_with(random.as_bytes(), &[]));
}

#[test]
fn a_mistake_in_a_variant_is_found_where_it_stands() {
    let scene = edited("contacts.rock.friction = 0.1", "contacts.rock.friction = -0.1");
    insta::assert_snapshot!(refused_with(scene.as_bytes(), &["--variant", "slippery"]));
}

#[test]
fn unknown_variant() {
    insta::assert_snapshot!(refused_with(SCENE.as_bytes(), &["--variant", "slipery"]));
}

#[test]
fn unknown_solver() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    let err = refusal(directory.path(), &["simulate", "scene.toml", "--solver", "dem:lamps"]);
    insta::assert_snapshot!(without_registries(&err));
}

#[test]
fn set_of_an_unknown_key() {
    insta::assert_snapshot!(refused_with(SCENE.as_bytes(), &["--set", "grains.upper.radus=0.2"]));
}

#[test]
fn set_below_an_unknown_key() {
    insta::assert_snapshot!(refused_with(SCENE.as_bytes(), &["--set", "grain.upper.radius=0.2"]));
}

#[test]
fn set_of_a_wrong_value() {
    insta::assert_snapshot!(refused_with(SCENE.as_bytes(), &["--set", "grains.upper.radius=-0.2"]));
}

#[test]
fn set_of_an_empty_path() {
    insta::assert_snapshot!(refused_with(SCENE.as_bytes(), &["--set", "grains..radius=0.2"]));
}

#[test]
fn set_without_a_value() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    let arguments = ["simulate", "scene.toml", "--solver", "dem", "--set", "grains.upper.radius"];
    insta::assert_snapshot!(refusal(directory.path(), &arguments));
}

#[test]
fn step_of_no_size() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    for step in ["-1e-3", "0", "nan", "inf", "small"] {
        let err = refusal(directory.path(), &["simulate", "scene.toml", "--solver", "dem", "--time-step", step]);
        assert!(err.contains("expected a positive number") && err.contains(step), "{err}");
    }
}

#[test]
fn step_above_the_critical_one() {
    insta::assert_snapshot!(refused_with(SCENE.as_bytes(), &["--time-step-fraction", "1.5"]));
    let err = refused_with(SCENE.as_bytes(), &["--time-step", "0.1"]);
    assert!(err.contains("found 1.000000e-1 s") && err.contains("--allow-unstable"), "{err}");
}

#[test]
fn step_above_the_critical_one_is_taken_when_it_is_meant() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    let arguments = [
        "simulate",
        "scene.toml",
        "--solver",
        "dem",
        "--time-step-fraction",
        "1.5",
        "--allow-unstable",
        "--out",
        "out",
    ];
    // The discs fall freely for the first ten milliseconds, so no spring can be unstable.
    let answer =
        grainbench(directory.path(), &[&arguments[..], &["--set", "grains.lower.position=[1.0, 0.5]"]].concat());
    assert_eq!(answer.code, Some(0), "{}", answer.err);
    assert!(directory.path().join("out/record.json").is_file());
}

#[test]
fn no_critical_step_without_contacts() {
    let start = SCENE.find("[contacts.rock]").unwrap();
    let end = SCENE.find("[grains.lower]").unwrap();
    let walls = SCENE.find("[walls.floor]").unwrap();
    let lone = format!("{}{}", &SCENE[..start], &SCENE[end..walls]);
    let lone = lone.split("[grains.upper]").next().unwrap().to_owned();
    insta::assert_snapshot!(refused_with(lone.as_bytes(), &[]));
}

#[test]
fn a_run_that_blows_up_says_when_where_why_and_what_would_have_been_stable() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    let arguments =
        ["simulate", "scene.toml", "--solver", "dem", "--time-step-fraction", "0.9", "--out", "out", "--json"];
    let long = ["--set", "duration=100", "--set", "grains.upper.position=[0.0, 0.295]"];
    let answer = grainbench(directory.path(), &[&arguments[..], &long].concat());
    assert_eq!((answer.code, answer.out.as_str()), (Some(1), ""));
    // The run leaves its partial output, but no record.
    let left = files(directory.path());
    assert!(left.contains(&"out/broken.json".to_owned()) && left.contains(&"out/series.csv".to_owned()), "{left:?}");
    assert!(!left.contains(&"out/record.json".to_owned()), "{left:?}");
    insta::assert_snapshot!(answer.err);
}

#[test]
fn missing_scene_file() {
    let directory = tempfile::tempdir().unwrap();
    insta::assert_snapshot!(refusal(directory.path(), &["simulate", "no-such.toml", "--solver", "dem"]));
}

#[test]
fn a_directory_for_a_scene() {
    let directory = tempfile::tempdir().unwrap();
    insta::assert_snapshot!(refusal(directory.path(), &["simulate", ".", "--solver", "dem"]));
}

#[test]
fn empty_scene_file() {
    insta::assert_snapshot!(refused_with(b"", &[]));
}

#[test]
fn scene_file_of_other_bytes() {
    insta::assert_snapshot!(refused_with(b"title = \"\xff\xfe\"\n", &[]));
}

#[test]
fn binary_scene_file() {
    insta::assert_snapshot!(refused_with(b"\x7fELF\x02\x01\x01\0\0\0\0\0\0\0\0\0\x03\0>\0\x01\0\0\0", &[]));
}

#[test]
fn truncated_data_file() {
    let directory = tempfile::tempdir().unwrap();
    let from = "radius = 0.1\nposition = [0.0, 0.1]";
    std::fs::write(directory.path().join("scene.toml"), edited(from, "file = { path = \"cut.data\" }")).unwrap();
    let data = "LAMMPS data file\n\n2 atoms\n1 atom types\n\n0 1 xlo xhi\n0 1 ylo yhi\n-0.5 0.5 zlo zhi\n\n\
                Atoms # sphere\n\n1 1 0.2 2600.0 0.5 0.5 0.0\n";
    std::fs::write(directory.path().join("cut.data"), data).unwrap();
    insta::assert_snapshot!(refusal(directory.path(), &["simulate", "scene.toml", "--solver", "dem"]));
}

#[test]
fn output_directories_that_cannot_be_written() {
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
    std::fs::write(directory.path().join("file"), "").unwrap();
    let mut messages = String::new();
    // The error must come before this run of a million seconds, otherwise the test would never end.
    let simulate = ["simulate", "scene.toml", "--solver", "dem", "--set", "duration=1000000"];
    // Permissions do not stop a superuser. A file in the way and a directory of the system stop every user.
    for out in ["file", "file/deep/er", "/proc/grainbench/deep"] {
        messages += &refusal(directory.path(), &[&simulate[..], &["--out", out]].concat());
        messages += &refusal(directory.path(), &["run", "squash", "--out", out]);
    }
    insta::assert_snapshot!(messages);
}

#[test]
fn unknown_case() {
    let directory = tempfile::tempdir().unwrap();
    insta::assert_snapshot!(without_registries(&refusal(directory.path(), &["run", "squahs"])));
}

#[test]
fn unknown_variant_of_a_case() {
    let directory = tempfile::tempdir().unwrap();
    insta::assert_snapshot!(refusal(directory.path(), &["run", "squash/plane"]));
}

#[test]
fn unknown_solver_of_a_run() {
    let directory = tempfile::tempdir().unwrap();
    let err = refusal(directory.path(), &["run", "squash", "--solver", "dem:ligghts"]);
    insta::assert_snapshot!(without_registries(&err));
}

#[test]
fn unknown_level() {
    let directory = tempfile::tempdir().unwrap();
    insta::assert_snapshot!(refusal(directory.path(), &["run", "squash", "--levels", "dt=.06"]));
}

#[test]
fn nothing_selected() {
    let directory = tempfile::tempdir().unwrap();
    insta::assert_snapshot!(refusal(directory.path(), &["run", "squash", "--solver", "dem:lammps"]));
}

#[test]
fn unknown_command_and_option() {
    let directory = tempfile::tempdir().unwrap();
    insta::assert_snapshot!(refusal(directory.path(), &["simulat"]));
    insta::assert_snapshot!(refusal(directory.path(), &["run", "--level", "all"]));
}

#[test]
fn reports_that_are_missing_or_damaged() {
    let directory = tempfile::tempdir().unwrap();
    insta::assert_snapshot!(refusal(directory.path(), &["report", "no-such"]));
    std::fs::write(directory.path().join("report.json"), "{\"provenance\": 3}").unwrap();
    insta::assert_snapshot!(refusal(directory.path(), &["report", "."]));
}

#[test]
fn checkpoints() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path();
    std::fs::write(path.join("scene.toml"), SCENE).unwrap();
    let simulate = ["simulate", "scene.toml"];
    let every = ["--checkpoint", "run.checkpoint", "--checkpoint-every", "3"];
    assert_eq!(grainbench(path, &[&simulate[..], &["--solver", "dem"], &every].concat()).code, Some(0));
    let whole = std::fs::read(path.join("run.checkpoint")).unwrap();
    let restart = |name: &str, further: &[&str]| {
        let solver: &[&str] = if further.contains(&"--solver") { &[] } else { &["--solver", "dem"] };
        let message = refusal(path, &[&simulate[..], &["--restart", name, "--out", "new"], solver, further].concat());
        message.lines().map(|line| line.trim_end().to_owned() + "\n").collect::<String>()
    };
    let stored = |name: &str, bytes: &[u8]| std::fs::write(path.join(name), bytes).unwrap();
    stored("cut.checkpoint", &whole[..whole.len() / 2]);
    stored("empty.checkpoint", b"");
    stored("newer.checkpoint", &[b"grainbench checkpoint 99\n", &whole[24..]].concat());
    let mut changed = whole.clone();
    changed[whole.len() - 9] ^= 64;
    stored("changed.checkpoint", &changed);
    let refusals = [
        ("absent", restart("nowhere.checkpoint", &[])),
        ("truncated", restart("cut.checkpoint", &[])),
        ("empty", restart("empty.checkpoint", &[])),
        ("newer", restart("newer.checkpoint", &[])),
        ("changed", restart("changed.checkpoint", &[])),
        ("foreign", restart("scene.toml", &[])),
        ("another step", restart("run.checkpoint", &["--time-step-fraction", "0.05"])),
        ("another scene", restart("run.checkpoint", &["--set", "title=\"Another\""])),
        ("another solver", restart("run.checkpoint", &["--solver", "dem:lammps"])),
    ];
    let shown: String = refusals.iter().map(|(what, message)| format!("{what}: {message}")).collect();
    insta::assert_snapshot!("checkpoints", shown);
}

/// Resolution options of another kind of solver are errors.
#[test]
fn options_of_other_solvers() {
    let mut messages = String::new();
    for options in [
        ["--cells", "4"],
        ["--substeps", "4"],
        ["--solver=mpm", "--time-step=1e-3"],
        ["--solver=rigid", "--time-step-fraction=.05"],
        ["--solver=rigid", "--courant=.2"],
    ] {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(directory.path().join("scene.toml"), SCENE).unwrap();
        let mut arguments = vec!["simulate", "scene.toml", "--out", "out"];
        if !options[0].starts_with("--solver") {
            arguments.push("--solver=dem");
        }
        arguments.extend(options);
        let set = ["--set=materials.rock.young_modulus=1e7", "--set=materials.rock.poisson_ratio=.3"];
        arguments.extend(set);
        messages += &format!("{}\n  {}", options.join(" "), refusal(directory.path(), &arguments));
    }
    insta::assert_snapshot!(messages);
}

#[test]
fn a_probe_of_a_place_or_a_wall_that_is_not_there() {
    let probes = ["contact = [\"upper\", \"flor\"]", "point = { grain = \"upper\", at = [0.0, 0.9] }"];
    let messages = probes.map(|probe| refused("upper = { grain = \"upper\" }", &format!("upper = {{ {probe} }}")));
    insta::assert_snapshot!(messages.concat());
}
