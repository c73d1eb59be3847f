//! Solvers whose conformance properties are tested, and their results.

use crate::cli::exit::Fault;
use crate::cli::solver;
use grainbench::cases::solvers;
use grainbench::harness::solvers::Solvers;
use grainbench::harness::verdict::{ControlResult, Verdict};
use grainbench::harness::{case::Physics, conformance};
use grainbench::reports::Section;
use grainbench::solver::Solver;
use grainbench::solver::terms::Terms;
use std::sync::Arc;

/// Solver with the conformance properties that are tested.
pub(crate) type ConformingSolver = (Arc<dyn Solver>, Terms);

/// Returns the named built-in and external solvers with their conformance properties. Without names, returns all
/// built-in solvers.
pub(crate) fn conforming(named: &[String]) -> Result<Vec<ConformingSolver>, Fault> {
    let wanted = |name: &String| named.is_empty() || named.contains(name);
    let ours = solvers::with_terms().into_iter().filter(|(solver, _)| wanted(&solver.name()));
    let mut solvers: Vec<ConformingSolver> = ours.map(|(solver, terms)| (Arc::from(solver), terms)).collect();
    for path in named.iter().filter(|name| solver::is_manifest(name)) {
        let solver = solver::outside(path)?;
        let terms = solver.terms();
        solvers.push((solver, terms));
    }
    Ok(solvers)
}

/// Tests the conformance properties of a solver. Finished runs of built-in solvers may come from the cache. An external
/// solver always runs, because its name differs from every built-in name.
pub(crate) fn judge(
    (solver, terms): &ConformingSolver,
    solvers: &Arc<dyn Solvers>,
) -> (Vec<Verdict>, Vec<ControlResult>) {
    let of_cache = solvers.find(&solver.name());
    conformance::judge_with_cache(&**solver, of_cache.as_deref().unwrap_or(&**solver), terms)
}

/// Returns the report section of conformance properties without results.
pub(crate) fn section() -> Section {
    Section {
        name: "conformance".to_owned(),
        physics: Physics::Properties,
        title: "Conformance properties".to_owned(),
        claim: format!("For each method: {}.", conformance::ALL.map(|property| property.claim).join("; ")),
        derivation: "Each property is tested in its own scenes. Examples are a grain that collides with four others, \
                     with friction and without, two grains that separate, and one grain held between two walls. The \
                     same solver with an error of 10⁻⁹ must fail. A documented exception of a method is amber and \
                     states its reason. If the error exceeds the stated size, the exception is red."
            .to_owned(),
        weak: "A solver can satisfy all properties and still be wrong. For example, it may conserve momentum and be \
               symmetric but have the wrong stiffness. Grid methods run in two dimensions, with two cells per radius."
            .to_owned(),
        ..Section::default()
    }
}
