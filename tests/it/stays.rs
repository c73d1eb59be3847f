//! Insertion and removal of grains, and removal of walls.

use crate::common::{Directory, scene, scene_in, temporary_with};
use grainbench::cases::solvers;
use grainbench::solver::observer::RunOptions;
use grainbench::solver::record::{Record, Snapshot};
use grainbench::solver::resolution::Resolution;

/// Common part of the scenes: spheres of mass 1 kg.
const HEAD: &str = include_str!("../scenes/passing-freely.toml");

/// Scene of a silo that is filled and drained.
const SILO: &str = include_str!("../scenes/silo.toml");
/// Grains on a floor. The left ones are lifted with a prescribed velocity for some time.
const LIFTED: &str = include_str!("../scenes/lifted.toml");

const FLOOR: &str = "walls.floor = { material = 'm', plane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] } }\n";

fn run(text: &str, threads: usize) -> Record {
    let solver = solvers::by_name("dem").unwrap();
    solver
        .run(&scene(text), &Resolution::TimeStep(1e-3), &mut RunOptions { threads, ..RunOptions::DEFAULT })
        .unwrap_or_else(|error| panic!("{error}"))
}

fn end(record: &Record) -> &Snapshot {
    record.snapshots.last().unwrap()
}

/// Three grains without contacts. Each falls freely from its insertion on, z₀ + vτ − gτ²/2, and is absent before.
#[test]
fn a_grain_that_is_poured_falls_from_when_it_comes() {
    let feed = "[grains.feed]\nmaterial = 'm'\nradius = 0.5\nvelocity = [0.5, 0.0, -3.0]\n\
        poured = { count = 3, rate = 2.0, seed = 4, low = [-2.0, 0.0, 40.0], high = [0.0, 4.0, 40.0], start = 0.25 }\n";
    // While no grain exists, the coordination number is zero.
    let text = format!("{HEAD}probes.stress = {{ stress = true }}\n{feed}");
    let record = run(&text, 1);
    assert!(record.series.column("stress.coordination").unwrap().iter().all(|&number| number == 0.0));
    let scene = scene(&text);
    for snapshot in &record.snapshots {
        let there: Vec<u32> = snapshot.grains.iter().map(|grain| grain.id).collect();
        let come: Vec<u32> = (1..=3).filter(|&id| 0.25 + 0.5 * f64::from(id - 1) <= snapshot.time + 1e-9).collect();
        assert_eq!(there, come, "at {}", snapshot.time);
        for grain in &snapshot.grains {
            let start = scene.grains[grain.id as usize - 1];
            let fallen = snapshot.time - (0.25 + 0.5 * f64::from(grain.id - 1));
            let exact = start.position + start.velocity * fallen + scene.gravity * (0.5 * fallen * fallen);
            assert!((grain.position - exact).norm() < 1e-12, "{} for {exact}", grain.position);
            assert!((grain.velocity - (start.velocity + scene.gravity * fallen)).norm() < 1e-12);
        }
    }
    let column = |name: &str| record.series.column(name).unwrap().last().copied();
    assert_eq!(["present", "entered", "left"].map(|of| column(&format!("grains.{of}"))), [3.0, 3.0, 0.0].map(Some));
}

/// A grain is inserted at the position and velocity of another grain in flight. Both hit a grain on the floor in the same way.
#[test]
fn a_grain_that_comes_is_one_that_came_from_farther_up() {
    let target = "[grains.target]\nmaterial = 'm'\nradius = 0.5\nposition = [0.0, 2.0, 0.49995]\n";
    // From z = 10 at −3 m/s, the grain reaches z = 10 − 3 − ½ with −4 m/s after one second.
    let ball =
        "[grains.ball]\nmaterial = 'm'\nradius = 0.5\nvelocity = [0.0, 0.0, -3.0]\nposition = [-0.2, 2.1, 10.0]\n";
    let poured = "[grains.ball]\nmaterial = 'm'\nradius = 0.5\nvelocity = [0.0, 0.0, -4.0]\n\
        poured = { count = 1, rate = 1.0, seed = 1, low = [-0.2, 2.1, 6.5], high = [-0.2, 2.1, 6.5], start = 1.0 }\n";
    let head = HEAD.replace("duration = 2.0", "duration = 2.5");
    let [flown, poured] = [ball, poured].map(|ball| run(&format!("{head}{FLOOR}{target}{ball}"), 1));
    assert_eq!([poured.snapshots[0].grains.len(), end(&poured).grains.len()], [1, 2]);
    for (a, b) in end(&flown).grains.iter().zip(&end(&poured).grains) {
        assert!((a.position - b.position).norm() < 1e-8, "{}: {} {}", a.id, a.position, b.position);
        assert!(a.velocity.norm() > 0.1, "it was struck");
    }
}

/// A grain beside a sliding bed is removed. The contacts of the bed have tangential springs. The removal changes the
/// bed only by the order of sums. In one second, rounding errors grow to less than 1e-8 in the moving bed; in the next
/// second they grow to 1e-6.
#[test]
fn a_grain_that_is_taken_out_leaves_all_others_as_they_are() {
    let bed = "[grains.bed]\nmaterial = 'm'\nradius = 0.5\n\
        lattice = { origin = [-1.4, 0.5, 0.499], spacing = [1.01, 0.999, 0.99], count = [3, 4, 3] }\n";
    let thrown =
        "[grains.a-thrown]\nmaterial = 'm'\nradius = 0.5\nposition = [-2.5, 0.1, 0.6]\nvelocity = [-4.0, 0.0, 2.0]\n";
    let removal = "removal = { low = [-4.0, -1.0, -1.0], high = [4.0, 5.0, 50.0], every_cycles = 50 }\n";
    let head = HEAD.replace("gravity = [0.0, 0.0, -1.0]", "gravity = [0.0, 0.2, -1.0]");
    let head = head.replace("duration = 2.0", "duration = 1.0");
    let alone = run(&format!("{head}{FLOOR}{bed}"), 1);
    let record = run(&format!("{head}{removal}{FLOOR}{bed}{thrown}"), 1);
    assert_eq!((record.snapshots[0].grains.len(), end(&record).grains.len()), (37, 36));
    // The grain leaves the box at (4 − 2.5)/4 s. Removal is checked at every fiftieth step.
    let left = record.series.column("grains.left").unwrap();
    let when = left.iter().position(|&left| left == 1.0).map(|at| record.series.time[at]);
    assert_eq!(when, Some(0.4));
    for (a, b) in end(&alone).grains.iter().zip(&end(&record).grains) {
        let off = (a.position - b.position).norm().max((a.velocity - b.velocity).norm()).max((a.spin - b.spin).norm());
        assert!(a.id == b.id && off < 1e-8, "{}: off by {off}", a.id);
    }
}

/// After its wall is removed, a grain falls by ½g(t − t₀)², apart from the effect of the last spring force.
#[test]
fn what_stood_on_a_wall_falls_when_it_is_taken_away() {
    let floor = FLOOR.replace("material = 'm',", "material = 'm', until = 1.2,");
    let ball = "[grains.ball]\nmaterial = 'm'\nradius = 0.5\nposition = [0.0, 2.0, 0.49995]\n";
    let record = run(&format!("{HEAD}{floor}{ball}"), 1);
    let z = |at: usize| record.snapshots[at].grains[0].position.z;
    assert!((z(2) - 0.49995).abs() < 1e-12, "at rest on mg/k until then: {}", z(2));
    let fallen = end(&record).time - 1.2;
    // The last spring force belongs to the previous step and acts for half a step.
    assert!((end(&record).grains[0].position.z - (0.49995 - 0.5 * fallen * fallen)).abs() < 1e-3);
    assert!(record.snapshots[0].walls[0].corners.len() == 2 && end(&record).walls[0].corners.is_empty());
    let stays = run(&format!("{HEAD}{FLOOR}{ball}"), 1);
    assert!((end(&stays).grains[0].position.z - 0.49995).abs() < 1e-12);
}

/// Neither the number of threads nor checkpoints change any bit.
#[test]
fn threads_and_checkpoints_leave_no_trace() {
    let path = temporary_with("silo.toml", SILO);
    let with =
        |further: &str| path.ok(format!("simulate silo.toml --solver dem --time-step 1e-3 --write dump {further}"));
    with("--out one --threads 1");
    with("--out two --threads 2 --checkpoint half --checkpoint-every 2400");
    with("--out three --threads 1 --restart half");
    let same = |file: &str| {
        let file_bytes = |folder: &str| std::fs::read(path.join(folder).join(file)).unwrap();
        assert!(file_bytes("one") == file_bytes("two"), "{file}, threads");
        assert!(file_bytes("one") == file_bytes("three"), "{file}, restarted");
    };
    ["series.csv", "snapshots.dump"].into_iter().for_each(same);
    let record = run(SILO, 1);
    let last = |name: &str| record.series.column(name).unwrap().last().copied().unwrap();
    assert!(last("grains.left") > 20.0 && last("grains.present") + last("grains.left") == 90.0);
}

/// Neither threads nor checkpoints change any bit, also if the checkpoint is taken during prescribed motion. Only `dem`
/// supports prescribed motion for a limited time.
#[test]
fn grains_that_are_driven_for_a_while_are_so_after_a_checkpoint_too() {
    let path = temporary_with("scene.toml", LIFTED);
    let with =
        |further: &str| path.ok(format!("simulate scene.toml --solver dem --time-step 1e-3 --write dump {further}"));
    let of_whole = |file: &str| path.join("whole").read(file);
    with("--out whole --threads 2");
    // Checkpoints before, at the start of, during, at the end of, and after the prescribed motion.
    for every in ["200", "300", "400", "600", "700", "900"] {
        with(&format!("--out one --checkpoint half --checkpoint-every {every}"));
        with("--out two --restart half");
        for file in ["series.csv", "snapshots.dump"] {
            let same = ["one", "two"].map(|folder| path.join(folder).read(file) == of_whole(file));
            assert_eq!(same, [true, true], "{file}, {every}");
        }
    }
    with("--out always --set driven.lifted.start=0.0 --set driven.lifted.stop=1.0");
    assert!(path.read("always/series.csv") != of_whole("series.csv"));
}

/// Two groups are inserted in one box, a heap grows into the box, or a wall crosses the box. Each run ends with an
/// error that names both grains or the wall, and never with an overlap.
#[test]
fn nothing_is_poured_into_what_stands_there() {
    let feed = |name: &str, seed: u32, count: u32, z: f64| {
        format!(
            "[grains.{name}]\nmaterial = 'm'\nradius = 0.5\nvelocity = [0.0, 0.0, -3.0]\n\
             [grains.{name}.poured]\nstart = 0.1\ncount = {count}\nrate = 2.5\nseed = {seed}\n\
             low = [0.0, 2.0, {z}]\nhigh = [0.2, 2.2, {z}]\n"
        )
    };
    let broken = |text: &str| {
        let solver = solvers::by_name("dem").unwrap();
        solver.run(&scene(text), &Resolution::TimeStep(1e-3), &mut ()).unwrap_err().to_string()
    };
    let two = broken(&format!("{HEAD}{}{}", feed("a", 1, 2, 9.0), feed("b", 2, 2, 9.0)));
    assert!(two.contains("it was poured into grain") && two.contains("of the smaller radius"), "{two}");
    let heap = broken(&format!("{HEAD}{FLOOR}{}", feed("a", 1, 10, 1.0)));
    assert!(heap.contains("it was poured into grain") && heap.contains("pour fewer grains"), "{heap}");
    let wall = broken(&format!("{HEAD}{FLOOR}{}", feed("a", 1, 1, 0.3)));
    assert!(wall.contains("it was poured into wall 1 of the scene, which it overlaps by 0.400"), "{wall}");
    // A grain that is inserted at time zero exists from the start and is checked at the start.
    let text = format!("{HEAD}{FLOOR}{}", feed("a", 1, 1, 0.3).replace("start = 0.1\n", ""));
    let first = scene_in("".as_ref(), &text).unwrap_err();
    assert!(first.contains("grain 1 and wall floor overlapping by 0.4000 of the radius"), "{first}");
}
