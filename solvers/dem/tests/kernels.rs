//! Tests of the number of compiled kernels, and of their stages: each kernel has only the stages that its scene needs.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use grainbench_dem::convention::{CapNormal, Convention, CoulombCap, History, Tension, TorqueArm, WallRolling};
use grainbench_dem::solver::Dem;
use grainbench_scene::contact_law::{ContactLaw, Springs};
use grainbench_scene::effect::Effect;
use grainbench_scene::effects::Effects;
use grainbench_scene::method::Method;
use grainbench_scene::scene::Scene;
use std::collections::BTreeSet;

/// Number of compiled kernels, in two and three dimensions. There are four normal stages. Each is combined with no
/// friction (1 kernel), or with friction (4 kernels): with or without rolling resistance, for two transports of springs
/// at rotating contacts.
///
/// A kernel consists of two loops: one over pairs, for each instruction set, and one over walls. A new effect or option
/// that multiplies kernels changes this number.
const KERNELS: usize = 2 * 4 * (1 + 4);

/// Returns a contact law with every effect, for Hertz contacts or for linear springs.
fn law_with_everything(hertz: bool) -> ContactLaw {
    let law = ContactLaw {
        friction: 0.5,
        cohesion: 1.0,
        stiffness_damping: 1e-6,
        normal_damping: 1.0,
        tangential_damping: 1.0,
        damping_ratio: 0.1,
        rolling_friction: 0.1,
        rolling_damping: 0.1,
        ..ContactLaw::default()
    };
    if hertz {
        ContactLaw { springs: Springs::Hertz { effective_modulus: 1e9, effective_shear_modulus: 3e8 }, ..law }
    } else {
        ContactLaw { springs: Springs::Linear { normal: 1e6, tangential: 5e5 }, ..law }
    }
}

/// Returns a scene of two grains and a moving wall with every effect, for Hertz contacts or for linear springs.
fn scene_with_everything(dimension: usize, hertz: bool) -> Scene {
    let texts = [include_str!("scenes/everything-2d.toml"), include_str!("scenes/everything-3d.toml")];
    let mut scene = Scene::from_text("everything", texts[dimension - 2]).unwrap();
    scene.change_laws(|law| *law = law_with_everything(hertz));
    let off: Vec<Effect> = effects().filter(|effect| !effect.is_on(&scene)).collect();
    assert!(off == if hertz { vec![] } else { vec![Effect::Hertz] }, "{off:?} are off");
    scene
}

/// Returns the effects that apply to solvers for rigid grains.
fn effects() -> impl Iterator<Item = Effect> {
    Effect::ALL.into_iter().filter(|effect| effect.concerns(Method::Dem))
}

/// Returns a scene for every combination of effects, in two and three dimensions, with linear springs and with Hertz contacts.
fn scenes() -> Vec<Scene> {
    let switches: Vec<Effect> = effects().filter(|effect| *effect != Effect::Hertz).collect();
    let mut scenes = Vec::new();
    for (dimension, hertz) in [(2, false), (2, true), (3, false), (3, true)] {
        let everything = scene_with_everything(dimension, hertz);
        for off in 0..1_usize << switches.len() {
            let mut scene = everything.clone();
            let switched_off = switches.iter().enumerate().filter(|(bit, _)| off >> bit & 1 == 1);
            switched_off.for_each(|(_, effect)| effect.switch_off(&mut scene));
            scenes.push(scene);
        }
    }
    scenes
}

/// Returns all combinations of two values of each option of a convention, except for the normal of velocities.
fn conventions() -> Vec<Convention> {
    let mut conventions = vec![Convention::CUNDALL_STRACK];
    let mut vary = |options: [fn(&mut Convention); 2]| {
        conventions = conventions
            .iter()
            .flat_map(|convention| {
                options.map(|set| {
                    let mut varied = *convention;
                    set(&mut varied);
                    varied
                })
            })
            .collect();
    };
    vary([|to| to.coulomb_cap = CoulombCap::Spring, |to| to.coulomb_cap = CoulombCap::SpringAndDashpot]);
    vary([|to| to.cap_normal = CapNormal::Spring, |to| to.cap_normal = CapNormal::Pushing]);
    vary([|to| to.torque_arm = TorqueArm::Radius, |to| to.torque_arm = TorqueArm::ContactPoint]);
    vary([|to| to.tension = Tension::Allowed, |to| to.tension = Tension::Clipped]);
    vary([|to| to.history = History::Turned, |to| to.history = History::Projected]);
    vary([|to| to.wall_rolling = WallRolling::RelativeSpin, |to| to.wall_rolling = WallRolling::Surface]);
    conventions
}

/// Returns the name of the kernel for a scene and a convention.
fn kernel(scene: &Scene, convention: Convention) -> &'static str {
    Dem::new(convention).start(scene, 1e-6).unwrap().layout()
}

/// Counts every kernel that the solver can select, for all combinations of effects, conventions and dimensions.
#[test]
fn no_more_kernels_are_compiled_than_known() {
    let (scenes, conventions) = (scenes(), conventions());
    let mut kernels = BTreeSet::new();
    for scene in &scenes {
        kernels.extend(conventions.iter().map(|&convention| kernel(scene, convention)));
    }
    let listed: Vec<&str> = kernels.iter().copied().collect();
    assert_eq!(kernels.len(), KERNELS, "{}", listed.join("\n"));
}

/// The name of a kernel contains the stage of an effect if and only if the scene has this effect.
#[test]
fn a_kernel_has_no_stage_for_what_is_absent() {
    for scene in scenes() {
        let effects = Effects::from_scene(&scene);
        for convention in Convention::ALL {
            let kernel = kernel(&scene, convention);
            let stages = [
                (effects.friction, "::Coulomb<"),
                (!effects.friction, "::Frictionless"),
                (effects.rolling_resistance, "::ElasticPlastic"),
                (!effects.rolling_resistance, "::FreeRolling"),
                (effects.hertz, "::Hertz"),
                (!effects.hertz, "::Spring"),
                (effects.hertz && effects.contact_damping, "::HertzDashpot"),
                (!effects.hertz && effects.contact_damping, "::SpringDashpot"),
            ];
            for (present, stage) in stages {
                assert_eq!(kernel.contains(stage), present, "`{stage}` in {kernel} of {effects:?}");
            }
        }
    }
}
