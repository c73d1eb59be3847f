//! Claims use all stored runs, which are complete and belong to the present scenes. Missing runs and programs are reported.

use crate::common::{Directory, temporary};
use grainbench::cases::registry::CASES;
use grainbench::cases::stored;
use grainbench::cases::uncertainty::{self, StoredEstimates};
use grainbench::harness::claim::Claim;
use grainbench::harness::run::ExpectedOutcome;
use grainbench::harness::tolerance::ToleranceOrigin;
use grainbench::reference::deck::Program;
use grainbench::reference::stored::{StoredRun, folder};
use grainbench::solver::failure::RunError;
use std::collections::BTreeSet;

#[test]
fn every_run_that_gates_read_is_stored_and_no_other() {
    for program in Program::ALL {
        let wanted: BTreeSet<String> = stored::all()
            .into_iter()
            .filter(|stored_run| stored_run.program == program)
            .map(|stored_run| stored_run.id)
            .collect();
        let there: BTreeSet<String> = std::fs::read_dir(folder(program, ""))
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        assert_eq!(there, wanted, "grainbench reference build makes what is missing");
    }
}

/// Each claim with an estimated tolerance has a stored estimate, and each stored estimate belongs to a claim.
#[test]
fn every_estimate_is_of_a_row_and_every_such_row_has_one() {
    for case in CASES {
        let claims: Vec<Claim> =
            (case.claims)().into_iter().filter(|claim| claim.tolerance.made == ToleranceOrigin::Estimated).collect();
        for claim in &claims {
            let found = uncertainty::find(case, claim);
            assert!(found.is_some(), "{} · {}: grainbench reference uncertainty makes it", case.name, claim.quantity);
        }
        let stored = std::fs::read_to_string(uncertainty::file(case.name)).unwrap_or_default();
        let stored: StoredEstimates = toml::from_str(&stored).unwrap_or_default();
        assert_eq!(stored.estimate.len(), claims.len(), "{}", case.name);
    }
}

/// A known error needs an upper limit. Without it, any larger error would be accepted.
#[test]
fn every_known_error_has_a_second_bound() {
    for case in CASES {
        for claim in (case.claims)() {
            if matches!(claim.standing(), ExpectedOutcome::Known(_)) {
                let bound = claim.runs[0].known_up_to;
                assert!(bound.is_finite() && bound > 0.0, "{} · {}: {bound}", case.name, claim.quantity);
            }
        }
    }
}

/// Each stored run belongs to the present scene. With a changed scene, it is rejected.
#[test]
fn none_is_stale_and_another_scene_is() {
    for stored_run in stored::all() {
        let stored = StoredRun::load(&folder(stored_run.program, &stored_run.id)).unwrap();
        let mut scene = stored_run.scene().unwrap();
        stored
            .record(&scene, &stored_run.run.resolution, stored_run.program)
            .unwrap_or_else(|error| panic!("{}: {error}", stored_run.id));
        scene.change_laws(|law| law.friction += 0.01);
        let refused = stored.record(&scene, &stored_run.run.resolution, stored_run.program);
        assert!(matches!(refused, Err(RunError::Stale { .. })), "{}", stored_run.id);
    }
}

/// Half the time step changes the displacement in the stored runs on inclined planes by less than 0.1 % of the final
/// value. This difference is their numerical uncertainty.
#[test]
fn the_time_step_is_worth_little_where_it_is_small() {
    for stored_run in
        stored::all().iter().filter(|stored_run| stored_run.id.starts_with("incline") && stored_run.id.ends_with("0.5"))
    {
        let (stored, scene) =
            (StoredRun::load(&folder(stored_run.program, &stored_run.id)).unwrap(), stored_run.scene().unwrap());
        let (run, half_step) = (stored.series(&scene), stored.half_step(&scene));
        let (x, half) = (run.column("grain.x").unwrap(), half_step.column("grain.x").unwrap());
        let worst = x.iter().zip(half).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-3 * x.last().unwrap() && worst > 0.0, "{}: {worst}", stored_run.id);
    }
}

#[test]
fn without_the_programs_stored_runs_judge_and_verify_reports_them_missing() {
    let directory = temporary();
    let without = |arguments: &str| directory.run_alone(arguments).judged();
    let (code, rows) = without("run collision --solver lammps --solver liggghts --json");
    assert_eq!(code, Some(0));
    assert!(rows.len() == 10 && rows.iter().all(|row| row["verdict"] == "pass"), "{rows:?}");
    assert!(rows.iter().all(|row| row["source"].as_str().unwrap().contains("stored run of 20")), "{rows:?}");

    let (code, rows) = without("reference verify collision-gamma-zeta.1 --json");
    assert_eq!(code, Some(1), "nothing was judged");
    assert!(rows.len() == 2 && rows.iter().all(|row| row["verdict"] == "not-available"), "{rows:?}");
}
