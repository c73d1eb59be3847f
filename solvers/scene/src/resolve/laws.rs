//! The pair table: contact laws between materials.

use super::Resolver;
use crate::error::SceneError;
use crate::file::{ContactSpec, GrainShape, LawKind};
use crate::scene::{Block, ContactLaw, Grain, Wall};
use std::f64::consts::PI;

impl Resolver<'_> {
    pub(super) fn laws(
        &self,
        grains: &[Grain],
        bodies: &[Block],
        walls: &[Wall],
    ) -> Result<Vec<Option<ContactLaw>>, SceneError> {
        let count = self.file.materials.len();
        let mut table = vec![None; count * count];
        for (name, spec) in &self.file.contacts {
            let key = format!("contacts.{name}.between");
            let a = usize::from(self.material(&key, &spec.between[0])?);
            let b = usize::from(self.material(&key, &spec.between[1])?);
            if table[a * count + b].is_some() {
                let pair = format!("a second one for {} and {}", spec.between[0], spec.between[1]);
                return Err(self.check.error(&key, "one law for each pair of materials", &pair));
            }
            let law = Some(self.law(name, spec)?);
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

    fn law(&self, name: &str, spec: &ContactSpec) -> Result<ContactLaw, SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("contacts.{name}.{part}");
        let friction = match (spec.friction, spec.friction_angle_deg) {
            (Some(_), Some(_)) => {
                return Err(check.error(&key("friction"), "one of `friction` and `friction_angle_deg`", "both"));
            }
            (Some(friction), None) => check.not_negative(&key("friction"), friction, "coefficient of friction")?,
            (None, Some(angle)) => {
                if !(0.0..90.0).contains(&angle) {
                    return Err(check.error(
                        &key("friction_angle_deg"),
                        "an angle from 0 to below 90°",
                        &angle.to_string(),
                    ));
                }
                angle.to_radians().tan()
            }
            (None, None) => 0.0,
        };
        let damping = |part: &str, value: f64, unit: &str| check.not_negative(&key(part), value, unit);
        let restitution = spec.restitution.unwrap_or(1.0);
        if !(restitution > 0.0 && restitution <= 1.0) {
            return Err(check.error(
                &key("restitution"),
                "a coefficient above 0 and at most 1",
                &restitution.to_string(),
            ));
        }
        let log = restitution.ln();
        let mut law = ContactLaw {
            friction,
            cohesion: check.not_negative(&key("cohesion"), spec.cohesion, "force (N)")?,
            stiffness_damping: damping("stiffness_damping", spec.stiffness_damping, "time (s)")?,
            normal_damping: damping("normal_damping", spec.normal_damping, "rate (1/s)")?,
            tangential_damping: damping("tangential_damping", spec.tangential_damping, "rate (1/s)")?,
            damping_ratio: -log / (PI * PI + log * log).sqrt(),
            rolling_friction: damping("rolling_friction", spec.rolling_friction, "coefficient")?,
            rolling_damping: damping("rolling_damping", spec.rolling_damping, "damping ratio")?,
            ..ContactLaw::default()
        };
        match spec.law {
            LawKind::Linear => self.linear(name, spec, &mut law)?,
            LawKind::Hertz => self.hertz(name, spec, &mut law)?,
            LawKind::Coulomb if spec.normal_stiffness.is_some() || spec.tangential_stiffness != 0.0 => {
                let key = key("normal_stiffness");
                return Err(check.error(&key, "no stiffness: a `coulomb` contact has no spring", "one"));
            }
            LawKind::Coulomb => {}
        }
        Ok(law)
    }

    fn linear(&self, name: &str, spec: &ContactSpec, law: &mut ContactLaw) -> Result<(), SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("contacts.{name}.{part}");
        let Some(stiffness) = spec.normal_stiffness else {
            return Err(check.error(&format!("contacts.{name}"), "the key `normal_stiffness`", "none"));
        };
        law.normal_stiffness = check.positive(&key("normal_stiffness"), stiffness, "stiffness (N/m)")?;
        let tangential = spec.tangential_stiffness;
        law.tangential_stiffness = if law.has_friction() {
            let what = "stiffness (N/m), since there is friction";
            check.positive(&key("tangential_stiffness"), tangential, what)?
        } else {
            check.not_negative(&key("tangential_stiffness"), tangential, "stiffness (N/m)")?
        };
        Ok(())
    }

    /// 1/E* and 1/G* are sums over both materials; a rigid one adds nothing.
    fn hertz(&self, name: &str, spec: &ContactSpec, law: &mut ContactLaw) -> Result<(), SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("contacts.{name}.{part}");
        if self.grain_shape()? == GrainShape::Disc {
            return Err(check.error(&key("law"), "`linear` between discs: Hertz's law is for spheres", "`hertz`"));
        }
        if spec.normal_stiffness.is_some() || spec.tangential_stiffness != 0.0 {
            let expected = "no stiffness: a Hertz contact takes it from E and ν of the materials";
            return Err(check.error(&key("normal_stiffness"), expected, "one"));
        }
        if spec.stiffness_damping != 0.0 {
            let expected = "`normal_damping` or `restitution` in a Hertz contact, which has no one stiffness";
            return Err(check.error(&key("stiffness_damping"), expected, &spec.stiffness_damping.to_string()));
        }
        let (mut compliance, mut shear_compliance) = (0.0, 0.0);
        for material in &spec.between {
            let of = |part: &str| format!("materials.{material}.{part}");
            let properties = &self.file.materials[material.as_str()];
            if properties.rigid {
                continue;
            }
            let (Some(young), Some(poisson)) = (properties.young_modulus, properties.poisson_ratio) else {
                let expected = "`young_modulus` and `poisson_ratio` (or `rigid = true`), since it has Hertz contacts";
                return Err(check.error(&format!("materials.{material}"), expected, "not both"));
            };
            check.positive(&of("young_modulus"), young, "modulus (Pa)")?;
            if !(poisson > -1.0 && poisson <= 0.5) {
                return Err(check.error(
                    &of("poisson_ratio"),
                    "a ratio above −1 and at most 1/2",
                    &poisson.to_string(),
                ));
            }
            compliance += (1.0 - poisson * poisson) / young;
            shear_compliance += 2.0 * (2.0 - poisson) * (1.0 + poisson) / young;
        }
        if compliance == 0.0 {
            return Err(check.error(&key("between"), "at least one material that is not rigid", "two rigid ones"));
        }
        law.effective_modulus = 1.0 / compliance;
        law.effective_shear_modulus = 1.0 / shear_compliance;
        Ok(())
    }
}
