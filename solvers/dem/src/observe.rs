//! Output of a simulation at a step: grains with their velocities at the time of the positions, contacts, walls and energies.

use crate::accounts::EnergyBudget;
use crate::geometry::Geometry;
use crate::grains::ABSENT;
use crate::neighbours::wrapped;
use crate::simulation::DemSimulation;
use grainbench_scene::scene::{Driven, Scene};
use grainbench_solver::record::{GrainState, Snapshot, StepState, WallState};
use nalgebra::Vector3;

/// Returns the state at this step: grains, contacts, walls and energies. It moves out the recorded contacts, so a
/// second call at the same step returns none.
pub(crate) fn observed<S: Geometry>(simulation: &mut DemSimulation<S>) -> StepState {
    let DemSimulation { recording, neighbours, step, .. } = simulation;
    let touching = recording.touching(*step, &neighbours.list.shares);
    let contacts = recording.take_contacts(*step, &mut neighbours.list.shares);
    let (simulation, scene) = (&*simulation, &simulation.scene);
    let grains: Vec<GrainState> = grain_states(simulation).collect();
    let energies = simulation.recording.energies(&simulation.neighbours.list.shares);
    let elastic_energy = energies.map(|energies| energies.elastic).sum();
    let EnergyBudget { is_requested, accounts, .. } = &simulation.budget;
    let budget = is_requested.then(|| accounts.budget(scene, &grains, elastic_energy));
    let walls = simulation
        .walls
        .iter()
        .map(|wall| {
            let (corners, infinite) = if wall.kept.gone { (Vec::new(), false) } else { wall.shape.corners() };
            WallState { name: wall.initial.name.clone(), corners, infinite, force: Some(wall.kept.force) }
        })
        .collect();
    let snapshot = Snapshot::new(scene, simulation.step, simulation.time(), grains, walls, contacts);
    StepState {
        touching,
        driven: simulation.forces_on_driven(),
        budget,
        ..StepState::of_rigid(snapshot, elastic_energy)
    }
}

/// Returns the grains that are present, sorted by id.
pub(crate) fn grain_states<S: Geometry>(simulation: &DemSimulation<S>) -> impl Iterator<Item = GrainState> {
    let (scene, time) = (&simulation.scene, simulation.time());
    let is_there = |id: &usize| simulation.grains.slot[*id] != ABSENT;
    let motion = |driven: &Driven| {
        let velocity = || driven.velocity_at(time, simulation.motion.time_step);
        driven.is_moved_at(time).then(|| (velocity(), driven.spin))
    };
    let motions: Vec<_> = scene.driven.iter().map(motion).collect();
    let groups = if motions.is_empty() { Vec::new() } else { scene.driven_group_of_grains() };
    (0..scene.grains.len()).filter(is_there).map(move |id| {
        let mut state = grain_state(simulation, id);
        if let Some(moved) = groups.get(id).copied().flatten().and_then(|group| motions[usize::from(group)]) {
            (state.velocity, state.spin) = moved;
        }
        state
    })
}

/// Returns the state of a grain. The velocity (m/s) and the spin (rad/s) are advanced by half a step, to the time of the
/// position.
fn grain_state<S: Geometry>(simulation: &DemSimulation<S>, id: usize) -> GrainState {
    let (scene, grains) = (&simulation.scene, &simulation.grains);
    let slot = grains.slot[id] as usize;
    let start = &scene.grains[id];
    let half = 0.5 * simulation.motion.time_step;
    let drag = 1.0 / (1.0 + scene.global_damping * half);
    let acceleration = grains.force(slot) * grains.inverse_mass(slot) + scene.gravity;
    let spin = match grains.spin(slot) {
        Some(spin) => spin * drag + grains.torque(slot) * (grains.inverse_inertia[slot] * half * drag),
        None => free_spin(scene, start.spin, simulation.motion.time_step, simulation.step),
    };
    let domain = scene.domain.filter(|_| scene.is_periodic());
    let position = grains.position(slot);
    // In two dimensions, the third number of a place is the angle.
    let angle = if grains.rotate() {
        grains.place[slot].0[2]
    } else {
        start.spin.z * simulation.step as f64 * simulation.motion.time_step
    };
    GrainState {
        position: domain.map_or(position, |domain| wrapped(position, &domain, S::DIMENSION)),
        velocity: (grains.velocity(slot) + acceleration * half) * drag,
        spin,
        angle: (S::DIMENSION == 2).then_some(angle),
        force: Some(grains.force(slot)),
        torque: Some(grains.torque(slot)),
        ..GrainState::start(id as u32 + 1, start)
    }
}

/// Returns the angular velocity (rad/s) after `step` steps of a grain without torques. Only global damping acts on it,
/// once per step (Cundall & Strack 1979, eq. 36).
fn free_spin(scene: &Scene, start: Vector3<f64>, time_step: f64, step: u64) -> Vector3<f64> {
    let half = 0.5 * scene.global_damping * time_step;
    start * libm::pow((1.0 - half) / (1.0 + half), step as f64)
}
