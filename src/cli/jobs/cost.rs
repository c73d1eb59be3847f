//! Tasks of a cost study: one for each point, one for the cost of the parts of a step, and one for large scenes.

use super::arguments::Arguments;
use super::study::{ReportOptions, Study, Tasks, outputs};
use crate::cli::cost;
use crate::cli::exit::{Fault, Outcome};
use crate::cli::own;
use crate::cli::strangers::NamedSolvers;
use grainbench::cases::solvers::Registry;
use grainbench::harness::subject::TargetQuantity;
use grainbench::jobs::execute::{ResultSink, TaskList};
use grainbench::jobs::task::{Id, Task};
use grainbench::reports::study::load::Load;
use grainbench::reports::study::point::{Point, PointStatus};
use grainbench::reports::study::points_of;
use grainbench::reports::study::step::Model;
use grainbench::store::key;
use grainbench::store::log::State;
use grainbench::studies::cost::run::{PointSelection, PointSet};
use grainbench::studies::cost::{load, step};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Expected durations (s) of measuring the cost of the parts of a step, and of a step with one and with 10,000 grains.
const BESIDE: [(&str, f64); 2] = [("prices", 40.0), ("loads", 90.0)];
/// Number of rounds in which the cost of a step is measured.
const ROUNDS: u32 = 5;

/// Cost study.
pub(crate) struct CostStudy {
    /// Points of each target quantity.
    sets: Vec<PointSet>,
    solvers: NamedSolvers,
    wanted: PointSelection,
    prices: bool,
    arguments: Arguments,
}

/// Result of a task.
#[derive(Serialize, Deserialize)]
pub(crate) enum Measured {
    Point(Box<Point>),
    Model(Model),
    Loads(Vec<Load>),
    /// Error message.
    Nothing(String),
}

impl CostStudy {
    pub(crate) fn new(arguments: &Arguments, is_shared: bool) -> Result<Self, Fault> {
        let all = arguments.levels.iter().any(|level| level == "all");
        let subjects = cost::subjects(&arguments.cases)?;
        let (solvers, named) = NamedSolvers::read_for(&arguments.solver, is_shared)?;
        let wanted = PointSelection { solvers: named, all, counts: arguments.counts };
        let program = key::of_this_program();
        let set = |subject: TargetQuantity| {
            let program = program.clone() + &own::edition(subject.case);
            PointSet::new(subject, &wanted, &solvers, &program)
        };
        let sets: Vec<PointSet> = subjects.into_iter().map(set).collect();
        if sets.iter().all(|set| set.count() == 0) {
            return Err(Fault::input("expected at least one point, found none for the selected cases and solvers"));
        }
        let prices = !arguments.counts && (arguments.prices || arguments.cases.is_empty());
        Ok(Self { sets, solvers, wanted, prices, arguments: arguments.clone() })
    }

    /// Returns the number of tasks before the first point.
    fn beside(&self) -> usize {
        if self.prices { BESIDE.len() } else { 0 }
    }

    /// Returns the index of the target quantity of a task, and the index of its point.
    fn place(&self, place: usize) -> Option<(usize, usize)> {
        let mut at = place.checked_sub(self.beside())?;
        for (number, set) in self.sets.iter().enumerate() {
            let count = set.count();
            if at < count {
                return Some((number, at));
            }
            at -= count;
        }
        None
    }
}

/// Returns the duration of all repetitions of a point (s).
fn seconds_of(point: &Point) -> f64 {
    point.repetitions.iter().map(|timing| timing.wall + timing.start_up).sum()
}

impl Tasks for CostStudy {
    fn is_timed(&self) -> bool {
        !self.wanted.counts
    }

    fn tasks(&self, program: &str) -> Result<Vec<Task>, Fault> {
        let mut tasks = Vec::new();
        for (word, seconds) in &BESIDE[..self.beside()] {
            tasks.push(Task {
                scene: "lattices and boxes".to_owned(),
                solver: "all".to_owned(),
                what: (*word).to_owned(),
                repetitions: ROUNDS,
                ..Task::new(Id::of_words(program, &["cost", word]), *seconds)
            });
        }
        for (number, set) in (0..).zip(&self.sets) {
            for point in set.planned() {
                tasks.push(Task {
                    scene: format!("{}/{}", set.subject.case.name, set.subject.variant),
                    solver: point.solver,
                    level: point.setting,
                    what: set.subject.quantity.clone(),
                    repetitions: if self.wanted.counts { 1 } else { 5 },
                    // One worker measures all points of a target quantity, with their repetitions in alternation.
                    group: if self.wanted.counts { None } else { Some(number) },
                    ..Task::new(point.id, point.seconds)
                });
            }
        }
        Ok(tasks)
    }

    fn inputs(&self) -> BTreeMap<String, String> {
        self.solvers.inputs()
    }
}

impl TaskList for CostStudy {
    type Output = Measured;

    fn perform(&self, place: usize, sink: &ResultSink<'_, Measured>) -> (State, Measured) {
        let now = |name: &str| sink.now(name);
        let measured = match BESIDE.get(place) {
            Some(("prices", _)) => {
                step::measure(&Registry, ROUNDS, &now).map(Measured::Model).map_err(|error| error.to_string())
            }
            _ => load::measure(&Registry, ROUNDS, &now).map(Measured::Loads).map_err(|error| error.to_string()),
        };
        measured.map_or_else(|why| (State::Failed, Measured::Nothing(why)), |measured| (State::Done, measured))
    }

    fn perform_group(&self, places: &[usize], sink: &ResultSink<'_, Measured>) {
        let found: Vec<(usize, usize)> = places.iter().filter_map(|place| self.place(*place)).collect();
        let Some(&(number, first)) = found.first() else { return self.perform_each(places, sink) };
        let points: Vec<usize> = found.iter().map(|(_, point)| *point).collect();
        // The tasks of a target quantity are consecutive.
        let start = places[0] - first;
        self.sets[number].measure(&points, &|name| sink.now(name), &mut |point, measured| {
            let is_failed = matches!(measured.standing, PointStatus::Failed | PointStatus::NotAvailable);
            let state = if is_failed { State::Failed } else { State::Done };
            sink.leave(start + point, state, seconds_of(&measured), Ok(Measured::Point(Box::new(measured))));
        });
    }
}

impl Study for CostStudy {
    fn report(&self, results: Vec<Option<Result<Measured, String>>>, how: &ReportOptions<'_>) -> Outcome {
        let old = how.against.map(points_of).transpose()?;
        let (results, has_crash) = outputs(results, how);
        let mut words = self.arguments.command_words("cost");
        if self.wanted.all {
            words.push("--levels all".to_owned());
        }
        if self.wanted.counts {
            words.push("--counts: times come from single runs beside other runs".to_owned());
        }
        let mut study = how.study(words);
        let mut results = results.into_iter();
        for measured in results.by_ref().take(self.beside()).flatten() {
            match measured {
                Measured::Model(model) => study.model = Some(model),
                Measured::Loads(loads) => study.loads = loads,
                Measured::Point(_) | Measured::Nothing(_) => {}
            }
        }
        let mut next_point = |measured: Option<Measured>| match measured {
            Some(Measured::Point(point)) => Some(*point),
            _ => None,
        };
        for set in &self.sets {
            let points = results.by_ref().take(set.count()).map(&mut next_point).collect();
            study.diagrams.push(set.diagram(points));
        }
        study.diagrams.retain(|diagram| !diagram.points.is_empty());
        let asked: Vec<String> =
            study.diagrams.iter().flat_map(|diagram| &diagram.points).map(|point| point.solver.clone()).collect();
        study.sources = own::sources(&asked);
        if let (Some(old), Some(path)) = (&old, how.against) {
            cost::set_against(&mut study, old, path);
        }
        how.publish(&study, has_crash)
    }
}
