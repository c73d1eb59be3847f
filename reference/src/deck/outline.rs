//! Checks and properties of a scene that decks for both programs share.

use grainbench_scene::contact_law::{ContactLaw, SpringsKind};
use grainbench_scene::dimension::Dimension;
use grainbench_scene::dimension::GrainShape;
use grainbench_scene::motion::Moment;
use grainbench_scene::scene::{Driven, Scene, Wall, WallShape};
use nalgebra::Vector3;

/// Contact laws that decks can express. Scenes with other laws are refused.
const WRITTEN: [SpringsKind; 3] = [SpringsKind::Coulomb, SpringsKind::Linear, SpringsKind::HertzMindlin];

/// Returns an error if the scene has physics that both programs lack or define differently.
pub(crate) fn refuse_what_neither_has(scene: &Scene) -> Result<(), String> {
    let laws = || scene.laws.iter().flatten();
    if scene.grains.is_empty() {
        return Err("it has no grain".to_owned());
    }
    if scene.driven.iter().any(Driven::is_for_a_while) {
        return Err(
            "it has grains with prescribed motion during a part of the run, for which a deck would have to change the \
                    integration groups between two runs"
                .to_owned(),
        );
    }
    if let Some(driven) = scene.driven.iter().find(|driven| !driven.motion.is_empty() || driven.spin.norm() > 0.0) {
        return Err(format!(
            "driven grains `{}` have a spin or a motion in addition to their velocity, but decks contain only `fix \
             move linear`",
            driven.name
        ));
    }
    if let Some(what) = scene.gathered() {
        return Err(format!("it has {what}, which decks do not support"));
    }
    if scene.global_damping != 0.0 {
        return Err("neither LAMMPS nor LIGGGHTS has mass-proportional damping of translation and rotation \
                    (`global_damping`)"
            .to_owned());
    }
    if let Some(law) = laws().find(|law| !WRITTEN.contains(&law.springs.kind())) {
        return Err(format!("its law is `{}`, which decks do not support", law.springs.kind().word()));
    }
    if laws().any(|law| law.cohesion != 0.0) {
        let here = "its cohesion is a shear strength without load, |F_s| <= F_n tan phi + c, and never attracts";
        return Err(format!("{here}; LAMMPS and LIGGGHTS have cohesion only as an attraction along the normal"));
    }
    if laws()
        .any(|law| law.is_hertz() && (law.normal_damping != 0.0 || law.has_friction() && law.tangential_damping != 0.0))
    {
        let here = "its dashpot gamma m_eff at a Hertz contact does not depend on the overlap";
        return Err(format!("{here}; LAMMPS and LIGGGHTS multiply it by sqrt(R_eff overlap)"));
    }
    if laws().any(|law| law.is_hertz() && law.rolling_friction != 0.0) {
        let here = "the stiffness of its rolling spring at a Hertz contact grows with the stiffness of the contact";
        return Err(format!(
            "{here}; LAMMPS has a rolling spring of constant stiffness, and LIGGGHTS stores its moment instead of its \
             angle"
        ));
    }
    Ok(())
}

/// Checks that all grains have the inertia factor I/(mR²) = `factor`.
pub(crate) fn one_inertia(scene: &Scene, factor: f64) -> Result<(), String> {
    let other = scene.grains.iter().position(|grain| {
        let moment = factor * grain.mass * grain.radius * grain.radius;
        (grain.inertia - moment).abs() > 1e-12 * moment
    });
    match other {
        None => Ok(()),
        Some(at) => {
            let grain = &scene.grains[at];
            let found = grain.inertia / (grain.mass * grain.radius * grain.radius);
            Err(format!(
                "the program uses moments of inertia of {factor} m R², but grain {} has {found:.6} m R²",
                at + 1
            ))
        }
    }
}

/// Returns true if the scene is two-dimensional.
pub(crate) fn is_flat(scene: &Scene) -> bool {
    scene.dimension == Dimension::Two
}

/// Returns I/(mR²) for the shape of the grains in the scene: 1/2 for discs, 2/5 for spheres.
pub(crate) fn inertia_factor(scene: &Scene) -> f64 {
    scene.grain_shape.inertia_factor()
}

pub(crate) fn has_discs(scene: &Scene) -> bool {
    scene.grain_shape == GrainShape::Disc
}

/// Returns the indices of the materials of all grains, sorted and without duplicates.
pub(crate) fn grain_materials(scene: &Scene) -> Vec<u16> {
    let mut materials: Vec<u16> = scene.grains.iter().map(|grain| grain.material).collect();
    materials.sort_unstable();
    materials.dedup();
    materials
}

/// Plane normal to an axis at the position `at` (m). `is_low` is true if its normal points in the positive direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct AxisPlane {
    pub(crate) axis: usize,
    pub(crate) at: f64,
    pub(crate) is_low: bool,
    /// Axis and velocity (m/s) of a tangential motion; `None` at rest.
    pub(crate) shear: Option<(usize, f64)>,
}

pub(crate) const AXES: [&str; 3] = ["x", "y", "z"];

impl AxisPlane {
    /// Returns a wall as a plane normal to an axis, or `None` if the wall has another shape or motion. It must be at
    /// rest, or move tangentially along one axis at one velocity for the whole run.
    pub(crate) fn from_wall(wall: &Wall) -> Option<Self> {
        let WallShape::Plane { point, normal } = wall.shape else { return None };
        let axis = (0..3).find(|&axis| normal[axis].abs() == 1.0)?;
        let mut plane = Self { axis, at: point[axis], is_low: normal[axis] > 0.0, shear: None };
        if wall.motion.is_moving() {
            let ([phase], []) = (&wall.motion.phases[..], &wall.motion.functions[..]) else { return None };
            let always = matches!(phase.start, Moment::Seconds(0.0) | Moment::Cycle(0)) && phase.stop == Moment::Never;
            let mut along = (0..3).filter(|&axis| phase.velocity[axis] != 0.0);
            let (first, second) = (along.next()?, along.next());
            if !always || second.is_some() || first == axis || phase.spin != Vector3::zeros() {
                return None;
            }
            plane.shear = Some((first, phase.velocity[first]));
        }
        Some(plane)
    }
}

/// Returns 4/3 of the effective modulus E* and 8 times the effective shear modulus G* (Pa).
pub(crate) fn hertz(law: &ContactLaw) -> (f64, f64) {
    (4.0 / 3.0 * law.effective_modulus(), 8.0 * law.effective_shear_modulus())
}
