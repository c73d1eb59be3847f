//! Prepares the packings of the case `photoelastic-packing` and finds the motion of their walls.
//!
//! `cargo run --release --example photoelastic_packing FOLDER VARIANT …` prepares the packing of each named variant and
//! writes it to FOLDER as a LAMMPS data file. It prints the table of the variant for the scene file, with initial
//! positions and velocities of the walls. If FOLDER contains the compressed packing, such as `start-1.data.gz` in the
//! folder of the case, the program uses the packing of the case and only finds the motion of the walls.
//!
//! At stage A, the mean overlap and the ratio F_H/F_V of horizontal to vertical wall force are prescribed. The growth of
//! F_V from stage A to stage B is prescribed, too. The result is F_H/F_V at stage B. No parameter is fitted to this
//! result.

mod prepare;
mod search;
mod walls;

use grainbench::cases::registry;
use grainbench::cases::registry::read_grains;
use grainbench::harness::case::PLAIN;
use grainbench::scene::scene::{Scene, WallShape};
use grainbench::scene::source::SceneSource;
use search::Search;
use std::collections::HashMap;
use std::error::Error;
use std::path::Path;

/// Returns the seed in a variant's name, which is the number after `seed-`; `1` for other names.
fn seed(variant: &str) -> &str {
    variant.rsplit_once("seed-").map_or("1", |(_, seed)| seed)
}

/// Returns the scene of a variant with loose discs, before compaction.
fn loose(variant: &str) -> Result<Scene, Box<dyn Error>> {
    let text = include_str!("loose.toml");
    let mut source = SceneSource::from_text("loose.toml", Path::new(""), text);
    if variant.starts_with("fifty") {
        source = source.variant("fifty");
    }
    Ok(source.set("grains.disc.packed.seed", seed(variant)).scene(&read_grains)?)
}

/// Moves the lower corner of the box to the origin, and rounds the positions of discs and walls to 1 nm.
fn rounded(mut packing: Scene) -> Scene {
    let round = |length: f64| (length * 1e9).round() / 1e9;
    let mut corner = [0.0; 2];
    for (number, wall) in packing.walls.iter().enumerate() {
        if let (&WallShape::Plane { point, .. }, 0 | 2) = (&wall.shape, number) {
            corner[number / 2] = point[number / 2];
        }
    }
    for axis in 0..2 {
        packing.grains.iter_mut().for_each(|grain| grain.position[axis] = round(grain.position[axis] - corner[axis]));
        for wall in &mut packing.walls {
            if let WallShape::Plane { point, normal } = &mut wall.shape {
                point[axis] = if normal[axis] == 0.0 { 0.0 } else { round(point[axis] - corner[axis]) };
            }
        }
    }
    packing
}

/// Returns the discs in the format of a LAMMPS data file. The density of each disc is that of a sphere with the radius
/// and the mass of the disc.
fn data(packing: &Scene) -> String {
    let [width, height] = walls::size(packing);
    let mut text = format!(
        "Touching discs, density as that of a sphere\n\n{} atoms\n2 atom types\n\n0.0 {width:?} xlo xhi\n0.0 {height:?} ylo yhi\n\
         -0.5 0.5 zlo zhi\n\nAtoms\n\n",
        packing.grains.len()
    );
    for (id, grain) in (1..).zip(&packing.grains) {
        let density = grain.mass / (4.0 / 3.0 * std::f64::consts::PI * grain.radius.powi(3));
        let (diameter, place) = (2.0 * grain.radius, grain.position);
        text.push_str(&format!("{id} 1 {diameter:?} {density:?} {:?} {:?} 0.0\n", place.x, place.y));
    }
    text
}

/// Returns the scene of a variant with the discs of the file `data` and the walls of `packing`. If the variant's name
/// begins with `table` or `fifty-elastic`, contact laws and times are those of the variant of the case with this name
/// without `-seed…`. Otherwise, they are those of the case's own scene.
fn scene(variant: &str, packing: &Scene, data: &Path) -> Result<Scene, Box<dyn Error>> {
    let named = ["table", "fifty-elastic"].iter().any(|name| variant.starts_with(name));
    let table = if named { variant.split("-seed").next().unwrap_or(variant) } else { PLAIN };
    let mut scene = source(table)?
        .set("grains.disc.file.path", &format!("{:?}", std::path::absolute(data)?))
        .scene(&read_grains)?;
    for (wall, prepared) in scene.walls.iter_mut().zip(&packing.walls) {
        wall.shape = prepared.shape.clone();
    }
    Ok(scene)
}

/// Returns the source of a variant of the case.
fn source(variant: &str) -> Result<SceneSource, Box<dyn Error>> {
    let case = registry::by_name("photoelastic-packing").ok_or("the case is gone")?;
    Ok(if variant == PLAIN { case.source() } else { case.source().variant(variant) })
}

/// Prints the packing file and the wall motions of a variant in the format of the scene file.
fn print(variant: &str, data: &str, scene: &Scene) {
    println!("[variants.{variant}]\ngrains.disc.file.path = \"{data}\"");
    for wall in &scene.walls {
        let [first, second] = &wall.motion.phases[..] else { continue };
        if let WallShape::Plane { point, .. } = wall.shape {
            // All digits are printed, because a change of the last digit can change the later motion of the discs.
            let exact = |speed: f64| format!("{:?}", speed + 0.0);
            let speed = |axis: usize| [first.velocity[axis], second.velocity[axis]].map(exact);
            let [x, y] = [speed(0), speed(1)];
            let seconds = |moment: grainbench::scene::motion::Moment| moment.seconds(f64::NAN);
            println!(
                "walls.{} = {{ plane.point = [{:?}, {:?}], motion = [{{ velocity = [{}, {}], stop = {:?} }}, \
                 {{ velocity = [{}, {}], start = {:?}, stop = {:?} }}] }}",
                wall.name,
                point.x,
                point.y,
                x[0],
                y[0],
                seconds(first.stop),
                x[1],
                y[1],
                seconds(second.start),
                seconds(second.stop)
            );
        }
    }
    println!();
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().ok_or("a folder, and variants of the case")?;
    let mut prepared: HashMap<String, Scene> = HashMap::new();
    for variant in arguments {
        let prefix = if variant.starts_with("fifty") { "fifty" } else { "start" };
        let name = format!("{prefix}-{}.data", seed(&variant));
        let path = Path::new(&folder).join(&name);
        let kept = Path::new(&folder).join(format!("{name}.gz")).is_file();
        if !kept && !prepared.contains_key(&name) {
            let packing = rounded(prepare::prepare(loose(&variant)?)?);
            std::fs::write(&path, data(&packing))?;
            prepared.insert(name.clone(), packing);
        }
        let scene =
            if kept { source(&variant)?.scene(&read_grains)? } else { scene(&variant, &prepared[&name], &path)? };
        let search = Search::new(&scene)?;
        let fraction = walls::fraction(&scene);
        match search.impose() {
            Ok(imposed) => {
                eprintln!("{variant}: fraction {fraction:.4}, {imposed:?}");
                print(&variant, &format!("{name}.gz"), &search.driven(&imposed));
            }
            Err(reason) => eprintln!("{variant}: fraction {fraction:.4}, {reason}"),
        }
    }
    Ok(())
}
