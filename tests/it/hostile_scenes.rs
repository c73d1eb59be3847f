//! Scenes that once hung, panicked, filled the memory or gave non-finite numbers with exit code 0. Each must give an
//! error with the reason, or run.

use crate::common::grainbench;
use std::fs;

const ELASTIC: &str = "title = 't'\ndimension = 2\nduration = 0.01\n\
     [materials.m]\ndensity = 1000.0\nyoung_modulus = 1.0e6\npoisson_ratio = 0.3\n\
     [contacts.m]\nbetween = ['m', 'm']\nlaw = 'coulomb'\n";
const RIGID: &str = "title = 't'\ndimension = 2\nduration = 0.01\n[materials.m]\ndensity = 1000.0\n\
     [contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1.0e6\n\
     [grains.a]\nmaterial = 'm'\nradius = 0.1\nposition = [0.0, 0.0]\nvelocity = [1.0, 0.0]\n[probes]\na.grain = 'a'\n";

/// Returns exit code and messages for a scene with appended text and further arguments.
fn simulated(scene: &str, more: &str, arguments: &[&str]) -> (i32, String) {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("s.toml"), format!("{scene}{more}")).unwrap();
    let answer = grainbench(directory.path(), &[&["simulate", "s.toml", "--solver"], arguments].concat());
    (answer.code.unwrap(), answer.err)
}

#[test]
fn what_does_not_fit_into_memory_is_counted_and_refused() {
    let (code, message) = simulated(
        ELASTIC,
        "[bodies.b]\nmaterial = 'm'\nbox = { low = [0.0, 0.0], high = [1.7976931348623157e308, 1.0] }\n",
        &["mpm"],
    );
    assert!(code == 2 && message.contains("expected points and nodes that fit into memory"), "{message}");
    let (code, message) = simulated(
        ELASTIC,
        "[grains.a]\nmaterial = 'm'\nradius = 0.01\nposition = [0.0, 60.0]\n\
         [bodies.b]\nmaterial = 'm'\nbox = { low = [-50000.0, 0.0], high = [50000.0, 50000.0] }\n",
        &["mpm"],
    );
    assert!(code == 2 && message.contains("points, about"), "{message}");
}

/// The list of steps and the series once filled the memory.
#[test]
fn more_output_than_fits_into_memory_is_refused_by_each_solver() {
    let long = RIGID.replace("duration = 0.01", "duration = 1e9");
    for solver in ["dem", "rigid"] {
        for (output, key) in [("snapshots = 1000000000", "output.snapshots"), ("every = 1e-9", "output.every")] {
            let (code, message) = simulated(&long, &format!("[output]\n{output}\n"), &[solver]);
            let expected = format!("s.toml: {solver}: {key}: expected ");
            assert!(
                code == 2 && message.contains(&expected) && message.contains("that fit into memory, found "),
                "{message}"
            );
        }
    }
    let (code, message) = simulated(RIGID, "[output]\nsnapshots = 1000000000\nevery = 1e-9\n", &["dem"]);
    assert_eq!(code, 0, "a short run has few steps: {message}");
}

/// Random and packed grains of absurd sizes once were tried for hours.
#[test]
fn grains_that_cannot_be_placed_end_in_an_error() {
    let scene = |grains: &str| {
        format!("domain = {{ low = [0.0, 0.0], high = [1.0, 1.0] }}\n{ELASTIC}[grains.a]\nmaterial = 'm'\n{grains}\n")
    };
    for (grains, reason) in [
        ("packed = { seed = 1, radii = [[1e200, 3000]] }", "expected grains that fill"),
        ("packed = { seed = 1, radii = [[1000.0, 3000]] }", "expected grains that fill"),
        ("radius = 1000.0\nrandom = { count = 3000, seed = 1 }", "expected grains that find room"),
    ] {
        let (code, message) = simulated(&scene(grains), "", &["dem"]);
        assert!(code == 2 && message.contains(reason), "{grains}: {message}");
    }
}

/// Words and lists of a scene are shortened in messages.
#[test]
fn long_values_are_quoted_in_short() {
    for (from, to) in [
        ("radius = 0.1", format!("radius = 0.1\n{} = 1", "x".repeat(5000))),
        ("position = [0.0, 0.0]", format!("position = [{}0.0]", "0.0, ".repeat(5000))),
        ("material = 'm'", format!("material = '{}'", "(".repeat(5000))),
    ] {
        let (code, message) = simulated(&RIGID.replace(from, &to), "", &["dem"]);
        assert!(code == 2 && message.len() < 500 && message.contains("expected") && message.contains('…'), "{message}");
    }
}

#[test]
fn bodies_that_the_grid_does_not_see_are_refused() {
    let body = "reference_length = 20.0\n";
    let (code, message) = simulated(
        &format!("{body}{ELASTIC}"),
        "[bodies.b]\nmaterial = 'm'\nbox = { low = [0.0, 0.0], high = [1.0, 1.0] }\n",
        &["mpm"],
    );
    assert!(
        code == 2 && message.contains("expected a body at least 0.5 cells wide, found `b` with 0.400"),
        "{message}"
    );
}

/// With one cell between two fixed sides, the energy once grew by a factor of 2e7.
#[test]
fn one_cell_between_two_held_sides_is_refused() {
    let bar = "[bodies.b]\nmaterial = 'm'\nbox = { low = [0.0, 0.0], high = [10.0, 1.0] }\nfixed = ['x-low']\n\
               sliding = ['y-low', 'y-high']\nwave = { amplitude = 0.01 }\n";
    let (code, message) = simulated(ELASTIC, bar, &["mpm", "--cells", "1"]);
    assert!(code == 2 && message.contains("cells between two sides of `b` that are held, found 1.000"), "{message}");
    assert_eq!(simulated(ELASTIC, bar, &["mpm", "--cells", "2"]).0, 0);
}

/// A plane on a line of the grid.
#[test]
fn contact_on_a_line_of_the_grid_runs() {
    let (code, message) = simulated(
        &format!("largest_initial_overlap = 0.5\n{ELASTIC}"),
        "[bodies.b]\nmaterial = 'm'\nbox = { low = [0.0, 0.0], high = [1.0, 0.5] }\n\
         [walls.w]\nmaterial = 'm'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n[probes]\nb.body = 'b'\n",
        &["mpm:gap"],
    );
    assert_eq!(code, 0, "{message}");
}

#[test]
fn rigid_bodies_run_without_being_told_how_finely() {
    assert_eq!(simulated(RIGID, "", &["rigid"]), (0, String::new()));
    let (code, message) = simulated(RIGID, "", &["rigid", "--substeps", "0"]);
    assert!(code == 2 && message.contains("substeps"), "{message}");
}

#[test]
fn more_steps_than_any_solver_takes_are_refused_by_each() {
    for solver in ["dem", "rigid"] {
        let (code, message) = simulated(&RIGID.replace("duration = 0.01", "duration = 1e200"), "", &[solver]);
        assert!(code == 2 && message.contains("expected fewer than 1e15 steps"), "{solver}: {message}");
    }
    let body = "[bodies.b]\nmaterial = 'm'\nbox = { low = [0.0, 0.0], high = [1.0, 1.0] }\n";
    let (code, message) = simulated(&ELASTIC.replace("duration = 0.01", "duration = 1e200"), body, &["mpm"]);
    assert!(code == 2 && message.contains("expected fewer than 1e15 steps"), "{message}");
}

/// The cells are as long as the period, independent of the options. Such a body once ended the program for lack of
/// memory.
#[test]
fn a_body_longer_than_the_period_is_refused() {
    let (code, message) = simulated(
        &format!("reference_length = 1e308\n{ELASTIC}"),
        "[domain]\nlow = [0.0, 0.0]\nhigh = [1.0, 1.0]\nperiodic = [true, true]\n\
         [bodies.b]\nmaterial = 'm'\nbox = { low = [0.0, 0.0], high = [1e12, 1.0] }\n",
        &["mpm"],
    );
    assert!(code == 2 && message.contains("body `b` is longer along x than the period there"), "{message}");
}

#[test]
fn bodies_that_would_settle_for_ever_are_refused() {
    let (code, message) = simulated(
        &format!("settle = {{ duration = 1e200, damping = 1.0, gravity = [0.0, 0.0] }}\n{ELASTIC}"),
        "[bodies.b]\nmaterial = 'm'\nbox = { low = [0.0, 0.0], high = [1.0, 1.0] }\n",
        &["mpm"],
    );
    assert!(code == 2 && message.contains("expected fewer than 1e15 steps"), "{message}");
}

/// A record of bodies without grains once had no bounds and could not be read back.
#[test]
fn a_record_of_bodies_alone_is_read_back() {
    let directory = tempfile::tempdir().unwrap();
    let body = "[bodies.b]\nmaterial = 'm'\nbox = { low = [0.0, 0.0], high = [1.0, 0.5] }\n[output]\nsnapshots = 1\n";
    fs::write(directory.path().join("s.toml"), format!("{ELASTIC}{body}")).unwrap();
    let simulate = ["simulate", "s.toml", "--solver", "mpm", "--cells", "4", "--out", "out"];
    assert_eq!(grainbench(directory.path(), &simulate).code, Some(0));
    let answer = grainbench(directory.path(), &["report", "out"]);
    assert_eq!(answer.code, Some(0), "{}", answer.err);
    let record = fs::read_to_string(directory.path().join("out/record.json")).unwrap();
    assert!(record.contains("\"bounds\":[[0.0,0.0,-0.5],[1.0,0.5,0.5]]"), "{record}");
}

#[test]
fn a_checkpoint_replaces_a_checkpoint_and_nothing_else() {
    let directory = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(directory.path().join(name), text).unwrap();
    write("s.toml", RIGID);
    write("letter", "dear reader");
    let run = |place: &str| {
        let arguments = ["simulate", "s.toml", "--solver", "dem", "--checkpoint", place, "--checkpoint-every", "1"];
        let answer = grainbench(directory.path(), &arguments);
        (answer.code.unwrap(), answer.err)
    };
    let (code, message) = run("letter");
    assert!(code == 2 && message.contains("found another file"), "{message}");
    assert_eq!(fs::read_to_string(directory.path().join("letter")).unwrap(), "dear reader");
    let (code, message) = run("/dev/null");
    assert!(code == 2 && message.contains("found something that is no file"), "{message}");
    assert_eq!((run("kept").0, run("kept").0), (0, 0));
}

/// Terminal control characters are escaped in the output.
#[test]
fn titles_do_not_steer_a_terminal() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("s.toml"), RIGID.replace("title = 't'", "title = \"a\\u001b[2Jb\\u202ec\""))
        .unwrap();
    let answer = grainbench(directory.path(), &["simulate", "s.toml", "--solver", "dem"]);
    assert_eq!(answer.code, Some(0), "{}", answer.err);
    assert!(answer.out.contains("a\\u{1b}[2Jb\\u{202e}c"), "{}", answer.out);
    assert!(!answer.out.contains('\u{1b}') && !answer.out.contains('\u{202e}'));
}

#[test]
fn thousands_of_overrides_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("s.toml"), RIGID).unwrap();
    let many: Vec<&str> = std::iter::repeat_n(["--set", "duration=0.01"], 1001).flatten().collect();
    let answer = grainbench(directory.path(), &[&["simulate", "s.toml", "--solver", "dem"][..], &many].concat());
    assert!(answer.code == Some(2) && answer.err.contains("at most 1000 keys, found 1001"), "{}", answer.err);
}

/// A library of unused materials costs nothing. The table of pairs of used materials is limited.
#[test]
fn thousands_of_materials_that_nothing_is_made_of_cost_nothing() {
    let library: String = (0..3000).map(|number| format!("[materials.m{number}]\ndensity = 1.0\n")).collect();
    let (code, message) = simulated(RIGID, &library, &["dem"]);
    assert_eq!(code, 0, "{message}");
    let walls: String = (0..3000)
        .map(|number| {
            let y = -1.0 - f64::from(number);
            format!(
                "[walls.w{number}]\nmaterial = 'm{number}'\nplane = {{ point = [0.0, {y}], normal = [0.0, 1.0] }}\n"
            )
        })
        .collect();
    let (code, message) = simulated(RIGID, &(library + &walls), &["dem"]);
    assert_eq!(code, 2, "{message}");
    assert!(message.contains("at most 1000 materials that something is made of"), "{message}");
}
