//! The discs as elastic bodies: contact force at rest, the frequency at which they ring, and the spring that they show.
//!
//! Without friction. The walls move in by d = .01 R and stop; a row of three diameters is shortened by 2d, with as much across. Rigid discs on
//! springs k_n have the force k_n d/2 everywhere and ring with ω² = 2 k_n/m. Elastic ones have F(2d/3) in closed form; half of a
//! diameter's compliance lies at each of its contacts, a whole one between two discs, so that ω² = 3 (dF/dδ)/m.

use crate::elastic::{Pressed, stiffen};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run};
use crate::measure::dominant_frequency;
use crate::verdict::Evidence;
use grainbench_scene::body::{Constitutive, Deformable};
use grainbench_scene::motion::Moment;
use grainbench_scene::scene::{Duration, Sampling, Scene};
use grainbench_scene::solver::Resolution;

const SOURCE: &str = "Johnson, Contact Mechanics, §5.6: a cylinder between two flats, with the pair across (derivation)";
/// Distance by which each wall moves in (m), and how long it takes (s).
const SQUEEZE: f64 = 0.5;
const RAMP: f64 = 0.4;
/// Periods of the ringing are some .5 s.
const TIME: f64 = RAMP + 5.0;
const CELLS: f64 = 6.0;

/// Discs of E' = 1.6 GPa, ν = 1/4; the walls stop.
fn elastic(scene: &mut Scene) {
    scene.deformable[0] =
        Some(Deformable { bulk_modulus: 1.0e9, shear_modulus: 0.6e9, constitutive: Constitutive::NeoHookean });
    for wall in &mut scene.walls {
        let phase = &mut wall.motion.phases[0];
        phase.velocity *= SQUEEZE / RAMP / phase.velocity.norm();
        phase.stop = Moment::Seconds(RAMP);
    }
    scene.duration = Duration::Seconds(TIME);
    scene.sampling = Sampling::Seconds(0.01);
}

fn run(solver: &'static str) -> Run {
    Run::new("kappa-0", solver, Resolution::grid(CELLS, 3)).adjusted("elastic discs", elastic).slow()
}

/// Force at the walls at rest and stiffness of a diameter about it, in closed form.
fn exact(scene: &Scene) -> Result<(f64, f64), Missing> {
    let disc = |sides| Pressed::of(scene, sides).ok_or_else(|| Missing("moduli".to_owned()));
    let force = disc(4)?.force(2.0 / 3.0 * SQUEEZE);
    // A disc that rings between two others is pressed on by one as much as it is let go by the other, and does not widen.
    Ok((force, disc(2)?.stiffness(force)))
}

/// The same discs as rigid ones on springs that have that force at rest.
fn on_springs(scene: &mut Scene) {
    elastic(scene);
    if let Ok((force, _)) = exact(scene) {
        scene.change_laws(|law| law.normal_stiffness = 2.0 * force / SQUEEZE);
    }
}

/// Force of an edge disc on its wall after the walls have stopped, with its times.
fn ringing(done: &Done) -> Result<(Vec<f64>, Vec<f64>), Missing> {
    let force = done.column("wall-edge.normal_force")?;
    Ok(done.series().time.iter().zip(force).filter(|(time, _)| **time > RAMP).unzip())
}

fn frequency(done: &Done) -> Result<f64, Missing> {
    let (_, stiffness) = exact(&done.scene)?;
    let near = (3.0 * stiffness / done.scene.grains[0].mass).sqrt();
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
            (FORCE, "patches of a quarter of a cell, on springs as soft as half a cell of material"),
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
                let expected = (3.0 * exact(&done[0].scene)?.1 / done[0].scene.grains[0].mass).sqrt();
                Ok(Measured::new(frequency(&done[0])?, expected, expected))
            },
        ),
        Gate::new(
            ("frequency of elastic discs over that of rigid ones on springs with their force at rest", "1"),
            vec![
                run("mpm"),
                Run::new("kappa-0", "dem", Resolution::CriticalFraction(0.05)).adjusted("springs with the force of elastic discs", on_springs).aside(),
            ],
            (Evidence::Analytic, SOURCE),
            (FREQUENCY, "that of the frequency"),
            softer(),
            |done| {
                let (force, stiffness) = exact(&done[0].scene)?;
                let expected = (3.0 * stiffness * SQUEEZE / (4.0 * force)).sqrt();
                Ok(Measured::new(frequency(&done[0])? / frequency(&done[1])?, expected, expected))
            },
        ),
    ]
}

const FORCE: f64 = 0.15;
const FREQUENCY: f64 = 0.08;
