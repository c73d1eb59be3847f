//! Extreme contacts: deep overlaps, high speeds, corners and coincident grains.

use super::{HardCase, case, end, kinetic, kinetic_at_start, near};
use crate::stability::failure::Failure;
use grainbench_scene::error::SceneError;
use grainbench_scene::scene::Scene;
use grainbench_solver::record::Record;

pub(super) fn cases() -> Result<Vec<HardCase>, SceneError> {
    let mut one_centre = case(
        "exactly-coincident-grains",
        "two discs with the same centre separate, or the run ends with an error; all values are finite and no \
         energy is gained",
        COINCIDENT,
        coincident,
    )?;
    // The scene reader would reject grains with the same centre.
    one_centre.scene.grains[1].position = one_centre.scene.grains[0].position;
    Ok(vec![
        case(
            "initial-overlap-50-percent",
            "two discs that overlap by R/2 at the start separate with at most the energy of their spring",
            OVERLAPPED,
            released,
        )?,
        case(
            "impact-crosses-a-grain-in-a-step",
            "a disc that moves more than its diameter in a default step does not pass through a wall and gains no \
             energy",
            BULLET,
            stopped,
        )?,
        case(
            "edge-along-cell-border",
            "a disc that slides without friction, with its edge along the border of cells, keeps its velocity within 1 \
             % and stays on the plane",
            EDGE,
            slides,
        )?,
        case(
            "compression-to-30-percent",
            "a disc compressed between two planes to 30 % of its height stays whole and between the planes, with its \
             centre in the middle",
            SQUEEZED,
            squeezed,
        )?,
        case(
            "corner-of-two-walls",
            "a disc that bounces in a corner of 90° stays in it and gains no energy",
            &corner([1.0, 0.0]),
            in_the_corner,
        )?,
        case(
            "corner-of-30-degrees",
            "a disc that is driven into a wedge of 30° stays in it and gains no energy",
            &corner([0.5, -0.866_025_403_784_438_6]),
            in_the_corner,
        )?,
        one_centre,
    ])
}

const OVERLAPPED: &str = "title = 'Deep overlap'\ndimension = 2\nduration = 0.2\nlargest_initial_overlap = 0.6\n\
    materials.m = { density = 1000.0, young_modulus = 1.0e7, poisson_ratio = 0.3 }\n\
    [contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1.0e7\n\
    [grains.a]\nmaterial = 'm'\nradius = 0.5\nposition = [-0.375, 0.0]\n\
    [grains.b]\nmaterial = 'm'\nradius = 0.5\nposition = [0.375, 0.0]\n\
    [output]\nevery = 0.2\n[probes]\nall = { system = true }\n";

fn released(scene: &Scene, record: &Record) -> Result<(), Failure> {
    let grains = end(record);
    let held = 0.5 * 1e7 * 0.25_f64.powi(2);
    let kinetic = kinetic(grains, scene);
    if kinetic > 1.01 * held {
        return Err(Failure::Growth(kinetic / held));
    }
    if grains[1].position.x - grains[0].position.x < 0.999 {
        return Err(Failure::Freeze("they still overlap".to_owned()));
    }
    near("height", grains[0].position.y.abs().max(grains[1].position.y.abs()), 0.0, 1e-6)
}

/// The critical time step is 2√(m/k) = 2√(785/1e7) s = 0.0177 s. In a tenth of this time the disc moves by 1.8 m.
const BULLET: &str = "title = 'Too fast'\ndimension = 2\nduration = 0.05\n\
    materials.m = { density = 1000.0, young_modulus = 1.0e10, poisson_ratio = 0.3 }\n\
    [contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1.0e7\n\
    [grains.a]\nmaterial = 'm'\nradius = 0.5\nposition = [-6.0, 0.0]\nvelocity = [1000.0, 0.0]\n\
    [walls.target]\nmaterial = 'm'\nplane = { point = [0.0, 0.0], normal = [-1.0, 0.0] }\n\
    [output]\nevery = 0.05\n[probes]\na = { grain = 'a' }\n";

fn stopped(scene: &Scene, record: &Record) -> Result<(), Failure> {
    let grains = end(record);
    if grains[0].position.x > 0.0 {
        return Err(Failure::Tunnelling(format!("it is {:.3} m behind the wall", grains[0].position.x)));
    }
    let (before, after) = (kinetic_at_start(scene), kinetic(grains, scene));
    if after > 1.01 * before { Err(Failure::Growth(after / before)) } else { Ok(()) }
}

/// With eight cells per radius, the lowest point of the disc is on a cell boundary.
const EDGE: &str = "title = 'Along a border'\ndimension = 2\ngravity = [0.0, -1.0]\nduration = 1.0\n\
    materials.m = { density = 1000.0, young_modulus = 1.0e6, poisson_ratio = 0.3 }\n\
    [contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1.0e6\n\
    [grains.a]\nmaterial = 'm'\nradius = 0.5\nposition = [0.0, 0.5]\nvelocity = [1.0, 0.0]\n\
    [walls.floor]\nmaterial = 'm'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n\
    [output]\nevery = 1.0\n[probes]\na = { grain = 'a' }\n";

fn slides(_scene: &Scene, record: &Record) -> Result<(), Failure> {
    let grains = end(record);
    near("velocity along", grains[0].velocity.x, 1.0, 0.01)?;
    near("height", grains[0].position.y, 0.5, 0.01)
}

const SQUEEZED: &str = "title = 'Squeezed'\ndimension = 2\nduration = 0.7\n\
    materials.m = { density = 1000.0, young_modulus = 1.0e6, poisson_ratio = 0.3 }\n\
    [contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1.0e6\n\
    [grains.a]\nmaterial = 'm'\nradius = 0.5\nposition = [0.0, 0.0]\n\
    [walls.low]\nmaterial = 'm'\nplane = { point = [0.0, -0.5], normal = [0.0, 1.0] }\nmotion = [{ velocity = [0.0, 0.5] }]\n\
    [walls.high]\nmaterial = 'm'\nplane = { point = [0.0, 0.5], normal = [0.0, -1.0] }\nmotion = [{ velocity = [0.0, -0.5] }]\n\
    [output]\nevery = 0.7\n[probes]\na = { grain = 'a' }\n";

fn squeezed(_scene: &Scene, record: &Record) -> Result<(), Failure> {
    let grains = end(record);
    near("height of the centre", grains[0].position.y, 0.0, 0.02)?;
    near("velocity of the centre", grains[0].velocity.norm(), 0.0, 0.5)?;
    let points = record.snapshots.last().map_or(&[][..], |snapshot| &snapshot.points);
    if let Some(point) = points.iter().find(|point| point.position.y.abs() > 0.2) {
        let y = point.position.y;
        return Err(Failure::Tunnelling(format!("a material point is {y:.3} m off the middle, behind a plane")));
    }
    match points.iter().find(|point| point.volume.is_nan() || point.volume <= 0.0) {
        Some(_) => Err(Failure::CellCollapsed),
        None => Ok(()),
    }
}

/// Returns a scene with a floor and a second wall of the given normal. Gravity drives the disc into the corner.
fn corner(normal: [f64; 2]) -> String {
    format!(
        "title = 'A corner'\ndimension = 2\ngravity = [-7.0, -7.0]\nduration = 2.0\n\
         materials.m = {{ density = 1000.0, young_modulus = 1.0e7, poisson_ratio = 0.3 }}\n\
         [contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1.0e7\n\
         [grains.a]\nmaterial = 'm'\nradius = 0.2\nposition = [1.2, 0.25]\nvelocity = [-1.0, 0.0]\n\
         [walls.floor]\nmaterial = 'm'\nplane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}\n\
         [walls.side]\nmaterial = 'm'\nplane = {{ point = [0.0, 0.0], normal = {normal:?} }}\n\
         [output]\nevery = 0.02\n[probes]\na = {{ grain = 'a' }}\nall = {{ system = true }}\n"
    )
}

fn in_the_corner(scene: &Scene, record: &Record) -> Result<(), Failure> {
    let grains = end(record);
    let energy = |velocity: f64, place: nalgebra::Vector3<f64>| 0.5 * velocity - scene.gravity.dot(&place);
    let start = energy(scene.grains[0].velocity.norm_squared(), scene.grains[0].position);
    let now = energy(grains[0].velocity.norm_squared(), grains[0].position);
    // The potential energy per mass is 7 (x + y) > 0 inside, with its minimum in the corner.
    if now > start + 0.02 * start.abs() {
        return Err(Failure::Growth(now / start));
    }
    for wall in &scene.walls {
        let grainbench_scene::scene::WallShape::Plane { point, normal } = wall.shape else { continue };
        let distance = (grains[0].position - point).dot(&normal);
        if distance.is_nan() || distance < 0.5 * grains[0].radius {
            return Err(Failure::Tunnelling(format!("it is {distance:.3} m from wall `{}`", wall.name)));
        }
    }
    Ok(())
}

const COINCIDENT: &str = "title = 'One centre'\ndimension = 2\nduration = 0.2\nlargest_initial_overlap = 2.0\n\
    materials.m = { density = 1000.0, young_modulus = 1.0e6, poisson_ratio = 0.3 }\n\
    [contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1.0e6\n\
    [grains.a]\nmaterial = 'm'\nradius = 0.5\nposition = [0.0, 0.0]\n\
    [grains.b]\nmaterial = 'm'\nradius = 0.5\nposition = [0.9, 0.0]\n\
    [output]\nevery = 0.2\n[probes]\nall = { system = true }\n";

fn coincident(scene: &Scene, record: &Record) -> Result<(), Failure> {
    let grains = end(record);
    let held = 0.5 * 1e6;
    let kinetic = kinetic(grains, scene);
    if kinetic > 1.01 * held {
        return Err(Failure::Growth(kinetic / held));
    }
    if (grains[1].position - grains[0].position).norm() < 0.99 {
        return Err(Failure::Freeze("they do not part".to_owned()));
    }
    Ok(())
}
