//! Plan of a parameter sweep.

use super::study::{ReportOptions, Study};
use crate::cli::cache;
use crate::cli::exit::{Fault, Outcome, exit_code, print, refuse};
use crate::cli::provenance::provenance;
use crate::cli::solver::{NamedSolvers, is_manifest};
use grainbench::harness::solvers::Solvers;
use grainbench::harness::verdict;
use grainbench::jobs::execute::{ResultSink, TaskList};
use grainbench::jobs::plan::Plan;
use grainbench::jobs::sweep::Sweep;
use grainbench::jobs::task::Task;
use grainbench::reports::number;
use grainbench::reports::sweep::{PointOutput, QuantityResult, counts, sweep_json, write_sweep};
use grainbench::store::key;
use grainbench::store::log::State;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// Sweep over parameters, with its solvers.
pub(crate) struct SweepStudy {
    path: String,
    sweep: Sweep,
    /// Names or manifests of the solvers, as the sweep file states them.
    asked: Vec<String>,
    /// Solver names in the results.
    names: Vec<String>,
    solvers: NamedSolvers,
    /// Solvers that use the cache of finished runs, which is opened with the first run. Timed tasks never use it.
    cached: OnceLock<Arc<dyn Solvers>>,
}

impl SweepStudy {
    pub(crate) fn new(file: &str) -> Result<Self, Fault> {
        if !is_manifest(file) {
            refuse!("{file}: expected the file of a sweep (`.toml`), found another name");
        }
        let sweep = Sweep::read(Path::new(file))?;
        let beside = Path::new(file).parent().unwrap_or(Path::new(""));
        // Paths of manifests are relative to the directory of the sweep file.
        let place = |name: String| if is_manifest(&name) { beside.join(name).display().to_string() } else { name };
        let asked: Vec<String> = sweep.solvers().into_iter().map(place).collect();
        let (solvers, names) = NamedSolvers::read_for(&asked, true)?;
        Ok(Self { path: file.to_owned(), sweep, asked, names, solvers, cached: OnceLock::new() })
    }
}

impl TaskList for SweepStudy {
    type Output = PointOutput;

    fn perform(&self, place: usize, _: &ResultSink<'_, PointOutput>) -> (State, PointOutput) {
        let solvers = self.cached.get_or_init(|| {
            let cache = if self.is_timed() { None } else { cache::open(false) };
            cache::with(self.solvers.clone(), cache.as_ref())
        });
        self.sweep.run(place, &**solvers, &self.names)
    }
}

impl Study for SweepStudy {
    fn is_timed(&self) -> bool {
        self.sweep.is_timed()
    }

    fn tasks(&self, program: &str) -> Result<Vec<Task>, Fault> {
        Ok(self.sweep.tasks(program, &self.solvers, &self.names)?)
    }

    fn inputs(&self) -> BTreeMap<String, String> {
        let scene = self.sweep.scene_file.as_ref().map(|path| path.display().to_string());
        let manifests = self.asked.iter().filter(|name| is_manifest(name)).cloned();
        // An invalid scene causes an error when the tasks are listed.
        let named = self.sweep.files().unwrap_or_default().into_iter().map(|path| path.display().to_string());
        let files = std::iter::once(self.path.clone()).chain(scene).chain(named).chain(manifests);
        let mut inputs = self.solvers.inputs();
        inputs.extend(files.map(|file| (file.clone(), key::of_file(Path::new(&file)))));
        inputs
    }

    fn check(&self, _: &Plan) -> Result<(), Fault> {
        // The sweep file is an input of the plan.
        Ok(())
    }

    fn report(&self, results: Vec<Option<Result<PointOutput, String>>>, how: &ReportOptions<'_>) -> Outcome {
        let mut options = vec![self.path.clone()];
        options.extend(how.words.iter().cloned());
        let crashed_point = |detail| {
            let looked = vec![QuantityResult::without_value(verdict::Outcome::Broken, None)];
            PointOutput { looked, detail: Some(detail), ..PointOutput::default() }
        };
        let left = results.into_iter().map(|result| Some(result?.unwrap_or_else(crashed_point))).collect();
        let report = self.sweep.report(&self.names, provenance(options, how.seconds), left);
        write_sweep(&how.out, &report)?;
        let [within, outside, amber, unjudged] = counts(&report.points);
        if how.json {
            print(&sweep_json(&report)?)?;
        } else {
            let [w, o, a, u] = [within, outside, amber, unjudged].map(|count| number::count(count as u64));
            let unjudged = if unjudged > 0 { format!(", {u} not judged") } else { String::new() };
            let page = how.out.join("index.html");
            print(&format!("{w} within, {o} outside or broken, {a} amber{unjudged}\n{}\n", page.display()))?;
        }
        let outcomes = || report.points.iter().flat_map(|point| &point.left.looked).filter_map(|result| result.verdict);
        let passes = outcomes().next().is_none() || verdict::passes(outcomes(), []);
        Ok(exit_code(!passes || how.strict && amber + unjudged > 0))
    }
}
