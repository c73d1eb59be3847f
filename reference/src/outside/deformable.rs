//! Deformable bodies in a resolved scene: grid, materials, bodies, relaxation and probes.

use grainbench_scene::body::{Block, BlockShape, Hold};
use grainbench_scene::material::{Constitutive, Deformable};
use grainbench_scene::scene::{BodyName, ProbeTarget, Scene};
use schemars::JsonSchema;
use serde::Serialize;

/// Grid of a run with deformable bodies.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Grid {
    /// Edge length h of a cell (m).
    pub cell: f64,
    /// Number of material points per cell and axis at the start, for programs that have material points.
    pub points: u32,
    /// Courant number c Δt/h, with the speed c of the fastest wave and the time step Δt.
    pub courant: f64,
}

/// Deformable material.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Material {
    /// Name of the material.
    pub material: String,
    /// Bulk modulus K (Pa).
    pub bulk_modulus: f64,
    /// Shear modulus G (Pa).
    pub shear_modulus: f64,
    /// Constitutive law (key `constitutive`: `hypoelastic`, `neo-hookean`, `kelvin-voigt` or `von-mises`) with its
    /// parameters.
    #[serde(flatten)]
    pub law: Constitutive,
}

/// Deformable body that is not a grain.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Body {
    /// Name of the body.
    pub name: String,
    /// Name of the body's material.
    pub material: String,
    /// Initial density ρ (kg/m³).
    pub density: f64,
    /// Initial shape of the body.
    pub shape: BodyShape,
    /// Initial velocity (m/s), to which `spin`, `stretch` and `wave` add.
    pub velocity: [f64; 3],
    /// Initial angular velocity ω about the centre c of the shape (rad/s). It adds ω × (x − c) to the velocity at x.
    pub spin: [f64; 3],
    /// Initial stretch rates a along the axes (1/s). They add aᵢ (xᵢ − cᵢ) to the velocity component vᵢ.
    pub stretch: [f64; 3],
    /// Constraints of the lower and the upper side of a box along each axis: `free`, `sliding` (no normal motion) or
    /// `fixed` (no motion).
    pub sides: [[&'static str; 2]; 3],
    /// Sine wave that is added to the velocity along x; absent if there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wave: Option<Wave>,
}

/// Initial shape of a body.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BodyShape {
    /// Box along the axes.
    Box {
        /// Lower corner (m).
        low: [f64; 3],
        /// Upper corner (m).
        high: [f64; 3],
    },
    /// Ring in two dimensions.
    Annulus {
        /// Centre (m).
        centre: [f64; 3],
        /// Inner radius (m).
        inner: f64,
        /// Outer radius (m).
        outer: f64,
    },
}

/// Initial velocity wave v_x = v₀ sin(β (x − x_low)), with the lower side x_low of the body.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Wave {
    /// Amplitude v₀ (m/s).
    pub amplitude: f64,
    /// Wave number β (1/m).
    pub wave_number: f64,
}

/// Damped relaxation before the run, which starts with all bodies at rest. After the relaxation, the initial velocities
/// and spins are set, and time starts at zero.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Settle {
    /// Duration of the relaxation (s).
    pub duration: f64,
    /// Mass-proportional damping α during the relaxation (1/s).
    pub damping: f64,
    /// Gravity during the relaxation (m/s²).
    pub gravity: [f64; 3],
}

/// Probe of a body or of a point inside a body.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct BodyProbe {
    /// Name of the probe, with which its columns in the series begin.
    pub name: String,
    /// Name of the body, or `grain N` with the id N of a grain.
    pub of: String,
    /// Initial position of the material point that the probe follows (m); absent for a probe of the whole body.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 3]>,
}

/// Returns the materials of a scene for which elastic moduli are given.
pub(super) fn materials(scene: &Scene) -> Vec<Material> {
    let named = scene.materials.iter().zip(&scene.deformable);
    let material = |(name, deformable): (&String, &Option<Deformable>)| {
        let deformable = deformable.as_ref()?;
        Some(Material {
            material: name.clone(),
            bulk_modulus: deformable.bulk_modulus,
            shear_modulus: deformable.shear_modulus,
            law: deformable.constitutive,
        })
    };
    named.filter_map(material).collect()
}

/// Returns the deformable bodies of a scene.
pub(super) fn bodies(scene: &Scene) -> Vec<Body> {
    let word = |hold: Hold| match hold {
        Hold::Free => "free",
        Hold::Sliding => "sliding",
        Hold::Fixed => "fixed",
    };
    let body = |body: &Block| Body {
        name: body.name.clone(),
        material: scene.materials[usize::from(body.material)].clone(),
        density: body.density,
        shape: match body.shape {
            BlockShape::Box { low, high } => BodyShape::Box { low: low.into(), high: high.into() },
            BlockShape::Annulus { centre, inner, outer } => BodyShape::Annulus { centre: centre.into(), inner, outer },
        },
        velocity: body.velocity.into(),
        spin: body.spin.into(),
        stretch: body.stretch.into(),
        sides: body.sides.map(|sides| sides.map(word)),
        wave: body.wave.map(|wave| Wave { amplitude: wave.amplitude, wave_number: wave.wave_number }),
    };
    scene.bodies.iter().map(body).collect()
}

/// Returns the relaxation of a scene before the run, or `None` if there is none.
pub(super) fn settle(scene: &Scene) -> Option<Settle> {
    scene.start.settle.map(|settle| Settle {
        duration: settle.duration,
        damping: settle.damping,
        gravity: settle.gravity.into(),
    })
}

/// Returns the probes of bodies, and of points inside bodies and grains.
pub(super) fn probes(scene: &Scene) -> Vec<BodyProbe> {
    let name = |body_name: BodyName| match body_name {
        BodyName::Grain(at) => format!("grain {}", at + 1),
        BodyName::Body(at) => scene.bodies[at].name.clone(),
    };
    let probe = |probe: &grainbench_scene::scene::Probe| {
        let (body, at) = match probe.target {
            ProbeTarget::Body(at) => (BodyName::Body(at), None),
            ProbeTarget::Point(at) => (scene.spots[at].body, Some(scene.spots[at].at.into())),
            _ => return None,
        };
        Some(BodyProbe { name: probe.name.clone(), of: name(body), at })
    };
    scene.probes.iter().filter_map(probe).collect()
}
