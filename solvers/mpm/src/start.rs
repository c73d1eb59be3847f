//! Start of a run: initial stress, relaxation and initial velocities.

use crate::failure::Failure;
use crate::grid::basis::with_basis;
use crate::grid::nodes::Grid;
use crate::points::state::State;
use crate::points::stress_at_start;
use crate::scheme::Surroundings;
use crate::simulation::Simulation;
use grainbench_solver::failure::SimulationFailure;
use grainbench_solver::record::Owner;
use grainbench_solver::space::Space;
use nalgebra::{Matrix3, Vector3};

impl<S: Space> Simulation<S> {
    /// Applies the initial stress and runs the damped relaxation before time zero.
    pub(crate) fn settle(&mut self) -> Result<(), Box<SimulationFailure>> {
        let start = self.scene.start;
        let gravity = start.settle.map_or(self.scene.gravity, |settle| settle.gravity);
        stress_at_start::give(&self.scene, gravity, &mut self.state, &self.contacts.tracers);
        self.cover();
        if let Some(settle) = start.settle {
            self.surroundings = Surroundings::new(gravity, settle.damping, self.scheme.time_step);
            self.settling = true;
            for _ in 0..(settle.duration / self.scheme.time_step).ceil() as u64 {
                self.cycle(false)?;
            }
            let (gravity, damping) = (self.scene.gravity, self.scene.global_damping);
            self.surroundings = Surroundings::new(gravity, damping, self.scheme.time_step);
            // The steps of relaxation do not count as simulated time, but they count as cost.
            (self.settling, self.step) = (false, 0);
            self.contacts.touches.clear();
        }
        Ok(())
    }

    /// Removes unneeded tracers and computes the bounding boxes of bodies.
    pub(crate) fn cover(&mut self) {
        let Self { scheme, state, boundary, contacts, .. } = self;
        contacts.drop_idle_surfaces(scheme.setting.contact, state, boundary);
        state.find_all_bounds(&mut contacts.tracers);
    }

    /// Sets the initial velocity of every point, half a step before time zero: v − a Δt/2.
    ///
    /// Here a is the acceleration of the first step ([`Simulation::accelerations`]), so the first step is like all
    /// later steps.
    ///
    /// # Errors
    /// Returns an error if the grid would have too many nodes.
    pub(crate) fn set_moving(&mut self) -> Result<(), Failure> {
        let half = 0.5 * self.scheme.time_step;
        let accelerations = self.accelerations()?;
        let State { bodies, points, before, .. } = &mut self.state;
        before.resize(points.len(), S::ORIGIN);
        for body in bodies.iter() {
            let medium = body.medium();
            // A relaxed grain has moved. It must rotate about its current centre of mass. Otherwise its rotation would
            // add to the velocity of its centre.
            let (_, centre) = points.centre_of_mass(body.points.clone());
            for at in body.points.clone() {
                let position = S::embed(points.position[at]);
                let (mut velocity, gradient) = match body.owner {
                    Owner::Grain(id) => {
                        let grain = &self.scene.grains[id as usize - 1];
                        let velocity = grain.velocity + grain.spin.cross(&(position - centre));
                        (velocity, grain.spin.cross_matrix())
                    }
                    Owner::Body(place) => {
                        let block = &self.scene.bodies[place as usize];
                        let wave = block.wave.map_or(0.0, |wave| {
                            let low = body.held.map_or(block.shape.centre().x, |(_, [low, _])| low.x);
                            wave.amplitude * libm::sin(wave.wave_number * (position.x - low))
                        });
                        let gradient = block.spin.cross_matrix() + Matrix3::from_diagonal(&block.stretch);
                        (block.velocity_at(position) + Vector3::new(wave, 0.0, 0.0), gradient)
                    }
                };
                if let Some(affine) = points.affine.get_mut(at) {
                    *affine = S::restrict_gradient(gradient);
                }
                let lag = S::embed(accelerations[at]) * half;
                let mut behind = if body.driven.is_some() { velocity } else { velocity - lag };
                if let Some(motion) = &self.scene.start.manufactured {
                    velocity += motion.velocity(&medium, position, 0.0);
                    behind += motion.velocity(&medium, position, -half);
                }
                points.velocity[at] = S::restrict(behind);
                before[at] = S::restrict(behind * 3.0 - velocity * 2.0);
            }
        }
        Ok(())
    }

    /// Returns the acceleration of every point at the start (m/s²).
    ///
    /// Relaxed bodies are in equilibrium, and only the change of gravity after relaxation acts on them. Gravity and the
    /// initial stress accelerate all other bodies. The acceleration of a point is a = Σ N_i (f_i/m_i + g) over the
    /// nodes i that influence the point, with f_i = −Σ V σ ∇N_i over the points. There is no acceleration across fixed
    /// or symmetry boundaries. A body stays at rest if its stress balances its weight.
    fn accelerations(&mut self) -> Result<Vec<S::Vector>, Failure> {
        let start = &self.scene.start;
        let balanced = start.settle.map_or_else(Vector3::zeros, |settle| settle.gravity);
        let pull = S::restrict(self.scene.gravity - balanced);
        let is_stressed = start.settle.is_none() && stress_at_start::is_given(&self.scene);
        let is_held = self.state.bodies.iter().any(|body| body.held.is_some()) && pull != S::ORIGIN;
        let mut accelerations = vec![pull; self.state.points.len()];
        if !(is_stressed || is_held) {
            return Ok(accelerations);
        }
        self.place_windows()?;
        self.scatter();
        let Self { scheme, state, grid, boundary, .. } = self;
        let nodes = &mut grid.nodes[..grid.used];
        if !is_stressed {
            nodes.iter_mut().for_each(|node| node.change = S::ORIGIN);
        }
        boundary.held.fold(&state.bodies, nodes, pull);
        for node in nodes.iter_mut().filter(|node| node.mass > 0.0) {
            node.change = node.change * (1.0 / node.mass) + pull;
        }
        boundary.held.hold(&state.bodies, &mut grid.nodes);
        let Grid { lattice, nodes, .. } = grid;
        for body in &state.bodies {
            with_basis!(scheme.setting.basis, B => body.each_stencil::<S, B>(lattice, &state.points, |at, stencil| {
                accelerations[at] = S::ORIGIN;
                stencil.each::<S, B>(&body.window, |node| {
                    accelerations[at] += nodes[node.slot].change * node.weight;
                });
            }));
        }
        Ok(accelerations)
    }
}
