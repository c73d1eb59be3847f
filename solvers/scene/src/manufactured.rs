//! Manufactured solutions: chosen motions, and the body forces that make them exact in a neo-Hookean material.

use libm::{cos, log, sin, sincos};
use nalgebra::{Vector2, Vector3};
use std::f64::consts::PI;

/// Chosen motion of a manufactured solution. The body forces hold for the Kirchhoff stress τ = λ (ln J) 1 + G (b − 1).
/// J = det F and b = F Fᵀ belong to the deformation gradient F, and 1 is the unit tensor (Kamojjala, Brannon,
/// Sadeghirad & Guilkey 2015).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Manufactured {
    /// Displacement u_x = A sin(2πX/L) sin(cπt/L) in a periodic box of length L along x. X is the initial position, t
    /// the time, and c = √(E/ρ₀) the bar wave speed.
    AxisAligned {
        /// Amplitude A (m), below L/2π.
        amplitude: f64,
        /// Length L of the box (m).
        length: f64,
    },
    /// Rotation of each circle of radius R about the origin by the angle α = A sin(Bπt) h(R) at time t. For .75 m < R <
    /// 1.25 m, h = (1 − 16 (R − 1)²)². For other radii, h = 0.
    Vortex {
        /// Largest angle A (rad).
        amplitude: f64,
        /// Rate B (1/s). The period of the motion is 2/B.
        rate: f64,
    },
}

/// Material for which a body force is computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// Density ρ₀ (kg/m³).
    pub density: f64,
    /// Lamé's λ (Pa).
    pub lame: f64,
    /// Shear modulus G (Pa).
    pub shear_modulus: f64,
}

impl Medium {
    /// Returns the bar wave speed √(E/ρ₀) (m/s), with Young's modulus E = G (3λ + 2G)/(λ + G).
    fn bar_speed(&self) -> f64 {
        let (lame, shear) = (self.lame, self.shear_modulus);
        (shear * (3.0 * lame + 2.0 * shear) / (lame + shear) / self.density).sqrt()
    }
}

impl Manufactured {
    /// Returns the displacement (m) at `time` (s) of the material point that started at `at` (m).
    #[must_use]
    pub fn displacement(&self, medium: &Medium, at: Vector3<f64>, time: f64) -> Vector3<f64> {
        match *self {
            Self::AxisAligned { amplitude, length } => {
                let phase = medium.bar_speed() * PI * time / length;
                Vector3::new(amplitude * sin(2.0 * PI * at.x / length) * sin(phase), 0.0, 0.0)
            }
            Self::Vortex { amplitude, rate } => {
                let radius = at.xy().norm();
                turned(at.xy(), amplitude * sin(rate * PI * time) * bump(radius)[0]) - Vector3::new(at.x, at.y, 0.0)
            }
        }
    }

    /// Returns the velocity (m/s) at `time` (s) of the material point that started at `at` (m).
    #[must_use]
    pub fn velocity(&self, medium: &Medium, at: Vector3<f64>, time: f64) -> Vector3<f64> {
        match *self {
            Self::AxisAligned { amplitude, length } => {
                let rate = medium.bar_speed() * PI / length;
                let speed = amplitude * sin(2.0 * PI * at.x / length) * rate * cos(rate * time);
                Vector3::new(speed, 0.0, 0.0)
            }
            Self::Vortex { amplitude, rate } => {
                let shape = bump(at.xy().norm())[0];
                let angle = amplitude * sin(rate * PI * time) * shape;
                let spin = amplitude * rate * PI * cos(rate * PI * time) * shape;
                Vector3::new(0.0, 0.0, spin).cross(&turned(at.xy(), angle))
            }
        }
    }

    /// Returns the body force per unit mass (m/s²) at `time` (s) on the material point that started at `at` (m).
    ///
    /// For the axis-aligned motion, with F = 1 + ∂u/∂X, it is b = (π²u/ρ₀L²)[4G − c²ρ₀ − 4(λ(ln F − 1) − G)/F²]. For
    /// the vortex, the radial and tangential components at the present angle satisfy ρb_r = −ρRα_t² + GRα'² and ρb_θ =
    /// ρRα_tt − G(3α' + Rα''). A prime is a derivative with respect to R, and an index t one with respect to time.
    #[must_use]
    pub fn body_force(&self, medium: &Medium, at: Vector3<f64>, time: f64) -> Vector3<f64> {
        let &Medium { density, lame, shear_modulus: shear } = medium;
        match *self {
            Self::AxisAligned { amplitude, length } => {
                let (wave, speed) = (2.0 * PI / length, medium.bar_speed());
                let swing = sin(speed * PI * time / length);
                let displacement = amplitude * sin(wave * at.x) * swing;
                let stretch = 1.0 + wave * amplitude * cos(wave * at.x) * swing;
                let bracket = 4.0 * shear
                    - speed * speed * density
                    - 4.0 * (lame * (log(stretch) - 1.0) - shear) / (stretch * stretch);
                Vector3::new((PI / length).powi(2) * displacement / density * bracket, 0.0, 0.0)
            }
            Self::Vortex { amplitude, rate } => {
                let radius = at.xy().norm();
                if radius == 0.0 {
                    return Vector3::zeros();
                }
                let [shape, slope, curvature] = bump(radius);
                let phase = rate * PI * time;
                let spin = amplitude * rate * PI * cos(phase) * shape;
                let spin_rate = -amplitude * (rate * PI).powi(2) * sin(phase) * shape;
                let (slope, curvature) = (amplitude * sin(phase) * slope, amplitude * sin(phase) * curvature);
                let stiffness = shear / density;
                let outward = radius * (stiffness * slope * slope - spin * spin);
                let across = radius * spin_rate - stiffness * (3.0 * slope + radius * curvature);
                let direction = turned(at.xy() / radius, amplitude * sin(phase) * shape);
                direction * outward + Vector3::z().cross(&direction) * across
            }
        }
    }
}

fn turned(vector: Vector2<f64>, angle: f64) -> Vector3<f64> {
    let (sine, cosine) = sincos(angle);
    Vector3::new(vector.x * cosine - vector.y * sine, vector.x * sine + vector.y * cosine, 0.0)
}

/// Returns the profile h(R) of the vortex and its first two derivatives.
fn bump(radius: f64) -> [f64; 3] {
    let away = radius - 1.0;
    let inside = 1.0 - 16.0 * away * away;
    if inside <= 0.0 {
        return [0.0; 3];
    }
    [inside * inside, -64.0 * away * inside, -64.0 * inside + 2048.0 * away * away]
}

#[cfg(test)]
mod tests {
    use super::*;

    const MEDIUM: Medium = Medium { density: 1000.0, lame: 576.923, shear_modulus: 384.615 };

    /// E = G (3λ + 2G)/(λ + G) is 1000 Pa, so the wave speed is 1 m/s and the largest displacement is reached at 0.5 s.
    #[test]
    fn the_wave_speed_is_that_of_a_bar() {
        let motion = Manufactured::AxisAligned { amplitude: 0.05, length: 1.0 };
        let displacement = motion.displacement(&MEDIUM, Vector3::new(0.25, 0.0, 0.0), 0.5);
        assert!((displacement.x - 0.05).abs() < 1e-9, "{displacement}");
    }

    fn stress(motion: &Manufactured, at: Vector3<f64>, time: f64) -> nalgebra::Matrix3<f64> {
        let step = 1e-4;
        let mut gradient = nalgebra::Matrix3::identity();
        for axis in 0..3 {
            let mut there = Vector3::zeros();
            there[axis] = step;
            let column = |x| motion.displacement(&MEDIUM, x, time);
            gradient
                .set_column(axis, &(gradient.column(axis) + (column(at + there) - column(at - there)) / (2.0 * step)));
        }
        let volume = gradient.determinant();
        let finger = gradient * gradient.transpose();
        let one = nalgebra::Matrix3::identity();
        let kirchhoff = one * (MEDIUM.lame * volume.ln()) + (finger - one) * MEDIUM.shear_modulus;
        kirchhoff * gradient.try_inverse().unwrap_or(one).transpose()
    }

    /// The momentum balance ρ₀ a = Div P + ρ₀ b holds for the first Piola–Kirchhoff stress P, with derivatives by
    /// finite differences.
    #[test]
    fn body_force_balances_the_motion() {
        let motions = [
            Manufactured::AxisAligned { amplitude: 0.05, length: 1.0 },
            Manufactured::Vortex { amplitude: 0.7, rate: 0.9 },
        ];
        for motion in motions {
            for at in [Vector3::new(0.83, 0.21, 0.0), Vector3::new(-0.5, 0.95, 0.0), Vector3::new(0.93, -0.3, 0.0)] {
                let (time, step) = (0.37, 1e-3);
                let mut divergence = Vector3::zeros();
                for axis in 0..3 {
                    let mut there = Vector3::zeros();
                    there[axis] = step;
                    let change = stress(&motion, at + there, time) - stress(&motion, at - there, time);
                    divergence += change.column(axis) / (2.0 * step);
                }
                let velocity = |t| motion.velocity(&MEDIUM, at, t);
                let acceleration = (velocity(time + step) - velocity(time - step)) / (2.0 * step);
                let force = acceleration - divergence / MEDIUM.density;
                let given = motion.body_force(&MEDIUM, at, time);
                assert!(
                    (force - given).norm() < 2e-3 * given.norm().max(0.1),
                    "{motion:?} at {at:?}: {force:?} {given:?}"
                );
            }
        }
    }
}
