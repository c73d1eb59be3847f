//! What to say when a run breaks.

use crate::simulation::Simulation;
use grainbench_scene::record::Owner;
use grainbench_scene::solver::{Broken, Cause, Subject};
use grainbench_scene::space::Space;

impl<S: Space> Simulation<S> {
    /// Which point went too far.
    pub(crate) fn ran_away(&self, cell: f64) -> Box<Broken> {
        let velocity = |at: usize| S::dot(self.points.velocity[at], self.points.velocity[at]).sqrt();
        for (place, body) in self.bodies.iter().enumerate() {
            for at in body.part.points.clone() {
                let position = self.points.position[at];
                if !S::dot(position, position).is_finite() {
                    return self.broken(place, at, Cause::NotFinite);
                }
            }
        }
        let mut worst = (0, 0, 0.0);
        for (place, body) in self.bodies.iter().enumerate() {
            for at in body.part.points.clone() {
                if velocity(at) > worst.2 {
                    worst = (place, at, velocity(at));
                }
            }
        }
        self.broken(worst.0, worst.1, Cause::LeftCell { moved: worst.2 * self.time_step, cell })
    }

    pub(crate) fn broken(&self, place: usize, point: usize, cause: Cause) -> Box<Broken> {
        let advice = if self.time_step > self.critical {
            format!("the step was above the limit h/c; {:.4e} s is stable for most scenes", 0.5 * self.critical)
        } else {
            "the step is within h/c: look at velocities, at the stress update, or refine the grid".to_owned()
        };
        Box::new(Broken {
            time: self.step as f64 * self.time_step,
            step: self.step,
            subject: match self.bodies[place].owner {
                Owner::Grain(id) => Subject::PointOfGrain(id),
                Owner::Body(at) => Subject::PointOfBody(at + 1),
            },
            position: S::embed(self.points.position[point]),
            cause,
            time_step: self.time_step,
            critical: self.critical,
            advice,
        })
    }
}
