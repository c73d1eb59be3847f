// Parts that are specific to rapier2d.

use grainbench_scene::scene::WallShape;
use nalgebra::Vector3;
use rapier::prelude::{AngVector, ColliderBuilder, IntegrationParameters, MassProperties, Pose, Rotation, Vector};
pub(crate) use rapier2d as rapier;

#[path = "world.rs"]
#[expect(clippy::duplicate_mod, reason = "one source for both engines, whose types differ and whose names do not")]
pub(crate) mod world;

fn vector(v: Vector3<f64>) -> Vector {
    Vector::new(v.x, v.y)
}

fn embedded(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x, v.y, 0.0)
}

fn spin(v: Vector3<f64>) -> AngVector {
    v.z
}

fn embedded_spin(spin: AngVector) -> Vector3<f64> {
    Vector3::new(0.0, 0.0, spin)
}

fn pose(centre: Vector3<f64>, rotation: Vector3<f64>) -> Pose {
    Pose::new(vector(centre), rotation.z)
}

fn orientation(rotation: &Rotation) -> f64 {
    rotation.angle()
}

fn mass_properties(mass: f64, inertia: f64) -> MassProperties {
    MassProperties::new(Vector::ZERO, mass, inertia)
}

/// Returns the friction impulse on the first body from its component in the solver's basis.
fn shear(normal: Vector, component: rapier::math::TangentImpulse<f64>) -> Vector3<f64> {
    let push = -normal;
    embedded(Vector::new(-push.y, push.x)) * component.x
}

/// Returns the collider of a segment, relative to `origin`; `None` for other shapes. A ball on either side touches the
/// nearest point of the segment.
fn finite(shape: &WallShape, origin: Vector3<f64>) -> Option<ColliderBuilder> {
    match shape {
        WallShape::Segment { ends } => {
            Some(ColliderBuilder::segment(vector(ends[0] - origin), vector(ends[1] - origin)))
        }
        WallShape::Plane { .. } | WallShape::Rectangle { .. } | WallShape::Round { .. } | WallShape::Mesh(_) => None,
    }
}

/// Does nothing, because there is only one friction model in two dimensions.
fn choose_friction(_parameters: &mut IntegrationParameters) {}
