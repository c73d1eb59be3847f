//! Four walls around discs, in the order left, right, bottom, top.

use grainbench::cases::stage::Stage;
use grainbench::dem::convention::Convention;
use grainbench::dem::solver::Dem;
use grainbench::mpm::solver::Mpm;
use grainbench::scene::motion::{Moment, Motion, Phase};
use grainbench::scene::nalgebra::Vector3;
use grainbench::scene::scene::{Duration, Scene, WallShape};
use grainbench::solver::Solver;
use grainbench::solver::record::Snapshot;
use grainbench::solver::resolution::Resolution;
use std::error::Error;

/// Resolution of runs with spring contacts, the default level of the case.
const RUNG: Resolution = Resolution::CriticalFraction(0.2);
/// Resolution of runs with elastic discs, the level `R/2` of the case.
const GRID: Resolution = Resolution::grid(2.0, 3);

/// Wall speeds (m/s) between the times `from` and `to` (s): outward for the sides, inward for top and bottom.
pub(crate) struct Course {
    pub(crate) sides: f64,
    pub(crate) ends: f64,
    pub(crate) from: f64,
    pub(crate) to: f64,
}

/// Replaces the motions of the four walls by `courses`.
pub(crate) fn drive(scene: &mut Scene, courses: &[Course]) {
    for (number, wall) in scene.walls.iter_mut().enumerate() {
        let velocity = |course: &Course| match number {
            0 => Vector3::new(-course.sides, 0.0, 0.0),
            1 => Vector3::new(course.sides, 0.0, 0.0),
            2 => Vector3::new(0.0, course.ends, 0.0),
            _ => Vector3::new(0.0, -course.ends, 0.0),
        };
        let phase = |course: &Course| Phase {
            velocity: velocity(course),
            spin: Vector3::zeros(),
            start: Moment::Seconds(course.from),
            stop: Moment::Seconds(course.to),
        };
        wall.motion = Motion { phases: courses.iter().map(phase).collect(), ..Motion::default() };
    }
}

/// Returns width and height of the box (m).
pub(crate) fn size(scene: &Scene) -> [f64; 2] {
    let place = |number: usize, axis: usize| match scene.walls[number].shape {
        WallShape::Plane { point, .. } => point[axis],
        _ => f64::NAN,
    };
    [place(1, 0) - place(0, 0), place(3, 1) - place(2, 1)]
}

/// Returns the packing fraction of the discs in the box.
pub(crate) fn fraction(scene: &Scene) -> f64 {
    let [width, height] = size(scene);
    scene.grains.iter().map(|grain| std::f64::consts::PI * grain.radius * grain.radius).sum::<f64>() / (width * height)
}

/// Runs a scene with spring contacts for `time` (s) and calls `go_on` with the state at intervals of `every` (s). The
/// run ends early if `go_on` returns false. Returns the last state.
pub(crate) fn watch(
    scene: &Scene,
    time: f64,
    every: f64,
    mut go_on: impl FnMut(&Snapshot) -> bool,
) -> Result<Snapshot, Box<dyn Error>> {
    // Time step of a complete run of the scene, whose duration is a whole number of steps.
    let (time_step, _) = RUNG.steps(scene)?;
    let mut simulation = Dem::new(Convention::CUNDALL_STRACK).start(scene, time_step)?;
    let (steps, stride) = ((time / time_step).round() as u64, (every / time_step).round().max(1.0) as u64);
    let mut snapshot = simulation.look(false).snapshot;
    while simulation.step() < steps {
        simulation.advance(stride.min(steps - simulation.step()))?;
        snapshot = simulation.look(false).snapshot;
        if !go_on(&snapshot) {
            break;
        }
    }
    Ok(snapshot)
}

/// Runs a scene with spring contacts for a time (s) and returns the final state.
pub(crate) fn run(scene: &Scene, time: f64) -> Result<Snapshot, Box<dyn Error>> {
    watch(scene, time, time, |_| true)
}

/// Runs a scene with elastic discs for a time (s) and returns the final state. The time step is shortened so that a
/// whole number of steps fits into this time.
pub(crate) fn run_elastic(scene: &Scene, time: f64) -> Result<Snapshot, Box<dyn Error>> {
    let mut scene = scene.clone();
    scene.duration = Duration::Seconds(time);
    scene.snapshots = 1;
    let mut record = Mpm::BEST.run(&scene, &GRID, &mut ())?;
    let last = record.snapshots.pop().ok_or("a run without a last snapshot")?;
    eprintln!("after {time} s {:?}", Stage::from_snapshot(&last));
    Ok(last)
}

/// Moves the discs and walls of a scene to their states at the end of a run, and removes the motions of the walls. The
/// contact history is lost.
pub(crate) fn go_on_from(scene: &mut Scene, snapshot: &Snapshot) {
    for (grain, state) in scene.grains.iter_mut().zip(&snapshot.grains) {
        (grain.position, grain.velocity, grain.spin) = (state.position, state.velocity, state.spin);
    }
    for (wall, state) in scene.walls.iter_mut().zip(&snapshot.walls) {
        wall.shape = WallShape::Plane { point: state.corners[0], normal: state.corners[1] };
        wall.motion = Motion::default();
    }
}

/// Sets the velocities and spins of all discs to zero.
pub(crate) fn stop(scene: &mut Scene) {
    for grain in scene.grains.iter_mut() {
        (grain.velocity, grain.spin) = (Vector3::zeros(), Vector3::zeros());
    }
}
