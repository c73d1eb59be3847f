//! Hertz contact of a cylinder in plane strain: half-width and peak pressure.

use grainbench_harness::prelude::*;
use grainbench_solver::record::{Owner, PointState};
use nalgebra::{Matrix2, Vector2};

const LEVELS: &[Level] =
    &[cells("b", 1.0, POINTS), cells("b/2", 2.0, POINTS), cells("b/4", 4.0, POINTS), cells("b/8", 8.0, POINTS)];
/// Largest relative errors of half-width and peak pressure that pass with cells as wide as the half-width b.
const COARSEST: [f64; 2] = [0.15, 0.12];
/// (b/R)² with R = 8 b: the relative error on any grid, because the bodies are not half-spaces.
const NO_HALF_SPACE: f64 = 1.0 / 64.0;
/// Material points per cell and axis.
const POINTS: u32 = 2;
/// Solver with APIC, in which material points come to rest. In `mpm` they oscillate under a static load.
const SOLVER: &str = "mpm+apic";
const SOURCE: Source =
    Source::Derived("Hertz: b = √(4PR/πE*), p₀ = 2P/πb; Johnson, Contact Mechanics, §4.2 (derivation)");

pub(crate) static CASE: Case = crate::heads::HERTZ_CYLINDER.with(LEVELS, 1, &claims).drawn_by(figures);

/// Half-width (m) and peak pressure (Pa) of a contact between half-spaces.
#[derive(Clone, Copy, Debug)]
struct Hertz {
    half_width: f64,
    peak: f64,
}

impl Hertz {
    fn from_scene(scene: &Scene) -> Self {
        let compliance =
            |material: &Option<Deformable>| material.map_or(f64::NAN, |deformable| 1.0 / deformable.plane_modulus());
        let modulus = 1.0 / scene.deformable.iter().map(compliance).sum::<f64>();
        let load = weight(scene);
        let half_width = (4.0 * load * scene.grains[0].radius / (PI * modulus)).sqrt();
        Self { half_width, peak: 2.0 * load / (PI * half_width) }
    }

    /// Returns the pressure −σ_yy (Pa) at the distance x from the middle (m) and at a depth z (m) below the surface of
    /// a half-space: (p₀/b) m (1 − (z² + n²)/(m² + n²)) with m², n² = ½(√((b² − x² + z²)² + 4x²z²) ± (b² − x² + z²))
    /// (McEwen 1949; Johnson, eq. 4.49b).
    fn pressure_below(&self, x: f64, depth: f64) -> f64 {
        let side = self.half_width * self.half_width - x * x + depth * depth;
        let root = (side * side + 4.0 * x * x * depth * depth).sqrt();
        let [m, n] = [0.5 * (root + side), 0.5 * (root - side)];
        self.peak / self.half_width * m.max(0.0).sqrt() * (1.0 - (depth * depth + n) / (m + n))
    }
}

/// Returns the line load P (N/m): the cylinder's weight.
fn weight(scene: &Scene) -> f64 {
    scene.grains[0].mass * scene.gravity.norm()
}

/// A material point of the block: position along and below the surface (m), and pressure −σ_yy (Pa).
#[derive(Clone, Copy, Debug)]
struct PressurePoint {
    x: f64,
    depth: f64,
    pressure: f64,
}

/// Returns the material points, initially `from` to `to` cells deep, less than 1.5 b from the middle at the end.
fn pressed(done: &FinishedRun, from: f64, to: f64) -> Result<Vec<PressurePoint>, MissingData> {
    let snapshots = &done.record.snapshots;
    let block = |point: &&PointState| matches!(point.owner, Owner::Body(_));
    let points = |at: Option<&Snapshot>| -> Vec<PointState> {
        at.into_iter().flat_map(|snapshot| &snapshot.points).filter(block).copied().collect()
    };
    let undeformed = points(snapshots.first()).first().map(|point| point.volume.sqrt());
    let cell = undeformed.ok_or("points of the block")? * f64::from(POINTS);
    let reach = 1.5 * Hertz::from_scene(&done.scene).half_width;
    let chosen = points(snapshots.last()).into_iter().filter_map(|point| {
        // The surface is y = 0 at the start.
        let start = (point.displacement.y - point.position.y) / cell;
        let seen = (from..to).contains(&start) && point.position.x.abs() < reach;
        seen.then(|| PressurePoint { x: point.position.x, depth: start * cell, pressure: -point.stress[1] })
    });
    Ok(chosen.collect())
}

/// Fits half-width and peak pressure of the contact by least squares (Gauss–Newton). The half-space solution is
/// compared with the stress of the material points in two layers of cells below the uppermost layer.
fn measured(done: &FinishedRun) -> Result<Hertz, MissingData> {
    let points = pressed(done, 1.0, 3.0)?;
    let mut found = Hertz::from_scene(&done.scene);
    for _ in 0..20 {
        let (mut curvature, mut slope) = (Matrix2::zeros(), Vector2::zeros());
        for point in &points {
            let now = found.pressure_below(point.x, point.depth);
            let wider = Hertz { half_width: found.half_width * (1.0 + 1e-6), ..found };
            // Derivatives by relative changes of the half-width and of the peak. The stress is linear in the peak.
            let by = Vector2::new((wider.pressure_below(point.x, point.depth) - now) / 1e-6, now);
            curvature += by * by.transpose();
            slope += by * (point.pressure - now);
        }
        let inverse = curvature.try_inverse().ok_or("stressed points of the block")?;
        let change = inverse * slope;
        found.half_width *= 1.0 + change.x;
        found.peak *= 1.0 + change.y;
    }
    Ok(found)
}

/// Returns the tolerance for `cells` cells a half-width, from the tolerance for one cell.
fn tolerance(coarsest: f64, cells: f64) -> Tolerance {
    if cells > 1.0 {
        judged(
            NO_HALF_SPACE + (coarsest - NO_HALF_SPACE) / (cells * cells),
            "(b/R)² = 1.6 % because the bodies are no half-spaces, plus the tolerance of cells of size b, which \
             decreases with the square of the cell",
        )
    } else {
        judged(
            coarsest,
            "cells as wide as half the patch, contact springs as soft as .4 cells of material, strains of 5 %",
        )
    }
}

/// Returns the remaining oscillation of the cylinder's force about equilibrium after 0.4 ms, divided by the weight.
///
/// The half-width grows as √P. A small additional load dP therefore moves the centre of the cylinder towards the base of
/// the block, which is d below the contact, by dP/π [(2 ln(2R/b) − 5/4 − n/4)/E'₁ + (2 ln(2d/b) − n − 1)/E'₂] with n =
/// ν/(1 − ν). The inertia of the cylinder balances dP: see `PressedDisc::gives`. Johnson, Contact Mechanics, eq. 5.58,
/// has the layer on a base. Steel on aluminium, R = d = 0.05 m.
fn swings() -> f64 {
    let (radius, half_width, poisson, damping) = (0.05_f64, 6.2146e-3, 0.3, 40_000.0_f64);
    let [steel, aluminium] = [210e9, 70e9].map(|young| young / (1.0 - poisson * poisson));
    let (logarithm, n) = (2.0 * (2.0 * radius / half_width).ln(), poisson / (1.0 - poisson));
    let cylinder = (logarithm - 1.25 - 0.25 * n) / steel;
    let block = (logarithm - n - 1.0) / aluminium;
    let mass = 7850.0 * PI * radius * radius;
    let squared = PI / ((cylinder + block) * mass);
    (-0.5 * damping * 4e-4).exp() / (1.0 - 0.25 * damping * damping / squared).sqrt()
}

fn claims() -> Vec<Claim> {
    let mut claims = Vec::new();
    for (level, cells) in LEVELS.iter().zip([1.0, 2.0, 4.0, 8.0]) {
        let run = Run::new(PLAIN, SOLVER, level.resolution);
        // Runs with b/2 and b/4 take seconds, a run with b/8 a minute.
        let run = match cells {
            1.0 => run,
            2.0 => run.slow(),
            _ => run.long(),
        };
        claims.extend([
            claim(format!("half-width of the contact, cells of {}", level.name), "m")
                .run(run.clone())
                .equals(SOURCE, |done| {
                    let exact = Hertz::from_scene(&done[0].scene);
                    Ok(Measurement::relative(measured(&done[0])?.half_width, exact.half_width))
                })
                .within(tolerance(COARSEST[0], cells))
                .refuses(as_stiff()),
            claim(format!("peak pressure, cells of {}", level.name), "Pa")
                .run(run)
                .equals(SOURCE, |done| {
                    Ok(Measurement::relative(measured(&done[0])?.peak, Hertz::from_scene(&done[0].scene).peak))
                })
                .within(tolerance(COARSEST[1], cells))
                .refuses(as_stiff()),
        ]);
    }
    claims.extend([
        claim("order in the cell of the error of the half-width, 1 and 2 cells a half-width", "1")
            .runs(LEVELS[..2].iter().map(|level| Run::new(PLAIN, SOLVER, level.resolution).slow()))
            .converges_at_least(1.0, SOURCE, |done| {
                let error = |done: &FinishedRun| -> Result<f64, MissingData> {
                    Ok((measured(done)?.half_width / Hertz::from_scene(&done.scene).half_width - 1.0).abs())
                };
                Ok((error(&done[0])? / error(&done[1])?).log2())
            })
            .within(exactly("cells as wide as half the patch are too coarse for an exact order"))
            .refuses(as_stiff()),
        claim("contact force at rest", "N/m")
            .run(Run::new(PLAIN, SOLVER, LEVELS[1].resolution).slow().known(
                "with APIC the cylinder comes to rest more slowly than a rigid cylinder on the springs of both bodies: \
                 0.07 % of its weight remains, but at most 0.05 % is allowed",
            )
            .up_to(1e-3))
            .holds("equilibrium: the cylinder's weight", |done| {
                let last = done[0].record.snapshots.last();
                let contact = last.and_then(|snapshot| snapshot.told_contacts().first()).ok_or("contact")?;
                Ok(Measurement::relative(contact.normal_force, weight(&done[0].scene)))
            })
            .within(computed(
                swings(),
                "the cylinder starts without contact force and vibrates about its equilibrium: after .4 ms exp(−αt/2) \
                 ω/√(ω² − α²/4) of the weight remains under the damping α = 40000/s, with ω from the compliance of a \
                 cylinder whose inertia balances the force, and of a layer on a base (Johnson, eq. 5.58)",
            ))
            .refuses(Control::without_the_error("points that keep their velocities", "mpm", LEVELS[1].resolution)),
    ]);
    claims
}

fn as_stiff() -> Control {
    Control::scene("the block as stiff as the cylinder", |scene| scene.deformable[1] = scene.deformable[0])
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for level in &LEVELS[..if runner.is_thorough() { 2 } else { 1 }] {
        let done = runner.run(&Run::new(PLAIN, SOLVER, level.resolution))?;
        let exact = Hertz::from_scene(&done.scene);
        let cell = done.scene.reference_length / if *level == LEVELS[0] { 1.0 } else { 2.0 };
        let mut points = pressed(&done, 1.0, 1.5).unwrap_or_default();
        points.sort_by(|a, b| a.x.total_cmp(&b.x));
        let seen = points.iter().map(|point| (point.x / exact.half_width, point.pressure / exact.peak));
        curves.push(Curve::new(format!("mpm+apic, cells of {}", level.name), Stroke::MarkedLine, seen.collect()));
        let way = (-60..=60).map(|at| f64::from(at) * exact.half_width / 40.0);
        let below = way.map(|x| (x / exact.half_width, exact.pressure_below(x, 1.25 * cell) / exact.peak));
        curves.push(Curve::new(format!("Hertz, cells of {}", level.name), Stroke::Dashed, below.collect()));
    }
    Ok(vec![Figure::graph(
        "pressure",
        "Pressure in the block under a cylinder, 1.25 cells below its surface",
        "Vertical stress of the material points in the second layer of cells (markers), compared with Hertz's \
         contact on a half-space at the same depth of 1.25 cells (dashes). Lengths are over the half-width b of the contact.",
        [Axis::linear("x / b"), Axis::linear("pressure / p₀")],
        curves,
    )])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks the values of the printed example, and the stress on the axis, p₀/√(1 + z²/b²).
    #[test]
    fn hertz_is_as_printed() {
        let scene = CASE.variant(PLAIN).unwrap_or_else(|error| panic!("{error}"));
        let exact = Hertz::from_scene(&scene);
        assert!((exact.half_width / 6.2146e-3 - 1.0).abs() < 1e-5, "{exact:?}");
        assert!((exact.peak / 3585.4e6 - 1.0).abs() < 2e-5, "{exact:?}");
        let on_axis = exact.pressure_below(0.0, exact.half_width);
        assert!((on_axis / exact.peak - 0.5_f64.sqrt()).abs() < 1e-12);
        let at_surface = exact.pressure_below(0.6 * exact.half_width, 0.0);
        assert!((at_surface / exact.peak - 0.8).abs() < 1e-12);
    }
}
