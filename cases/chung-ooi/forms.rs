//! Closed forms of an impact whose contact slides throughout, and of a dashpot that never pulls.

use super::{impact, law};
use crate::exact::dashpot::{no_tension_ratio, no_tension_restitution};
use grainbench_harness::prelude::*;

/// Impact parameters of the first grain of a scene against the second grain or the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct ImpactParameters {
    /// Slip velocity of the first grain's surface on the partner, s = v_a − ω_a R_a − v_b − ω_b R_b, along x (m/s).
    pub(super) slip: f64,
    /// Impulse m* v_n that stops the approach (N s).
    pub(super) stopping: f64,
    /// Friction coefficient μ.
    pub(super) friction: f64,
    /// Coefficient of restitution e of a contact that ends when the overlap is zero.
    pub(super) restitution: f64,
    /// Coefficient of restitution e′ of a contact that ends as soon as its force is zero.
    pub(super) early: f64,
    /// ρ = 6 G* s/(μ E* v_n): growth rate of the tangential spring force over the rate of the spring's limit.
    pub(super) steepness: f64,
}

/// Returns e = exp(−πζ/√(1−ζ²)) of a contact that ends when the overlap is zero.
pub(super) fn restitution(ratio: f64) -> f64 {
    (-PI * ratio / (1.0 - ratio * ratio).sqrt()).exp()
}

impl ImpactParameters {
    /// Reads the parameters from a scene.
    pub(super) fn from_scene(scene: &Scene) -> Self {
        let first = &scene.grains[0];
        let own = first.velocity.x - first.spin.y * first.radius;
        let other = scene.grains.get(1).map_or(0.0, |second| second.velocity.x + second.spin.y * second.radius);
        let (_, mass, speed) = impact(scene);
        let law = law(scene);
        let steepness = 6.0 * law.effective_shear_modulus() * (own - other).abs()
            / (law.friction * law.effective_modulus() * speed);
        Self {
            slip: own - other,
            stopping: mass * speed,
            friction: law.friction,
            restitution: restitution(law.damping_ratio),
            early: no_tension_restitution(law.damping_ratio),
            steepness,
        }
    }

    /// Returns the part of the friction impulse, in units of μ m* v_n, that is lost because the contact sticks at
    /// first: 2ζ²/(2ρ/3 − 1) (derivation). This assumes that the limit applies to spring and dashpot, that ζ gives e
    /// with a release at zero force, and that the tangential spring is incremental. Increments k_s Δs give 2/3 of the
    /// force k_s s, because k_s grows with √δ.
    pub(super) fn latest_start(&self) -> f64 {
        2.0 * no_tension_ratio(self.restitution).powi(2) / (2.0 / 3.0 * self.steepness - 1.0)
    }

    /// Returns the impulse of friction on the first grain (N s), opposite to the slip: μ times `factor` times the
    /// impulse that stops the approach. The factor is 1 + e if the Coulomb limit uses the spring force. It is also
    /// 1 + e if the limit uses a total force that never pulls and gives the restitution e.
    pub(super) fn impulse(&self, factor: f64) -> f64 {
        -self.slip.signum() * self.friction * factor * self.stopping
    }

    /// Returns velocity along x (m/s) and spin (rad/s) of the first grain after [`Self::impulse`] at the distance R.
    pub(super) fn after(&self, scene: &Scene, factor: f64) -> [f64; 2] {
        let (grain, impulse) = (&scene.grains[0], self.impulse(factor));
        [grain.velocity.x + impulse / grain.mass, grain.spin.y - impulse * grain.radius / grain.inertia]
    }
}

/// Velocity along x and spin of the first grain, each with its name, unit and column.
pub(super) const ALONG_AND_SPIN: [(&str, &str, &str); 2] =
    [("velocity along the contact", "m/s", "a.vx"), ("spin", "rad/s", "a.omega_y")];

/// Compares a quantity of [`ALONG_AND_SPIN`] with [`ImpactParameters::after`], in units of its change.
pub(super) fn change(done: &FinishedRun, at: usize, factor: f64) -> Result<Measurement, MissingData> {
    let scene = &done.scene;
    let after = ImpactParameters::from_scene(scene).after(scene, factor)[at];
    let before = [scene.grains[0].velocity.x, scene.grains[0].spin.y][at];
    Ok(Measurement::new(done.last(ALONG_AND_SPIN[at].2)?, after, (after - before).abs()))
}
