//! Large deflection of a cantilever under its own weight.

use crate::exact::bisection;
use grainbench_harness::prelude::*;

const POINTS: u32 = 3;
const LEVELS: &[Level] = &[cells("t/2", 2.0, POINTS), cells("t/3", 3.0, POINTS)];
const SOURCE: Source = Source::Derived("EI θ'' = −w (L − s) cos θ by shooting (derivation)");

const SINKING: ClaimFigure = ClaimFigure {
    name: "sinking",
    title: "Displacement of the tip",
    caption: "The strip is released at rest in a horizontal position and damped. The legend gives the cell length in \
              parts of the thickness.",
    axes: ["time t (s)", "displacement (m)"],
    logarithmic: false,
};

pub(crate) static CASE: Case = crate::heads::HEAVY_CANTILEVER.with(LEVELS, 0, &claims);

/// Elastica under its own weight, in units of its length.
#[derive(Clone, Copy, Debug)]
struct Elastica {
    /// Curvature at the clamp, multiplied by the length.
    curvature: f64,
    /// Displacement of the tip below the clamp.
    sinking: f64,
    /// Angle of the tip below the horizontal (rad).
    angle: f64,
    /// Curvature at the tip, multiplied by the length; zero for the solution.
    left: f64,
}

impl Elastica {
    /// Solves for γ = w L³/EI by bisection of the curvature at the clamp.
    fn under(weight: f64) -> Self {
        let [low, high] = bisection([0.0, weight], 60, |curvature| Self::shot(weight, curvature).left <= 0.0);
        Self::shot(weight, 0.5 * (low + high))
    }

    /// Integrates from the clamp to the tip by Runge-Kutta, for an assumed curvature at the clamp.
    fn shot(weight: f64, curvature: f64) -> Self {
        const STEPS: u32 = 1000;
        let step = 1.0 / f64::from(STEPS);
        let slope = |s: f64, [angle, bend, _]: [f64; 3]| [bend, -weight * (1.0 - s) * angle.cos(), angle.sin()];
        let mut state = [0.0, curvature, 0.0];
        for at in 0..STEPS {
            let s = f64::from(at) * step;
            let ahead = |by: f64, rate: [f64; 3]| [0, 1, 2].map(|part| state[part] + by * rate[part]);
            let first = slope(s, state);
            let second = slope(s + 0.5 * step, ahead(0.5 * step, first));
            let third = slope(s + 0.5 * step, ahead(0.5 * step, second));
            let fourth = slope(s + step, ahead(step, third));
            let mean = |part: usize| (first[part] + 2.0 * second[part] + 2.0 * third[part] + fourth[part]) / 6.0;
            state = [0, 1, 2].map(|part| state[part] + step * mean(part));
        }
        Self { curvature, sinking: state[2], angle: state[0], left: state[1] }
    }
}

/// Returns length and thickness (m), and γ = w L³/EI.
fn strip(scene: &Scene) -> Option<[f64; 3]> {
    let beam = scene.bodies.first()?;
    let BlockShape::Box { low, high } = beam.shape else { return None };
    let material = scene.deformable.first().copied().flatten()?;
    let [length, thickness] = [high.x - low.x, high.y - low.y];
    // For ν = 0, E is the longitudinal modulus.
    let stiffness = material.longitudinal_modulus() * thickness * thickness / 12.0;
    Some([length, thickness, beam.density * -scene.gravity.y * length.powi(3) / stiffness])
}

/// Returns the tolerance relative to the deflection: effects of the thickness and of the spacing of points at the tip.
fn allowed(level: Level) -> f64 {
    let Resolution::Grid { cells, points, .. } = level.resolution else { return f64::NAN };
    let (thickness, Elastica { curvature, sinking, angle, .. }) = (0.05, Elastica::under(10.0));
    let spacing = thickness / cells / f64::from(points);
    0.8 * thickness * thickness + (0.5 * curvature * thickness).powi(2) + 0.5 * spacing * angle.sin() / sinking
}

fn claims() -> Vec<Claim> {
    LEVELS
        .iter()
        .map(|&level| {
            let run = Run::new(PLAIN, "mpm", level.resolution);
            let run = if level.name == LEVELS[0].name { run } else { run.slow() };
            claim(format!("displacement of the tip at rest, cells of {}", level.name), "m")
                .run(run)
                .equals(SOURCE, |done| {
                    let [length, _, weight] = strip(&done[0].scene).ok_or("a strip")?;
                    let exact = -length * Elastica::under(weight).sinking;
                    Ok(Measurement::relative(done[0].last("tip.uy")?, exact))
                })
                .within(computed(
                    allowed(level),
                    "shear of .8 (t/L)², the square of the strain of the faces, and half the spacing of points at the tip",
                ))
                .refuses(Control::scene("gravity × .9", |scene| scene.gravity *= 0.9))
                .solver_independent_continuum()
                .drawn(&SINKING, level.name)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares the solution with the values in `derivation.md`.
    #[test]
    fn the_elastica_is_that_of_the_derivation() {
        let Elastica { curvature, sinking, angle, left } = Elastica::under(10.0);
        assert!((curvature - 3.7422).abs() < 5e-5 && (sinking - 0.700_20).abs() < 5e-6, "{curvature} {sinking}");
        assert!((angle - 1.0526).abs() < 5e-5 && left.abs() < 1e-12, "{angle} {left}");
        assert!((Elastica::under(9.0).sinking - 0.673_08).abs() < 5e-6);
    }

    /// Checks that the deflection is w L⁴/8EI up to the square of the angle.
    #[test]
    fn a_light_cantilever_bends_as_a_beam() {
        let weight = 1e-3;
        assert!((Elastica::under(weight).sinking * 8.0 / weight - 1.0).abs() < weight * weight);
    }
}
