//! What a program is given of bodies that deform: cells, materials, bodies, how they start, and where probes are.

use grainbench_scene::body::{Block, BlockShape, Hold};
use grainbench_scene::material::{Constitutive, Deformable};
use grainbench_scene::scene::{BodyName, ProbeTarget, Scene};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

/// The grid of a run, where bodies deform.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Grid {
    /// Edge h of a cell (m).
    pub cell: f64,
    /// Material points per cell and axis at the start, for methods that have them.
    pub points: u32,
    /// Courant number c Δt/h of the steps, c the speed of the fastest wave.
    pub courant: f64,
}

/// A material that deforms.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Material {
    /// Name.
    pub material: String,
    /// Bulk modulus K (Pa).
    pub bulk_modulus: f64,
    /// Shear modulus G (Pa).
    pub shear_modulus: f64,
    /// `hypoelastic`, `neo-hookean` or `von-mises`, with its numbers.
    #[serde(flatten)]
    pub law: Constitutive,
}

/// A body that is no grain.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Body {
    /// Name.
    pub name: String,
    /// Material.
    pub material: String,
    /// Density ρ at the start (kg/m³).
    pub density: f64,
    /// Shape at the start.
    pub shape: BodyShape,
    /// Velocity at the start (m/s).
    pub velocity: [f64; 3],
    /// Angular velocity ω at the start about the middle of its shape (rad/s), on top of it: ω × (x − c).
    pub spin: [f64; 3],
    /// Rates of stretch at the start along the axes (1/s), on top of both: aᵢ (xᵢ − cᵢ).
    pub stretch: [f64; 3],
    /// By axis, what the lower side of a box may do and the upper one: `free`, `sliding` (kept from moving along its normal) or
    /// `fixed` (kept from moving at all).
    pub sides: [[&'static str; 2]; 3],
    /// A velocity along x on top of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wave: Option<Wave>,
}

/// The shape of a body.
#[derive(Clone, Debug, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BodyShape {
    /// A box along the axes.
    Box {
        /// Lower corner (m).
        low: [f64; 3],
        /// Upper corner (m).
        high: [f64; 3],
    },
    /// A ring, in the plane.
    Annulus {
        /// Centre (m).
        centre: [f64; 3],
        /// Inner radius (m).
        inner: f64,
        /// Outer radius (m).
        outer: f64,
    },
}

/// v_x = v₀ sin(β (x − x_low)).
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Wave {
    /// v₀ (m/s).
    pub amplitude: f64,
    /// β (1/m).
    pub wave_number: f64,
}

/// A damped phase before the clock starts: everything is at rest, then velocities and spins are given and the clock starts.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub struct Settle {
    /// How long (s).
    pub duration: f64,
    /// Mass-proportional damping α meanwhile (1/s).
    pub damping: f64,
    /// Gravity meanwhile (m/s²).
    pub gravity: [f64; 3],
}

/// A probe that looks at a body or into one.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct BodyProbe {
    /// Name; the columns of the series begin with it.
    pub name: String,
    /// The body or grain.
    pub of: String,
    /// The place at the start (m) of the material that it follows; the whole body where none is said.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<[f64; 3]>,
}

fn vector(vector: &Vector3<f64>) -> [f64; 3] {
    [vector.x, vector.y, vector.z]
}

/// The materials that deform.
pub(super) fn materials(scene: &Scene) -> Vec<Material> {
    let named = scene.materials.iter().zip(&scene.deformable);
    let material = |(name, of): (&String, &Option<Deformable>)| {
        let of = of.as_ref()?;
        Some(Material {
            material: name.clone(),
            bulk_modulus: of.bulk_modulus,
            shear_modulus: of.shear_modulus,
            law: of.constitutive,
        })
    };
    named.filter_map(material).collect()
}

/// The bodies.
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
            BlockShape::Box { low, high } => BodyShape::Box { low: vector(&low), high: vector(&high) },
            BlockShape::Annulus { centre, inner, outer } => {
                BodyShape::Annulus { centre: vector(&centre), inner, outer }
            }
        },
        velocity: vector(&body.velocity),
        spin: vector(&body.spin),
        stretch: vector(&body.stretch),
        sides: body.sides.map(|sides| sides.map(word)),
        wave: body.wave.map(|wave| Wave { amplitude: wave.amplitude, wave_number: wave.wave_number }),
    };
    scene.bodies.iter().map(body).collect()
}

/// The phase before the clock starts.
pub(super) fn settle(scene: &Scene) -> Option<Settle> {
    scene.start.settle.map(|settle| Settle {
        duration: settle.duration,
        damping: settle.damping,
        gravity: vector(&settle.gravity),
    })
}

/// The probes of bodies and of the material inside bodies and grains.
pub(super) fn probes(scene: &Scene) -> Vec<BodyProbe> {
    let name = |of: BodyName| match of {
        BodyName::Grain(at) => format!("grain {}", at + 1),
        BodyName::Body(at) => scene.bodies[at].name.clone(),
    };
    let probe = |probe: &grainbench_scene::scene::Probe| {
        let (of, at) = match probe.target {
            ProbeTarget::Body(at) => (BodyName::Body(at), None),
            ProbeTarget::Point(at) => (scene.spots[at].body, Some(vector(&scene.spots[at].at))),
            _ => return None,
        };
        Some(BodyProbe { name: probe.name.clone(), of: name(of), at })
    };
    scene.probes.iter().filter_map(probe).collect()
}
