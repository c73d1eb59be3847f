//! An absent effect costs almost nothing, because it is not part of the selected kernel. Valgrind, if installed, counts
//! the instructions of the kernel for undamped, frictionless discs. They are compared with those of a hand-written loop
//! without any other effect. Counts do not depend on the load of the machine; no test measures time. Simulating an effect
//! with neutral values does not change the result.

#[path = "../../benches/minimal/mod.rs"]
mod minimal;

use crate::common::{scene, simulated};
use grainbench::cases::registry;
use grainbench::dem::convention::Convention;
use grainbench::dem::solver::Dem;
use grainbench::scene::contact_law::{ContactLaw, Springs};
use grainbench::scene::effect::Effect;
use grainbench::scene::effects::Effects;
use grainbench::scene::scene::{Duration, Scene};
use grainbench::solver::resolution::Resolution;
use minimal::Minimal;
use std::process::Command;

/// Environment variable that tells the process under valgrind which loop to run and for how many steps.
const TASK: &str = "GRAINBENCH_COUNTED_LOOP";
/// Number of discs along each side of the lattice, as in its scene.
const SIDE: u32 = 24;
const STEP: f64 = 0.05;
/// Largest accepted ratio of the kernel's instructions to those of the hand-written loop.
const ALLOWED: f64 = 1.02;
/// Smallest accepted ratio of instructions in dense shear: friction without effect, divided by no friction.
const FRICTION: f64 = 1.3;

/// Returns a square lattice of overlapping discs. It expands at its rim without rebuilding the neighbour list.
fn lattice() -> Scene {
    scene(include_str!("../scenes/lattice.toml"))
}

/// Returns dense shear of 10,000 discs without friction.
fn dense_shear() -> Scene {
    let mut scene = registry::by_name("plane-shear").unwrap().variant("plain").unwrap();
    scene.change_laws(|law| (law.friction, law.tangential_damping) = (0.0, 0.0));
    scene
}

/// Loop that runs under valgrind. As an ordinary test, it does nothing.
#[test]
fn counted_loop() {
    let Ok(task) = std::env::var(TASK) else { return };
    let (name, steps) = task.split_once(' ').unwrap();
    let steps: u64 = steps.parse().unwrap();
    if name == "by-hand" {
        let place =
            |grain: &grainbench::scene::scene::Grain| ([grain.position.x, grain.position.y], grain.radius, grain.mass);
        let discs: Vec<_> = lattice().grains.iter().map(place).collect();
        let mut minimal = Minimal::new(&discs, 1.0, 0.2);
        (0..steps).for_each(|_| minimal.step(STEP));
        assert!(minimal.touching >= steps * u64::from(SIDE * SIDE) && minimal.farthest < 0.01);
        return;
    }
    let (mut scene, step) = if name.starts_with("dense") { (dense_shear(), 1e-4) } else { (lattice(), STEP) };
    if name.ends_with("with-idle-friction") {
        assert!(Effect::Friction.switch_on_idly(&mut scene));
    }
    let mut simulation = Dem::new(Convention::DEFAULT).start(&scene, step).unwrap();
    simulation.advance(steps).unwrap();
    assert_eq!(simulation.counts().neighbour_builds, 1);
}

/// Counts the instructions of a process that runs a loop for a number of steps.
fn instructions(name: &str, steps: u64) -> Option<f64> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(std::env::current_exe().unwrap())
        .args(["--exact", "absent_effects::counted_loop", "--test-threads=1"])
        .env(TASK, format!("{name} {steps}"))
        .output()
        .ok()?;
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{text}\n{}", String::from_utf8_lossy(&output.stdout));
    let line = text.lines().find(|line| line.contains("Collected :")).expect("callgrind says how many it counted");
    line.split(':').nth(1)?.trim().parse().ok()
}

/// Returns the instructions per step from runs with few and many steps. Without valgrind, returns `None`, or panics in CI.
fn a_step(name: &str, [few, many]: [u64; 2]) -> Option<f64> {
    let counted = instructions(name, many).zip(instructions(name, few));
    assert!(counted.is_some() || std::env::var_os("CI").is_none(), "valgrind is not installed: nothing was counted");
    let (many_steps, few_steps) = counted?;
    Some((many_steps - few_steps) / (many - few) as f64)
}

#[test]
fn what_is_absent_costs_next_to_nothing() {
    const STEPS: [u64; 2] = [10, 60];
    let (Some(by_hand), Some(kernel)) = (a_step("by-hand", STEPS), a_step("kernel", STEPS)) else { return };
    let idle = a_step("with-idle-friction", STEPS).unwrap();
    println!("instructions a step: by hand {by_hand}, kernel {kernel}, friction that does nothing {idle}");
    assert!(kernel <= ALLOWED * by_hand, "the kernel takes {kernel} instructions a step, a loop by hand {by_hand}");
    // Control: the count increases if an effect is compiled in.
    assert!(idle > 1.1 * kernel, "friction that does nothing takes {idle} instructions, none {kernel}");
}

/// In dense shear, a step without friction takes fewer instructions than a step with friction that has no effect.
#[test]
fn dense_shear_without_friction_takes_fewer_instructions() {
    const STEPS: [u64; 2] = [2, 12];
    let Some(kernel) = a_step("dense", STEPS) else { return };
    let idle = a_step("dense-with-idle-friction", STEPS).unwrap();
    println!("instructions a step of dense shear: {kernel}, with friction that does nothing {idle}");
    assert!(idle >= FRICTION * kernel, "friction that does nothing takes {idle} instructions, none {kernel}");
}

/// The selected kernel contains friction if and only if the scene has friction, even if friction has no effect.
#[test]
fn what_is_absent_is_no_part_of_the_kernel() {
    let kernel = |scene: &Scene| Dem::new(Convention::DEFAULT).start(scene, 1e-4).unwrap().layout();
    for mut scene in [lattice(), dense_shear()] {
        let without = kernel(&scene);
        assert!(without.contains("Frictionless") && !without.contains("Coulomb"), "{without}");
        assert!(Effect::Friction.switch_on_idly(&mut scene));
        let with = kernel(&scene);
        assert!(with.contains("Coulomb") && !with.contains("Frictionless"), "{with}");
    }
}

/// Adds an unused material with friction and rolling resistance. The selected kernels then include both, but they have no effect.
fn with_idle_friction(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let (law, count) = (scene.laws[0].unwrap(), scene.materials.len());
    assert_eq!(count, 1, "a scene of one material");
    let normal = law.normal_stiffness();
    let springs = Springs::Linear { normal, tangential: normal };
    let idle = ContactLaw { springs, friction: 0.5, rolling_friction: 0.1, ..law };
    scene.materials.push("idle".to_owned());
    scene.laws = vec![Some(law), None, None, Some(idle)];
    scene
}

#[test]
fn friction_that_does_nothing_changes_nothing_in_a_gas() {
    let gas = registry::by_name("disc-gas").unwrap().variant("plain").unwrap();
    same_without(&Scene { duration: Duration::Cycles(20_000), ..gas }, Resolution::CriticalFraction(0.05));
}

#[test]
fn friction_that_does_nothing_changes_nothing_in_dense_shear() {
    same_without(&Scene { duration: Duration::Cycles(200), ..dense_shear() }, Resolution::TimeStep(1e-4));
}

/// Checks that a frictionless scene has the same final state with the frictionless kernel and with friction that has no effect.
fn same_without(scene: &Scene, resolution: Resolution) {
    let idle = with_idle_friction(scene);
    let (without, with) = (Effects::from_scene(scene), Effects::from_scene(&idle));
    assert!(!without.friction && with.friction && with.rolling_resistance);
    let [without, with] = [scene, &idle].map(|scene| simulated("dem", scene, &resolution));
    let (without, with) = (without.snapshots.last().unwrap(), with.snapshots.last().unwrap());
    assert!(without.grains.iter().any(|grain| grain.velocity != scene.grains[grain.id as usize - 1].velocity));
    for (a, b) in without.grains.iter().zip(&with.grains) {
        // Equal numbers have equal bits, except for the sign of zero.
        assert!(a.position == b.position && a.velocity == b.velocity && a.force == b.force, "grain {}", a.id);
    }
}
