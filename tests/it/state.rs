//! Scenes whose initial state is the final state of another run.

use crate::common::{Directory, temporary};
use std::path::Path;

/// Returns a scene of spheres with friction that fall into a box and come to rest.
fn scene(duration: f64, grains: &str) -> String {
    let heap = include_str!("../scenes/heap.toml").replace("duration = 1.0", &format!("duration = {duration:?}"));
    heap.replace("[grains.g]\nmaterial = 'm'\nstate = { path = 'heap.state' }", grains)
}

const DROPPED: &str = "[grains.g]\nmaterial = 'm'\nradius = 0.5\n\
    lattice = { origin = [0.55, 0.6, 0.6], spacing = [1.12, 1.16, 1.2], count = [4, 4, 5] }";

fn simulate(path: &Path, name: &str, text: &str, further: &str) {
    path.write(format!("{name}.toml"), text);
    path.ok(format!("simulate {name}.toml --solver dem --time-step 1e-3 --write dump --out {name} {further}"));
}

/// Returns the positions of all grains at the end and at the start of a run (m).
fn ends(path: &Path, name: &str) -> [Vec<[f64; 3]>; 2] {
    let dump = path.join(name).read("snapshots.dump");
    let snapshots: Vec<&str> = dump.split("ITEM: ATOMS").skip(1).collect();
    let positions = |snapshot: &str| {
        let heads: Vec<&str> = snapshot.lines().next().unwrap().split_whitespace().collect();
        let at = ["x", "y", "z"].map(|axis| heads.iter().position(|head| *head == axis).unwrap());
        let rows = snapshot.lines().skip(1).take_while(|line| !line.starts_with("ITEM"));
        rows.map(|row| {
            let numbers: Vec<&str> = row.split_whitespace().collect();
            at.map(|column| numbers[column].parse().unwrap())
        })
        .collect()
    };
    [positions(snapshots[snapshots.len() - 1]), positions(snapshots[0])]
}

fn apart(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    assert_eq!(a.len(), b.len());
    let between = a.iter().zip(b).flat_map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).abs()));
    between.fold(0.0, f64::max)
}

/// A heap at rest stays at rest if its state includes the contact springs. Without the springs it moves.
#[test]
fn a_heap_that_is_taken_over_with_its_springs_goes_on() {
    let path = temporary();
    simulate(&path, "first", &scene(12.0, DROPPED), "--state heap.state");
    let taken =
        |further: &str| scene(2.0, &format!("[grains.g]\nmaterial = 'm'\nstate = {{ path = 'heap.state'{further} }}"));
    simulate(&path, "whole", &scene(14.0, DROPPED), "");
    simulate(&path, "with", &taken(""), "--state again.state");
    simulate(&path, "without", &taken(", springs = false"), "");
    let [end, _] = ends(&path, "first");
    let [later, start] = ends(&path, "with");
    assert!(apart(&end, &start) == 0.0, "it begins where the other ended");
    let [uninterrupted, _] = ends(&path, "whole");
    assert!(apart(&uninterrupted, &later) < 1e-10, "{}", apart(&uninterrupted, &later));
    // With a rounded state it also stays at rest, up to the effect of rounding.
    simulate(&path, "rounding", &scene(12.0, DROPPED), "--state rounded.state --rounded");
    let sizes = ["heap.state", "rounded.state"].map(|file| std::fs::metadata(path.join(file)).unwrap().len());
    assert!(sizes[1] < sizes[0], "{sizes:?}");
    simulate(&path, "rounded", &taken("").replace("heap.state", "rounded.state"), "");
    let [later, _] = ends(&path, "rounded");
    let moved = apart(&uninterrupted, &later);
    assert!(0.0 < moved && moved < 1e-8, "{moved}");
    // Another grain, which is listed first and is held far above, does not change the assignment of springs to grains.
    let held = "[driven.a]\ngrains = 'a'\n[grains.a]\nmaterial = 'm'\nradius = 0.5\nposition = [2.5, 2.5, 9.5]\n";
    let behind = taken("").replace("[grains.g]", &format!("{held}[grains.g]"));
    simulate(&path, "behind", &behind, "");
    let [later, _] = ends(&path, "behind");
    assert!(apart(&uninterrupted, &later[1..]) < 1e-10, "{}", apart(&uninterrupted, &later[1..]));
    let [later, _] = ends(&path, "without");
    assert!(apart(&uninterrupted, &later) > 1e-5, "{}", apart(&uninterrupted, &later));
    // At rest, the final state equals the initial state, up to residual motion.
    let [first, again] = ["heap.state", "again.state"].map(|file| {
        let bytes = std::fs::read(path.join(file)).unwrap();
        grainbench::scene::end_state::EndState::from_bytes(&bytes).unwrap()
    });
    assert!(first.springs.pairs.len() > 100 && first.springs.walls.len() > 10);
    // Springs are in the order of the grains, independent of the neighbour lists.
    assert!(first.springs.pairs.is_sorted_by_key(|pair| (pair.0, pair.1)));
    assert_eq!(first.springs.pairs.len(), again.springs.pairs.len());
}

/// A flying, spinning grain continues with exactly its spin, and with the velocity v + g t. With friction, a solver
/// integrates spins during the run; without friction, spins are known from the start.
#[test]
fn a_grain_that_spins_is_taken_over_with_its_spin() {
    let path = temporary();
    let thrown = "[grains.g]\nmaterial = 'm'\nradius = 0.5\nposition = [2.5, 2.5, 5.0]\n\
        velocity = [0.3, -0.2, 1.0]\nspin = [1.0, -2.0, 0.5]";
    let taken = "[grains.g]\nmaterial = 'm'\nstate = { path = 'first.state' }";
    for friction in ["friction = 0.4", "friction = 0.0"] {
        for (name, time, grains) in [("first", 0.1, thrown), ("then", 0.2, taken)] {
            let state = format!("{name}.state");
            simulate(&path, name, &scene(0.1, grains).replace("friction = 0.4", friction), &format!("--state {state}"));
            let bytes = std::fs::read(path.join(state)).unwrap();
            let grain = grainbench::scene::end_state::EndState::from_bytes(&bytes).unwrap().grains[0];
            assert_eq!(grain.spin.as_slice(), [1.0, -2.0, 0.5], "{friction}, {name}");
            let exact = [0.3, time - 0.2, 1.0 - 10.0 * time];
            let off = grain.velocity.iter().zip(exact).map(|(found, exact)| (found - exact).abs()).fold(0.0, f64::max);
            assert!(off < 1e-12, "{friction}, {name}: off by {off} m/s");
        }
    }
}
