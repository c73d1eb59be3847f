//! What a simulation shows at a step: grains with their velocities at the time of the positions, contacts, walls and
//! energies.

use crate::contact::normal::Normal;
use crate::contact::rolling::Rolling;
use crate::contact::tangential::Tangential;
use crate::neighbours::wrapped;
use crate::rotation::Rotation;
use crate::simulation::Kernel;
use grainbench_scene::record::{self, ContactState, GrainState, Look, Snapshot, WallState};
use grainbench_scene::scene::Scene;
use grainbench_scene::space::Space;
use nalgebra::Vector3;

/// The state at this step: grains, contacts, walls and energies.
pub(crate) fn look<S: Space, N: Normal, T: Tangential<S>, R: Rolling<S>>(kernel: &Kernel<S, N, T, R>) -> Look {
    let scene = &kernel.scene;
    let mut grains: Vec<GrainState> = (0..scene.grains.len()).map(|id| grain_state(kernel, id)).collect();
    for driven in &scene.driven {
        for &grain in &driven.grains {
            (grains[grain].velocity, grains[grain].spin) = (driven.velocity, Vector3::zeros());
        }
    }
    let elastic_energy = kernel.seen.iter().map(|seen| seen.elastic_energy).sum();
    let budget = kernel.accounting.then(|| kernel.accounts.budget(scene, &grains, elastic_energy));
    let mut contacts: Vec<ContactState> = kernel
        .seen
        .iter()
        .map(|seen| ContactState {
            grain: seen.grain,
            partner: seen.partner,
            point: S::embed(seen.point),
            normal: S::embed(seen.normal),
            overlap: seen.overlap,
            normal_force: seen.normal_force,
            shear_force: S::embed(S::along(seen.shear, seen.normal)),
            slipping: seen.slipping,
        })
        .collect();
    contacts.sort_by_key(|contact| contact.grain);
    let walls = kernel
        .walls
        .iter()
        .map(|wall| {
            let (corners, infinite) = wall.shape.corners();
            WallState { name: wall.name().to_owned(), corners, infinite, force: Some(S::embed(wall.force)) }
        })
        .collect();
    let snapshot = Snapshot {
        step: kernel.step,
        time: kernel.step as f64 * kernel.motion.time_step,
        bounds: record::bounds(scene, &grains),
        periodic: scene.domain.map_or([false; 3], |domain| domain.periodic),
        grains,
        contacts: Some(contacts),
        walls,
        bodies: Vec::new(),
        points: Vec::new(),
    };
    Look { driven: kernel.forces_on_driven(), budget, ..Look::of_rigid(snapshot, elastic_energy) }
}

/// A grain, with its velocity (m/s) and spin (rad/s) brought from half a step before to the time of the positions.
fn grain_state<S: Space, N: Normal, T: Tangential<S>, R: Rolling<S>>(
    kernel: &Kernel<S, N, T, R>,
    id: usize,
) -> GrainState {
    let (scene, grains) = (&kernel.scene, &kernel.grains);
    let slot = grains.slot[id] as usize;
    let start = &scene.grains[id];
    let half = 0.5 * kernel.motion.time_step;
    let drag = 1.0 / (1.0 + scene.global_damping * half);
    let movement = &grains.movement[slot];
    let acceleration = S::embed(grains.force[slot]) * movement.inverse_mass + scene.gravity;
    let rotation = &grains.rotation[slot];
    let spin = match rotation.spin() {
        Some(spin) => {
            let acceleration = rotation.acceleration(grains.torque[slot]);
            S::embed_spin(spin * drag + acceleration * (half * drag))
        }
        None => free_spin(scene, start.spin, kernel.motion.time_step, kernel.step),
    };
    let domain = scene.domain.filter(|_| scene.is_periodic());
    let position = grains.place[slot].position;
    let angle = if rotation.spin().is_some() {
        rotation.angle()
    } else {
        start.spin.z * kernel.step as f64 * kernel.motion.time_step
    };
    GrainState {
        position: S::embed(domain.map_or(position, |domain| wrapped::<S>(position, &domain))),
        velocity: (S::embed(movement.velocity) + acceleration * half) * drag,
        spin,
        angle: (S::DIMENSION == 2).then_some(angle),
        force: Some(S::embed(grains.force[slot])),
        torque: Some(S::embed_spin(T::Rotation::torque(grains.torque[slot]))),
        ..GrainState::start(id as u32 + 1, start)
    }
}

/// The angular velocity (rad/s) of a grain on which nothing exerts a torque: only global damping acts, once a step
/// (Cundall & Strack 1979, eq. 36).
fn free_spin(scene: &Scene, start: Vector3<f64>, time_step: f64, step: u64) -> Vector3<f64> {
    let half = 0.5 * scene.global_damping * time_step;
    start * libm::pow((1.0 - half) / (1.0 + half), step as f64)
}
