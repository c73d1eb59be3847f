//! Forces in output files, compared with hand calculations. The tests check the grain on which a force acts, its
//! direction, and the nearest image across a periodic boundary.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};

use grainbench_reference::observer::{DumpRecord, Names};
use grainbench_reference::outputs::{Outputs, Sources};
use grainbench_scene::scene::Scene;
use grainbench_scene::source::SceneSource;

fn scene(text: &str) -> Scene {
    let text = format!(
        "title = 'forces'\nduration = 1.0\nmaterials.m.density = 1.0\n\
         contacts.m = {{ between = ['m', 'm'], normal_stiffness = 1.0e3, tangential_stiffness = 1.0e3, friction = 0.5 }}\n{text}"
    );
    SceneSource::from_text("test", Path::new("../cases/mesh-seam"), &text)
        .scene(&grainbench_scene::resolve::no_data_file)
        .unwrap()
}

/// Returns the quantities of a scene from files with the given texts. `names` are pairs of our column names and the
/// names in the files.
fn observed(scene: &Scene, texts: &[String], names: &[(&str, &str)]) -> DumpRecord {
    let directory = tempfile::tempdir().unwrap();
    let file = |(number, text): (usize, &String)| -> PathBuf {
        let path = directory.path().join(format!("{number}.csv"));
        std::fs::write(&path, text).unwrap();
        path
    };
    let names = Names(names.iter().map(|&(ours, theirs)| (ours.to_owned(), theirs.to_owned())).collect());
    let files = texts.iter().enumerate().map(file).collect();
    let sources = Sources { files, names, time_step: Some(0.5), ..Sources::default() };
    Outputs::survey(sources).unwrap().observe(scene).unwrap()
}

/// Returns a dump with one snapshot of `what` (`ATOMS` or `ENTRIES`).
fn dump(what: &str, columns: &str, rows: &[&str]) -> String {
    format!(
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF {what}\n{}\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 10\n-0.5 0.5\n\
         ITEM: {what} {columns}\n{}\n",
        rows.len(),
        rows.join("\n")
    )
}

/// Returns the only sample of a column.
fn value(observed: &DumpRecord, name: &str) -> f64 {
    observed.series.column(name).unwrap()[0]
}

fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-12 * (1.0 + expected.abs()), "{found} for {expected}");
}

/// Two discs of radius 0.51 m are in contact across the corner of two periodic axes. Disc a is at (0.1, 0.2) m, and the
/// image of b at (−0.5, −0.6) m. Their distance is 1 m along e = (−0.6, −0.8), so the overlap is 0.02 m.
///
/// A normal force of 100 N on a is −100 e N = (60, 80) N. A tangential force of 7 N along t = (e_y, −e_x) = (−0.8,
/// 0.6), clockwise from e, is (−5.6, 4.2) N. The force on a is (54.4, 84.2) N, and the force on b is opposite. In two
/// dimensions, the sign of the shear force is the same for both discs.
#[test]
fn pair_forces_act_on_the_first_along_the_nearest_image() {
    let scene = scene(
        "dimension = 2\ndomain = { low = [0.0, 0.0], high = [10.0, 10.0], periodic = [true, true] }\n\
         [grains.a]\nmaterial = 'm'\nradius = 0.51\nposition = [0.1, 0.2]\n\
         [grains.b]\nmaterial = 'm'\nradius = 0.51\nposition = [9.5, 9.4]\n\
         [probes]\nab.contact = ['a', 'b']\nba.contact = ['b', 'a']\n",
    );
    let grains = dump("ATOMS", "id x y", &["2 9.5 9.4", "1 0.1 0.2"]);
    let names = [("id1", "i"), ("id2", "j"), ("force_x", "fx"), ("force_y", "fy")];
    let parts = [names.as_slice(), &[("tangential_x", "tx"), ("tangential_y", "ty")]].concat();
    for (columns, row, names) in [
        ("i j fx fy", "1 2 54.4 84.2", &names[..]),
        ("i j fx fy", "2 1 -54.4 -84.2", &names),
        ("fy j fx i", "84.2 2 54.4 1", &names),
        ("i j fx fy tx ty", "1 2 60 80 -5.6 4.2", &parts),
        ("i j tx ty fx fy", "2 1 5.6 -4.2 -60 -80", &parts),
    ] {
        let observed = observed(&scene, &[dump("ENTRIES", columns, &[row]), grains.clone()], names);
        for contact in ["ab", "ba"] {
            close(value(&observed, &format!("{contact}.overlap")), 0.02);
            close(value(&observed, &format!("{contact}.normal_force")), 100.0);
            close(value(&observed, &format!("{contact}.shear_force")), 7.0);
        }
        assert!(observed.snapshots[0].contacts.is_none(), "what a probe asks for is not all that there is");
    }
    // Each force component has an uncertainty of 0.05 N, half a unit of its last digit. Positions are exact.
    let exact = dump(
        "ATOMS",
        "id x y",
        &["1 1.0000000000000000e-01 2.0000000000000000e-01", "2 9.5000000000000000e+00 9.4000000000000000e+00"],
    );
    let printed = observed(&scene, &[dump("ENTRIES", "i j fx fy", &["1 2 54.4 84.2"]), exact], &names);
    for name in ["ab.normal_force", "ab.shear_force"] {
        let at = printed.series.columns.iter().position(|column| column.name == name).unwrap();
        close(printed.uncertainty[at][0], 0.1);
    }
    // An attractive normal force is negative.
    let pulled = observed(&scene, &[dump("ENTRIES", "i j fx fy", &["1 2 -6 -8"]), grains], &names);
    close(value(&pulled, "ab.normal_force"), -10.0);
}

/// A disc of radius 0.5 m overlaps by 0.01 m with a plane of normal (0.6, 0.8). The direction e = (−0.6, −0.8) points
/// from the disc to the plane.
///
/// A normal force of 50 N on the disc is (30, 40) N. A tangential force of 3 N along t = (−0.8, 0.6) is (−2.4, 1.8) N.
/// The force on the plane is minus the sum of the forces on both discs.
#[test]
fn wall_forces_act_on_the_grain_and_the_wall_feels_the_opposite() {
    let scene = scene(
        "dimension = 2\n[grains.a]\nmaterial = 'm'\nradius = 0.5\nposition = [0.294, 0.392]\n\
         [grains.b]\nmaterial = 'm'\nradius = 0.5\nposition = [-1.306, 1.592]\n\
         [walls.slope]\nmaterial = 'm'\nplane = { point = [0.0, 0.0], normal = [0.6, 0.8] }\n\
         [probes]\nc.contact = ['a', 'slope']\nslope.wall = 'slope'\n",
    );
    let columns = [("slope.force_x", "f_w[1]"), ("slope.force_y", "f_w[2]")];
    let grains = dump("ATOMS", "id x y f_w[1] f_w[2]", &["1 0.294 0.392 27.6 41.8", "2 -1.306 1.592 6 8"]);
    let observed = observed(&scene, &[grains], &columns);
    close(value(&observed, "c.overlap"), 0.01);
    close(value(&observed, "c.normal_force"), 50.0);
    close(value(&observed, "c.shear_force"), 3.0);
    close(value(&observed, "slope.force_x"), -33.6);
    close(value(&observed, "slope.force_y"), -49.8);
}

/// A disc of radius 0.5 m is in contact with the end of a segment. Its centre at (0.294, 0.392) m is 0.49 m from the
/// end at the origin, so the overlap is 0.01 m along (−0.6, −0.8). A normal force of 50 N on the disc is (30, 40) N.
#[test]
fn the_end_of_a_segment_is_the_nearest_point() {
    let scene = scene(
        "dimension = 2\n[grains.a]\nmaterial = 'm'\nradius = 0.5\nposition = [0.294, 0.392]\n\
         [walls.w]\nmaterial = 'm'\nsegment = [[-1.0, 0.0], [0.0, 0.0]]\n[probes]\nc.contact = ['a', 'w']\n",
    );
    let columns = [("w.force_x", "f_w[1]"), ("w.force_y", "f_w[2]")];
    let grains = dump("ATOMS", "id x y f_w[1] f_w[2]", &["1 0.294 0.392 30 40"]);
    let observed = observed(&scene, &[grains], &columns);
    close(value(&observed, "c.overlap"), 0.01);
    close(value(&observed, "c.normal_force"), 50.0);
    close(value(&observed, "c.shear_force"), 0.0);
}

/// A sphere of radius 0.51 m overlaps by 0.01 m with the upper face of the cube [0, 1]³ m. The force on it is 50 N along
/// the normal and 5 N along (3, 4, 0)/5.
#[test]
fn a_contact_with_a_mesh_is_at_its_nearest_point() {
    let scene = scene(
        "dimension = 3\n[grains.a]\nmaterial = 'm'\nradius = 0.51\nposition = [0.4, 0.7, 1.5]\n\
         [walls.w]\nmaterial = 'm'\nmesh = { file = 'cube.stl', unit = 'm' }\n[probes]\nc.contact = ['a', 'w']\n",
    );
    let columns = ["x", "y", "z"].map(|axis| (format!("w.force_{axis}"), format!("f_w[{axis}]")));
    let columns: Vec<(&str, &str)> = columns.iter().map(|(ours, theirs)| (ours.as_str(), theirs.as_str())).collect();
    let grains = dump("ATOMS", "id x y z f_w[x] f_w[y] f_w[z]", &["1 0.4 0.7 1.5 3 4 50"]);
    let observed = observed(&scene, &[grains], &columns);
    close(value(&observed, "c.overlap"), 0.01);
    close(value(&observed, "c.normal_force"), 50.0);
    close(value(&observed, "c.shear_force"), 5.0);
}

/// A wall rises with 0.1 m/s during the first of two steps of 0.5 s, so it ends at 0.05 m. A disc of radius 0.5 m at
/// 0.54 m then overlaps with it by 0.01 m.
#[test]
fn a_wall_moves_until_the_cycle_at_which_its_motion_stops() {
    let scene = scene(
        "dimension = 2\n[grains.a]\nmaterial = 'm'\nradius = 0.5\nposition = [0.0, 0.54]\n\
         [walls.w]\nmaterial = 'm'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n\
         motion = [{ velocity = [0.0, 0.1], stop_cycle = 1 }]\n[probes]\nc.contact = ['a', 'w']\n",
    );
    let columns = [("w.force_x", "f_w[1]"), ("w.force_y", "f_w[2]")];
    let start = dump("ATOMS", "id x y f_w[1] f_w[2]", &["1 0 0.54 0 0"]);
    let end = dump("ATOMS", "id x y f_w[1] f_w[2]", &["1 0 0.54 0 10"]).replace("TIMESTEP\n0", "TIMESTEP\n2");
    let observed = observed(&scene, &[start + &end], &columns);
    close(*observed.series.column("c.overlap").unwrap().last().unwrap(), 0.01);
    close(observed.snapshots.last().unwrap().walls[0].corners[0].y, 0.05);
}

/// Two spheres of radius 0.51 m in three dimensions are 1 m apart along (2, 3, 6)/7. A normal force of 70 N on the
/// first is −(20, 30, 60) N.
///
/// The shear force is 5 N along (−6, 0, 2)/√40. Only its magnitude is checked, because it has no sign in three
/// dimensions.
#[test]
fn pair_forces_in_space_have_a_push_and_a_size() {
    let (x, y, z) = (2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0);
    let scene = scene(&format!(
        "dimension = 3\n[grains.a]\nmaterial = 'm'\nradius = 0.51\nposition = [0.0, 0.0, 0.0]\n\
         [grains.b]\nmaterial = 'm'\nradius = 0.51\nposition = [{x}, {y}, {z}]\n[probes]\nc.contact = ['a', 'b']\n"
    ));
    let along = 5.0 / 40.0_f64.sqrt();
    let grains = dump("ATOMS", "id x y z", &["1 0 0 0", &format!("2 {x} {y} {z}")]);
    let row = format!("2 1 {} 30 {}", 20.0 + 6.0 * along, 60.0 - 2.0 * along);
    let names = [("id1", "i"), ("id2", "j"), ("force_x", "fx"), ("force_y", "fy"), ("force_z", "fz")];
    let observed = observed(&scene, &[dump("ENTRIES", "i j fx fy fz", &[&row]), grains], &names);
    close(value(&observed, "c.overlap"), 0.02);
    close(value(&observed, "c.normal_force"), 70.0);
    close(value(&observed, "c.shear_force"), 5.0);
}

/// Forces in a table have the same signs as in our series. They are kept, whatever the name of their column.
#[test]
fn tables_have_forces_as_series_have_them() {
    let scene = scene(
        "dimension = 2\n[grains.a]\nmaterial = 'm'\nradius = 0.5\nposition = [0.0, 0.49]\n\
         [walls.w]\nmaterial = 'm'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n\
         [probes]\nc.contact = ['a', 'w']\nw.wall = 'w'\n",
    );
    let text = "time,push,c.shear_force,w.force_x,force_y\n0.0,12.5,-3.25,3.25,-12.5\n0.5,1.5,0.5,-0.5,-1.5\n";
    let observed = observed(&scene, &[text.to_owned()], &[("c.normal_force", "push")]);
    for (name, values) in [
        ("c.normal_force", [12.5, 1.5]),
        ("c.shear_force", [-3.25, 0.5]),
        ("w.force_x", [3.25, -0.5]),
        ("w.force_y", [-12.5, -1.5]),
    ] {
        assert_eq!(observed.series.column(name).unwrap(), values, "{name}");
    }
}
