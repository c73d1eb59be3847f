//! Benchmark of point updates per second: `cargo bench -p grainbench-mpm`.
//!
//! `points` measures the number of point updates (points times steps) per second in three cases. An elastic block of
//! 60,000 points vibrates, once with hat functions and FLIP, and once with the setting [`Mpm::BEST`]. 36 discs with
//! friction are compressed with `Mpm::BEST`. `grains` measures this number for 12, 120 and 1200 discs of equal
//! resolution, each in contact with four others. The time before the first step is not counted.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use grainbench_mpm::options::{Contact, Setting};
use grainbench_mpm::solver::Mpm;
use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::record::Cost;
use grainbench_solver::resolution::Resolution;
use std::time::Duration;

fn scene(text: &str) -> Scene {
    Scene::from_text("bench", &format!("title = 'bench'\ndimension = 2\n{text}")).expect("the scene is right")
}

/// Returns a free vibrating square of 122.5 × 122.5 cells.
fn block() -> Scene {
    scene(
        "duration = 0.15\nreference_length = 1.0\noutput.every = 1.0\n\
         materials.m = { density = 1.0, bulk_modulus = 10.0, shear_modulus = 6.0 }\n\
         [bodies.b]\nmaterial = 'm'\nbox = { low = [0.0, 0.0], high = [1.0, 1.0] }\nwave = { amplitude = 0.01 }\n\
         [probes]\nall.system = true\n",
    )
}

/// Returns slightly overlapping discs in a square lattice. The domain is periodic along both axes, so each disc is in
/// contact with four others.
fn grains([columns, rows]: [u32; 2]) -> Scene {
    let end = |count: u32| f64::from(2 * count) - 1.0;
    scene(&format!(
        "duration = 2.0\nreference_length = 1.0\noutput.every = 2.0\n\
         domain = {{ low = [-1.0, -1.0], high = [{:?}, {:?}], periodic = [true, true] }}\n\
         materials.m = {{ density = 1.0, bulk_modulus = 10.0, shear_modulus = 6.0 }}\n\
         contacts.m = {{ between = ['m', 'm'], law = 'coulomb', friction = 0.5 }}\n\
         grains.d = {{ material = 'm', radius = 1.005, \
         lattice = {{ origin = [0.0, 0.0], spacing = [2.0, 2.0], count = [{columns}, {rows}] }} }}\n",
        end(columns),
        end(rows)
    ))
}

/// Returns six by six discs in contact between four walls that move inwards.
fn discs() -> Scene {
    let wall = |name: &str, point: &str, normal: &str, velocity: &str| {
        format!(
            "[walls.{name}]\nmaterial = 'm'\nplane = {{ point = [{point}], normal = [{normal}] }}\n\
             motion = [{{ velocity = [{velocity}] }}]\n"
        )
    };
    let walls = [
        wall("west", "-1.0, 0.0", "1.0, 0.0", "0.01, 0.0"),
        wall("east", "11.0, 0.0", "-1.0, 0.0", "-0.01, 0.0"),
        wall("south", "0.0, -1.0", "0.0, 1.0", "0.0, 0.01"),
        wall("north", "0.0, 11.0", "0.0, -1.0", "0.0, -0.01"),
    ];
    scene(&format!(
        "duration = 6.0\noutput.every = 6.0\n\
         materials.m = {{ density = 1.0, bulk_modulus = 10.0, shear_modulus = 6.0 }}\n\
         contacts.m = {{ between = ['m', 'm'], law = 'coulomb', friction = 0.5 }}\n\
         grains.d = {{ material = 'm', radius = 1.0, \
         lattice = {{ origin = [0.0, 0.0], spacing = [2.0, 2.0], count = [6, 6] }} }}\n\
         {}[probes]\nall.system = true\n",
        walls.concat()
    ))
}

fn points(criterion: &mut Criterion) {
    let linear = Mpm::BEST.with(|setting| *setting = Setting::classic(Contact::Penalty));
    let cases = [
        ("block, hat functions, FLIP", linear, block(), Resolution::grid(122.5, 2)),
        ("block, best setting", Mpm::BEST, block(), Resolution::grid(122.5, 2)),
        ("36 discs with friction, best setting", Mpm::BEST, discs(), Resolution::grid(8.0, 3)),
    ];
    time(criterion, "points", &cases);
}

/// Measures the time per point and step for a growing number of grains. It is constant except for cache effects.
fn number_of_grains(criterion: &mut Criterion) {
    let at = Resolution::grid(4.0, 2);
    let cases = [("12", [3, 4]), ("120", [10, 12]), ("1200", [30, 40])]
        .map(|(name, count)| (name, Mpm::BEST, grains(count), at));
    time(criterion, "grains", &cases);
}

fn time(criterion: &mut Criterion, name: &str, cases: &[(&str, Mpm, Scene, Resolution)]) {
    let mut group = criterion.benchmark_group(name);
    group.sample_size(10).measurement_time(Duration::from_secs(20));
    for (name, solver, scene, resolution) in cases {
        let cost = || -> Cost { solver.run(scene, resolution, &mut ()).expect("the run ends well").cost };
        let counted = cost();
        println!("{name}: {} points, {} steps", counted.particle_steps / counted.steps, counted.steps);
        group.throughput(Throughput::Elements(counted.particle_steps));
        group.bench_function(*name, |bencher| {
            bencher.iter_custom(|count| (0..count).map(|_| Duration::from_secs_f64(cost().wall_seconds)).sum());
        });
    }
    group.finish();
}

criterion_group!(benches, points, number_of_grains);
criterion_main!(benches);
