//! Distributions of radii, sampled with a random number generator. The samples are the same on every machine.

use rand::{Rng, RngExt};
use std::f64::consts::TAU;

/// Distribution of radii.
#[derive(Clone, Debug, PartialEq)]
pub enum Radii {
    /// Uniform distribution between two radii (m).
    Uniform([f64; 2]),
    /// Log-normal distribution: R = median · exp(deviation · n) with a standard normal variable n. Radii outside a
    /// range (m) are drawn again.
    LogNormal {
        /// Median of R (m).
        median: f64,
        /// Standard deviation of ln R.
        deviation: f64,
        /// Smallest and largest R (m).
        range: [f64; 2],
    },
    /// Sieve curve, as a list of parts.
    ByMass(Vec<Part>),
}

/// Part of a sieve curve: grains with radii between two sieves. The mass is distributed uniformly over the radii.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Smallest and largest R (m).
    pub range: [f64; 2],
    /// Fraction of all grains, by number, whose radii are at most the largest R of this part.
    pub up_to: f64,
    /// Power p in mass ∝ Rᵖ: 3 for spheres, 2 for discs.
    pub power: i32,
}

impl Radii {
    /// Returns the distribution of a sieve curve: pairs of a radius (m) and the mass fraction of the grains up to this
    /// radius. Radii and fractions must not decrease. The first fraction must be 0, and the last 1. The mass is
    /// distributed uniformly over the radii of a part, so the number density is proportional to R⁻ᵖ. A mass fraction w
    /// between the radii a and b thus contains w/(b − a) ∫ R⁻ᵖ dR grains, in units of the inverse mass of a grain with
    /// R = 1 m.
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

    /// Returns the largest possible radius (m).
    #[must_use]
    pub fn largest(&self) -> f64 {
        match self {
            Self::Uniform([_, large]) | Self::LogNormal { range: [_, large], .. } => *large,
            Self::ByMass(parts) => parts.last().map_or(0.0, |part| part.range[1]),
        }
    }

    /// Draws a radius (m).
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
                // Inverse of −R^(1 − p)/(p − 1).
                let value = -f64::from(power - 1) * (low + within * (high - low));
                libm::pow(value, -1.0 / f64::from(power - 1)).clamp(a, b)
            }
        }
    }
}

/// Returns the antiderivative of R⁻ᵖ at a radius R.
fn antiderivative(radius: f64, power: i32) -> f64 {
    -radius.powi(1 - power) / f64::from(power - 1)
}

/// Draws a normally distributed number (Box & Muller).
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

    /// Checks the mean and the standard deviation of ln R. The standard error of the mean of 10⁵ draws is 0.003 times
    /// the deviation.
    #[test]
    fn logarithms_are_normal() {
        let all = drawn(&Radii::LogNormal { median: 2.0, deviation: 0.3, range: [0.1, 40.0] });
        let logs: Vec<f64> = all.iter().map(|radius| radius.ln()).collect();
        let mean = logs.iter().sum::<f64>() / logs.len() as f64;
        let square = logs.iter().map(|log| (log - mean).powi(2)).sum::<f64>() / logs.len() as f64;
        assert!((mean - 2.0_f64.ln()).abs() < 4e-3 && (square.sqrt() - 0.3).abs() < 3e-3, "{mean} {}", square.sqrt());
    }

    /// The masses of drawn grains reproduce a sieve curve. The mass fraction rises to 1/3 at the radius 2 and to .8 at
    /// the radius 4, with a step to 1 at the radius 4.
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
