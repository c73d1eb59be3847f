//! The contact laws of a scene: one for every two materials.

use grainbench_scene::scene::{ContactLaw, Scene};

/// The law between every two materials.
pub(crate) struct Laws {
    /// Row after row: the laws of a material with every other.
    laws: Vec<ContactLaw>,
    material_count: usize,
}

impl Laws {
    /// The laws of a scene.
    pub(crate) fn new(scene: &Scene) -> Self {
        Self {
            laws: scene.laws.iter().map(|law| law.map(without_idle_shear).unwrap_or_default()).collect(),
            material_count: scene.materials.len(),
        }
    }

    /// The laws of a material with the others, by their number; the laws of the next materials follow.
    #[inline(always)]
    pub(crate) fn of(&self, material: u16) -> &[ContactLaw] {
        &self.laws[usize::from(material) * self.material_count..]
    }
}

/// A law without friction has no tangential spring or dashpot either, also in a scene that has friction elsewhere.
fn without_idle_shear(law: ContactLaw) -> ContactLaw {
    if law.has_friction() { law } else { ContactLaw { tangential_stiffness: 0.0, tangential_damping: 0.0, ..law } }
}
