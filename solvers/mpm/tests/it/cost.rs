//! Tests of the cost of runs, with counts that do not depend on the machine.

use crate::support::run;
use grainbench_solver::record::Cost;

const MATERIAL: &str = "materials.m = { density = 1.0, bulk_modulus = 10.0, shear_modulus = 6.0 }\n\
    contacts.m = { between = ['m', 'm'], law = 'coulomb', friction = 0.5 }\n";

/// Returns the cost of slightly overlapping discs in a square lattice. Each has four contacts, except at the rim.
fn discs(count: [u32; 2]) -> Cost {
    let text = format!(
        "dimension = 2\nduration = 0.2\n{MATERIAL}\
         grains.d = {{ material = 'm', radius = 1.0, \
         lattice = {{ origin = [0.0, 0.0], spacing = [1.99, 1.99], count = [{}, {}] }} }}\n",
        count[0], count[1]
    );
    run("mpm", &text, 3.0, 2).cost
}

/// From ten to a thousand grains, with constant points per grain, the cost grows with exponents near one.
#[test]
fn cost_grows_with_the_number_of_grains_and_no_faster() {
    let [few, many] = [discs([2, 5]), discs([25, 40])];
    assert_eq!(few.steps, many.steps);
    assert_eq!(100 * few.particle_steps, many.particle_steps);
    let exponent = |count: fn(&Cost) -> u64| (count(&many) as f64 / count(&few) as f64).log10() / 2.0;
    // Ten discs have 13 contacts and a thousand have 1935. Counts by contact therefore grow by 148.8 = 100^1.086.
    let contacts = (1935.0_f64 / 13.0).log10() / 2.0;
    let nodes = exponent(|cost| cost.node_updates.unwrap());
    let memory = exponent(|cost| cost.bytes.unwrap());
    let springs = exponent(|cost| cost.contact_evaluations.unwrap()) / contacts;
    let pairs = exponent(|cost| cost.pair_tests.unwrap()) / contacts;
    for (what, exponent) in [("nodes", nodes), ("memory", memory), ("springs", springs), ("pairs", pairs)] {
        assert!((0.95..=1.05).contains(&exponent), "{what}: {exponent}");
    }
}

/// A single body has no surface, no pairs and no springs. The run evaluates no contact and takes as much memory as a
/// run with one velocity field for all bodies.
#[test]
fn a_body_by_itself_pays_nothing_for_contact() {
    let text = format!(
        "dimension = 2\nduration = 0.5\n{MATERIAL}[grains.g]\nmaterial = 'm'\nradius = 1.0\nposition = [0.0, 0.0]\nspin = 0.1\n"
    );
    let costs = ["mpm:penalty", "mpm:gap", "mpm:2000", "mpm:2001", "mpm:no-slip"].map(|solver| {
        let cost = run(solver, &text, 8.0, 2).cost;
        assert_eq!((cost.contact_evaluations, cost.pair_tests), (Some(0), Some(0)), "{solver}");
        (cost.bytes, cost.node_updates)
    });
    assert!(costs.iter().all(|cost| *cost == costs[0]), "{costs:?}");
    // With a wall that is never in contact, the only cost is the surface.
    let wall = "[walls.w]\nmaterial = 'm'\nplane = { point = [0.0, -9.0], normal = [0.0, 1.0] }\n";
    let with_wall = run("mpm:penalty", &(text + wall), 8.0, 2).cost;
    assert!(with_wall.bytes > costs[0].0 && with_wall.contact_evaluations == Some(0), "{with_wall:?}");
}

/// A box of 2 m × 1 m with four cells per metre and two points per cell and axis has 16 · 8 points. Each point counts
/// once per step.
#[test]
fn points_are_counted_once_a_step() {
    let text = format!(
        "dimension = 2\nduration = 0.5\nreference_length = 1.0\n{MATERIAL}\
         bodies.b = {{ material = 'm', box = {{ low = [0.0, 0.0], high = [2.0, 1.0] }} }}\n"
    );
    let cost = run("mpm", &text, 4.0, 2).cost;
    assert!(cost.steps > 0 && cost.particle_steps == cost.steps * 128, "{cost:?}");
}
