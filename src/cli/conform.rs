//! `grainbench conform`: tests the conformance properties that every solver must satisfy.

use super::cache;
use super::cores::{at_once, share};
use super::exit::{Fault, Outcome, check_writable, print};
use super::provenance::provenance;
use super::run::{add_reasons, exit_code, says_nothing};
use super::solver;
use grainbench::cases::solvers;
use grainbench::harness::conformance;
use grainbench::harness::verdict::{Control, Verdict};
use grainbench::reports::measured::Measurements;
use grainbench::reports::results::results_json;
use grainbench::reports::{Report, Section, summary_table, write_report};
use grainbench::scene::solver::Solver;
use grainbench::scene::terms::Terms;
use grainbench::studies::run_cache::RunCache;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};
use std::time::Instant;

/// Arguments of the command.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Solvers, by name or manifest; all built-in solvers by default.
    #[arg(value_name = "NAME|SOLVER.toml")]
    solver: Vec<String>,
    /// Treat amber results as red.
    #[arg(long)]
    strict: bool,
    /// Directory for the report.
    #[arg(long, value_name = "DIR", default_value = "grainbench-out")]
    out: PathBuf,
    /// Print the results as JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// Tests the solvers and writes the report.
pub(crate) fn conform(arguments: &Arguments) -> Outcome {
    let start = Instant::now();
    check_writable(&arguments.out)?;
    let section = section(&arguments.solver, None)?;
    let section = section.ok_or_else(|| {
        let names: Vec<String> = solvers::with_terms().iter().map(|(solver, _)| solver.name()).collect();
        let expected = "the path of a manifest (`SOLVER.toml`) or a built-in solver";
        Fault::unknown(expected, &arguments.solver.join(", "), names.iter().map(String::as_str))
    })?;
    let mut words = vec!["conform".to_owned()];
    words.extend(arguments.solver.iter().cloned());
    let mut report = Report {
        provenance: provenance(words, start.elapsed().as_secs_f64()),
        sections: vec![section],
        judged: Vec::new(),
        shown: Vec::new(),
        measured: Measurements::default(),
        red_because: Vec::new(),
    };
    let is_mute = says_nothing(&report);
    add_reasons(&mut report, is_mute, arguments.strict);
    write_report(&arguments.out, &report).map_err(Fault::writing)?;
    if arguments.json {
        print(&results_json(&report).map_err(Fault::input)?)?;
    } else {
        print(&format!("{}\n{}\n", summary_table(&report), arguments.out.join("index.html").display()))?;
    }
    Ok(exit_code(&report, arguments.strict))
}

/// Solver with the terms of its conformance.
pub(crate) type SolverWithTerms = (Arc<dyn Solver>, Terms);

/// Returns the named solvers and external solvers with their terms; all our solvers if none is named.
pub(crate) fn owing(named: &[String]) -> Result<Vec<SolverWithTerms>, Fault> {
    let wanted = |name: &String| named.is_empty() || named.contains(name);
    let ours = solvers::with_terms().into_iter().filter(|(solver, _)| wanted(&solver.name()));
    let mut solvers: Vec<SolverWithTerms> = ours.map(|(solver, terms)| (Arc::from(solver), terms)).collect();
    for path in named.iter().filter(|name| solver::is_manifest(name)) {
        let outside = solver::outside(path)?;
        let terms = outside.terms();
        solvers.push((outside, terms));
    }
    Ok(solvers)
}

/// Tests the conformance of the named solvers; of all our solvers if none is named. Finished runs of our solvers come
/// from the cache if there is one. Returns `None` if no solver matches.
pub(crate) fn section(named: &[String], cache: Option<&Arc<RunCache>>) -> Result<Option<Section>, Fault> {
    let solvers = owing(named)?;
    let ours = solvers.len() - named.iter().filter(|name| solver::is_manifest(name)).count();
    let judged: Vec<_> = solvers.iter().map(|_| OnceLock::new()).collect();
    let kept = cache::solvers(cache);
    share(
        solvers.len(),
        at_once(1),
        || true,
        |number| {
            let (solver, terms) = &solvers[number];
            // An external solver may have the name of one of our solvers.
            let of_cache = if number < ours { kept.find(&solver.name()) } else { None };
            let of_cache = of_cache.as_ref().unwrap_or(solver);
            judged[number].get_or_init(|| conformance::judge_kept(&**solver, &**of_cache, terms));
        },
    );
    let (verdicts, controls): (Vec<_>, Vec<_>) = judged.into_iter().filter_map(OnceLock::into_inner).unzip();
    Ok((!solvers.is_empty()).then(|| section_of(verdicts.concat(), controls.concat())))
}

/// Returns the section of some conformance results.
pub(crate) fn section_of(verdicts: Vec<Verdict>, controls: Vec<Control>) -> Section {
    Section {
        name: "conformance".to_owned(),
        title: "Conformance properties".to_owned(),
        claim: format!("For every method: {}.", conformance::ALL.map(|property| property.claim).join("; ")),
        derivation: "Each property is tested in its own scenes: a grain that collides with four others, with friction \
                     and without; two grains that separate; one grain held between two walls. The same solver with an \
                     error of 10⁻⁹ must fail. A documented exception of a method is amber with its reason and red \
                     beyond the stated size."
            .to_owned(),
        weak:
            "A solver can satisfy all properties and still be wrong: it may conserve momentum, be symmetric and have \
               the wrong stiffness. Grid methods run in the plane, with two cells per radius."
                .to_owned(),
        figures: Vec::new(),
        verdicts,
        controls,
        runs: Vec::new(),
    }
}
