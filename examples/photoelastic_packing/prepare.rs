//! Preparation of a dense packing of discs in contact. Frictionless discs move at random while the walls close slowly,
//! as in a shaken assembly. When the discs are jammed, they are stopped. The walls then compress them with damping, and
//! open until the contacts are free of force.

use super::walls::{Course, drive, go_on_from, run, size, stop, watch};
use grainbench::cases::stage::Stage;
use grainbench::scene::nalgebra::Vector3;
use grainbench::scene::scene::Scene;
use std::error::Error;

/// Initial speed of the discs (m/s). Before each interval, the velocities are scaled so that the discs have their
/// initial kinetic energy, because the walls do work on the discs.
const SPEED: f64 = 0.3;
/// Duration of an interval (s).
const STRETCH: f64 = 50.0;
/// Maximum number of intervals.
const STRETCHES: u32 = 500;
/// Wall speed divided by the width of the box while the discs move freely (1/s).
const RATE: f64 = 5e-6;
/// Number of contacts per disc, averaged over an interval, above which the discs count as jammed.
const JAMMED: f64 = 0.5;
/// Wall speed divided by the width of the box while the walls compress the jammed discs (1/s).
const PRESS: f64 = 1.6e-4;
/// Global damping α while the walls compress the jammed discs (1/s).
const DAMPING: f64 = 5.0;
/// Mean overlap divided by the mean radius, at which the compression ends.
const PRESSED: f64 = 2e-3;
/// Mean overlap divided by the mean radius, below which the contacts count as free of force.
const TOUCHING: f64 = 5e-6;

/// Compacts the discs of a loose scene to a dense packing.
pub(crate) fn prepare(mut scene: Scene) -> Result<Scene, Box<dyn Error>> {
    // The initial directions of consecutive discs differ by the golden angle. The first collisions randomise them.
    for (number, grain) in scene.grains.iter_mut().enumerate() {
        let angle = number as f64 * std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        grain.velocity = SPEED * Vector3::new(angle.cos(), angle.sin(), 0.0);
    }
    let level = energy(&scene);
    for _ in 0..STRETCHES {
        let factor = (level / energy(&scene)).sqrt();
        scene.grains.iter_mut().for_each(|grain| grain.velocity *= factor);
        let speed = RATE * size(&scene)[0];
        drive(&mut scene, &[Course { sides: -speed, ends: speed, from: 0.0, to: STRETCH }]);
        let (mut contacts, mut looks) = (0, 0);
        let end = watch(&scene, STRETCH, 1.0, |snapshot| {
            (contacts, looks) = (contacts + snapshot.told_contacts().len(), looks + snapshot.grains.len());
            true
        })?;
        go_on_from(&mut scene, &end);
        if contacts as f64 > JAMMED * looks as f64 {
            break;
        }
    }
    stop(&mut scene);
    scene.global_damping = DAMPING;
    let speed = PRESS * size(&scene)[0];
    drive(&mut scene, &[Course { sides: -speed, ends: speed, from: 0.0, to: f64::MAX }]);
    let pressed = watch(&scene, 1000.0, 0.5, |snapshot| {
        Stage::from_snapshot(snapshot).overlap < PRESSED
            || snapshot.told_contacts().len() * 4 < snapshot.grains.len() * 7
    })?;
    go_on_from(&mut scene, &pressed);
    open(scene)
}

/// Opens the walls until the overlaps of the discs are negligible. The strain of each opening is 0.98 of the strain at
/// which the wall forces would vanish if they decreased linearly.
fn open(mut scene: Scene) -> Result<Scene, Box<dyn Error>> {
    let (mut strain, mut before) = (0.0, None);
    for _ in 0..20 {
        stop(&mut scene);
        let rest = run(&scene, 60.0)?;
        go_on_from(&mut scene, &rest);
        let stage = Stage::from_snapshot(&rest);
        if rest.told_contacts().is_empty() || stage.overlap < TOUCHING {
            stop(&mut scene);
            return Ok(scene);
        }
        let force = stage.horizontal + stage.vertical;
        let further = match before {
            Some((earlier, larger)) if larger > force => 0.98 * force * (strain - earlier) / (larger - force),
            _ => 1e-3,
        };
        before = Some((strain, force));
        strain += further;
        let speed = 0.5 * further * size(&scene)[0] / 20.0;
        drive(&mut scene, &[Course { sides: speed, ends: -speed, from: 0.0, to: 20.0 }]);
        let opened = run(&scene, 20.0)?;
        go_on_from(&mut scene, &opened);
    }
    Err("the walls never came off the discs".into())
}

fn energy(scene: &Scene) -> f64 {
    scene.grains.iter().map(|grain| 0.5 * grain.mass * grain.velocity.norm_squared()).sum()
}
