//! A sphere on triangle meshes: it rolls across seams of coplanar triangles, and is in contact with edges and corners.

mod floors;

use crate::rows::programs::{row, same_cycle};
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[fraction("dt=.1", 0.1), fraction("dt=.03", 0.03), fraction("dt=.01", 0.01)];
/// Time step (s): 1/63 of the critical time step.
const STEP: Resolution = Resolution::TimeStep(1e-4);
const FLOORS: [&str; 2] = ["two-triangles", "many-triangles"];
const AXES: [&str; 3] = ["ball.x", "ball.y", "ball.z"];

pub(crate) static CASE: Case = crate::heads::MESH_SEAM.with(LEVELS, 1, &claims);

fn claims() -> Vec<Claim> {
    let mut claims: Vec<Claim> =
        FLOORS.into_iter().flat_map(|floor| [level(floor), rolls(floor), as_plane(floor)]).collect();
    claims.extend(PLACES.iter().map(held));
    claims.extend(FLOORS.map(liggghts));
    claims
}

fn level(floor: &'static str) -> Claim {
    let control = match floor {
        "two-triangles" => {
            Control::scene("a contact with each side of the seam: two rectangles with a gap", floors::of_two_rectangles)
        }
        _ => Control::scene("a step of 1e-3 R at the seams along a line", floors::with_a_step),
    };
    claim(format!("height over the seams, {floor}, worst, over the overlap at rest"), "m")
        .run(Run::new(floor, "dem:lammps", STEP))
        .holds("a plane has no seams (derivation)", |done| {
            let (scene, height) = (&done[0].scene, done[0].column("ball.z")?);
            let grain = &scene.grains[0];
            let overlap = grain.radius - grain.position.z;
            Ok(Measurement::worst(&done[0].series().time, height, |_| grain.position.z, overlap))
        })
        .within(computed(
            1e-9,
            "rounding: 1e-16 m/1e-4 m per step for a thousand steps; springs bring older errors back",
        ))
        .refuses(control)
}

fn rolls(floor: &'static str) -> Claim {
    claim(format!("velocity at 1 s, {floor}"), "m/s")
        .run(Run::new(floor, "dem:lammps", STEP))
        .equals(Source::Derived("5/7 of the initial velocity (derivation)"), |done| {
            let start = done[0].scene.grains[0].velocity.norm();
            let exact = 5.0 / 7.0 * start;
            Ok(Measurement::relative(done[0].last("ball.vx")?.hypot(done[0].last("ball.vy")?), exact))
        })
        .within(rounding(1.0, "angular momentum about the contact determines the value once the spring is at rest"))
        .refuses(Control::grains("the inertia of a disc", |grain| grain.inertia *= 1.25))
}

/// Returns the claim that a flat mesh, rotated so that its coordinates have rounding errors, is a plane.
fn as_plane(floor: &'static str) -> Claim {
    let turned_run = |variant| Run::new(variant, "dem:lammps", STEP).adjusted("turned by 20°", floors::turned);
    claim(format!("position on a slant, {floor} and a plane, worst, over R"), "m")
        .runs([turned_run(floor), turned_run("plane").aside()])
        .agrees(Source::Ourselves("the same on a plane"), |done| worst(done, &AXES, done[0].scene.grains[0].radius))
        .within(required(1e-9, "a mesh of a plane is the plane"))
        .refuses(Control::scene("a step of 1e-3 R in the mesh", floors::with_a_step))
}

/// A fixed position of the sphere at the cube, and its contact points on the surface of the cube.
struct SeamPosition {
    words: &'static str,
    /// Centre (m).
    centre: [f64; 3],
    /// Vectors from each contact point to the centre (m).
    away: &'static [[f64; 3]],
}

const PLACES: [SeamPosition; 5] = [
    SeamPosition { words: "over the seam of a face", centre: [0.5, 0.5, 1.07], away: &[[0.0, 0.0, 0.07]] },
    SeamPosition { words: "over a face beside a ridge", centre: [0.97, 0.5, 1.07], away: &[[0.0, 0.0, 0.07]] },
    SeamPosition { words: "at a ridge", centre: [1.06, 0.4, 1.07], away: &[[0.06, 0.0, 0.07]] },
    SeamPosition { words: "at a corner", centre: [1.05, 1.04, 1.07], away: &[[0.05, 0.04, 0.07]] },
    SeamPosition {
        words: "within a corner",
        centre: [0.91, 0.92, 0.93],
        away: &[[-0.09, 0.0, 0.0], [0.0, -0.08, 0.0], [0.0, 0.0, -0.07]],
    },
];

fn held(at: &'static SeamPosition) -> Claim {
    let place = |scene: &mut Scene| scene.grains[0].position = at.centre.into();
    claim(format!("force {}, off from the exact vector", at.words), "N")
        .run(Run::new("cube", "dem", STEP).adjusted(at.words, place))
        .holds("k (R − d) from every contact point (derivation)", |done| {
            let (scene, done) = (&done[0].scene, &done[0]);
            let grain = &scene.grains[0];
            let stiffness = scene
                .law(grain.material, scene.walls[0].material)
                .map_or(f64::NAN, |law| law.springs.stiffness(0.0, 1.0).0);
            let exact: Vector3<f64> = at
                .away
                .iter()
                .map(|away| {
                    let away = Vector3::from(*away);
                    away.normalize() * (stiffness * (grain.radius - away.norm()))
                })
                .sum();
            let force =
                Vector3::new(done.last("held.force_x")?, done.last("held.force_y")?, done.last("held.force_z")?);
            Ok(Measurement::new((force - exact).norm(), 0.0, exact.norm()))
        })
        .within(computed(
            1e-13,
            "rounding of positions near 1 m, 2e-16 in each of three directions, relative to an overlap of 5 mm",
        ))
        .refuses(Control::scene("a plane for the cube, sphere 1e-9 m higher", move |scene| {
            scene.walls[0].shape = WallShape::Plane { point: Vector3::z(), normal: Vector3::z() };
            // On the upper face, the plane gives the right force, so the control also raises the sphere.
            scene.grains[0].position.z += 1e-9;
        }))
}

fn liggghts(floor: &'static str) -> Claim {
    let runs = ["dem:liggghts", "liggghts"].map(|solver| Run::new(floor, solver, STEP));
    let control = Control::our_contact_law("tangential stiffness × 1.001 in ours", |law| law.scale_tangential(1.001));
    let allowed = same_cycle("in units of R");
    row(&format!("position over {floor}, worst"), "m", allowed, runs, control, |done| {
        worst(done, &AXES, done[0].scene.grains[0].radius)
    })
}
