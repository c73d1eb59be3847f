//! Settings of rapier that a scene does not define.

/// Settings of the method, with the defaults of rapier; tests change them to study their influence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// True if a contact that has moved little keeps its contact points from an earlier step.
    ///
    /// This is rapier's default, but it never applies to pairs whose coefficients are set by a hook.
    pub recycling: bool,
    /// Natural frequency (Hz) of the correction towards zero overlap between two grains.
    pub frequency: f64,
    /// Natural frequency (Hz) of the correction between a grain and a fixed wall.
    pub wall_frequency: f64,
    /// Damping ratio of the correction.
    pub damping_ratio: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { recycling: true, frequency: 30.0, wall_frequency: 60.0, damping_ratio: 10.0 }
    }
}
