//! Materials: those that something is made of, and what deforms.

use super::Resolver;
use crate::body::{Constitutive, Deformable};
use crate::error::SceneError;
use crate::file::{ConstitutiveKind, MaterialSpec};
use crate::scene::{Block, Grain, Wall};

/// Most materials that things are made of: each pair of them has a place in a table.
const MOST_MATERIALS: usize = 1000;

impl Resolver<'_> {
    /// The materials that something is made of, by place in the file. Grains, bodies and walls name them by place among
    /// these from now on: a library of materials in the file costs nothing.
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
        if kept.len() > MOST_MATERIALS {
            let expected = format!("at most {MOST_MATERIALS} materials that something is made of");
            return Err(self.check.error("materials", &expected, &kept.len().to_string()));
        }
        let mut now = vec![0_u16; used.len()];
        (0..).zip(&kept).for_each(|(place, &before)| now[before] = place);
        let renamed = |material: &mut u16| *material = now[usize::from(*material)];
        grains.iter_mut().for_each(|grain| renamed(&mut grain.material));
        bodies.iter_mut().for_each(|body| renamed(&mut body.material));
        walls.iter_mut().for_each(|wall| renamed(&mut wall.material));
        Ok(kept)
    }

    /// Name of a material, by place in the file.
    pub(super) fn material_name(&self, place: usize) -> &str {
        self.file.materials.get_index(place).map_or("", |(name, _)| name.as_str())
    }

    /// What each material is made of, where the file says so.
    pub(super) fn deformable(&self) -> Result<Vec<Option<Deformable>>, SceneError> {
        self.file.materials.iter().map(|(name, material)| self.moduli(name, material)).collect()
    }

    fn moduli(&self, name: &str, spec: &MaterialSpec) -> Result<Option<Deformable>, SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("materials.{name}.{part}");
        let asked = spec.constitutive.is_some() || spec.bulk_modulus.is_some() || spec.shear_modulus.is_some();
        let (bulk_modulus, shear_modulus) =
            match (spec.bulk_modulus, spec.shear_modulus, spec.young_modulus, spec.poisson_ratio) {
                (Some(bulk), Some(shear), None, None) => {
                    let modulus = "modulus (Pa)";
                    let bulk = check.positive(&key("bulk_modulus"), bulk, modulus)?;
                    (bulk, check.positive(&key("shear_modulus"), shear, modulus)?)
                }
                (None, None, Some(young), Some(poisson)) => {
                    if !(young > 0.0 && young.is_finite() && poisson > -1.0 && poisson < 0.5) {
                        let expected = "a positive `young_modulus` and a `poisson_ratio` above −1 and below 1/2";
                        let found = format!("{young} and {poisson}");
                        // Laws of contacts judge these numbers themselves where no body is to deform.
                        return if asked {
                            Err(check.error(&key("young_modulus"), expected, &found))
                        } else {
                            Ok(None)
                        };
                    }
                    (young / (3.0 * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson)))
                }
                _ if asked => {
                    let expected = "`young_modulus` and `poisson_ratio`, or `bulk_modulus` and `shear_modulus`";
                    return Err(check.error(&format!("materials.{name}"), expected, "another choice of them"));
                }
                _ => return Ok(None),
            };
        let constitutive = match spec.constitutive.unwrap_or(ConstitutiveKind::NeoHookean) {
            ConstitutiveKind::NeoHookean => Constitutive::NeoHookean,
            ConstitutiveKind::Hypoelastic => Constitutive::Hypoelastic,
            ConstitutiveKind::VonMises => {
                let Some(yield_stress) = spec.yield_stress else {
                    return Err(check.error(&format!("materials.{name}"), "the key `yield_stress`", "none"));
                };
                let hardening = spec.hardening_modulus.unwrap_or(0.0);
                Constitutive::VonMises {
                    yield_stress: check.positive(&key("yield_stress"), yield_stress, "stress (Pa)")?,
                    hardening_modulus: check.not_negative(&key("hardening_modulus"), hardening, "modulus (Pa)")?,
                }
            }
        };
        Ok(Some(Deformable { bulk_modulus, shear_modulus, constitutive }))
    }
}
