//! Table of contact laws between materials.

use super::Resolver;
use crate::contact_law::ContactLaw;
use crate::error::SceneError;
use crate::scene::{Block, Grain, Wall};
use std::collections::BTreeSet;

impl Resolver<'_> {
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
