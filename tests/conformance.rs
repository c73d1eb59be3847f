//! What every solver owes, of every solver of ours.

use grainbench::cases::conformance::{ALL, Order, Terms};
use grainbench::cases::solvers;
use grainbench::cases::verdict::Outcome;
use grainbench::scene::record::Record;
use grainbench::scene::scene::Scene;
use grainbench::scene::solver::{Resolution, RunError, Solver, Watch};

#[test]
fn every_discrete_element_method_conforms() {
    for solver in solvers::all().into_iter().filter(|solver| solver.name().starts_with("dem")) {
        grainbench::conform(&*solver, &Terms::SECOND_ORDER).require().unwrap();
    }
}

/// A rigid-body engine keeps linear momentum, mirrors and reruns to the bit. What it does not keep comes from its method:
/// impulses at points that are fixed for a step turn with the grains (angular momentum), contacts are solved one after
/// another (order of the list), and its tolerances are absolute (Galilean and rotation invariance to 1e-10).
#[test]
fn a_rigid_engine_owes_less_and_that_much_it_keeps() {
    let solver = solvers::by_name("rigid").unwrap();
    let terms = Terms::at(Resolution::substeps(8));
    for name in ["mirror-invariance", "rerun"] {
        let property = ALL.iter().find(|property| property.name == name).unwrap();
        let rows = property.check(&*solver, &terms);
        assert!(rows.iter().any(|row| row.outcome == Outcome::Pass), "{name} was run");
        assert!(rows.iter().all(|row| row.outcome != Outcome::Fail), "{name}: {rows:#?}");
    }
    let momentum = ALL.iter().find(|property| property.name == "momentum").unwrap().check(&*solver, &terms);
    let failed: Vec<&str> =
        momentum.iter().filter(|row| row.outcome == Outcome::Fail).map(|row| row.quantity.as_str()).collect();
    assert!(!failed.is_empty() && failed.iter().all(|quantity| quantity.contains("angular")), "{failed:?}");
}

/// Rows tell solvers apart that are nearly right, and only in what they are wrong in.
#[test]
fn a_property_sees_its_own_flaw_and_not_every_other() {
    use grainbench::cases::conformance::{Flaw, Flawed};
    let solver = solvers::by_name("dem").unwrap();
    let red = |flaw: Flaw| -> Vec<&str> {
        let flawed = Flawed::new(&*solver, flaw);
        let is_red =
            |rows: Vec<grainbench::cases::verdict::Verdict>| rows.iter().all(|row| row.outcome == Outcome::Fail);
        ALL.iter().filter(|property| is_red(property.check(&flawed, &Terms::SECOND_ORDER))).map(|p| p.name).collect()
    };
    assert_eq!(red(Flaw::Drag), ["momentum", "galilean-invariance", "free-flight"]);
    assert_eq!(red(Flaw::Anisotropic), ["momentum", "galilean-invariance", "rotation-invariance", "free-flight"]);
    assert!(red(Flaw::Handed).contains(&"mirror-invariance") && !red(Flaw::Handed).contains(&"permutation"));
    assert!(red(Flaw::Listed).contains(&"permutation") && !red(Flaw::Listed).contains(&"mirror-invariance"));
    assert!(red(Flaw::FirstOrder).contains(&"order") && !red(Flaw::FirstOrder).contains(&"rerun"));
    assert_eq!(red(Flaw::Irreproducible), ["rerun"]);
}

/// A claim that the runs do not bear out fails, and nothing else with it.
#[test]
fn an_order_that_is_not_there_is_not_believed() {
    let solver = solvers::by_name("dem").unwrap();
    let third = Order { expected: 3.0, ..Terms::SECOND_ORDER.order.unwrap() };
    let terms = Terms { order: Some(third), ..Terms::SECOND_ORDER };
    let failures = grainbench::conform(&*solver, &terms).failures();
    assert!(!failures.is_empty() && failures.iter().all(|line| line.contains("order")), "{failures:#?}");
}

/// A solver that refuses every scene has shown nothing.
#[test]
fn a_solver_that_runs_nothing_does_not_pass() {
    struct Nothing;
    impl Solver for Nothing {
        fn name(&self) -> String {
            "nothing".to_owned()
        }
        fn run(&self, _: &Scene, _: &Resolution, _: &mut dyn Watch) -> Result<Record, RunError> {
            Err(RunError::Unsupported { solver: self.name(), reason: "it runs nothing".to_owned() })
        }
    }
    let refused = grainbench::conform(&Nothing, &Terms::at(Resolution::TimeStep(1e-4))).require().unwrap_err();
    assert!(refused.to_string().contains("no row passed"));
    assert!(grainbench::judge(Nothing, &["backspin"]).unwrap().require().is_err());
}
