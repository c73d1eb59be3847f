//! The discs as elastic bodies: the force at the walls, the frequency at which they ring between them, and the spring that they show.
//!
//! The walls move in by d = .01 R and stop; by symmetry the plane between the discs is one more wall. A disc's diameter is shortened by d.
//! A rigid disc on springs k_n has the wall force F = (2/3) k_n d and rings with ω² = 3 k_n/m. An elastic one has F(d) in closed form, and
//! as its compliance lies one half at each of its two contacts, ω² = 4 (dF/dd)/m as long as it moves as a whole.

use crate::bench::Bench;
use crate::case::PLAIN;
use crate::elastic::{Pressed, stiffen};
use crate::figure::{Axis, Curve, Figure, Stroke};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run};
use crate::measure::dominant_frequency;
use crate::verdict::Evidence;
use grainbench_scene::body::{Constitutive, Deformable};
use grainbench_scene::motion::Moment;
use grainbench_scene::scene::{Duration, Sampling, Scene};
use grainbench_scene::solver::{Resolution, RunError};

const SOURCE: &str = "Johnson, Contact Mechanics, §5.6: a cylinder between two flats (derivation)";
/// Distance by which each wall moves in (m), and how long it takes (s).
const SQUEEZE: f64 = 0.01;
const RAMP: f64 = 1.2;
/// Periods of the ringing are some 1.6 s.
const TIME: f64 = RAMP + 16.0;
const CELLS: f64 = 8.0;

/// Discs of E' = 16 Pa, ν = 1/4, as heavy as in the example; the walls stop.
fn elastic(scene: &mut Scene) {
    scene.deformable[0] =
        Some(Deformable { bulk_modulus: 10.0, shear_modulus: 6.0, constitutive: Constitutive::NeoHookean });
    for wall in &mut scene.walls {
        let phase = &mut wall.motion.phases[0];
        phase.velocity *= SQUEEZE / RAMP / phase.velocity.norm();
        phase.stop = Moment::Seconds(RAMP);
    }
    scene.duration = Duration::Seconds(TIME);
    scene.sampling = Sampling::Seconds(0.02);
}

fn run(solver: &'static str) -> Run {
    Run::new(PLAIN, solver, Resolution::grid(CELLS, 3)).adjusted("elastic discs", elastic)
}

/// Force at the walls at rest and stiffness of a diameter about it, in closed form.
fn exact(scene: &Scene) -> Result<(f64, f64), Missing> {
    let disc = Pressed::of(scene, 2).ok_or_else(|| Missing("moduli".to_owned()))?;
    let force = disc.force(SQUEEZE);
    Ok((force, disc.stiffness(force)))
}

/// The same discs as rigid ones on springs that have that force at rest.
fn on_springs(scene: &mut Scene) {
    elastic(scene);
    if let Ok((force, _)) = exact(scene) {
        scene.change_laws(|law| law.normal_stiffness = 1.5 * force / SQUEEZE);
    }
}

/// Force at the left wall after the walls have stopped, with its times.
fn ringing(done: &Done) -> Result<(Vec<f64>, Vec<f64>), Missing> {
    let force = done.column("A.normal_force")?;
    Ok(done.series().time.iter().zip(force).filter(|(time, _)| **time > RAMP).unzip())
}

fn frequency(done: &Done) -> Result<f64, Missing> {
    let (_, stiffness) = exact(&done.scene)?;
    let near = (4.0 * stiffness / done.scene.grains[0].mass).sqrt();
    let (time, force) = ringing(done)?;
    Ok(dominant_frequency(&time, &force, 0.5 * near, 1.6 * near))
}

pub(super) fn gates() -> Vec<Gate> {
    let softer = || Control::scene("discs a quarter softer", |scene| stiffen(scene, 0.75));
    vec![
        Gate::new(
            ("force at the wall of elastic discs, mean after the walls have stopped", "N/m"),
            vec![run("mpm")],
            (Evidence::Analytic, SOURCE),
            (FORCE, "patches of a third of a cell, on springs as soft as half a cell of material"),
            softer(),
            |done| {
                let (force, _) = exact(&done[0].scene)?;
                let (_, found) = ringing(&done[0])?;
                Ok(Measured::new(found.iter().sum::<f64>() / found.len() as f64, force, force))
            },
        ),
        Gate::new(
            ("frequency at which elastic discs ring", "rad/s"),
            vec![run("mpm")],
            (Evidence::Analytic, SOURCE),
            (FREQUENCY, "half the error of the stiffness, and discs that do not move quite as a whole"),
            softer(),
            |done| {
                let expected = (4.0 * exact(&done[0].scene)?.1 / done[0].scene.grains[0].mass).sqrt();
                Ok(Measured::new(frequency(&done[0])?, expected, expected))
            },
        ),
        Gate::new(
            ("frequency of elastic discs over that of rigid ones on springs with their force at rest", "1"),
            vec![
                run("mpm"),
                Run::new(PLAIN, "dem", Resolution::CriticalFraction(0.05)).adjusted("springs with the force of elastic discs", on_springs).aside(),
            ],
            (Evidence::Analytic, SOURCE),
            (FREQUENCY, "that of the frequency"),
            softer(),
            |done| {
                let (force, stiffness) = exact(&done[0].scene)?;
                let expected = (4.0 * stiffness * SQUEEZE / (4.5 * force)).sqrt();
                Ok(Measured::new(frequency(&done[0])? / frequency(&done[1])?, expected, expected))
            },
        ),
    ]
}

const FORCE: f64 = 0.15;
const FREQUENCY: f64 = 0.08;

pub(super) fn figure(bench: &Bench) -> Result<Figure, RunError> {
    let springs = Run::new(PLAIN, "dem", Resolution::CriticalFraction(0.05));
    let springs = springs.adjusted("springs with the force of elastic discs", on_springs);
    let mut curves = Vec::new();
    for (name, run) in [("mpm, elastic discs", run("mpm")), ("dem, k_n = 3F/2d", springs)] {
        let done = bench.run(&run)?;
        let unit = exact(&done.scene).map_or(1.0, |(force, _)| force);
        let force = done.series().column("A.normal_force").unwrap_or_default();
        let points = done.series().time.iter().zip(force).map(|(&time, force)| (time, force / unit)).collect();
        curves.push(Curve::new(name, Stroke::Line, points));
    }
    Ok(Figure::graph(
        "elastic",
        "Force at the wall: elastic discs, and rigid ones on springs",
        "The walls move in by d = .01 R and stop. A spring of k_n = 3F/2d, F the force of elastic discs in closed form, gives the force at \
         rest; the frequency is then nearly theirs.",
        [Axis::linear("time t (s)"), Axis::linear("force / F")],
        curves,
    ))
}
