//! Objectivity: rigid rotation of grains together with walls, and of free deformable bodies.

use super::end::{End, NoEnd};
use super::row::{PropertyValue, Rows};
use super::scenes::NamedScene;
use super::turning::{self, RotatingScene};
use super::{Flaw, Property};
use crate::evidence::Evidence;
use crate::expect::larger;
use crate::verdict::Verdict;
use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::record::{PointState, Record};
use grainbench_solver::resolution::Resolution;
use grainbench_solver::terms::Terms;
use nalgebra::Vector3;

pub(super) const PROPERTY: Property = Property {
    name: "objectivity",
    claim: "grains that rotate with their walls as one rigid body stay at rest relative to the walls, and a freely \
            rotating body keeps its size and spin",
    flaw: Flaw::SlowerWalls,
    evidence: Evidence::Analytic,
    source: "the forces in the frame at rest, plus the centrifugal force",
    because: "errors at a distance d from the axis, after an angle θ. The time step gives d (ΩΔt)² (1 + θ)², and for a \
              grain on springs also 2 d (Ω/ω)² ωT (ωΔt)²/24; without a claimed order it gives d ΩΔt (1 + θ). Lever \
              arms differ from the radius by up to the overlap δ, which gives 2Ωδ/R in spins, and 2δθ in positions if \
              the centre moves. Different Ωδ on the two sides rotate the direction of vibration, which gives d (Ω/ω)² \
              θ. Rigid grains differ by 2 d (Ω/ω)² + δ. Bodies grow by at most ρΩ²R²/E and (ΩΔt)² (1 + θ), and lose \
              twice this fraction of their spin",
    check,
};

/// Quantity and unit of each result. Contacts that rotate about their normals have their own quantity, because a method
/// may have a stated exception for them.
const PLACE: (&str, &str) = ("place off in the end", "m");
const TWISTED: (&str, &str) = ("place off in the end, under twist", "m");
const SPIN: (&str, &str) = ("spin × radius off in the end", "m/s");
const SIZE: (&str, &str) = ("size off, largest of two time steps", "1");
const SPINNING: (&str, &str) = ("spin off, largest of two time steps", "1");

fn check(rows: &Rows<'_>) -> Vec<Verdict> {
    if rows.solver.deforms() { of_bodies(rows) } else { of_grains(rows) }
}

/// Returns the results for rigid grains and for grains with contact springs.
fn of_grains(rows: &Rows<'_>) -> Vec<Verdict> {
    let only = |wanted: fn(&RotatingScene) -> bool| {
        turning::all().map(|all| all.into_iter().filter(wanted).collect::<Vec<_>>())
    };
    // A solver that claims an order also runs at four times the time step. The tolerance varies with this order.
    let coarse = rows.terms.order.and_then(|_| rows.terms.resolution.coarser(4.0));
    let levels = [Some(rows.terms.resolution), coarse];
    let end = |turning: &RotatingScene, resolution: &Resolution| {
        End::from_solver(rows.solver, &turning.named.scene, resolution)
    };
    let place = |turning: &RotatingScene| {
        worst(levels, turning.reach(), |resolution| {
            let end = end(turning, resolution)?;
            let grains = end.grains.iter().zip(turning.named.scene.grains.iter());
            let off = grains.map(|(grain, start)| (grain.position - turning.place(start.position, end.time)).norm());
            Ok((off.fold(0.0, larger), place_allowed(rows, turning, &end)))
        })
    };
    let spin = |turning: &RotatingScene| {
        worst(levels, turning.spin.norm(), |resolution| {
            let end = end(turning, resolution)?;
            // Spin times radius (m/s).
            let off = end.grains.iter().map(|grain| (grain.spin - turning.spin).norm() * grain.radius);
            let allowed = turning.spin.norm() * (scheme(turning, &end, rows.terms) + 2.0 * turning.overlap);
            Ok((off.fold(0.0, larger), allowed))
        })
    };
    let resolution = &rows.terms.resolution;
    [
        rows.each(only(|turning| !turning.twisted), resolution, PLACE, place),
        rows.each(only(|turning| turning.twisted), resolution, TWISTED, place),
        // Contacts that rotate only about their normals exert no torque on a grain. These scenes are left out.
        rows.each(only(|turning| turning.across > 0.0 || turning.carried), resolution, SPIN, spin),
    ]
    .concat()
}

/// Returns the deviation that is the largest fraction of its tolerance. `read` returns the deviation and its tolerance at a
/// resolution. A deviation that is NaN is returned at once.
fn worst(
    levels: [Option<Resolution>; 2],
    scale: f64,
    read: impl Fn(&Resolution) -> Result<(f64, f64), NoEnd>,
) -> Result<PropertyValue, NoEnd> {
    let mut worst: Option<(f64, f64)> = None;
    for resolution in levels.iter().flatten() {
        let (off, allowed) = read(resolution)?;
        if off.is_nan() {
            return Ok(PropertyValue::deviation(off, scale, allowed));
        }
        if worst.is_none_or(|(most, passes)| off / allowed > most / passes) {
            worst = Some((off, allowed));
        }
    }
    let (off, allowed) = worst.unwrap_or((f64::NAN, 0.0));
    Ok(PropertyValue::deviation(off, scale, allowed))
}

/// Returns the relative error that a scheme may have after the rotation of the scene. The error is of second order in the
/// time step if the solver claims at least this order, and of first order otherwise.
fn scheme(turning: &RotatingScene, end: &End, terms: &Terms) -> f64 {
    let step = turning.spin.norm() * end.time_step;
    let angle = 1.0 + RotatingScene::angle();
    if terms.order.is_some_and(|order| order.expected >= 2.0) { (step * angle).powi(2) } else { step * angle }
}

/// Returns the largest allowed distance from the exact position (m).
fn place_allowed(rows: &Rows<'_>, turning: &RotatingScene, end: &End) -> f64 {
    let terms = rows.terms;
    let rate = turning.spin.norm();
    let softness = |frequency: f64| 2.0 * (rate / frequency).powi(2);
    let swing = turning.frequency.map_or(0.0, |frequency| {
        let phase = frequency * end.time * (frequency * end.time_step).powi(2) / 24.0;
        let arms = 0.5 * turning.across * RotatingScene::angle().min(2.0);
        softness(frequency) * (arms + if terms.order.is_some() { phase } else { 1.0 })
    });
    let lever = if turning.carried { 2.0 * turning.overlap * RotatingScene::angle() } else { 0.0 };
    let rigid = if is_rigid(&terms.resolution) { turning.overlap } else { 0.0 };
    turning.reach() * (scheme(turning, end, terms) + swing) + lever + rigid
}

/// Returns true if a resolution is for rigid bodies, whose contacts have no springs.
pub(super) const fn is_rigid(resolution: &Resolution) -> bool {
    matches!(resolution, Resolution::Rigid { .. })
}

fn of_bodies(rows: &Rows<'_>) -> Vec<Verdict> {
    let levels = [Some(rows.terms.resolution), shorter(&rows.terms.resolution)];
    let judge = |named: &NamedScene, times: f64, read: fn(&dyn Solver, &Scene, &Record) -> Result<f64, NoEnd>| {
        worst(levels, 1.0, |resolution| {
            let record = rows.solver.run(&named.scene, resolution, &mut ())?;
            Ok((read(rows.solver, &named.scene, &record)?, times * strained(&named.scene, &record)))
        })
    };
    let resolution = &rows.terms.resolution;
    let size = rows.each(turning::free(), resolution, SIZE, |named| judge(named, 1.0, size_off));
    let spin = rows.each(turning::free(), resolution, SPINNING, |named| judge(named, 2.0, spinning_off));
    [size, spin].concat()
}

/// Returns the resolution with half the time step. The grid does not change.
fn shorter(resolution: &Resolution) -> Option<Resolution> {
    match *resolution {
        Resolution::Grid { cells, points, courant } => Some(Resolution::Grid { cells, points, courant: 0.5 * courant }),
        other => other.coarser(0.5),
    }
}

/// Returns the largest allowed relative change of size. Twice this change is allowed for the spin.
///
/// Suddenly applied centrifugal forces strain the body by less than ρΩ²R²/E, including the overshoot. Here ρ is the density, Ω
/// the spin, R the radius and E Young's modulus. At the centre of a disc, the strain is at most 0.375 ρΩ²R²/E. The time step
/// Δt adds (ΩΔt)² (1 + θ), where θ is the angle of rotation.
fn strained(scene: &Scene, record: &Record) -> f64 {
    let grain = &scene.grains[0];
    let density = grain.mass / scene.grain_shape.mass(grain.radius, 1.0);
    let modulus = scene.deformable[usize::from(grain.material)].map_or(f64::NAN, |material| {
        let [bulk, shear] = [material.bulk_modulus, material.shear_modulus];
        9.0 * bulk * shear / (3.0 * bulk + shear)
    });
    let rate = grain.spin.norm();
    let angle = scene.duration.seconds().unwrap_or(f64::NAN) * rate;
    density * (rate * grain.radius).powi(2) / modulus + (rate * record.provenance.time_step).powi(2) * (1.0 + angle)
}

/// Returns the relative change of the radius of gyration of the material points during the run.
fn size_off(solver: &dyn Solver, _: &Scene, record: &Record) -> Result<f64, NoEnd> {
    let points = record.snapshots.last().map_or(&[][..], |last| &last.points);
    if points.is_empty() {
        return Err(RunError::Unsupported {
            solver: solver.name(),
            reason: "the record contains no material points".to_owned(),
        }
        .into());
    }
    let gyration = |place: fn(&PointState) -> Vector3<f64>| {
        let centre = points.iter().map(place).sum::<Vector3<f64>>() / points.len() as f64;
        points.iter().map(|point| (place(point) - centre).norm_squared()).sum::<f64>()
    };
    let (end, start) = (gyration(|point| point.position), gyration(|point| point.position - point.displacement));
    Ok(((end / start).sqrt() - 1.0).abs())
}

/// Returns the relative change of the spin during the run.
fn spinning_off(_: &dyn Solver, scene: &Scene, record: &Record) -> Result<f64, NoEnd> {
    let end = End::read(scene, record)?;
    let start = scene.grains[0].spin;
    Ok((end.grains[0].spin - start).norm() / start.norm())
}
