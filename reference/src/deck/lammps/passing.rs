//! What is there for a while, and what is pressed: grains that leave, walls that are taken away, pistons.
//!
//! A grain that leaves is deleted by `fix evaporate` in the region outside the box of `removal`, at the same steps. A wall
//! that is taken away goes so far behind itself that nothing meets it. A piston is a plane that follows an atom, which meets no
//! grain and is as heavy as the piston; on it act the force that presses, that of the grains on the plane, and a drag. With
//! velocities half a step before the forces, v' = (v (1 − c Δt/2) + (F − F_n)/M Δt)/(1 + c Δt/2) is a force of
//! (F − F_n − M c v)/(1 + c Δt/2).

use grainbench_scene::scene::{Piston, Scene, Wall, WallShape};
use nalgebra::Vector3;

use crate::deck::Stepping;
use crate::deck::data::box_of;
use crate::deck::outline::{AXES, is_flat};
use crate::deck::schedule::gone_at;

/// Refuses what LAMMPS does not do as the scene says it.
pub(super) fn refuse(scene: &Scene) -> Result<(), String> {
    if !scene.stays.entries.is_empty() {
        return Err(
            "its grains are poured at places and times of their own: LAMMPS (`fix pour`, `fix deposit`) draws \
                    both itself, and takes a grain of a given place between two runs only; begin with the \
                    deposit (`simulate --state`)"
                .to_owned(),
        );
    }
    if scene.springs.is_some() {
        return Err("its contacts remember something at the start, and a data file of LAMMPS holds no springs (`springs = false` \
                    beside the state leaves that out)"
            .to_owned());
    }
    Ok(())
}

/// Walls that are pressed, each with its number from 1 and what presses it.
pub(super) fn pistons(scene: &Scene) -> impl Iterator<Item = (usize, &Wall, Piston)> {
    (1..).zip(&scene.walls).filter_map(|(number, wall)| Some((number, wall, wall.piston?)))
}

/// The group of the grains of the scene: atoms that pistons follow are none.
pub(super) fn grains(scene: &Scene) -> &'static str {
    if pistons(scene).next().is_some() { "grains" } else { "all" }
}

/// Types of atoms beside those of the materials.
pub(super) fn more_types(scene: &Scene) -> usize {
    usize::from(pistons(scene).next().is_some())
}

/// The atom that a piston follows, by its id; they are counted after the grains.
fn atom(scene: &Scene, number: usize) -> usize {
    let before = pistons(scene).filter(|(other, ..)| *other <= number).count();
    scene.grains.len() + before
}

/// Where the atoms start (m), and the axis that they go along: one without a period.
fn start(scene: &Scene) -> Result<(Vector3<f64>, usize), String> {
    let (low, high) = box_of(scene);
    let periodic = scene.domain.map_or([false; 3], |domain| domain.periodic);
    let axis = (0..scene.dimension.count()).find(|&axis| !periodic[axis]);
    let axis =
        axis.ok_or("a piston in a box that is periodic along every axis, which has no plane to press".to_owned())?;
    // Near zero a small way is told with the most digits.
    let start = low.zip_map(&high, |low, high| 0.0_f64.clamp(low, high));
    Ok((start, axis))
}

/// The lines that make the atoms that pistons follow.
pub(super) fn atoms(scene: &Scene) -> Result<Vec<String>, String> {
    let grains = scene.grains.len();
    if pistons(scene).next().is_none() {
        return Ok(Vec::new());
    }
    let (place, _) = start(scene)?;
    let kind = scene.materials.len() + 1;
    let mut lines = vec![format!("group grains id 1:{grains}")];
    for (number, _, piston) in pistons(scene) {
        let id = atom(scene, number);
        lines.push(format!("create_atoms {kind} single {:?} {:?} {:?} units box", place.x, place.y, place.z));
        let smallest = scene.grains.iter().map(|grain| grain.radius).fold(f64::INFINITY, f64::min);
        lines.push(format!("set atom {id} diameter {smallest:?}"));
        lines.push(format!("set atom {id} mass {:?}", piston.mass));
    }
    lines.push("group pistons subtract all grains".to_owned());
    lines.extend((1..=kind).map(|other| format!("neigh_modify exclude type {other} {kind}")));
    Ok(lines)
}

/// The lines that press the pistons, after those of the walls.
pub(super) fn press(scene: &Scene, stepping: &Stepping) -> Result<Vec<String>, String> {
    let mut lines = Vec::new();
    for (number, wall, piston) in pistons(scene) {
        let WallShape::Plane { normal, .. } = wall.shape else { continue };
        let (_, axis) = start(scene)?;
        let (id, fix) = (atom(scene, number), format!("f_wall{number}"));
        let along = AXES[axis];
        lines.push(format!("group piston{number} id {id}"));
        lines.push(format!("compute press{number} grains reduce sum {fix}[2] {fix}[3] {fix}[4]"));
        // Theirs is the force on the grains.
        let on_grains: Vec<String> = (0..3)
            .filter(|&at| normal[at] != 0.0)
            .map(|at| format!("({:?})*c_press{number}[{}]", normal[at], at + 1))
            .collect();
        let net = format!("{:?}-({})", piston.force, on_grains.join("+"));
        let force = if piston.damping == 0.0 {
            net
        } else {
            let (drag, share) = (piston.mass * piston.damping, 1.0 + 0.5 * piston.damping * stepping.time_step);
            format!("({net}-({drag:?})*v{along}[{id}])/{share:?}")
        };
        lines.push(format!("variable press{number} equal {force}"));
        let forces = ["x", "y", "z"].map(|at| if at == along { format!("v_press{number}") } else { "0.0".to_owned() });
        lines.push(format!("fix press{number} piston{number} addforce {}", forces.join(" ")));
    }
    if !lines.is_empty() {
        lines.push("fix pressed pistons nve".to_owned());
    }
    Ok(lines)
}

/// How far a piston has gone along its normal, as a formula; none of a wall that is none.
pub(super) fn advance(scene: &Scene, number: usize) -> Option<String> {
    pistons(scene).find(|(other, ..)| *other == number)?;
    let (place, axis) = start(scene).ok()?;
    Some(format!("({}[{}]-({:?}))", AXES[axis], atom(scene, number), place[axis]))
}

/// What moves a wall along each axis beside its prescribed motion, as formulas: the way of a piston along its normal, and far
/// behind itself when it is taken away.
pub(super) fn ways(scene: &Scene, wall: &Wall, number: usize, stepping: &Stepping) -> [String; 3] {
    let mut ways = [const { String::new() }; 3];
    let mut add = |axis: usize, term: String| {
        let way: &mut String = &mut ways[axis];
        *way = if way.is_empty() { term } else { format!("{way}+{term}") };
    };
    if let (Some(gone), WallShape::Plane { normal, .. }) = (advance(scene, number), &wall.shape) {
        (0..3).filter(|&axis| normal[axis] != 0.0).for_each(|axis| add(axis, format!("({:?})*{gone}", normal[axis])));
    }
    if let Some(until) = wall.until {
        let step = gone_at(until, stepping);
        let (low, high) = box_of(scene);
        let far = 1e3 * (high - low).norm();
        let away = match wall.shape {
            WallShape::Plane { normal, .. } => -normal * far,
            _ if is_flat(scene) => Vector3::x() * far,
            _ => Vector3::z() * far,
        };
        (0..3)
            .filter(|&axis| away[axis] != 0.0)
            .for_each(|axis| add(axis, format!("({:?})*(step>={step})", away[axis])));
    }
    ways
}

/// The lines that take grains out.
pub(super) fn removal(scene: &Scene) -> Vec<String> {
    let Some(removal) = scene.stays.removal else { return Vec::new() };
    let (low, high) = (removal.low, removal.high);
    let side = |axis: usize| {
        if axis == 2 && is_flat(scene) { "INF INF".to_owned() } else { format!("{:?} {:?}", low[axis], high[axis]) }
    };
    let sides = [0, 1, 2].map(side).join(" ");
    vec![
        format!("region beyond block {sides} side out units box"),
        format!("fix leave {} evaporate {} {} beyond 1", grains(scene), removal.every, scene.grains.len()),
    ]
}
