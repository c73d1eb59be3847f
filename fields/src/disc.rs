//! Elastic stress inside a disc under point forces at its rim.
//!
//! A force F on the edge of a half-plane makes a purely radial stress around its point of application (Flamant 1892;
//! Timoshenko and Goodier, Theory of Elasticity, art. 36):
//!
//! ```text
//! σ_F(x) = −(2/(π r)) (F·e) e⊗e ,      r e = x − a,   a the point of the force, per metre of depth
//! ```
//!
//! Consider a circle of radius R through a. At a rim point with outward normal n, e·n = r/(2R), so the traction there
//! is −(F·e) e/(πR). The tractions of all forces F_i at normals n_i add up to
//!
//! ```text
//! t = −ΣF/(2πR) + n ΣF·n_i/(2πR) − τ M/(2πR²) ,     M = R Σ n_i×F_i,  τ the tangent, counter-clockwise
//! ```
//!
//! This sum follows by doubling the angle of each chord, as in art. 41 for two opposite forces. Three fields cancel
//! this traction, so that the rim between the forces is free:
//!
//! ```text
//! uniform       −1 ΣF_i·n_i/(2πR)
//! resultant F   (F⊗x + x⊗F − (F·x) 1)/(2πR²)     in balance with the body force −F/(πR²) of a disc that accelerates at F/m
//! torque M      σ_rθ = M r²/(2πR⁴)               in balance with the body force of angular acceleration M/I, I = mR²/2
//! ```
//!
//! Each field is compatible, because its σ_xx + σ_yy is harmonic or the field is torsion. The sum is exact in plane
//! elasticity for any moduli, both for a disc in equilibrium and for a disc with rigid-body acceleration. It is also
//! exact under gravity, because gravity changes body force and acceleration alike. The centrifugal stress, at most
//! ρω²R² for density ρ and angular velocity ω, is not included. Stress diverges as 1/r at a point force; a real contact
//! has a finite width.

use grainbench_solver::record::{Partner, Snapshot};
use nalgebra::{Matrix2, Vector2};
use std::f64::consts::PI;

/// A force at the rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Load {
    /// Outward unit normal of the rim at the point of the force.
    pub normal: Vector2<f64>,
    /// Force on the disc (N per metre of depth).
    pub force: Vector2<f64>,
}

/// A disc under forces at its rim.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedDisc {
    radius: f64,
    loads: Vec<Load>,
    /// Uniform part of the stress, −ΣF·n/(2πR) (Pa).
    uniform: f64,
    /// Sum of the forces ΣF (N per metre of depth).
    resultant: Vector2<f64>,
    /// Coefficient of the stress due to the torque M of the forces, M/(2πR⁴) (Pa/m²).
    twist: f64,
}

impl LoadedDisc {
    /// Creates a disc of a radius (m) under loads.
    #[must_use]
    fn new(radius: f64, loads: Vec<Load>) -> Self {
        let normal_sum: f64 = loads.iter().map(|load| load.force.dot(&load.normal)).sum();
        let resultant = loads.iter().map(|load| load.force).sum();
        let torque: f64 = loads.iter().map(|load| radius * load.normal.perp(&load.force)).sum();
        let uniform = -normal_sum / (2.0 * PI * radius);
        Self { radius, loads, uniform, resultant, twist: torque / (2.0 * PI * radius.powi(4)) }
    }

    /// Returns each grain of a two-dimensional snapshot as a disc under its contact forces, in the order of the grains.
    #[must_use]
    pub fn of_snapshot(snapshot: &Snapshot) -> Vec<Self> {
        let mut loads: Vec<Vec<Load>> = vec![Vec::new(); snapshot.grains.len()];
        for contact in snapshot.told_contacts() {
            let normal = contact.normal.xy();
            let force = contact.shear_force.xy() - normal * contact.normal_force;
            let mut push = |id: u32, load: Load| {
                if let Some(loads) = snapshot.place_of(id).and_then(|place| loads.get_mut(place)) {
                    loads.push(load);
                }
            };
            push(contact.grain, Load { normal, force });
            if let Partner::Grain(other) = contact.partner {
                push(other, Load { normal: -normal, force: -force });
            }
        }
        snapshot.grains.iter().zip(loads).map(|(grain, loads)| Self::new(grain.radius, loads)).collect()
    }

    /// Returns the stress (Pa, tension positive) at a position relative to the centre (m).
    #[must_use]
    pub fn stress(&self, place: Vector2<f64>) -> Matrix2<f64> {
        let radius = self.radius;
        let mut stress = Matrix2::from_diagonal_element(self.uniform);
        for load in &self.loads {
            let chord = place - load.normal * radius;
            // The distance to a point force is at least a billionth of the radius, so the stress stays finite.
            let square = chord.norm_squared().max((1e-9 * radius).powi(2));
            stress -= chord * chord.transpose() * (2.0 / PI * load.force.dot(&chord) / (square * square));
        }
        let (force, along) = (self.resultant, self.resultant.dot(&place));
        stress += (force * place.transpose() + place * force.transpose() - Matrix2::from_diagonal_element(along))
            / (2.0 * PI * radius * radius);
        // r² (e_r⊗e_θ + e_θ⊗e_r) in Cartesian components.
        let (x, y) = (place.x, place.y);
        stress + Matrix2::new(-2.0 * x * y, x * x - y * y, x * x - y * y, 2.0 * x * y) * self.twist
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(angle: f64, force: (f64, f64)) -> Load {
        Load { normal: Vector2::new(angle.cos(), angle.sin()), force: Vector2::new(force.0, force.1) }
    }

    /// Returns the largest traction on the rim away from the loads, divided by Σ|F|/(2πR), the sum of the forces per
    /// length of the rim.
    fn rim_traction(disc: &LoadedDisc) -> f64 {
        let scale: f64 = disc.loads.iter().map(|load| load.force.norm()).sum::<f64>() / (2.0 * PI * disc.radius);
        (0..720)
            .map(|at| f64::from(at).to_radians() / 2.0 + 1e-3)
            .map(|angle| Vector2::new(angle.cos(), angle.sin()))
            .filter(|normal| disc.loads.iter().all(|load| (load.normal - normal).norm() > 0.02))
            .map(|normal| (disc.stress(normal * disc.radius) * normal).norm() / scale)
            .fold(0.0, f64::max)
    }

    /// Returns the divergence of the stress by central differences (Pa/m).
    fn divergence(disc: &LoadedDisc, place: Vector2<f64>) -> Vector2<f64> {
        let step = 1e-4 * disc.radius;
        let slope = |along: Vector2<f64>| {
            (disc.stress(place + along * step) - disc.stress(place - along * step)) * along / (2.0 * step)
        };
        slope(Vector2::x()) + slope(Vector2::y())
    }

    #[test]
    fn pressed_between_two_points_it_has_the_textbook_stress() {
        let (radius, force) = (0.03, 700.0);
        let up = std::f64::consts::FRAC_PI_2;
        let disc = LoadedDisc::new(radius, vec![load(up, (0.0, -force)), load(-up, (0.0, force))]);
        let unit = 2.0 * force / (PI * 2.0 * radius);
        let centre = disc.stress(Vector2::zeros());
        assert!((centre.m11 / unit - 1.0).abs() < 1e-12, "σ_x = 2P/(πD)");
        assert!(((centre.m11 - centre.m22) / (4.0 * unit) - 1.0).abs() < 1e-12, "σ_x − σ_y = 8P/(πD)");
        // Along the loaded diameter σ_x = 2P/(πD). On the perpendicular diameter, at x = R/2, eq. (g) of art. 41 of
        // Timoshenko and Goodier gives σ_y.
        assert!((disc.stress(Vector2::new(0.0, 0.6 * radius)).m11 / unit - 1.0).abs() < 1e-12);
        let side = disc.stress(Vector2::new(0.5 * radius, 0.0));
        let (d, x) = (2.0 * radius, 0.5 * radius);
        let expected = unit * (1.0 - 4.0 * d.powi(4) / (d * d + 4.0 * x * x).powi(2));
        assert!((side.m22 / expected - 1.0).abs() < 1e-12, "{} {expected}", side.m22);
        assert!(rim_traction(&disc) < 1e-12);
    }

    #[test]
    fn any_forces_leave_the_rim_free_and_the_inside_in_balance() {
        let radius = 0.7;
        let balanced = {
            // Pairs of opposite forces along chords are in equilibrium of force and moment.
            let (a, b, c) = (0.3_f64, 2.0_f64, 4.1_f64);
            let chord = |from: f64, to: f64| (to.cos() - from.cos(), to.sin() - from.sin());
            let pair = |from: f64, to: f64, size: f64| {
                let (x, y) = chord(from, to);
                [load(from, (size * x, size * y)), load(to, (-size * x, -size * y))]
            };
            [pair(a, b, 3.0), pair(b, c, 5.0), pair(c, a, 2.0)].concat()
        };
        let pushed = vec![load(0.3, (-2.0, 0.4)), load(1.7, (0.5, -1.0))];
        for (loads, accelerates) in [(balanced, false), (pushed, true)] {
            let disc = LoadedDisc::new(radius, loads);
            assert!(rim_traction(&disc) < 1e-12, "{}", rim_traction(&disc));
            assert_eq!(disc.resultant.norm() > 1e-12, accelerates);
            for place in [Vector2::new(0.1, -0.2), Vector2::new(-0.3, 0.25), Vector2::zeros()] {
                // Mass times acceleration per volume: ρ(a + ω̇×x) = F/(πR²) + 2M/(πR⁴) τ r.
                let spinning = Vector2::new(-place.y, place.x) * (4.0 * disc.twist);
                let inertia = disc.resultant / (PI * radius * radius) + spinning;
                let off = (divergence(&disc, place) - inertia).norm();
                assert!(off < 1e-5 * (1.0 + inertia.norm()), "{off}");
            }
        }
    }

    #[test]
    fn a_missing_part_of_the_solution_is_seen_at_the_rim() {
        let whole = LoadedDisc::new(1.0, vec![load(0.3, (-2.0, 0.4)), load(1.7, (0.5, -1.0))]);
        let without = [
            LoadedDisc { uniform: 0.0, ..whole.clone() },
            LoadedDisc { resultant: Vector2::zeros(), ..whole.clone() },
            LoadedDisc { twist: 0.0, ..whole },
        ];
        for disc in without {
            assert!(rim_traction(&disc) > 0.1, "{}", rim_traction(&disc));
        }
    }
}
