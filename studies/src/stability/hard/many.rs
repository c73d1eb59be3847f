//! Many grains or many steps: long rest, dense shear, and a restart at half of a run.

use super::{HardCase, case, end, kinetic, near};
use crate::stability::assembly::{grain, wall};
use crate::stability::failure::Failure;
use grainbench_scene::error::SceneError;
use grainbench_scene::scene::Scene;
use grainbench_solver::record::{GrainState, Record};
use std::f64::consts::FRAC_1_PI;
use std::fmt::Write as _;

/// Number of rows of the large heap, which has 990 discs.
const ROWS: usize = 44;
/// Duration of a run of a heap, in units of a tenth of the critical time step.
const STEPS: f64 = 1e6;
/// Number of discs in each row of the sheared layer.
const ACROSS: usize = 40;
/// Number of rows of the sheared layer.
const LAYERS: usize = 25;
/// Radius of a sheared disc (m). Centres are 2 m apart, so that the area fraction is 0.80.
const RADIUS: f64 = 0.94;

pub(super) fn cases() -> Result<Vec<HardCase>, SceneError> {
    let shear = shear();
    Ok(vec![
        case(
            "heap-at-rest-for-1e6-steps",
            "six discs in a heap come to rest and stay at rest: after 10⁶ steps of the springs each disc is within R/100 \
             of its place, and none moves",
            &heap("A heap", 3, 1.0),
            |scene, record| at_rest(scene, record, 0.01),
        )?,
        HardCase {
            asked: &["dem"],
            ..case(
                "heap-of-990-for-1e6-steps",
                "a heap of 44 rows of discs comes to rest and stays at rest: after 10⁶ steps of the springs each disc \
                 is within R/10 of its place, and none moves",
                &heap("A heap of many", ROWS, 10.0),
                |scene, record| at_rest(scene, record, 0.1),
            )?
        },
        case(
            "dense-shear-of-1000",
            "a layer of 1000 discs is sheared between two walls: all discs stay between the walls, no overlap reaches \
             R/10, and no disc is faster than twice the speed of the wall",
            &shear,
            sheared,
        )?,
        HardCase {
            goes_on: true,
            ..case(
                "restart-of-1000-in-the-middle",
                "the same layer, interrupted halfway and continued from its checkpoint, ends with the same bits",
                &shear,
                sheared,
            )?
        },
    ])
}

/// Returns the first part of a scene with unit masses and k = 1e6. A tenth of the critical time step is then 2e-4 s.
fn head(title: &str, duration: f64, gravity: f64, radius: f64) -> String {
    format!(
        "title = '{title}'\ndimension = 2\ngravity = [0.0, {gravity:?}]\nduration = {duration:?}\nmaterials.m.density = {:?}\n\
         contacts.m = {{ between = ['m', 'm'], normal_stiffness = 1.0e6, tangential_stiffness = 2.857142857e5, friction = 0.5, \
         normal_damping = 500.0, tangential_damping = 500.0 }}\n",
        FRAC_1_PI / (radius * radius)
    )
}

/// Returns the scene of a heap between two vertical walls: each row has one disc less than the row below. Samples are `every`
/// seconds apart.
fn heap(title: &str, rows: usize, every: f64) -> String {
    let mut text = head(title, STEPS * 2e-4, -10.0, 1.0);
    let mut number = 0;
    for row in 0..rows {
        for at in 0..rows - row {
            let x = 2.0 * at as f64 + row as f64 - (rows - 1) as f64;
            grain(&mut text, number, 1.0, [x, 1.0 + 3.0_f64.sqrt() * row as f64]);
            number += 1;
        }
    }
    let edge = rows as f64;
    wall(&mut text, "floor", [0.0, 0.0], [0.0, 1.0]);
    wall(&mut text, "left", [-edge, 0.0], [1.0, 0.0]);
    wall(&mut text, "right", [edge, 0.0], [-1.0, 0.0]);
    text + &format!("[output]\nevery = {every:?}\n[probes]\nall = {{ system = true }}\n")
}

/// Checks that each disc is within `allowed` (m) of its place, and at rest.
fn at_rest(scene: &Scene, record: &Record, allowed: f64) -> Result<(), Failure> {
    let grains = all_at_the_end(scene, record)?;
    for (grain, start) in grains.iter().zip(&scene.grains) {
        near(&format!("displacement of grain {}", grain.id), (grain.position - start.position).norm(), 0.0, allowed)?;
    }
    near("kinetic energy", kinetic(grains, scene), 0.0, 1e-6)
}

/// Returns the grains at the end of a run.
fn all_at_the_end<'a>(scene: &Scene, record: &'a Record) -> Result<&'a [GrainState], Failure> {
    let grains = end(record);
    if grains.len() == scene.grains.len() {
        return Ok(grains);
    }
    Err(Failure::Wrong(format!("{} grains are left of {}", grains.len(), scene.grains.len())))
}

/// Returns the height of the sheared layer (m).
fn height() -> f64 {
    3.0_f64.sqrt() * (LAYERS - 1) as f64 + 2.0 * RADIUS
}

fn shear() -> String {
    let length = 2.0 * ACROSS as f64;
    let mut text =
        format!("domain = {{ low = [0.0, 0.0], high = [{length:?}, {:?}], periodic = [true, false] }}\n", height())
            + &head("A sheared layer", 4.0, 0.0, RADIUS);
    for row in 0..LAYERS {
        for at in 0..ACROSS {
            let x = 2.0 * at as f64 + 0.5 + (row % 2) as f64;
            grain(&mut text, ACROSS * row + at, RADIUS, [x, RADIUS + 3.0_f64.sqrt() * row as f64]);
        }
    }
    for (name, y, up, way) in [("bottom", 0.0, 1.0, -1.0), ("top", height(), -1.0, 1.0)] {
        wall(&mut text, name, [0.0, y], [0.0, up]);
        let _ = writeln!(text, "motion = [{{ velocity = [{way:?}, 0.0] }}]");
    }
    text + "[output]\nevery = 0.5\n[probes]\nall = { system = true }\n"
}

fn sheared(scene: &Scene, record: &Record) -> Result<(), Failure> {
    let grains = all_at_the_end(scene, record)?;
    for grain in grains {
        let within = (0.9 * RADIUS..=height() - 0.9 * RADIUS).contains(&grain.position.y);
        if !within {
            return Err(Failure::Tunnelling(format!("grain {} is at y = {:.3}", grain.id, grain.position.y)));
        }
        near(&format!("speed of grain {}", grain.id), grain.velocity.norm(), 0.0, 2.0)?;
    }
    let length = 2.0 * ACROSS as f64;
    for (at, grain) in grains.iter().enumerate() {
        for other in &grains[at + 1..] {
            let mut way = grain.position - other.position;
            way.x -= length * (way.x / length).round();
            let overlap = 2.0 * RADIUS - way.norm();
            if overlap > 0.1 * RADIUS {
                return Err(Failure::Overlap(overlap / RADIUS));
            }
        }
    }
    Ok(())
}
