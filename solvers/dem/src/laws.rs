//! The contact laws of a scene as the kernels read them: one row of numbers for every two materials.

use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::scene::Scene;

/// The numbers of a contact law. Which law they belong to is the type of the kernel's stages, so that a stage reads its
/// numbers without asking; [`ContactLaw`] says what each means.
#[derive(Clone, Copy, Debug, Default)]
pub struct Constants {
    /// Constants of the springs: k_n and k_s (N/m), or E* and G* (Pa).
    pub springs: [f64; 2],
    /// Friction tan φ.
    pub friction: f64,
    /// Cohesion c (N).
    pub cohesion: f64,
    /// Stiffness-proportional damping β (s).
    pub stiffness_damping: f64,
    /// Mass-proportional normal damping γ_n (1/s).
    pub normal_damping: f64,
    /// Mass-proportional tangential damping γ_t (1/s).
    pub tangential_damping: f64,
    /// Damping ratio ζ.
    pub damping_ratio: f64,
    /// Coefficient of rolling resistance μ_r.
    pub rolling_friction: f64,
    /// Damping ratio η_r of the rolling spring.
    pub rolling_damping: f64,
}

impl From<&ContactLaw> for Constants {
    /// A law without friction has no tangential spring or dashpot either, also in a scene that has friction elsewhere.
    fn from(law: &ContactLaw) -> Self {
        let [normal, tangential] = law.springs.constants();
        let if_sheared = |number: f64| if law.has_friction() { number } else { 0.0 };
        Self {
            springs: [normal, if_sheared(tangential)],
            friction: law.friction,
            cohesion: law.cohesion,
            stiffness_damping: law.stiffness_damping,
            normal_damping: law.normal_damping,
            tangential_damping: if_sheared(law.tangential_damping),
            damping_ratio: law.damping_ratio,
            rolling_friction: law.rolling_friction,
            rolling_damping: law.rolling_damping,
        }
    }
}

/// The law between every two materials.
pub(crate) struct Laws {
    /// Row after row: the laws of a material with every other.
    laws: Vec<Constants>,
    material_count: usize,
}

impl Laws {
    /// The laws of a scene.
    pub(crate) fn new(scene: &Scene) -> Self {
        let constants = |law: &Option<ContactLaw>| law.as_ref().map(Constants::from).unwrap_or_default();
        Self { laws: scene.laws.iter().map(constants).collect(), material_count: scene.materials.len() }
    }

    /// The laws of a material with the others, by their number; the laws of the next materials follow.
    #[inline(always)]
    pub(crate) fn of(&self, material: u16) -> &[Constants] {
        &self.laws[usize::from(material) * self.material_count..]
    }
}
