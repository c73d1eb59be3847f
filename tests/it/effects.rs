//! An effect that a scene does not need is not simulated. Simulating it with neutral values does not change the result.

use grainbench::cases::registry;
use grainbench::dem::convention::Convention;
use grainbench::dem::solver::Dem;
use grainbench::scene::contact_law::{ContactLaw, Springs};
use grainbench::scene::effects::Effects;
use grainbench::scene::scene::{Duration, Scene};
use grainbench::solver::Solver;
use grainbench::solver::record::Record;
use grainbench::solver::resolution::Resolution;

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

fn run(scene: &Scene, resolution: Resolution) -> Record {
    Dem::new(Convention::DEFAULT).run(scene, &resolution, &mut ()).unwrap()
}

#[test]
fn friction_that_does_nothing_changes_nothing_in_a_gas() {
    let mut scene = registry::by_name("disc-gas").unwrap().variant("plain").unwrap();
    scene.duration = Duration::Cycles(20_000);
    same_without(&scene, Resolution::CriticalFraction(0.05));
}

#[test]
fn friction_that_does_nothing_changes_nothing_in_dense_shear() {
    let mut scene = registry::by_name("plane-shear").unwrap().variant("plain").unwrap();
    scene.change_laws(|law| (law.friction, law.tangential_damping) = (0.0, 0.0));
    scene.duration = Duration::Cycles(200);
    same_without(&scene, Resolution::TimeStep(1e-4));
}

/// Checks that a frictionless scene has the same final state with the frictionless kernel and with friction that has no effect.
fn same_without(scene: &Scene, resolution: Resolution) {
    let idle = with_idle_friction(scene);
    let (without, with) = (Effects::from_scene(scene), Effects::from_scene(&idle));
    assert!(!without.friction && with.friction && with.rolling_resistance);
    let (without, with) = (run(scene, resolution), run(&idle, resolution));
    let (without, with) = (without.snapshots.last().unwrap(), with.snapshots.last().unwrap());
    assert!(without.grains.iter().any(|grain| grain.velocity != scene.grains[grain.id as usize - 1].velocity));
    for (a, b) in without.grains.iter().zip(&with.grains) {
        // Equal numbers have equal bits, except for the sign of zero.
        assert!(a.position == b.position && a.velocity == b.velocity && a.force == b.force, "grain {}", a.id);
    }
}
