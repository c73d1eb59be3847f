//! Contact law between two materials: keys in the scene file, and the resolved law.
//!
//! A new law needs a variant of [`LawKind`], `SpringsKind` and [`Springs`], with its name, its keys and its stiffness.
//! Input decks and external programs that do not support the new law reject it by its kind.

use crate::check::Checker;
use crate::dimension::GrainShape;
use crate::error::SceneError;
use crate::material::MaterialSpec;
use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Kind of contact law: normal force and tangential spring.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LawKind {
    /// Linear normal and tangential springs of given stiffness.
    #[default]
    Linear,
    /// Hertz's law along the normal and Mindlin's spring along the tangent. The stiffness follows from E and ν of both
    /// materials. Spheres only.
    Hertz,
    /// Coulomb friction without springs, for solvers with deformable or rigid bodies.
    Coulomb,
}

/// Contact law between two materials. It has a spring and a dashpot along the normal, an incremental spring and a
/// dashpot along the tangent, and rolling resistance. Coulomb friction with cohesion c limits the tangential force F_s:
/// |F_s| ≤ F_n tan φ + c, with the normal force F_n.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactSpec {
    /// Names of the two materials, as in `materials`.
    pub between: [String; 2],
    /// Kind of the law: `linear` (the default), `hertz` or `coulomb`. All laws of a scene must be of one kind.
    #[serde(default)]
    pub law: LawKind,
    /// Normal stiffness k_n (N/m; N/m per metre of depth for discs). Required for linear laws.
    #[serde(default)]
    pub normal_stiffness: Option<f64>,
    /// Tangential stiffness k_s (N/m; N/m per metre of depth for discs). Required for linear laws with friction or
    /// cohesion. Default 0.
    #[serde(default)]
    pub tangential_stiffness: f64,
    /// Coefficient of friction μ = tan φ. Give at most one of `friction` and `friction_angle_deg`. Default 0.
    #[serde(default)]
    pub friction: Option<f64>,
    /// Angle of friction φ (degrees), from 0 to below 90. Default 0.
    #[serde(default)]
    pub friction_angle_deg: Option<f64>,
    /// Cohesion c (N): the largest tangential force at zero normal force. Default 0.
    #[serde(default)]
    pub cohesion: f64,
    /// Stiffness-proportional contact damping β (s), with the normal and tangential dashpots c_n = β k_n and c_s = β
    /// k_s (Cundall & Strack 1979). Not for Hertz contacts. Default 0.
    #[serde(default)]
    pub stiffness_damping: f64,
    /// Mass-proportional normal damping γ_n (1/s), with the dashpot c_n = γ_n m_eff. The effective mass m_eff is
    /// m₁m₂/(m₁+m₂) between grains, and m at a wall. Default 0.
    #[serde(default)]
    pub normal_damping: f64,
    /// Mass-proportional tangential damping γ_t (1/s), with the dashpot c_s = γ_t m_eff. Default 0.
    #[serde(default)]
    pub tangential_damping: f64,
    /// Coefficient of restitution e, above 0 and at most 1. It sets the damping ratio ζ of a normal dashpot: c_n =
    /// 2ζ√(k_n m_eff) in linear contacts, and c_n = 2√(5/6) ζ√(S m_eff) with S = dF/dδ in Hertz contacts. In `dem`, a
    /// contact ends when its force returns to zero, so that e = exp(−2ζ acos ζ/√(1 − ζ²)). In `dem:1979`, `dem:lammps`
    /// and `dem:liggghts`, a contact ends when its overlap returns to zero, so that e = exp(−πζ/√(1 − ζ²)). The
    /// simulated e has an error of first order in the time step, because the dashpot lags by half a step and the
    /// contact begins within a step. All dashpots of a contact act together: with a further dashpot, grains rebound
    /// more slowly. Default 1, without this dashpot.
    #[serde(default)]
    pub restitution: Option<f64>,
    /// Coefficient of rolling resistance μ_r. An elastic-plastic spring of stiffness k_r = 2.25 k_n μ_r² R_eff² exerts
    /// the moment against rolling (Ai et al. 2011, model C). The moment is at most μ_r R_eff F_n. The effective radius
    /// R_eff is R₁R₂/(R₁+R₂) between grains, and R at a wall. As in LIGGGHTS, the factor of spheres also holds for discs.
    /// Default 0.
    #[serde(default)]
    pub rolling_friction: f64,
    /// Damping ratio η_r of the rolling spring. Until the spring yields, the damping moment is −2η_r√(I_r k_r) times
    /// the rolling velocity (rad/s), with the moment of inertia I_r of the pair about the contact point. Default 0.
    #[serde(default)]
    pub rolling_damping: f64,
}

/// Resolved contact law between two materials. [`ContactSpec`] explains each number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactLaw {
    /// Normal and tangential springs.
    pub springs: Springs,
    /// Coefficient of friction tan φ.
    pub friction: f64,
    /// Cohesion c (N).
    pub cohesion: f64,
    /// Stiffness-proportional damping β (s); linear springs only.
    pub stiffness_damping: f64,
    /// Mass-proportional normal damping γ_n (1/s).
    pub normal_damping: f64,
    /// Mass-proportional tangential damping γ_t (1/s).
    pub tangential_damping: f64,
    /// Damping ratio ζ that gives the coefficient of restitution if the contact ends when its overlap returns to zero.
    pub damping_ratio: f64,
    /// Coefficient of rolling resistance μ_r.
    pub rolling_friction: f64,
    /// Damping ratio η_r of the rolling spring.
    pub rolling_damping: f64,
}

/// Kind of the springs of a law, with the names used in manifests and resolved scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SpringsKind {
    /// Coulomb friction without springs.
    Coulomb,
    /// Linear springs.
    Linear,
    /// Hertz's law along the normal and Mindlin's spring along the tangent.
    HertzMindlin,
}

impl SpringsKind {
    /// Returns the name used in manifests and resolved scenes.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Coulomb => "coulomb",
            Self::Linear => "linear",
            Self::HertzMindlin => "hertz-mindlin",
        }
    }
}

/// Springs of a contact law. They are serialised in the form that external solvers read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "law")]
pub enum Springs {
    /// Friction without springs, for solvers with deformable or rigid bodies.
    #[default]
    #[serde(rename = "coulomb")]
    Absent,
    /// Linear springs: normal force F_n = k_n δ at the overlap δ, and tangential stiffness k_s.
    #[serde(rename = "linear")]
    Linear {
        /// Normal stiffness k_n (N/m; N/m per metre of depth for discs).
        #[serde(rename = "normal_stiffness")]
        normal: f64,
        /// Tangential stiffness k_s (N/m; N/m per metre of depth for discs).
        #[serde(rename = "tangential_stiffness")]
        tangential: f64,
    },
    /// Hertz's normal force F_n = (4/3) E* √R* δ^{3/2} at the overlap δ, with R* = R₁R₂/(R₁+R₂), and Mindlin's
    /// tangential stiffness k_s = 8 G* √(R* δ).
    #[serde(rename = "hertz-mindlin")]
    Hertz {
        /// Effective modulus E* (Pa): 1/E* = (1−ν₁²)/E₁ + (1−ν₂²)/E₂.
        effective_modulus: f64,
        /// Effective shear modulus G* (Pa): 1/G* = (2−ν₁)/G₁ + (2−ν₂)/G₂.
        effective_shear_modulus: f64,
    },
}

impl Springs {
    /// Returns the kind of the springs.
    #[must_use]
    pub const fn kind(&self) -> SpringsKind {
        match self {
            Self::Absent => SpringsKind::Coulomb,
            Self::Linear { .. } => SpringsKind::Linear,
            Self::Hertz { .. } => SpringsKind::HertzMindlin,
        }
    }

    /// Returns the two stiffness constants: k_n and k_s (N/m), or E* and G* (Pa).
    #[must_use]
    pub const fn constants(&self) -> [f64; 2] {
        match *self {
            Self::Absent => [0.0; 2],
            Self::Linear { normal, tangential } => [normal, tangential],
            Self::Hertz { effective_modulus, effective_shear_modulus } => [effective_modulus, effective_shear_modulus],
        }
    }

    /// Returns the springs with their two constants multiplied by two factors.
    #[must_use]
    pub fn scaled(self, [first, second]: [f64; 2]) -> Self {
        match self {
            Self::Absent => Self::Absent,
            Self::Linear { normal, tangential } => {
                Self::Linear { normal: normal * first, tangential: tangential * second }
            }
            Self::Hertz { effective_modulus, effective_shear_modulus } => Self::Hertz {
                effective_modulus: effective_modulus * first,
                effective_shear_modulus: effective_shear_modulus * second,
            },
        }
    }

    /// Returns the normal and tangential stiffness dF/dδ (N/m) at an overlap δ (m), for an effective radius R* =
    /// R₁R₂/(R₁+R₂) (m). The stiffnesses are k_n and k_s for linear laws, and S = 2E*√(R*δ) and 8G*√(R*δ) for Hertz and
    /// Mindlin.
    #[must_use]
    pub fn stiffness(&self, overlap: f64, effective_radius: f64) -> (f64, f64) {
        let root = || (effective_radius * overlap).sqrt();
        match *self {
            Self::Absent => (0.0, 0.0),
            Self::Linear { normal, tangential } => (normal, tangential),
            Self::Hertz { effective_modulus, effective_shear_modulus } => {
                (2.0 * effective_modulus * root(), 8.0 * effective_shear_modulus * root())
            }
        }
    }

    /// Returns the secant stiffness F_n/δ (N/m) at an overlap (m), for an effective radius (m): k_n, or two thirds of
    /// dF/dδ for F_n ∝ δ^{3/2}.
    #[must_use]
    pub fn secant_stiffness(&self, overlap: f64, effective_radius: f64) -> f64 {
        let (tangent, _) = self.stiffness(overlap, effective_radius);
        match self {
            Self::Absent | Self::Linear { .. } => tangent,
            Self::Hertz { .. } => 2.0 / 3.0 * tangent,
        }
    }
}

impl ContactLaw {
    /// Returns the coefficient of restitution e = exp(−πζ/√(1 − ζ²)) that follows from the damping ratio ζ.
    #[must_use]
    pub fn restitution(&self) -> f64 {
        libm::exp(-PI * self.damping_ratio / (1.0 - self.damping_ratio * self.damping_ratio).sqrt())
    }

    /// Sets the damping ratio ζ = −ln e/√(π² + ln² e) for a coefficient of restitution e.
    pub fn set_restitution(&mut self, restitution: f64) {
        let log = libm::log(restitution);
        self.damping_ratio = -log / (PI * PI + log * log).sqrt();
    }

    /// Returns true if a tangential force can act, which needs friction or cohesion.
    #[must_use]
    pub fn has_friction(&self) -> bool {
        self.friction > 0.0 || self.cohesion > 0.0
    }

    /// Returns true if a dashpot acts along the normal or, with friction, along the tangent.
    #[must_use]
    pub fn has_damping(&self) -> bool {
        let tangential = self.has_friction() && self.tangential_damping != 0.0;
        self.stiffness_damping != 0.0 || self.normal_damping != 0.0 || self.damping_ratio != 0.0 || tangential
    }

    /// Returns true for Hertz's law.
    #[must_use]
    pub const fn is_hertz(&self) -> bool {
        matches!(self.springs, Springs::Hertz { .. })
    }

    /// Returns true if the law has springs. A law without springs only limits the tangential force.
    #[must_use]
    pub const fn has_stiffness(&self) -> bool {
        !matches!(self.springs, Springs::Absent)
    }

    /// Returns the stiffness k_n of a linear normal spring (N/m); zero in other laws.
    #[must_use]
    pub const fn normal_stiffness(&self) -> f64 {
        if let Springs::Linear { normal, .. } = self.springs { normal } else { 0.0 }
    }

    /// Returns the stiffness k_s of a linear tangential spring (N/m); zero in other laws.
    #[must_use]
    pub const fn tangential_stiffness(&self) -> f64 {
        if let Springs::Linear { tangential, .. } = self.springs { tangential } else { 0.0 }
    }

    /// Returns Hertz's effective modulus E* (Pa); zero in other laws.
    #[must_use]
    pub const fn effective_modulus(&self) -> f64 {
        if let Springs::Hertz { effective_modulus, .. } = self.springs { effective_modulus } else { 0.0 }
    }

    /// Returns Mindlin's effective shear modulus G* (Pa); zero in other laws.
    #[must_use]
    pub const fn effective_shear_modulus(&self) -> f64 {
        if let Springs::Hertz { effective_shear_modulus, .. } = self.springs { effective_shear_modulus } else { 0.0 }
    }

    /// Multiplies the normal stiffness of any law by a factor.
    pub fn scale_normal(&mut self, by: f64) {
        self.springs = self.springs.scaled([by, 1.0]);
    }

    /// Multiplies the tangential stiffness of any law by a factor.
    pub fn scale_tangential(&mut self, by: f64) {
        self.springs = self.springs.scaled([1.0, by]);
    }

    /// Returns text that identifies the law in fingerprints: every number with all its digits. The text of the
    /// existing laws must not change, because stored results are found by it.
    #[must_use]
    pub fn identity(&self) -> String {
        let moduli = [self.effective_modulus(), self.effective_shear_modulus()];
        let springs = [self.normal_stiffness(), self.tangential_stiffness(), moduli[0], moduli[1]];
        let dashpots = [self.stiffness_damping, self.normal_damping, self.tangential_damping, self.damping_ratio];
        let limits = [self.friction, self.cohesion, self.rolling_friction, self.rolling_damping];
        format!("{springs:?} {dashpots:?} {limits:?}")
    }
}

impl ContactSpec {
    /// Builds the law from the scene; `name` is its key in the table of contacts.
    pub(crate) fn law(
        &self,
        name: &str,
        check: &Checker<'_>,
        materials: &IndexMap<String, MaterialSpec>,
        grain_shape: GrainShape,
    ) -> Result<ContactLaw, SceneError> {
        let key = |part: &str| format!("contacts.{name}.{part}");
        let number = |part: &str, value: f64, unit: &str| check.not_negative(&key(part), value, unit);
        let friction = match (self.friction, self.friction_angle_deg) {
            (Some(_), Some(_)) => {
                return Err(check.error(&key("friction"), "one of `friction` and `friction_angle_deg`", "both"));
            }
            (Some(friction), None) => number("friction", friction, "coefficient of friction")?,
            (None, Some(angle)) => {
                let (key, is_valid) = (key("friction_angle_deg"), (0.0..90.0).contains(&angle));
                check.require(is_valid, &key, "an angle from 0 to below 90°", angle)?;
                libm::tan(angle.to_radians())
            }
            (None, None) => 0.0,
        };
        let restitution = self.restitution.unwrap_or(1.0);
        let is_valid = restitution > 0.0 && restitution <= 1.0;
        check.require(is_valid, &key("restitution"), "a coefficient above 0 and at most 1", restitution)?;
        let mut law = ContactLaw {
            springs: Springs::Absent,
            friction,
            cohesion: number("cohesion", self.cohesion, "force (N)")?,
            stiffness_damping: number("stiffness_damping", self.stiffness_damping, "time (s)")?,
            normal_damping: number("normal_damping", self.normal_damping, "rate (1/s)")?,
            tangential_damping: number("tangential_damping", self.tangential_damping, "rate (1/s)")?,
            damping_ratio: 0.0,
            rolling_friction: number("rolling_friction", self.rolling_friction, "coefficient")?,
            rolling_damping: number("rolling_damping", self.rolling_damping, "damping ratio")?,
        };
        law.set_restitution(restitution);
        let springs = match self.law {
            LawKind::Linear => self.linear(name, check, law.has_friction())?,
            LawKind::Hertz => self.hertz(name, check, materials, grain_shape)?,
            LawKind::Coulomb => {
                let expected = "no stiffness, because a `coulomb` contact has no spring";
                check.require(self.has_no_stiffness(), &key("normal_stiffness"), expected, "one")?;
                Springs::Absent
            }
        };
        Ok(ContactLaw { springs, ..law })
    }

    fn has_no_stiffness(&self) -> bool {
        self.normal_stiffness.is_none() && self.tangential_stiffness == 0.0
    }

    fn linear(&self, name: &str, check: &Checker<'_>, has_friction: bool) -> Result<Springs, SceneError> {
        let key = |part: &str| format!("contacts.{name}.{part}");
        let Some(stiffness) = self.normal_stiffness else {
            let help = "or `law = \"hertz\"`, whose stiffness comes from the moduli of the materials";
            let key = format!("contacts.{name}");
            return Err(check.source.error(&key, "the key `normal_stiffness`", "none", Some(help.to_owned())));
        };
        let normal = check.positive(&key("normal_stiffness"), stiffness, "stiffness (N/m)")?;
        let (key, tangential) = (key("tangential_stiffness"), self.tangential_stiffness);
        let tangential = if has_friction {
            check.positive(&key, tangential, "stiffness (N/m), because there is friction")?
        } else {
            check.not_negative(&key, tangential, "stiffness (N/m)")?
        };
        Ok(Springs::Linear { normal, tangential })
    }

    /// Builds Hertz springs. 1/E* and 1/G* are sums over both materials; a rigid material adds nothing.
    fn hertz(
        &self,
        name: &str,
        check: &Checker<'_>,
        materials: &IndexMap<String, MaterialSpec>,
        grain_shape: GrainShape,
    ) -> Result<Springs, SceneError> {
        let key = |part: &str| format!("contacts.{name}.{part}");
        let expected = "`linear` between discs, because Hertz's law is for spheres";
        check.require(grain_shape != GrainShape::Disc, &key("law"), expected, "`hertz`")?;
        let expected = "no stiffness, because a Hertz contact computes it from E and ν of the materials";
        check.require(self.has_no_stiffness(), &key("normal_stiffness"), expected, "one")?;
        let expected = "`normal_damping` or `restitution`, because the stiffness of a Hertz contact varies";
        let damping = self.stiffness_damping;
        check.require(damping == 0.0, &key("stiffness_damping"), expected, damping)?;
        let (mut compliance, mut shear_compliance) = (0.0, 0.0);
        for material in &self.between {
            let key_of = |part: &str| format!("materials.{material}.{part}");
            let properties = &materials[material.as_str()];
            if properties.rigid {
                continue;
            }
            let (Some(young), Some(poisson)) = (properties.young_modulus, properties.poisson_ratio) else {
                let expected = "`young_modulus` and `poisson_ratio` (or `rigid = true`), because the material has \
                                Hertz contacts";
                return Err(check.error(&format!("materials.{material}"), expected, "not both"));
            };
            check.positive(&key_of("young_modulus"), young, "modulus (Pa)")?;
            let is_valid = poisson > -1.0 && poisson <= 0.5;
            check.require(is_valid, &key_of("poisson_ratio"), "a ratio above −1 and at most 1/2", poisson)?;
            compliance += (1.0 - poisson * poisson) / young;
            shear_compliance += 2.0 * (2.0 - poisson) * (1.0 + poisson) / young;
        }
        let expected = "at least one material that is not rigid";
        check.require(compliance != 0.0, &key("between"), expected, "two rigid materials")?;
        Ok(Springs::Hertz { effective_modulus: 1.0 / compliance, effective_shear_modulus: 1.0 / shear_compliance })
    }
}
