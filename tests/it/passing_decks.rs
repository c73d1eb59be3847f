//! Decks of scenes with temporary grains, temporary walls and pistons. Each deck gives the same result as our solver,
//! or an error names the feature that the external program lacks.

use crate::common::{scene, simulated};
use grainbench::cases::solvers;
use grainbench::solver::failure::RunError;
use grainbench::solver::record::Record;
use grainbench::solver::resolution::Resolution;

const STEP: Resolution = Resolution::TimeStep(1e-3);

/// Spheres of mass 1 above a floor that ends in the middle.
const HEAD: &str = include_str!("../scenes/passing.toml");

const LEDGE: &str = "walls.ledge.material = 'm'\n\
    walls.ledge.rectangle = { corner = [-3.0, -1.0, 0.0], edges = [[3.0, 0.0, 0.0], [0.0, 6.0, 0.0]] }\n";
const FLOOR: &str = "[walls.floor]\nmaterial = 'm'\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n";
const LID: &str = "[walls.lid]\nmaterial = 'm'\nplane = { point = [0.0, 0.0, 2.1], normal = [0.0, 0.0, -1.0] }\n\
    motion = [{ velocity = [0.2, 0.0, 0.0] }]\n[probes]\nlid = { piston = 'lid' }\non-lid = { wall = 'lid' }\n";

/// Returns our run and the run of an external program, in its convention. `None` if it is not installed, an error in CI.
fn both(text: &str, program: &str) -> Option<[Record; 2]> {
    let ours = simulated(&format!("dem:{program}"), &scene(text), &STEP);
    match solvers::by_name(program).unwrap().run(&scene(text), &STEP, &mut ()) {
        Ok(theirs) => Some([ours, theirs]),
        Err(RunError::NotAvailable { .. }) if std::env::var_os("CI").is_none() => None,
        Err(error) => panic!("{error}"),
    }
}

/// Returns the largest distance between equal grains in snapshots of equal steps up to a time (s). Both snapshots must
/// contain the same grains.
fn apart([ours, theirs]: &[Record; 2], until: f64) -> f64 {
    let mut worst = 0.0_f64;
    let mut compared = 0;
    for (ours, theirs) in ours.snapshots.iter().zip(&theirs.snapshots).filter(|(ours, _)| ours.time <= until) {
        assert_eq!(ours.step, theirs.step);
        let ids =
            |ids_of: &[grainbench::solver::record::GrainState]| ids_of.iter().map(|grain| grain.id).collect::<Vec<_>>();
        assert_eq!(ids(&ours.grains), ids(&theirs.grains), "at {}", ours.time);
        for (a, b) in ours.grains.iter().zip(&theirs.grains) {
            worst = worst.max((a.position - b.position).norm());
            compared += 1;
        }
    }
    assert!(compared > 100, "{compared}");
    worst
}

fn column_apart([ours, theirs]: &[Record; 2], name: &str) -> [f64; 2] {
    let (a, b) = (ours.series.column(name).unwrap(), theirs.series.column(name).unwrap());
    let off = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    [off, a.iter().map(|a| a.abs()).fold(0.0, f64::max)]
}

/// Grains that fall off the ledge are removed at the same steps, and all other grains move in the same way.
#[test]
fn grains_leave_lammps_as_they_leave_ours() {
    let removal = "removal = { low = [-4.0, -1.0, -2.0], high = [4.0, 5.0, 20.0], every_cycles = 30 }\n";
    let text = format!(
        "{}{LEDGE}probes.grains = {{ count = true }}\n",
        HEAD.replacen("grains.ball.material", &format!("{removal}grains.ball.material"), 1)
    );
    let Some(records) = both(&text, "lammps") else { return };
    let left = records[0].series.column("grains.left").unwrap();
    assert!(left[0] == 0.0 && (3.0..30.0).contains(left.last().unwrap()), "{left:?}");
    assert_eq!(records[1].series.column("grains.left").unwrap(), left);
    let found = apart(&records, 5.0);
    assert!(found < 1e-8, "{found}");
    // Control: without removal, all grains remain.
    let all = both(&format!("{HEAD}{LEDGE}"), "lammps").unwrap();
    assert_eq!(all[1].snapshots.last().unwrap().grains.len(), 30);
}

/// The motion of the floor is the sum of a sine, a ramp and a table.
#[test]
fn a_floor_moves_along_a_path_in_lammps_as_in_ours() {
    let text = |ramp: f64| {
        let parts = [
            "{ sine = { amplitude = [0.02, 0.0, 0.01], frequency = 1.5, phase_deg = 30.0 }, start = 0.1 }",
            &format!("{{ velocity = [0.1, 0.05, 0.0], ramp = {ramp:?}, start = 0.2, stop = 0.9 }}"),
            "{ table = [[0.3, 0.0, 0.0, 0.0], [0.6, 0.0, 0.02, 0.01], [1.0, 0.0, 0.0, 0.0]] }",
        ];
        format!("{HEAD}{FLOOR}motion = [{}]\n", parts.join(", "))
    };
    let Some(records) = both(&text(0.5), "lammps") else { return };
    let found = apart(&records, 1.5);
    assert!(found < 1e-9, "{found}");
    // Control: a shorter ramp gives a visible difference.
    let [ours, _] = both(&text(0.45), "lammps").unwrap();
    assert!(apart(&[ours, records[1].clone()], 1.5) > 1e-4);
}

/// When the floor is removed, all grains start to fall at the same step.
#[test]
fn a_wall_is_taken_away_in_lammps_as_in_ours() {
    let text = |until: &str| format!("{HEAD}{FLOOR}until = {until}\n");
    let Some(records) = both(&text("3.0005"), "lammps") else { return };
    let found = apart(&records, 5.0);
    assert!(found < 1e-8, "{found}");
    // Control: a difference of one step is visible.
    let [ours, theirs] = both(&text("3.0015"), "lammps").unwrap();
    assert!(apart(&[ours, records[1].clone()], 5.0) > 1e-4);
    assert!(apart(&[records[0].clone(), theirs], 5.0) > 1e-4);
}

/// When a wall is removed, our solver omits its whole last force, and LIGGGHTS omits half of it. A grain that rested on
/// the wall therefore falls slower by ½ g Δt in LIGGGHTS.
#[test]
fn a_wall_is_taken_away_in_liggghts_but_for_half_a_push() {
    let single = HEAD
        .replace("count = [5, 3, 2]", "count = [1, 1, 1]")
        .replace("0.55]", "0.49995]")
        .replace("snapshots = 19", "snapshots = 199");
    let Some([ours, theirs]) = both(&format!("{single}{FLOOR}until = 2.0\n"), "liggghts") else { return };
    let end = |record: &Record| record.snapshots.last().unwrap().grains[0].position.z;
    let (found, half) = (end(&theirs) - end(&ours), 0.5 * 1e-3 * 3.0);
    assert!((found - half).abs() < 1e-6, "{found} for {half}");
}

/// A lid with a prescribed force and a tangential velocity, with and without damping.
#[test]
fn a_piston_presses_in_lammps_as_in_ours() {
    for (piston, of_grains) in [("force = 40.0, mass = 20.0", 1e-8), ("force = 40.0, mass = 20.0, damping = 2.0", 1e-4)]
    {
        let text = |lid: &str| format!("{HEAD}{FLOOR}{lid}");
        let pressed = LID.replace("motion", &format!("piston = {{ {piston} }}\nmotion"));
        let Some(records) = both(&text(&pressed), "lammps") else { return };
        let found = apart(&records, 1.0);
        assert!(found < of_grains, "{piston}: {found}");
        let [advance, far] = column_apart(&records, "lid.advance");
        assert!(advance < 1e2 * of_grains && far > 0.01, "{piston}: {advance} of {far}");
        // Control: a lid with another mass moves differently.
        let [ours, _] = both(&text(&pressed.replace("mass = 20.0", "mass = 20.2")), "lammps").unwrap();
        assert!(apart(&[ours, records[1].clone()], 1.0) > 1e-5);
    }
}
