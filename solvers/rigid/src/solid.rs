// Parts that are specific to rapier3d.

use grainbench_scene::scene::WallShape;
use nalgebra::Vector3;
use rapier::math::Matrix;
use rapier::prelude::{
    AngVector, ColliderBuilder, FrictionModel, IntegrationParameters, MassProperties, Pose, Rotation, Vector,
};
pub(crate) use rapier3d as rapier;

#[path = "world.rs"]
#[expect(clippy::duplicate_mod, reason = "one source for both engines, whose types differ and whose names do not")]
pub(crate) mod world;

fn vector(v: Vector3<f64>) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

fn embedded(v: Vector) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z)
}

fn spin(v: Vector3<f64>) -> AngVector {
    vector(v)
}

fn embedded_spin(spin: AngVector) -> Vector3<f64> {
    embedded(spin)
}

fn pose(centre: Vector3<f64>, rotation: Vector3<f64>) -> Pose {
    Pose::new(vector(centre), vector(rotation))
}

const fn orientation(_rotation: &Rotation) -> f64 {
    0.0
}

fn mass_properties(mass: f64, inertia: f64) -> MassProperties {
    MassProperties::new(Vector::ZERO, mass, Vector::splat(inertia))
}

/// Returns the friction impulse on the first body from its components in the solver's basis.
///
/// rapier builds this basis from the normal direction (Duff et al., Building an Orthonormal Basis, Revisited, 2017).
fn shear(normal: Vector, components: rapier::math::TangentImpulse<f64>) -> Vector3<f64> {
    let push = -embedded(normal);
    let sign = 1.0_f64.copysign(push.z);
    let a = -1.0 / (sign + push.z);
    let first = Vector3::new(push.x * push.y * a, sign + push.y * push.y * a, -push.y);
    first * components.x + push.cross(&first) * components.y
}

/// Returns the collider of a rectangle, relative to `origin`; `None` for other shapes. The collider is a cuboid of zero
/// thickness.
///
/// The contact point of a ball is the nearest point of the cuboid, and thus of the rectangle. Two triangles would give
/// two contacts on their common edge. A finite thickness would move the surface or the edges.
fn finite(shape: &WallShape, origin: Vector3<f64>) -> Option<ColliderBuilder> {
    match shape {
        WallShape::Rectangle { corner, edges: [u, v] } => {
            let middle = corner + (u + v) * 0.5;
            let (along, across) = (u.normalize(), v.normalize());
            let axes = Matrix::from_cols(vector(along), vector(across), vector(along.cross(&across)));
            let position = Pose::from_parts(vector(middle - origin), Rotation::from_mat3(&axes));
            Some(ColliderBuilder::cuboid(0.5 * u.norm(), 0.5 * v.norm(), 0.0).position(position))
        }
        WallShape::Plane { .. } | WallShape::Segment { .. } | WallShape::Round { .. } | WallShape::Mesh(_) => None,
    }
}

/// Selects Coulomb friction at every contact point, as in the scene's law. rapier's default adds torsional resistance.
const fn choose_friction(parameters: &mut IntegrationParameters) {
    parameters.friction_model = FrictionModel::Coulomb;
}
