//! Granular elements: quantities of the cells of a grid, with the same definition for grains and for material points
//! (Rycroft, Kamrin and Bazant 2009, §3).

use crate::contact_stress::{Stress, contact_stress};
use crate::grid::Grid;
use crate::motion::{Motion, motion, movers};
use crate::packing::packing_fraction;
use crate::tensor;
use grainbench_scene::dimension::Dimension;
use grainbench_scene::dimension::GrainShape;
use grainbench_solver::record::Snapshot;
use nalgebra::{Matrix3, Vector3};

/// Quantities of one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element {
    /// Fraction of the cell volume that grains or material fill.
    pub packing_fraction: f64,
    /// Stress T (Pa), negative in compression; `None` if it is unknown.
    pub stress: Option<Matrix3<f64>>,
    /// Mean velocity and its gradient.
    pub motion: Motion,
    /// Dimension of space, 2 or 3.
    pub dimension: usize,
}

impl Element {
    /// Returns the pressure p (Pa); `None` if the stress is unknown.
    #[must_use]
    pub fn pressure(&self) -> Option<f64> {
        self.stress.map(|stress| tensor::pressure(&stress, self.dimension))
    }

    /// Returns the Mohr–Coulomb sin φ; `None` if the pressure is unknown or not positive.
    #[must_use]
    pub fn sine_of_friction(&self) -> Option<f64> {
        self.under_pressure().map(|stress| tensor::sine_of_friction(&stress, self.dimension))
    }

    /// Returns the Drucker–Prager ratio |T₀|/(√2 p) with the deviator T₀ of the stress; `None` if the pressure p is
    /// unknown or not positive.
    #[must_use]
    pub fn drucker_prager(&self) -> Option<f64> {
        self.under_pressure().map(|stress| tensor::drucker_prager(&stress, self.dimension))
    }

    fn under_pressure(&self) -> Option<Matrix3<f64>> {
        self.stress.filter(|stress| tensor::pressure(stress, self.dimension) > 0.0)
    }

    /// Returns |D₀| (1/s), the Frobenius norm of the deviator of the strain rate D = (L + Lᵀ)/2; `None` if the velocity
    /// gradient L is unknown.
    #[must_use]
    pub fn shear_rate(&self) -> Option<f64> {
        let rate = self.motion.gradient?.symmetric_part();
        Some(tensor::deviator(&rate, self.dimension).norm())
    }

    /// Returns the inertial number |I₀| = |D₀| d √(ρ/p) for grains of diameter d (m) and density ρ (kg/m³). Returns
    /// `None` if the pressure p is unknown or not positive, or if |D₀| is unknown.
    ///
    /// For a simple shear of rate γ̇, |D₀| = γ̇/√2, so the usual I is √2 |I₀|.
    #[must_use]
    pub fn inertial_number(&self, diameter: f64, density: f64) -> Option<f64> {
        let pressure = self.pressure().filter(|&pressure| pressure > 0.0)?;
        Some(self.shear_rate()? * diameter * (density / pressure).sqrt())
    }

    /// Returns the angles between the principal axes of the stress and of the strain rate D. `plane` contains the two
    /// axes (0 is x) of the plane for [`tensor::Coaxiality::in_plane`].
    #[must_use]
    pub fn coaxiality(&self, plane: [usize; 2]) -> Option<tensor::Coaxiality> {
        tensor::coaxiality(&self.stress?, &self.motion.gradient?.symmetric_part(), self.dimension, plane)
    }
}

/// Computes the elements of a snapshot in the order of [`Grid::place`]. If the snapshot has material points, the
/// elements are computed from these points, otherwise from the grains.
#[must_use]
pub fn elements(snapshot: &Snapshot, space: Dimension, grid: &Grid) -> Vec<Element> {
    elements_moving(snapshot, motion(&movers(snapshot), space.count(), grid), Stress::Instant, space, grid)
}

/// Computes the elements of a snapshot for a given kind of stress and a given motion of the cells, such as the motion
/// between two snapshots.
#[must_use]
pub fn elements_moving(
    snapshot: &Snapshot,
    motion: Vec<Motion>,
    stress: Stress,
    space: Dimension,
    grid: &Grid,
) -> Vec<Element> {
    let dimension = space.count();
    let stress = contact_stress(snapshot, dimension, grid, stress);
    let filled = packing_fraction(snapshot, space, grid);
    let element = |(cell, (motion, packing_fraction)): (usize, (Motion, f64))| Element {
        packing_fraction,
        stress: stress.as_ref().map(|stress| stress[cell]),
        motion,
        dimension,
    };
    motion.into_iter().zip(filled).enumerate().map(element).collect()
}

/// Returns the mean diameter (m) and mean density (kg/m³) of the grains of a snapshot. Discs are one metre deep.
///
/// All grains have equal weights. Returns `None` if there are no grains.
#[must_use]
pub fn mean_grain(snapshot: &Snapshot, space: Dimension) -> Option<(f64, f64)> {
    let grains = &snapshot.grains;
    let shape = match space {
        Dimension::Two => GrainShape::Disc,
        Dimension::Three => GrainShape::Sphere,
    };
    let sum = |(diameter, density): (f64, f64), (more, other): (f64, f64)| (diameter + more, density + other);
    let each = grains.iter().map(|grain| (2.0 * grain.radius, grain.mass / shape.mass(grain.radius, 1.0)));
    let (diameter, density) = each.fold((0.0, 0.0), sum);
    let count = grains.len() as f64;
    (count > 0.0).then_some((diameter / count, density / count))
}

/// Returns the mean velocity at a position (m/s), interpolated linearly between the centres of non-empty cells.
#[must_use]
pub fn velocity_at(
    elements: &[Element],
    grid: &Grid,
    periodic: [bool; 3],
    place: Vector3<f64>,
) -> Option<Vector3<f64>> {
    interpolated(grid, periodic, place, |cell| elements[cell].motion.velocity)
}

/// Interpolates a quantity linearly between the centres of the surrounding cells. Cells without a value do not count.
/// Returns `None` if no surrounding cell has a value.
#[must_use]
pub fn interpolated<T>(
    grid: &Grid,
    periodic: [bool; 3],
    place: Vector3<f64>,
    value_at: impl Fn(usize) -> Option<T>,
) -> Option<T>
where
    T: std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
{
    let mut lower = [0_i64; 3];
    let mut part = [0.0; 3];
    for axis in 0..3 {
        let along = (place[axis] - grid.low[axis]) / grid.cell[axis] - 0.5;
        (lower[axis], part[axis]) = (along.floor() as i64, along - along.floor());
    }
    let (mut sum, mut weights): (Option<T>, f64) = (None, 0.0);
    for corner in 0..8_usize {
        let (mut at, mut weight) = ([0; 3], 1.0);
        for axis in 0..3 {
            let upper = corner >> axis & 1 == 1;
            weight *= if upper { part[axis] } else { 1.0 - part[axis] };
            let count = grid.count[axis] as i64;
            let number = lower[axis] + i64::from(upper);
            // Beyond the outermost cell centres, the value of the outermost cell applies.
            at[axis] = if periodic[axis] { number.rem_euclid(count) } else { number.clamp(0, count - 1) } as usize;
        }
        let Some(value) = value_at(grid.place(at)).filter(|_| weight > 0.0) else { continue };
        weights += weight;
        let more = value * weight;
        sum = Some(match sum {
            Some(sum) => sum + more,
            None => more,
        });
    }
    sum.map(|sum| sum * (1.0 / weights))
}
