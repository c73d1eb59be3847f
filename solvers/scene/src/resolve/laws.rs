//! The pair table: contact laws between materials.

use super::Resolver;
use crate::contact_law::{ContactLaw, Surroundings};
use crate::error::SceneError;
use crate::scene::{Block, Grain, Wall};

impl Resolver<'_> {
    pub(super) fn laws(
        &self,
        grains: &[Grain],
        bodies: &[Block],
        walls: &[Wall],
    ) -> Result<Vec<Option<ContactLaw>>, SceneError> {
        let count = self.file.materials.len();
        let mut table = vec![None; count * count];
        let grain_shape = self.grain_shape()?;
        let around = Surroundings { check: &self.check, materials: &self.file.materials, grain_shape };
        for (name, spec) in &self.file.contacts {
            let key = format!("contacts.{name}.between");
            let a = usize::from(self.material(&key, &spec.between[0])?);
            let b = usize::from(self.material(&key, &spec.between[1])?);
            if table[a * count + b].is_some() {
                let pair = format!("a second one for {} and {}", spec.between[0], spec.between[1]);
                return Err(self.check.error(&key, "one law for each pair of materials", &pair));
            }
            let law = Some(spec.law(name, &around)?);
            table[a * count + b] = law;
            table[b * count + a] = law;
        }
        let all = table.iter().flatten().count();
        let hertz = table.iter().flatten().filter(|law| ContactLaw::is_hertz(law)).count();
        let springs = table.iter().flatten().filter(|law| ContactLaw::has_stiffness(law)).count();
        if (hertz > 0 && hertz < springs) || (springs > 0 && springs < all) {
            return Err(self.check.error("contacts", "laws of one kind, all `linear` or all `hertz`", "both"));
        }
        self.require_laws(&table, grains, bodies, walls)?;
        Ok(table)
    }

    /// Every pair of materials that can meet must have a law: silence would let grains pass through each other.
    fn require_laws(
        &self,
        table: &[Option<ContactLaw>],
        grains: &[Grain],
        bodies: &[Block],
        walls: &[Wall],
    ) -> Result<(), SceneError> {
        let count = self.file.materials.len();
        let mut grains_of = vec![0_usize; count];
        grains.iter().for_each(|grain| grains_of[usize::from(grain.material)] += 1);
        bodies.iter().for_each(|body| grains_of[usize::from(body.material)] += 1);
        let has_wall = |m: usize| walls.iter().any(|wall| usize::from(wall.material) == m);
        for a in 0..count {
            for b in 0..count {
                let among_grains = if a == b { grains_of[a] > 1 } else { grains_of[a] > 0 && grains_of[b] > 0 };
                let at_wall = grains_of[a] > 0 && has_wall(b);
                if (among_grains || at_wall) && table[a * count + b].is_none() {
                    let name = |m: usize| self.file.materials.get_index(m).map_or("", |(name, _)| name.as_str());
                    let pair = format!("a law between {} and {}, which can meet", name(a), name(b));
                    return Err(self.check.error("contacts", &pair, "none"));
                }
            }
        }
        Ok(())
    }
}
