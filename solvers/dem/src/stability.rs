//! Stable time steps of packings of equal grains and of contacts with dashpots.

use crate::contact::options::Options;
use crate::convention::Convention;
use crate::laws::damping_ratio;
use grainbench_scene::contact_law::{ContactLaw, SpringsKind};
use grainbench_scene::dimension::Dimension;
use grainbench_scene::scene::Scene;

/// Number of steps between two checks of the contact stiffness. A check costs about as much as a step. Lasting contacts
/// are always found. A collision at a tenth of the critical time step takes 11 to 20 steps, so a check can miss it.
const STEPS_BETWEEN_LOOKS: u64 = 32;

/// Critical time step of a scene.
pub(crate) struct CriticalStep {
    /// Critical time step 2√(m_min/k_max) of the scene (s).
    pub(crate) time_step: f64,
    /// True if the stiffness of contacts is checked against the time step.
    follows_contacts: bool,
}

impl CriticalStep {
    pub(crate) fn new(scene: &Scene) -> Self {
        Self { time_step: scene.critical_time_step(), follows_contacts: false }
    }

    /// Enables checks of contacts against the time step (s) during the run, unless unstable steps are allowed. They are
    /// needed only if the stiffness of contacts depends on the overlap (Hertz), or if the time step already exceeds the
    /// critical time step of the scene.
    pub(crate) fn follow_contacts(&mut self, scene: &Scene, time_step: f64, allow_unstable: bool) {
        let curved = scene.laws.iter().flatten().any(|law| law.springs.kind() == SpringsKind::HertzMindlin);
        self.follows_contacts = !allow_unstable && (curved || time_step > self.time_step);
    }

    /// Returns true if contacts are checked after this step.
    pub(crate) const fn is_checked_at(&self, step: u64) -> bool {
        self.follows_contacts && step % STEPS_BETWEEN_LOOKS == 1
    }

    /// Returns the advice for a run with this time step (s) that has failed.
    pub(crate) fn advice(&self, scene: &Scene, time_step: f64) -> String {
        let stable = stable_fraction(scene);
        if time_step / self.time_step > stable {
            let longest = stable * self.time_step;
            return format!(
                "{stable:.3} of the critical time step ({longest:.4e} s) is stable for any packing of equal grains"
            );
        }
        "the time step is stable for any packing of equal grains: check velocities, wall motion and initial overlaps"
            .to_owned()
    }
}

/// Returns a fraction f of the critical step `2√(m/k_n)` at which every packing of equal grains is stable.
///
/// The fraction follows from an upper bound of the largest frequency ω of a grain with `z` contacts, whose neighbours
/// move in the opposite direction: ω² ≤ z (k_n/m) (1 + κ(1 + mR²/I)) with κ = k_s/k_n. Hence
/// f = 2/(ω · 2√(m/k_n)) = 1/√(z(1 + κ(1 + mR²/I))), with z = 6 for discs and z = 12 for spheres. For the square lattice
/// (z = 4), the bound is exact at κ = 0 and κ = 1. If all grains spin equally, ω² = 2zκ (k_n/m) mR²/I, which is above the
/// bound for discs with κ > 1. A fraction f of 2√(m/k_s) is still stable there. Dashpots and rolling springs are not
/// included.
#[must_use]
pub fn stable_fraction(scene: &Scene) -> f64 {
    let contacts = match scene.dimension {
        Dimension::Two => 6.0,
        Dimension::Three => 12.0,
    };
    let ratio = |law: &ContactLaw| {
        let (normal, tangential) = law.springs.stiffness(1.0, 1.0);
        if law.has_friction() { tangential / normal } else { 0.0 }
    };
    let worst = scene.laws.iter().flatten().map(ratio).fold(0.0, f64::max);
    1.0 / (contacts * (1.0 + worst * (1.0 + 1.0 / scene.grain_shape.inertia_factor()))).sqrt()
}

/// Returns two time steps (s) for the normal motion at one linear contact: the largest stable step with its dashpot, and
/// the largest stable step without. The contact is the one with the smallest stable step. Both are infinite if no linear
/// contact has a normal dashpot. Tangential dashpots and Hertz contacts are not included.
///
/// The dashpot uses the velocity half a step earlier. In each step, the overlap is multiplied by λ, with λ² − (2 − θ² −
/// 2ζθ)λ + 1 − 2ζθ = 0, θ = ωΔt, ω² = k/m* and ζ = c/(2√(k m*)). Here k is the stiffness, c the viscosity and m* the
/// effective mass. The limit λ = −1 is reached at θ = 2(√(1 + ζ²) − ζ). For ζ = 3/4, this is 1, half of the limit 2
/// without damping.
#[must_use]
pub fn damped_step(scene: &Scene, convention: &Convention) -> (f64, f64) {
    let options = Options::from_convention(convention);
    // Masses of the two lightest grains of every material (kg).
    let mut lightest = vec![[f64::INFINITY; 2]; scene.materials.len()];
    for grain in &scene.grains {
        let [first, second] = &mut lightest[usize::from(grain.material)];
        if grain.mass < *first {
            (*first, *second) = (grain.mass, *first);
        } else {
            *second = second.min(grain.mass);
        }
    }
    let mut least = (f64::INFINITY, f64::INFINITY);
    let mut bear = |law: Option<&ContactLaw>, mass: f64| {
        let Some(law) = law.filter(|law| mass.is_finite() && mass > 0.0 && law.normal_stiffness() > 0.0) else {
            return;
        };
        let frequency = (law.normal_stiffness() / mass).sqrt();
        let ratio =
            0.5 * (law.stiffness_damping * frequency + law.normal_damping / frequency) + damping_ratio(law, &options);
        let step = 2.0 / frequency * ((1.0 + ratio * ratio).sqrt() - ratio);
        if ratio > 0.0 && step < least.0 {
            least = (step, 2.0 / frequency);
        }
    };
    for (a, &[first, second]) in lightest.iter().enumerate() {
        bear(scene.law(a as u16, a as u16), 1.0 / (1.0 / first + 1.0 / second));
        for (b, &[other, _]) in lightest.iter().enumerate().skip(a + 1) {
            bear(scene.law(a as u16, b as u16), 1.0 / (1.0 / first + 1.0 / other));
        }
        for wall in &scene.walls {
            bear(scene.law(a as u16, wall.material), first);
        }
    }
    least
}
