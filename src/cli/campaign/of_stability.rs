//! Plan of a stability study, with one task per stability limit or hard case.

use super::arguments::Arguments;
use super::study::{ReportOptions, Study};
use crate::cli::cost::Follower;
use crate::cli::exit::{Fault, Outcome};
use crate::cli::provenance::provenance;
use crate::cli::publish::{Output, publish_study};
use crate::cli::stability::{self, WorkItem};
use crate::cli::strangers::NamedSolvers;
use grainbench::campaign::finished::FinishedTasks;
use grainbench::campaign::log::State;
use grainbench::campaign::plan::{Kind, Plan};
use grainbench::campaign::share::share;
use grainbench::campaign::task::{Id, Task};
use grainbench::campaign::work::ResultSink;
use grainbench::reports::study::Study as Report;
use grainbench::studies::identity;
use grainbench::studies::result_cache::ResultCache;
use grainbench::studies::stability::assembly::{self, Assembly};
use grainbench::studies::stability::hard::{self, HardCase};
use grainbench::studies::stability::limit;
use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, Mutex, PoisonError};

/// Expected duration of finding a stability limit with contact springs (s).
const SPRINGS: f64 = 0.5;
/// Expected duration of finding a stability limit with a grid (s per cell).
const CELLS: f64 = 0.05;
/// Factor on the expected duration of a hard case. A failed case is repeated with smaller time steps.
const TRIES: f64 = 3.0;

/// Stability limits and hard cases of a plan.
pub(crate) struct StabilityStudy {
    assemblies: Vec<Assembly>,
    hard: Vec<HardCase>,
    arguments: Arguments,
}

impl StabilityStudy {
    pub(crate) fn new(arguments: &Arguments) -> Result<Self, Fault> {
        arguments.only(&["CASE", "--solver"])?;
        let study = Self { assemblies: assembly::all()?, hard: hard::all(), arguments: arguments.clone() };
        study.with(|_, _| Ok(())).map(|()| study)
    }

    /// Calls a function with the work items and solvers of the plan.
    fn with<T>(&self, work: impl FnOnce(&[WorkItem<'_>], &NamedSolvers) -> Result<T, Fault>) -> Result<T, Fault> {
        let (solvers, named) = NamedSolvers::read_by_content(&self.arguments.solver)?;
        let strangers = solvers.names();
        let pieces = stability::select(&self.arguments.cases, [&named, &strangers], &self.assemblies, &self.hard)?;
        work(&pieces, &solvers)
    }
}

/// Returns the name of a work item in the result cache.
fn name(piece: &WorkItem<'_>, program: &str, solvers: &NamedSolvers) -> String {
    use grainbench::harness::solvers::Solvers;
    let by = |solver: &str| program.to_owned() + &solvers.edition(solver);
    match *piece {
        WorkItem::Assembly(assembly, solver) => limit::name_of_assembly(&by(solver), assembly, solver),
        WorkItem::Bar(setting, cells) => limit::name_of_bar(program, setting, cells),
        WorkItem::Hard(case, solver) => hard::name_of(&by(solver), case, solver),
    }
}

impl Study for StabilityStudy {
    fn kind(&self) -> Kind {
        Kind::Stability
    }

    fn is_timed(&self) -> bool {
        false
    }

    fn tasks(&self, program: &str) -> Result<Vec<Task>, Fault> {
        self.with(|pieces, solvers| {
            let task = |piece: &WorkItem<'_>| {
                let (scene, solver, level, seconds) = match *piece {
                    WorkItem::Assembly(assembly, solver) => {
                        let at = assembly.kappa.map_or_else(String::new, |kappa| format!(" {kappa}"));
                        (format!("{}{at}", assembly.name), solver, String::new(), SPRINGS)
                    }
                    WorkItem::Bar(setting, cells) => {
                        ("vibrating-bar".to_owned(), setting, format!("cells={cells}"), CELLS * cells)
                    }
                    WorkItem::Hard(case, solver) => {
                        (case.name.clone(), solver, String::new(), TRIES * hard::seconds(case, solver))
                    }
                };
                let id = Id::of_hash(&name(piece, program, solvers))?;
                let what = if matches!(piece, WorkItem::Hard(..)) { "hard case" } else { "limit" };
                Some(Task {
                    id,
                    scene,
                    set: BTreeMap::new(),
                    solver: solver.to_owned(),
                    level,
                    what: what.to_owned(),
                    repetitions: 1,
                    seconds,
                    group: None,
                })
            };
            Ok(pieces.iter().filter_map(task).collect())
        })
    }

    fn inputs(&self) -> BTreeMap<String, String> {
        self.with(|_, solvers| Ok(solvers.inputs())).unwrap_or_default()
    }

    fn work(&self, _plan: &Plan, tasks: &[&Task], jobs: usize, desk: &Arc<ResultSink>) -> Result<(), Fault> {
        let program = identity::of_this_program();
        self.with(|pieces, solvers| {
            let known: HashMap<Id, &WorkItem<'_>> = pieces
                .iter()
                .filter_map(|piece| Some((Id::of_hash(&name(piece, &program, solvers))?, piece)))
                .collect();
            let do_piece = |at: usize| {
                let Some(piece) = known.get(&tasks[at].id) else { return };
                desk.attempt(tasks[at].id, || {
                    let kept: Arc<Mutex<String>> = Arc::default();
                    let keeps = Arc::clone(&kept);
                    let cache = ResultCache::elsewhere(
                        |_| None,
                        move |_, text| {
                            text.clone_into(&mut keeps.lock().unwrap_or_else(PoisonError::into_inner));
                            Ok(())
                        },
                    );
                    let mut study = Report::new(provenance(Vec::new(), 0.0));
                    let done =
                        stability::do_piece(piece, (&program, solvers), &cache, &mut study, &mut Follower::none());
                    let text = kept.lock().unwrap_or_else(PoisonError::into_inner).clone();
                    match (done, serde_json::from_str::<serde_json::Value>(&text)) {
                        (Ok(_), Ok(result)) => (State::Done, result),
                        (Err(fault), _) => (State::Failed, serde_json::Value::String(fault.to_string())),
                        (_, Err(error)) => (State::Failed, serde_json::Value::String(error.to_string())),
                    }
                });
            };
            share(tasks.len(), jobs, || desk.goes_on(), do_piece);
            Ok(())
        })
    }

    fn collect(&self, plan: &Plan, finished: &FinishedTasks, how: &ReportOptions<'_>) -> Outcome {
        let texts: HashMap<Id, String> = plan
            .tasks
            .iter()
            .filter_map(|task| {
                let entry = finished.entries.get(&task.id)?;
                (entry.state == State::Done).then(|| (task.id, entry.json.to_string()))
            })
            .collect();
        let there: std::collections::HashSet<Id> = texts.keys().copied().collect();
        let cache = ResultCache::elsewhere(move |name| texts.get(&Id::of_hash(name)?).cloned(), |_, _| Ok(()));
        let mut words = vec!["stability".to_owned()];
        words.extend(self.arguments.cases.iter().cloned());
        words.extend(self.arguments.solver.iter().map(|solver| format!("--solver {solver}")));
        words.extend(how.words.iter().cloned());
        let mut study = Report::new(provenance(words, how.seconds));
        let program = &plan.head.program;
        self.with(|pieces, solvers| {
            for piece in pieces {
                // Unfinished items are left out, because they would be computed here.
                if Id::of_hash(&name(piece, program, solvers)).is_some_and(|id| there.contains(&id)) {
                    stability::do_piece(piece, (program, solvers), &cache, &mut study, &mut Follower::none())?;
                }
            }
            Ok(())
        })?;
        study.sources = stability::sources_of(&study);
        let text = stability::text(&study);
        let output = Output { text: Some(text), ..Output::new(how.out, how.json, false) };
        publish_study(&study, output, stability::is_red(&study))
    }
}
