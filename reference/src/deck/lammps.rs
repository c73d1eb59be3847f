//! LAMMPS: contacts of `gran/hooke/history` and its like between grains and at walls.

use grainbench_scene::effects::Effects;
use grainbench_scene::scene::{Probe, ProbeTarget, Scene, Wall};

use super::data::{GROWING, boundary, box_of, data_file, of_sphere, skin};
use super::lammps_contact::{at_wall, between_grains};
use super::logged::logged;
use super::outline::{AXES, AxisPlane, has_discs, inertia_factor, is_flat, one_inertia};
use super::region::region;
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
    let effects = Effects::of(scene);
    if effects.hertz && effects.restitution {
        say("# The number behind the stiffness is what the polynomial of `damping tsuji` makes sqrt(5) zeta of:");
        say("# with it the dashpot is 2 sqrt(5/6) zeta sqrt(S m_eff), as the coefficient of restitution asks for.");
    }
    say(&between_grains(scene)?);
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

fn wall_lines(scene: &Scene, wall: &Wall, number: u32, stepping: &Stepping) -> Result<String, String> {
    let Some(law) = at_wall(scene, wall.material, &wall.name)? else { return Ok(String::new()) };
    let tells = tells(scene, number);
    if let Some(plane) = AxisPlane::of(wall) {
        let axis = AXES[plane.axis];
        let (low, high) = if plane.is_low {
            (format!("{:?}", plane.at), "NULL".to_owned())
        } else {
            ("NULL".to_owned(), format!("{:?}", plane.at))
        };
        let shear = plane.shear.map(|(along, speed)| format!(" shear {} {speed:?}", AXES[along])).unwrap_or_default();
        return Ok(format!("fix wall{number} all wall/gran {law} {axis}plane {low} {high}{shear}{tells}"));
    }
    let region = region(wall, number, stepping)?;
    Ok(format!("{region}\nfix wall{number} all wall/gran/region {law} region wall{number}{tells}"))
}
