//! Continuum fields on the command line, from our runs, from dumps of external programs, and from invalid files.

use crate::common::{Directory, scene, simulated, temporary, temporary_with};
use grainbench::fields::element::elements;
use grainbench::fields::grid::Grid;
use grainbench::scene::dimension::Dimension;
use grainbench::scene::nalgebra::{Matrix3, Vector3};
use grainbench::solver::record::{Partner, Snapshot};
use grainbench::solver::resolution::Resolution;
use std::fmt::Write;
use std::path::Path;

/// Scene of spheres that fall into a box without a lid and come to rest.
const SCENE: &str = include_str!("../scenes/spheres-in-a-box.toml");

/// Returns the snapshot of the packing at rest.
fn packing() -> Snapshot {
    let record = simulated("dem", &scene(SCENE), &Resolution::CriticalFraction(0.1));
    record.snapshots.into_iter().next_back().unwrap()
}

/// At rest, the contact forces on a grain sum to ΣF = −m g. The sum of lever arm ⊗ force over contacts between grains
/// is therefore Σ_walls x_c ⊗ F − Σ_grains x ⊗ ΣF. Both sides are computed independently. The lever arm at a wall is R
/// − δ/2 with the overlap δ. With the lever arm R, the identity would be wrong by δ/2 at each wall contact.
#[test]
fn the_stress_of_a_packing_at_rest_carries_its_weight() {
    let packing = packing();
    let grid = Grid::filling(packing.bounds, Vector3::new(1.7, 2.5, 1.1));
    let elements = elements(&packing, Dimension::Three, &grid);
    let inner: Matrix3<f64> = elements.iter().map(|element| element.stress.unwrap() * grid.volume()).sum();
    let on_walls = packing.told_contacts().iter().filter(|contact| matches!(contact.partner, Partner::Wall(_)));
    let (mut outer, mut shifted) = (Matrix3::zeros(), Matrix3::zeros());
    for contact in on_walls {
        let force = contact.shear_force - contact.normal * contact.normal_force;
        outer += contact.point * force.transpose();
        shifted += (contact.point + contact.normal * (0.5 * contact.overlap)) * force.transpose();
    }
    let of_grains: Matrix3<f64> =
        packing.grains.iter().map(|grain| grain.position * grain.force.unwrap().transpose()).sum();
    let exact = outer - of_grains;
    assert!((inner - exact).norm() < 1e-12 * exact.norm(), "{inner} {exact}");
    // Control: with the lever arm R at walls, the identity is wrong.
    assert!((inner - (shifted - of_grains)).norm() > 1e-5 * exact.norm());
    // At rest: Σ Δz F_z = −Σ m g z + Σ_walls z F_z.
    let weight: f64 = packing.grains.iter().map(|grain| -10.0 * grain.mass * grain.position.z).sum();
    let found = inner.m33 - outer.m33;
    assert!((found / weight - 1.0).abs() < 1e-6, "{found} for {weight}");
    assert!(weight < -1000.0);
}

/// Returns a dump of the grains in the form of another program, with the columns in another order.
fn dump(packing: &Snapshot) -> String {
    let mut text = String::new();
    let (low, high) = packing.bounds;
    let _ = writeln!(text, "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n{}", packing.grains.len());
    let _ = writeln!(text, "ITEM: BOX BOUNDS ff ff ff");
    (0..3).for_each(|axis| writeln!(text, "{} {}", low[axis], high[axis]).unwrap());
    let _ = writeln!(text, "ITEM: ATOMS id vx vy vz x y z radius density");
    for grain in packing.grains.iter().rev() {
        let (v, x) = (grain.velocity, grain.position);
        let _ = writeln!(text, "{} {:?} {:?} {:?} {:?} {:?} {:?} 0.5 1.0", grain.id, v.x, v.y, v.z, x.x, x.y, x.z);
    }
    text
}

/// Returns a dump of the contacts with separate normal and tangential parts. Forces are given for the second grain of each pair.
fn contacts(packing: &Snapshot) -> String {
    let between: Vec<_> =
        packing.told_contacts().iter().filter(|contact| matches!(contact.partner, Partner::Grain(_))).collect();
    let mut text = format!("ITEM: TIMESTEP\n7\nITEM: NUMBER OF ENTRIES\n{}\n", between.len());
    text += "ITEM: BOX BOUNDS ff ff ff\n0 5\n0 5\n0 10\nITEM: ENTRIES a b nx ny nz tx ty tz\n";
    for contact in between {
        let Partner::Grain(other) = contact.partner else { continue };
        let (n, t) = (contact.normal * contact.normal_force, -contact.shear_force);
        let _ = writeln!(text, "{other} {} {:?} {:?} {:?} {:?} {:?} {:?}", contact.grain, n.x, n.y, n.z, t.x, t.y, t.z);
    }
    text
}

const MAP: &str = "id1=a,id2=b,force_x=nx,force_y=ny,force_z=nz,tangential_x=tx,tangential_y=ty,tangential_z=tz";

fn column(folder: &Path, file: &str, name: &str) -> Vec<Option<f64>> {
    let mut table = csv::Reader::from_path(folder.join(file)).unwrap();
    let at = table.headers().unwrap().iter().position(|head| head == name).unwrap_or_else(|| panic!("no {name}"));
    table.records().map(|row| row.unwrap()[at].parse().ok()).collect()
}

#[test]
fn a_strangers_dump_says_as_much_as_our_own_record() {
    let path = temporary();
    let packing = packing();
    path.write("grains.dump", dump(&packing));
    path.write("contacts.dump", contacts(&packing));
    let cells = "--cell 1.25,2.5,1.25 --fewest 1";
    path.ok(format!("fields grains.dump --contacts contacts.dump --map {MAP} --out told {cells}"));
    let untold = path.run(format!("fields grains.dump --out untold {cells}"));
    assert!(untold.out.contains("No contacts were recorded, so there is no stress."), "{}", untold.out);

    // Expected values: the fields from the library without wall contacts, which the dump does not contain.
    let mut alone = packing;
    alone.contacts.as_mut().unwrap().retain(|contact| matches!(contact.partner, Partner::Grain(_)));
    let grid = Grid::filling(alone.bounds, Vector3::new(1.25, 2.5, 1.25));
    let exact = elements(&alone, Dimension::Three, &grid);
    let same = |file: &str, name: &str, value: &dyn Fn(usize) -> Option<f64>| {
        let found = column(&path.join(file), "elements.csv", name);
        assert_eq!(found.len(), grid.cells());
        for (cell, found) in found.into_iter().enumerate() {
            match (found, value(cell)) {
                (None, None) => {}
                (Some(found), Some(exact)) => {
                    assert!(
                        (found - exact).abs() < 1e-9 * (1.0 + exact.abs()),
                        "{name} of {cell}: {found} for {exact}"
                    );
                }
                other => panic!("{name} of {cell}: {other:?}"),
            }
        }
    };
    for file in ["told", "untold"] {
        same(file, "packing_fraction (1)", &|cell| Some(exact[cell].packing_fraction));
        same(file, "members (1)", &|cell| Some(exact[cell].motion.members as f64));
    }
    same("told", "stress_zz (Pa)", &|cell| exact[cell].stress.map(|stress| stress.m33));
    same("told", "sine_of_friction (1)", &|cell| exact[cell].sine_of_friction());
    // If the contacts are unknown, the stress is missing and not zero.
    same("untold", "stress_zz (Pa)", &|_| None);
    same("untold", "pressure (Pa)", &|_| None);
    let image = path.read("untold/elements/elements-000000.vti");
    assert!(image.contains("Name=\"pressure\" format=\"ascii\">\nnan\n"), "an undefined pressure is written as NaN");
}

/// A dump without velocities and times gives packing fraction and stress, but no motion. Its step number serves as time.
#[test]
fn what_a_dump_does_not_tell_is_nowhere() {
    let path = temporary();
    let packing = packing();
    let still = |text: String, step: &str| text.replace("vx vy vz", "p q r").replace("TIMESTEP\n7", step);
    let steps = ["TIMESTEP\n7", "TIMESTEP\n9"];
    path.write("still.dump", steps.map(|step| still(dump(&packing), step)).concat());
    path.write("contacts.dump", steps.map(|step| still(contacts(&packing), step)).concat());
    let options = "--cell 2.5,5,2.5 --fewest 1 --flowing 0.1 --out out";
    path.ok(format!("fields still.dump --contacts contacts.dump --map {MAP} {options}"));
    let known = |name: &str| column(&path.join("out"), "elements.csv", name).iter().flatten().count();
    for name in ["speed (m/s)", "shear_rate (1/s)", "residual_velocity (m/s)", "angle_of_largest (deg)", "time (s)"] {
        assert_eq!(known(name), 0, "{name}");
    }
    assert!(known("packing_fraction (1)") == 16 && known("pressure (Pa)") == 16);
    let table = path.read("out/elements.csv");
    assert!(table.lines().skip(1).all(|row| row.contains("still")), "what has no rate of shear does not flow");
    let clock = path.read("out/elements/elements.pvd");
    assert!(!clock.contains("NaN") && clock.contains("\"9.0\"") || clock.contains("\"9\""), "{clock}");
}

#[test]
fn a_run_of_ours_becomes_tables_images_films_and_trails() {
    let path = temporary_with("scene.toml", SCENE);
    path.ok("simulate scene.toml --solver dem --write parquet --out run");
    path.ok("fields run --cell 1.25,5,1.25 --tracers 2.5,5,2.5 --out seen");
    for file in ["elements.csv", "means.csv", "tracers.csv", "summary.json", "index.html", "elements/elements.pvd"] {
        assert!(path.join("seen").join(file).is_file(), "{file}");
    }
    assert_eq!(column(&path.join("seen"), "elements.csv", "time (s)").len(), 5 * 4 * 8);
    assert_eq!(column(&path.join("seen"), "means.csv", "x (m)").len(), 4 * 8);
    let strains = column(&path.join("seen"), "tracers.csv", "hencky_strain (1)");
    assert!(strains.iter().flatten().any(|&strain| strain > 0.05) && strains[0].is_some_and(|strain| strain < 1e-12));
    // A repeated command writes the same file.
    path.ok("fields run --cell 1.25,5,1.25 --tracers 2.5,5,2.5 --out again");
    let bytes = |folder: &str| std::fs::read(path.join(folder).join("elements.csv")).unwrap();
    assert!(bytes("seen") == bytes("again"));
}

/// Grains outside the cells are counted and reported. An option gives the radius if the file lacks it.
#[test]
fn grains_outside_are_counted() {
    let path = temporary();
    let packing = packing();
    path.write("bare.dump", dump(&packing).replace("radius", "colour"));
    let high = packing.grains.iter().filter(|grain| grain.position.z >= 2.0).count();
    let answer = path.ok("fields bare.dump --radius 0.5 --cell 2.5,2.5,1 --low 0,0,0 --high 5,5,2 --json");
    let summary = answer.json();
    assert_eq!(summary["outside"], high);
    assert_eq!(summary["cells"], serde_json::json!([2, 2, 2]));
    assert_eq!(summary["stress"], false);
}
