//! Mass-proportional damping.

/// Factors of damping in a step. The trapezoidal rule for dv/dt = a − αv gives v' = keep v + gain a.
///
/// The damping force −αρv acts on the velocity and spin of every material point, and not only on the part that nodes
/// represent. Otherwise relative motion of neighbouring points, which the grid does not resolve, would never decay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Damping {
    /// (1 − αΔt/2)/(1 + αΔt/2).
    pub(crate) keep: f64,
    /// Δt/(1 + αΔt/2) (s).
    pub(crate) gain: f64,
}

impl Damping {
    /// Computes the factors for a damping α (1/s) and a step of length `time_step` (s).
    pub(crate) fn over(alpha: f64, time_step: f64) -> Self {
        let half = 0.5 * alpha * time_step;
        Self { keep: (1.0 - half) / (1.0 + half), gain: time_step / (1.0 + half) }
    }
}
