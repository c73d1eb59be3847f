//! Deformable bodies other than grains, and their initial conditions.

use crate::manufactured::Manufactured;
use nalgebra::{Matrix3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Initial shape of a body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "BodyShape")]
pub enum BlockShape {
    /// Box along the axes.
    Box {
        /// Lower corner (m).
        #[schemars(with = "[f64; 3]")]
        low: Vector3<f64>,
        /// Upper corner (m).
        #[schemars(with = "[f64; 3]")]
        high: Vector3<f64>,
    },
    /// Ring in two dimensions.
    Annulus {
        /// Centre (m).
        #[schemars(with = "[f64; 3]")]
        centre: Vector3<f64>,
        /// Inner radius (m).
        inner: f64,
        /// Outer radius (m).
        outer: f64,
    },
}

impl BlockShape {
    /// Returns the corners of the bounding box (m).
    #[must_use]
    pub fn corners(&self) -> (Vector3<f64>, Vector3<f64>) {
        match *self {
            Self::Box { low, high } => (low, high),
            Self::Annulus { centre, outer, .. } => {
                let reach = Vector3::new(outer, outer, 0.0);
                (centre - reach, centre + reach)
            }
        }
    }

    /// Returns the volume (m³; m² in two dimensions).
    #[must_use]
    pub fn volume(&self, dimensions: usize) -> f64 {
        match self {
            Self::Box { low, high } => (0..dimensions).map(|axis| high[axis] - low[axis]).product(),
            Self::Annulus { inner, outer, .. } => std::f64::consts::PI * (outer * outer - inner * inner),
        }
    }

    /// Returns the centre (m).
    #[must_use]
    pub fn centre(&self) -> Vector3<f64> {
        match self {
            Self::Box { low, high } => (low + high) * 0.5,
            Self::Annulus { centre, .. } => *centre,
        }
    }

    /// Returns the distance of a position (m) outside the shape; zero or negative inside. For a box, it is the largest
    /// distance along one axis.
    #[must_use]
    pub fn outside(&self, at: Vector3<f64>, dimensions: usize) -> f64 {
        match self {
            Self::Box { low, high } => {
                let beyond = |axis: usize| (low[axis] - at[axis]).max(at[axis] - high[axis]);
                (0..dimensions).map(beyond).fold(f64::NEG_INFINITY, f64::max)
            }
            Self::Annulus { centre, inner, outer } => {
                let radius = (at - centre).norm();
                (inner - radius).max(radius - outer)
            }
        }
    }

    /// Returns the characteristic length (m): the shortest edge of a box, or the width of a ring.
    #[must_use]
    pub fn length(&self, dimensions: usize) -> f64 {
        match self {
            Self::Box { low, high } => (0..dimensions).map(|axis| high[axis] - low[axis]).fold(f64::INFINITY, f64::min),
            Self::Annulus { inner, outer, .. } => outer - inner,
        }
    }
}

/// Boundary conditions on the sides of a box. For each axis, the lower side comes first, then the upper side.
pub type Sides = [[Hold; 2]; 3];

/// Boundary condition on a side of a box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hold {
    /// Free to move.
    #[default]
    Free,
    /// Symmetry boundary: no motion along the normal of the side.
    Sliding,
    /// Fixed boundary: no motion.
    Fixed,
}

/// Initial velocity v₀ sin(β (x − x_low)) along x with β = (2n − 1)π/2L. It is mode n of a bar of length L that is
/// fixed at x_low, its end of smallest x.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(description = "Initial velocity wave v_x = v₀ sin(β (x − x_low)), with the lower side x_low of the body.")]
pub struct Wave {
    /// Amplitude v₀ (m/s).
    pub amplitude: f64,
    /// Wave number β (1/m).
    pub wave_number: f64,
}

/// Initial Cauchy stress (Pa, tension positive), which is a linear function of the position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialStress {
    /// Stress at the centre of the shape (Pa). In two dimensions, σ_zz = ν (σ_xx + σ_yy), as in plane strain.
    pub centre: Matrix3<f64>,
    /// Gradient of the stress along each axis (Pa/m).
    pub gradient: [Matrix3<f64>; 3],
}

impl InitialStress {
    /// Returns the stress (Pa) at a position relative to the centre of the shape (m).
    #[must_use]
    pub fn at(&self, arm: Vector3<f64>) -> Matrix3<f64> {
        self.gradient.iter().zip(arm.iter()).fold(self.centre, |sum, (gradient, way)| sum + gradient * *way)
    }
}

/// Deformable body other than a grain.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Name in the file.
    pub name: String,
    /// Index in [`crate::scene::Scene::materials`].
    pub material: u16,
    /// Density ρ (kg/m³).
    pub density: f64,
    /// Shape at the start.
    pub shape: BlockShape,
    /// Initial velocity of the centre of the shape (m/s).
    pub velocity: Vector3<f64>,
    /// Initial angular velocity ω about the centre c of the shape (rad/s). It adds ω × (x − c) to the velocity at x.
    pub spin: Vector3<f64>,
    /// Initial stretch rates aᵢ along the axes (1/s). They add aᵢ (xᵢ − cᵢ) to component i of the velocity at x.
    pub stretch: Vector3<f64>,
    /// Initial stress; `None` for zero stress or for the stress that [`Start::initial_pressure`] gives.
    pub stress: Option<InitialStress>,
    /// Boundary conditions on the sides.
    pub sides: Sides,
    /// Further initial velocity in the form of a wave along x.
    pub wave: Option<Wave>,
}

impl Block {
    /// Returns the initial velocity (m/s) at a position (m), without the wave.
    #[must_use]
    pub fn velocity_at(&self, place: Vector3<f64>) -> Vector3<f64> {
        let arm = place - self.shape.centre();
        self.velocity + self.spin.cross(&arm) + self.stretch.component_mul(&arm)
    }
}

/// Damped relaxation before the run, which starts with all bodies at rest. After the relaxation, the initial velocities
/// and spins are set, and time starts at zero.
// Gravity and damping then take the values of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Settle {
    /// Duration of the relaxation (s).
    pub duration: f64,
    /// Mass-proportional damping α during the relaxation (1/s).
    pub damping: f64,
    /// Gravity during the relaxation (m/s²).
    #[schemars(with = "[f64; 3]")]
    pub gravity: Vector3<f64>,
}

/// Initial stress of deformable bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum InitialPressure {
    /// Pressure p of a fluid at rest: ∇p = ρ g, with p = 0 at the highest point of each body.
    Hydrostatic,
}

/// Initial conditions of deformable bodies, and their body force other than gravity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Start {
    /// Damped relaxation before t = 0.
    pub settle: Option<Settle>,
    /// Initial stress.
    pub initial_pressure: Option<InitialPressure>,
    /// Body force that makes a chosen motion the exact solution.
    pub manufactured: Option<Manufactured>,
}

impl Start {
    /// Returns a description of a requested feature that only solvers for deformable bodies support; `None` if there is
    /// none.
    #[must_use]
    pub fn needs_deformable(&self) -> Option<&'static str> {
        let features = [
            (self.settle.is_some(), "a phase of settling before the clock starts"),
            (self.initial_pressure.is_some(), "an initial pressure inside bodies"),
            (self.manufactured.is_some(), "a manufactured body force"),
        ];
        features.into_iter().find_map(|(is_used, words)| is_used.then_some(words))
    }
}
