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
    format!(
        "title = 'discs'\ndimension = 2\nduration = 1.0\ngravity = [0.0, -10.0]\nglobal_damping = 20.0\n\
         domain = {{ low = [0.0, -1.0], high = [4.0, 9.0], periodic = [true, false] }}\n\
         grain_shape = '{}'\nmaterials.m = {{ density = 1000.0, young_modulus = 1e7, poisson_ratio = 0.3 }}\n\
         contacts.all = {{ between = ['m', 'm'], {law} }}\n\
         [grains.g]\nmaterial = 'm'\nradius = 0.15\n\
         lattice = {{ origin = [0.2, 0.16], spacing = [0.33, 0.31], count = [12, 6] }}\n\
         [grains.d]\nmaterial = 'm'\nradius = 0.15\nposition = [2.0, 2.1]\n[driven.d]\ngrains = 'd'\n\
         [walls.floor]\nmaterial = 'm'\nplane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}\n\
         [walls.step]\nmaterial = 'm'\nsegment = [[1.0, -0.1], [1.3, 0.02]]\n\
         [walls.lid]\nmaterial = 'm'\nplane = {{ point = [0.0, 3.0], normal = [0.0, -1.0] }}\n\
         motion = [{{ velocity = [1e-6, 0.0] }}, {{ sine = {{ amplitude = [0.0, 1e-6], frequency = 5.0 }} }}]\n",
        if law.contains("hertz") { "sphere" } else { "disc" }
    )
}

/// Returns a scene of spheres with each kind of wall. Some spheres are removed during the run.
fn spheres(law: &str) -> String {
    format!(
        "title = 'spheres'\ndimension = 3\nduration = 1.0\ngravity = [0.0, 0.0, -10.0]\nglobal_damping = 20.0\n\
         domain = {{ low = [-2.0, -2.0, -9.0], high = [2.0, 2.0, 9.0], periodic = [true, false, false] }}\n\
         removal = {{ low = [-3.0, -3.0, -0.5], high = [3.0, 3.0, 9.0], every_cycles = 50 }}\n\
         materials.m = {{ density = 1000.0, young_modulus = 1e7, poisson_ratio = 0.3 }}\n\
         contacts.all = {{ between = ['m', 'm'], {law} }}\n\
         [grains.g]\nmaterial = 'm'\nradius = 0.2\n\
         lattice = {{ origin = [-1.5, -0.85, 0.45], spacing = [0.41, 0.42, 0.43], count = [8, 5, 3] }}\n\
         [walls.floor]\nmaterial = 'm'\n\
         rectangle = {{ corner = [-3.0, -1.5, 0.0], edges = [[6.0, 0.0, 0.0], [0.0, 4.0, 0.0]] }}\n\
         [walls.side]\nmaterial = 'm'\nplane = {{ point = [0.0, -1.6, 0.0], normal = [0.0, 1.0, 0.0] }}\n\
         motion = [{{ velocity = [1e-6, 0.0, 0.0] }}]\n\
         [walls.trough]\nmaterial = 'm'\ncylinder = {{ axis = [[-9.0, 0.0, 1.0], [9.0, 0.0, 1.0]], radius = 1.6 }}\n\
         [walls.cone]\nmaterial = 'm'\ncone = {{ axis = [[0.0, 0.0, -2.0], [0.0, 0.0, 3.0]], radii = [1.9, 2.8] }}\n\
         [walls.mesh]\nmaterial = 'm'\nmesh = {{ file = 'roof.stl', unit = 'm', open = true }}\n\
         motion = [{{ spin = [0.0, 0.0, 1e-6], centre = [0.0, 0.0, 0.0] }}]\n\
         [walls.lid]\nmaterial = 'm'\nplane = {{ point = [0.0, 0.0, 1.7], normal = [0.0, 0.0, -1.0] }}\n\
         piston = {{ force = 30.0, mass = 50.0, damping = 5.0 }}\n"
    )
}

/// Two triangles that rise from the floor.
const ROOF: &str = "solid roof\n\
    facet normal 0 0 0\nouter loop\nvertex -0.5 -1.0 -0.1\nvertex 0.0 -1.0 0.15\nvertex 0.0 1.0 0.15\nendloop\nendfacet\n\
    facet normal 0 0 0\nouter loop\nvertex -0.5 -1.0 -0.1\nvertex 0.0 1.0 0.15\nvertex -0.5 1.0 -0.1\nendloop\nendfacet\n\
    endsolid roof\n";

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
    let (place, up, low, high) = match dimension {
        2 => ("[0.5, 0.99]", "[0.0, 1.0]", "[0.0, 0.0]", "[1.0, 0.5]"),
        _ => ("[0.5, 0.5, 0.99]", "[0.0, 0.0, 1.0]", "[0.0, 0.0, 0.0]", "[1.0, 1.0, 0.5]"),
    };
    let at = |last: &str| if dimension == 2 { format!("[0.0, {last}]") } else { format!("[0.0, 0.0, {last}]") };
    format!(
        "title = 'bodies'\ndimension = {dimension}\nduration = 1.0\nreference_length = 0.5\ngravity = {}\n\
         largest_initial_overlap = 0.5\n\
         materials.m = {{ density = 1000.0, young_modulus = 1e6, poisson_ratio = 0.3, {material} }}\n\
         contacts.all = {{ between = ['m', 'm'], law = 'coulomb', friction = 0.3 }}\n\
         [grains.g]\nmaterial = 'm'\nradius = 0.5\nposition = {place}\nvelocity = {}\n\
         [bodies.b]\nmaterial = 'm'\nbox = {{ low = {low}, high = {high} }}\n\
         [walls.floor]\nmaterial = 'm'\nplane = {{ point = {}, normal = {up} }}\n",
        at("-1.0"),
        at("-0.2"),
        at("0.0")
    )
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
