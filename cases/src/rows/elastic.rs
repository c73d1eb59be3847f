//! Elastic grains: relaxation of one grain on a plane before the run, stiffening of a grain towards the rigid limit,
//! and the closed form of a disc that is compressed across its diameter.

use crate::exact::bisection;
use crate::exact::one_grain::{OneGrain, last, normal_axis};
use crate::rows::on_plane::touching;
use grainbench_harness::prelude::*;
use grainbench_scene::body::Settle;

/// Relaxation phase before the run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rest {
    /// Duration (s).
    pub(crate) duration: f64,
    /// Mass-proportional damping α (1/s).
    pub(crate) damping: f64,
}

/// Relaxes the first grain on its plane under the normal component of gravity, before a run of `time` (s).
pub(crate) fn settle(scene: &mut Scene, rest: Rest, time: f64) {
    touching(scene);
    let (normal, mut gravity) = (normal_axis(scene), Vector3::zeros());
    gravity[normal] = scene.gravity[normal];
    scene.start.settle = Some(Settle { duration: rest.duration, damping: rest.damping, gravity });
    scene.duration = Duration::Seconds(time);
}

/// Multiplies bulk and shear modulus of all deformable bodies by a factor.
pub(crate) fn stiffen(scene: &mut Scene, factor: f64) {
    for material in scene.deformable.iter_mut().flatten() {
        material.bulk_modulus *= factor;
        material.shear_modulus *= factor;
    }
}

/// Returns the last displacement down an incline divided by that of a rigid grain, minus one.
pub(crate) fn excess(done: &FinishedRun) -> Result<f64, MissingData> {
    let (t, state) = last(done)?;
    Ok(state.x / OneGrain::from_scene(&done.scene).rigid_incline(t).x - 1.0)
}

/// Returns the claim that [`excess`] equals a cited value.
pub(crate) fn excess_claim(quantity: String, run: Run, cited: CitedNumber, tolerance: Tolerance) -> ClaimWithTolerance {
    claim(quantity, "1").run(run).equals_cited(cited, 1.0, |done| excess(&done[0])).within(tolerance)
}

/// Elastic disc in plane strain that is compressed without friction at two opposite sides or at four. The shortening of
/// its diameter is δ.
///
/// δ/R = p [(2/π)(2 ln(4R/a) − 1) − s], p = F/(E'R), a² = 4pR²/π (Johnson, Contact Mechanics, §5.6: a cylinder between
/// two flats). s is zero for two sides. For four sides, the second pair of forces widens the disc, and s = (4/π − 1) +
/// ν/(1 − ν).
#[derive(Clone, Copy, Debug)]
pub(crate) struct PressedDisc {
    /// E' = E/(1 − ν²) (Pa).
    pub(crate) modulus: f64,
    /// Poisson's ratio ν.
    pub(crate) poisson: f64,
    /// Radius R (m).
    pub(crate) radius: f64,
    /// Number of compressed sides: 2 or 4.
    pub(crate) sides: u8,
}

impl PressedDisc {
    /// Reads the first grain of a scene; `None` if it is not deformable.
    pub(crate) fn from_scene(scene: &Scene, sides: u8) -> Option<Self> {
        let disc = (*scene.deformable.first()?)?;
        let (bulk, shear) = (disc.bulk_modulus, disc.shear_modulus);
        let poisson = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear));
        Some(Self { modulus: disc.plane_modulus(), poisson, radius: scene.grains[0].radius, sides })
    }

    /// Returns δ/(pR) for the dimensionless force p = F/(E'R).
    fn compliance(&self, p: f64) -> f64 {
        let widened = if self.sides == 4 { 4.0 / PI - 1.0 + self.poisson / (1.0 - self.poisson) } else { 0.0 };
        let patch = (4.0 * p / PI).sqrt();
        2.0 / PI * (2.0 * (4.0 / patch).ln() - 1.0) - widened
    }

    /// Returns the force (N per metre) that shortens each compressed diameter by `shortening` (m), by bisection.
    pub(crate) fn force(&self, shortening: f64) -> f64 {
        let [p, _] = bisection([1e-12, 0.05], 200, |p| p * self.compliance(p) < shortening / self.radius);
        p * self.modulus * self.radius
    }

    /// Returns the displacements due to a small increase ΔF of the force at one contact, in units of ΔF/(πE'). Before
    /// the increase, `force` (N per metre) compresses the disc at two opposite contacts. Relative to the mean
    /// displacement and along ΔF, u is the displacement of the loaded contact and v that of the opposite point.
    ///
    /// The inertia of the disc balances ΔF as a uniform body force −ΔF/(πR²). The axis x points along ΔF from the
    /// centre; r and θ are measured from the contact. The stress
    /// ```text
    /// σ = −(2ΔF/πr) cos θ e_r e_r + (ΔF/2πR) (e_x e_x + e_y e_y) + (ΔF/2πR²) [x (e_x e_x − e_y e_y) + y (e_x e_y + e_y e_x)]
    /// ```
    ///
    /// leaves the rim free of traction. The mean displacement is the displacement of the centre. With n = ν/(1 − ν) and
    /// a contact half-width a that grows as √F
    ///
    /// ```text
    /// u = 2 ln(2R/a) − 5/4 − n/4        v = −2 ln 2 + 3/4 − n/4        w = 2 − π/2 + πn/2
    /// ```
    ///
    /// u − v = 2 ln(4R/a) − 2 is the shortening of half a diameter between two flats. w is the outward displacement of
    /// each side due to a pair of forces ΔF on the perpendicular diameter.
    /// Source: Flamant's solution (Timoshenko & Goodier, Theory of Elasticity, §§36, 41); Johnson, Contact Mechanics,
    /// eq. 5.57.
    pub(crate) fn gives(&self, force: f64) -> DiscDisplacements {
        let n = self.poisson / (1.0 - self.poisson);
        let patch = self.patch(force);
        let u = 2.0 * (2.0 / patch).ln() - 1.25 - 0.25 * n;
        let v = -2.0 * 2.0_f64.ln() + 0.75 - 0.25 * n;
        DiscDisplacements { u, v, w: 2.0 - 0.5 * PI + 0.5 * PI * n }
    }

    /// Returns the mean square of the deviation of the displacement from its mean, in units of (1/πE')². The loads are
    /// forces at left, right, bottom and top, and inertia balances them. The result gives the added mass of a disc,
    /// which is the inertia of its deformation. The quadrature uses the displacement field of [`Self::gives`].
    pub(crate) fn stirred(&self, loads: [f64; 4]) -> f64 {
        self.stirred_by(100, loads)
    }

    /// Computes [`Self::stirred`] on a grid of `parts` × `parts` points over the diameter.
    fn stirred_by(&self, parts: i32, [left, right, bottom, top]: [f64; 4]) -> f64 {
        let n = self.poisson / (1.0 - self.poisson);
        let from_left = |x: f64, y: f64| -> [f64; 2] {
            let (square, angle) = ((x + 1.0).powi(2) + y * y, y.atan2(x + 1.0));
            let along = -square.ln() - (1.0 + n) * y * y / square + 0.5 * (1.0 - n) * x;
            let across = (1.0 + n) * (x + 1.0) * y / square - (1.0 - n) * angle + 0.5 * (1.0 - n) * y;
            [along + 0.25 * (1.0 + n) * (x * x + 3.0 * y * y), across - 0.5 * (1.0 + n) * x * y]
        };
        let place = |at: i32| f64::from(2 * at + 1) / f64::from(parts) - 1.0;
        let places = (0..parts * parts).map(|at| (place(at / parts), place(at % parts)));
        let (mut sum, mut count) = (0.0, 0.0);
        for (x, y) in places.filter(|(x, y)| x * x + y * y < 1.0) {
            let [l, r, b, t] = [(x, y), (-x, y), (y, x), (-y, x)].map(|(x, y)| from_left(x, y));
            let along = left * l[0] - right * r[0] + bottom * b[1] + top * t[1];
            let across = left * l[1] + right * r[1] + bottom * b[0] - top * t[0];
            sum += along * along + across * across;
            count += 1.0;
        }
        sum / count
    }

    /// Returns the contact half-width a over the radius R, with a² = 4FR/(πE′).
    pub(crate) fn patch(&self, force: f64) -> f64 {
        (4.0 * force / (PI * self.modulus * self.radius)).sqrt()
    }
}

/// Displacements of a disc, in units of ΔF/(πE').
#[derive(Clone, Copy, Debug)]
pub(crate) struct DiscDisplacements {
    /// Displacement of the loaded contact along ΔF, relative to the mean displacement.
    pub(crate) u: f64,
    /// Displacement of the opposite point along ΔF, relative to the mean displacement.
    pub(crate) v: f64,
    /// Outward displacement of a side due to a pair of forces ΔF on the perpendicular diameter.
    pub(crate) w: f64,
}

/// −Ai'(0), where Ai is the Airy function: time integral of the part of a wave front of width 1 that arrives before the
/// nominal arrival time.
pub(crate) const AHEAD: f64 = 0.258_819_403_792_806_8;

/// Returns the width δ of a wave front after a path length s (`way`), for cells of length h (`cell`): δ³ = 3 (25/96) h²
/// s. On the grid, the frequency of a wave with wavenumber k is lower by the fraction (25/96)(kh)² (derivations of
/// `vibrating-bar` and `bar-impact`).
pub(crate) fn front(cell: f64, way: f64) -> f64 {
    (3.0 * 25.0 / 96.0 * cell * cell * way).cbrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the stress at a point from the centre of a disc of radius 1. One force F = πE' acts at (−1, 0) along +x,
    /// and the body force −F/π balances it.
    fn stress([x, y]: [f64; 2]) -> [[f64; 2]; 2] {
        let (along, r) = ([x + 1.0, y], (x + 1.0).hypot(y));
        let radial = -2.0 * along[0] / (r * r);
        let e = along.map(|part| part / r);
        let component = |i: usize, j: usize, rest: f64| radial * e[i] * e[j] + rest;
        [
            [component(0, 0, 0.5 + 0.5 * x), component(0, 1, 0.5 * y)],
            [component(1, 0, 0.5 * y), component(1, 1, 0.5 - 0.5 * x)],
        ]
    }

    /// Checks that the rim is free of traction except at the contact, u and v by integrals of the strain and by
    /// Johnson's approach below a contact patch, and that the mean displacement is the displacement of the centre.
    #[test]
    fn a_disc_gives_way_to_a_load_that_its_inertia_bears() {
        for at in 1..20 {
            let angle = PI - 0.3 * f64::from(at);
            let normal = [angle.cos(), angle.sin()];
            let [xx, yy] = stress(normal);
            for row in [xx, yy] {
                assert!((row[0] * normal[0] + row[1] * normal[1]).abs() < 1e-12, "{angle}");
            }
        }
        let disc = PressedDisc { modulus: 1.0, poisson: 0.25, radius: 1.0, sides: 2 };
        let (n, force) = (1.0 / 3.0, 2e-3);
        let DiscDisplacements { u, v, .. } = disc.gives(force);
        // Integral of E' du/dx, divided by F/π: relative displacement of two points on the diameter.
        let apart = |from: f64, to: f64| -> f64 {
            let (parts, width) = (20_000, (to - from) / 20_000.0);
            let strain = |x: f64| {
                let [xx, yy] = stress([x, 0.0]);
                xx[0] - n * yy[1]
            };
            (0..parts).map(|part| strain(from + (f64::from(part) + 0.5) * width) * width).sum()
        };
        assert!((apart(0.0, 1.0) - v).abs() < 1e-6, "{} is not {v}", apart(0.0, 1.0));
        // Johnson's eq. 5.57 at a depth of many contact widths, differentiated by the force. The term −1 arises because
        // the contact width grows with the force.
        let depth = 0.01;
        let (patch, tension) = (disc.patch(force), depth * (0.5 * (1.0 - n) - 0.5 * (1.0 + n)));
        let near = 2.0 * (2.0 * depth / patch).ln() - n - 1.0 - tension;
        assert!((near - apart(depth - 1.0, 0.0) - u).abs() < 1e-3, "{} is not {u}", near - apart(depth - 1.0, 0.0));
        // Mean of u_x − u_x(0) over the disc.
        let (mut mean, mut area, parts) = (0.0, 0.0, 800);
        for i in 0..parts {
            for j in 0..parts {
                let place = |at: i32| (2.0 * f64::from(at) + 1.0) / f64::from(parts) - 1.0;
                let (x, y) = (place(i), place(j));
                if x * x + y * y < 1.0 {
                    let square = (x + 1.0).powi(2) + y * y;
                    let flamant = -square.ln() - (1.0 + n) * y * y / square;
                    let rest = 0.5 * (1.0 - n) * x + 0.25 * (1.0 + n) * (x * x + 3.0 * y * y);
                    mean += flamant + rest;
                    area += 1.0;
                }
            }
        }
        assert!((mean / area).abs() < 2e-3, "{}", mean / area);
        let half = 2.0 * (4.0 / patch).ln() - 2.0;
        assert!((u - v - half).abs() < 1e-12);
    }

    /// The added mass does not change if the loads are rotated by 90° or reversed.
    #[test]
    fn what_is_stirred_does_not_depend_on_the_axis() {
        let disc = PressedDisc { modulus: 1.0, poisson: 0.25, radius: 1.0, sides: 2 };
        let [along, across, back] =
            [[1.0, -1.0, 0.0, 0.0], [0.0, 0.0, 1.0, -1.0], [-1.0, 1.0, 0.0, 0.0]].map(|loads| disc.stirred(loads));
        assert!((along / across - 1.0).abs() < 1e-12 && (along / back - 1.0).abs() < 1e-12);
        // The relative error of the quadrature is at most 3e-3, also for one load alone. The added mass is 2.8 % of the
        // mass for two loads.
        for loads in [[1.0, 0.0, 0.0, 0.0], [1.0, -1.0, 0.0, 0.0]] {
            assert!((disc.stirred(loads) / disc.stirred_by(400, loads) - 1.0).abs() < 3e-3, "{loads:?}");
        }
    }
}
