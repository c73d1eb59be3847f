//! Scenes that once hung, panicked, exhausted the memory, or gave non-finite numbers with exit code 0. Each must give
//! an error with a reason, or run. Further scenes are in `tests/refusals/hostile-scenes.toml`.

use crate::common::{Directory, temporary, temporary_with};

const ELASTIC: &str = include_str!("../scenes/elastic.toml");
const RIGID: &str = include_str!("../scenes/disc.toml");

/// Returns the exit code and the messages of a simulation of a scene. `more` extends the scene, and `arguments` the command.
fn simulated(scene: &str, more: &str, arguments: &str) -> (i32, String) {
    let directory = temporary_with("s.toml", format!("{scene}{more}"));
    let answer = directory.run(format!("simulate s.toml --solver {arguments}"));
    (answer.code.unwrap(), answer.err)
}

/// Messages shorten long words and lists of a scene.
#[test]
fn long_values_are_quoted_in_short() {
    for (from, to) in [
        ("radius = 0.1", format!("radius = 0.1\n{} = 1", "x".repeat(5000))),
        ("position = [0.0, 0.0]", format!("position = [{}0.0]", "0.0, ".repeat(5000))),
        ("material = 'm'", format!("material = '{}'", "(".repeat(5000))),
    ] {
        let (code, message) = simulated(&RIGID.replace(from, &to), "", "dem");
        assert!(code == 2 && message.len() < 500 && message.contains("expected") && message.contains('…'), "{message}");
    }
}

/// Each of these scenes differs slightly from one that `tests/refusals/hostile-scenes.toml` rejects.
#[test]
fn what_is_barely_possible_runs() {
    let bar = "[bodies.b]\nmaterial = 'm'\nbox = { low = [0.0, 0.0], high = [10.0, 1.0] }\nfixed = ['x-low']\n\
               sliding = ['y-low', 'y-high']\nwave = { amplitude = 0.01 }\n";
    let many = "[output]\nsnapshots = 1000000000\nevery = 1e-9\n";
    for (scene, more, arguments) in [
        (ELASTIC, bar, "mpm --cells 2"),
        (RIGID, many, "dem"),
        (RIGID, "", "rigid"),
        (RIGID, "", "dem --checkpoint kept --checkpoint-every 1"),
    ] {
        assert_eq!(simulated(scene, more, arguments), (0, String::new()), "{arguments}");
    }
}

/// A wall plane that coincides with a line of the grid.
#[test]
fn contact_on_a_line_of_the_grid_runs() {
    let (code, message) = simulated(
        &format!("largest_initial_overlap = 0.5\n{ELASTIC}"),
        "[bodies.b]\nmaterial = 'm'\nbox = { low = [0.0, 0.0], high = [1.0, 0.5] }\n\
         [walls.w]\nmaterial = 'm'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n[probes]\nb.body = 'b'\n",
        "mpm:gap",
    );
    assert_eq!(code, 0, "{message}");
}

/// A record with bodies but without grains once had no bounds and could not be read.
#[test]
fn a_record_of_bodies_alone_is_read_back() {
    let directory = temporary();
    let body = "[bodies.b]\nmaterial = 'm'\nbox = { low = [0.0, 0.0], high = [1.0, 0.5] }\n[output]\nsnapshots = 1\n";
    directory.write("s.toml", format!("{ELASTIC}{body}"));
    directory.ok("simulate s.toml --solver mpm --cells 4 --out out");
    directory.ok("report out");
    let record = directory.read("out/record.json");
    assert!(record.contains("\"bounds\":[[0.0,0.0,-0.5],[1.0,0.5,0.5]]"), "{record}");
}

/// Terminal control characters in a title are escaped in the output.
#[test]
fn titles_do_not_steer_a_terminal() {
    let directory = temporary_with("s.toml", RIGID.replace("title = 't'", "title = \"a\\u001b[2Jb\\u202ec\""));
    let answer = directory.ok("simulate s.toml --solver dem");
    assert!(answer.out.contains("a\\u{1b}[2Jb\\u{202e}c"), "{}", answer.out);
    assert!(!answer.out.contains('\u{1b}') && !answer.out.contains('\u{202e}'));
}

#[test]
fn thousands_of_overrides_are_refused() {
    let directory = temporary_with("s.toml", RIGID);
    directory
        .run(format!("simulate s.toml --solver dem {}", "--set duration=0.01 ".repeat(1001)))
        .refused("at most 1000 keys, found 1001");
}

/// Unused materials cost nothing. Only the number of pairs of used materials is limited.
#[test]
fn thousands_of_materials_that_nothing_is_made_of_cost_nothing() {
    let library: String = (0..3000).map(|number| format!("[materials.m{number}]\ndensity = 1.0\n")).collect();
    let (code, message) = simulated(RIGID, &library, "dem");
    assert_eq!(code, 0, "{message}");
    let walls: String = (0..3000)
        .map(|number| {
            let y = -1.0 - f64::from(number);
            format!(
                "[walls.w{number}]\nmaterial = 'm{number}'\nplane = {{ point = [0.0, {y}], normal = [0.0, 1.0] }}\n"
            )
        })
        .collect();
    let (code, message) = simulated(RIGID, &(library + &walls), "dem");
    assert_eq!(code, 2, "{message}");
    assert!(message.contains("at most 1000 materials that are in use"), "{message}");
}
