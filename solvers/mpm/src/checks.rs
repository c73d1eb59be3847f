//! Periodic checks of a run. One compares the time step with the critical time step of the deformed material. Another
//! compares the energy of a closed run with its initial energy. The initial overlaps of bodies are checked once, in the
//! first step.

use crate::contact::ContactPartner;
use crate::energy::ledger::EnergyGuard;
use crate::failure::Failure;
use crate::material::{Law, with_law};
use crate::options::Contact;
use crate::points::body::Body;
use crate::simulation::Simulation;
use grainbench_scene::scene::{Scene, crossing_time};
use grainbench_solver::failure::{Cause, SimulationFailure};
use grainbench_solver::space::Space;

/// Number of steps between two checks. A check takes about as long as two steps.
const INTERVAL: u64 = 256;

/// Allowed energy gain of a closed run, relative to its largest kinetic plus elastic energy so far.
///
/// Runs with the checked settings gain half a per cent for two colliding discs, and up to an eighth for three discs
/// (nodal contact of penetrating surfaces). The offset of half a step between velocities and positions adds to the gain.
/// An instability exceeds any bound within tens of steps.
const ALLOWED_GAIN: f64 = 0.25;

/// Largest allowed strain of the surface layer at the start, caused by the contact springs of an initial overlap.
///
/// At a strain of a quarter the stress of neo-Hookean material exceeds the linear stress by a third. A shock wave that
/// starts at the surface then moves the surface at a quarter of the speed of sound.
const LARGEST_STRAIN: f64 = 0.25;

/// Returns true if only gravity does work on the bodies: no wall or grain is driven, and there is no manufactured body
/// force.
fn is_closed(scene: &Scene) -> bool {
    let rests = scene.walls.iter().all(|wall| !wall.motion.is_moving());
    rests && scene.driven.is_empty() && scene.start.manufactured.is_none()
}

/// Returns true if the contact method creates no energy by design.
///
/// The methods of the original papers do create energy. They stop nodes before surfaces are in contact, and nodes later
/// depart with more energy than before (up to 1.8 times the energy of a collision).
fn keeps_energy(contact: Contact) -> bool {
    !matches!(contact, Contact::Kinematic | Contact::Traction)
}

impl<S: Space> Simulation<S> {
    /// Returns the error of a failure at the current step, with a critical time step (s).
    fn simulation_failure(&self, failure: Failure, critical: f64) -> Box<SimulationFailure> {
        failure.into_simulation_failure(self.step, self.scheme.time_step, critical)
    }

    /// Starts to monitor the energy if the run is closed and its contact method creates no energy.
    pub(crate) fn watch_energy(&mut self) {
        if is_closed(&self.scene) && keeps_energy(self.scheme.setting.contact) {
            let [inner, height] = self.energies();
            self.watched = Some(EnergyGuard { start: inner + height, springs: None, largest: inner });
        }
    }

    /// Returns true if the next step must record contact points for the checks.
    pub(crate) fn wants_touches(&self) -> bool {
        self.is_fresh || self.watched.is_some_and(|watched| watched.springs.is_none())
    }

    /// Checks the last step.
    ///
    /// # Errors
    /// Returns an error if bodies overlap too much at the start, the step exceeds the critical time step, or the energy
    /// has grown too much.
    pub(crate) fn check(&mut self) -> Result<(), Box<SimulationFailure>> {
        let is_first = std::mem::take(&mut self.is_fresh);
        if is_first {
            self.check_overlaps()?;
        }
        if !self.settling
            && let springs = self.contacts.touches.iter().map(|touch| touch.energy).sum()
            && let Some(watched) = &mut self.watched
        {
            watched.springs.get_or_insert(springs);
        }
        if !(is_first || self.step.is_multiple_of(INTERVAL)) {
            return Ok(());
        }
        self.check_step()?;
        if self.settling { Ok(()) } else { self.check_energy() }
    }

    /// Rejects initial overlaps whose springs strain the surface layer too much.
    ///
    /// The strain is p/M, with the pressure p = κ δ of the springs (κ: stiffness per area, δ: overlap) and the
    /// longitudinal modulus M of the softer body.
    fn check_overlaps(&self) -> Result<(), Box<SimulationFailure>> {
        let Self { scheme, state, contacts, grid, .. } = self;
        if scheme.setting.contact != Contact::Penalty {
            return Ok(());
        }
        let per_depth = scheme.setting.penalty / grid.lattice.shortest(S::DIMENSION);
        let strain_in = |body: &Body, modulus: f64| modulus / body.deformable.longitudinal_modulus();
        for touch in &contacts.touches {
            let body = &state.bodies[touch.body as usize];
            let own = body.deformable.plane_modulus();
            let relative = match touch.other {
                ContactPartner::Wall(_) => strain_in(body, own),
                ContactPartner::Body(other) => {
                    let other = &state.bodies[other as usize];
                    let theirs = other.deformable.plane_modulus();
                    let mean = 2.0 * own * theirs / (own + theirs);
                    strain_in(body, mean).max(strain_in(other, mean))
                }
            };
            let strain = per_depth * touch.depth * relative;
            if strain > LARGEST_STRAIN {
                let cause = Cause::StartsInside { depth: touch.depth, strain, allowed: LARGEST_STRAIN };
                return Err(self.simulation_failure(
                    Failure { owner: body.owner, position: S::embed(touch.point), cause },
                    self.critical,
                ));
            }
        }
        Ok(())
    }

    /// Compares the time step with the current critical time step, if the run satisfied the limit at the start.
    fn check_step(&self) -> Result<(), Box<SimulationFailure>> {
        let Self { scheme, state, grid, critical, .. } = self;
        if scheme.time_step > *critical {
            return Ok(());
        }
        let cell = grid.lattice.shortest(S::DIMENSION);
        let points = &state.points;
        let mut least = (*critical, 0, 0);
        for (place, body) in state.bodies.iter().enumerate() {
            with_law!(&body.law, law => for at in body.points.clone() {
                let ratio = points.volume[at] / points.reference_volume[at];
                let finger = S::embed_symmetric(S::finger(points.deformation[at]));
                let viscosity = body.deformable.longitudinal_viscosity() * ratio;
                let time = crossing_time(law.wave_modulus(ratio, &finger), viscosity, body.density, cell);
                if time < least.0 {
                    least = (time, place, at);
                }
            });
        }
        let (now, place, point) = least;
        if scheme.time_step <= now {
            return Ok(());
        }
        let cause = Cause::Stiffened { crossing: now, at_start: *critical };
        Err(self.simulation_failure(state.failure(place, point, cause), now))
    }

    /// Compares the energy with its initial value.
    fn check_energy(&mut self) -> Result<(), Box<SimulationFailure>> {
        let Some(EnergyGuard { start, springs, largest }) = self.watched else { return Ok(()) };
        let [inner, height] = self.energies();
        let (largest, brought) = (largest.max(inner), springs.unwrap_or(0.0));
        self.watched = Some(EnergyGuard { start, springs, largest });
        let gained = inner + height - start - brought;
        let allowed = ALLOWED_GAIN * f64::max(largest - gained.max(0.0), brought);
        // NaN does not count as an energy gain, because other checks report it.
        if gained <= allowed.max(self.rounding()) || gained.is_nan() {
            return Ok(());
        }
        let points = &self.state.points;
        let squared = |at: usize| S::dot(points.velocity[at], points.velocity[at]);
        let bodies = self.state.bodies.iter().enumerate();
        let all = bodies.flat_map(|(place, body)| body.points.clone().map(move |at| (place, at)));
        let fastest = all.max_by(|a, b| squared(a.1).total_cmp(&squared(b.1)));
        let (place, point) = fastest.unwrap_or_default();
        let cause = Cause::GainedEnergy { gained, allowed };
        Err(self.simulation_failure(self.state.failure(place, point, cause), self.critical))
    }

    /// Returns the kinetic plus elastic energy, and the gravitational potential energy (J).
    fn energies(&self) -> [f64; 2] {
        let Self { scheme, state, grid, .. } = self;
        let elastic: f64 = state.bodies.iter().map(|body| self.elastic_energy(body)).sum();
        let kinetic = state.kinetic_energy(scheme.setting.basis, &grid.lattice);
        [kinetic + elastic, state.points.gravitational_energy(self.scene.gravity)]
    }

    /// Returns an estimate of the rounding error of the energy (J), from potential and initial energy and the number of
    /// steps.
    fn rounding(&self) -> f64 {
        let start = self.watched.map_or(0.0, |watched| watched.start.abs());
        let height = self.state.points.gravitational_energy(self.scene.gravity);
        (start + height.abs()) * f64::EPSILON * self.step as f64
    }
}
