//! Snapshots that need not be stored are reduced to a summary and use no memory.

use crate::common::{Directory, scene, temporary};
use crate::observer::RunObserver;
use grainbench::cases::solvers;
use grainbench::solver::brief::Brief;
use grainbench::solver::observer::RunOptions;
use grainbench::solver::record::Series;
use grainbench::solver::resolution::Resolution;
use std::path::Path;

/// Discs on a floor that overlap, slip and rotate. A group on top has prescribed motion.
const DISCS: &str = include_str!("../scenes/sliding-discs.toml");

/// Two colliding elastic discs.
const SOFT: &str = include_str!("../scenes/soft-discs.toml");

fn taken(solver: &str, text: &str, most_rows: u64, threads: usize) -> (Series, RunObserver) {
    let mut observer =
        RunObserver::new(RunOptions { threads, most_rows, keep_snapshots: false, ..RunOptions::DEFAULT });
    let resolution = match solver {
        "mpm" => Resolution::Grid { cells: 6.0, points: 2, courant: 0.4 },
        _ => Resolution::CriticalFraction(0.1),
    };
    let record = solvers::by_name(solver).unwrap().run(&scene(text), &resolution, &mut observer).unwrap();
    (record.series, observer)
}

/// A summary equals the one computed from the whole snapshot, with and without probes. The series has the same bits.
#[test]
fn the_summary_equals_the_snapshot() {
    for (solver, scene) in [("dem", DISCS), ("mpm", SOFT)] {
        for probes in ["", "[probes]\nall.system = true\n", "[probes]\nall.system = true\np.contact = ['a', 'b']\n"] {
            let text = format!("{scene}{probes}");
            let (series, all) = taken(solver, &text, u64::MAX, 1);
            assert!(all.briefs.is_empty() && all.snapshots.len() == 4, "{solver}: {} snapshots", all.snapshots.len());
            for threads in [1, 2] {
                let (same, none) = taken(solver, &text, 20, threads);
                assert_eq!(format!("{same:?}"), format!("{series:?}"), "{solver} {probes}");
                assert!(none.snapshots.is_empty());
                let summaries: Vec<&Brief> = none.briefs.iter().map(|(brief, _)| brief).collect();
                let expected: Vec<Brief> = all.snapshots.iter().map(Brief::from_snapshot).collect();
                assert_eq!(summaries, expected.iter().collect::<Vec<_>>(), "{solver} {probes}");
                assert!(expected.iter().any(|brief| brief.contacts > Some(0)), "some touch");
                for ((_, rows), snapshot) in none.briefs.iter().zip(&all.snapshots) {
                    let contacts = if solver == "dem" { snapshot.told_contacts().len() } else { 0 };
                    assert_eq!(*rows, (snapshot.grains.len() + snapshot.points.len() + contacts) as u64);
                }
            }
        }
    }
    let slipping = |brief: &Brief| brief.slipping_contacts > Some(0) && brief.slipping_contacts < brief.contacts;
    assert!(taken("dem", DISCS, 20, 1).1.briefs.iter().any(|(brief, _)| slipping(brief)), "some slip and some do not");
}

/// Grains that are close but not in contact give no contact rows, not even at the start.
#[test]
fn what_is_near_and_does_not_touch_is_no_row() {
    let apart = "title = 'apart'\ndimension = 2\nduration_cycles = 6\nmaterials.m.density = 2500.0\n\
        contacts.m = { between = ['m', 'm'], normal_stiffness = 1.0e6 }\n\
        [grains.g]\nmaterial = 'm'\nradius = 0.05\n\
        lattice = { origin = [0.05, 0.05], spacing = [0.1001, 0.1001], count = [20, 20] }\n[output]\nevery_cycles = 3\n";
    let (_, all) = taken("dem", apart, 450, 1);
    assert_eq!((all.snapshots.len(), all.briefs.len()), (2, 0));
    let (_, none) = taken("dem", apart, 350, 1);
    assert_eq!((none.snapshots.len(), none.briefs.len()), (0, 2));
}

/// A large run that crashes stores its last state, although it would otherwise have stored only a summary.
#[test]
fn the_last_state_of_a_large_run_that_breaks_is_kept() {
    let path = temporary();
    let fall = "title = 'fall'\ndimension = 2\nduration_cycles = 6\ngravity = [0.0, -1.0e9]\n\
        materials.m.density = 2500.0\ncontacts.m = { between = ['m', 'm'], normal_stiffness = 1.0e6 }\n\
        [grains.g]\nmaterial = 'm'\nradius = 0.05\n\
        lattice = { origin = [0.05, 0.05], spacing = [0.2, 0.2], count = [460, 460] }\n[output]\nevery_cycles = 3\n";
    path.write("fall.toml", fall);
    let run = path.run("simulate fall.toml --solver dem --out out");
    assert!(run.code == Some(1) && run.err.contains("with its last state"), "{:?} {}", run.code, run.err);
    let files = crate::common::files(&path.join("out"));
    assert!(files.iter().any(|file| file.ends_with("grains.parquet")), "{files:?}");
}

/// Returns the largest memory of a run of the program (bytes).
#[cfg(target_os = "linux")]
fn memory(path: &Path, simulate: &str) -> f64 {
    1000.0 * crate::common::peak_memory(path, &format!("{simulate} --threads 1 --out out")) as f64
}

/// In `simulate`, a grain with three contacts takes at most 700 bytes, and a material point at most 350 bytes. Both
/// follow from the difference between two sizes.
#[test]
#[cfg(target_os = "linux")]
fn a_grain_takes_at_most_seven_hundred_bytes_and_a_point_half_of_that() {
    let path = temporary();
    let spheres = include_str!("../scenes/layers-of-spheres.toml");
    path.write("few.toml", spheres);
    path.write("many.toml", spheres.replace("count = [40, 40, 50]", "count = [40, 40, 150]"));
    let [few, many] = ["few.toml", "many.toml"].map(|scene| memory(&path, &format!("simulate {scene} --solver dem")));
    let grain = (many - few) / f64::from(40 * 40 * 100);
    assert!(grain > 300.0 && grain <= 700.0, "{grain} B a grain");
    let block = "title = 'block'\ndimension = 2\nduration = 0.002\nreference_length = 1.0\n\
        materials.m = { density = 1.0, young_modulus = 1.0, poisson_ratio = 0.3 }\n\
        [bodies.b]\nmaterial = 'm'\nbox = { low = [0.0, 0.0], high = [1.0, 1.0] }\nstretch = [0.02, -0.02]\n\
        [output]\nevery = 0.002\n";
    path.write("block.toml", block);
    let [few, many] = ["160", "240"]
        .map(|cells| memory(&path, &format!("simulate block.toml --solver mpm --cells {cells} --points 3")));
    let point = (many - few) / f64::from(9 * (240 * 240 - 160 * 160));
    assert!(point > 150.0 && point <= 350.0, "{point} B a point");
}
