//! Tasks of a cost study: one for each point, one for the cost of the parts of a step, and one for large scenes.

use super::arguments::Arguments;
use super::study::{ReportOptions, Study, outputs};
use crate::cli::exit::{Fault, Outcome, refuse};
use crate::cli::own;
use crate::cli::solver::NamedSolvers;
use crate::cli::subject::selected;
use grainbench::cases::solvers::Registry;
use grainbench::harness::case::Case;
use grainbench::harness::subject::{TargetQuantity, of_each_variant};
use grainbench::jobs::execute::{ResultSink, TaskList};
use grainbench::jobs::task::{Id, Task};
use grainbench::reports::study::load::Load;
use grainbench::reports::study::point::{Point, PointStatus};
use grainbench::reports::study::points_of;
use grainbench::reports::study::step::Model;
use grainbench::store::key;
use grainbench::store::log::State;
use grainbench::studies::cost::against::{compare, shared};
use grainbench::studies::cost::knobs::SweepPoint;
use grainbench::studies::cost::run::{PointSelection, PointSet};
use grainbench::studies::cost::{load, step};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Expected durations (s) of measuring the cost of the parts of a step, and of a step with one and with 10,000 grains.
const BESIDE: [(&str, f64); 2] = [("prices", 40.0), ("loads", 90.0)];
/// Number of rounds in which the cost of a step is measured.
const ROUNDS: u32 = 5;

pub(crate) struct CostStudy {
    /// Points of each target quantity.
    sets: Vec<PointSet>,
    /// Index of the target quantity, and of the point in its set, of each task that measures a point.
    places: Vec<(usize, usize)>,
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
        let subjects = subjects(&arguments.cases)?;
        let (solvers, named) = NamedSolvers::read_for(&arguments.solver, is_shared)?;
        let wanted = PointSelection { solvers: named, all, counts: arguments.counts };
        let program = key::of_this_program();
        let set = |subject: TargetQuantity| {
            let program = program.clone() + &own::edition(subject.case);
            PointSet::new(subject, &wanted, &solvers, &program)
        };
        let sets: Vec<PointSet> = subjects.into_iter().map(set).collect();
        let of_set = |(number, set): (usize, &PointSet)| (0..set.count()).map(move |point| (number, point));
        let places: Vec<(usize, usize)> = sets.iter().enumerate().flat_map(of_set).collect();
        if places.is_empty() {
            refuse!("expected at least one point, found none for the selected cases and solvers");
        }
        let prices = !arguments.counts && (arguments.prices || arguments.cases.is_empty());
        Ok(Self { sets, places, solvers, wanted, prices, arguments: arguments.clone() })
    }

    /// Returns the number of tasks before the first point.
    fn beside(&self) -> usize {
        if self.prices { BESIDE.len() } else { 0 }
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
        let of_point = |place: &usize| self.places.get(place.checked_sub(self.beside())?).copied();
        let found: Vec<(usize, usize)> = places.iter().filter_map(of_point).collect();
        let Some(&(number, first)) = found.first() else { return self.perform_each(places, sink) };
        let points: Vec<usize> = found.iter().map(|(_, point)| *point).collect();
        // The tasks of a target quantity are consecutive.
        let start = places[0] - first;
        self.sets[number].measure(&points, &|name| sink.now(name), &mut |point, measured| {
            let is_failed = matches!(measured.standing, PointStatus::Failed | PointStatus::NotAvailable);
            let state = if is_failed { State::Failed } else { State::Done };
            let seconds = measured.repetitions.iter().map(|timing| timing.wall + timing.start_up).sum();
            sink.leave(start + point, state, seconds, Ok(Measured::Point(Box::new(measured))));
        });
    }
}

impl Study for CostStudy {
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
            for (id, SweepPoint { solver, resolution, knobs, .. }, seconds) in set.planned() {
                tasks.push(Task {
                    scene: format!("{}/{}", set.subject.case.name, set.subject.variant),
                    solver: solver.clone(),
                    level: if knobs.is_empty() { resolution.to_string() } else { format!("{resolution}, {knobs}") },
                    what: set.subject.quantity.clone(),
                    repetitions: if self.wanted.counts { 1 } else { 5 },
                    // One worker measures all points of a target quantity, with their repetitions in alternation.
                    group: if self.wanted.counts { None } else { Some(number) },
                    ..Task::new(id, seconds)
                });
            }
        }
        Ok(tasks)
    }

    fn inputs(&self) -> BTreeMap<String, String> {
        self.solvers.inputs()
    }

    fn report(&self, results: Vec<Option<Result<Measured, String>>>, how: &ReportOptions<'_>) -> Outcome {
        let old = how.against.map(points_of).transpose()?;
        let (results, has_crash) = outputs(results, how);
        let mut words = self.arguments.command_words();
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
        if let (Some(old), Some(path)) = (&old, how.against) {
            let new: Vec<Point> = study.diagrams.iter().flat_map(|diagram| diagram.points.clone()).collect();
            study.changes = compare(old, &new);
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            study.against = Some(format!("{name}, {} of {} points compared", shared(old, &new), new.len()));
        }
        how.publish(study, has_crash)
    }
}

/// Returns the target quantities of the named cases, in the order of the registry.
fn subjects(names: &[String]) -> Result<Vec<TargetQuantity>, Fault> {
    if let Some(case) = own::folder(names)? {
        return Ok((case.targets)(case));
    }
    let mut found = Vec::new();
    for (case, variants) in selected(names)? {
        found.extend((case.targets)(case).into_iter().filter(|subject| variants.contain(subject.variant)));
        for variant in variants.named() {
            if found.iter().all(|subject| subject.case.name != case.name || subject.variant != variant) {
                found.push(of_variant(case, variant)?);
            }
        }
    }
    if found.is_empty() {
        refuse!("expected a case with an exact solution for a single run, found none in the selection");
    }
    Ok(found)
}

/// Returns the target quantity of a variant that is not among those of the case. The error lists the variants with one.
fn of_variant(case: &'static Case, variant: &str) -> Result<TargetQuantity, Fault> {
    let mut all = of_each_variant(case);
    if let Some(at) = all.iter().position(|subject| subject.variant == variant) {
        return Ok(all.swap_remove(at));
    }
    let mut variants: Vec<&str> = all.iter().map(|subject| subject.variant).collect();
    variants.sort_unstable();
    let known = if variants.is_empty() { "no variant has one".to_owned() } else { variants.join(", ") };
    let expected = format!("a variant with an exact solution for a single run ({known})");
    Err(Fault::input(format!("{}/{variant}: expected {expected}, found one without", case.name)))
}
