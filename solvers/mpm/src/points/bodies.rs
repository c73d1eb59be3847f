//! Creation of bodies from a scene, with seeding of material points and surface tracers.

use crate::grid::lattice::{Lattice, Window};
use crate::material::Material;
use crate::options::{Setting, Transfer};
use crate::points::arrays::Points;
use crate::points::body::Body;
use crate::points::seed::{self, Seed};
use crate::surface::elements::{self, Patch};
use crate::surface::tracers::Tracers;
use grainbench_scene::body::{Block, BlockShape, Sides};
use grainbench_scene::scene::Scene;
use grainbench_solver::record::Owner;
use grainbench_solver::space::Space;
use nalgebra::Vector3;

/// Seeds all bodies of a scene with `per_cell` points per cell and axis.
///
/// `time_step` (s) is the time step of the constitutive laws. Grains and blocks of materials without elastic moduli are
/// skipped, because an earlier check rejects their scenes.
pub(crate) fn seed<S: Space>(
    scene: &Scene,
    setting: &Setting,
    lattice: &Lattice,
    per_cell: u32,
    time_step: f64,
) -> (Vec<Body>, Points<S>, Tracers<S>) {
    let cell = lattice.shortest(S::DIMENSION);
    let spacing = cell / f64::from(per_cell);
    let between = cell / setting.tracers;
    let (mut bodies, mut points, mut tracers) = (Vec::new(), Points::<S>::default(), Tracers::default());
    let half = 0.5 / f64::from(per_cell);
    let driven = scene.driven_group_of_grains();
    let mut add = |owner: Owner, material: u16, density: f64, seeds: &[Seed], surfaces: &[Vec<Patch>]| {
        let Some(deformable) = scene.deformable.get(usize::from(material)).copied().flatten() else { return };
        let first = (points.len(), tracers.len());
        for seed in seeds {
            points.push(S::restrict(seed.position), seed.volume, density);
        }
        surfaces.iter().for_each(|surface| tracers.add(surface));
        let (held, driven) = match owner {
            Owner::Grain(id) => (None, driven[id as usize - 1]),
            Owner::Body(at) => (held(&scene.bodies[at as usize]), None),
        };
        bodies.push(Body {
            owner,
            points: first.0..points.len(),
            window: Window::default(),
            runs_in_order: 0,
            half,
            cell_mass: density * lattice.cell[..S::DIMENSION].iter().product::<f64>(),
            tracers: first.1..tracers.len(),
            chunks: tracers.cut(first.1..tracers.len()),
            material,
            law: Material::new(&deformable, time_step),
            density,
            deformable,
            bounds: [Vector3::zeros(); 2],
            angle: 0.0,
            held,
            driven,
        });
    };
    for (at, grain) in scene.grains.iter().enumerate() {
        let (centre, radius) = (grain.position, grain.radius);
        let (seeds, surface) = if S::DIMENSION == 2 {
            (seed::rings(centre, 0.0, radius, spacing), elements::circle(centre, radius, between, 1.0))
        } else {
            (seed::shells(centre, radius, spacing), elements::globe(centre, radius, between))
        };
        let volume: f64 = seeds.iter().map(|seed| seed.volume).sum();
        add(Owner::Grain(at as u32 + 1), grain.material, grain.mass / volume, &seeds, &[surface]);
    }
    for (at, block) in scene.bodies.iter().enumerate() {
        let (seeds, surfaces) = match block.shape {
            BlockShape::Box { low, high } => {
                let spacing = lattice.cell.map(|cell| cell / f64::from(per_cell));
                let surface = if S::DIMENSION == 2 {
                    elements::rectangle(low, high, between)
                } else {
                    elements::faces(low, high, between)
                };
                (seed::lattice(low, high, spacing, S::DIMENSION), vec![surface])
            }
            BlockShape::Annulus { centre, inner, outer } => {
                let surfaces = [(outer, 1.0), (inner, -1.0)]
                    .map(|(radius, outward)| elements::circle(centre, radius, between, outward));
                (seed::rings(centre, inner, outer, spacing), surfaces.into())
            }
        };
        add(Owner::Body(at as u32), block.material, block.density, &seeds, &surfaces);
    }
    if !matches!(setting.transfer, Transfer::Flip { .. }) {
        points.affine = vec![S::NO_GRADIENT; points.len()];
    }
    if bodies.iter().any(|body: &Body| body.deformable.constitutive.yield_stress().is_some()) {
        points.plastic_strain = vec![0.0; points.len()];
    }
    (bodies, points, tracers)
}

/// Returns the held sides of a box and its corners (m); `None` if no side is held.
fn held(block: &Block) -> Option<(Sides, [Vector3<f64>; 2])> {
    let BlockShape::Box { low, high } = block.shape else { return None };
    (block.sides != Sides::default()).then_some((block.sides, [low, high]))
}
