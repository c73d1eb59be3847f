//! Materials of grains, bodies and walls: keys in the scene file, and the resolved moduli and constitutive laws.
//!
//! A new constitutive law needs a variant of [`Constitutive`], a name and keys in this module.
//! `solvers/mpm/src/material/laws.rs` computes the stress.

use crate::check::Checker;
use crate::error::SceneError;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Material: density, elastic moduli and constitutive law.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct MaterialSpec {
    /// Density ρ (kg/m³). Required, except for materials that only walls have, and for grains with masses from a state
    /// or data file.
    pub density: Option<f64>,
    /// Young's modulus E (Pa). Required for Hertz contacts unless `rigid` is true. With `poisson_ratio`, it also gives
    /// the elastic moduli for solvers with deformable bodies.
    pub young_modulus: Option<f64>,
    /// Poisson's ratio ν, above −1 and at most 1/2; below 1/2 for deformable bodies. Required for Hertz contacts unless
    /// `rigid` is true.
    pub poisson_ratio: Option<f64>,
    /// If true, the material is rigid: in a Hertz contact, only the other material deforms. Default false.
    pub rigid: bool,
    /// Bulk modulus K (Pa) of deformable bodies. Give `bulk_modulus` and `shear_modulus`, or `young_modulus` and
    /// `poisson_ratio`.
    pub bulk_modulus: Option<f64>,
    /// Shear modulus G (Pa) of deformable bodies. Required with `bulk_modulus`.
    pub shear_modulus: Option<f64>,
    /// Constitutive law of a deformable material: `neo-hookean` (the default), `kelvin-voigt`, `hypoelastic` or
    /// `von-mises`.
    pub constitutive: Option<ConstitutiveKind>,
    /// Yield stress Y (Pa). Required for `von-mises`.
    pub yield_stress: Option<f64>,
    /// Hardening modulus H (Pa) of `von-mises`. Default 0.
    pub hardening_modulus: Option<f64>,
    /// Shear viscosity η (Pa s). Required for `kelvin-voigt`.
    pub viscosity: Option<f64>,
    /// Bulk viscosity ζ (Pa s) of `kelvin-voigt`. Default 0.
    pub bulk_viscosity: Option<f64>,
}

impl MaterialSpec {
    /// Returns the moduli and the constitutive law of the material `name`; `None` if the file does not give them.
    ///
    /// # Errors
    /// When a number is out of range, or the moduli are incomplete.
    pub(crate) fn deformable(&self, name: &str, check: &Checker<'_>) -> Result<Option<Deformable>, SceneError> {
        let key = |part: &str| format!("materials.{name}.{part}");
        let asked = self.constitutive.is_some() || self.bulk_modulus.is_some() || self.shear_modulus.is_some();
        let (bulk_modulus, shear_modulus) =
            match (self.bulk_modulus, self.shear_modulus, self.young_modulus, self.poisson_ratio) {
                (Some(bulk), Some(shear), None, None) => {
                    let modulus = "modulus (Pa)";
                    let bulk = check.positive(&key("bulk_modulus"), bulk, modulus)?;
                    (bulk, check.positive(&key("shear_modulus"), shear, modulus)?)
                }
                (None, None, Some(young), Some(poisson)) => {
                    if !(young > 0.0 && young.is_finite() && poisson > -1.0 && poisson < 0.5) {
                        let expected = "a positive `young_modulus` and a `poisson_ratio` above −1 and below 1/2";
                        let found = format!("{young} and {poisson}");
                        // If no key of a deformable body is given, only contact laws use these numbers, and the contact
                        // laws check them.
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
                    return Err(check.error(&format!("materials.{name}"), expected, "another combination"));
                }
                _ => return Ok(None),
            };
        let kind = self.constitutive.unwrap_or(ConstitutiveKind::NeoHookean);
        self.refuse_keys_of_other_laws(kind, name, check)?;
        let constitutive = match kind {
            ConstitutiveKind::NeoHookean => Constitutive::NeoHookean,
            ConstitutiveKind::KelvinVoigt => {
                let Some(viscosity) = self.viscosity else {
                    return Err(check.error(&format!("materials.{name}"), "the key `viscosity`", "none"));
                };
                let bulk = self.bulk_viscosity.unwrap_or(0.0);
                Constitutive::KelvinVoigt {
                    viscosity: check.not_negative(&key("viscosity"), viscosity, "viscosity (Pa s)")?,
                    bulk_viscosity: check.not_negative(&key("bulk_viscosity"), bulk, "viscosity (Pa s)")?,
                }
            }
            ConstitutiveKind::Hypoelastic => Constitutive::Hypoelastic,
            ConstitutiveKind::VonMises => {
                let Some(yield_stress) = self.yield_stress else {
                    return Err(check.error(&format!("materials.{name}"), "the key `yield_stress`", "none"));
                };
                let hardening = self.hardening_modulus.unwrap_or(0.0);
                Constitutive::VonMises {
                    yield_stress: check.positive(&key("yield_stress"), yield_stress, "stress (Pa)")?,
                    hardening_modulus: check.not_negative(&key("hardening_modulus"), hardening, "modulus (Pa)")?,
                }
            }
        };
        Ok(Some(Deformable { bulk_modulus, shear_modulus, constitutive }))
    }

    /// Rejects a key that the constitutive law does not use, instead of ignoring it.
    fn refuse_keys_of_other_laws(
        &self,
        kind: ConstitutiveKind,
        name: &str,
        check: &Checker<'_>,
    ) -> Result<(), SceneError> {
        let keys_of_laws = [
            ("viscosity", self.viscosity, ConstitutiveKind::KelvinVoigt),
            ("bulk_viscosity", self.bulk_viscosity, ConstitutiveKind::KelvinVoigt),
            ("yield_stress", self.yield_stress, ConstitutiveKind::VonMises),
            ("hardening_modulus", self.hardening_modulus, ConstitutiveKind::VonMises),
        ];
        keys_of_laws.into_iter().try_for_each(|(part, value, law)| {
            let (key, expected) = (format!("materials.{name}.{part}"), format!("`constitutive = \"{law}\"` beside it"));
            check.require(value.is_none() || law == kind, &key, &expected, format_args!("`{kind}`"))
        })
    }
}

/// Constitutive law of a deformable material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ConstitutiveKind {
    /// Hypoelastic law: the Jaumann rate of the Cauchy stress is linear in the rate of deformation.
    Hypoelastic,
    /// Compressible neo-Hookean law: Kirchhoff stress τ = λ (ln J) 1 + G (b − 1), with J = det F, b = F Fᵀ, the
    /// deformation gradient F and the unit tensor 1.
    NeoHookean,
    /// Neo-Hookean stress plus a viscous stress 2η dev D + ζ (tr D) 1, with the rate of deformation D (1/s).
    KelvinVoigt,
    /// Hypoelastic law up to the von Mises yield stress, then plastic flow with linear isotropic hardening.
    VonMises,
}

impl std::fmt::Display for ConstitutiveKind {
    /// Prints the name used in scene files.
    fn fmt(&self, text: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        text.write_str(match self {
            Self::Hypoelastic => "hypoelastic",
            Self::NeoHookean => "neo-hookean",
            Self::KelvinVoigt => "kelvin-voigt",
            Self::VonMises => "von-mises",
        })
    }
}

/// Constitutive law with its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "constitutive", rename_all = "kebab-case")]
pub enum Constitutive {
    /// Hypoelastic law: the Jaumann rate of the Cauchy stress is linear in the rate of deformation.
    Hypoelastic,
    /// Compressible neo-Hookean law: Kirchhoff stress τ = λ (ln J) 1 + G (b − 1), with λ = K − 2G/3, J = det F, b = F
    /// Fᵀ, the deformation gradient F and the unit tensor 1.
    NeoHookean,
    /// Neo-Hookean stress plus a viscous stress 2η dev D + ζ (tr D) 1, with the rate of deformation D (1/s).
    KelvinVoigt {
        /// Shear viscosity η (Pa s).
        viscosity: f64,
        /// Bulk viscosity ζ (Pa s).
        bulk_viscosity: f64,
    },
    /// Hypoelastic law up to the von Mises yield stress, then plastic flow with linear isotropic hardening.
    VonMises {
        /// Yield stress Y (Pa).
        yield_stress: f64,
        /// Hardening modulus H (Pa): the increase of the yield stress per unit of plastic strain.
        hardening_modulus: f64,
    },
}

impl Constitutive {
    /// Returns the kind of the law.
    #[must_use]
    pub const fn kind(&self) -> ConstitutiveKind {
        match self {
            Self::Hypoelastic => ConstitutiveKind::Hypoelastic,
            Self::NeoHookean => ConstitutiveKind::NeoHookean,
            Self::KelvinVoigt { .. } => ConstitutiveKind::KelvinVoigt,
            Self::VonMises { .. } => ConstitutiveKind::VonMises,
        }
    }

    /// Returns the initial yield stress (Pa); `None` if the material never yields.
    #[must_use]
    pub const fn yield_stress(&self) -> Option<f64> {
        match *self {
            Self::VonMises { yield_stress, .. } => Some(yield_stress),
            Self::Hypoelastic | Self::NeoHookean | Self::KelvinVoigt { .. } => None,
        }
    }

    /// Returns the shear and bulk viscosities η and ζ (Pa s); `None` if the law has no viscosity or both are zero.
    #[must_use]
    pub fn viscosities(&self) -> Option<[f64; 2]> {
        match *self {
            Self::KelvinVoigt { viscosity, bulk_viscosity } if viscosity + bulk_viscosity > 0.0 => {
                Some([viscosity, bulk_viscosity])
            }
            _ => None,
        }
    }
}

/// Elastic moduli and constitutive law of a deformable material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deformable {
    /// Bulk modulus K (Pa).
    pub bulk_modulus: f64,
    /// Shear modulus G (Pa).
    pub shear_modulus: f64,
    /// Constitutive law.
    pub constitutive: Constitutive,
}

impl Deformable {
    /// Returns Lamé's λ = K − 2G/3 (Pa).
    #[must_use]
    pub fn lame(&self) -> f64 {
        self.bulk_modulus - 2.0 / 3.0 * self.shear_modulus
    }

    /// Returns the modulus M = K + 4G/3 of longitudinal waves (Pa). The wave speed is √(M/ρ).
    #[must_use]
    pub fn longitudinal_modulus(&self) -> f64 {
        self.bulk_modulus + 4.0 / 3.0 * self.shear_modulus
    }

    /// Returns the viscosity 4η/3 + ζ of longitudinal waves (Pa s).
    #[must_use]
    pub fn longitudinal_viscosity(&self) -> f64 {
        self.constitutive.viscosities().map_or(0.0, |[shear, bulk]| 4.0 / 3.0 * shear + bulk)
    }

    /// Returns Poisson's ratio ν = (3K − 2G)/(6K + 2G).
    #[must_use]
    pub fn poisson_ratio(&self) -> f64 {
        let Self { bulk_modulus, shear_modulus, .. } = self;
        (3.0 * bulk_modulus - 2.0 * shear_modulus) / (6.0 * bulk_modulus + 2.0 * shear_modulus)
    }

    /// Returns Young's modulus in plane strain (Pa), E' = E/(1 − ν²) = 4G (K + G/3)/(K + 4G/3).
    #[must_use]
    pub fn plane_modulus(&self) -> f64 {
        4.0 * self.shear_modulus * (self.bulk_modulus + self.shear_modulus / 3.0) / self.longitudinal_modulus()
    }
}
