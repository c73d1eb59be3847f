//! Selection of the materials in use, and properties of deformable materials.

use super::Resolver;
use crate::error::SceneError;
use crate::material::Deformable;
use crate::scene::{Block, Grain, Wall};

/// Largest number of materials in use, because each pair of them has an entry in a table.
const MOST_MATERIALS: usize = 1000;

impl Resolver<'_> {
    /// Returns the indices in the file of all materials in use. The materials of grains, bodies and walls are changed
    /// to indices in this list, so that unused materials cost nothing.
    pub(super) fn used_materials(
        &self,
        grains: &mut [Grain],
        bodies: &mut [Block],
        walls: &mut [Wall],
    ) -> Result<Vec<usize>, SceneError> {
        let mut used = vec![false; self.file.materials.len()];
        let named = || {
            let grains = grains.iter().map(|grain| grain.material);
            grains.chain(bodies.iter().map(|body| body.material)).chain(walls.iter().map(|wall| wall.material))
        };
        named().for_each(|material| used[usize::from(material)] = true);
        let kept: Vec<usize> = (0..used.len()).filter(|&place| used[place]).collect();
        let expected = format!("at most {MOST_MATERIALS} materials that are in use");
        self.check.require(kept.len() <= MOST_MATERIALS, "materials", &expected, kept.len())?;
        let mut now = vec![0_u16; used.len()];
        (0..).zip(&kept).for_each(|(place, &before)| now[before] = place);
        let renamed = |material: &mut u16| *material = now[usize::from(*material)];
        grains.iter_mut().for_each(|grain| renamed(&mut grain.material));
        bodies.iter_mut().for_each(|body| renamed(&mut body.material));
        walls.iter_mut().for_each(|wall| renamed(&mut wall.material));
        Ok(kept)
    }

    /// Returns the name of a material, by index in the file.
    pub(super) fn material_name(&self, place: usize) -> &str {
        self.file.materials.get_index(place).map_or("", |(name, _)| name.as_str())
    }

    /// Returns the density of a material (kg/m³), by index in the file.
    pub(super) fn density(&self, material: u16) -> Result<f64, SceneError> {
        let place = usize::from(material);
        let missing =
            || self.check.error(&format!("materials.{}", self.material_name(place)), "the key `density`", "none");
        self.file.materials[place].density.ok_or_else(missing)
    }

    /// Returns the deformable properties of each material; `None` if the file gives none.
    pub(super) fn deformable(&self) -> Result<Vec<Option<Deformable>>, SceneError> {
        self.file.materials.iter().map(|(name, material)| material.deformable(name, &self.check)).collect()
    }
}
