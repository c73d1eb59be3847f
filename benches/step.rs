//! Time of a DEM step and of the contact kernel: `cargo bench`.
//!
//! `particle-steps` runs 10,000 sheared discs in the convention of LAMMPS, with 4.7 contacts per disc. It runs them with
//! friction, without friction, and with friction compiled in but μ = 0. `contact` runs one pair in permanent contact.
//! `lattice` runs square lattices of increasing size. Their time per grain and step must be constant.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use grainbench::cases::registry;
use grainbench::dem::convention::Convention;
use grainbench::dem::solver::Dem;
use grainbench::scene::contact_law::ContactLaw;
use grainbench::scene::scene::Scene;
use grainbench::solver::drive::Stepper;
use std::hint::black_box;

fn start(scene: &Scene, convention: Convention, time_step: f64) -> Box<dyn Stepper> {
    Dem::new(convention).start(scene, time_step).expect("the scene runs")
}

fn plane_shear() -> Scene {
    let case = registry::by_name("plane-shear").expect("a case of the registry");
    case.variant("plain").expect("the scene is right")
}

/// Returns a square lattice of discs in contact with friction, `count` along each side.
fn lattice(count: u32) -> Scene {
    let text = format!(
        r#"
title = "lattice"
dimension = 2
duration = 1.0
materials.disc.density = 0.3183098861837907
contacts.all = {{ between = ["disc", "disc"], normal_stiffness = 1.0, tangential_stiffness = 1.0, friction = 0.5 }}
[grains.disc]
material = "disc"
radius = 1.0
lattice = {{ origin = [0.0, 0.0], spacing = [1.999, 1.999], count = [{count}, {count}] }}
"#
    );
    Scene::from_text("lattice", &text).expect("the scene is right")
}

/// Adds a material with friction that no grain has. The kernel then computes friction, but friction has no effect.
fn with_idle_friction(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let law = scene.laws[0].expect("a scene of one material");
    scene.materials.push("idle".to_owned());
    scene.laws = vec![Some(law), None, None, Some(ContactLaw { friction: 0.5, ..law })];
    scene
}

fn particle_steps(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("particle-steps");
    group.sample_size(20);
    let with_friction = plane_shear();
    let mut without = with_friction.clone();
    without.change_laws(|law| law.friction = 0.0);
    group.throughput(Throughput::Elements(100 * with_friction.grains.len() as u64));
    let idle = with_idle_friction(&without);
    for (name, scene) in [("friction", &with_friction), ("frictionless", &without), ("friction at μ = 0", &idle)] {
        let mut simulation = start(scene, Convention::LAMMPS, 1e-4);
        group.bench_function(name, |bencher| bencher.iter(|| simulation.advance(black_box(100))));
    }
    group.finish();
}

fn contact(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("contact");
    let case = registry::by_name("collision").expect("a case of the registry");
    let mut scene = case.variant("oblique").expect("the scene is right");
    // The grains are in contact from the start and hardly move, so the contact persists.
    scene.grains[1].position = scene.grains[0].position + nalgebra::Vector3::new(2.199, 0.0, 0.0);
    scene.grains.iter_mut().for_each(|grain| (grain.velocity, grain.spin) = (grain.velocity * 0.0, grain.spin * 1e-9));
    group.throughput(Throughput::Elements(1000));
    for convention in Convention::ALL {
        let mut simulation = start(&scene, convention, 1e-6);
        group.bench_function(convention.name, |bencher| bencher.iter(|| simulation.advance(black_box(1000))));
    }
    group.finish();
}

fn scaling(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("lattice");
    group.sample_size(20);
    for count in [10_u32, 32, 100, 316] {
        let scene = lattice(count);
        let mut simulation = start(&scene, Convention::DEFAULT, 0.1);
        group.throughput(Throughput::Elements(10 * scene.grains.len() as u64));
        group.bench_with_input(BenchmarkId::from_parameter(count * count), &count, |bencher, _| {
            bencher.iter(|| simulation.advance(black_box(10)));
        });
    }
    group.finish();
}

criterion_group!(benches, particle_steps, contact, scaling);
criterion_main!(benches);
