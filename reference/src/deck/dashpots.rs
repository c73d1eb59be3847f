//! Dashpots proportional to the effective mass of the contact, as in LAMMPS and LIGGGHTS.

use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::scene::Scene;

/// Coefficients γ (1/s) of normal and tangential dashpots c = γ m_eff.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Dashpots {
    pub(crate) normal: f64,
    pub(crate) tangential: f64,
}

/// Contact partner of a grain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    /// Grains of a material, by its index.
    Grains(u16),
    /// A wall.
    Wall,
}

impl Dashpots {
    /// Returns the coefficients of a contact law for contacts between grains of a material and a partner.
    ///
    /// Other dashpots can be converted if all these contacts have the same effective mass m_eff. Stiffness-proportional
    /// damping c = βk gives γ = βk/m_eff. A coefficient of restitution gives γ = 2ζ√(k/m_eff). A grain with prescribed
    /// motion has infinite mass. Without friction there is no tangential dashpot.
    pub(crate) fn from_law(scene: &Scene, law: &ContactLaw, material: u16, side: Side) -> Result<Self, String> {
        let sheared = if law.has_friction() { 1.0 } else { 0.0 };
        let mut dashpots = Self { normal: law.normal_damping, tangential: sheared * law.tangential_damping };
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
                if mass.max(other).is_finite() { mass * other / (mass + other) } else { mass.min(other) }
            }
        };
        let (normal, tangential) = (law.normal_stiffness() / effective, law.tangential_stiffness() / effective);
        dashpots.normal += law.stiffness_damping * normal + 2.0 * law.damping_ratio * normal.sqrt();
        dashpots.tangential += sheared * law.stiffness_damping * tangential;
        Ok(dashpots)
    }
}

/// Returns the mass (kg) of the grains of a material, or `None` if their masses differ. Grains with prescribed motion have
/// infinite mass.
fn one_mass(scene: &Scene, material: u16) -> Option<f64> {
    let grains = scene.grains.iter().zip(scene.driven_group_of_grains());
    let mut masses = grains
        .filter(|(grain, _)| grain.material == material)
        .map(|(grain, driven)| if driven.is_some() { f64::INFINITY } else { grain.mass });
    let first = masses.next()?;
    masses.all(|mass| mass == first).then_some(first)
}
