//! Settings of rapier that a scene does not define.

/// Settings of rapier. The default values are those of rapier, and tests change them to study their influence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// True if a contact that has moved little keeps its contact points from an earlier step.
    ///
    /// True is rapier's default. Contacts whose coefficients are set by a hook never keep their contact points.
    pub recycling: bool,
    /// Natural frequency (Hz) of the correction towards zero overlap between two grains.
    pub frequency: f64,
    /// Natural frequency (Hz) of the correction towards zero overlap between a grain and a fixed wall.
    pub wall_frequency: f64,
    /// Damping ratio of both corrections towards zero overlap.
    pub damping_ratio: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { recycling: true, frequency: 30.0, wall_frequency: 60.0, damping_ratio: 10.0 }
    }
}
