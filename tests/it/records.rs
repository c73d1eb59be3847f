//! Options of snapshots: columns, digits, and stress averaged between snapshots.

use crate::common::{self, Directory, temporary_with};
use crate::observer::RunObserver;
use grainbench::cases::solvers;
use grainbench::reports::each_snapshot;
use grainbench::scene::nalgebra::{Matrix3, Vector3};
use grainbench::scene::scene::Scene;
use grainbench::solver::checkpoint::Checkpoint;
use grainbench::solver::record::{GrainState, Partner, Record, Snapshot};
use grainbench::solver::resolution::Resolution;

/// 1200 colliding spheres of two sizes between two walls and a periodic boundary.
const SCENE: &str = include_str!("../scenes/falling.toml");

fn scene(output: &str) -> Scene {
    common::scene(&format!("{SCENE}{output}\n"))
}

const STEP: Resolution = Resolution::CriticalFraction(0.05);

fn run(scene: &Scene, threads: usize) -> (Record, Vec<Checkpoint>) {
    let mut observer = RunObserver::with_checkpoints(13, threads);
    let record = solvers::by_name("dem").unwrap().run(scene, &STEP, &mut observer).unwrap();
    (record, observer.checkpoints)
}

/// Returns volume times stress of each grain, computed from the contacts of a snapshot. `part` is the fraction of the
/// overlap by which a lever arm is shorter than the radius (0.5: it ends at the middle of the overlap).
fn virials(snapshot: &Snapshot, part: f64) -> Vec<Matrix3<f64>> {
    let mut sums = vec![Matrix3::zeros(); snapshot.grains.len()];
    for contact in snapshot.told_contacts() {
        let force = contact.shear_force - contact.normal * contact.normal_force;
        let mut add = |id: u32, side: f64| {
            let place = id as usize - 1;
            let arm = contact.normal * (snapshot.grains[place].radius - part * contact.overlap) * side;
            sums[place] += arm * (force * side).transpose();
        };
        add(contact.grain, 1.0);
        if let Partner::Grain(other) = contact.partner {
            add(other, -1.0);
        }
    }
    sums.iter().map(|sum| (sum + sum.transpose()) * 0.5).collect()
}

fn matrix([xx, yy, zz, xy, yz, zx]: [f64; 6]) -> Matrix3<f64> {
    Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz)
}

/// Returns the largest difference of a stress, divided by the largest expected stress.
fn apart(found: &[GrainState], stress: impl Fn(&GrainState) -> Option<[f64; 6]>, exact: &[Matrix3<f64>]) -> f64 {
    let scale = exact.iter().map(Matrix3::norm).fold(0.0, f64::max);
    assert!(scale > 0.0);
    let each = found.iter().zip(exact).map(|(grain, exact)| (matrix(stress(grain).unwrap()) - exact).norm());
    each.fold(0.0, f64::max) / scale
}

/// The mean over an interval equals the mean over all its steps. Another run stores the contacts of all steps for it.
#[test]
fn the_mean_over_an_interval_is_that_of_its_steps() {
    let each = run(&Scene { snapshots: 59, ..scene("") }, 1).0;
    for every in [1, 4] {
        let chosen = format!("columns = ['virial', 'mean-virial']\nmean_every_cycles = {every}");
        let (found, _) = run(&scene(&chosen), 1);
        let steps: Vec<u64> = found.snapshots.iter().map(|snapshot| snapshot.step).collect();
        assert_eq!(steps, [0, 20, 40, 60]);
        // Nothing is before the first snapshot.
        assert!(found.snapshots[0].grains.iter().all(|grain| grain.mean_virial.is_none()));
        for pair in found.snapshots.windows(2) {
            let [before, now] = pair else { panic!() };
            let snapshots: Vec<&Snapshot> = each.snapshots[before.step as usize + 1..=now.step as usize]
                .iter()
                .filter(|snapshot| snapshot.step.is_multiple_of(every))
                .collect();
            let mean = |part: f64| -> Vec<Matrix3<f64>> {
                let mut sums = vec![Matrix3::zeros(); now.grains.len()];
                snapshots
                    .iter()
                    .for_each(|one| sums.iter_mut().zip(virials(one, part)).for_each(|(sum, more)| *sum += more));
                sums.iter().map(|sum| sum / snapshots.len() as f64).collect()
            };
            assert!(apart(&now.grains, |grain| grain.mean_virial.as_deref().copied(), &mean(0.5)) < 1e-13);
            // Controls: a lever arm equal to the radius and the instantaneous stress give visible differences.
            assert!(apart(&now.grains, |grain| grain.mean_virial.as_deref().copied(), &mean(0.0)) > 1e-4);
            let instant = virials(&each.snapshots[now.step as usize], 0.5);
            assert!(apart(&now.grains, |grain| grain.virial.as_deref().copied(), &instant) < 1e-13);
            assert!(apart(&now.grains, |grain| grain.mean_virial.as_deref().copied(), &instant) > 0.05);
            // Contacts and other columns are not stored, because they are not requested.
            let bare = |grain: &GrainState| grain.force.is_none() && grain.spin.x.is_nan();
            assert!(now.contacts.is_none() && now.grains.iter().all(bare));
        }
    }
}

fn bits(record: &Record) -> String {
    format!("{:?}{:?}", record.series, record.snapshots)
}

/// Means do not depend on the number of threads, or on the checkpoint from which a run continues, also within an interval.
#[test]
fn means_are_the_same_to_the_bit_on_any_threads_and_from_any_checkpoint() {
    let scene = scene("columns = ['spin', 'mean-virial']\nmean_every_cycles = 3\ndigits = 9");
    let (whole, checkpoints) = run(&scene, 1);
    assert!(bits(&run(&scene, 2).0) == bits(&whole), "on two threads");
    let solver = solvers::by_name("dem").unwrap();
    assert_eq!(checkpoints.iter().map(Checkpoint::step).collect::<Vec<_>>(), [13, 26, 39, 52]);
    for checkpoint in &checkpoints {
        let mut observer = RunObserver::with_checkpoints(13, 2);
        let continued = solver.run_from(&scene, &STEP, Some(checkpoint), &mut observer).unwrap();
        assert!(bits(&continued) == bits(&whole), "from step {}", checkpoint.step());
    }
    // Output options do not change the run.
    let plain = run(&self::scene(""), 1).0;
    assert_eq!(plain.series, whole.series);
}

/// Files contain only the chosen columns and can be read. Numbers are rounded to the chosen digits.
#[test]
fn files_hold_what_was_chosen() {
    let path = temporary_with("all.toml", SCENE);
    path.write("some.toml", format!("{SCENE}columns = ['mean-virial']\ndigits = 7\n"));
    let mut snapshots: Vec<Vec<Snapshot>> = Vec::new();
    for (name, formats) in [("all", "parquet"), ("some", "parquet"), ("some", "dump,vtk")] {
        let file = format!("{name}.toml");
        path.ok(format!("simulate {file} --solver dem --time-step-fraction 0.05 --write {formats} --out run"));
        let mut all = Vec::new();
        each_snapshot(&path.join("run"), |error| error, &mut |snapshot| {
            all.push(snapshot);
            Ok(())
        })
        .unwrap();
        snapshots.push(all);
    }
    let size = |grain: &GrainState| grain.position.norm().max(1e-300);
    let [all, some, record] = &snapshots[..] else { panic!() };
    assert_eq!(format!("{some:?}"), format!("{record:?}"), "a record of text is equal");
    let mut worst = 0.0_f64;
    for (whole, chosen) in all.iter().zip(some) {
        assert!(chosen.contacts.is_none() && whole.contacts.is_some() && chosen.grains.len() == whole.grains.len());
        for (whole, chosen) in whole.grains.iter().zip(&chosen.grains) {
            worst = worst.max((whole.position - chosen.position).norm() / size(whole));
            assert_eq!((whole.radius, whole.mass, whole.id), (chosen.radius, chosen.mass, chosen.id));
            assert!(chosen.spin.iter().all(|spin| spin.is_nan()) && chosen.force.is_none() && chosen.virial.is_none());
            assert!(chosen.mean_virial.as_deref().is_none_or(|virial| *virial != [f64::NAN; 6]));
        }
    }
    assert!(worst > 1e-9 && worst < 1e-7, "{worst}");
    assert!(some[3].grains.iter().all(|grain| grain.mean_virial.is_some()));
    assert_ne!(all[3].grains[0].spin, Vector3::zeros());
}

/// `fields` states which stress it uses: the mean stress if present, or the instantaneous stress if requested.
#[test]
fn fields_names_the_stress_that_it_read() {
    let path = temporary_with("scene.toml", format!("{SCENE}columns = ['virial', 'mean-virial']\n"));
    path.write("bare.toml", format!("{SCENE}columns = ['spin']\n"));
    for (name, out) in [("scene.toml", "run"), ("bare.toml", "bare")] {
        path.ok(format!("simulate {name} --solver dem --time-step-fraction 0.05 --write parquet --out {out}"));
    }
    let pressure = |more: &str, run: &str| -> (String, Option<f64>) {
        let answer = path.ok(format!("fields {run} --cell 5,2.5,3.5 --fewest 1 --surface 0.01 --json {more}"));
        let summary = answer.json();
        let is_pressure = |mean: &&serde_json::Value| mean["quantity"] == "pressure";
        let found =
            summary["means"].as_array().unwrap().iter().find(is_pressure).and_then(|mean| mean["value"].as_f64());
        (summary["which_stress"].as_str().unwrap().to_owned(), found)
    };
    let (mean, of_mean) = pressure("--from 0.0001", "run");
    let (instant, of_instant) = pressure("--from 0.0001 --stress instant", "run");
    assert!(mean.contains("averaged over the time") && instant.contains("instant"), "{mean}, {instant}");
    let (of_mean, of_instant) = (of_mean.unwrap(), of_instant.unwrap());
    assert!((of_mean / of_instant - 1.0).abs() > 0.02, "{of_mean} {of_instant}");
    assert_eq!(pressure("", "run").1, Some(of_mean), "the first frame has no mean, and takes no other stress for it");
    assert_eq!(pressure("", "bare").1, None);
}
