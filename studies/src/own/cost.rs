//! Cost of accuracy of a scene: levels of each solver within a time budget, and their estimated errors.

use super::convergence::{LevelValue, Reference, deviation, ensemble, reference, scatter};
use super::ladder::{Ladder, soften};
use super::schedule::{self, Finished};
use super::stored_run::{StoredColumn, StoredRun, columns, failure, wall_seconds};
use super::within::Within;
use crate::chaos::{ZERO, natural, perturbed_runs};
use crate::run_cache::key_of_run;
use grainbench_harness::evidence::Evidence;
use grainbench_harness::solvers::Solvers;
use grainbench_harness::statistics::median;
use grainbench_reports::number;
use grainbench_reports::study::estimate::{Estimate, EstimatedPoint, Level, Quantity, Reduction, SceneCost};
use grainbench_reports::study::point::PointStatus;
use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::failure::StorageError;
use grainbench_solver::observer::Observer;
use grainbench_solver::record::Snapshot;
use grainbench_solver::resolution::Resolution;
use grainbench_store::{WriteError, artifact::Directory, key};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Fractions of the budget at which the parts of the study end: levels; half steps and softer contacts; effects; largest
/// stable steps; repetitions.
pub const PARTS: [f64; 5] = [0.7, 0.78, 0.85, 0.93, 0.97];
/// Fraction of the budget at which any run is interrupted.
const LATEST: f64 = 1.1;
/// Fraction of the remaining time that the first level of a solver may take.
const FIRST: f64 = 0.3;
/// Smallest relevant change of a probe in the test for chaos, relative to its largest value.
pub(super) const MATTERS: f64 = 0.01;
/// Largest number of timed repetitions of a level.
const REPETITIONS: usize = 9;
/// Uncertainty relative to the scale below which no further level is useful.
const ENOUGH: f64 = 1e-7;
/// Difference relative to the scale of the probe that counts as rounding error.
const ROUNDING: f64 = 1e-12;
/// Factors by which the stiffness of contacts is divided.
const SOFTER: [f64; 2] = [10.0, 100.0];
/// Number of failures in a row after which a solver gets no further level: with time steps or substeps, and with cells,
/// whose refinement costs much more.
const FAILURES: [usize; 2] = [12, 6];
/// Columns that count something. They change in jumps, and are target quantities only if the user names them.
const COUNTS: [&str; 6] = ["slipping", "contacts", "slipping_contacts", "present", "entered", "left"];

/// Scene, solvers and extent of a study.
pub struct SceneStudy<'a> {
    /// Path of the scene.
    pub name: String,
    /// Scene.
    pub scene: &'a Scene,
    /// Names of the solvers.
    pub names: Vec<String>,
    /// Solvers by name.
    pub solvers: &'a dyn Solvers,
    /// Columns of probes that are target quantities; all if empty.
    pub quantities: Vec<String>,
    /// Window of time (s) whose means are compared.
    pub window: Option<(f64, f64)>,
    /// Time budget.
    pub budget: Duration,
    /// Storage of finished runs.
    pub cache: &'a Directory,
    /// Hash of this program.
    pub program: String,
    /// Returns true if the user stops the study. The current run then ends and is not stored.
    pub stop: &'a (dyn Fn() -> bool + Sync),
}

/// Receiver of the progress and of preliminary results.
pub trait StudyFollower {
    /// Called when a run begins, with the time that is spent (s).
    fn now(&mut self, _run: &str, _spent: f64) {}
    /// Called after each level, with the results so far.
    ///
    /// # Errors
    /// When the results cannot be written.
    fn result(&mut self, _line: &str, _so_far: &dyn Fn() -> SceneCost) -> Result<(), WriteError> {
        Ok(())
    }
}

/// Follower that ignores everything.
impl StudyFollower for () {}

/// Purpose of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Purpose {
    /// Level of a solver.
    Level,
    /// Same cells with half of the time step.
    HalfStep,
    /// Contacts whose stiffness is divided by this factor.
    Softer(f64),
}

/// Run with its place in the study.
struct Run {
    solver: usize,
    fineness: f64,
    resolution: Resolution,
    setting: String,
    purpose: Purpose,
    name: String,
    stored: StoredRun,
}

/// Values of the perturbed runs of a chaotic scene, by column: name and means over time.
type Perturbed = Vec<(String, Vec<f64>)>;

/// Study in progress.
pub struct Measurement<'a> {
    study: &'a SceneStudy<'a>,
    /// Scene without snapshots, whose writing is no part of the cost.
    scene: Scene,
    ladders: Vec<Ladder>,
    found: Vec<Option<Arc<dyn Solver>>>,
    finished: Vec<Finished>,
    runs: Vec<Run>,
    perturbed: Option<Perturbed>,
    notes: Vec<String>,
    start: Instant,
    /// Time of stored runs (s), which counts as spent.
    stored: f64,
    /// Time of the stored repetitions (s), which counts as spent when levels are timed again.
    repeated: f64,
    /// True if all runs are stored runs.
    is_reused: bool,
}

/// Observer that stores no snapshot.
struct NoSnapshots;

impl Observer for NoSnapshots {
    fn snapshot(&mut self, _snapshot: Snapshot) -> Result<Option<Snapshot>, StorageError> {
        Ok(None)
    }
}

impl<'a> Measurement<'a> {
    /// Begins a study.
    #[must_use]
    pub fn new(study: &'a SceneStudy<'a>) -> Self {
        let scene = Scene { snapshots: 0, snapshot_times: Vec::new(), ..study.scene.clone() };
        let ladders: Vec<Ladder> = study.names.iter().map(|name| Ladder::new(name, &scene, study.solvers)).collect();
        let finished = |ladder: &Ladder| {
            let (exponent, listed) = (ladder.exponent(), ladder.listed.clone());
            Finished { exponent, listed, ..Finished::default() }
        };
        let finished = ladders.iter().map(finished).collect();
        let found = study.names.iter().map(|name| study.solvers.find_within(name, study.budget)).collect();
        Self {
            study,
            scene,
            ladders,
            found,
            finished,
            runs: Vec::new(),
            perturbed: None,
            notes: Vec::new(),
            start: Instant::now(),
            stored: 0.0,
            repeated: 0.0,
            is_reused: true,
        }
    }

    /// Returns true if the user stops the study.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        (self.study.stop)()
    }

    /// Returns the time that is spent (s). The time of reused runs counts, so that a continued study makes the same choices.
    #[must_use]
    pub fn spent(&self) -> f64 {
        self.stored + self.start.elapsed().as_secs_f64()
    }

    /// Returns the time (s) until a part of the budget is used up.
    #[must_use]
    pub fn remaining(&self, part: f64) -> f64 {
        part * self.study.budget.as_secs_f64() - self.spent()
    }

    /// Returns the time at which a run is interrupted, if it may take this time (s).
    #[must_use]
    pub fn deadline(&self, seconds: f64) -> Instant {
        Instant::now() + Duration::from_secs_f64(seconds.clamp(0.0, 1e9))
    }

    /// Returns the solvers with at least one measured level.
    #[must_use]
    pub fn measured_solvers(&self) -> Vec<String> {
        let is_measured = |at: &usize| !self.measured(*at, Purpose::Level).is_empty();
        (0..self.study.names.len()).filter(is_measured).map(|at| self.study.names[at].clone()).collect()
    }

    /// Returns true if perturbed runs part, so that means over time are compared.
    #[must_use]
    pub fn is_chaotic(&self) -> bool {
        self.perturbed.as_ref().is_some_and(|perturbed| !perturbed.is_empty())
    }

    /// Returns the finest resolution of a solver for whose run at most `seconds` are expected, and the expected time of a run
    /// (s). If no level is that fast, the coarsest level is returned.
    #[must_use]
    pub fn resolution_within(&self, solver: &str, seconds: f64) -> Option<(Resolution, f64)> {
        let at = self.study.names.iter().position(|name| name == solver)?;
        let levels = self.measured(at, Purpose::Level);
        let fits = levels.iter().rev().find(|run| run.stored.seconds <= seconds && run.fineness <= 4.0);
        let run = fits.or_else(|| levels.first())?;
        Some((run.resolution, run.stored.seconds))
    }

    /// Runs the levels of all solvers, and the test for chaos after the first two levels.
    ///
    /// # Errors
    /// When a result cannot be stored.
    pub fn levels(&mut self, follower: &mut dyn StudyFollower) -> Result<(), WriteError> {
        for (at, name) in self.study.names.iter().enumerate() {
            if self.found[at].is_none() {
                self.finished[at].closed = true;
                self.notes.push(format!("{name}: there is no such solver."));
            }
        }
        while !self.is_stopped()
            && let Some((at, fineness)) = schedule::next(&self.finished, self.remaining(PARTS[0]))
        {
            self.level(at, fineness, follower)?;
            if self.is_stopped() {
                break;
            }
            follower.result(&self.line(), &|| self.result())?;
        }
        Ok(())
    }

    /// Runs a level of a solver, and the test for chaos after the first two levels.
    fn level(&mut self, at: usize, fineness: f64, follower: &mut dyn StudyFollower) -> Result<(), WriteError> {
        let resolution = self.ladders[at].at(fineness);
        let Some(run) = self.run(at, (fineness, resolution, Purpose::Level), follower)? else { return Ok(()) };
        let (status, seconds) = (run.stored.status, run.stored.seconds);
        let last = self.finished[at].levels.last().map_or(0.0, |(last, _)| *last);
        self.finished[at].levels.push((fineness, seconds));
        self.runs.push(run);
        let is_last_factor = last > 0.0 && self.ladders[at].listed.is_empty() && fineness < 1.9 * last;
        let failures = self.own(at).rev().take_while(|run| run.stored.status == PointStatus::Failed).count();
        let most = FAILURES[usize::from(self.ladders[at].has_cells())];
        let is_over = !matches!(status, PointStatus::Measured | PointStatus::Failed);
        if is_over || is_last_factor || failures >= most || self.is_converged(at) {
            self.finished[at].closed = true;
        }
        if self.perturbed.is_none() && !self.is_stopped() && self.measured(at, Purpose::Level).len() >= 2 {
            self.test_for_chaos(at, follower);
        }
        Ok(())
    }

    /// Runs half of the time step on the grid, and softer contacts.
    ///
    /// # Errors
    /// When a result cannot be stored.
    pub fn variations(&mut self, follower: &mut dyn StudyFollower) -> Result<(), WriteError> {
        for at in 0..self.ladders.len() {
            let has_cells = self.ladders[at].has_cells();
            let limit = 0.5 * self.remaining(PARTS[2]);
            let fits = |run: &&&Run| match has_cells {
                true => 2.0 * run.stored.seconds <= limit,
                false => run.fineness <= 4.0 && run.stored.seconds <= limit,
            };
            let levels = self.measured(at, Purpose::Level);
            let found = levels.iter().rev().find(fits).map(|run| (run.fineness, run.resolution));
            let Some((fineness, resolution)) = found else { continue };
            let is_soft =
                self.study.names[at] == "dem" && self.scene.laws.iter().flatten().any(ContactLaw::has_stiffness);
            let varied = match resolution {
                Resolution::Grid { cells, points, courant } if has_cells => {
                    vec![(Resolution::Grid { cells, points, courant: 0.5 * courant }, Purpose::HalfStep)]
                }
                _ if is_soft && !has_cells => SOFTER.map(|factor| (resolution, Purpose::Softer(factor))).to_vec(),
                _ => Vec::new(),
            };
            for (resolution, purpose) in varied {
                let run = self.run(at, (fineness, resolution, purpose), follower)?;
                self.runs.extend(run);
            }
        }
        Ok(())
    }

    /// Times levels again until the budget is used up, or each level is timed often enough.
    ///
    /// # Errors
    /// When a result cannot be stored.
    pub fn repetitions(&mut self, follower: &mut dyn StudyFollower) -> Result<(), WriteError> {
        // A study that was finished before is not timed again.
        if self.repeated > 0.0 && self.is_reused {
            return Ok(());
        }
        self.stored += std::mem::take(&mut self.repeated);
        while !self.is_stopped() {
            let time =
                |run: &Run| if run.stored.status == PointStatus::Measured { run.stored.seconds } else { f64::INFINITY };
            // Softer contacts are timed once.
            let is_softer = |run: &Run| matches!(run.purpose, Purpose::Softer(_));
            let count = |run: &Run| if is_softer(run) { REPETITIONS } else { run.stored.walls.len() };
            let levels: Vec<(f64, usize)> = self.runs.iter().map(|run| (time(run), count(run))).collect();
            let Some(at) = schedule::again(&levels, self.remaining(PARTS[4]), REPETITIONS) else { return Ok(()) };
            let run = &self.runs[at];
            follower.now(&format!("{} {} again", self.study.names[run.solver], run.setting), self.spent());
            let Some(solver) = self.found[run.solver].clone() else { return Ok(()) };
            let within = Within::new(&*solver, self.deadline(self.remaining(LATEST)), self.study.stop);
            let begin = Instant::now();
            let Ok(record) = within.run(&self.scene, &run.resolution, &mut NoSnapshots) else { return Ok(()) };
            let wall = wall_seconds(&record, begin.elapsed().as_secs_f64());
            let run = &mut self.runs[at];
            run.stored.walls.push(wall);
            self.study.cache.put(&run.name, &run.stored)?;
        }
        Ok(())
    }

    /// Returns the runs of a solver.
    fn own(&self, solver: usize) -> impl DoubleEndedIterator<Item = &Run> {
        self.runs.iter().filter(move |run| run.solver == solver)
    }

    /// Returns the measured runs of a solver for a purpose, from coarse to fine.
    fn measured(&self, solver: usize, purpose: Purpose) -> Vec<&Run> {
        let is_measured = |run: &&Run| run.purpose == purpose && run.stored.status == PointStatus::Measured;
        self.own(solver).filter(is_measured).collect()
    }

    /// Runs a level, or takes it from the storage. Returns none if the user stops the study.
    fn run(
        &mut self,
        at: usize,
        (fineness, resolution, purpose): (f64, Resolution, Purpose),
        follower: &mut dyn StudyFollower,
    ) -> Result<Option<Run>, WriteError> {
        if self.is_stopped() {
            return Ok(None);
        }
        let solver_name = &self.study.names[at];
        let (mut scene, mut setting) = (self.scene.clone(), resolution.to_string());
        if let Purpose::Softer(factor) = purpose {
            soften(&mut scene, factor);
            setting += &format!(", contacts softer by {factor}");
        }
        let program = self.study.program.clone() + &self.study.solvers.edition(solver_name);
        let what = self.study.window.map_or(String::new(), |(from, to)| format!(", {from:?}..{to:?}"));
        let name = key_of_run(&program, solver_name, &scene, &resolution, &format!("scene without claims{what}"));
        follower.now(&format!("{solver_name} {setting}"), self.spent());
        let stored = match self.study.cache.get::<StoredRun>(&name) {
            Ok(stored) => {
                self.stored += stored.seconds;
                self.repeated += stored.walls.iter().skip(1).sum::<f64>();
                stored
            }
            Err(_) => {
                let stored = self.measure(at, &scene, &resolution);
                self.is_reused &= stored.status == PointStatus::OverBudget;
                // An external program fails when it is stopped.
                if self.is_stopped() && stored.status != PointStatus::Measured {
                    return Ok(None);
                }
                if stored.status != PointStatus::OverBudget {
                    self.study.cache.put(&name, &stored)?;
                }
                stored
            }
        };
        match stored.status {
            PointStatus::Measured | PointStatus::Failed => {}
            _ => {
                let detail = stored.detail.clone().unwrap_or_default();
                let is_named = detail.starts_with(solver_name.as_str());
                self.notes.push(if is_named { detail } else { format!("{solver_name}: {detail}") });
            }
        }
        Ok(Some(Run { solver: at, fineness, resolution, setting, purpose, name, stored }))
    }

    fn measure(&self, at: usize, scene: &Scene, resolution: &Resolution) -> StoredRun {
        let mut stored = StoredRun::default();
        let Some(solver) = &self.found[at] else {
            let detail = Some("there is no such solver".to_owned());
            return StoredRun { status: PointStatus::NotAvailable, detail, ..stored };
        };
        // A first whole run of unknown cost must not use the time of the other solvers.
        let limit = match self.measured(at, Purpose::Level).is_empty() {
            true => FIRST * self.remaining(PARTS[0]),
            false => self.remaining(LATEST),
        };
        let within = Within::new(&**solver, self.deadline(limit), self.study.stop);
        let begin = Instant::now();
        let record = within.run(scene, resolution, &mut NoSnapshots);
        stored.seconds = begin.elapsed().as_secs_f64();
        match record {
            Ok(record) => {
                stored.status = PointStatus::Measured;
                stored.walls = vec![wall_seconds(&record, stored.seconds)];
                stored.steps = record.cost.steps;
                stored.columns = columns(&record, self.study.window);
            }
            Err(error) => {
                (stored.status, stored.detail) = failure(&error, within.0.completed(), stored.seconds, resolution);
                if stored.status == PointStatus::Failed {
                    stored.walls = vec![stored.seconds];
                }
            }
        }
        stored
    }

    /// Repeats a level with a tiny displacement of one grain. If the probes change, the scene is chaotic.
    fn test_for_chaos(&mut self, at: usize, follower: &mut dyn StudyFollower) {
        let Some(run) = self.measured(at, Purpose::Level).first().copied() else { return };
        let (resolution, name) = (run.resolution, key::of_words(&run.name, &["perturbed"]));
        if let Ok((seconds, perturbed)) = self.study.cache.get::<(f64, Perturbed)>(&name) {
            self.stored += seconds;
            self.perturbed = Some(perturbed);
            return;
        }
        let Some(solver) = self.found[at].clone() else { return };
        follower.now(&format!("{} {resolution}, test for chaos", self.study.names[at]), self.spent());
        let begin = Instant::now();
        let within = Within::new(&*solver, self.deadline(self.remaining(PARTS[0])), self.study.stop);
        let mut again = |scene: &Scene| within.run(scene, &resolution, &mut NoSnapshots);
        let found = again(&self.scene).and_then(|whole| {
            let others = perturbed_runs(&self.scene, &whole, MATTERS, &mut again)?;
            Ok((whole, others))
        });
        let (whole, others) = match found {
            Ok(found) => found,
            Err(_) if self.is_stopped() => return,
            Err(error) => {
                let reason = match within.0.is_cut() {
                    true => "did not end within the budget".to_owned(),
                    false => format!("failed: {error}"),
                };
                self.notes.push(format!("The test for chaos {reason}."));
                self.perturbed = Some(Vec::new());
                return;
            }
        };
        let all: Vec<Vec<StoredColumn>> =
            [&whole].into_iter().chain(&others).map(|run| columns(run, self.study.window)).collect();
        let means = |column: &StoredColumn| {
            let named = all.iter().filter_map(|columns| columns.iter().find(|other| other.name == column.name));
            (column.name.clone(), named.map(|column| column.mean).collect())
        };
        let perturbed = if others.is_empty() { Perturbed::new() } else { all[0].iter().map(means).collect() };
        // A result that cannot be stored is computed again.
        let test = (begin.elapsed().as_secs_f64(), perturbed);
        let _ = self.study.cache.put(&name, &test);
        self.perturbed = Some(test.1);
    }

    /// Returns true if no further level of a solver can improve the result.
    fn is_converged(&self, at: usize) -> bool {
        let name = &self.study.names[at];
        let is_exact = |quantity: &Quantity| {
            let estimate = quantity.estimates.iter().find(|row| row.solver == *name);
            estimate.is_some_and(|row| row.uncertainty <= ENOUGH * quantity.scale)
        };
        self.measured(at, Purpose::Level).len() >= 3 && self.result().quantities.iter().all(is_exact)
    }

    /// Returns a line about the last run.
    fn line(&self) -> String {
        let Some(run) = self.runs.last() else { return String::new() };
        let solver = &self.study.names[run.solver];
        let what = run.stored.detail.clone().unwrap_or_else(|| number::seconds(median(&run.stored.walls)));
        format!("{solver} {}: {what}", run.setting)
    }

    /// Returns the results so far.
    #[must_use]
    pub fn result(&self) -> SceneCost {
        let whole = if self.is_chaotic() { Reduction::Mean } else { Reduction::End };
        let reduction = self.study.window.map_or(whole, |(from, to)| Reduction::Window(from, to));
        let level = |run: &Run| Level {
            solver: self.study.names[run.solver].clone(),
            setting: run.setting.clone(),
            status: run.stored.status,
            wall_seconds: (!run.stored.walls.is_empty()).then(|| median(&run.stored.walls)),
            repetitions: run.stored.walls.len(),
            steps: run.stored.steps,
            detail: run.stored.detail.clone(),
        };
        let mut notes = self.notes.clone();
        notes.extend((0..self.study.names.len()).filter_map(|at| self.failures(at)));
        notes.extend((0..self.study.names.len()).filter_map(|at| self.unsupported(at)));
        if self.is_chaotic() {
            notes.push(
                "The scene is chaotic: a displacement of one grain by a millionth of its radius changes its probes by more \
                 than 1 %. Means over time are compared, with the scatter of perturbed runs."
                    .to_owned(),
            );
        }
        SceneCost {
            scene: self.study.name.clone(),
            budget: self.study.budget.as_secs_f64(),
            spent: self.start.elapsed().as_secs_f64(),
            reduction,
            names: self.study.names.clone(),
            levels: self.runs.iter().map(level).collect(),
            quantities: self.quantities(reduction),
            notes,
        }
    }

    /// Returns a note about a solver of which no level ended.
    fn failures(&self, at: usize) -> Option<String> {
        let name = &self.study.names[at];
        // A preliminary result says nothing about levels that follow.
        let is_over = schedule::next(&self.finished, self.remaining(PARTS[0])).is_none();
        let levels: Vec<&Run> = self.own(at).filter(|run| run.purpose == Purpose::Level).collect();
        let Some(last) = levels.last() else {
            let is_known = is_over && self.found[at].is_some();
            return is_known.then(|| format!("{name}: no run fits into the time that the other solvers leave."));
        };
        let mut failed = levels.iter().filter(|run| run.stored.status == PointStatus::Failed);
        let (count, finest) = (failed.clone().count(), failed.next_back()?);
        if levels.iter().any(|run| run.stored.status == PointStatus::Measured) {
            return None;
        }
        let is_cut = is_over && last.stored.status == PointStatus::Failed && !self.finished[at].closed;
        let end = if is_cut { "; a finer one does not fit into the budget" } else { "" };
        let detail = finest.stored.detail.as_deref().unwrap_or_default();
        Some(format!("{name}: {count} levels failed, the finest at {}{end}: {detail}", finest.setting))
    }

    fn quantities(&self, reduction: Reduction) -> Vec<Quantity> {
        let mut found: Vec<Quantity> = Vec::new();
        for (run, column) in self.runs.iter().flat_map(|run| run.stored.columns.iter().map(move |column| (run, column)))
        {
            let is_known = found.iter().any(|known| known.name == column.name);
            if is_known || !self.is_wanted(column) || self.ladders[run.solver].lacks(&column.name) {
                continue;
            }
            // Scales are those of the finest run of the first solver.
            let is_level = |run: &&Run| run.purpose == Purpose::Level && !self.ladders[run.solver].lacks(&column.name);
            let levels = self.runs.iter().filter(is_level);
            let mut named = levels.filter_map(|run| Some((run.solver, run.stored.column(&column.name)?)));
            let Some((first, _)) = named.clone().next() else { continue };
            let Some((_, finest)) = named.rfind(|(solver, _)| *solver == first) else { continue };
            let all = self.runs.iter().filter_map(|run| run.stored.column(&column.name));
            let largest = all.fold(0.0, |most: f64, other| most.max(other.largest));
            if finest.scale <= ZERO * natural(&self.scene, &column.unit) || largest <= ZERO * finest.scale {
                continue;
            }
            let scale = if reduction == Reduction::End { finest.largest } else { finest.mean_absolute };
            let mut quantity = Quantity {
                name: column.name.clone(),
                unit: column.unit.clone(),
                // A column may be zero in the finest run alone.
                scale: scale.max(ZERO * finest.scale),
                estimates: Vec::new(),
                points: Vec::new(),
            };
            for at in 0..self.ladders.len() {
                self.estimate(at, (reduction, ROUNDING * finest.scale), &mut quantity);
            }
            found.push(quantity);
        }
        found
    }

    /// Adds the reference value and the points of a solver to a quantity. Differences up to `rounding` are rounding errors.
    fn estimate(&self, at: usize, (reduction, rounding): (Reduction, f64), quantity: &mut Quantity) {
        if self.ladders[at].lacks(&quantity.name) {
            return;
        }
        let value = |run: &Run| {
            let column = run.stored.column(&quantity.name)?;
            Some(if reduction == Reduction::End { column.end } else { column.mean })
        };
        let ladder = &self.ladders[at];
        let levels = self.measured(at, Purpose::Level);
        let mut values: Vec<LevelValue> = levels
            .iter()
            .filter_map(|run| {
                Some(LevelValue { size: ladder.size(run.fineness, run.stored.steps), value: value(run)? })
            })
            .collect();
        values.sort_by(|a, b| b.size.total_cmp(&a.size));
        let perturbed = self.perturbed.iter().flatten().find(|(name, _)| *name == quantity.name);
        let spread = perturbed.map_or(0.0, |(_, values)| deviation(values));
        let found = match self.is_chaotic() || reduction == Reduction::Mean {
            false => reference(&values, ladder.order(), rounding),
            true => ensemble(&values, spread, rounding),
        };
        let Some(Reference { value: limit, mut uncertainty, order, basis }) = found else { return };
        if reduction == Reduction::End && quantity.estimates.is_empty() {
            quantity.scale = quantity.scale.max(limit.abs());
        }
        for half in self.measured(at, Purpose::HalfStep) {
            let same = levels.iter().find(|run| run.fineness == half.fineness);
            if let (Some(half), Some(whole)) = (value(half), same.and_then(|run| value(run))) {
                uncertainty += (half - whole).abs();
            }
        }
        let scatter = if reduction == Reduction::End { 0.0 } else { scatter(spread) };
        let point = |run: &Run, softer: bool| {
            let value = value(run)?;
            Some(EstimatedPoint {
                solver: self.study.names[at].clone(),
                setting: run.setting.clone(),
                wall_seconds: median(&run.stored.walls),
                value,
                error: (value - limit).abs() / quantity.scale,
                uncertainty: uncertainty.hypot(scatter) / quantity.scale,
                softer,
            })
        };
        let points: Vec<EstimatedPoint> = levels.iter().filter_map(|run| point(run, false)).collect();
        let softer = SOFTER.into_iter().flat_map(|factor| self.measured(at, Purpose::Softer(factor)));
        let softer = softer.filter_map(|run| {
            let mut softer = point(run, true)?;
            // The error of the time step is not part of the influence of the stiffness.
            let same = levels.iter().position(|level| level.fineness == run.fineness)?;
            softer.uncertainty += points.get(same)?.error;
            Some(softer)
        });
        let softer: Vec<EstimatedPoint> = softer.collect();
        quantity.points.extend(points.into_iter().chain(softer));
        quantity.estimates.push(Estimate {
            solver: self.study.names[at].clone(),
            evidence: Evidence::Convergence,
            value: limit,
            uncertainty,
            order,
            basis,
        });
    }

    /// Returns a note about the target quantities that the method of a solver does not have.
    fn unsupported(&self, at: usize) -> Option<String> {
        let columns = self.own(at).next()?.stored.columns.iter();
        let names = columns.filter(|column| self.is_wanted(column) && self.ladders[at].lacks(&column.name));
        let names: Vec<&str> = names.map(|column| column.name.as_str()).collect();
        (!names.is_empty()).then(|| {
            format!("{}: unsupported, because its contacts are rigid: {}.", self.study.names[at], names.join(", "))
        })
    }

    /// Returns true if a column is a target quantity.
    fn is_wanted(&self, column: &StoredColumn) -> bool {
        let wanted = &self.study.quantities;
        if wanted.is_empty() {
            let quantity = column.name.rsplit_once('.').map_or("", |(_, quantity)| quantity);
            return !COUNTS.contains(&quantity);
        }
        wanted.iter().any(|name| *name == column.name || column.name.starts_with(&format!("{name}.")))
    }
}

#[cfg(test)]
#[path = "drawn.rs"]
mod tests;
