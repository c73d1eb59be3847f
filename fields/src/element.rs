//! Granular elements: contents of the cells of a grid, with the same definition for grains and for material points
//! (Rycroft, Kamrin and Bazant 2009, §3).

use crate::contact_stress::{Stress, contact_stress};
use crate::grid::Grid;
use crate::motion::{Motion, motion, movers};
use crate::packing::packing_fraction;
use crate::tensor;
use grainbench_scene::file::GrainShape;
use grainbench_scene::record::Snapshot;
use grainbench_scene::scene::Dimension;
use nalgebra::{Matrix3, Vector3};

/// Contents of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element {
    /// Fraction of the cell volume that grains or material fill.
    pub packing_fraction: f64,
    /// Stress T (Pa), negative in compression; `None` if contacts are unknown.
    pub stress: Option<Matrix3<f64>>,
    /// Mean velocity and its gradient.
    pub motion: Motion,
    /// Number of axes.
    pub dimension: usize,
}

impl Element {
    /// Returns the pressure p (Pa); `None` if the stress is unknown.
    #[must_use]
    pub fn pressure(&self) -> Option<f64> {
        self.stress.map(|stress| tensor::pressure(&stress, self.dimension))
    }

    /// Returns the Mohr–Coulomb sin φ, or `None` without pressure.
    #[must_use]
    pub fn sine_of_friction(&self) -> Option<f64> {
        self.under_pressure().map(|stress| tensor::sine_of_friction(&stress, self.dimension))
    }

    /// Returns the Drucker–Prager ratio, or `None` without pressure.
    #[must_use]
    pub fn drucker_prager(&self) -> Option<f64> {
        self.under_pressure().map(|stress| tensor::drucker_prager(&stress, self.dimension))
    }

    fn under_pressure(&self) -> Option<Matrix3<f64>> {
        self.stress.filter(|stress| tensor::pressure(stress, self.dimension) > 0.0)
    }

    /// Returns |D₀| (1/s): the Frobenius norm of the deviator of D = (L + Lᵀ)/2.
    #[must_use]
    pub fn shear_rate(&self) -> Option<f64> {
        let rate = self.motion.gradient?.symmetric_part();
        Some(tensor::deviator(&rate, self.dimension).norm())
    }

    /// Returns |I₀| = |D₀| d √(ρ/p) for grains of diameter d (m) and density ρ (kg/m³), or `None` without pressure.
    ///
    /// For a simple shear of rate γ̇, |D₀| = γ̇/√2, so that the usual I is √2 |I₀|.
    #[must_use]
    pub fn inertial_number(&self, diameter: f64, density: f64) -> Option<f64> {
        let pressure = self.pressure().filter(|&pressure| pressure > 0.0)?;
        Some(self.shear_rate()? * diameter * (density / pressure).sqrt())
    }

    /// Returns the angles between the axes of the stress and of D, with the rotation in the plane of two axes.
    #[must_use]
    pub fn coaxiality(&self, plane: [usize; 2]) -> Option<tensor::Coaxiality> {
        tensor::coaxiality(&self.stress?, &self.motion.gradient?.symmetric_part(), self.dimension, plane)
    }
}

/// Computes the cells of a snapshot in the order of [`Grid::place`], from material points if there are any, else from
/// grains.
#[must_use]
pub fn elements(snapshot: &Snapshot, space: Dimension, grid: &Grid) -> Vec<Element> {
    elements_moving(snapshot, motion(&movers(snapshot), space.count(), grid), Stress::Instant, space, grid)
}

/// Computes the cells from a given motion, such as one between two snapshots, and a given kind of stress.
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

/// Returns the mean diameter (m) and mean density (kg/m³; kg/m² for discs) of the grains of a snapshot.
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

/// Returns the sum of x⊗F over all cells, ΣV T (J). It is equal for all grids that contain all centres.
#[must_use]
pub fn whole_stress(elements: &[Element], grid: &Grid) -> Option<Matrix3<f64>> {
    let weighted_stress = |element: &Element| element.stress.map(|stress| stress * grid.volume());
    elements.iter().map(weighted_stress).sum()
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

/// Interpolates a quantity linearly between the centres of the surrounding cells with a value.
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
            // Beyond the outermost centres the outermost cell is used.
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
