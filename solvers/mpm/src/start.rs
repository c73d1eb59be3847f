//! How a run starts: pressed, settled, set moving.

use crate::scheme::Surroundings;
use crate::simulation::Simulation;
use crate::state::State;
use crate::stress_at_start;
use grainbench_scene::record::Owner;
use grainbench_scene::solver::Broken;
use grainbench_scene::space::Space;
use nalgebra::Vector3;

impl<S: Space> Simulation<S> {
    /// The damped phase before the clock starts.
    pub(crate) fn settle(&mut self) -> Result<(), Box<Broken>> {
        let start = self.scene.start;
        let gravity = start.settle.map_or(self.scene.gravity, |settle| settle.gravity);
        stress_at_start::give(&self.scene, gravity, &mut self.state, &self.contacts.tracers);
        self.cover();
        if let Some(settle) = start.settle {
            self.surroundings = Surroundings { gravity: S::restrict(gravity), damping: settle.damping };
            self.settling = true;
            for _ in 0..(settle.duration / self.scheme.time_step).ceil() as u64 {
                self.cycle(false)?;
            }
            let (gravity, damping) = (S::restrict(self.scene.gravity), self.scene.global_damping);
            self.surroundings = Surroundings { gravity, damping };
            // Its steps are not those of the scene's clock, but they are work.
            (self.settling, self.step) = (false, 0);
            self.contacts.touches.clear();
        }
        Ok(())
    }

    /// Drops surfaces that nobody needs, and finds the boxes around bodies.
    pub(crate) fn cover(&mut self) {
        let Self { scheme, state, boundary, contacts, .. } = self;
        contacts.drop_idle_surfaces(scheme.setting.contact, state, boundary);
        state.find_all_bounds(&mut contacts.tracers);
    }

    /// Gives every point the velocity that the scene asks for, half a step before the clock starts, so that every step
    /// is alike: what balances the bodies at rest does so then too, and gravity beyond that acts from the start.
    pub(crate) fn set_moving(&mut self) {
        let half = 0.5 * self.scheme.time_step;
        let balanced = self.scene.start.settle.map_or_else(Vector3::zeros, |settle| settle.gravity);
        let lag = (self.scene.gravity - balanced) * half;
        let State { bodies, points, before, .. } = &mut self.state;
        before.resize(points.len(), S::ORIGIN);
        for body in bodies.iter() {
            let medium = body.medium();
            // A grain that has settled has sunk: it turns about where its mass is, or it would start with a velocity.
            let (_, centre) = points.centre_of_mass(body.part.points.clone());
            for at in body.part.points.clone() {
                let position = S::embed(points.position[at]);
                let mut velocity = match body.owner {
                    Owner::Grain(id) => {
                        let grain = &self.scene.grains[id as usize - 1];
                        if let Some(affine) = points.affine.get_mut(at) {
                            *affine = S::restrict_gradient(grain.spin.cross_matrix());
                        }
                        grain.velocity + grain.spin.cross(&(position - centre))
                    }
                    Owner::Body(place) => {
                        let block = &self.scene.bodies[place as usize];
                        let wave = block.wave.map_or(0.0, |wave| {
                            let low = body.held.map_or(block.shape.centre().x, |(_, [low, _])| low.x);
                            wave.amplitude * libm::sin(wave.wave_number * (position.x - low))
                        });
                        if let Some(affine) = points.affine.get_mut(at) {
                            *affine = S::restrict_gradient(block.velocity_gradient());
                        }
                        block.velocity_at(position) + Vector3::new(wave, 0.0, 0.0)
                    }
                };
                let mut behind = if body.driven.is_some() { velocity } else { velocity - lag };
                if let Some(motion) = &self.scene.start.manufactured {
                    velocity += motion.velocity(&medium, position, 0.0);
                    behind += motion.velocity(&medium, position, -half);
                }
                points.velocity[at] = S::restrict(behind);
                before[at] = S::restrict(behind * 3.0 - velocity * 2.0);
            }
        }
    }
}
