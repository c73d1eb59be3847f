//! LIGGGHTS: `hooke/stiffness tangential history` between grains and at walls.
//!
//! Scenes in the plane are run in two dimensions where every wall is a primitive one. Meshes, which all other walls need,
//! work in three dimensions only: there the grains are one layer of spheres.

use std::fmt::Write as _;

use grainbench_scene::effects::Effects;
use grainbench_scene::scene::{ContactLaw, ProbeTarget, Scene, Wall};
use nalgebra::Vector3;

use super::dashpots::{Dashpots, Side};
use super::data::{GROWING, boundary, box_of, data_file, of_disc, of_sphere, skin};
use super::logged::logged;
use super::mesh::{Triangle, stl, triangles};
use super::outline::{AXES, AxisPlane, grain_materials, has_discs, is_flat, one_inertia, refuse_turning};
use super::schedule::{changes, velocity_from};
use super::{COLUMNS, END, SAMPLES, Stepping, Written, heading, thermo};

/// A wall that needs a mesh.
struct Mesh<'s> {
    number: usize,
    wall: &'s Wall,
    triangles: Vec<Triangle>,
}

pub(crate) fn files(scene: &Scene, stepping: &Stepping) -> Result<Written, String> {
    let mut meshes = Vec::new();
    let (mut low, mut high) = box_of(scene);
    let (centre, reach) = (0.5 * (low + high), (high - low).norm() + way(scene, stepping));
    for (number, wall) in (1..).zip(&scene.walls) {
        refuse_turning(wall)?;
        if AxisPlane::of(wall).is_none() {
            meshes.push(Mesh { number, wall, triangles: triangles(&wall.shape, centre, reach) });
        }
    }
    let flat = is_flat(scene) && has_discs(scene) && meshes.is_empty();
    if flat {
        one_inertia(scene, 0.5)?;
    } else if Effects::of(scene).friction || !is_flat(scene) {
        // Without friction nothing turns, and discs may be spheres.
        one_inertia(scene, 0.4).map_err(|reason| match (is_flat(scene), meshes.is_empty()) {
            (true, false) => format!("this needs meshes for walls, which work in three dimensions only: {reason}"),
            _ => reason,
        })?;
    }
    if is_flat(scene) && !flat {
        let depth = 0.5 * (high.xy() - low.xy()).min();
        (low.z, high.z) = (-depth, depth);
    }
    let corners = if meshes.is_empty() { (low, high) } else { around((low, high), &meshes, reach, stepping) };
    let types = 2 * scene.materials.len();
    let data = data_file(scene, types, corners, if flat { of_disc } else { of_sphere });
    let (commands, logged) = logged(scene, "thermo_temp", |number| forces_of_wall(number, &meshes))?;
    let printed = thermo(&commands, &logged, stepping);
    let input = input(scene, stepping, flat, &meshes, &printed)?;
    let mut files = vec![("in.liggghts".to_owned(), input), ("data.grains".to_owned(), data)];
    files.extend(meshes.iter().map(|mesh| (format!("wall-{}.stl", mesh.number), stl(&mesh.triangles))));
    Ok((files, logged))
}

/// The command that adds up the forces of a wall on the grains, and the components of the sum. A mesh does so by itself,
/// and its force is that of the grains.
fn forces_of_wall(number: usize, meshes: &[Mesh<'_>]) -> (String, [String; 3]) {
    if meshes.iter().any(|mesh| mesh.number == number) {
        return (String::new(), [1, 2, 3].map(|at| format!("(-f_mesh{number}[{at}])")));
    }
    let fix = format!("f_force_wall{number}");
    let command = format!("compute wall{number} all reduce sum {fix}[1] {fix}[2] {fix}[3]\n");
    (command, [1, 2, 3].map(|at| format!("c_wall{number}[{at}]")))
}

/// Whether a probe asks for the force on a wall.
fn is_asked(scene: &Scene, number: usize) -> bool {
    scene.probes.iter().any(|probe| probe.target == ProbeTarget::Wall(number - 1))
}

/// How far a grain may go that meets nothing (m), so that it stays above planes that are meshes.
fn way(scene: &Scene, stepping: &Stepping) -> f64 {
    let time = stepping.steps as f64 * stepping.time_step;
    let speed = scene.grains.iter().map(|grain| grain.velocity.norm()).fold(0.0, f64::max);
    time * (speed + 0.5 * scene.gravity.norm() * time)
}

/// A box around the grains and all meshes, wherever these go.
fn around(
    (low, high): (Vector3<f64>, Vector3<f64>),
    meshes: &[Mesh<'_>],
    reach: f64,
    stepping: &Stepping,
) -> (Vector3<f64>, Vector3<f64>) {
    let (mut least, mut most) = (low, high);
    let end = stepping.steps as f64 * stepping.time_step;
    for mesh in meshes {
        let moved = mesh.wall.motion.displacement(end, stepping.time_step).translation;
        for corner in mesh.triangles.iter().flatten() {
            for place in [*corner, corner + moved] {
                (least, most) = (least.inf(&place), most.sup(&place));
            }
        }
    }
    let margin = Vector3::repeat(0.1 * reach);
    (least - margin, most + margin)
}

fn input(scene: &Scene, stepping: &Stepping, flat: bool, meshes: &[Mesh<'_>], printed: &str) -> Result<String, String> {
    let mut text = format!("# {}\n", heading(scene));
    let mut say = |line: &str| {
        text.push_str(line);
        text.push('\n');
    };
    say("units si\natom_style granular\natom_modify map array");
    if flat {
        say("dimension 2");
    }
    // A mesh must lie within the box, which then cannot be fitted to the grains.
    let open = if meshes.is_empty() { GROWING } else { "f" };
    let mut boundary = boundary(scene, open);
    if is_flat(scene) && !flat {
        // One layer in space has room above and below.
        boundary.truncate(boundary.len() - 1);
        boundary.push_str(open);
    }
    say(&boundary);
    say("newton off\ncommunicate single vel yes\nread_data data.grains");
    say(&format!("neighbor {:?} bin\nneigh_modify every 1 delay 0 check yes", skin(scene)));
    say(&properties(scene)?);
    say("pair_style gran model hooke/stiffness tangential history\npair_coeff * *");
    say(&format!("timestep {:?}", stepping.time_step));
    let strength = scene.gravity.norm();
    if strength > 0.0 {
        let g = scene.gravity;
        say(&format!("fix gravity all gravity {strength:?} vector {:?} {:?} {:?}", g.x, g.y, g.z));
    }
    for (number, wall) in (1..).zip(&scene.walls) {
        let kind = type_of_wall(scene, wall);
        if let Some(plane) = AxisPlane::of(wall) {
            let axis = AXES[plane.axis];
            let shear =
                plane.shear.map(|(along, speed)| format!(" shear {} {speed:?}", AXES[along])).unwrap_or_default();
            say(&format!(
                "fix wall{number} all wall/gran model hooke/stiffness tangential history primitive type {kind} {axis}plane {:?}{shear}{}",
                plane.at,
                if is_asked(scene, number) { " store_force yes" } else { "" }
            ));
        } else {
            let style = if is_asked(scene, number) { "mesh/surface/stress" } else { "mesh/surface" };
            say(&format!("fix mesh{number} all {style} file wall-{number}.stl type {kind}"));
        }
    }
    if !meshes.is_empty() {
        let names: Vec<String> = meshes.iter().map(|mesh| format!("mesh{}", mesh.number)).collect();
        say(&format!(
            "fix walls all wall/gran model hooke/stiffness tangential history mesh n_meshes {} meshes {}",
            names.len(),
            names.join(" ")
        ));
    }
    say("fix motion all nve/sphere");
    if flat {
        say("fix plane all enforce2d");
    }
    say(printed);
    // One format serves the whole row.
    let dump = |name: &str, interval: u64, file: &str| {
        let columns = COLUMNS.join(" ");
        let format = format!("%d %d{}", " %.17g".repeat(COLUMNS.len() - 2));
        format!("dump {name} all custom {interval} {file} {columns}\ndump_modify {name} format \"{format}\" sort id")
    };
    say(&dump("samples", stepping.interval, SAMPLES));
    say(&runs(stepping, meshes)?);
    if !stepping.ends_on_a_sample() {
        say(&format!("undump samples\n{}\nrun 0", dump("end", 1, END)));
    }
    Ok(text)
}

/// The runs, one for each stretch in which no mesh changes its velocity.
fn runs(stepping: &Stepping, meshes: &[Mesh<'_>]) -> Result<String, String> {
    let changes = changes(meshes.iter().map(|mesh| &mesh.wall.motion), stepping)?;
    let mut text = String::new();
    let mut now = vec![Vector3::zeros(); meshes.len()];
    for stretch in changes.windows(2) {
        for (mesh, now) in meshes.iter().zip(&mut now) {
            let (number, velocity) = (mesh.number, velocity_from(&mesh.wall.motion, stretch[0], stepping)?);
            if velocity == *now {
                continue;
            }
            if *now != Vector3::zeros() {
                let _ = writeln!(text, "unfix move{number}");
            }
            if velocity != Vector3::zeros() {
                let [x, y, z] = velocity.into();
                let _ = writeln!(text, "fix move{number} all move/mesh mesh mesh{number} linear {x:?} {y:?} {z:?}");
            }
            *now = velocity;
        }
        let _ = writeln!(text, "run {}", stretch[1] - stretch[0]);
    }
    Ok(text.trim_end().to_owned())
}

/// Walls have types of their own, behind those of the grains, for dashpots may differ there.
fn type_of_wall(scene: &Scene, wall: &Wall) -> usize {
    scene.materials.len() + usize::from(wall.material) + 1
}

/// The properties of every pair of types.
fn properties(scene: &Scene) -> Result<String, String> {
    let count = scene.materials.len();
    let grains = grain_materials(scene);
    let mut table: Vec<(ContactLaw, Dashpots)> = Vec::with_capacity(4 * count * count);
    for a in 0..2 * count {
        for b in 0..2 * count {
            table.push(entry(scene, &grains, (a, b))?.unwrap_or_default());
        }
    }
    type Pick = fn(&(ContactLaw, Dashpots)) -> f64;
    let picks: [(&str, Pick); 6] = [
        ("kn", |(law, _)| law.normal_stiffness),
        ("kt", |(law, _)| law.tangential_stiffness),
        ("gamman", |(_, dashpots)| dashpots.normal),
        ("gammat", |(_, dashpots)| dashpots.tangential),
        ("coefficientFriction", |(law, _)| law.friction),
        // Asked for, and not used with stiffnesses.
        ("coefficientRestitution", |_| 0.5),
    ];
    let mut lines = Vec::new();
    for (name, pick) in picks {
        let values: Vec<String> = table.iter().map(|entry| format!("{:?}", pick(entry))).collect();
        lines.push(format!("fix {name} all property/global {name} peratomtypepair {} {}", 2 * count, values.join(" ")));
    }
    Ok(lines.join("\n"))
}

/// Law and dashpots between two types; none where they never meet.
fn entry(scene: &Scene, grains: &[u16], (a, b): (usize, usize)) -> Result<Option<(ContactLaw, Dashpots)>, String> {
    let count = scene.materials.len();
    let material = |kind: usize| (kind % count) as u16;
    let is_grain = |kind: usize| kind < count && grains.contains(&material(kind));
    let is_wall = |kind: usize| kind >= count;
    let (grain, side) = match (is_grain(a), is_grain(b)) {
        (true, true) if scene.grains.len() > 1 => (a, Side::Grains(material(b))),
        (true, _) if is_wall(b) => (a, Side::Wall),
        (_, true) if is_wall(a) => (b, Side::Wall),
        _ => return Ok(None),
    };
    let Some(law) = scene.law(material(a), material(b)) else { return Ok(None) };
    Ok(Some((*law, Dashpots::of(scene, law, material(grain), side)?)))
}
