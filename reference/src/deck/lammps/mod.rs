//! Decks for LAMMPS. Contacts between grains and at walls use `gran/hooke/history` and related styles.

mod contact;
mod passing;
mod region;

use grainbench_scene::effects::Effects;
use grainbench_scene::scene::{Scene, Wall};

use crate::deck::data::{GROWING, boundary, box_of, data_file, of_sphere, skin};
use crate::deck::driven::driven;
use crate::deck::logged::{Sums, logged};
use crate::deck::outline::{AXES, AxisPlane, has_discs, inertia_factor, is_flat, one_inertia};
use crate::deck::peer::{DeckFiles, Peer};
use crate::deck::script::{
    COLUMNS, CONTACTS, END, END_CONTACTS, SAMPLES, asks_for_contacts_at, asks_for_pairs, asks_for_wall, heading, thermo,
};
use crate::deck::stepping::Stepping;
use crate::names::Names;
use contact::{at_wall, between_grains};
use region::region;

/// LAMMPS, `pair_style gran/hooke/history` and related styles.
pub(crate) struct Lammps;

impl Peer for Lammps {
    fn name(&self) -> &'static str {
        "lammps"
    }

    fn title(&self) -> &'static str {
        "LAMMPS"
    }

    fn executable(&self) -> &'static str {
        "lmp"
    }

    fn write(&self, scene: &Scene, stepping: &Stepping) -> Result<DeckFiles, String> {
        files(scene, stepping)
    }
}

fn files(scene: &Scene, stepping: &Stepping) -> Result<DeckFiles, String> {
    passing::refuse(scene)?;
    one_inertia(scene, inertia_factor(scene))?;
    if let Some(what) = scene.round_wall().filter(|_| scene.laws.iter().flatten().any(|law| law.is_hertz())) {
        return Err(format!(
            "{what}, and LAMMPS uses its curvature in Hertz' law, while the scene treats it as a plane"
        ));
    }
    // LAMMPS reads the density in a data file as that of a sphere, even in two dimensions.
    let data = data_file(scene, scene.materials.len() + passing::more_types(scene), box_of(scene), of_sphere);
    let advance = |wall: usize| passing::advance(scene, wall);
    let grains = passing::grains(scene);
    let program = Sums { temperature: "NULL", grains, force: &forces_of_wall, advance: &advance };
    let (commands, logged) = logged(scene, &program)?;
    let printed = thermo(&commands, &logged, stepping);
    let names = names(scene);
    let input = input(scene, stepping, &printed, &names)?;
    Ok(DeckFiles { files: vec![("in.lammps".to_owned(), input), ("data.grains".to_owned(), data)], logged, names })
}

/// Returns the names of the columns with the forces that probes request. Column 1 of `fix wall/gran … contacts` is a
/// flag, and columns 2 to 4 are the force. `pair/local` has separate columns for the normal and the tangential force.
fn names(scene: &Scene) -> Names {
    let mut names = Vec::new();
    for (number, wall) in (1..).zip(&scene.walls).filter(|&(number, _)| asks_for_contacts_at(scene, number)) {
        for (axis, column) in AXES.into_iter().zip(2..) {
            names.push((format!("{}.force_{axis}", wall.name), format!("f_wall{number}[{column}]")));
        }
    }
    if asks_for_pairs(scene) {
        names.extend([("id1".to_owned(), "c_pairs[1]".to_owned()), ("id2".to_owned(), "c_pairs[2]".to_owned())]);
        for (part, first) in [("force", 1), ("tangential", 4)] {
            for (axis, column) in AXES.into_iter().zip(first..) {
                names.push((format!("{part}_{axis}"), format!("c_forces[{column}]")));
            }
        }
    }
    Names(names)
}

/// Returns the command that sums the forces of a wall on the grains, and the components of the sum.
fn forces_of_wall(number: usize) -> (String, [String; 3]) {
    let fix = format!("f_wall{number}");
    let command = format!("compute wall{number} all reduce sum {fix}[2] {fix}[3] {fix}[4]\n");
    (command, [1, 2, 3].map(|at| format!("c_wall{number}[{at}]")))
}

/// Returns the keyword that makes LAMMPS store the forces of a wall on each grain, if a probe or a piston needs them,
/// otherwise an empty text.
fn tells(scene: &Scene, number: u32) -> &'static str {
    let is_pressed = scene.walls[number as usize - 1].piston.is_some();
    if asks_for_wall(scene, number as usize) || is_pressed { " contacts" } else { "" }
}

fn input(scene: &Scene, stepping: &Stepping, printed: &str, names: &Names) -> Result<String, String> {
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
    let grains = passing::grains(scene);
    passing::atoms(scene)?.iter().for_each(|line| say(line));
    say(&format!("neighbor {:?} bin\nneigh_modify every 1 delay 0 check yes", skin(scene)));
    let effects = Effects::from_scene(scene);
    if effects.hertz && effects.restitution {
        say(
            "# With the coefficient after the stiffness, the dashpot of `damping tsuji` is 2 sqrt(5/6) zeta sqrt(S m_eff).",
        );
        say(
            "# For LAMMPS from 29 Sep 2021 to 22 Jul 2025. A release that multiplies the polynomial by sqrt(2) needs the",
        );
        say("# coefficient of restitution itself.");
    }
    say(&between_grains(scene)?);
    say(&format!("timestep {:?}", stepping.time_step));
    let strength = scene.gravity.norm();
    if strength > 0.0 {
        let g = scene.gravity;
        say(&format!("fix gravity {grains} gravity {strength:?} vector {:?} {:?} {:?}", g.x, g.y, g.z));
    }
    for (number, wall) in (1..).zip(&scene.walls) {
        say(&wall_lines(scene, wall, number, stepping)?);
    }
    passing::press(scene, stepping)?.iter().for_each(|line| say(line));
    passing::removal(scene).iter().for_each(|line| say(line));
    let (lines, free) = driven(scene, grains);
    lines.iter().for_each(|line| say(line));
    say(&format!("fix motion {free} nve/sphere{}", if has_discs(scene) { " disc" } else { "" }));
    if flat {
        say("fix plane all enforce2d");
    }
    say(printed);
    let of_walls = names.0.iter().map(|(_, column)| column.as_str()).filter(|column| column.starts_with("f_"));
    let columns = COLUMNS.into_iter().chain(of_walls).collect::<Vec<_>>().join(" ");
    let of_pairs: Vec<&str> =
        names.0.iter().map(|(_, column)| column.as_str()).filter(|it| it.starts_with("c_")).collect();
    let of_pairs = of_pairs.join(" ");
    let dump = |name: &str, interval: u64, [file, contacts]: [&str; 2]| {
        let grains = format!(
            "dump {name} {grains} custom {interval} {file} {columns}\n\
             dump_modify {name} format float %.17g sort id time yes units yes"
        );
        if of_pairs.is_empty() {
            return grains;
        }
        format!(
            "{grains}\ndump {name}2 all local {interval} {contacts} {of_pairs}\ndump_modify {name}2 format float %.17g"
        )
    };
    if !of_pairs.is_empty() {
        say("compute pairs all property/local patom1 patom2\ncompute forces all pair/local fx fy fz p1 p2 p3");
    }
    say(&dump("samples", stepping.interval, [SAMPLES, CONTACTS]));
    say(&format!("run {}", stepping.steps));
    if !stepping.ends_on_a_sample() {
        let no_more = if of_pairs.is_empty() { "" } else { "\nundump samples2" };
        say(&format!("undump samples{no_more}\n{}\nrun 0", dump("end", 1, [END, END_CONTACTS])));
    }
    Ok(text)
}

fn wall_lines(scene: &Scene, wall: &Wall, number: u32, stepping: &Stepping) -> Result<String, String> {
    let Some(law) = at_wall(scene, wall.material, &wall.name)? else { return Ok(String::new()) };
    let tells = tells(scene, number);
    let grains = passing::grains(scene);
    let ways = passing::ways(scene, wall, number as usize, stepping);
    if let Some(plane) = AxisPlane::from_wall(wall).filter(|_| ways.iter().all(String::is_empty)) {
        let axis = AXES[plane.axis];
        let (low, high) = if plane.is_low {
            (format!("{:?}", plane.at), "NULL".to_owned())
        } else {
            ("NULL".to_owned(), format!("{:?}", plane.at))
        };
        let shear = plane.shear.map(|(along, speed)| format!(" shear {} {speed:?}", AXES[along])).unwrap_or_default();
        return Ok(format!("fix wall{number} {grains} wall/gran {law} {axis}plane {low} {high}{shear}{tells}"));
    }
    let region = region(wall, number, stepping, &ways)?;
    Ok(format!("{region}\nfix wall{number} {grains} wall/gran/region {law} region wall{number}{tells}"))
}
