//! Loops over grains, contacts, points and nodes allocate no memory. Allocations are counted for each kernel of our solvers.

use crate::common::{scene_in, temporary_with};
use allocation_counter::measure;
use grainbench::cases::solvers;
use grainbench::dem::convention::Convention;
use grainbench::dem::solver::Dem;
use grainbench::mpm::solver::Mpm;
use grainbench::scene::scene::{Duration, Sampling, Scene};
use grainbench::solver::resolution::Resolution;
use rayon::prelude::*;
use std::path::Path;

/// Number of steps before the counted steps.
const WARM: u64 = 100;
/// Number of steps in which grains come to rest.
const SETTLED: u64 = 20_000;
/// Number of repetitions for a bed of grains. The smallest count is used.
const COUNTS: u64 = 50;
const STEPS: u64 = 100;

/// Returns the allocations of 100 steps: the difference between two runs, in which the set-up cancels.
fn counted(run: impl Fn(u64)) -> i64 {
    let [few, many] = [WARM, WARM + STEPS].map(|steps| measure(|| run(steps)).count_total as i64);
    many - few
}

/// Reads a scene, and removes all output between its start and its end.
fn scene(directory: &Path, text: &str) -> Scene {
    let mut scene = scene_in(directory, text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    (scene.sampling, scene.snapshots) = (Sampling::Cycles(u64::MAX), 0);
    scene
}

/// Returns the allocations of the material point method in 100 steps.
fn of_points(solver: &str, scene: &Scene) -> i64 {
    let at = |courant| Resolution::Grid { cells: 2.0, points: 2, courant };
    let mpm = Mpm::named(solver.split('+').next().unwrap_or_default()).unwrap();
    let crossing = mpm.plan(scene, &at(0.2)).unwrap_or_else(|error| panic!("{solver}: {error}")).critical;
    // The step is a power of two, so that the duration of any number of steps gives exactly this step.
    let step = (0.2 * crossing).log2().floor().exp2();
    counted(|steps| {
        let scene = Scene { duration: Duration::Seconds(step * steps as f64), ..scene.clone() };
        let record = solvers::by_name(solver).unwrap().run(&scene, &at(step / crossing * (1.0 + 1e-9)), &mut ());
        let record = record.unwrap_or_else(|error| panic!("{solver}: {error}"));
        assert_eq!((record.cost.steps, record.provenance.time_step), (steps, step), "{solver}");
    })
}

/// Returns the allocations of grains at rest in 100 steps. Rebuilds of the neighbour list and new contacts allocate memory.
fn of_grains(convention: Convention, scene: &Scene) -> u64 {
    let mut simulation = Dem::new(convention).start(scene, 0.05 * scene.critical_time_step()).unwrap();
    simulation.advance(SETTLED).unwrap_or_else(|error| panic!("{error}"));
    let before = simulation.counts();
    // Grains that still creep cause a rebuild now and then. The smallest of several counts is therefore used.
    let found =
        (0..COUNTS).map(|_| measure(|| simulation.advance(STEPS).unwrap()).count_total).min().unwrap_or(u64::MAX);
    let contacts = (simulation.counts().contact_evaluations - before.contact_evaluations) / COUNTS;
    assert!(2 * contacts > STEPS * scene.grains.len() as u64, "{contacts} contacts in {STEPS} steps");
    found
}

/// Largest accepted number of allocations per step of the material point method. In each step, lists of nodes and contacts are
/// allocated for the threads. Their number does not depend on the number of points, which is in the hundreds.
const OF_THREADS: i64 = 4;

/// Control: a step with one allocation is counted as one allocation.
#[test]
fn a_step_that_allocates_is_counted() {
    let run = |steps: u64| (0..steps).for_each(|step| drop(std::hint::black_box(vec![step])));
    assert_eq!(counted(run), STEPS as i64);
}

const LAWS: [&str; 8] = [
    "normal_stiffness = 1e5",
    "normal_stiffness = 1e5, normal_damping = 5.0",
    "normal_stiffness = 1e5, tangential_stiffness = 3e4, friction = 0.4",
    "normal_stiffness = 1e5, tangential_stiffness = 3e4, friction = 0.4, cohesion = 0.1, restitution = 0.8",
    "normal_stiffness = 1e5, tangential_stiffness = 3e4, friction = 0.4, rolling_friction = 0.1, normal_damping = 5.0",
    "law = 'hertz'",
    "law = 'hertz', friction = 0.4, restitution = 0.8",
    "law = 'hertz', friction = 0.4, rolling_friction = 0.1",
];

/// Returns a scene of discs, or of spheres for Hertz contacts, between periodic sides. It has an uneven floor, a moving
/// wall above, and a group with prescribed motion.
fn discs(law: &str) -> String {
    let discs = include_str!("../scenes/discs-between-walls.toml").replace("normal_stiffness = 1e5", law);
    if law.contains("hertz") { discs.replace("'disc'", "'sphere'") } else { discs }
}

/// Returns a scene of spheres with each kind of wall. Some spheres are removed during the run.
fn spheres(law: &str) -> String {
    include_str!("../scenes/spheres-between-walls.toml").replace("normal_stiffness = 1e5", law)
}

/// Two triangles that rise from the floor.
const ROOF: &str = include_str!("../scenes/roof.stl");

#[test]
fn steps_of_grains_allocate_nothing() {
    let directory = temporary_with("roof.stl", ROOF);
    let scenes = LAWS.iter().flat_map(|law| [(law, discs(law)), (law, spheres(law))]);
    let runs: Vec<_> = scenes
        .flat_map(|scene| [Convention::DEFAULT, Convention::LAMMPS].map(|convention| (convention, scene.clone())))
        .collect();
    let found: Vec<String> = runs
        .par_iter()
        .filter_map(|(convention, (law, text))| {
            let found = of_grains(*convention, &scene(&directory, text));
            let name = text.lines().next().unwrap_or_default();
            (found != 0).then(|| format!("{name}, {law}, {}: {found}", convention.name))
        })
        .collect();
    assert!(found.is_empty(), "allocations in {STEPS} steps:\n{}", found.join("\n"));
}

/// Returns a scene of a body on a wall and a body above it, in two or three dimensions.
fn bodies(material: &str, dimension: usize) -> String {
    let bodies = [include_str!("../scenes/bodies-2d.toml"), include_str!("../scenes/bodies-3d.toml")];
    bodies[dimension - 2].replace("constitutive = 'hypoelastic'", material)
}

#[test]
fn steps_of_material_points_allocate_nothing_for_a_point() {
    let materials = [
        "constitutive = 'hypoelastic'",
        "constitutive = 'neo-hookean'",
        "constitutive = 'kelvin-voigt', viscosity = 10.0, bulk_viscosity = 5.0",
        "constitutive = 'von-mises', yield_stress = 1e3, hardening_modulus = 1e4",
    ];
    let transfers =
        ["mpm", "mpm+apic", "mpm+flip", "mpm+pic=0.1", "mpm+gimp+flip", "mpm+linear+apic", "mpm+usf", "mpm+usl+flip"];
    let contacts = ["mpm:2000", "mpm:2001", "mpm:gap", "mpm:penalty", "mpm:no-slip"];
    let every = materials.map(|material| (material, "mpm")).into_iter();
    let every = every.chain(transfers.iter().chain(&contacts).map(|solver| (materials[1], *solver)));
    let runs: Vec<_> =
        every.flat_map(|(material, solver)| [2, 3].map(|dimension| (material, solver, dimension))).collect();
    let found: Vec<String> = runs
        .par_iter()
        .filter_map(|&(material, solver, dimension)| {
            let scene = scene(Path::new(""), &bodies(material, dimension));
            let found = of_points(solver, &scene);
            (found > OF_THREADS * STEPS as i64)
                .then(|| format!("{solver} in {dimension} dimensions, {material}: {found}"))
        })
        .collect();
    assert!(found.is_empty(), "allocations in {STEPS} steps:\n{}", found.join("\n"));
}
