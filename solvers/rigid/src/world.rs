// A scene in rapier. The file is compiled once for each dimension, with the engine and types of that dimension in
// `super`.

use super::rapier::prelude::{
    ActiveHooks, CoefficientCombineRule, ColliderBuilder, ContactModificationContext, IntegrationParameters,
    PhysicsHooks, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle, SharedShape, SpringCoefficients,
};
use super::{
    choose_friction, embedded, embedded_spin, finite, mass_properties, orientation, pose, shear, spin, vector,
};
use crate::engine::{Engine, GrainMotion, LoadedContact, Placement, Stepping};
use crate::pairs::{Side, coefficients, common_coefficients};
use grainbench_scene::scene::{Scene, WallShape};
use nalgebra::Vector3;

/// Hook that sets the coefficients of every pair from the scene.
struct SceneCoefficients(Scene);

impl PhysicsHooks for SceneCoefficients {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext<'_>) {
        let side = |handle| context.colliders.get(handle).map(|collider| Side::of_tag(collider.user_data));
        let (Some(one), Some(other)) = (side(context.collider1), side(context.collider2)) else { return };
        let Some(contact) = context.rigid_mut() else { return };
        match coefficients(&self.0, one, other) {
            Some(coefficients) => {
                *contact.friction = coefficients.friction;
                *contact.restitution = coefficients.restitution;
            }
            // Grains and walls without a contact law pass through each other.
            None => contact.solver_contacts.clear(),
        }
    }
}

/// rapier with the bodies of a scene.
pub(crate) struct World {
    world: PhysicsWorld,
    hooks: SceneCoefficients,
    grains: Vec<RigidBodyHandle>,
    walls: Vec<RigidBodyHandle>,
    /// Unit of mass (kg).
    mass: f64,
}

impl World {
    pub(crate) fn new(scene: &Scene, stepping: &Stepping) -> Self {
        let shared = common_coefficients(scene);
        // If all pairs have the same coefficients, the shapes store them, as is usual with rapier. Otherwise a hook
        // sets the coefficients of each pair.
        let with_coefficients = |builder: ColliderBuilder, side: Side| {
            let builder = builder.density(0.0).user_data(side.tag());
            match shared {
                Some(coefficients) => builder
                    .friction(coefficients.friction)
                    .restitution(coefficients.restitution)
                    .friction_combine_rule(CoefficientCombineRule::Max)
                    .restitution_combine_rule(CoefficientCombineRule::Max),
                None => builder.active_hooks(ActiveHooks::MODIFY_SOLVER_CONTACTS),
            }
        };
        let mut world = PhysicsWorld {
            gravity: vector(scene.gravity),
            integration_parameters: parameters(stepping),
            ..PhysicsWorld::default()
        };
        let grains = scene.grains.iter().enumerate().map(|(at, grain)| {
            let body = RigidBodyBuilder::dynamic()
                .translation(vector(grain.position))
                .linvel(vector(grain.velocity))
                .angvel(spin(grain.spin))
                // rapier treats masses above 1e20 as infinite, so masses are in units near the mean mass.
                .additional_mass_properties(mass_properties(grain.mass / stepping.mass, grain.inertia / stepping.mass))
                .linear_damping(scene.global_damping)
                .angular_damping(scene.global_damping)
                .can_sleep(false)
                // rapier would otherwise limit spins to a quarter turn per step.
                .allow_fast_rotation(true);
            world.insert(body, with_coefficients(ColliderBuilder::ball(grain.radius), Side::Grain(at))).0
        });
        let grains = grains.collect();
        let walls = scene.walls.iter().enumerate().map(|(at, wall)| {
            let origin = wall.motion.centre;
            let body = if wall.motion.is_moving() {
                RigidBodyBuilder::kinematic_position_based()
            } else {
                RigidBodyBuilder::fixed()
            };
            let shape = match &wall.shape {
                WallShape::Plane { point, normal } => Some(
                    ColliderBuilder::new(SharedShape::halfspace(vector(*normal))).translation(vector(point - origin)),
                ),
                shape => finite(shape, origin),
            };
            let body = body.translation(vector(origin));
            match shape {
                Some(shape) => world.insert(body, with_coefficients(shape, Side::Wall(at))).0,
                None => world.bodies.insert(body),
            }
        });
        let walls = walls.collect();
        Self { world, hooks: SceneCoefficients(scene.clone()), grains, walls, mass: stepping.mass }
    }
}

/// Returns rapier's defaults with the values of `stepping`, Coulomb friction, no speed limit and no continuous collision
/// detection.
fn parameters(stepping: &Stepping) -> IntegrationParameters {
    let settings = &stepping.settings;
    let softness =
        |frequency| SpringCoefficients { natural_frequency: frequency, damping_ratio: settings.damping_ratio };
    let mut parameters = IntegrationParameters {
        dt: stepping.time_step,
        num_solver_iterations: stepping.iterations,
        length_unit: stepping.length,
        normalized_max_linear_velocity: f64::MAX,
        max_ccd_substeps: 0,
        contact_recycling: settings.recycling,
        contact_softness: softness(settings.frequency),
        static_contact_softness: softness(settings.wall_frequency),
        ..IntegrationParameters::default()
    };
    choose_friction(&mut parameters);
    parameters
}

impl Engine for World {
    fn step(&mut self, walls: &[Placement]) {
        for placement in walls {
            if let Some(body) = self.world.bodies.get_mut(self.walls[placement.wall]) {
                body.set_next_kinematic_position(pose(placement.centre, placement.rotation));
            }
        }
        self.world.step_with_events(&self.hooks, &());
    }

    fn grain(&self, at: usize) -> GrainMotion {
        // rapier never removes a body. A missing body would have the state NaN, which is reported as not finite.
        let gone = Vector3::repeat(f64::NAN);
        self.world.bodies.get(self.grains[at]).map_or(
            GrainMotion { position: gone, velocity: gone, spin: gone, orientation: 0.0 },
            |body| GrainMotion {
                position: embedded(body.translation()),
                velocity: embedded(body.linvel()),
                spin: embedded_spin(body.angvel()),
                orientation: orientation(body.rotation()),
            },
        )
    }

    fn touches(&self) -> Vec<LoadedContact> {
        let side = |handle| self.world.colliders.get(handle).map(|collider| Side::of_tag(collider.user_data));
        let mut touches = Vec::new();
        for pair in self.world.narrow_phase.contact_pairs() {
            let (Some(one), Some(other)) = (side(pair.collider1), side(pair.collider2)) else { continue };
            for manifold in pair.solver_manifolds() {
                for point in manifold.points.iter().filter(|point| point.data.impulse > 0.0) {
                    touches.push(LoadedContact {
                        sides: [one, other],
                        normal: embedded(manifold.data.normal),
                        push: point.data.impulse * self.mass,
                        shear: shear(manifold.data.normal, point.data.tangent_impulse) * self.mass,
                        friction: manifold.data.friction,
                    });
                }
            }
        }
        touches
    }

    fn counts(&self) -> (u64, u64) {
        self.world
            .narrow_phase
            .contact_pairs()
            .fold((0, 0), |(tested, solved), pair| (tested + 1, solved + u64::from(pair.has_any_active_contact())))
    }
}
