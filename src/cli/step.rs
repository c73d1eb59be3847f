//! Options that set the time step.

use super::value::positive;
use grainbench::solver::resolution::Resolution;

/// Time step, as a fraction of the critical one or in seconds.
#[derive(clap::Args)]
pub(crate) struct Step {
    /// Time step as a fraction of the critical one, 2√(m_min/k_max).
    #[arg(
        long,
        value_name = "FRACTION",
        default_value_t = Resolution::FRACTION,
        value_parser = positive,
        allow_hyphen_values = true,
        conflicts_with = "time_step"
    )]
    time_step_fraction: f64,
    /// Time step in seconds.
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_hyphen_values = true)]
    time_step: Option<f64>,
}

impl Step {
    /// Returns true if the time step is the default fraction of the critical one.
    pub(crate) fn is_usual(&self) -> bool {
        self.resolution() == Resolution::CriticalFraction(Resolution::FRACTION)
    }

    /// Returns the time step as a resolution.
    pub(crate) fn resolution(&self) -> Resolution {
        self.time_step.map_or(Resolution::CriticalFraction(self.time_step_fraction), Resolution::TimeStep)
    }
}
