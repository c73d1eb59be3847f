//! List of physical effects. Each effect has a name, a scene key that switches it on, and a function that switches it
//! off. Most effects have a neutral value, which switches them on without changing results. The effects of a scene are
//! always determined from this list.

use crate::contact_law::{ContactLaw, Springs};
use crate::material::Constitutive;
use crate::method::Method;
use crate::motion::{Moment, Phase};
use crate::scene::Scene;
use nalgebra::Vector3;

/// Physical effect that a scene may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Effect {
    /// Tangential forces, and the rotation that they cause.
    Friction,
    /// Tangential strength of a contact at zero normal force.
    Cohesion,
    /// Hertz contacts instead of linear springs. They cannot be switched off, because that would need another law.
    Hertz,
    /// Contact dashpots, including those of a coefficient of restitution.
    ContactDamping,
    /// Normal dashpots that set a coefficient of restitution. They belong to the contact dashpots: without contact
    /// damping, they are off too.
    Restitution,
    /// Moments against rolling.
    RollingResistance,
    /// Mass-proportional damping of every grain.
    GlobalDamping,
    /// Gravity.
    Gravity,
    /// Periodic axes.
    PeriodicAxes,
    /// Walls or grains with prescribed motion.
    MovingWalls,
    /// Material that yields; only in deformable bodies.
    Plasticity,
    /// Material with a viscosity; only in deformable bodies.
    Viscosity,
}

impl Effect {
    /// All effects in a fixed order.
    pub const ALL: [Self; 12] = [
        Self::Friction,
        Self::Cohesion,
        Self::Hertz,
        Self::ContactDamping,
        Self::Restitution,
        Self::RollingResistance,
        Self::GlobalDamping,
        Self::Gravity,
        Self::PeriodicAxes,
        Self::MovingWalls,
        Self::Plasticity,
        Self::Viscosity,
    ];

    /// Returns the effects that can be switched off separately.
    pub fn switches() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|effect| !matches!(effect, Self::Hertz | Self::Restitution))
    }

    /// Returns the name of the effect for users, its name in files, and the title of a negative control without it.
    const fn names(self) -> [&'static str; 3] {
        match self {
            Self::Friction => ["friction and rotation", "friction", "without friction and rotation"],
            Self::Cohesion => ["cohesion", "cohesion", "without cohesion"],
            Self::Hertz => ["Hertz contacts", "hertz", "with linear springs"],
            Self::ContactDamping => ["contact damping", "contact-damping", "without contact damping"],
            Self::Restitution => ["restitution", "restitution", "without restitution"],
            Self::RollingResistance => ["rolling resistance", "rolling-resistance", "without rolling resistance"],
            Self::GlobalDamping => ["global damping", "global-damping", "without global damping"],
            Self::Gravity => ["gravity", "gravity", "without gravity"],
            Self::PeriodicAxes => ["periodic axes", "periodic-axes", "without periodic axes"],
            Self::MovingWalls => ["moving walls", "moving-walls", "with walls at rest"],
            Self::Plasticity => ["plasticity", "plasticity", "without plasticity"],
            Self::Viscosity => ["viscosity", "viscosity", "without viscosity"],
        }
    }

    /// Returns the name of the effect for users.
    #[must_use]
    pub const fn word(self) -> &'static str {
        self.names()[0]
    }

    /// Returns the name of the effect in files.
    #[must_use]
    pub const fn key_word(self) -> &'static str {
        self.names()[1]
    }

    /// Returns the title of a negative control without the effect.
    #[must_use]
    pub const fn absence(self) -> &'static str {
        self.names()[2]
    }

    /// Returns the scene key that switches the effect on, with its value; `None` if the effect is off.
    #[must_use]
    pub fn key(self, scene: &Scene) -> Option<String> {
        match self {
            Self::Friction => of_law(scene, "friction", |law| law.friction),
            Self::Cohesion => of_law(scene, "cohesion", |law| law.cohesion),
            Self::Hertz => of_law(scene, "youngs_modulus", ContactLaw::effective_modulus),
            Self::Restitution => of_law(scene, "restitution", restitution),
            Self::RollingResistance => of_law(scene, "rolling_friction", |law| law.rolling_friction),
            Self::ContactDamping => [
                ("normal_damping", (|law| law.normal_damping) as fn(&ContactLaw) -> f64),
                ("stiffness_damping", |law| law.stiffness_damping),
                ("restitution", restitution),
                ("tangential_damping", |law| if law.has_friction() { law.tangential_damping } else { 0.0 }),
            ]
            .into_iter()
            .find_map(|(key, value)| of_law(scene, key, value)),
            Self::GlobalDamping => {
                (scene.global_damping != 0.0).then(|| format!("global_damping = {}", scene.global_damping))
            }
            Self::Gravity => (scene.gravity != Vector3::zeros()).then(|| {
                let gravity: Vec<String> = scene.gravity.iter().map(|part| format!("{part:.4}")).collect();
                format!("gravity = [{}]", gravity[..scene.dimension.count()].join(", "))
            }),
            Self::PeriodicAxes => scene.is_periodic().then(|| "domain.periodic".to_owned()),
            Self::MovingWalls => {
                let wall = scene.walls.iter().find(|wall| wall.motion.is_moving());
                let driven = || scene.driven.iter().find(|driven| driven.fastest() > 0.0);
                let of_wall = wall.map(|wall| format!("walls.{}.motion", wall.name));
                of_wall.or_else(|| Some(format!("driven.{}.velocity", driven()?.name)))
            }
            Self::Plasticity => scene.deformable.iter().zip(&scene.materials).find_map(|(material, name)| {
                let yield_stress = material.as_ref()?.constitutive.yield_stress()?;
                Some(format!("materials.{name}.yield_stress = {yield_stress}"))
            }),
            Self::Viscosity => scene.deformable.iter().zip(&scene.materials).find_map(|(material, name)| {
                let [shear, bulk] = material.as_ref()?.constitutive.viscosities()?;
                let (key, value) = if shear > 0.0 { ("viscosity", shear) } else { ("bulk_viscosity", bulk) };
                Some(format!("materials.{name}.{key} = {value}"))
            }),
        }
    }

    /// Returns true if the effect exists in a method. Plasticity and viscosity exist only in deformable bodies on a
    /// grid.
    #[must_use]
    pub fn concerns(self, method: Method) -> bool {
        !matches!(self, Self::Plasticity | Self::Viscosity) || method == Method::Grid
    }

    /// Returns the methods whose loops omit the effect when it is off. These methods are also tested with the neutral
    /// value. Methods on a grid never omit gravity and damping, because both cost only one product and one sum per
    /// node.
    #[must_use]
    pub const fn left_out_by(self) -> &'static [Method] {
        match self {
            Self::Plasticity | Self::Viscosity => &[Method::Grid],
            Self::Friction => &[Method::Dem, Method::Grid],
            _ => &[Method::Dem],
        }
    }

    /// Returns true if the scene uses the effect.
    #[must_use]
    pub fn is_on(self, scene: &Scene) -> bool {
        self.key(scene).is_some()
    }

    /// Switches the effect off. Without friction, cohesion and rolling resistance are off too.
    pub fn switch_off(self, scene: &mut Scene) {
        match self {
            Self::Friction => scene.change_laws(|law| {
                (law.friction, law.cohesion, law.rolling_friction) = (0.0, 0.0, 0.0);
            }),
            Self::Cohesion => scene.change_laws(|law| law.cohesion = 0.0),
            // Hertz contacts cannot be switched off, because that would need another law.
            Self::Hertz => {}
            Self::Restitution => scene.change_laws(|law| law.damping_ratio = 0.0),
            Self::RollingResistance => scene.change_laws(|law| law.rolling_friction = 0.0),
            Self::ContactDamping => scene.change_laws(|law| {
                (law.normal_damping, law.stiffness_damping) = (0.0, 0.0);
                (law.tangential_damping, law.damping_ratio) = (0.0, 0.0);
            }),
            Self::GlobalDamping => scene.global_damping = 0.0,
            Self::Gravity => scene.gravity = Vector3::zeros(),
            Self::PeriodicAxes => {
                if let Some(domain) = &mut scene.domain {
                    domain.periodic = [false; 3];
                }
            }
            Self::MovingWalls => {
                scene.walls.iter_mut().for_each(|wall| wall.motion.clear());
                for driven in &mut scene.driven {
                    driven.velocity = Vector3::zeros();
                    driven.motion.clear();
                    if driven.is_moved_at(0.0) {
                        driven.grains.iter().for_each(|&grain| scene.grains[grain].velocity = Vector3::zeros());
                    }
                }
            }
            Self::Plasticity => {
                let is_plastic = |law| matches!(law, Constitutive::VonMises { .. });
                change_materials(scene, is_plastic, Constitutive::Hypoelastic);
            }
            Self::Viscosity => {
                let is_viscous = |law| matches!(law, Constitutive::KelvinVoigt { .. });
                change_materials(scene, is_viscous, Constitutive::NeoHookean);
            }
        }
    }

    /// Switches the effect on with a neutral value; returns false if it has none. Neutral values are a contact law of
    /// an unused material, a global damping or viscosity that is lost in rounding, a yield stress that is never
    /// reached, and a wall motion after the end of the run. The neutral gravity is so small that its product with a
    /// time step below 0.5 s is zero.
    #[must_use]
    pub fn switch_on_idly(self, scene: &mut Scene) -> bool {
        match self {
            Self::Friction => idle_law(scene, |law| {
                law.friction = 0.5;
                bear_shear(law);
            }),
            Self::Cohesion => idle_law(scene, |law| {
                law.cohesion = 1.0;
                bear_shear(law);
            }),
            Self::RollingResistance => idle_law(scene, |law| {
                law.friction = 0.5;
                bear_shear(law);
                law.rolling_friction = 0.1;
            }),
            Self::ContactDamping => idle_law(scene, |law| law.normal_damping = 1.0),
            Self::GlobalDamping => {
                scene.global_damping = f64::MIN_POSITIVE;
                true
            }
            Self::Gravity => {
                scene.gravity[0] = SMALLEST;
                true
            }
            Self::MovingWalls => {
                // The motion begins long after the end of the run. All walls have it, because walls that move differently
                // have no joint.
                let velocity = Vector3::new(1.0, 0.0, 0.0);
                let (start, stop) = (Moment::Seconds(f64::MAX), Moment::Never);
                for wall in &mut scene.walls {
                    wall.motion.phases.push(Phase { velocity, spin: Vector3::zeros(), start, stop });
                }
                !scene.walls.is_empty()
            }
            // The yield stress is so high that it is never reached.
            Self::Plasticity => {
                let never = Constitutive::VonMises { yield_stress: f64::MAX, hardening_modulus: 0.0 };
                change_materials(scene, |law| law == Constitutive::Hypoelastic, never)
            }
            Self::Viscosity => {
                let hardly = Constitutive::KelvinVoigt { viscosity: SMALLEST, bulk_viscosity: 0.0 };
                change_materials(scene, |law| law == Constitutive::NeoHookean, hardly)
            }
            // A periodic domain of any size changes the positions of grains. Hertz contacts and restitution change the
            // results.
            Self::PeriodicAxes | Self::Hertz | Self::Restitution => false,
        }
    }
}

/// Smallest positive floating-point number, used as gravity (m/s²) and as viscosity (Pa s). Its product with a time step
/// below 0.5 s is zero.
const SMALLEST: f64 = f64::from_bits(1);

/// Replaces the constitutive laws for which `is_changed` is true. Returns false if there are none.
fn change_materials(scene: &mut Scene, is_changed: impl Fn(Constitutive) -> bool, new: Constitutive) -> bool {
    let mut changed = false;
    for material in scene.deformable.iter_mut().flatten().filter(|material| is_changed(material.constitutive)) {
        (material.constitutive, changed) = (new, true);
    }
    changed
}

/// Returns the key with its value for the first law in which the value is not zero; `None` if there is none.
fn of_law(scene: &Scene, key: &str, value: impl Fn(&ContactLaw) -> f64) -> Option<String> {
    let count = scene.materials.len();
    scene.laws.iter().enumerate().find_map(|(at, law)| {
        let value = value(law.as_ref()?);
        let (a, b) = (&scene.materials[at / count], &scene.materials[at % count]);
        (value != 0.0).then(|| format!("contacts of {a} and {b}: {key} = {value}"))
    })
}

/// Returns the coefficient of restitution given in the scene, rounded to twelve decimal places; 0 if the law has no
/// such dashpot.
fn restitution(law: &ContactLaw) -> f64 {
    if law.damping_ratio == 0.0 { 0.0 } else { (1e12 * law.restitution()).round() / 1e12 }
}

/// Sets the tangential stiffness of linear springs to the normal stiffness.
const fn bear_shear(law: &mut ContactLaw) {
    if let Springs::Linear { normal, tangential } = &mut law.springs {
        *tangential = *normal;
    }
}

/// Adds an unused material with a changed copy of the first law of the scene. Returns false if the scene has no law.
fn idle_law(scene: &mut Scene, change: impl Fn(&mut ContactLaw)) -> bool {
    let Some(mut law) = scene.laws.iter().flatten().next().copied() else { return false };
    change(&mut law);
    let count = scene.materials.len();
    let rows = scene.laws.chunks(count).flat_map(|row| row.iter().copied().chain([None]));
    scene.laws = rows.chain(std::iter::repeat_n(None, count)).chain([Some(law)]).collect();
    scene.materials.push("idle".to_owned());
    if !scene.deformable.is_empty() {
        scene.deformable.push(None);
    }
    true
}

#[cfg(test)]
mod tests {
    /// The key of the effect shows the coefficient of restitution of the scene, not the damping ratio.
    #[test]
    fn restitution_is_told_as_the_scene_has_it() {
        let mut law = ContactLaw::default();
        for coefficient in [0.05, 0.5, 0.7, 0.99] {
            law.set_restitution(coefficient);
            assert_eq!(restitution(&law), coefficient);
        }
        law.set_restitution(1.0);
        assert_eq!(restitution(&law), 0.0);
    }

    use super::*;

    /// The table of laws gets a row and a column. The laws of the scene stay with their pairs of materials.
    #[test]
    fn an_unused_material_keeps_the_laws_of_the_others() {
        let text = "title = 'two materials'\ndimension = 2\nduration = 1.0\nmaterials.a.density = 1.0\n\
                    materials.b.density = 1.0\n\
                    contacts.aa = { between = ['a', 'a'], normal_stiffness = 1.0 }\n\
                    contacts.ab = { between = ['a', 'b'], normal_stiffness = 2.0 }\n\
                    contacts.bb = { between = ['b', 'b'], normal_stiffness = 3.0 }\n\
                    grains.a = { material = 'a', radius = 1.0, position = [0.0, 1.0] }\n\
                    grains.b = { material = 'b', radius = 1.0, position = [9.0, 1.0] }\n";
        let mut scene = Scene::from_text("two-materials", text).unwrap();
        assert!(Effect::Friction.switch_on_idly(&mut scene));
        let stiffness = scene.laws.iter().map(|law| law.map(|law| law.normal_stiffness()));
        let [a, ab, b] = [1.0, 2.0, 3.0].map(Some);
        // The unused material is in contact only with itself.
        assert_eq!(stiffness.collect::<Vec<_>>(), [a, ab, None, ab, b, None, None, None, a]);
    }

    /// A neutral value must switch the effect on. Otherwise, tests would run the kernel without the effect.
    #[test]
    fn what_is_switched_on_idly_is_on() {
        let text = "title = 'two discs'\ndimension = 2\nduration = 1.0\nmaterials.disc.density = 1.0\n\
                    contacts.all = { between = ['disc', 'disc'], normal_stiffness = 1.0 }\n\
                    grains.a = { material = 'disc', radius = 1.0, position = [0.0, 1.0] }\n\
                    walls.floor = { material = 'disc', plane = { point = [0.0, 0.0], normal = [0.0, 1.0] } }\n";
        let scene = Scene::from_text("two-discs", text).unwrap();
        for effect in Effect::ALL {
            let mut idle = scene.clone();
            assert!(!effect.is_on(&scene), "{effect:?}");
            if effect.switch_on_idly(&mut idle) {
                assert!(effect.is_on(&idle), "{effect:?}");
                effect.switch_off(&mut idle);
                assert!(!effect.is_on(&idle), "{effect:?}");
            }
        }
    }
}
