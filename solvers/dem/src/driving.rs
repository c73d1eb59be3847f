//! Grains with prescribed motion, for the whole run or a part of it.

use crate::geometry::Geometry;
use crate::simulation::DemSimulation;
use grainbench_scene::scene::Driven;
use nalgebra::Vector3;

/// Returns two flags: true if the motion is prescribed at the previous step, and true if it is prescribed at this step.
fn moved_before_and_at(driven: &Driven, step: u64, time_step: f64) -> [bool; 2] {
    [step - 1, step].map(|step| driven.is_moved_at(step as f64 * time_step))
}

impl<S: Geometry> DemSimulation<S> {
    /// Sets the forces and torques on grains with prescribed motion to zero, because forces do not move them.
    pub(crate) fn shield_driven(&mut self) {
        let (time, grains) = (self.time(), &mut self.grains);
        let moved = self.scene.driven.iter().filter(|driven| driven.is_moved_at(time));
        for &grain in moved.flat_map(|driven| &driven.grains) {
            grains.unload(grains.slot[grain] as usize);
        }
    }

    /// Sets the mass of grains to infinity when their prescribed motion starts, and back to their own mass when it ends.
    pub(crate) fn begin_and_end_driving(&mut self) {
        let Self { scene, grains, motion, step, .. } = self;
        for driven in &scene.driven {
            let [before, now] = moved_before_and_at(driven, *step, motion.time_step);
            if now != before {
                grains.weigh(scene, driven, now);
            }
        }
    }

    /// Shifts velocities back by half a step for grains whose prescribed motion ends at this step. Their prescribed
    /// velocity belongs to the present time, but the integration needs the velocity half a step earlier.
    pub(crate) fn let_go(&mut self) {
        let Self { scene, grains, motion, step, .. } = self;
        for driven in &scene.driven {
            if let [true, false] = moved_before_and_at(driven, *step, motion.time_step) {
                let slots: Vec<usize> = driven.grains.iter().map(|&grain| grains.slot[grain] as usize).collect();
                motion.step_back_half(grains, slots.into_iter());
            }
        }
    }

    /// Sets the prescribed velocity and spin of grains over this step. The grains have already moved with another
    /// velocity during the last `drifted` seconds. Their positions are corrected to those that the prescribed velocity
    /// gives.
    pub(crate) fn drive(&mut self, drifted: f64) {
        let (time, time_step, grains) = (self.time(), self.motion.time_step, &mut self.grains);
        for driven in self.scene.driven.iter().filter(|driven| driven.is_moved_at(time)) {
            let velocity = S::embed(S::restrict(driven.velocity_over(time, time_step)));
            for &grain in &driven.grains {
                let slot = grains.slot[grain] as usize;
                let position = grains.position(slot) + (velocity - grains.velocity(slot)) * drifted;
                S::put(position, &mut grains.place[slot]);
                let at = grains.first_quad(slot);
                S::put(velocity, &mut grains.movement[at]);
                grains.set_spin(slot, driven.spin);
            }
        }
    }

    /// Returns the sum of the contact forces on each group of grains with prescribed motion (N).
    pub(crate) fn forces_on_driven(&self) -> Vec<Vector3<f64>> {
        let force = |&grain: &usize| self.grains.force(self.grains.slot[grain] as usize);
        self.scene.driven.iter().map(|driven| driven.grains.iter().map(force).sum()).collect()
    }
}
