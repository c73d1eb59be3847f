//! A grain as an elastic body on a plane: how it starts, and the change of stiffness that leads to the rigid answer;
//! and a disc that is pressed.

use crate::exact::one_grain::{OneGrain, last};
use grainbench_harness::prelude::*;
use grainbench_scene::body::Settle;
use grainbench_scene::scene::{Duration, Scene};
use std::f64::consts::PI;

/// A phase of settling: how long (s), and its mass-proportional damping (1/s).
#[derive(Clone, Copy, Debug)]
pub struct Rest {
    /// How long (s).
    pub duration: f64,
    /// Damping α (1/s).
    pub damping: f64,
}

/// The first grain touches its plane and comes to rest on it under the part of gravity that presses it there; the run
/// then lasts `time` (s).
pub fn settle(scene: &mut Scene, rest: Rest, time: f64) {
    let normal = scene.dimension.count() - 1;
    scene.grains[0].position[normal] = scene.grains[0].radius;
    let mut gravity = scene.gravity;
    for axis in 0..normal {
        gravity[axis] = 0.0;
    }
    scene.start.settle = Some(Settle { duration: rest.duration, damping: rest.damping, gravity });
    scene.duration = Duration::Seconds(time);
}

/// All moduli times a factor.
pub fn stiffen(scene: &mut Scene, factor: f64) {
    for material in scene.deformable.iter_mut().flatten() {
        material.bulk_modulus *= factor;
        material.shear_modulus *= factor;
    }
}

/// Displacement down an incline over that of a rigid grain, less one.
///
/// # Errors
/// Where the run has no grain.
pub(crate) fn excess(done: &Done) -> Result<f64, Missing> {
    let (t, state) = last(done)?;
    Ok(state.x / OneGrain::of(&done.scene).rigid_incline(t).x - 1.0)
}

/// An elastic disc in plane strain that is pressed at two opposite sides, or at four, without friction: how much its
/// diameter shortens.
///
/// δ/R = p [(2/π)(2 ln(4R/a) − 1) − s], p = F/(E'R), a² = 4pR²/π (Johnson, Contact Mechanics, §5.6: a cylinder between
/// two flats); s is zero between two flats, and with an equal pair across, which widens it, (4/π − 1) + ν/(1 − ν).
#[derive(Clone, Copy, Debug)]
pub struct Pressed {
    /// E' = E/(1 − ν²) (Pa).
    pub modulus: f64,
    /// Poisson's ratio ν.
    pub poisson: f64,
    /// Radius R (m).
    pub radius: f64,
    /// Two sides, or four.
    pub sides: u8,
}

impl Pressed {
    /// The first grain of a scene; none when it does not deform.
    #[must_use]
    pub fn of(scene: &Scene, sides: u8) -> Option<Self> {
        let disc = (*scene.deformable.first()?)?;
        let (bulk, shear) = (disc.bulk_modulus, disc.shear_modulus);
        let poisson = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear));
        Some(Self { modulus: disc.plane_modulus(), poisson, radius: scene.grains[0].radius, sides })
    }

    /// Shortening over p R under p.
    fn compliance(&self, p: f64) -> f64 {
        let widened = if self.sides == 4 { 4.0 / PI - 1.0 + self.poisson / (1.0 - self.poisson) } else { 0.0 };
        let patch = (4.0 * p / PI).sqrt();
        2.0 / PI * (2.0 * (4.0 / patch).ln() - 1.0) - widened
    }

    /// Force (N per metre) that shortens each diameter by `shortening` (m), by bisection.
    #[must_use]
    pub fn force(&self, shortening: f64) -> f64 {
        let (mut low, mut high) = (1e-12, 0.05);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if middle * self.compliance(middle) < shortening / self.radius { low = middle } else { high = middle }
        }
        low * self.modulus * self.radius
    }

    /// Stiffness of a diameter against a little more of a force (N/m per metre), dF/dδ: a ∝ √F takes 2/π off the
    /// compliance.
    #[must_use]
    pub fn stiffness(&self, force: f64) -> f64 {
        self.modulus / (self.compliance(force / (self.modulus * self.radius)) - 2.0 / PI)
    }
}

/// −Ai'(0): what of a front of width 1 has come before it is due.
pub(crate) const AHEAD: f64 = 0.258_819_403_792_806_8;

/// Width δ of a front after a way, in units of that of `cell` and `way`: δ³ = 3 (25/96) h² s, for a grid on which a wave's
/// frequency is lower by (25/96)(kh)² (derivations of `vibrating-bar` and `bar-impact`).
pub(crate) fn front(cell: f64, way: f64) -> f64 {
    (3.0 * 25.0 / 96.0 * cell * cell * way).cbrt()
}
