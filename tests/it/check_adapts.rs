//! `check` adapts to the output: parameters that follow others, the start in a file, and contact conventions.

use crate::common::{Directory, count, data, root, temporary, temporary_with, unpacked};
use serde_json::Value;
use std::path::Path;

/// Simulates a scene file. The table of its probes is `run/series.csv`.
fn simulate(directory: &Path, scene: &str, solver: &str, step: &str, set: &str) {
    directory.ok(format!("simulate {scene} --solver {solver} --time-step {step} --out run --write none {set}"));
}

/// Parameters of the LIGGGHTS run of a sphere of 5 mm, as changes of the case.
const NUMBERS: &str = "--set gravity={magnitude=9.81,slope_deg=30} --set duration=.5 \
     --set materials.rock={density=2500,young_modulus=5e6,poisson_ratio=.3} \
     --set 'contacts.plane={law=\"hertz\",friction=.5,restitution=.5}'";

/// The position follows the radius. The Hertz law removes the linear stiffness, and Young's modulus the bulk modulus.
#[test]
fn keys_follow_other_keys() {
    let directory = temporary();
    let dump = data("liggghts-slope/sphere.dump");
    let checked =
        |more: &str| directory.run(format!("check incline-sphere/45deg-mu.495 --dump {dump} --json {NUMBERS} {more}"));
    let exact = |rows: &[Value], verdict: &str| {
        rows.iter().filter(|row| row["evidence"] == "analytic" && row["verdict"] == verdict).count()
    };
    for start in ["--set grains.sphere.radius=.005", &format!("--like {dump}")] {
        let (code, rows) = checked(start).judged();
        assert_eq!((code, exact(&rows, "pass")), (Some(0), 3), "{start}: {rows:#?}");
    }
    // Another radius does not fit the file, and the start of a file does not excuse wrong physics.
    checked("--set grains.sphere.radius=.0052").refused("radius");
    let answer = checked(&format!("--like {dump} --set gravity.slope_deg=31"));
    assert!(answer.code == Some(1) && exact(&answer.rows(), "fail") > 0, "{}", answer.out);
    // A file without grains, and one with another number of grains.
    directory.write("empty.dump", "");
    checked("--like empty.dump").refused("empty.dump");
    checked(&format!("--like {}", data("lammps-nine-static.dump.gz"))).refused("expected 1 grains");
}

/// A grain on a floor keeps its static overlap, and grains on it move with it.
#[test]
fn grains_move_with_a_radius() {
    let directory = temporary_with("s.toml", include_str!("../scenes/four-discs.toml"));
    let heights = |set: &str| -> Vec<f64> {
        let answer = directory.run(format!("scene s.toml {set}"));
        let resolved = answer.json();
        let grains = resolved["grains"].as_array().unwrap();
        grains.iter().map(|grain| grain["position"][1].as_f64().unwrap()).collect()
    };
    let near = |found: &[f64], expected: [f64; 4]| {
        let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-12, "{found:?}, expected {expected:?}");
    };
    let rest = |radius: f64| radius - 1000.0 * std::f64::consts::PI * radius * radius * 10.0 / 1e6;
    near(&heights(""), [0.1, 0.3, rest(0.1), 0.5]);
    near(&heights("--set grains.a.radius=0.2"), [0.2, 0.5, rest(0.1), 0.5]);
    near(&heights("--set grains.c.radius=0.05 --set grains.d.radius=0.05"), [0.1, 0.3, rest(0.05), 0.5]);
    // A position of the user stays.
    near(&heights("--set grains.a.radius=0.05 --set grains.a.position=[0,.05]"), [0.05, 0.2, rest(0.1), 0.5]);
}

/// A sphere that hits a floor obliquely, with friction and dashpots. The contact conventions differ by 12 %.
const OBLIQUE: &str = include_str!("../scenes/oblique-impact.toml");

/// The output is compared with the nearest convention, with its own tolerance. The summary names the convention.
#[test]
fn the_nearest_convention_is_judged_by_its_own_tolerance() {
    let directory = temporary_with("s.toml", OBLIQUE);
    let checked = |more: &str| directory.run(format!("check s.toml --dump run/series.csv --power off {more}"));
    for (solver, words) in [("dem:liggghts", "LIGGGHTS' convention"), ("dem:1979", "Cundall & Strack")] {
        simulate(&directory, "s.toml", solver, "1e-5", "");
        let answer = checked("");
        assert!(answer.code == Some(0) && answer.out.contains(", 0 fail, 0 amber"), "{solver}: {}", answer.out);
        let first = answer.out.lines().next().unwrap();
        assert!(first.starts_with("The output agrees with") && first.contains(words), "{first}");
        // The file and the time step are named once, and columns of zeros have one line.
        assert_eq!(answer.out.matches("series.csv · dt=").count(), 1, "{}", answer.out);
        assert!(answer.out.contains("exactly zero as expected: a.y, a.vy, a.omega_x, a.omega_z"), "{}", answer.out);
    }
    simulate(&directory, "s.toml", "dem:liggghts", "1e-5", "");
    let answer = checked("--convention dem:lammps");
    assert!(answer.code == Some(1) && answer.out.contains("differs from LAMMPS' convention"), "{}", answer.out);
    // Friction that is wrong by 4 % has less effect than the choice of the convention, so the output may have a
    // convention that we do not have.
    simulate(&directory, "s.toml", "dem:liggghts", "1e-5", "--set contacts.g.friction=.48");
    let answer = checked("");
    for part in ["The output differs from ", "first outside at t = ", "; our conventions differ by more"] {
        assert!(answer.out.contains(part) && !answer.out.contains(" 0 amber"), "{}", answer.out);
    }
    assert_eq!(checked("--strict").code, Some(1));
    assert_eq!(checked("--convention dem:liggghts").code, Some(1));
    // A larger mistake is red.
    simulate(&directory, "s.toml", "dem:liggghts", "1e-5", "--set contacts.g.friction=.1");
    assert_eq!(checked("").code, Some(1));
}

/// Thirty discs fall into a box. After the horizon of the run, only means are compared.
const THIRTY: &str = include_str!("../scenes/thirty-discs.toml");

#[test]
fn a_wrong_friction_of_many_grains_is_red() {
    let directory = temporary_with("s.toml", THIRTY);
    for (set, wrong) in [("", false), ("--set contacts.g.friction=.1", true)] {
        simulate(&directory, "s.toml", "dem:lammps", "2e-5", set);
        let (code, rows) = directory.run("check s.toml --dump run/series.csv --power off --json").judged();
        assert_eq!((code, count(&rows, "fail") > 0), (Some(wrong.into()), wrong), "{set}: {rows:#?}");
    }
}

/// 605 discs flow out of a hopper. Only their numbers are known, as in the log of a program.
const HOPPER: &str = include_str!("../scenes/hopper.toml");

/// The flow rate reveals a wrong friction. The tolerance is the scatter of our runs, and a right run of another convention and
/// another rounding lies within it. The result says how long a run must be to be conclusive.
#[test]
fn the_flow_rate_of_a_hopper_reveals_a_wrong_friction() {
    let directory = temporary_with("s.toml", HOPPER);
    let flow = |solver: &str, set: &str| {
        simulate(&directory, "s.toml", solver, "2.5e-4", set);
        let (code, rows) = directory.run("check s.toml --dump run/series.csv --power off --json").judged();
        let is_flow = |row: &&Value| row["quantity"].as_str().unwrap().starts_with("discs.left, mean rate from t = ");
        let row = rows.iter().find(is_flow).unwrap_or_else(|| panic!("{rows:#?}")).clone();
        (code, count(&rows, "fail"), row)
    };
    for solver in ["dem:lammps", "dem:1979"] {
        let (code, failed, row) = flow(solver, "--set grains.a.lattice.perturbation=1.00000001e-4");
        assert_eq!((code, failed), (Some(0), 0), "{row}");
        let detail = row["detail"].as_str().unwrap_or("times as long, to t = ");
        assert!(detail.contains("times as long, to t = "), "{row}");
    }
    let (code, _, row) = flow("dem:lammps", "--set contacts.g.friction=.1");
    assert_eq!((code, &row["verdict"]), (Some(1), &"fail".into()), "{row}");
    let detail = row["detail"].as_str().unwrap();
    assert!(detail.contains("larger than the mean of our runs, whose means lie between"), "{detail}");
    let allowed = row["allowed"].as_f64().unwrap();
    assert!((0.02..0.15).contains(&allowed), "{allowed}");
}

/// An output with another stiffness: the result is red, and the overlap at rest leads to the cause.
#[test]
fn an_overlap_at_rest_reveals_the_stiffness() {
    let directory = temporary_with("s.toml", OBLIQUE);
    let dump = |overlap: f64| {
        let row = |step: u32| {
            let time = f64::from(step) * 1e-5;
            let z = if step == 0 { 0.02 } else { 0.005 - overlap };
            format!(
                "ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n-1 1\n-1 1\n-1 1\n\
                 ITEM: ATOMS id x y z\n1 {time:?} 0.0 {z:?}\n"
            )
        };
        (0..=10).map(|sample| row(1000 * sample)).collect::<String>()
    };
    let checked = |overlap: f64| {
        directory.write("d.dump", dump(overlap));
        directory.run(
            "check s.toml --dump d.dump --time-step 1e-5 --power off --partial --set duration=.1 --set output.every=.01 \
             --set gravity=[0,0,-500]",
        )
    };
    let answer = checked(2e-5);
    assert!(answer.code == Some(1) && answer.out.contains("is the stiffness yours?"), "{}", answer.out);
    // The weight of 0.65 N causes an overlap of 65 µm.
    let answer = checked(6.5e-5);
    assert!(answer.code == Some(1) && !answer.out.contains("is the stiffness yours?"), "{}", answer.out);
}

/// A dump of contacts with the columns of our decks needs no `--map`.
#[test]
fn contacts_of_a_deck_need_no_names() {
    let directory = temporary();
    let text = unpacked("lammps-nine-static.contacts.gz");
    // The stored dump has the columns distance, two ids and two components of the force.
    let row = |order: &str, line: &str| match line.split_whitespace().collect::<Vec<_>>()[..] {
        ["ITEM:", "ENTRIES", ..] => format!("ITEM: ENTRIES {order}\n"),
        [_, a, b, x, y] => format!("{a} {b} {x} {y} 0\n"),
        _ => format!("{line}\n"),
    };
    let checked = |order: &str| {
        let contacts: String = text.lines().map(|line| row(order, line)).collect();
        directory.write("dump.contacts", contacts);
        let dump = data("lammps-nine-static.dump.gz");
        directory.run(format!("check nine-discs/static-0 --dump {dump} dump.contacts --partial --json"))
    };
    let (code, mut rows) = checked("c_pairs[1] c_pairs[2] c_pairs[4] c_pairs[5] c_pairs[6]").judged();
    rows.retain(|row| row["evidence"] == "analytic" && row["unit"] == "N");
    assert!(code == Some(0) && count(&rows, "pass") > 0, "{rows:#?}");
    // Columns in another order are not those of a deck.
    let swapped = "c_pairs[2] c_pairs[1] c_pairs[4] c_pairs[5] c_pairs[6]";
    checked(swapped).refused("expected columns `id1` and `id2`");
}

/// The stored runs of this case have a time step three times as short as a run of its solver-independent claim.
#[test]
fn a_longer_step_than_that_of_the_stored_run_passes() {
    let directory = temporary();
    let scene = root("cases/chung-ooi/scene.toml").display().to_string();
    for (set, code) in [("", 0), ("--set materials.sphere.young_modulus=48.5e9", 1)] {
        let solver = "--solver dem:lammps --time-step-fraction 0.003";
        directory.ok(format!("simulate {scene} --variant 1-glass {solver} --out run {set}"));
        let (found, mut rows) = directory.run("check chung-ooi/1-glass --dump run/series.csv --json").judged();
        rows.retain(|row| row["source"].as_str().unwrap().contains("stored run"));
        let red = count(&rows, "fail") > 0;
        assert!(!rows.is_empty() && found == Some(code) && red == (code == 1), "{rows:#?}");
    }
}

/// `check` and `deck` accept the folder of a case.
#[test]
fn the_folder_of_a_case_is_accepted() {
    let directory = temporary();
    let folder = root("examples/case").display().to_string();
    let scene = root("examples/case/scene.toml").display().to_string();
    simulate(&directory, &scene, "dem", "1e-5", "");
    let (code, rows) = directory.run(format!("check {folder}/plain --dump run/series.csv --json")).judged();
    let analytic = rows.iter().filter(|row| row["evidence"] == "analytic").count();
    assert_eq!((code, analytic), (Some(0), 2), "{rows:#?}");
    // Both variants have this start.
    directory.run(format!("check {folder} --dump run/series.csv")).refused("expected the name of a variant");
    directory.ok(format!("deck {folder} --for lammps --out deck"));
    directory.run("check run --dump run/series.csv").refused("claims.toml");
}
