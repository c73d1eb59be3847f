//! Material points as a structure of arrays. They are grouped by body and sorted by cell within a body.

use grainbench_lanes::{Team, take_off};
use grainbench_solver::space::Space;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// All material points of a run.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct Points<S: Space> {
    /// Initial index, which identifies the point.
    pub(crate) id: Vec<u32>,
    /// Initial position (m).
    pub(crate) start: Vec<S::Vector>,
    /// Position (m).
    pub(crate) position: Vec<S::Vector>,
    /// Position at the end of the current step (m).
    pub(crate) next: Vec<S::Vector>,
    /// Velocity (m/s).
    pub(crate) velocity: Vec<S::Vector>,
    /// Affine part of the velocity (1/s); empty unless the transfer uses it.
    pub(crate) affine: Vec<S::Matrix>,
    /// Mass (kg).
    pub(crate) mass: Vec<f64>,
    /// Volume in the undeformed state (m³).
    pub(crate) reference_volume: Vec<f64>,
    /// Volume (m³).
    pub(crate) volume: Vec<f64>,
    /// Deformation gradient.
    pub(crate) deformation: Vec<S::Matrix>,
    /// Cauchy stress (Pa).
    pub(crate) stress: Vec<S::Symmetric>,
    /// Equivalent plastic strain; empty if no material yields.
    pub(crate) plastic_strain: Vec<f64>,
}

impl<S: Space> Points<S> {
    /// Memory of a point (bytes), without affine part and plastic strain.
    const BYTES: usize = size_of::<u32>()
        + 4 * size_of::<S::Vector>()
        + size_of::<S::Matrix>()
        + size_of::<S::Symmetric>()
        + 3 * size_of::<f64>();

    /// Returns the memory of all points (bytes).
    pub(crate) fn bytes(&self) -> usize {
        self.len() * Self::BYTES + size_of_val(&*self.affine) + size_of_val(&*self.plastic_strain)
    }

    pub(crate) fn len(&self) -> usize {
        self.position.len()
    }

    /// Returns the mass (kg) and centre of mass (m) of a range of points.
    pub(crate) fn centre_of_mass(&self, range: Range<usize>) -> (f64, Vector3<f64>) {
        let mut mass = 0.0;
        let mut moment = Vector3::zeros();
        for at in range {
            mass += self.mass[at];
            moment += S::embed(self.position[at]) * self.mass[at];
        }
        (mass, moment / mass)
    }

    /// Returns the gravitational potential energy of all points (J), relative to the origin. `gravity` is in m/s².
    pub(crate) fn gravitational_energy(&self, gravity: Vector3<f64>) -> f64 {
        (0..self.len()).map(|at| -self.mass[at] * gravity.dot(&S::embed(self.position[at]))).sum()
    }

    /// Returns the affine part of the velocity of a point (1/s); zero if there is none.
    pub(crate) fn affine_of(&self, at: usize) -> S::Matrix {
        self.affine.get(at).copied().unwrap_or(S::NO_GRADIENT)
    }

    /// Returns the equivalent plastic strain of a point; zero if nothing yields.
    pub(crate) fn plastic_strain_of(&self, at: usize) -> f64 {
        self.plastic_strain.get(at).copied().unwrap_or(0.0)
    }

    /// Adds an undeformed point at rest.
    pub(crate) fn push(&mut self, position: S::Vector, volume: f64, density: f64) {
        self.id.push(self.id.len() as u32);
        self.start.push(position);
        self.position.push(position);
        self.next.push(position);
        self.velocity.push(S::ORIGIN);
        self.mass.push(density * volume);
        self.reference_volume.push(volume);
        self.volume.push(volume);
        self.deformation.push(S::restrict_gradient(Matrix3::identity()));
        self.stress.push(S::Symmetric::default());
    }

    /// Returns true if all arrays are as long as those of `other`, including affine part and plastic strain.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        let count = other.len();
        let same = self.affine.len() == other.affine.len() && self.plastic_strain.len() == other.plastic_strain.len();
        same && [
            self.id.len(),
            self.start.len(),
            self.next.len(),
            self.position.len(),
            self.velocity.len(),
            self.mass.len(),
            self.reference_volume.len(),
            self.volume.len(),
            self.deformation.len(),
            self.stress.len(),
        ]
        .iter()
        .all(|&length| length == count)
    }

    /// Returns the permutation that sorts a body's points by `place`. Points with equal places keep their order.
    pub(crate) fn order(&self, range: Range<usize>, place: impl Fn(S::Vector) -> usize) -> Order {
        let places: Vec<usize> = self.position[range.clone()].iter().map(|&position| place(position)).collect();
        let low = places.iter().copied().min().unwrap_or(0);
        let high = places.iter().copied().max().unwrap_or(0);
        // Counting sort. `before` contains the number of points at lower places, which becomes the next free index of
        // each place.
        let mut before = vec![0; high - low + 2];
        places.iter().for_each(|place| before[place - low + 1] += 1);
        (1..before.len()).for_each(|place| before[place] += before[place - 1]);
        let mut numbers = vec![0; places.len()];
        for (place, at) in places.iter().zip(range.clone()) {
            let next = &mut before[place - low];
            numbers[*next] = at;
            *next += 1;
        }
        Order { range, numbers }
    }

    /// Applies permutations to the points of bodies. Each thread handles some of the arrays.
    pub(crate) fn put_in(&mut self, orders: &[Order], team: &Team) {
        let tasks = [
            put_in(&mut self.deformation, orders),
            put_in(&mut self.stress, orders),
            put_in(&mut self.affine, orders),
            put_in(&mut self.start, orders),
            put_in(&mut self.position, orders),
            put_in(&mut self.velocity, orders),
            put_in(&mut self.mass, orders),
            put_in(&mut self.reference_volume, orders),
            put_in(&mut self.volume, orders),
            put_in(&mut self.plastic_strain, orders),
            put_in(&mut self.id, orders),
        ];
        team.each(tasks.into_iter(), |_, task| task());
    }

    /// Returns a mutable view of all points.
    pub(crate) fn lent(&mut self) -> PointsMut<'_, S> {
        PointsMut {
            first: 0,
            position: &mut self.position,
            next: &mut self.next,
            velocity: &mut self.velocity,
            affine: &mut self.affine,
            mass: &self.mass,
            reference_volume: &self.reference_volume,
            volume: &mut self.volume,
            deformation: &mut self.deformation,
            stress: &mut self.stress,
            plastic_strain: &mut self.plastic_strain,
        }
    }
}

/// Permutation of consecutive points.
#[derive(Clone, Debug)]
pub(crate) struct Order {
    range: Range<usize>,
    /// Old indices in the new order.
    numbers: Vec<usize>,
}

/// Returns a task that applies permutations to an array. It does nothing if the array is empty.
fn put_in<'a, T: Copy + Send>(values: &'a mut [T], orders: &'a [Order]) -> Box<dyn FnOnce() + Send + 'a> {
    Box::new(move || {
        if values.is_empty() {
            return;
        }
        for Order { range, numbers } in orders {
            let old = values[range.clone()].to_vec();
            for (value, &from) in values[range.clone()].iter_mut().zip(numbers) {
                *value = old[from - range.start];
            }
        }
    })
}

/// Mutable view of consecutive points for one thread.
pub(crate) struct PointsMut<'a, S: Space> {
    /// Index of the first point.
    pub(crate) first: usize,
    pub(crate) position: &'a mut [S::Vector],
    pub(crate) next: &'a mut [S::Vector],
    pub(crate) velocity: &'a mut [S::Vector],
    pub(crate) affine: &'a mut [S::Matrix],
    pub(crate) mass: &'a [f64],
    pub(crate) reference_volume: &'a [f64],
    pub(crate) volume: &'a mut [f64],
    pub(crate) deformation: &'a mut [S::Matrix],
    pub(crate) stress: &'a mut [S::Symmetric],
    pub(crate) plastic_strain: &'a mut [f64],
}

impl<S: Space> PointsMut<'_, S> {
    /// Splits off the first `count` points.
    pub(crate) fn take_off(&mut self, count: usize) -> Self {
        let first = self.first;
        self.first += count;
        let (mass, others) = self.mass.split_at(count);
        self.mass = others;
        let (reference_volume, others) = self.reference_volume.split_at(count);
        self.reference_volume = others;
        Self {
            first,
            position: take_off(&mut self.position, count),
            next: take_off(&mut self.next, count),
            velocity: take_off(&mut self.velocity, count),
            affine: take_off(&mut self.affine, count),
            mass,
            reference_volume,
            volume: take_off(&mut self.volume, count),
            deformation: take_off(&mut self.deformation, count),
            stress: take_off(&mut self.stress, count),
            plastic_strain: take_off(&mut self.plastic_strain, count),
        }
    }
}
