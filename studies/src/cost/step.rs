//! Cost model, which divides the cost of a time step into elementary operations.
//!
//! Grains with contact springs rest on a periodic square or cubic lattice. Three spacings are run: beyond the reach of
//! the neighbour list, within its reach, and in contact. The time of a step per grain is then `g`, `g + p·pairs` and
//! `g + p·pairs + c·contacts`, where `g`, `p` and `c` are the costs of a grain, a listed pair and a contact. The run
//! reports the numbers of pairs and contacts per grain. A block of material points is run with 4 and 16 points per
//! cell. In each run, the time of a step is `a·points + b·nodes`, with the costs `a` of a point and `b` of a node. A
//! timing is the processor time of a long run minus that of a short run.

use crate::clock::cpu_seconds;
use grainbench_harness::solvers::Solvers;
use grainbench_lanes::{Processor, Quad, probe};
use grainbench_reports::study::step::{Model, Probe, TaskCost};
use grainbench_scene::error::SceneError;
use grainbench_scene::scene::{Duration, Sampling, Scene};
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::record::Cost;
use grainbench_solver::resolution::Resolution;
use std::hint::black_box;

/// Numbers of steps of the short and the long run, first for grains, then for a block.
const STEPS: [[u64; 2]; 2] = [[20, 1620], [20, 320]];
/// Number of SIMD packs in each of the two streamed arrays. An array has 64 MB, which is more than caches hold.
const STREAMED: usize = 2 << 20;
/// Number of repetitions of multiplications and additions in a timing of arithmetic.
const COMPUTED: u64 = 2_000_000;

/// Distances of neighbouring centres in diameters: beyond the reach of the neighbour list, within it, and in contact.
///
/// The list reaches a tenth of a diameter beyond contact.
const SPACINGS: [f64; 3] = [1.3, 1.05, 0.9999];

/// Scenes that determine the unit costs of a set of operations.
struct Family {
    solver: &'static str,
    /// Operations, and descriptions of the scenes that determine them. The first operation occurs in every scene.
    pieces: Vec<(String, String)>,
    scenes: Vec<(Scene, Resolution)>,
    /// Function that returns the number of each operation per particle-step from the counts of a run.
    counts: fn(&Cost) -> Vec<f64>,
}

/// Measures unit costs of operations and the speed of the machine in a number of rounds.
///
/// # Errors
/// When a solver cannot run its scene.
pub fn measure(solvers: &dyn Solvers, rounds: u32, now: &dyn Fn(&str)) -> Result<Model, RunError> {
    let families =
        families().map_err(|error| RunError::Resolution { solver: "dem".to_owned(), reason: error.to_string() })?;
    let mut probe = Probe { streamed: Vec::new(), computed: Vec::new() };
    let mut prices: Vec<TaskCost> = Vec::new();
    for family in &families {
        prices.extend(family.pieces.iter().map(|(piece, found)| TaskCost {
            solver: family.solver.to_owned(),
            piece: piece.clone(),
            found: found.clone(),
            nanoseconds: Vec::new(),
        }));
    }
    for round in 1..=rounds {
        let mut at = 0;
        for family in &families {
            let unknown =
                || RunError::Resolution { solver: family.solver.to_owned(), reason: "no such solver".to_owned() };
            let solver = solvers.find(family.solver).ok_or_else(unknown)?;
            let mut rows = Vec::new();
            for (scene, resolution) in &family.scenes {
                now(&format!("{}, lap {round} of {rounds}", scene.title));
                rows.push(lap(&*solver, scene, resolution, family.counts)?);
            }
            for (price, value) in prices[at..].iter_mut().zip(solved(rows)) {
                price.nanoseconds.push(value);
            }
            at += family.pieces.len();
        }
        now(&format!("memory and registers, lap {round} of {rounds}"));
        probe.streamed.push(streamed());
        probe.computed.push(computed());
    }
    Ok(Model { prices, probe })
}

/// Times a scene. Returns the number of each operation per particle-step and the time of a particle-step (ns).
fn lap(
    solver: &dyn Solver,
    scene: &Scene,
    resolution: &Resolution,
    counts: fn(&Cost) -> Vec<f64>,
) -> Result<(Vec<f64>, f64), RunError> {
    let run = |steps: u64| -> Result<(Cost, f64), RunError> {
        let scene = for_steps(scene, resolution, steps);
        let begun = cpu_seconds();
        let cost = solver.run(&scene, resolution, &mut ())?.cost;
        Ok((cost, cpu_seconds() - begun))
    };
    let steps = STEPS[usize::from(matches!(resolution, Resolution::Grid { .. }))];
    let [(short, before), (long, after)] = [run(steps[0])?, run(steps[1])?];
    Ok((counts(&long), 1e9 * (after - before) / (long.particle_steps - short.particle_steps) as f64))
}

/// Returns the scene with a given number of steps. Its only output is at the start and the end.
fn for_steps(scene: &Scene, resolution: &Resolution, steps: u64) -> Scene {
    let duration = match (resolution, scene.duration) {
        // Grid methods take a duration, not a number of steps. The duration of the scene is about one step.
        (Resolution::Grid { .. }, Duration::Seconds(step)) => Duration::Seconds(step * steps as f64),
        _ => Duration::Cycles(steps),
    };
    let sampling = match duration {
        Duration::Seconds(time) => Sampling::Seconds(time),
        Duration::Cycles(steps) => Sampling::Cycles(steps),
    };
    Scene { duration, sampling, snapshots: 0, ..scene.clone() }
}

/// Solves for unit costs by elimination. There are as many rows of counts and times as operations.
///
/// Rows must be linearly independent: each has a new operation or another ratio of operations.
fn solved(mut rows: Vec<(Vec<f64>, f64)>) -> Vec<f64> {
    let count = rows.len();
    for pivot in 0..count {
        let (row, time) = rows[pivot].clone();
        for (other, (counts, spent)) in rows.iter_mut().enumerate() {
            if other != pivot {
                let times = counts[pivot] / row[pivot];
                counts.iter_mut().zip(&row).for_each(|(count, coefficient)| *count -= times * coefficient);
                *spent -= times * time;
            }
        }
    }
    rows.into_iter().enumerate().map(|(pivot, (counts, time))| time / counts[pivot]).collect()
}

/// Measures the memory bandwidth (bytes/ns).
fn streamed() -> f64 {
    let (mut to, from) = (vec![Quad([1.0; 4]); STREAMED], vec![Quad([2.0; 4]); STREAMED]);
    let begun = cpu_seconds();
    for _ in 0..4 {
        probe::stream(black_box(&mut to), black_box(&from));
    }
    4.0 * (STREAMED * probe::BYTES_OF_A_QUAD) as f64 / (1e9 * (cpu_seconds() - begun))
}

/// Measures the arithmetic rate (operations/ns).
fn computed() -> f64 {
    let begun = cpu_seconds();
    let (operations, sum) = probe::compute(Processor::new(), black_box(COMPUTED));
    black_box(sum);
    operations as f64 / (1e9 * (cpu_seconds() - begun))
}

/// Returns the scenes of grains in two and three dimensions and of a block of material points.
fn families() -> Result<Vec<Family>, SceneError> {
    const OF_GRAINS: fn(&Cost) -> Vec<f64> = |cost| {
        let each = |count: Option<u64>| count.unwrap_or(0) as f64 / cost.particle_steps as f64;
        vec![1.0, each(cost.pair_tests), each(cost.contact_evaluations)]
    };
    const OF_POINTS: fn(&Cost) -> Vec<f64> =
        |cost| vec![1.0, cost.node_updates.unwrap_or(0) as f64 / cost.particle_steps as f64];
    let grains = |dimension: usize, space: &str, grains: &str| -> Result<Family, SceneError> {
        let pieces = [
            ("grain", "out of reach of each other"),
            ("listed pair", "near each other"),
            ("contact", "that touch, with friction and a dashpot"),
        ];
        let pieces = pieces.map(|(piece, state)| (format!("{piece} in {space}"), format!("{grains} {state}")));
        let scene = |spacing: f64| Ok((lattice(dimension, spacing)?, Resolution::CriticalFraction(0.1)));
        let scenes = SPACINGS.into_iter().map(scene).collect::<Result<_, SceneError>>()?;
        Ok(Family { solver: "dem", pieces: pieces.into(), scenes, counts: OF_GRAINS })
    };
    let blocks = ["material point in the plane", "node in the plane"]
        .map(|piece| (piece.to_owned(), "a block with four points in a cell and with sixteen".to_owned()));
    Ok(vec![
        grains(2, "the plane", "discs")?,
        grains(3, "space", "spheres")?,
        Family {
            solver: "mpm",
            pieces: blocks.into(),
            scenes: vec![(block()?, Resolution::grid(60.0, 2)), (block()?, Resolution::grid(60.0, 4))],
            counts: OF_POINTS,
        },
    ])
}

/// Returns grains of diameter 1 m at rest on a lattice. The spacing is in diameters. The domain is periodic, so that
/// the grains stay at rest.
fn lattice(dimension: usize, spacing: f64) -> Result<Scene, SceneError> {
    let count = if dimension == 2 { 100 } else { 25 };
    let all = |value: String| vec![value; dimension].join(", ");
    scene(
        &format!("lattice of {dimension} dimensions, {spacing} diameters apart"),
        &format!(
            "dimension = {dimension}\nduration = 1.0\nmaterials.m.density = 1.0\n\
             contacts.m = {{ between = ['m', 'm'], normal_stiffness = 1.0e5, tangential_stiffness = 5.0e4, friction = 0.5, \
             normal_damping = 1.0 }}\n\
             domain = {{ low = [{}], high = [{}], periodic = [{}] }}\n\
             [grains.g]\nmaterial = 'm'\nradius = 0.5\n\
             lattice = {{ origin = [{}], spacing = [{}], count = [{}] }}\n",
            all("0.0".to_owned()),
            all(format!("{:?}", f64::from(count) * spacing)),
            all("true".to_owned()),
            all("0.5".to_owned()),
            all(format!("{spacing:?}")),
            all(count.to_string()),
        ),
    )
}

/// Returns a scene of one step with a vibrating square block.
fn block() -> Result<Scene, SceneError> {
    // The wave speed is 11.6 m/s. In one step a wave crosses 0.35 of a cell of 1/60 m.
    scene(
        "block",
        "dimension = 2\nduration = 5.0e-4\nreference_length = 1.0\n\
         materials.m = { density = 1.0, young_modulus = 100.0, poisson_ratio = 0.3 }\n\
         [bodies.b]\nmaterial = 'm'\nbox = { low = [0.0, 0.0], high = [1.0, 1.0] }\nwave = { amplitude = 0.1 }\n",
    )
}

fn scene(title: &str, text: &str) -> Result<Scene, SceneError> {
    let text = format!("title = '{title}'\n{text}[output]\nevery = 1.0\n");
    Scene::from_text(title, &text)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grain costs 20 ns, a pair 3 ns and a contact 15 ns.
    #[test]
    fn prices_are_found_from_times_and_counts() {
        let row = |counts: [f64; 3]| (counts.to_vec(), 20.0 * counts[0] + 3.0 * counts[1] + 15.0 * counts[2]);
        let found = solved(vec![row([1.0, 0.0, 0.0]), row([1.0, 2.0, 0.0]), row([1.0, 3.0, 1.9])]);
        for (found, expected) in found.into_iter().zip([20.0, 3.0, 15.0]) {
            assert!((found - expected).abs() < 1e-12 * expected, "{found} for {expected}");
        }
    }

    /// The three lattices have no pairs, pairs without contacts, and pairs with contacts.
    #[test]
    fn lattices_have_what_is_counted() {
        use grainbench_dem::{convention::Convention, solver::Dem};
        for dimension in [2, 3] {
            let counted = SPACINGS.map(|spacing| {
                let mut simulation =
                    Dem::new(Convention::DEFAULT).start(&lattice(dimension, spacing).unwrap(), 1e-5).unwrap();
                simulation.advance(3).unwrap();
                let counts = simulation.counts();
                [counts.pair_tests > 0, counts.contact_evaluations > 0]
            });
            assert_eq!(counted, [[false, false], [true, false], [true, true]]);
        }
    }
}
