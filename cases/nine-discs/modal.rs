//! The nine discs without slip as two oscillators: static forces, the continuous solution and the discrete solution.

use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::scene::Scene;
use std::f64::consts::SQRT_2;

/// Duration of the walls' ramp, in units of √(m/k_n): 40 steps of a tenth of the critical time step.
pub(crate) const RAMP_TIME: f64 = 40.0 * 0.1 * 2.0;

/// Modal solution of one scene in closed form.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Modal {
    /// Ratio of tangential to normal stiffness, κ = k_s/k_n.
    pub(crate) kappa: f64,
    /// Normal stiffness divided by the mass, k_n/m (1/s²).
    pub(crate) rate: f64,
}

/// Inward displacements of the edge disc (a) and of the corner disc (b), as fractions of the wall travel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InwardDisplacements {
    pub(crate) edge: f64,
    pub(crate) corner: f64,
}

impl Modal {
    pub(crate) fn from_scene(scene: &Scene) -> Self {
        let law = law(scene);
        Self {
            kappa: if law.has_friction() { law.tangential_stiffness() / law.normal_stiffness() } else { 0.0 },
            rate: law.normal_stiffness() / scene.grains[0].mass,
        }
    }

    /// Returns the displacements at rest after compression.
    pub(crate) fn at_rest(&self) -> InwardDisplacements {
        let k = self.kappa;
        let below = 2.0 + 4.0 * k + k * k;
        InwardDisplacements { edge: (1.0 + 2.0 * k) / below, corner: (2.0 + 3.0 * k) / (2.0 * below) }
    }

    /// Returns the frequencies ω₋ and ω₊ of the two modes (rad/s).
    pub(crate) fn frequencies(&self) -> [f64; 2] {
        let k = self.kappa;
        [-1.0, 1.0].map(|sign| (self.rate * (2.0 + 2.0 * k + sign * SQRT_2 * k)).sqrt())
    }

    /// Returns both displacements when each mode is at a fraction of its static value.
    fn combine(&self, fractions: [f64; 2]) -> InwardDisplacements {
        let rest = self.at_rest();
        let slow = (rest.edge + SQRT_2 * rest.corner) * fractions[0];
        let fast = (rest.edge - SQRT_2 * rest.corner) * fractions[1];
        InwardDisplacements { edge: 0.5 * (slow + fast), corner: (slow - fast) / (2.0 * SQRT_2) }
    }

    /// Returns the continuous solution at t (s) for a ramp of duration `ramp` (s).
    pub(crate) fn continuous(&self, t: f64, ramp: f64) -> InwardDisplacements {
        self.combine(self.frequencies().map(|omega| {
            if t < ramp {
                t / ramp - (omega * t).sin() / (omega * ramp)
            } else {
                1.0 - 2.0 * (0.5 * omega * ramp).sin() / (omega * ramp) * (omega * (t - 0.5 * ramp)).cos()
            }
        }))
    }

    /// Returns the solution of the discrete calculation cycle, for a ramp of `ramp` cycles of `time_step` (s).
    pub(crate) fn discrete(&self, cycle: u64, ramp: u64, time_step: f64) -> InwardDisplacements {
        self.combine(self.frequencies().map(|omega| {
            let theta = 2.0 * (0.5 * omega * time_step).asin();
            let r = |n: f64| if n > 0.0 { n - (n * theta).sin() / theta.sin() } else { 0.0 };
            let (n, ramp) = (cycle as f64, ramp as f64);
            (r(n) - r(n - ramp)) / ramp
        }))
    }

    /// Returns the decay rate γ (1/s) of the slow mode in the calculation cycle after the walls have stopped. α is the
    /// global damping, β k the contact damping.
    /// A cycle changes velocity and position of a mode to
    /// `v' = [v(1 − αΔt/2) − ω²Δt(x + βv)]/(1 + αΔt/2)`, `x' = x + v'Δt`. The product of its eigenvalues is
    /// `(1 − αΔt/2 − βω²Δt)/(1 + αΔt/2) = exp(−2γΔt)`.
    pub(crate) fn decay(&self, scene: &Scene, time_step: f64) -> f64 {
        let (alpha, beta) = (scene.global_damping, law(scene).stiffness_damping);
        let omega = self.frequencies()[0];
        let half = 0.5 * alpha * time_step;
        -((1.0 - half - beta * omega * omega * time_step) / (1.0 + half)).ln() / (2.0 * time_step)
    }

    /// Returns the amplitude of the force between centre and edge after a ramp of `ramp` cycles, as a fraction of its
    /// static value. The amplitudes of both modes are added.
    pub(crate) fn residual(&self, ramp: u64, time_step: f64) -> f64 {
        let rest = self.at_rest();
        let parts = [rest.edge + SQRT_2 * rest.corner, rest.edge - SQRT_2 * rest.corner].map(|part| 0.5 * part);
        let amplitude = |part: f64, omega: f64| {
            let theta = 2.0 * (0.5 * omega * time_step).asin();
            let ramp = ramp as f64;
            (part * 2.0 * (0.5 * ramp * theta).sin() / (ramp * theta.sin())).abs()
        };
        let [slow, fast] = self.frequencies();
        (amplitude(parts[0], slow) + amplitude(parts[1], fast)) / rest.edge
    }
}

/// Returns the only contact law of the scene.
pub(crate) fn law(scene: &Scene) -> ContactLaw {
    scene.laws.iter().flatten().next().copied().unwrap_or_default()
}
