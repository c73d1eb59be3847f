//! LAMMPS: `gran/hooke/history` between grains and at walls.

use std::fmt::Write as _;

use grainbench_scene::motion::{Moment, Motion};
use grainbench_scene::scene::{ContactLaw, Probe, ProbeTarget, Scene, Wall, WallShape};

use super::dashpots::{Dashpots, Side};
use super::data::{GROWING, boundary, box_of, data_file, of_sphere, skin};
use super::logged::logged;
use super::outline::{
    AXES, AxisPlane, grain_materials, has_discs, inertia_factor, is_flat, one_inertia, refuse_turning,
};
use super::{COLUMNS, END, SAMPLES, Stepping, Written, heading, thermo};

pub(crate) fn files(scene: &Scene, stepping: &Stepping) -> Result<Written, String> {
    one_inertia(scene, inertia_factor(scene))?;
    // LAMMPS reads the density of a data file as a sphere's, in two dimensions too.
    let data = data_file(scene, scene.materials.len(), box_of(scene), of_sphere);
    let (commands, logged) = logged(scene, "NULL", forces_of_wall)?;
    let printed = thermo(&commands, &logged, stepping);
    let files = vec![("in.lammps".to_owned(), input(scene, stepping, &printed)?), ("data.grains".to_owned(), data)];
    Ok((files, logged))
}

/// The command that adds up the forces of a wall on the grains, and the components of the sum.
fn forces_of_wall(number: usize) -> (String, [String; 3]) {
    let fix = format!("f_wall{number}");
    let command = format!("compute wall{number} all reduce sum {fix}[2] {fix}[3] {fix}[4]\n");
    (command, [1, 2, 3].map(|at| format!("c_wall{number}[{at}]")))
}

/// What lets a wall tell its forces, where a probe asks for them.
fn tells(scene: &Scene, number: u32) -> &'static str {
    let is_asked = |probe: &Probe| probe.target == ProbeTarget::Wall(number as usize - 1);
    if scene.probes.iter().any(is_asked) { " contacts" } else { "" }
}

fn input(scene: &Scene, stepping: &Stepping, printed: &str) -> Result<String, String> {
    let flat = is_flat(scene);
    let mut text = format!("# {}\n", heading(scene));
    let mut say = |line: &str| {
        text.push_str(line);
        text.push('\n');
    };
    say("units si\natom_style sphere\natom_modify map array");
    if flat {
        say("dimension 2");
    }
    say(&boundary(scene, GROWING));
    say("newton off\ncomm_modify vel yes\nread_data data.grains");
    say(&format!("neighbor {:?} bin\nneigh_modify every 1 delay 0 check yes", skin(scene)));
    say(&format!("pair_style gran/hooke/history {}\npair_coeff * *", pair_law(scene)?));
    say(&format!("timestep {:?}", stepping.time_step));
    let strength = scene.gravity.norm();
    if strength > 0.0 {
        let g = scene.gravity;
        say(&format!("fix gravity all gravity {strength:?} vector {:?} {:?} {:?}", g.x, g.y, g.z));
    }
    for (number, wall) in (1..).zip(&scene.walls) {
        say(&wall_lines(scene, wall, number, stepping)?);
    }
    say(if has_discs(scene) { "fix motion all nve/sphere disc" } else { "fix motion all nve/sphere" });
    if flat {
        say("fix plane all enforce2d");
    }
    say(printed);
    let columns = COLUMNS.join(" ");
    let dump = |name: &str, interval: u64, file: &str| {
        format!(
            "dump {name} all custom {interval} {file} {columns}\ndump_modify {name} format float %.17g sort id time yes units yes"
        )
    };
    say(&dump("samples", stepping.interval, SAMPLES));
    say(&format!("run {}", stepping.steps));
    if !stepping.ends_on_a_sample() {
        say(&format!("undump samples\n{}\nrun 0", dump("end", 1, END)));
    }
    Ok(text)
}

/// `k_n k_t γ_n γ_t μ 1` of a law, with the dashpots of a partner.
fn numbers(scene: &Scene, law: &ContactLaw, material: u16, side: Side) -> Result<String, String> {
    let Dashpots { normal, tangential } = Dashpots::of(scene, law, material, side)?;
    let (k_n, k_t, friction) = (law.normal_stiffness, law.tangential_stiffness, law.friction);
    Ok(format!("{k_n:?} {k_t:?} {normal:?} {tangential:?} {friction:?} 1"))
}

/// The one law that LAMMPS has between grains.
fn pair_law(scene: &Scene) -> Result<String, String> {
    let materials = grain_materials(scene);
    let mut found: Option<String> = None;
    for &a in &materials {
        for &b in materials.iter().filter(|&&b| b >= a) {
            let Some(law) = scene.law(a, b) else { continue };
            // A lone grain touches no other, whatever masses its law would need.
            let said = if scene.grains.len() == 1 { Side::Wall } else { Side::Grains(b) };
            same(&mut found, numbers(scene, law, a, said)?, "gran/hooke/history has one law for all pairs of grains")?;
        }
    }
    // No two grains can touch.
    Ok(found.unwrap_or_else(|| "1.0 0.0 0.0 0.0 0.0 0".to_owned()))
}

/// Takes a law, or refuses a second one.
fn same(found: &mut Option<String>, law: String, reason: &str) -> Result<(), String> {
    match found {
        Some(before) if *before != law => Err(format!("{reason}, and the scene has several")),
        _ => {
            *found = Some(law);
            Ok(())
        }
    }
}

fn wall_lines(scene: &Scene, wall: &Wall, number: u32, stepping: &Stepping) -> Result<String, String> {
    refuse_turning(wall)?;
    let mut law: Option<String> = None;
    for material in grain_materials(scene) {
        let Some(of_pair) = scene.law(material, wall.material) else { continue };
        let reason = format!("wall/gran has one law for all grains at the wall `{}`", wall.name);
        same(&mut law, numbers(scene, of_pair, material, Side::Wall)?, &reason)?;
    }
    let Some(law) = law else { return Ok(String::new()) };
    if let Some(plane) = AxisPlane::of(wall) {
        let axis = AXES[plane.axis];
        let (low, high) = if plane.is_low {
            (format!("{:?}", plane.at), "NULL".to_owned())
        } else {
            ("NULL".to_owned(), format!("{:?}", plane.at))
        };
        let shear = plane.shear.map(|(along, speed)| format!(" shear {} {speed:?}", AXES[along])).unwrap_or_default();
        let tells = tells(scene, number);
        return Ok(format!(
            "fix wall{number} all wall/gran hooke/history {law} {axis}plane {low} {high}{shear}{tells}"
        ));
    }
    let WallShape::Plane { point, normal } = wall.shape else {
        return Err(format!("LAMMPS has no wall of finite extent such as `{}`", wall.name));
    };
    let mut lines = String::new();
    let mut moves = String::new();
    if wall.motion.is_moving() {
        moves.push_str(" move");
        for (axis, name) in AXES.into_iter().enumerate() {
            let path = path(&wall.motion, axis, stepping);
            if path.is_empty() {
                moves.push_str(" NULL");
            } else {
                let _ = writeln!(lines, "variable wall{number}{} equal \"{path}\"", name);
                let _ = write!(moves, " v_wall{number}{}", name);
            }
        }
    }
    let (p, n) = (point, normal);
    let _ = writeln!(
        lines,
        "region wall{number} plane {:?} {:?} {:?} {:?} {:?} {:?} side in units box{moves}",
        p.x, p.y, p.z, n.x, n.y, n.z
    );
    let tells = tells(scene, number);
    let _ = write!(lines, "fix wall{number} all wall/gran/region hooke/history {law} region wall{number}{tells}");
    Ok(lines)
}

/// The displacement along an axis as a formula of step and time step; empty where there is none.
fn path(motion: &Motion, axis: usize, stepping: &Stepping) -> String {
    let time = |moment: Moment| match moment {
        Moment::Seconds(time) => format!("{time:?}"),
        Moment::Cycle(cycle) => format!("({cycle}*dt)"),
        Moment::Never => format!("{:?}", f64::MAX),
    };
    let mut terms = Vec::new();
    for phase in motion.phases.iter().filter(|phase| phase.velocity[axis] != 0.0) {
        let speed = phase.velocity[axis];
        let start = phase.start.seconds(stepping.time_step);
        let elapsed = if phase.stop == Moment::Never {
            "(step*dt)".to_owned()
        } else {
            let stop = time(phase.stop);
            format!("((step*dt<{stop})*(step*dt)+(step*dt>={stop})*{stop})")
        };
        terms.push(if start > 0.0 {
            let start = time(phase.start);
            format!("({speed:?})*(step*dt>{start})*({elapsed}-{start})")
        } else {
            format!("({speed:?})*{elapsed}")
        });
    }
    terms.join("+")
}
