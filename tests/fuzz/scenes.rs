//! A scene with mistakes, run by any solver. The result must be an error that names the position, or a record of finite numbers.

use crate::driver::RandomSource;
use crate::mistakes::{PLANE, SPACE, make, mistake, two_grains};
use grainbench::cases::registry::CASES;
use grainbench::cases::solvers;
use grainbench::reports::SnapshotStore;
use grainbench::reports::export::record_json;
use grainbench::scene::body::BlockShape;
use grainbench::scene::method::Method;
use grainbench::scene::scene::{Duration, Scene};
use grainbench::scene::source::SceneSource;
use grainbench::solver::Solver;
use grainbench::solver::checkpoint::{Checkpoint, CheckpointError};
use grainbench::solver::failure::RunError;
use grainbench::solver::observer::{Observer, RunOptions};
use grainbench::solver::record::Record;
use grainbench::solver::resolution::Resolution;
use nalgebra::Vector3;
use proptest::prelude::*;
use std::path::Path;

/// Number of steps of a run.
const STEPS: u64 = 12;
/// Number of grains above which a scene is not run.
const BIG: f64 = 1.5e3;
const MANY: f64 = 1e4; // estimated number of material points above which a scene is not run
/// Number of grains, points or nodes above which no machine has enough memory. The solver itself must reject such scenes.
const ABSURD: f64 = 1e12;
/// Number of cells per reference length.
const CELLS: f64 = 2.0;
const POINTS: u32 = 2; // material points per cell along each axis

/// Observer that ends a run at its first checkpoint, by returning an error.
struct Brief;

impl Observer for Brief {
    fn options(&self) -> RunOptions {
        RunOptions { checkpoint_interval: Some(STEPS), ..RunOptions::DEFAULT }
    }
    fn checkpoint(&mut self, _checkpoint: Checkpoint) -> Result<(), CheckpointError> {
        Err(CheckpointError::NotStored("enough".to_owned()))
    }
}

/// Makes a scene with random mistakes and runs it.
pub(crate) fn try_out(lot: &mut RandomSource) -> Result<(), String> {
    let which = lot.draw(0..2 * CASES.len());
    let mistakes = lot.draw(prop::collection::vec(mistake(), 1..4));
    let start = [PLANE, SPACE].get(which % 4).copied().filter(|_| which >= CASES.len());
    let start = start.unwrap_or(CASES[which % CASES.len()].scene);
    let text = mistakes.iter().fold(start.to_owned(), |text, mistake| make(&text, mistake));
    let solvers = solvers::all();
    let solver = lot.one(&solvers);
    lot.show(&text);
    lot.show(&format!("# {}", solver.name()));
    let source = SceneSource::from_text("scene.toml", Path::new(""), &text);
    let mut variants = vec![None];
    match source.variants() {
        Ok(names) => variants.extend(names.into_iter().map(Some)),
        Err(error) => return names_place(&error.to_string()),
    }
    let variant = lot.one(&variants).clone();
    let source = variant.map_or(source.clone(), |name| source.variant(&name));
    let brief = lot.draw(any::<bool>());
    match source.scene(&two_grains) {
        Err(error) => names_place(&error.to_string()),
        Ok(scene) => run(lot, scene, solver.as_ref(), brief),
    }
}

/// Checks an error message about a scene: it must be one line, name the file, and contain "expected" and "found".
pub(crate) fn names_place(message: &str) -> Result<(), String> {
    let one_line = !message.chars().any(char::is_control);
    let named = message.starts_with("scene.toml") && message.contains("expected ") && message.contains("found ");
    if one_line && named { Ok(()) } else { Err(format!("badly said: {message:?}")) }
}

/// Runs a scene for a few steps. Either the duration is shortened, or the observer ends the run.
fn run(lot: &mut RandomSource, mut scene: Scene, solver: &dyn Solver, brief: bool) -> Result<(), String> {
    if scene.grains.iter().any(|grain| !(grain.mass > 0.0 && grain.inertia > 0.0)) {
        return Err("a grain has no mass".to_owned());
    }
    let method = Method::from_name(&solver.name());
    let odd = lot.draw(prop_oneof![15 => Just(None), 1 => any::<f64>().prop_map(Some)]);
    let resolution = match method {
        Some(Method::Grid) => Resolution::grid(odd.unwrap_or(CELLS), POINTS),
        Some(Method::Rigid) => Resolution::substeps(2),
        _ => odd.map_or(Resolution::CriticalFraction(0.1), Resolution::TimeStep),
    };
    if is_big(&scene, &resolution) {
        return Ok(());
    }
    let steps = STEPS as f64;
    match method {
        Some(Method::Grid) if brief => {
            let step = Resolution::COURANT * scene.crossing_time(scene.reference_length / CELLS);
            scene.duration = Duration::Seconds(steps * step);
        }
        // The rigid-body solver writes no checkpoints, so only its duration can be shortened.
        Some(Method::Rigid) => scene.duration = Duration::Seconds(steps / 2.0 * Resolution::RIGID_STEP),
        _ if brief => scene.duration = Duration::Cycles(STEPS),
        _ => {}
    }
    shorten_settling(&mut scene);
    lot.show(&format!("# {resolution}, {:?}", scene.duration));
    match solver.run(&scene, &resolution, &mut Brief) {
        Ok(record) => sound(&record),
        Err(RunError::Checkpoint(CheckpointError::NotStored(why))) if why == "enough" => Ok(()),
        Err(error) => {
            let message = error.to_string();
            let one_line = !message.chars().any(char::is_control);
            let says_who = message.starts_with(&solver.name()) || message.starts_with("the simulation broke at t = ");
            if one_line && says_who { Ok(()) } else { Err(format!("badly said: {message:?}")) }
        }
    }
}

/// Shortens the relaxation of bodies to a few steps. A relaxation with too many steps is unchanged: the solver must reject it.
fn shorten_settling(scene: &mut Scene) {
    const REFUSED: f64 = 4e15;
    let courant = Resolution::COURANT * scene.crossing_time(scene.reference_length / CELLS);
    let Duration::Seconds(time) = scene.duration else { return };
    let step = courant.min(time);
    if let Some(settle) = scene.start.settle.as_mut().filter(|settle| settle.duration / step < REFUSED) {
        settle.duration = settle.duration.min(STEPS as f64 * step);
    }
}

/// Returns true if a scene is too large for a short test but not too large for a machine.
fn is_big(scene: &Scene, resolution: &Resolution) -> bool {
    let between = |count: f64, low: f64| count > low && count < ABSURD;
    if between(scene.grains.len() as f64, BIG) {
        return true;
    }
    let Resolution::Grid { cells, .. } = *resolution else { return false };
    let (dimensions, cell) = (scene.dimension.count(), scene.reference_length / cells);
    let boxed = |length: f64| (length / cell + 4.0).powi(dimensions as i32);
    let of_bodies = scene.bodies.iter().map(|body| match body.shape {
        BlockShape::Box { low, high } => (0..dimensions).map(|axis| (high[axis] - low[axis]) / cell + 4.0).product(),
        BlockShape::Annulus { outer, .. } => boxed(2.0 * outer),
    });
    let nodes: f64 = of_bodies.chain(scene.grains.iter().map(|grain| boxed(2.0 * grain.radius))).sum();
    between(nodes * f64::from(POINTS).powi(dimensions as i32), MANY)
}

/// Checks that a record contains only finite numbers, and that it is unchanged after writing and reading.
fn sound(record: &Record) -> Result<(), String> {
    let finite = |vector: &Vector3<f64>| vector.iter().all(|value| value.is_finite());
    let series = &record.series;
    if !series.time.iter().chain(series.values.iter().flatten()).all(|value| value.is_finite()) {
        return Err("no number in the series of a run that is reported as valid".to_owned());
    }
    for snapshot in &record.snapshots {
        let grains = snapshot.grains.iter().all(|grain| {
            let vectors = [grain.force, grain.torque].into_iter().flatten();
            [grain.position, grain.velocity, grain.spin].into_iter().chain(vectors).all(|vector| finite(&vector))
        });
        let contacts = snapshot.told_contacts().iter().all(|contact| {
            finite(&contact.shear_force) && contact.overlap.is_finite() && contact.normal_force.is_finite()
        });
        let points = snapshot.points.iter().all(|point| {
            finite(&point.position) && finite(&point.velocity) && point.stress.iter().all(|value| value.is_finite())
        });
        let walls = snapshot.walls.iter().all(|wall| wall.force.as_ref().is_none_or(finite));
        if !(grains && contacts && points && walls) {
            return Err(format!("no number in snapshot {} of a run that is reported as valid", snapshot.step));
        }
    }
    let mut store = SnapshotStore::for_output(&std::env::temp_dir().join("fuzz"));
    for snapshot in &record.snapshots {
        store.add(snapshot.clone()).map_err(|error| error.to_string())?;
    }
    store.settle().map_err(|error| error.to_string())?;
    let mut text = Vec::new();
    record_json::write(record, &store, &mut text).map_err(|error| error.to_string())?;
    match serde_json::from_slice::<Record>(&text) {
        Ok(read) if read == *record => Ok(()),
        Ok(_) => Err("the record reads back as another".to_owned()),
        Err(error) => Err(format!("the record does not read back: {error}")),
    }
}
