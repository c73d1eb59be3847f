//! Walls of triangles. They give the same results as other walls with the same surface, also with motion and with
//! inserted and removed grains. Invalid files are rejected.

use crate::common::{Directory, bits, scene_in, temporary, temporary_with};
use crate::observer::RunObserver;
use grainbench::cases::solvers;
use grainbench::scene::scene::Scene;
use grainbench::solver::observer::{Observer, RunOptions};
use grainbench::solver::record::Record;
use grainbench::solver::resolution::Resolution;
use std::fmt::Write as _;

type Triangle = [[f64; 3]; 3];

const STEP: Resolution = Resolution::TimeStep(1e-4);

fn stl(triangles: &[Triangle]) -> String {
    let mut text = "solid test\n".to_owned();
    for triangle in triangles {
        text.push_str("facet normal 0 0 0\nouter loop\n");
        for [x, y, z] in triangle {
            let _ = writeln!(text, "vertex {x:?} {y:?} {z:?}");
        }
        text.push_str("endloop\nendfacet\n");
    }
    text + "endsolid test\n"
}

/// Returns the triangles of a box with outward normals.
fn block(low: [f64; 3], high: [f64; 3]) -> Vec<Triangle> {
    let corner = |bits: usize| [0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { high[axis] } else { low[axis] });
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c].map(corner), [a, c, d].map(corner)]).collect()
}

/// Returns the triangles of a rectangle in the plane z = 0: `count` strips of two triangles each.
fn strips(low: [f64; 2], high: [f64; 2], count: u32) -> Vec<Triangle> {
    let at = |strip: u32, y: f64| [low[0] + (high[0] - low[0]) * f64::from(strip) / f64::from(count), y, 0.0];
    (0..count)
        .flat_map(|strip| {
            let [a, b] = [at(strip, low[1]), at(strip + 1, low[1])];
            let [c, d] = [at(strip + 1, high[1]), at(strip, high[1])];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

/// Spheres above each other in a box of triangles with sides of 2 m. Some are in contact with edges and corners of the box.
const BOX: &str = include_str!("../scenes/in-a-box.toml");

/// Returns the scene of the spheres without the box.
fn spheres() -> &'static str {
    BOX.split("[walls.box]").next().unwrap()
}

fn scene(triangles: &[Triangle], text: &str) -> Scene {
    let directory = temporary_with("wall.stl", stl(triangles));
    scene_in(&directory, text).unwrap()
}

fn run(scene: &Scene, observer: &mut dyn Observer) -> Record {
    let solver = solvers::by_name("dem").unwrap();
    solver.run(scene, &STEP, observer).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns the largest distance between equal grains of two runs at the end (m).
fn apart(one: &Record, other: &Record) -> f64 {
    let [one, other] = [one, other].map(|record| &record.snapshots.last().unwrap().grains);
    assert_eq!(one.len(), other.len());
    one.iter().zip(other).map(|(a, b)| (a.position - b.position).norm()).fold(0.0, f64::max)
}

/// In a box of twelve triangles, grains move as in a box of six planes.
#[test]
fn a_box_of_triangles_is_a_box_of_planes() {
    let mut planes = String::new();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let (mut point, mut normal) = ([0.0; 3], [0.0; 3]);
            (point[axis], normal[axis]) = (side, -side);
            let (name, plane) = (format!("w{axis}{side}"), format!("{{ point = {point:?}, normal = {normal:?} }}"));
            let _ = writeln!(planes, "walls.'{name}' = {{ material = 'm', plane = {plane} }}");
        }
    }
    let triangles = block([-1.0; 3], [1.0; 3]);
    let mut ours = scene(&triangles, BOX);
    let as_planes = run(&scene(&triangles, &format!("{planes}{}", spheres())), &mut ());
    let record = run(&ours, &mut ());
    let contacts = |record: &Record| record.snapshots.last().unwrap().contacts.as_ref().map_or(0, Vec::len);
    let touching = contacts(&record);
    assert!(touching > 20 && touching == contacts(&as_planes), "{touching}");
    assert!(apart(&record, &as_planes) < 1e-9, "{}", apart(&record, &as_planes));
    // Control: a slightly different stiffness gives a visible difference.
    ours.change_laws(|law| law.scale_normal(1.0 + 1e-6));
    assert!(apart(&run(&ours, &mut ()), &as_planes) > 1e-9);
}

/// A translating and rotating plate of triangles moves grains as a rectangle does.
#[test]
fn a_plate_of_triangles_moves_as_a_rectangle() {
    let motion = "motion = [{ velocity = [0.3, 0.0, 0.2], spin = [0.0, 0.0, 1.5], centre = [0.2, 0.1, 0.0] }]";
    let grains = spheres().replace("-0.79]", "0.1999]").replace("count = [4, 4, 3]", "count = [4, 4, 1]");
    let mesh =
        format!("[walls.plate]\nmaterial = 'm'\nmesh = {{ file = 'wall.stl', unit = 'm', open = true }}\n{motion}\n");
    let rectangle = "rectangle = { corner = [-3.0, -3.0, 0.0], edges = [[6.0, 0.0, 0.0], [0.0, 6.0, 0.0]] }";
    let rectangle = format!("[walls.plate]\nmaterial = 'm'\n{rectangle}\n{motion}\n");
    let triangles = strips([-3.0; 2], [3.0; 2], 11);
    let [ours, theirs] = [mesh, rectangle].map(|wall| run(&scene(&triangles, &format!("{grains}{wall}")), &mut ()));
    assert!(apart(&ours, &theirs) < 1e-9, "{}", apart(&ours, &theirs));
    let [first, last] = [0, ours.snapshots.len() - 1].map(|at| &ours.snapshots[at].grains[0]);
    assert!((first.position - last.position).norm() > 0.05 && last.spin.norm() > 0.01);
    let forces = [&ours, &theirs].map(|record| record.snapshots.last().unwrap().walls[0].force.unwrap());
    assert!(forces[0].norm() > 1.0 && (forces[0] - forces[1]).norm() < 1e-6 * forces[0].norm());
}

/// A sphere is moved over the ridge between two plates at 179°. It keeps its tangential spring, because the contact
/// continues from plate to ridge to plate. The tangential force is k_t v t, with a relative error of 1 − cos ½° due to
/// the slope of the plates.
#[test]
fn a_spring_goes_on_over_a_ridge() {
    let slope = 0.5_f64.to_radians();
    let at = |x: f64, y: f64| [x, y, -slope.tan() * x.abs()];
    let [a, b, c] = [-1.0, 0.0, 1.0].map(|x| [at(x, -1.0), at(x, 1.0)]);
    let triangles = [[a[0], b[0], b[1]], [a[0], b[1], a[1]], [b[0], c[0], c[1]], [b[0], c[1], b[1]]];
    let text = include_str!("../scenes/roof.toml");
    let record = run(&scene(&triangles, text), &mut ());
    let (rate, time) = (3e4 * 0.1, &record.series.time);
    let allowed = rate * 0.04 * (1.0 - slope.cos());
    for (force, time) in record.series.column("touch.shear_force").unwrap().iter().zip(time) {
        assert!((force - rate * time).abs() < allowed, "{force} N for {} N at {time} s", rate * time);
    }
}

/// Returns a scene with a rotating funnel of triangles. Grains fall through it and are removed below.
fn funnel() -> Scene {
    let rim = |part: u32, radius: f64, z: f64| {
        let (sine, cosine) = (f64::from(part) * std::f64::consts::TAU / 16.0).sin_cos();
        [radius * cosine, radius * sine, z]
    };
    // The last part ends exactly where the first part begins, to the bit.
    let triangles: Vec<Triangle> = (0..16)
        .flat_map(|part| {
            let next = (part + 1) % 16;
            let [a, b] = [part, next].map(|part| rim(part, 0.5, -1.2));
            let [c, d] = [next, part].map(|part| rim(part, 2.0, 0.3));
            [[a, b, c], [a, c, d]]
        })
        .collect();
    let text = format!(
        "{}[walls.funnel]\nmaterial = 'm'\nmesh = {{ file = 'wall.stl', unit = 'm', open = true }}\n\
         motion = [{{ spin = [0.0, 0.0, 3.0], centre = [0.0, 0.0, 0.0] }}]\n\
         [removal]\nlow = [-9.0, -9.0, -9.0]\nhigh = [9.0, 9.0, -1.5]\n",
        spheres().replace("-0.79]", "0.2]").replace("duration = 0.3", "duration = 0.8")
    );
    scene(&triangles, &text)
}

#[test]
fn threads_and_restarts_change_no_bit() {
    let scene = funnel();
    let mut observer = RunObserver::with_checkpoints(700, 1);
    let straight = run(&scene, &mut observer);
    assert!(straight.snapshots.last().unwrap().grains.len() < 48, "none was taken out");
    let straight = bits(straight);
    for threads in [2, 3] {
        assert!(bits(run(&scene, &mut RunOptions { threads, ..RunOptions::DEFAULT })) == straight, "{threads} threads");
    }
    let solver = solvers::by_name("dem").unwrap();
    assert!(observer.checkpoints.len() > 5);
    for checkpoint in &observer.checkpoints {
        let record =
            solver.run_from(&scene, &STEP, Some(checkpoint), &mut ()).unwrap_or_else(|error| panic!("{error}"));
        assert!(bits(record) == straight);
    }
}

/// Returns triangles as a binary STL file.
fn binary(triangles: &[Triangle]) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        triangle.iter().flatten().for_each(|number| bytes.extend((*number as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

/// Valid files: in millimetres, with slightly different corners, binary, turned inside out if this is declared, and
/// open. Invalid files are in `tests/refusals/meshes.toml`.
#[test]
fn valid_files_are_read() {
    let cube = block([-1.0; 3], [1.0; 3]);
    let turned: Vec<Triangle> = cube.iter().map(|&[a, b, c]| [b, a, c]).collect();
    let mut nearly = cube.clone();
    nearly[0][0][0] += 1e-7;
    let large: Vec<Triangle> = cube.iter().map(|triangle| triangle.map(|corner| corner.map(|x| 1e3 * x))).collect();
    let directory = temporary();
    for (bytes, more) in [
        (stl(&large).into_bytes(), "unit = 'mm'"),
        (stl(&nearly).into_bytes(), "unit = 'm', merge = 1e-6"),
        (binary(&cube), "unit = 'm'"),
        (stl(&turned).into_bytes(), "unit = 'm', inward = true"),
        (stl(&cube[2..]).into_bytes(), "unit = 'm', open = true"),
    ] {
        directory.write("wall.stl", bytes);
        scene_in(&directory, &BOX.replace("unit = 'm'", more)).unwrap();
    }
}
