//! Removal of grains, temporary walls, and pistons.
//!
//! `fix evaporate` deletes grains outside the box of `removal` at the same steps as our solvers. To remove a wall, the
//! deck moves it so far away that it has no more contacts.
//!
//! A piston is a plane that follows an atom without contacts. The atom has the mass M of the piston. The forces on it
//! are the applied force F, the force −F_n of the grains, and a drag −M c v. LAMMPS computes forces with the velocity v of
//! half a step before. With the time step Δt, the velocity of the piston after a step is
//! v' = (v (1 − c Δt/2) + (F − F_n)/M Δt)/(1 + c Δt/2).
//! LAMMPS obtains this velocity with the force (F − F_n − M c v)/(1 + c Δt/2).

use grainbench_scene::scene::{Piston, Scene, Wall, WallShape};
use nalgebra::Vector3;

use crate::deck::Stepping;
use crate::deck::data::box_of;
use crate::deck::outline::{AXES, is_flat};
use crate::deck::schedule::gone_at;

/// Returns an error if the scene has inserted grains or initial springs, which LAMMPS cannot reproduce.
pub(super) fn refuse(scene: &Scene) -> Result<(), String> {
    if !scene.stays.entries.is_empty() {
        return Err(
            "its grains are poured at given places and times, but LAMMPS (`fix pour`, `fix deposit`) chooses both at \
                    random and can insert a grain at a given place only between two runs; start from the deposited \
                    grains (`simulate --state`)"
                .to_owned(),
        );
    }
    if scene.springs.is_some() {
        return Err(
            "its contacts have springs at the start, but a data file of LAMMPS contains no springs (`springs = \
                    false` next to the state omits them)"
                .to_owned(),
        );
    }
    Ok(())
}

/// Returns the walls that are pistons, with their numbers from 1.
pub(super) fn pistons(scene: &Scene) -> impl Iterator<Item = (usize, &Wall, Piston)> {
    (1..).zip(&scene.walls).filter_map(|(number, wall)| Some((number, wall, wall.piston?)))
}

/// Returns the group of the scene's grains. It excludes the atoms that pistons follow.
pub(super) fn grains(scene: &Scene) -> &'static str {
    if pistons(scene).next().is_some() { "grains" } else { "all" }
}

/// Returns the number of atom types in addition to those of the materials.
pub(super) fn more_types(scene: &Scene) -> usize {
    usize::from(pistons(scene).next().is_some())
}

/// Returns the id of the atom that a piston follows. These ids follow those of the grains.
fn atom(scene: &Scene, number: usize) -> usize {
    let before = pistons(scene).filter(|(other, ..)| *other <= number).count();
    scene.grains.len() + before
}

/// Returns the initial position (m) of the atoms that pistons follow, and the axis along which they move: the first
/// axis that is not periodic.
fn start(scene: &Scene) -> Result<(Vector3<f64>, usize), String> {
    let (low, high) = box_of(scene);
    let periodic = scene.domain.map_or([false; 3], |domain| domain.periodic);
    let axis = (0..scene.dimension.count()).find(|&axis| !periodic[axis]);
    let axis = axis.ok_or(
        "it has a piston in a box that is periodic along all axes, so the piston has no direction to move \
                    in"
        .to_owned(),
    )?;
    // Near zero, a small displacement is printed with the most digits. LAMMPS creates no atom on the upper side of the box.
    let start = low.zip_map(&high, |low, high| if low <= 0.0 && 0.0 < high { 0.0 } else { 0.5 * (low + high) });
    Ok((start, axis))
}

/// Returns the commands that create the atoms of the pistons.
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

/// Returns the commands for the forces on the pistons. They must follow the commands of the walls.
pub(super) fn press(scene: &Scene, stepping: &Stepping) -> Result<Vec<String>, String> {
    let mut lines = Vec::new();
    for (number, wall, piston) in pistons(scene) {
        let WallShape::Plane { normal, .. } = wall.shape else { continue };
        let (_, axis) = start(scene)?;
        let (id, fix) = (atom(scene, number), format!("f_wall{number}"));
        let along = AXES[axis];
        lines.push(format!("group piston{number} id {id}"));
        lines.push(format!("compute press{number} grains reduce sum {fix}[2] {fix}[3] {fix}[4]"));
        // LAMMPS sums the force on the grains, which is opposite to that on the piston.
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

/// Returns the displacement of a piston along its normal (m) as a LAMMPS formula, or `None` if the wall is not a
/// piston.
pub(super) fn advance(scene: &Scene, number: usize) -> Option<String> {
    pistons(scene).find(|(other, ..)| *other == number)?;
    let (place, axis) = start(scene).ok()?;
    Some(format!("({}[{}]-({:?}))", AXES[axis], atom(scene, number), place[axis]))
}

/// Returns formulas for the displacement of a wall along each axis (m) in addition to its prescribed motion. They
/// contain the displacement of a piston along its normal, and the large displacement by which a wall is removed.
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

/// Returns the commands that remove grains.
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
