//! Effects that a scene uses, as flags. Solvers select their kernels from these flags.

use crate::effect::Effect;
use crate::scene::Scene;

/// Effects that are on. Solvers select their kernels from these flags once, before the first step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effects {
    /// Tangential forces or rolling moments at contacts: at least one law has friction, cohesion or rolling resistance.
    /// Without this effect, no torque acts, and solvers need no contact history and no spin.
    pub friction: bool,
    /// Dashpots at contacts: at least one law has a damping coefficient or a restitution below 1.
    pub contact_damping: bool,
    /// Normal dashpots that set a coefficient of restitution.
    pub restitution: bool,
    /// Hertz contacts instead of linear springs.
    pub hertz: bool,
    /// Moments against rolling: at least one law has rolling resistance.
    pub rolling_resistance: bool,
}

impl Effects {
    /// Returns the effects that `scene` uses.
    #[must_use]
    pub fn from_scene(scene: &Scene) -> Self {
        let on = |effect: Effect| effect.is_on(scene);
        Self {
            friction: on(Effect::Friction) || on(Effect::Cohesion) || on(Effect::RollingResistance),
            contact_damping: on(Effect::ContactDamping),
            restitution: on(Effect::Restitution),
            hertz: on(Effect::Hertz),
            rolling_resistance: on(Effect::RollingResistance),
        }
    }

    /// Returns the names of the effects that are on.
    #[must_use]
    pub fn words(scene: &Scene) -> Vec<String> {
        Effect::ALL.into_iter().filter(|effect| effect.is_on(scene)).map(|effect| effect.word().to_owned()).collect()
    }
}
