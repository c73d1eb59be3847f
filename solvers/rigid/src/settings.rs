//! What rapier lets one set and a scene does not say.

/// Settings of the method, at rapier's own values unless a test asks what one of them does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Whether a contact that has moved little keeps its points from an earlier step. rapier does so by default, but
    /// never for pairs whose coefficients a hook sets.
    pub recycling: bool,
    /// Natural frequency (Hz) of the pull towards zero overlap between two grains.
    pub frequency: f64,
    /// The same between a grain and a wall that does not move.
    pub wall_frequency: f64,
    /// Damping ratio of that pull.
    pub damping_ratio: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { recycling: true, frequency: 30.0, wall_frequency: 60.0, damping_ratio: 10.0 }
    }
}
