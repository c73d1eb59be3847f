//! Deformable bodies that are no grains, and how bodies start.

use crate::manufactured::Manufactured;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// Shape of a body that is no grain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BlockShape {
    /// A box along the axes.
    Box {
        /// Lower corner (m).
        low: Vector3<f64>,
        /// Upper corner (m).
        high: Vector3<f64>,
    },
    /// A ring, in the plane.
    Annulus {
        /// Centre (m).
        centre: Vector3<f64>,
        /// Inner radius (m).
        inner: f64,
        /// Outer radius (m).
        outer: f64,
    },
}

impl BlockShape {
    /// Corners of the box around it (m).
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

    /// Volume (m³; m² in the plane).
    #[must_use]
    pub fn volume(&self, dimensions: usize) -> f64 {
        match self {
            Self::Box { low, high } => (0..dimensions).map(|axis| high[axis] - low[axis]).product(),
            Self::Annulus { inner, outer, .. } => std::f64::consts::PI * (outer * outer - inner * inner),
        }
    }

    /// Middle (m).
    #[must_use]
    pub fn centre(&self) -> Vector3<f64> {
        match self {
            Self::Box { low, high } => (low + high) * 0.5,
            Self::Annulus { centre, .. } => *centre,
        }
    }

    /// How far outside of it a place is (m); not above zero where it is in it.
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

    /// Length that says how large it is: the shortest edge, or the width of the ring (m).
    #[must_use]
    pub fn length(&self, dimensions: usize) -> f64 {
        match self {
            Self::Box { low, high } => (0..dimensions).map(|axis| high[axis] - low[axis]).fold(f64::INFINITY, f64::min),
            Self::Annulus { inner, outer, .. } => outer - inner,
        }
    }
}

/// What the sides of a box may do, by axis: the lower side and the upper one.
pub type Sides = [[Hold; 2]; 3];

/// Whether a side of a box is held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hold {
    /// Free to move.
    #[default]
    Free,
    /// Kept from moving along the normal of the side.
    Sliding,
    /// Kept from moving at all.
    Fixed,
}

/// An initial velocity along x of v₀ sin(β (x − x_low)), β = (2n − 1)π/2L: mode n of a bar that is held at its lower
/// end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Amplitude v₀ (m/s).
    pub amplitude: f64,
    /// Wave number β (1/m).
    pub wave_number: f64,
}

/// A Cauchy stress that a body starts with, linear in the place (Pa, tension positive).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialStress {
    /// At the middle of its shape (Pa). In the plane the stress out of it is that of plane strain, ν (σ_xx + σ_yy).
    pub centre: Matrix3<f64>,
    /// What it gains along each axis (Pa/m).
    pub gradient: [Matrix3<f64>; 3],
}

impl InitialStress {
    /// The stress at a place, given by its way from the middle of the shape (m).
    #[must_use]
    pub fn at(&self, arm: Vector3<f64>) -> Matrix3<f64> {
        self.gradient.iter().zip(arm.iter()).fold(self.centre, |sum, (gradient, way)| sum + gradient * *way)
    }
}

/// A deformable body that is no grain.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    /// Name in the file.
    pub name: String,
    /// Place in [`crate::scene::Scene::materials`].
    pub material: u16,
    /// Density ρ (kg/m³).
    pub density: f64,
    /// Shape at the start.
    pub shape: BlockShape,
    /// Velocity (m/s).
    pub velocity: Vector3<f64>,
    /// Angular velocity ω about the middle of its shape (rad/s), on top of it: ω × (x − c).
    pub spin: Vector3<f64>,
    /// Rates of stretch a along the axes (1/s), on top of both: aᵢ (xᵢ − cᵢ).
    pub stretch: Vector3<f64>,
    /// Stress that it starts with, beside none.
    pub stress: Option<InitialStress>,
    /// Sides that are held.
    pub sides: Sides,
    /// A velocity on top of it that varies along x.
    pub wave: Option<Wave>,
}

impl Block {
    /// Its velocity at a place at the start (m/s), but for a wave.
    #[must_use]
    pub fn velocity_at(&self, place: Vector3<f64>) -> Vector3<f64> {
        let arm = place - self.shape.centre();
        self.velocity + self.spin.cross(&arm) + self.stretch.component_mul(&arm)
    }

    /// Gradient of that velocity (1/s), ∂vᵢ/∂xⱼ.
    #[must_use]
    pub fn velocity_gradient(&self) -> Matrix3<f64> {
        self.spin.cross_matrix() + Matrix3::from_diagonal(&self.stretch)
    }
}

/// A damped phase before the clock starts: bodies at rest come to equilibrium, then they are given their velocities and
/// spins and are released.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settle {
    /// How long (s).
    pub duration: f64,
    /// Mass-proportional damping α (1/s) meanwhile.
    pub damping: f64,
    /// Gravity meanwhile (m/s²).
    pub gravity: Vector3<f64>,
}

/// The stress that bodies start with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum InitialPressure {
    /// That of a fluid at rest: ∇p = ρ g, zero at the highest point of each body.
    Hydrostatic,
}

/// How deformable bodies start and what drives them, beside gravity and contacts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Start {
    /// A damped phase before the clock starts.
    pub settle: Option<Settle>,
    /// Stress at the start.
    pub initial_pressure: Option<InitialPressure>,
    /// A body force that makes a chosen motion the exact one.
    pub manufactured: Option<Manufactured>,
}

impl Start {
    /// What is asked for here, in words, for solvers that have no deformable bodies.
    #[must_use]
    pub fn needs_deformable(&self) -> Option<&'static str> {
        if self.settle.is_some() {
            Some("a phase of settling before the clock starts")
        } else if self.initial_pressure.is_some() {
            Some("an initial pressure inside bodies")
        } else if self.manufactured.is_some() {
            Some("a manufactured body force")
        } else {
            None
        }
    }
}
