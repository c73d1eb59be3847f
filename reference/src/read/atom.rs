//! One grain of a data file.

/// A grain as a LAMMPS data file of `atom_style sphere`, or a LIGGGHTS one of `atom_style granular`, states it.
///
/// Numbers are in the units of the file; a data file does not say which these are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Atom {
    /// The grain's number in its file, 1 or more, used once.
    pub id: u32,
    /// The grain's type, counted from 1.
    pub type_: u32,
    /// Diameter, positive.
    pub diameter: f64,
    /// Density of the sphere of this diameter, in two dimensions too; see [`Atom::mass`].
    pub density: f64,
    /// Position of the centre. It may lie outside of the box.
    pub position: [f64; 3],
    /// How many times the grain has crossed each periodic boundary; zero where the file does not say.
    pub image: [i32; 3],
    /// Velocity of the centre; zero where the file has no `Velocities`.
    pub velocity: [f64; 3],
    /// Angular velocity, in radians per unit of time; zero where the file has no `Velocities`.
    pub angular_velocity: [f64; 3],
}

impl Atom {
    /// Mass: (π/6) d³ ρ, that of a sphere.
    ///
    /// LAMMPS reads the density of a data file as a sphere's even where the simulation has two dimensions and its
    /// integrator treats the grains as discs (`fix nve/sphere disc` changes the moment of inertia only).
    /// LIGGGHTS with `dimension 2` does not: there the mass is (π/4) d² ρ, which the caller has to know.
    #[must_use]
    pub fn mass(&self) -> f64 {
        std::f64::consts::PI / 6.0 * self.diameter.powi(3) * self.density
    }

    /// Radius, half the diameter.
    #[must_use]
    pub fn radius(&self) -> f64 {
        0.5 * self.diameter
    }
}
