//! Plan of a parameter sweep.

use super::arguments::Arguments;
use super::study::{ReportOptions, Study};
use crate::cli::cache;
use crate::cli::exit::{Fault, Outcome, RED, print};
use crate::cli::provenance::provenance;
use crate::cli::publish::outcome_is_judged;
use crate::cli::solver::is_manifest;
use crate::cli::strangers::NamedSolvers;
use grainbench::campaign::finished::{FinishedTasks, TaskResult};
use grainbench::campaign::log::State;
use grainbench::campaign::plan::{Kind, Plan, hash_of_file};
use grainbench::campaign::share::share;
use grainbench::campaign::sweep::Sweep;
use grainbench::campaign::task::{Id, Task};
use grainbench::campaign::work::ResultSink;
use grainbench::harness::verdict;
use grainbench::reports::number;
use grainbench::reports::sweep::{PointOutput, QuantityResult, sweep_json, write_sweep};
use grainbench::scene::solver::Solver;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;

/// Sweep over parameters, with its solvers.
pub(crate) struct SweepStudy {
    path: String,
    sweep: Sweep,
    /// Names or manifests of the solvers, as the sweep file states them.
    asked: Vec<String>,
    /// Solver names in the results.
    names: Vec<String>,
}

impl SweepStudy {
    pub(crate) fn new(file: &str, arguments: &Arguments) -> Result<Self, Fault> {
        if !is_manifest(file) {
            return Err(Fault::unknown("`SWEEP.toml`, or a command with a plan", file, ["run", "cost", "stability"]));
        }
        arguments.only(&[])?;
        let sweep = Sweep::read(Path::new(file))?;
        let beside = Path::new(file).parent().unwrap_or(Path::new(""));
        // Paths of manifests are relative to the directory of the sweep file.
        let place = |name: String| if is_manifest(&name) { beside.join(name).display().to_string() } else { name };
        let asked: Vec<String> = sweep.solvers().into_iter().map(place).collect();
        let (_, names) = NamedSolvers::read_by_content(&asked)?;
        Ok(Self { path: file.to_owned(), sweep, asked, names })
    }

    fn solvers(&self) -> Result<NamedSolvers, Fault> {
        NamedSolvers::read_by_content(&self.asked).map(|(solvers, _)| solvers)
    }
}

impl Study for SweepStudy {
    fn kind(&self) -> Kind {
        Kind::Sweep
    }

    fn is_timed(&self) -> bool {
        self.sweep.is_timed()
    }

    fn tasks(&self, program: &str) -> Result<Vec<Task>, Fault> {
        Ok(self.sweep.tasks(program, &self.solvers()?, &self.names)?)
    }

    fn inputs(&self) -> BTreeMap<String, String> {
        let scene = self.sweep.scene_file().map(|path| path.display().to_string());
        let manifests = self.asked.iter().filter(|name| is_manifest(name)).cloned();
        // An invalid scene causes an error when the tasks are listed.
        let named = self.sweep.files().unwrap_or_default().into_iter().map(|path| path.display().to_string());
        let files = std::iter::once(self.path.clone()).chain(scene).chain(named).chain(manifests);
        let mut inputs = self.solvers().map_or_else(|_| BTreeMap::new(), |solvers| solvers.inputs());
        inputs.extend(files.map(|file| (file.clone(), hash_of_file(Path::new(&file)))));
        inputs
    }

    fn work(&self, plan: &Plan, tasks: &[&Task], jobs: usize, desk: &Arc<ResultSink>) -> Result<(), Fault> {
        // Timed tasks never use results of the cache.
        let cache = if self.is_timed() { None } else { cache::open(false) };
        let solvers = cache::with(self.solvers()?, cache.as_ref());
        let places: HashMap<Id, usize> = plan.tasks.iter().enumerate().map(|(at, task)| (task.id, at)).collect();
        let mut found: BTreeMap<&str, Arc<dyn Solver>> = BTreeMap::new();
        for (asked, name) in self.sweep.solvers().iter().zip(&self.names) {
            let solver =
                solvers.find(name).ok_or_else(|| Fault::input(format!("expected a solver, found `{name}`")))?;
            let named = tasks.iter().find(|task| task.solver == *asked);
            found.extend(named.map(|task| (task.solver.as_str(), solver)));
        }
        let do_piece = |piece: usize| {
            let task = tasks[piece];
            if let (Some(place), Some(solver)) = (places.get(&task.id), found.get(task.solver.as_str())) {
                desk.attempt(task.id, || self.sweep.run(*place, task, &**solver));
            }
        };
        share(tasks.len(), jobs, || desk.goes_on(), do_piece);
        if let Some(cache) = &cache {
            cache.make_room();
        }
        Ok(())
    }

    fn collect(&self, plan: &Plan, finished: &FinishedTasks, how: &ReportOptions<'_>) -> Outcome {
        let mut options = vec![self.path.clone()];
        options.extend(how.words.iter().cloned());
        let left = |place: usize| -> Option<PointOutput> {
            match finished.result(plan.tasks.get(place)?.id) {
                TaskResult::Nothing => None,
                TaskResult::Out(left) => Some(left),
                TaskResult::Crash(detail) => {
                    let looked =
                        QuantityResult { verdict: Some(verdict::Outcome::Broken), ..QuantityResult::default() };
                    Some(PointOutput { looked: vec![looked], detail: Some(detail), ..PointOutput::default() })
                }
            }
        };
        let report = self.sweep.report(&self.names, provenance(options, how.seconds), left);
        write_sweep(how.out, &report).map_err(Fault::writing)?;
        let [within, outside, amber, unjudged] = report.counts();
        if how.json {
            print(&sweep_json(&report).map_err(Fault::input)?)?;
        } else {
            let [w, o, a, u] = [within, outside, amber, unjudged].map(|count| number::count(count as u64));
            let unjudged = if unjudged > 0 { format!(", {u} not judged") } else { String::new() };
            let page = how.out.join("index.html");
            print(&format!("{w} within, {o} outside or broken, {a} amber{unjudged}\n{}\n", page.display()))?;
        }
        let crashed = plan
            .tasks
            .iter()
            .any(|task| finished.entries.get(&task.id).is_some_and(|entry| entry.state == State::Crashed));
        let outcomes = || report.points.iter().flat_map(|point| &point.left.looked).filter_map(|result| result.verdict);
        let nothing_judged = outcomes().next().is_some() && !outcomes().any(outcome_is_judged);
        let is_red = crashed || outside > 0 || nothing_judged || how.strict && amber + unjudged > 0;
        Ok(if is_red { ExitCode::from(RED) } else { ExitCode::SUCCESS })
    }
}
