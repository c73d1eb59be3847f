//! Checks of a run every so many steps: the time step against the critical one of the material as it is deformed now, and the
//! energy of a closed run against that at its start. And once, at the first step: overlaps that bodies start with.

use crate::bodies::Body;
use crate::contact::Other;
use crate::failure::Failure;
use crate::material::{Law, with_law};
use crate::options::Contact;
use crate::simulation::Simulation;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{Broken, Cause};
use grainbench_scene::space::Space;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Steps from one check to the next. A check takes about as long as two steps.
const INTERVAL: u64 = 256;

/// Energy that a closed run may gain, over the largest kinetic and elastic energy that it has had. What is known of the settings
/// that are checked: half a per cent where two discs meet, up to an eighth where three do (contact at nodes that surfaces have
/// met), and half a step between velocities and positions. An instability passes any bound within tens of steps.
const ALLOWED_GAIN: f64 = 0.25;

/// Strain of the surface layer by the springs of an overlap at the start up to which a run begins: a quarter, at which the stress
/// of neo-Hookean material is a third above the linear one and the shock that leaves the surface moves it by a quarter of the
/// speed of sound.
const LARGEST_STRAIN: f64 = 0.25;

/// Energy of a closed run (J; J/m of discs).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Watched {
    /// Kinetic, elastic and gravitational energy at the start; with that of springs once they are known.
    start: f64,
    /// Energy in springs at the start, once it is known: after the first step.
    springs: Option<f64>,
    /// Largest kinetic and elastic energy so far.
    largest: f64,
}

/// Returns true if nothing but gravity does work on the bodies of a scene: no wall and no grain is driven, no force manufactured.
fn is_closed(scene: &Scene) -> bool {
    let rests = scene.walls.iter().all(|wall| !wall.motion.is_moving());
    rests && scene.driven.is_empty() && scene.start.manufactured.is_none()
}

/// Returns true if contact makes no energy by its design. The methods of the papers do: nodes are stopped before surfaces meet,
/// and released with more than they had (up to 1.8 times the energy of a collision).
fn keeps_energy(contact: Contact) -> bool {
    !matches!(contact, Contact::Kinematic | Contact::Traction)
}

/// Time that the fastest wave takes through a cell (s) at a point with a modulus ρ₀c² (Pa), and over the volume at the start.
fn crossing_time(body: &Body, modulus: f64, volume_ratio: f64, cell: f64) -> f64 {
    let speed = (modulus / body.density).sqrt();
    // As `Scene::crossing_time`, with the density now.
    let damping = body.deformable.longitudinal_viscosity() * volume_ratio / (body.density * speed * cell);
    cell / speed * ((1.0 + damping * damping).sqrt() - damping)
}

impl<S: Space> Simulation<S> {
    /// A failure at the step now, beside a critical time step (s).
    fn told(&self, failure: Failure, critical: f64) -> Box<Broken> {
        failure.told(self.step, self.scheme.time_step, critical)
    }

    /// Begins to watch the energy, if nothing else gives any.
    pub(crate) fn watch_energy(&mut self) {
        if is_closed(&self.scene) && keeps_energy(self.scheme.setting.contact) {
            let [inner, height] = self.energies();
            self.watched = Some(Watched { start: inner + height, springs: None, largest: inner });
        }
    }

    /// Returns true if the next step has to find what touches.
    pub(crate) fn wants_touches(&self) -> bool {
        self.is_fresh || self.watched.is_some_and(|watched| watched.springs.is_none())
    }

    /// Checks a step that was taken.
    ///
    /// # Errors
    /// When bodies started in each other, the step is above the critical one, or energy came from nowhere.
    pub(crate) fn check(&mut self) -> Result<(), Box<Broken>> {
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

    /// Refuses overlaps whose springs strain the surface layer too much: by p/M with the pressure p = κ δ of the springs and the
    /// softer modulus M.
    fn check_overlaps(&self) -> Result<(), Box<Broken>> {
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
                Other::Wall(_) => strain_in(body, own),
                Other::Body(other) => {
                    let other = &state.bodies[other as usize];
                    let theirs = other.deformable.plane_modulus();
                    let mean = 2.0 * own * theirs / (own + theirs);
                    strain_in(body, mean).max(strain_in(other, mean))
                }
            };
            let strain = per_depth * touch.depth * relative;
            if strain > LARGEST_STRAIN {
                let cause = Cause::StartsInside { depth: touch.depth, strain, allowed: LARGEST_STRAIN };
                return Err(
                    self.told(Failure { owner: body.owner, position: S::embed(touch.point), cause }, self.critical)
                );
            }
        }
        Ok(())
    }

    /// Compares the time step with the critical one now; of runs that were within it at the start.
    fn check_step(&self) -> Result<(), Box<Broken>> {
        let Self { scheme, state, grid, critical, .. } = self;
        if scheme.time_step > *critical {
            return Ok(());
        }
        let cell = grid.lattice.shortest(S::DIMENSION);
        let points = &state.points;
        let mut least = (*critical, 0, 0);
        for (place, body) in state.bodies.iter().enumerate() {
            with_law!(&body.law, law => for at in body.part.points.clone() {
                let ratio = points.volume[at] / points.reference_volume[at];
                let finger = S::embed_symmetric(S::finger(points.deformation[at]));
                let time = crossing_time(body, law.wave_modulus(ratio, &finger), ratio, cell);
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
        Err(self.told(state.failure(place, point, cause), now))
    }

    /// Compares the energy with that at the start.
    fn check_energy(&mut self) -> Result<(), Box<Broken>> {
        let Some(Watched { start, springs, largest }) = self.watched else { return Ok(()) };
        let [inner, height] = self.energies();
        let (largest, brought) = (largest.max(inner), springs.unwrap_or(0.0));
        self.watched = Some(Watched { start, springs, largest });
        let gained = inner + height - start - brought;
        let allowed = ALLOWED_GAIN * f64::max(largest - gained.max(0.0), brought);
        // A state that is no number is told where it arises.
        if gained <= allowed.max(self.rounding()) || gained.is_nan() {
            return Ok(());
        }
        let points = &self.state.points;
        let squared = |at: usize| S::dot(points.velocity[at], points.velocity[at]);
        let bodies = self.state.bodies.iter().enumerate();
        let all = bodies.flat_map(|(place, body)| body.part.points.clone().map(move |at| (place, at)));
        let fastest = all.max_by(|a, b| squared(a.1).total_cmp(&squared(b.1)));
        let (place, point) = fastest.unwrap_or_default();
        let cause = Cause::GainedEnergy { gained, allowed };
        Err(self.told(self.state.failure(place, point, cause), self.critical))
    }

    /// Kinetic and elastic energy, and that of height (J).
    fn energies(&self) -> [f64; 2] {
        let Self { scheme, state, grid, .. } = self;
        let elastic: f64 = state.bodies.iter().map(|body| self.elastic_energy(body)).sum();
        let kinetic = state.kinetic_energy(scheme.setting.basis, &grid.lattice);
        [kinetic + elastic, self.height_energy()]
    }

    /// Energy of height (J) in the field of gravity.
    fn height_energy(&self) -> f64 {
        let (points, gravity) = (&self.state.points, self.scene.gravity);
        if gravity == Vector3::zeros() {
            return 0.0;
        }
        (0..points.len()).map(|at| -points.mass[at] * gravity.dot(&S::embed(points.position[at]))).sum()
    }

    /// Energy (J) that is no more than rounding: of the energies of height and at the start, in every step.
    fn rounding(&self) -> f64 {
        let start = self.watched.map_or(0.0, |watched| watched.start.abs());
        (start + self.height_energy().abs()) * f64::EPSILON * self.step as f64
    }
}
