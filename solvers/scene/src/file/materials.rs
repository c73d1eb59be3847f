//! The keys of `materials`: what grains, bodies and walls are made of.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A material.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaterialSpec {
    /// Density ρ (kg/m³); not needed for materials of walls, nor where a data file gives it.
    #[serde(default)]
    pub density: Option<f64>,
    /// Young's modulus E (Pa); needed for Hertz contacts unless `rigid`. With Poisson's ratio it makes bodies
    /// deformable for solvers that resolve them.
    #[serde(default)]
    pub young_modulus: Option<f64>,
    /// Poisson's ratio ν, from −1 to 1/2; needed for Hertz contacts unless `rigid`.
    #[serde(default)]
    pub poisson_ratio: Option<f64>,
    /// Whether the material is rigid: its partner alone deforms in a Hertz contact.
    #[serde(default)]
    pub rigid: bool,
    /// Bulk modulus K (Pa), with `shear_modulus` in place of Young's modulus and Poisson's ratio.
    #[serde(default)]
    pub bulk_modulus: Option<f64>,
    /// Shear modulus G (Pa).
    #[serde(default)]
    pub shear_modulus: Option<f64>,
    /// Law of a deformable material: `neo-hookean` (the default), `hypoelastic` or `von-mises`.
    #[serde(default)]
    pub constitutive: Option<ConstitutiveKind>,
    /// Yield stress Y (Pa); needed for `von-mises`.
    #[serde(default)]
    pub yield_stress: Option<f64>,
    /// Hardening modulus H (Pa) of `von-mises`. Default 0.
    #[serde(default)]
    pub hardening_modulus: Option<f64>,
}

/// Law of a deformable material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ConstitutiveKind {
    /// The Jaumann rate of the stress is linear in the rate of deformation.
    Hypoelastic,
    /// Compressible: τ = λ ln J + G (b − 1).
    NeoHookean,
    /// Hypoelastic up to a yield stress, with linear isotropic hardening.
    VonMises,
}
