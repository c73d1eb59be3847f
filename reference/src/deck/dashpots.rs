//! Dashpots as both programs have them: proportional to the effective mass of the contact.

use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::scene::Scene;

/// Coefficients γ of c = γ m_eff (1/s).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Dashpots {
    pub(crate) normal: f64,
    pub(crate) tangential: f64,
}

/// The other side of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// Grains of a material.
    Grains(u16),
    /// A wall.
    Wall,
}

impl Dashpots {
    /// The coefficients of a law for contacts of grains of one material with a partner.
    ///
    /// Dashpots that are not proportional to the effective mass are so all the same where every contact has the same
    /// effective mass: c = βk is γ = βk/m_eff, and a coefficient of restitution gives γ = 2ζ√(k/m_eff).
    pub(crate) fn of(scene: &Scene, law: &ContactLaw, material: u16, side: Side) -> Result<Self, String> {
        let mut dashpots = Self { normal: law.normal_damping, tangential: law.tangential_damping };
        let named = match (law.stiffness_damping != 0.0, law.damping_ratio != 0.0) {
            (false, false) => return Ok(dashpots),
            (true, _) => "stiffness_damping",
            (false, true) => "restitution",
        };
        let reason = || {
            let what =
                "between grains of different mass needs a dashpot that is not proportional to the effective mass";
            format!("`{named}` {what}")
        };
        let mass = one_mass(scene, material).ok_or_else(reason)?;
        let effective = match side {
            Side::Wall => mass,
            Side::Grains(other) => {
                let other = one_mass(scene, other).ok_or_else(reason)?;
                mass * other / (mass + other)
            }
        };
        let (normal, tangential) = (law.normal_stiffness() / effective, law.tangential_stiffness() / effective);
        dashpots.normal += law.stiffness_damping * normal + 2.0 * law.damping_ratio * normal.sqrt();
        dashpots.tangential += law.stiffness_damping * tangential;
        Ok(dashpots)
    }
}

/// The mass of all grains of a material, if it is one.
fn one_mass(scene: &Scene, material: u16) -> Option<f64> {
    let mut masses = scene.grains.iter().filter(|grain| grain.material == material).map(|grain| grain.mass);
    let first = masses.next()?;
    masses.all(|mass| mass == first).then_some(first)
}
