//! How a run starts: pressed, settled, set moving.

use crate::bodies::{Body, press};
use crate::contact::penalty::Springs;
use crate::options::Contact;
use crate::simulation::Simulation;
use crate::surface::Tracers;
use grainbench_scene::manufactured::Medium;
use grainbench_scene::record::Owner;
use grainbench_scene::solver::Broken;
use grainbench_scene::space::Space;
use nalgebra::Vector3;

impl<S: Space> Simulation<S> {
    /// The damped phase before the clock starts.
    pub(crate) fn settle(&mut self) -> Result<(), Box<Broken>> {
        let start = self.scene.start;
        let gravity = start.settle.map_or(self.scene.gravity, |settle| settle.gravity);
        if start.initial_pressure.is_some() {
            press(&self.bodies, &mut self.points, &self.tracers, gravity);
        }
        self.drop_idle_surfaces();
        self.find_all_bounds();
        if let Some(settle) = start.settle {
            (self.gravity, self.damping, self.settling) = (S::restrict(gravity), settle.damping, true);
            for _ in 0..(settle.duration / self.time_step).ceil() as u64 {
                self.cycle(false)?;
            }
            (self.gravity, self.damping) = (S::restrict(self.scene.gravity), self.scene.global_damping);
            // Its steps are not those of the scene's clock, but they are work.
            (self.settling, self.step) = (false, 0);
            self.touches.clear();
        }
        Ok(())
    }

    /// Surfaces that nothing can touch, or that contact does not ask for, cost nothing: they are needed for pressing only.
    pub(crate) fn drop_idle_surfaces(&mut self) {
        if self.can_touch() && matches!(self.setting.contact, Contact::Penalty | Contact::Gap) {
            return;
        }
        (self.tracers, self.springs) = (Tracers::new(), Springs::new(false, 0));
        for body in &mut self.bodies {
            (body.tracers, body.chunks) = (0..0, 0..0);
        }
    }

    /// Gives every point the velocity that the scene asks for, half a step before the clock starts, so that every step is
    /// alike: what balances the bodies at rest does so then too, and gravity beyond that acts from the start.
    pub(crate) fn set_moving(&mut self) {
        let half = 0.5 * self.time_step;
        let balanced = self.scene.start.settle.map_or_else(Vector3::zeros, |settle| settle.gravity);
        let lag = (self.scene.gravity - balanced) * half;
        self.before.resize(self.points.len(), S::ORIGIN);
        for body in &self.bodies {
            let medium = medium(body);
            // A grain that has settled has sunk: it turns about where its mass is, or it would start with a velocity.
            let (_, centre) = self.points.centre_of_mass(body.part.points.clone());
            for at in body.part.points.clone() {
                let position = S::embed(self.points.position[at]);
                let mut velocity = match body.owner {
                    Owner::Grain(id) => {
                        let grain = &self.scene.grains[id as usize - 1];
                        if let Some(affine) = self.points.affine.get_mut(at) {
                            *affine = S::restrict_gradient(grain.spin.cross_matrix());
                        }
                        grain.velocity + grain.spin.cross(&(position - centre))
                    }
                    Owner::Body(place) => {
                        let block = &self.scene.bodies[place as usize];
                        let wave = block.wave.map_or(0.0, |wave| {
                            let low = body.held.map_or(block.shape.centre().x, |(_, [low, _])| low.x);
                            wave.amplitude * (wave.wave_number * (position.x - low)).sin()
                        });
                        block.velocity + Vector3::new(wave, 0.0, 0.0)
                    }
                };
                let mut behind = if body.driven.is_some() { velocity } else { velocity - lag };
                if let Some(motion) = &self.scene.start.manufactured {
                    velocity += motion.velocity(&medium, position, 0.0);
                    behind += motion.velocity(&medium, position, -half);
                }
                self.points.velocity[at] = S::restrict(behind);
                self.before[at] = S::restrict(behind * 3.0 - velocity * 2.0);
            }
        }
    }
}

/// What a manufactured solution needs to know of a body.
pub(crate) fn medium(body: &Body) -> Medium {
    Medium { density: body.density, lame: body.deformable.lame(), shear_modulus: body.deformable.shear_modulus }
}
