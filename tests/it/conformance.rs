//! Tests of the conformance properties with defective solvers. The solver crates test their own solvers.

use grainbench::cases::solvers;
use grainbench::harness::conformance::ALL;
use grainbench::harness::verdict::Outcome;
use grainbench::scene::scene::Scene;
use grainbench::solver::Solver;
use grainbench::solver::failure::RunError;
use grainbench::solver::observer::Observer;
use grainbench::solver::record::Record;
use grainbench::solver::resolution::Resolution;
use grainbench::solver::terms::{Order, Terms};

/// Each property detects its own flaw, and does not fail for all flaws.
#[test]
fn a_property_sees_its_own_flaw_and_not_every_other() {
    use grainbench::harness::conformance::{Flaw, FlawedSolver};
    let solver = solvers::by_name("dem").unwrap();
    let red = |flaw: Flaw| -> Vec<&str> {
        let flawed = FlawedSolver::new(&*solver, flaw);
        let is_red =
            |rows: Vec<grainbench::harness::verdict::Verdict>| rows.iter().all(|row| row.outcome == Outcome::Fail);
        ALL.iter().filter(|property| is_red(property.check(&flawed, &Terms::SECOND_ORDER))).map(|p| p.name).collect()
    };
    assert_eq!(red(Flaw::Drag), ["momentum", "galilean-invariance", "free-flight"]);
    assert_eq!(red(Flaw::Anisotropic), ["momentum", "galilean-invariance", "rotation-invariance", "free-flight"]);
    assert!(red(Flaw::Handed).contains(&"mirror-invariance") && !red(Flaw::Handed).contains(&"permutation"));
    assert!(red(Flaw::Listed).contains(&"permutation") && !red(Flaw::Listed).contains(&"mirror-invariance"));
    assert!(red(Flaw::FirstOrder).contains(&"order") && !red(Flaw::FirstOrder).contains(&"rerun"));
    assert_eq!(red(Flaw::Irreproducible), ["rerun"]);
}

/// If two results had the same name, they and their controls could be confused.
#[test]
fn every_row_has_a_unique_name() {
    let solver = solvers::by_name("dem").unwrap();
    let rows = grainbench::conform(&*solver, &Terms::SECOND_ORDER).verdicts;
    let names: std::collections::BTreeSet<_> = rows.iter().map(|row| (&row.variant, &row.quantity)).collect();
    assert_eq!(names.len(), rows.len());
}

/// A claimed order that the runs do not confirm makes the property `order` fail, and no other property.
#[test]
fn an_order_that_is_not_there_is_not_believed() {
    let solver = solvers::by_name("dem").unwrap();
    let third = Order { expected: 3.0, ..Terms::SECOND_ORDER.order.unwrap() };
    let terms = Terms { order: Some(third), ..Terms::SECOND_ORDER };
    let failures = grainbench::conform(&*solver, &terms).failures();
    assert!(!failures.is_empty() && failures.iter().all(|line| line.contains("order")), "{failures:#?}");
}

/// A solver that rejects every scene does not pass.
#[test]
fn a_solver_that_runs_nothing_does_not_pass() {
    struct IdleSolver;
    impl Solver for IdleSolver {
        fn name(&self) -> String {
            "nothing".to_owned()
        }
        fn run(&self, _: &Scene, _: &Resolution, _: &mut dyn Observer) -> Result<Record, RunError> {
            Err(RunError::Unsupported { solver: self.name(), reason: "it runs nothing".to_owned() })
        }
    }
    let refused = grainbench::conform(&IdleSolver, &Terms::at(Resolution::TimeStep(1e-4))).require().unwrap_err();
    assert!(refused.to_string().contains("nothing was judged"));
    assert!(grainbench::judge(IdleSolver, &["backspin"]).unwrap().require().is_err());
}
