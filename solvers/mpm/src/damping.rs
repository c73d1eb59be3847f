//! Mass-proportional damping.

/// What damping makes of a step: dv/dt = a − αv by the trapezoidal rule, v' = keep v + gain a.
///
/// It acts on the velocity and spin of every material point, as −αρv says, and not only on what nodes see of them:
/// motion of points against their neighbours that the grid does not show would go on for ever otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Damping {
    /// (1 − αΔt/2)/(1 + αΔt/2).
    pub(crate) keep: f64,
    /// Δt/(1 + αΔt/2) (s).
    pub(crate) gain: f64,
}

impl Damping {
    /// Of α (1/s) over a step (s).
    pub(crate) fn over(alpha: f64, time_step: f64) -> Self {
        let half = 0.5 * alpha * time_step;
        Self { keep: (1.0 - half) / (1.0 + half), gain: time_step / (1.0 + half) }
    }
}
