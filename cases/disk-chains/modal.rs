//! Exact motion of discs on linear springs by modal analysis, for displacements that leave the geometry unchanged and
//! until a contact opens or slips: `M ü + K u = f V t`, by the eigenvectors of `M^{-1/2} K M^{-1/2}`.
//!
//! At a contact with unit normal `e` (from i to j) and tangent `t = (e₂, −e₁)`, the spring displacements are
//!
//! ```text
//! overlap        e·(u_i − u_j)
//! shear          t·(u_i − u_j) − s (R_i θ_i + R_j θ_j),   s = ω × e along t = −1 per unit of ω (counter-clockwise)
//! ```
//!
//! and the energy is k/2 times their squares. A wall is a disc that does not move, here without shear.

use crate::exact::bisection;
use grainbench_scene::scene::{Scene, WallShape};
use nalgebra::{DMatrix, DVector, Vector2};

/// Spring between two discs or between a disc and a wall. `stretch` contains the derivatives of the spring displacement
/// with respect to (x, y, θ) of all discs.
struct Spring {
    stretch: DVector<f64>,
    stiffness: f64,
    is_shear: bool,
    /// The two discs; `None` for a spring at a wall.
    pair: Option<[usize; 2]>,
    /// Overlap per unit of the striker's displacement: 1 for springs at the striker, otherwise 0.
    driven: f64,
}

impl Spring {
    /// Returns the spring displacement (m) from the displacements of the discs (m, rad) and of the striker (m).
    fn overlap(&self, displacement: &DVector<f64>, striker: f64) -> f64 {
        self.stretch.dot(displacement) + self.driven * striker
    }
}

/// Modes of a scene of discs in contact, driven by its first wall.
pub(super) struct Modes {
    springs: Vec<Spring>,
    /// Columns M^{-1/2} v of all modes.
    shapes: DMatrix<f64>,
    frequency: Vec<f64>,
    /// Generalised force of the striker on each mode, per unit of the striker's displacement.
    drive: Vec<f64>,
    speed: f64,
}

impl Modes {
    /// Computes the modes with the contacts at the start of a scene. All contacts stick if their law has friction.
    pub(super) fn from_scene(scene: &Scene) -> Self {
        let count = scene.grains.len();
        let springs = springs(scene);
        let mut stiffness = DMatrix::zeros(3 * count, 3 * count);
        let mut force = DVector::zeros(3 * count);
        for spring in &springs {
            stiffness += &spring.stretch * spring.stretch.transpose() * spring.stiffness;
            force -= &spring.stretch * (spring.stiffness * spring.driven);
        }
        let root = DVector::from_iterator(
            3 * count,
            scene.grains.iter().flat_map(|grain| [grain.mass.sqrt(), grain.mass.sqrt(), grain.inertia.sqrt()]),
        );
        let scaled = DMatrix::from_fn(3 * count, 3 * count, |i, j| stiffness[(i, j)] / (root[i] * root[j]));
        let eigen = scaled.symmetric_eigen();
        let shapes = DMatrix::from_fn(3 * count, 3 * count, |i, mode| eigen.eigenvectors[(i, mode)] / root[i]);
        let drive = (shapes.transpose() * force).iter().copied().collect();
        let frequency = eigen.eigenvalues.iter().map(|value| value.max(0.0).sqrt()).collect();
        let speed = scene.walls[0].motion.phases[0].velocity.norm();
        Self { springs, shapes, frequency, drive, speed }
    }

    /// Returns the displacements (m, rad) at a time (s): `q̈ + ω²q = gVt` gives `q = gV(t − sin ωt/ω)/ω²`.
    fn displacement(&self, time: f64) -> DVector<f64> {
        let fastest = self.frequency.iter().copied().fold(0.0, f64::max);
        let amplitudes = self.frequency.iter().zip(&self.drive).map(|(&frequency, &drive)| {
            // Rotations without spring displacements are not driven.
            if frequency < 1e-6 * fastest {
                0.0
            } else {
                drive * self.speed * (time - (frequency * time).sin() / frequency) / (frequency * frequency)
            }
        });
        &self.shapes * DVector::from_iterator(self.frequency.len(), amplitudes)
    }

    /// Returns the normal force between two discs (N).
    pub(super) fn force(&self, pair: [usize; 2], time: f64) -> f64 {
        let displacement = self.displacement(time);
        let spring = self.springs.iter().find(|spring| !spring.is_shear && spring.pair == Some(pair));
        spring.map_or(f64::NAN, |spring| spring.stiffness * spring.overlap(&displacement, self.speed * time))
    }

    /// Returns the time at which a contact first pulls and opens (s), within `until` (s). NaN if no contact opens.
    pub(super) fn first_opening(&self, until: f64) -> f64 {
        let pull = |time: f64| {
            let displacement = self.displacement(time);
            let normal = self.springs.iter().filter(|spring| !spring.is_shear);
            // Distant contacts pull slightly before the force arrives. A tension within this tolerance does not count
            // as opening.
            let felt = 1e-2 * self.speed * time;
            normal.map(|spring| -spring.overlap(&displacement, self.speed * time) - felt).fold(f64::MIN, f64::max)
        };
        first_above(pull, 0.0, until)
    }

    /// Returns the time at which the normal force between two discs first exceeds a threshold (s), within `until` (s).
    pub(super) fn arrival(&self, pair: [usize; 2], threshold: f64, until: f64) -> f64 {
        first_above(|time| self.force(pair, time), threshold, until)
    }

    /// Returns the time at which a disc first moves along x faster than a threshold (m/s), within `until` (s).
    pub(super) fn moving(&self, disc: usize, threshold: f64, until: f64) -> f64 {
        let tick = 1e-6 * until;
        let position = |time: f64| self.displacement(time)[3 * disc];
        first_above(|time| (position(time + tick) - position(time - tick)) / (2.0 * tick), threshold, until)
    }
}

/// Returns the first time up to `until` (s) at which a function exceeds a threshold, by bisection; NaN if there is none.
fn first_above(value: impl Fn(f64) -> f64, threshold: f64, until: f64) -> f64 {
    const SCAN: usize = 1000;
    let time = |step: usize| until * step as f64 / SCAN as f64;
    let Some(first) = (1..=SCAN).find(|&step| value(time(step)) > threshold) else { return f64::NAN };
    let [before, after] = bisection([time(first - 1), time(first)], 50, |time| value(time) <= threshold);
    0.5 * (before + after)
}

fn springs(scene: &Scene) -> Vec<Spring> {
    let count = scene.grains.len();
    let mut springs = Vec::new();
    let row = |entries: &[(usize, f64)]| {
        let mut row = DVector::zeros(3 * count);
        entries.iter().for_each(|&(at, value)| row[at] += value);
        row
    };
    for (i, a) in scene.grains.iter().enumerate() {
        for (j, b) in scene.grains.iter().enumerate().skip(i + 1) {
            let between = (b.position - a.position).xy();
            if between.norm() > (a.radius + b.radius) * (1.0 + 1e-9) {
                continue;
            }
            let e: Vector2<f64> = between.normalize();
            let Some(law) = scene.law(a.material, b.material) else { continue };
            let normal = row(&[(3 * i, e.x), (3 * i + 1, e.y), (3 * j, -e.x), (3 * j + 1, -e.y)]);
            let (pair, driven) = (Some([i, j]), 0.0);
            springs.push(Spring { stretch: normal, stiffness: law.normal_stiffness(), is_shear: false, pair, driven });
            if law.has_friction() {
                let t = Vector2::new(e.y, -e.x);
                let shear = row(&[
                    (3 * i, t.x),
                    (3 * i + 1, t.y),
                    (3 * i + 2, -a.radius),
                    (3 * j, -t.x),
                    (3 * j + 1, -t.y),
                    (3 * j + 2, -b.radius),
                ]);
                springs.push(Spring {
                    stretch: shear,
                    stiffness: law.tangential_stiffness(),
                    is_shear: true,
                    pair,
                    driven,
                });
            }
        }
        for (number, wall) in scene.walls.iter().enumerate() {
            let WallShape::Plane { point, normal } = wall.shape else { continue };
            let touches = (a.position - point).dot(&normal) < a.radius * (1.0 + 1e-9);
            if let (true, Some(law)) = (touches, scene.law(a.material, wall.material)) {
                let stretch = row(&[(3 * i, -normal.x), (3 * i + 1, -normal.y)]);
                let driven = if number == 0 { 1.0 } else { 0.0 };
                springs.push(Spring {
                    stretch,
                    stiffness: law.normal_stiffness(),
                    is_shear: false,
                    pair: None,
                    driven,
                });
            }
        }
    }
    springs
}
