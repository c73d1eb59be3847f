//! Plan of a cost study. It has one task per point, one for the cost of the parts of a step, and one for large scenes.

use super::arguments::Arguments;
use super::study::{ReportOptions, Study};
use crate::cli::cost::{self, ROUNDS};
use crate::cli::exit::{Fault, Outcome};
use crate::cli::provenance::provenance;
use crate::cli::publish::{Output, publish_study};
use crate::cli::strangers::NamedSolvers;
use grainbench::campaign::finished::{FinishedTasks, TaskResult};
use grainbench::campaign::log::State;
use grainbench::campaign::plan::{Kind, Plan};
use grainbench::campaign::share::share;
use grainbench::campaign::task::{Id, Task};
use grainbench::campaign::work::ResultSink;
use grainbench::cases::solvers::Registry;
use grainbench::harness::subject::TargetQuantity;
use grainbench::reports::study::point::{Point, PointStatus};
use grainbench::reports::study::{Study as Report, points_of};
use grainbench::studies::cost::run::{Meter, PointSelection};
use grainbench::studies::cost::{load, step};
use grainbench::studies::result_cache::ResultCache;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// Expected duration of measuring the cost of the parts of a step (s).
const PRICES: f64 = 40.0;
/// Expected duration of measuring the cost of a step with one and with 10,000 grains (s).
const LOADS: f64 = 90.0;

/// Cost study of a plan.
pub(crate) struct CostStudy {
    subjects: Vec<TargetQuantity>,
    solver: Vec<String>,
    wanted: PointSelection,
    prices: bool,
    arguments: Arguments,
}

impl CostStudy {
    pub(crate) fn new(arguments: &Arguments) -> Result<Self, Fault> {
        arguments.only(&["CASE", "--solver", "--levels", "--prices", "--counts"])?;
        let all = match &arguments.levels[..] {
            [] => false,
            [word] if word == "default" => false,
            [word] if word == "all" => true,
            words => {
                let found = words.join(",");
                return Err(Fault::input(format!("--levels: expected `default` or `all` with cost, found `{found}`")));
            }
        };
        let subjects = cost::subjects(&arguments.cases)?;
        let (_, named) = NamedSolvers::read_by_content(&arguments.solver)?;
        Ok(Self {
            subjects,
            solver: arguments.solver.clone(),
            wanted: PointSelection { solvers: named, all, counts: arguments.counts },
            prices: !arguments.counts && (arguments.prices || arguments.cases.is_empty()),
            arguments: arguments.clone(),
        })
    }

    fn solvers(&self) -> Result<NamedSolvers, Fault> {
        NamedSolvers::read_by_content(&self.solver).map(|(solvers, _)| solvers)
    }

    /// Returns the tasks that belong to no diagram: the cost of the parts of a step, and the cost of a step for
    /// different numbers of grains.
    fn beside(&self, program: &str) -> [(Id, &'static str, f64); 2] {
        [("prices", PRICES), ("loads", LOADS)]
            .map(|(word, seconds)| (Id::of_words(program, &["cost", word]), word, seconds))
    }
}

/// Returns the task id of a point from the point's name.
fn id_of(name: &str) -> Option<Id> {
    Id::of_hash(name)
}

/// Returns the duration of all repetitions of a point (s).
fn seconds_of(point: &Point) -> f64 {
    point.repetitions.iter().map(|timing| timing.wall + timing.start_up).sum()
}

impl Study for CostStudy {
    fn kind(&self) -> Kind {
        Kind::Cost
    }

    fn is_timed(&self) -> bool {
        !self.wanted.counts
    }

    fn tasks(&self, program: &str) -> Result<Vec<Task>, Fault> {
        let (solvers, none) = (self.solvers()?, ResultCache::none());
        let meter = Meter::new(&none, self.wanted.clone(), &solvers);
        let mut tasks = Vec::new();
        if self.prices {
            for (id, word, seconds) in self.beside(program) {
                tasks.push(Task {
                    id,
                    scene: "lattices and boxes".to_owned(),
                    set: BTreeMap::new(),
                    solver: "all".to_owned(),
                    level: String::new(),
                    what: word.to_owned(),
                    repetitions: ROUNDS,
                    seconds,
                    group: None,
                });
            }
        }
        for (number, subject) in (0..).zip(&self.subjects) {
            for point in meter.planned(subject) {
                let Some(id) = id_of(&point.name) else { continue };
                tasks.push(Task {
                    id,
                    scene: format!("{}/{}", subject.case.name, subject.variant),
                    set: BTreeMap::new(),
                    solver: point.solver,
                    level: point.setting,
                    what: subject.quantity.clone(),
                    repetitions: if self.wanted.counts { 1 } else { 5 },
                    seconds: point.seconds,
                    // One worker measures all points of a target quantity, with their repetitions in alternation.
                    group: if self.wanted.counts { None } else { Some(number) },
                });
            }
        }
        Ok(tasks)
    }

    fn inputs(&self) -> BTreeMap<String, String> {
        self.solvers().map_or_else(|_| BTreeMap::new(), |solvers| solvers.inputs())
    }

    fn work(&self, plan: &Plan, tasks: &[&Task], jobs: usize, desk: &Arc<ResultSink>) -> Result<(), Fault> {
        let solvers = self.solvers()?;
        let wanted: BTreeSet<Id> = tasks.iter().map(|task| task.id).collect();
        for (id, word, _) in self.beside(&plan.head.program) {
            if !wanted.contains(&id) || !desk.goes_on() {
                continue;
            }
            let start = Instant::now();
            let result = if word == "prices" {
                step::measure(&Registry, ROUNDS, &mut ()).map_err(Fault::input).map(serde_json::to_value)
            } else {
                load::measure(&Registry, ROUNDS, &mut ()).map_err(Fault::from).map(serde_json::to_value)
            };
            let result = result?.map_err(Fault::input)?;
            desk.leave(id, State::Done, start.elapsed().as_secs_f64(), &result);
        }
        let left: Arc<Mutex<BTreeSet<Id>>> = Arc::default();
        let (at, gone) = (Arc::clone(desk), Arc::clone(&left));
        let cache = ResultCache::elsewhere(
            |_| None,
            move |name, text| {
                let point: Option<Point> = serde_json::from_str(text).ok();
                let failed = point
                    .as_ref()
                    .is_some_and(|point| matches!(point.standing, PointStatus::Failed | PointStatus::NotAvailable));
                if let Some(id) = id_of(name) {
                    let state = if failed { State::Failed } else { State::Done };
                    at.leave_text(id, state, point.as_ref().map_or(0.0, seconds_of), text);
                    gone.lock().unwrap_or_else(PoisonError::into_inner).insert(id);
                }
                Ok(())
            },
        );
        let meter = Meter::new(&cache, self.wanted.clone(), &solvers);
        let pieces: Vec<(usize, Vec<Id>)> = self
            .subjects
            .iter()
            .enumerate()
            .map(|(at, subject)| {
                let mine = meter.planned(subject).into_iter().filter_map(|point| id_of(&point.name));
                (at, mine.filter(|id| wanted.contains(id)).collect())
            })
            .filter(|(_, mine): &(usize, Vec<Id>)| !mine.is_empty())
            .collect();
        // Without timing, each point is a work item of its own.
        let pieces: Vec<(usize, Vec<Id>)> = if self.wanted.counts {
            pieces.into_iter().flat_map(|(at, mine)| mine.into_iter().map(move |id| (at, vec![id]))).collect()
        } else {
            pieces
        };
        let do_piece = |piece: usize| {
            let (at, mine) = &pieces[piece];
            let wants = |name: &str| id_of(name).is_some_and(|id| mine.contains(&id));
            let start = Instant::now();
            let done = catch_unwind(AssertUnwindSafe(|| meter.measure_named(&self.subjects[*at], &wants, &mut ())));
            if let Err(reason) = done {
                let left = left.lock().unwrap_or_else(PoisonError::into_inner).clone();
                for id in mine.iter().filter(|id| !left.contains(id)) {
                    desk.crashed(*id, start.elapsed().as_secs_f64(), &*reason);
                }
            }
        };
        share(pieces.len(), jobs, || desk.goes_on(), do_piece);
        Ok(())
    }

    fn collect(&self, plan: &Plan, finished: &FinishedTasks, how: &ReportOptions<'_>) -> Outcome {
        let old = how.against.map(points_of).transpose().map_err(Fault::input)?;
        let solvers = self.solvers()?;
        let texts: HashMap<Id, String> = plan
            .tasks
            .iter()
            .filter_map(|task| {
                let entry = finished.entries.get(&task.id)?;
                (entry.state != State::Crashed).then(|| (task.id, entry.json.to_string()))
            })
            .collect();
        let cache = ResultCache::elsewhere(move |name| texts.get(&id_of(name)?).cloned(), |_, _| Ok(()));
        let meter = Meter::new(&cache, self.wanted.clone(), &solvers);
        let mut words = vec!["cost".to_owned()];
        words.extend(self.arguments.cases.iter().cloned());
        words.extend(self.arguments.solver.iter().map(|solver| format!("--solver {solver}")));
        if self.wanted.all {
            words.push("--levels all".to_owned());
        }
        if self.wanted.counts {
            words.push("--counts: times come from single runs beside other runs".to_owned());
        }
        words.extend(how.words.iter().cloned());
        let mut study = Report::new(provenance(words, how.seconds));
        if self.prices {
            let [(prices, ..), (loads, ..)] = self.beside(&plan.head.program);
            study.model = match finished.result(prices) {
                TaskResult::Out(model) => Some(model),
                TaskResult::Nothing | TaskResult::Crash(_) => None,
            };
            study.loads = match finished.result(loads) {
                TaskResult::Out(loads) => loads,
                TaskResult::Nothing | TaskResult::Crash(_) => Vec::new(),
            };
        }
        study.diagrams = self.subjects.iter().map(|subject| meter.finished(subject)).collect();
        study.diagrams.retain(|diagram| !diagram.points.is_empty());
        let asked: Vec<String> =
            study.diagrams.iter().flat_map(|diagram| &diagram.points).map(|point| point.solver.clone()).collect();
        study.sources = cost::sources(&asked);
        if let (Some(old), Some(path)) = (&old, how.against) {
            cost::set_against(&mut study, old, path);
        }
        let text = cost::text(&study);
        let output = Output { text: Some(text), ..Output::new(how.out, how.json, false) };
        publish_study(&study, output, cost::is_red(&study))
    }
}
