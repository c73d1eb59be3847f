//! Distributions of radii, drawn from a generator: the same numbers on every machine.

use rand::{Rng, RngExt};
use std::f64::consts::TAU;

/// How radii are distributed.
#[derive(Clone, Debug, PartialEq)]
pub enum Radii {
    /// Evenly between two (m).
    Uniform([f64; 2]),
    /// R = median · exp(deviation · n), n normally distributed; drawn again outside a range (m).
    LogNormal {
        /// Median of R (m).
        median: f64,
        /// Standard deviation of ln R.
        deviation: f64,
        /// Smallest and largest R (m).
        range: [f64; 2],
    },
    /// Parts of a sieve curve.
    ByMass(Vec<Part>),
}

/// Grains of radii between two sieves, over which their mass is spread evenly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Smallest and largest R (m).
    pub range: [f64; 2],
    /// Share of the number of grains up to the end of this part.
    pub up_to: f64,
    /// Power p of R that mass goes with: 3 for spheres, 2 for discs.
    pub power: i32,
}

impl Radii {
    /// A sieve curve: radii (m) with the share of the mass that is no larger, both rising, the latter from 0 to 1. With the
    /// mass even over a part, numbers go as R⁻ᵖ: of a share w from a to b there are w/(b − a) ∫ R⁻ᵖ dR over the mass at R = 1.
    #[must_use]
    pub fn by_mass(curve: &[(f64, f64)], power: i32) -> Self {
        let number = |a: f64, b: f64, share: f64| {
            let integral = if b > a { antiderivative(b, power) - antiderivative(a, power) } else { a.powi(-power) };
            share * if b > a { integral / (b - a) } else { integral }
        };
        let mut all = 0.0;
        let mut parts = Vec::new();
        for pair in curve.windows(2) {
            let [(a, before), (b, after)] = [pair[0], pair[1]];
            all += number(a, b, after - before);
            parts.push(Part { range: [a, b], up_to: all, power });
        }
        parts.iter_mut().for_each(|part| part.up_to /= all);
        Self::ByMass(parts)
    }

    /// The largest that there can be (m).
    #[must_use]
    pub fn largest(&self) -> f64 {
        match self {
            Self::Uniform([_, large]) | Self::LogNormal { range: [_, large], .. } => *large,
            Self::ByMass(parts) => parts.last().map_or(0.0, |part| part.range[1]),
        }
    }

    /// One of them (m).
    pub fn draw(&self, generator: &mut impl Rng) -> f64 {
        match self {
            Self::Uniform([small, large]) => small + (large - small) * generator.random::<f64>(),
            Self::LogNormal { median, deviation, range } => loop {
                let radius = median * libm::exp(deviation * normal(generator));
                if (range[0]..=range[1]).contains(&radius) {
                    return radius;
                }
            },
            Self::ByMass(parts) => {
                let share: f64 = generator.random();
                let place = parts.partition_point(|part| part.up_to < share).min(parts.len() - 1);
                let Part { range: [a, b], power, .. } = parts[place];
                let within: f64 = generator.random();
                if b <= a {
                    return a;
                }
                let (low, high) = (antiderivative(a, power), antiderivative(b, power));
                // Of −R^(1 − p)/(p − 1) the inverse.
                let value = -f64::from(power - 1) * (low + within * (high - low));
                libm::pow(value, -1.0 / f64::from(power - 1)).clamp(a, b)
            }
        }
    }
}

/// Of R⁻ᵖ.
fn antiderivative(radius: f64, power: i32) -> f64 {
    -radius.powi(1 - power) / f64::from(power - 1)
}

/// A normally distributed number (Box & Muller).
fn normal(generator: &mut impl Rng) -> f64 {
    let size = (-2.0 * libm::log(1.0 - generator.random::<f64>())).sqrt();
    size * libm::cos(TAU * generator.random::<f64>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_pcg::Pcg64;

    fn drawn(radii: &Radii) -> Vec<f64> {
        let mut generator = Pcg64::seed_from_u64(1);
        (0..100_000).map(|_| radii.draw(&mut generator)).collect()
    }

    /// Median and deviation of ln R; a hundred thousand draws tell the mean to a third of a hundredth of the deviation.
    #[test]
    fn logarithms_are_normal() {
        let all = drawn(&Radii::LogNormal { median: 2.0, deviation: 0.3, range: [0.1, 40.0] });
        let logs: Vec<f64> = all.iter().map(|radius| radius.ln()).collect();
        let mean = logs.iter().sum::<f64>() / logs.len() as f64;
        let square = logs.iter().map(|log| (log - mean).powi(2)).sum::<f64>() / logs.len() as f64;
        assert!((mean - 2.0_f64.ln()).abs() < 4e-3 && (square.sqrt() - 0.3).abs() < 3e-3, "{mean} {}", square.sqrt());
    }

    /// A sieve curve comes back from the masses: a third of it evenly from 1 to 2, two thirds from 2 to 4, a step at 4.
    #[test]
    fn masses_follow_the_sieve_curve() {
        let curve = [(1.0, 0.0), (2.0, 1.0 / 3.0), (4.0, 0.8), (4.0, 1.0)];
        for power in [2, 3] {
            let all = drawn(&Radii::by_mass(&curve, power));
            let mass =
                |to: f64| all.iter().filter(|radius| **radius < to).map(|radius| radius.powi(power)).sum::<f64>();
            let whole = mass(5.0);
            for (radius, share) in [(1.5, 1.0 / 6.0), (2.0, 1.0 / 3.0), (3.0, 17.0 / 30.0), (4.0, 0.8)] {
                let found = mass(radius) / whole;
                assert!((found - share).abs() < 0.01, "up to {radius}: {found} for {share}");
            }
        }
    }
}
