//! Grain of a data file.

/// Grain of a LAMMPS data file with `atom_style sphere` or a LIGGGHTS data file with `atom_style granular`.
///
/// Numbers are in the units of the file. A data file does not name its units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Atom {
    /// Id of the grain, at least 1 and unique in its file.
    pub id: u32,
    /// Type of the grain, counted from 1.
    pub type_: u32,
    /// Diameter, positive.
    pub diameter: f64,
    /// Density of a sphere with this diameter, in two dimensions too. See [`Atom::mass`].
    pub density: f64,
    /// Position of the centre, which may be outside the box.
    pub position: [f64; 3],
    /// Number of crossings of each periodic boundary; zero if the file does not contain them.
    pub image: [i32; 3],
    /// Velocity of the centre; zero if the file has no section `Velocities`.
    pub velocity: [f64; 3],
    /// Angular velocity in radians per unit of time; zero if the file has no section `Velocities`.
    pub angular_velocity: [f64; 3],
}

impl Atom {
    /// Returns the mass of a sphere, (π/6) d³ ρ.
    ///
    /// LAMMPS reads the density in a data file as that of a sphere, even in two-dimensional simulations with discs.
    /// There, `fix nve/sphere disc` changes only the moment of inertia.
    ///
    /// LIGGGHTS with `dimension 2` uses the mass (π/4) d² ρ instead, so this function does not apply.
    #[must_use]
    pub fn mass(&self) -> f64 {
        std::f64::consts::PI / 6.0 * self.diameter.powi(3) * self.density
    }

    /// Returns the radius, half the diameter.
    #[must_use]
    pub fn radius(&self) -> f64 {
        0.5 * self.diameter
    }
}
