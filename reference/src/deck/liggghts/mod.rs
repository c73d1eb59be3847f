//! Decks for LIGGGHTS. Contacts between grains and at walls use `hooke/stiffness tangential history` and related
//! models.
//!
//! Two-dimensional scenes of discs are run in two dimensions if every wall is a plane normal to an axis. Other walls
//! need meshes, which LIGGGHTS supports only in three dimensions. With meshes, and for scenes of spheres, the grains
//! are one layer of spheres in three dimensions.

mod contact;
mod mesh;
mod moduli;
mod passing;

use std::fmt::Write as _;

use grainbench_scene::effects::Effects;
use grainbench_scene::motion::Motion;
use grainbench_scene::scene::{Scene, Wall, WallShape};
use nalgebra::{Unit, Vector3};

use crate::deck::data::{GROWING, boundary, box_of, data_file, of_disc, of_sphere, skin};
use crate::deck::driven::driven;
use crate::deck::logged::{Sums, logged};
use crate::deck::outline::{AXES, AxisPlane, has_discs, is_flat, one_inertia};
use crate::deck::peer::{DeckFiles, Peer};
use crate::deck::schedule::{Rates, changes, rates_from};
use crate::deck::script::{
    COLUMNS, CONTACTS, END, END_CONTACTS, SAMPLES, asks_for_contacts_at, asks_for_force, asks_for_pairs, asks_for_wall,
    heading, thermo,
};
use crate::deck::stepping::Stepping;
use crate::names::Names;
use contact::{Model, type_of_wall};
use mesh::{Triangle, stl, triangles};

/// Wall that needs a mesh.
struct Mesh<'s> {
    number: usize,
    wall: &'s Wall,
    triangles: Vec<Triangle>,
}

/// LIGGGHTS, `model hooke/stiffness tangential history` and related models.
pub(crate) struct Liggghts;

impl Peer for Liggghts {
    fn name(&self) -> &'static str {
        "liggghts"
    }

    fn title(&self) -> &'static str {
        "LIGGGHTS"
    }

    fn executable(&self) -> &'static str {
        "liggghts"
    }

    fn write(&self, scene: &Scene, stepping: &Stepping) -> Result<DeckFiles, String> {
        files(scene, stepping)
    }
}

fn files(scene: &Scene, stepping: &Stepping) -> Result<DeckFiles, String> {
    passing::refuse(scene)?;
    if let Some(what) = scene.round_wall() {
        return Err(format!("{what}, but LIGGGHTS has only infinite cylinders and meshes of flat triangles"));
    }
    if let Some(wall) = scene.walls.iter().find(|wall| !wall.motion.functions.is_empty()) {
        let reason = "which `move/mesh` supports only along its own path and from the first step on";
        return Err(format!("wall `{}` moves by a sine or a ramp, {reason}", wall.name));
    }
    let mut meshes = Vec::new();
    let (mut low, mut high) = box_of(scene);
    let (centre, reach) = (0.5 * (low + high), (high - low).norm() + way(scene, stepping));
    for (number, wall) in (1..).zip(&scene.walls) {
        if AxisPlane::from_wall(wall).is_none() {
            // A rotating plane may come into contact with grains at a point that is far away from the grains at the
            // start.
            let aside = if turns(&wall.motion) { 2.0 * (wall.motion.centre - centre).norm() } else { 0.0 };
            // All grains are within half the diagonal of the box at the start.
            let reach = reach.max(reach - 0.5 * (high - low).norm() + slide(scene, wall, stepping));
            meshes.push(Mesh { number, wall, triangles: triangles(&wall.shape, centre, reach + aside) });
        }
    }
    let flat = is_flat(scene) && has_discs(scene) && meshes.is_empty();
    if flat {
        one_inertia(scene, 0.5)?;
    } else if Effects::from_scene(scene).friction || !is_flat(scene) {
        // Without friction, grains do not rotate, and spheres can replace discs.
        one_inertia(scene, 0.4).map_err(|reason| match (is_flat(scene), meshes.is_empty()) {
            (true, false) => format!("its walls need meshes, which work only in three dimensions: {reason}"),
            _ => reason,
        })?;
    }
    if is_flat(scene) && !flat {
        let depth = 0.5 * (high.xy() - low.xy()).min();
        (low.z, high.z) = (-depth, depth);
    }
    let corners = if meshes.is_empty() { (low, high) } else { around((low, high), &meshes, reach, stepping) };
    let corners = with_periods(scene, (low, high), corners, &meshes)?;
    let types = 2 * scene.materials.len();
    let data = data_file(scene, types, corners, if flat { of_disc } else { of_sphere });
    let force = |number: usize| forces_of_wall(number, &meshes);
    let (commands, logged) =
        logged(scene, &Sums { temperature: "thermo_temp", grains: "all", force: &force, advance: &|_| None })?;
    let printed = thermo(&commands, &logged, stepping);
    let names = names(scene, &meshes);
    let input = input(scene, stepping, flat, &meshes, &printed, &names)?;
    let mut files = vec![("in.liggghts".to_owned(), input), ("data.grains".to_owned(), data)];
    files.extend(meshes.iter().map(|mesh| (format!("wall-{}.stl", mesh.number), stl(&mesh.triangles))));
    Ok(DeckFiles { files, logged, names })
}

/// Returns the names of the columns with the forces that probes request. Walls that are meshes have no forces per
/// grain.
fn names(scene: &Scene, meshes: &[Mesh<'_>]) -> Names {
    let mut names = Vec::new();
    for (number, wall) in (1..).zip(&scene.walls).filter(|&(number, _)| asks_for_contacts_at(scene, number)) {
        if meshes.iter().any(|mesh| mesh.number == number) {
            continue;
        }
        for (axis, column) in AXES.into_iter().zip(1..) {
            names.push((format!("{}.force_{axis}", wall.name), format!("f_force_wall{number}[{column}]")));
        }
    }
    if asks_for_pairs(scene) {
        // Column 3 is a flag for pairs across a periodic boundary. The force follows it.
        names.extend([("id1".to_owned(), "c_pairs[1]".to_owned()), ("id2".to_owned(), "c_pairs[2]".to_owned())]);
        for (axis, column) in AXES.into_iter().zip(4..) {
            names.push((format!("force_{axis}"), format!("c_pairs[{column}]")));
        }
    }
    Names(names)
}

/// Returns the command that sums the forces of a wall on the grains, and the components of the sum. A mesh needs no
/// command. LIGGGHTS reports the force on the mesh, so its sign is reversed here. This force is zero at the start,
/// because LIGGGHTS has not summed it yet.
fn forces_of_wall(number: usize, meshes: &[Mesh<'_>]) -> (String, [String; 3]) {
    if meshes.iter().any(|mesh| mesh.number == number) {
        return (String::new(), [1, 2, 3].map(|at| format!("(-f_mesh{number}[{at}])")));
    }
    let fix = format!("f_force_wall{number}");
    let command = format!("compute wall{number} all reduce sum {fix}[1] {fix}[2] {fix}[3]\n");
    (command, [1, 2, 3].map(|at| format!("c_wall{number}[{at}]")))
}

/// Rounding error of a bound, as a fraction of the period.
const PRINTED: f64 = 1e-9;

/// Returns an upper bound on the displacement of a grain without contacts during the run (m). The meshes of planes must
/// extend at least so far.
fn way(scene: &Scene, stepping: &Stepping) -> f64 {
    let time = stepping.steps as f64 * stepping.time_step;
    let speed = scene.grains.iter().map(|grain| grain.velocity.norm()).fold(0.0, f64::max);
    time * (speed + 0.5 * scene.gravity.norm() * time)
}

/// Returns an upper bound on the displacement of a wall along its plane relative to grains that other walls move (m).
fn slide(scene: &Scene, wall: &Wall, stepping: &Stepping) -> f64 {
    let across = if let WallShape::Plane { normal, .. } = wall.shape { normal } else { Vector3::zeros() };
    let along = |other: &Wall| {
        let phases = other.motion.phases.iter().map(|phase| phase.velocity);
        phases.map(|velocity| (velocity - across * across.dot(&velocity)).norm()).sum::<f64>()
    };
    let fastest = scene.walls.iter().map(along).fold(0.0, f64::max);
    stepping.steps as f64 * stepping.time_step * (along(wall) + fastest)
}

/// Returns the corners of a box around the grains and all meshes during the whole run (m).
fn around(
    (low, high): (Vector3<f64>, Vector3<f64>),
    meshes: &[Mesh<'_>],
    reach: f64,
    stepping: &Stepping,
) -> (Vector3<f64>, Vector3<f64>) {
    let (mut least, mut most) = (low, high);
    let end = stepping.steps as f64 * stepping.time_step;
    for mesh in meshes {
        let motion = &mesh.wall.motion;
        // Between the times at which its velocity changes, the mesh moves along straight lines.
        let turns_back = motion.phases.iter().flat_map(|phase| [phase.start, phase.stop]);
        let times = turns_back.map(|moment| moment.seconds(stepping.time_step).min(end)).chain([0.0, end]);
        let moves: Vec<_> = times.map(|time| motion.displacement(time, stepping.time_step).translation).collect();
        for corner in mesh.triangles.iter().flatten() {
            // A rotation does not change the distance to the centre.
            let (centre, room) =
                if turns(motion) { (motion.centre, (corner - motion.centre).norm()) } else { (*corner, 0.0) };
            for place in moves.iter().map(|moved| centre + moved) {
                (least, most) = (least.inf(&place.add_scalar(-room)), most.sup(&place.add_scalar(room)));
            }
        }
    }
    let margin = Vector3::repeat(0.1 * reach);
    (least - margin, most + margin)
}

/// Returns corners with the bounds of the scene along its periodic axes. Room for meshes there would change the period.
fn with_periods(
    scene: &Scene,
    (low, high): (Vector3<f64>, Vector3<f64>),
    (mut least, mut most): (Vector3<f64>, Vector3<f64>),
    meshes: &[Mesh<'_>],
) -> Result<(Vector3<f64>, Vector3<f64>), String> {
    let periodic = scene.domain.map_or([false; 3], |domain| domain.periodic);
    for axis in (0..3).filter(|&axis| periodic[axis]) {
        (least[axis], most[axis]) = (low[axis], high[axis]);
        let room = PRINTED * (high[axis] - low[axis]);
        let is_beyond = |corner: &Vector3<f64>| corner[axis] < low[axis] - room || corner[axis] > high[axis] + room;
        if let Some(mesh) = meshes.iter().find(|mesh| mesh.triangles.iter().flatten().any(is_beyond)) {
            return Err(format!(
                "wall `{}` extends beyond the periodic bounds along {}, {} m to {} m, where LIGGGHTS deletes its triangles",
                mesh.wall.name,
                ['x', 'y', 'z'][axis],
                low[axis],
                high[axis]
            ));
        }
    }
    Ok((least, most))
}

/// Returns true if the motion has a rotation in any phase.
fn turns(motion: &Motion) -> bool {
    motion.phases.iter().any(|phase| phase.spin != Vector3::zeros())
}

fn input(
    scene: &Scene,
    stepping: &Stepping,
    flat: bool,
    meshes: &[Mesh<'_>],
    printed: &str,
    names: &Names,
) -> Result<String, String> {
    let mut text = format!("# {}\n", heading(scene));
    let mut say = |line: &str| {
        text.push_str(line);
        text.push('\n');
    };
    say("units si\natom_style granular\natom_modify map array");
    if flat {
        say("dimension 2");
    }
    // Meshes must lie within the box, so a box with meshes has fixed sides.
    let open = if meshes.is_empty() { GROWING } else { "f" };
    let mut boundary = boundary(scene, open);
    if is_flat(scene) && !flat {
        // A layer of spheres in three dimensions has free space above and below.
        boundary.truncate(boundary.len() - 1);
        boundary.push_str(open);
    }
    say(&boundary);
    say("newton off\ncommunicate single vel yes");
    let model = Model::from_scene(scene);
    let (words, switches) = (model.words(), model.switches());
    if let Some(line) = model.preparation() {
        say(line);
    }
    say("read_data data.grains");
    say(&format!("neighbor {:?} bin\nneigh_modify every 1 delay 0 check yes", skin(scene)));
    say(&model.properties(scene)?);
    say(&format!("pair_style gran model {words}{switches}\npair_coeff * *"));
    say(&format!("timestep {:?}", stepping.time_step));
    let strength = scene.gravity.norm();
    if strength > 0.0 {
        let g = scene.gravity;
        say(&format!("fix gravity all gravity {strength:?} vector {:?} {:?} {:?}", g.x, g.y, g.z));
    }
    for (number, wall) in (1..).zip(&scene.walls) {
        let kind = type_of_wall(scene, wall.material);
        if let Some(plane) = AxisPlane::from_wall(wall) {
            let axis = AXES[plane.axis];
            let shear =
                plane.shear.map(|(along, speed)| format!(" shear {} {speed:?}", AXES[along])).unwrap_or_default();
            say(&format!(
                "fix wall{number} all wall/gran model {words} primitive type {kind} {axis}plane {:?}{shear}{}{switches}",
                plane.at,
                if asks_for_wall(scene, number) { " store_force yes" } else { "" }
            ));
        } else {
            let style = if asks_for_force(scene, number) { "mesh/surface/stress" } else { "mesh/surface" };
            say(&format!("fix mesh{number} all {style} file wall-{number}.stl type {kind}"));
        }
    }
    if !meshes.is_empty() {
        let names: Vec<String> = meshes.iter().map(|mesh| format!("mesh{}", mesh.number)).collect();
        say(&format!(
            "fix walls all wall/gran model {words} mesh n_meshes {} meshes {}{switches}",
            names.len(),
            names.join(" ")
        ));
    }
    let (lines, free) = driven(scene, "all");
    lines.iter().for_each(|line| say(line));
    say(&format!("fix motion {free} nve/sphere"));
    if flat {
        say("fix plane all enforce2d");
    }
    say(printed);
    // LIGGGHTS needs one format for the whole line.
    let of_walls = names.0.iter().map(|(_, column)| column.as_str()).filter(|column| column.starts_with("f_"));
    let columns: Vec<&str> = COLUMNS.into_iter().chain(of_walls).collect();
    let of_pairs: Vec<&str> =
        names.0.iter().map(|(_, column)| column.as_str()).filter(|it| it.starts_with("c_")).collect();
    let dump = |name: &str, interval: u64, [file, contacts]: [&str; 2]| {
        let format = format!("%d %d{}", " %.17g".repeat(columns.len() - 2));
        let columns = columns.join(" ");
        let grains = format!(
            "dump {name} all custom {interval} {file} {columns}\ndump_modify {name} format \"{format}\" sort id"
        );
        if of_pairs.is_empty() {
            return grains;
        }
        let (columns, format) = (of_pairs.join(" "), ["%.17g"].repeat(of_pairs.len()).join(" "));
        format!(
            "{grains}\ndump {name}2 all local {interval} {contacts} {columns}\ndump_modify {name}2 format \"{format}\""
        )
    };
    if !of_pairs.is_empty() {
        say("compute pairs all pair/gran/local id force");
    }
    say(&dump("samples", stepping.interval, [SAMPLES, CONTACTS]));
    say(&runs(scene, stepping, meshes)?);
    if !stepping.ends_on_a_sample() {
        let no_more = if of_pairs.is_empty() { "" } else { "\nundump samples2" };
        say(&format!("undump samples{no_more}\n{}\nrun 0", dump("end", 1, [END, END_CONTACTS])));
    }
    Ok(text)
}

/// Returns the `run` commands. A new run begins whenever a mesh changes its velocity or spin, or a wall is removed.
fn runs(scene: &Scene, stepping: &Stepping, meshes: &[Mesh<'_>]) -> Result<String, String> {
    let gone = passing::gone(scene, stepping);
    let mut changes = changes(meshes.iter().map(|mesh| &mesh.wall.motion), stepping)?;
    changes.extend(gone.iter().map(|&(_, step)| step).filter(|&step| step < stepping.steps));
    changes.sort_unstable();
    changes.dedup();
    let mut text = String::new();
    let mut now = vec![Rates::default(); meshes.len()];
    for stretch in changes.windows(2) {
        for (number, _) in gone.iter().filter(|&&(_, step)| step == stretch[0]) {
            let _ = writeln!(text, "unfix wall{number}");
        }
        for (mesh, now) in meshes.iter().zip(&mut now) {
            let motion = &mesh.wall.motion;
            let (number, rates) = (mesh.number, rates_from(motion, stretch[0], stepping)?);
            if rates == *now {
                continue;
            }
            if *now != Rates::default() {
                let _ = writeln!(text, "unfix move{number}");
            }
            let how = match (rates.velocity != Vector3::zeros(), Unit::try_new(rates.spin, 0.0)) {
                (false, None) => None,
                (true, None) => {
                    let [x, y, z] = rates.velocity.into();
                    Some(format!("linear {x:?} {y:?} {z:?}"))
                }
                (false, Some(axis)) => {
                    let time = stretch[0] as f64 * stepping.time_step;
                    let [x, y, z] = (motion.centre + motion.displacement(time, stepping.time_step).translation).into();
                    let period = std::f64::consts::TAU / rates.spin.norm();
                    Some(format!(
                        "rotate origin {x:?} {y:?} {z:?} axis {:?} {:?} {:?} period {period:?}",
                        axis.x, axis.y, axis.z
                    ))
                }
                (true, Some(_)) => {
                    let name = &mesh.wall.name;
                    return Err(format!(
                        "`{name}` moves and rotates at the same time, but `move/mesh rotate` rotates about a fixed \
                         point"
                    ));
                }
            };
            if let Some(how) = how {
                let _ = writeln!(text, "fix move{number} all move/mesh mesh mesh{number} {how}");
            }
            *now = rates;
        }
        let _ = writeln!(text, "run {}", stretch[1] - stretch[0]);
    }
    Ok(text.trim_end().to_owned())
}
