//! A complete solver for one rigid grain on a fixed plane, and its test.
//!
//! Each step computes the friction impulse that stops the slip and limits it to the Coulomb limit. While the grain
//! slides, and while it rolls, its acceleration is constant, and steps of any length are exact. Only the step in which
//! sliding turns into rolling has an error.

use grainbench::scene::nalgebra::Vector3;
use grainbench::scene::scene::{Duration, Scene, WallShape};
use grainbench::solver::Solver;
use grainbench::solver::failure::RunError;
use grainbench::solver::observer::Observer;
use grainbench::solver::record::{Cost, GrainState, Provenance, Record, Snapshot, StepState};
use grainbench::solver::recorder::Recorder;
use grainbench::solver::resolution::Resolution;

struct Rigid;

impl Solver for Rigid {
    fn name(&self) -> String {
        "my-rigid-grain".to_owned()
    }

    fn has_springs(&self) -> bool {
        false
    }

    fn run(&self, scene: &Scene, resolution: &Resolution, observer: &mut dyn Observer) -> Result<Record, RunError> {
        let unsupported = |reason: &str| RunError::Unsupported { solver: self.name(), reason: reason.to_owned() };
        let ([grain], [wall]) = (&scene.grains[..], &scene.walls[..]) else {
            return Err(unsupported("it knows one grain and one wall"));
        };
        let (&WallShape::Plane { normal, .. }, false) = (&wall.shape, wall.motion.is_moving()) else {
            return Err(unsupported("it knows only planes at rest"));
        };
        let Duration::Seconds(duration) = scene.duration else {
            return Err(unsupported("it has no calculation cycles"));
        };
        let Resolution::CriticalFraction(fraction) = *resolution else {
            return Err(unsupported("it takes steps that are a fraction of the critical one"));
        };
        let steps = (duration / (fraction * scene.critical_time_step())).ceil() as u64;
        let time_step = duration / steps as f64;

        let friction = scene.law(grain.material, wall.material).map_or(0.0, |law| law.friction);
        let onto = -scene.gravity.dot(&normal);
        let along = scene.gravity + normal * onto;
        let arm = -grain.radius * normal;
        // Change of the slip velocity per impulse at the contact: translation of the centre and rotation about it.
        let mobility = 1.0 / grain.mass + grain.radius.powi(2) / grain.inertia;
        let limit = friction * grain.mass * onto * time_step;

        let (mut position, mut velocity, mut spin, mut angle) = (grain.position, grain.velocity, grain.spin, 0.0);
        let mut recorder = Recorder::new(scene, time_step, steps);
        for step in 0..=steps {
            if recorder.is_due(step) {
                let state = GrainState { position, velocity, spin, angle: Some(angle), ..GrainState::start(1, grain) };
                let snapshot = Snapshot::of_grains(scene, step, step as f64 * time_step, vec![state]);
                let due = recorder.take(scene, StepState::of_rigid(snapshot, 0.0));
                due.into_iter().for_each(|snapshot| recorder.keep(snapshot));
            }
            let before = (velocity, spin);
            velocity += along * time_step;
            let slip: Vector3<f64> = velocity + spin.cross(&arm);
            let impulse = (-slip / mobility).cap_magnitude(limit);
            velocity += impulse / grain.mass;
            spin += arm.cross(&impulse) / grain.inertia;
            position += 0.5 * (before.0 + velocity) * time_step;
            angle += 0.5 * (before.1 + spin).z * time_step;
        }
        observer.progress(steps, steps);
        let (series, snapshots) = recorder.finish();
        let provenance = Provenance {
            scene: scene.title.clone(),
            solver: self.name(),
            resolution: resolution.to_string(),
            time_step,
            critical_time_step: None,
            effects: vec!["friction and rotation".to_owned(), "gravity".to_owned()],
            options: Vec::new(),
        };
        Ok(Record { provenance, series, snapshots, cost: Cost::of_program(steps, 1, f64::NAN) })
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let judgement = grainbench::judge(Rigid, &["incline-disc", "incline-sphere", "backspin"])?;
    println!("{judgement}");
    judgement.require()?; // If a claim fails or none is judged, the program ends with exit code 1.
    Ok(())
}
