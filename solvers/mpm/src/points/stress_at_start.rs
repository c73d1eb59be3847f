//! Initial stress of bodies: a hydrostatic pressure or a stress given by the scene.

use crate::material::{Law, Material, State as Material3, with_law};
use crate::points::arrays::Points;
use crate::points::body::Body;
use crate::points::state::State;
use crate::surface::tracers::Tracers;
use grainbench_scene::body::BlockShape;
use grainbench_scene::scene::Scene;
use grainbench_solver::record::Owner;
use grainbench_solver::space::Space;
use nalgebra::{Matrix3, Vector3};

/// Returns the reason why a body cannot have the initial stress that the scene gives, or `None` if it can.
///
/// A stress that is linear in position is largest at a corner of the bounding box, so only the corners are checked.
pub(crate) fn refusal(scene: &Scene) -> Option<String> {
    let dimensions = scene.dimension.count();
    scene.bodies.iter().find_map(|body| {
        let stress = body.stress.as_ref()?;
        let material = scene.deformable.get(usize::from(body.material)).copied().flatten()?;
        // The time step has no influence, because material at rest has no viscous stress.
        let law = Material::new(&material, 1.0);
        let (low, high) = body.shape.corners();
        let centre = body.shape.centre();
        let corner = |number: usize| {
            let part = |axis: usize| if number >> axis & 1 == 0 { low[axis] } else { high[axis] };
            Vector3::new(part(0), part(1), part(2))
        };
        let bears = |place: Vector3<f64>| state_under(&law, &stress.at(place - centre), dimensions).is_some();
        let place = (0..1 << dimensions).map(corner).find(|&place| !bears(place))?;
        let kind = material.constitutive.kind();
        let there = match body.shape {
            BlockShape::Box { .. } => "at its corner",
            BlockShape::Annulus { .. } => "at the corner of the square around it",
        };
        let place: Vec<String> = place.iter().take(dimensions).map(f64::to_string).collect();
        Some(format!(
            "body `{}` starts with a stress that its material `{}` ({kind}) cannot bear, {there} [{}]: expected a \
             stress below its moduli, and below its yield stress if it has one",
            body.name,
            scene.materials[usize::from(body.material)],
            place.join(", ")
        ))
    })
}

/// Returns true if the scene gives an initial pressure or the initial stress of a body.
pub(crate) fn is_given(scene: &Scene) -> bool {
    scene.start.initial_pressure.is_some() || scene.bodies.iter().any(|body| body.stress.is_some())
}

fn state_under(law: &Material, stress: &Matrix3<f64>, dimensions: usize) -> Option<Material3> {
    with_law!(law, law => law.under_stress(stress, dimensions))
}

/// Applies the initial stress of the scene to the points. `gravity` (m/s²) determines the hydrostatic pressure.
pub(crate) fn give<S: Space>(scene: &Scene, gravity: Vector3<f64>, state: &mut State<S>, tracers: &Tracers<S>) {
    let State { bodies, points, .. } = state;
    for body in bodies.iter() {
        if scene.start.initial_pressure.is_some() {
            let depth = |position: S::Vector| S::embed(position).dot(&gravity);
            let surface = tracers.position[body.tracers.clone()].iter().map(|&at| depth(at));
            // The pressure is zero at the highest point of the body.
            let top = surface.fold(f64::INFINITY, f64::min);
            let pressure = |position| body.density * (depth(position) - top);
            press(body, points, |position| Matrix3::from_diagonal_element(-pressure(position)));
        }
        if let Owner::Body(place) = body.owner
            && let block = &scene.bodies[place as usize]
            && let Some(stress) = &block.stress
        {
            let centre = block.shape.centre();
            press(body, points, |position| stress.at(S::embed(position) - centre));
        }
    }
}

/// Applies to every point of a body the stress (Pa) at the point's position.
fn press<S: Space>(body: &Body, points: &mut Points<S>, stress: impl Fn(S::Vector) -> Matrix3<f64>) {
    for at in body.points.clone() {
        // Stresses that the material cannot have were rejected before. A NaN state would fail at the first step and be
        // reported.
        let broken = || Material3 { deformation: Matrix3::from_element(f64::NAN), ..Material3::default() };
        let wanted = stress(points.position[at]);
        let Material3 { deformation, stress, .. } =
            state_under(&body.law, &wanted, S::DIMENSION).unwrap_or_else(broken);
        points.reference_volume[at] = points.volume[at] / deformation.determinant();
        points.deformation[at] = S::restrict_gradient(deformation);
        points.stress[at] = S::restrict_symmetric(stress);
    }
}
