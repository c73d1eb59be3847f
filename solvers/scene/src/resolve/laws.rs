//! Materials in use, their properties as deformable bodies, and the table of contact laws between them.

use super::Resolver;
use crate::contact_law::ContactLaw;
use crate::error::SceneError;
use crate::material::Deformable;
use crate::scene::{Block, Grain, Wall};
use std::collections::BTreeSet;

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

    /// Returns the table of laws for all pairs of `materials` (indices in the file). Laws of other pairs in the file
    /// are checked but not stored.
    pub(super) fn laws(
        &self,
        materials: &[usize],
        grains: &[Grain],
        bodies: &[Block],
        walls: &[Wall],
    ) -> Result<Vec<Option<ContactLaw>>, SceneError> {
        let count = materials.len();
        let mut table = vec![None; count * count];
        let mut stated = BTreeSet::new();
        let grain_shape = self.grain_shape()?;
        for (name, spec) in &self.file.contacts {
            let key = format!("contacts.{name}.between");
            let a = usize::from(self.material(&key, &spec.between[0])?);
            let b = usize::from(self.material(&key, &spec.between[1])?);
            let found = format_args!("a second law for {} and {}", spec.between[0], spec.between[1]);
            let is_first = stated.insert((a.min(b), a.max(b)));
            self.check.require(is_first, &key, "one law for each pair of materials", found)?;
            let law = spec.law(name, &self.check, &self.file.materials, grain_shape)?;
            if let (Ok(a), Ok(b)) = (materials.binary_search(&a), materials.binary_search(&b)) {
                table[a * count + b] = Some(law);
                table[b * count + a] = Some(law);
            }
        }
        let mut kinds = table.iter().flatten().map(|law| law.springs.kind());
        let first = kinds.next();
        let is_one_kind = kinds.all(|kind| Some(kind) == first);
        self.check.require(is_one_kind, "contacts", "laws of one kind, all `linear` or all `hertz`", "both")?;
        self.require_laws(materials, &table, grains, bodies, walls)?;
        Ok(table)
    }

    /// Rejects a pair of materials that can come into contact but has no law. Without a law, their grains would pass
    /// through each other.
    fn require_laws(
        &self,
        materials: &[usize],
        table: &[Option<ContactLaw>],
        grains: &[Grain],
        bodies: &[Block],
        walls: &[Wall],
    ) -> Result<(), SceneError> {
        let count = materials.len();
        let mut grains_of = vec![0_usize; count];
        grains.iter().for_each(|grain| grains_of[usize::from(grain.material)] += 1);
        bodies.iter().for_each(|body| grains_of[usize::from(body.material)] += 1);
        let walls: BTreeSet<usize> = walls.iter().map(|wall| usize::from(wall.material)).collect();
        for a in 0..count {
            for b in 0..count {
                let among_grains = if a == b { grains_of[a] > 1 } else { grains_of[a] > 0 && grains_of[b] > 0 };
                let at_wall = grains_of[a] > 0 && walls.contains(&b);
                if (among_grains || at_wall) && table[a * count + b].is_none() {
                    let name = |place: usize| self.material_name(materials[place]);
                    let pair = format!("a law between {} and {}, which can come into contact", name(a), name(b));
                    return Err(self.check.error("contacts", &pair, "none"));
                }
            }
        }
        Ok(())
    }
}
