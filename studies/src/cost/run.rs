//! Measurement of the points of the cost study, one at a time. Repetitions of the points of a target quantity
//! alternate.

use super::knobs::{self, SweepPoint};
use crate::clock::{self, TimedResult};
use crate::run_cache::run_words;
use grainbench_harness::run::FinishedRun;
use grainbench_harness::solvers::Solvers;
use grainbench_harness::statistics::range;
use grainbench_harness::subject::TargetQuantity;
use grainbench_reports::study::point::{Counts, Diagram, Point, PointStatus, Timing};
use grainbench_scene::scene::{Duration, Scene};
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::record::Record;
use grainbench_store::key::Id;
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

/// Number of repetitions of a point that takes less than a second.
const REPETITIONS: usize = 5;
/// Longest run that is repeated (s). A longer run is measured once.
const SHORT: f64 = 1.0;
/// Shortest duration of a repetition (s). A repetition of a shorter run consists of several runs.
const LEAST: f64 = 2e-3;
/// Duration of the reference timing before and after a run, as a fraction of the run time.
const SHARE: f64 = 0.025;
/// Longest duration of a reference timing (s).
const LONG_ENOUGH: f64 = 0.01;
/// Duration of the reference timing before and after a first run (s), whose run time is still unknown.
const AT_FIRST: f64 = 0.002;
/// Shortest run that needs no warm-up (s). If the first run of a point takes at least this time, it counts as a repetition.
const WARM: f64 = 0.05;
/// Maximum number of runs in a repetition.
const MOST: f64 = 50.0;
/// Longest expected run that is measured by default (s).
const LONGEST: f64 = 20.0;
/// Assumed run time of another program relative to our solver.
const PROGRAM: f64 = 4.0;
/// Smallest ratio of the errors of two successive refinements that counts as stagnation at an error floor. The largest
/// ratio is its reciprocal.
const FLOOR: f64 = 0.8;
/// Cause of the error floor of an external solver, which is unknown.
const UNKNOWN: &str = "error that smaller steps do not reduce";
/// Errors below this are rounding errors, not a floor.
const ROUNDING: f64 = 1e-11;

/// Selection of points, and extent of the measurement.
#[derive(Clone, Debug, Default)]
pub struct PointSelection {
    /// Solvers to measure; all if empty.
    pub solvers: Vec<String>,
    /// True to include points that are expected to take longer than 20 s.
    pub all: bool,
    /// True to measure only errors and counts, with one run per point. The time of this run is not meaningful.
    pub counts: bool,
}

/// Point to measure.
struct Task {
    turn: SweepPoint,
    /// Cause of the error that remains at the finest resolutions.
    floor: &'static str,
    scene: Arc<Scene>,
    solver: Arc<dyn Solver>,
    id: Id,
    /// Processor time of a run of one step by another program (s). Points with the same scene and solver share it.
    ///
    /// It estimates the start-up, which is not part of the cost of steps.
    start: Arc<OnceLock<f64>>,
    /// True for another program: LAMMPS, LIGGGHTS or an external solver.
    is_program: bool,
    /// True if the external solver keeps running between runs.
    stays: bool,
}

impl Task {
    /// Returns the processor time of the start-up (s); zero for our solvers.
    fn start(&self) -> f64 {
        if !self.is_program {
            return 0.0;
        }
        *self.start.get_or_init(|| {
            let scene = Scene { duration: Duration::Cycles(1), snapshots: 0, ..(*self.scene).clone() };
            let before = clock::cpu_seconds();
            match self.solver.run(&scene, &self.turn.resolution, &mut ()) {
                Ok(_) => clock::cpu_seconds() - before,
                Err(_) => 0.0,
            }
        })
    }
}

/// Selected points of a target quantity.
pub struct PointSet {
    /// Target quantity.
    pub subject: TargetQuantity,
    tasks: Vec<Task>,
    /// True to measure only errors and counts.
    counts: bool,
}

impl PointSet {
    /// Selects the points of a target quantity. `program` is the hash of this program.
    #[must_use]
    pub fn new(subject: TargetQuantity, wanted: &PointSelection, solvers: &dyn Solvers, program: &str) -> Self {
        Self { tasks: tasks(&subject, wanted, solvers, program), subject, counts: wanted.counts }
    }

    /// Returns the number of points.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.tasks.len()
    }

    /// Returns the id and the expected time of all repetitions (s) of each point, in the order of their first measurement.
    pub fn planned(&self) -> impl Iterator<Item = (Id, &SweepPoint, f64)> {
        self.tasks.iter().map(|task| {
            let once = knobs::nominal_seconds(&task.scene, &task.turn.resolution);
            let once = if task.is_program { PROGRAM * once } else { once };
            let times = if self.counts || once >= SHORT { 1.0 } else { 1.0 + REPETITIONS as f64 };
            // A repetition lasts at least `LEAST`, because of the resolution of the clock.
            (task.id, &task.turn, times * once.max(if self.counts { 0.0 } else { LEAST }))
        })
    }

    /// Measures the points with the given indices, one at a time, with repetitions in alternation. Calls `now` with the
    /// name of the next run, and `leave` with each measured point.
    pub fn measure(&self, places: &[usize], now: &dyn Fn(&str), leave: &mut dyn FnMut(usize, Point)) {
        let mut open: Vec<(usize, f64, Point)> = Vec::new();
        for &place in places {
            let task = &self.tasks[place];
            now(&format!("{} · {} {}", self.subject.case.name, task.turn.solver, task.turn.resolution));
            let point = first(&self.subject, task);
            let whole = point.repetitions.first().map_or(0.0, |timing| timing.wall + timing.start_up);
            if whole < SHORT && point.standing == PointStatus::Measured && !self.counts {
                let repetitions = if whole < WARM { Vec::new() } else { point.repetitions };
                open.push((place, whole, Point { repetitions, ..point }));
            } else {
                leave(place, point);
            }
        }
        for round in 1..=REPETITIONS {
            for (place, whole, point) in open.iter_mut().filter(|(_, _, point)| point.repetitions.len() < round) {
                let task = &self.tasks[*place];
                now(&format!("{} · {} again", self.subject.case.name, task.turn.solver));
                point.repetitions.extend(repeated(task, *whole));
            }
        }
        for (place, _, mut point) in open {
            summarise(&mut point);
            leave(place, point);
        }
    }

    /// Returns the diagram of the measured points, with error floors marked. `points` has an entry for each point.
    #[must_use]
    pub fn diagram(&self, points: Vec<Option<Point>>) -> Diagram {
        let measured = self.tasks.iter().zip(points).filter_map(|(task, point)| Some((task, point?)));
        let (tasks, mut points): (Vec<&Task>, Vec<Point>) = measured.unzip();
        mark_floors(&tasks, &mut points);
        Diagram {
            case: self.subject.case.name.to_owned(),
            variant: self.subject.variant.to_owned(),
            quantity: self.subject.quantity.clone(),
            source: self.subject.source.clone(),
            points,
        }
    }
}

fn tasks(subject: &TargetQuantity, wanted: &PointSelection, solvers: &dyn Solvers, program: &str) -> Vec<Task> {
    let Ok(plain) = subject.case.variant(subject.variant) else { return Vec::new() };
    let external_solvers = solvers.external_solvers();
    let mut tasks = Vec::new();
    let mut found: BTreeMap<String, Option<Arc<dyn Solver>>> = BTreeMap::new();
    for lane in &subject.lanes {
        let mut scene = plain.clone();
        if let Some(change) = &lane.prepare {
            change(&mut scene);
        }
        let scene = Arc::new(scene);
        let mut starts: BTreeMap<String, Arc<OnceLock<f64>>> = BTreeMap::new();
        for turn in knobs::turns(lane, &external_solvers) {
            let named = &wanted.solvers;
            if !named.is_empty() && !named.iter().any(|name| *name == turn.solver || *name == turn.line) {
                continue;
            }
            let is_program = solvers.is_program(&turn.solver);
            let slower = if is_program { PROGRAM } else { 1.0 };
            if !wanted.all && slower * knobs::nominal_seconds(&scene, &turn.resolution) > LONGEST {
                continue;
            }
            let solver = found.entry(turn.solver.clone()).or_insert_with(|| solvers.find(&turn.solver));
            let Some(solver) = solver.clone() else { continue };
            let once = if wanted.counts { "|once" } else { "" };
            let read = format!("{}|{}|{}{once}", subject.quantity, subject.variant, turn.knobs);
            let words = run_words(&turn.solver, &scene, &turn.resolution, &read);
            let id = Id::of_words(
                &(program.to_owned() + &solvers.edition(&turn.solver)),
                &words.each_ref().map(String::as_str),
            );
            // Two solver setups may lead to the same run.
            if tasks.iter().all(|task: &Task| task.id != id) {
                let start = Arc::clone(starts.entry(turn.solver.clone()).or_default());
                let scene = Arc::clone(&scene);
                let external = external_solvers.iter().find(|external| external.name == turn.solver);
                let stays = external.is_some_and(|external| external.stays);
                // The cause of the floor of an external solver is unknown.
                let floor = external.map_or(lane.method.floor(), |_| UNKNOWN);
                tasks.push(Task { turn, floor, scene, solver, id, start, is_program, stays });
            }
        }
    }
    tasks
}

/// Runs a point once and returns its times, or `None` if the run did not start. The reference task is timed for
/// `lasting` seconds before and after the run.
fn timed(task: &Task, lasting: f64) -> (Option<Timing>, Result<Record, RunError>) {
    let clocked = clock::clocked(lasting, || task.solver.run(&task.scene, &task.turn.resolution, &mut ()));
    let TimedResult { done: record, cpu, wall: whole, reference } = clocked;
    let ran = matches!(record, Ok(_) | Err(RunError::Broken(_) | RunError::Program { .. }));
    // A failed run has no record, so its whole time counts as time of the stepping loop.
    let wall = record.as_ref().map_or(whole, |record| record.cost.wall_seconds);
    let cpu = match (&record, task.stays) {
        // The processor time of a program that keeps running is unknown. With one thread it equals the wall time.
        (Ok(_), true) => wall,
        (Ok(_), false) => (cpu - task.start()).max(0.0),
        (Err(_), _) => cpu,
    };
    (ran.then_some(Timing { wall, cpu, start_up: (whole - wall).max(0.0), reference }), record)
}

/// Measures one repetition: the mean of several consecutive runs, each of about `whole` seconds.
fn repeated(task: &Task, whole: f64) -> Option<Timing> {
    let runs = (LEAST / whole).ceil().clamp(1.0, MOST) as usize;
    let lasting = (SHARE * whole).min(LONG_ENOUGH);
    let timings: Option<Vec<Timing>> = (0..runs).map(|_| timed(task, lasting).0).collect();
    let timings = timings?;
    let mean = |value: fn(&Timing) -> f64| timings.iter().map(value).sum::<f64>() / runs as f64;
    Some(Timing {
        wall: mean(|t| t.wall),
        cpu: mean(|t| t.cpu),
        start_up: mean(|t| t.start_up),
        reference: mean(|t| t.reference),
    })
}

/// Runs a point for the first time and evaluates its error.
fn first(subject: &TargetQuantity, task: &Task) -> Point {
    let (timing, record) = timed(task, AT_FIRST);
    let mut point = Point {
        case: subject.case.name.to_owned(),
        variant: subject.variant.to_owned(),
        solver: task.turn.line.clone(),
        resolution: task.turn.resolution.to_string(),
        knobs: task.turn.knobs.clone(),
        quantity: subject.quantity.clone(),
        unit: subject.unit.to_owned(),
        repetitions: timing.into_iter().collect(),
        ..Point::default()
    };
    match record {
        Ok(record) => {
            point.counts = Counts::from(&record.cost);
            let done = FinishedRun::new(Arc::clone(&task.scene), Arc::new(record));
            match (subject.measure)(&[done]).map(|measured| (measured.expected.value(), measured)) {
                Ok((Some(expected), measured)) if measured.error().is_finite() => {
                    point.standing = PointStatus::Measured;
                    point.value = Some(measured.value);
                    point.expected = Some(expected);
                    point.error = Some(measured.error().abs());
                }
                Ok((Some(_), _)) => point.detail = Some("its error is not finite".to_owned()),
                Ok((None, _)) => point.detail = Some("a bound is expected, which gives no error".to_owned()),
                Err(missing) => {
                    point.standing = PointStatus::Unsupported;
                    point.detail = Some(missing.to_string());
                }
            }
        }
        Err(error) => {
            point.standing = match &error {
                RunError::Unsupported { .. } => PointStatus::Unsupported,
                RunError::NotAvailable { .. } => PointStatus::NotAvailable,
                _ => PointStatus::Failed,
            };
            point.detail = Some(error.to_string());
        }
    }
    summarise(&mut point);
    point
}

/// Computes the medians and the spread of the repetitions.
fn summarise(point: &mut Point) {
    let range_of = |value: fn(&Timing) -> f64| range(&point.repetitions.iter().map(value).collect::<Vec<_>>());
    let median_of = |value: fn(&Timing) -> f64| range_of(value).map(|[_, median, _]| median);
    let (walls, cpu_seconds, start_up) =
        (range_of(|timing| timing.wall), median_of(|timing| timing.cpu), median_of(|timing| timing.start_up));
    // If a program reports no time of its stepping loop, its wall time is the total time minus the time of a run
    // without steps. The difference is negative if the start-up time varies by more. Such a point has no wall time.
    point.wall_seconds = walls.map(|[_, median, _]| median).filter(|median| *median > 0.0);
    point.start_up_seconds = start_up;
    // The processor time of another program is a difference of two times. If the difference is small compared with the
    // start-up time, it is noise.
    let is_reliable = |cpu: &f64| *cpu >= 0.1 * point.start_up_seconds.unwrap_or(0.0);
    point.cpu_seconds = cpu_seconds.filter(is_reliable);
    point.wall_spread = match walls {
        Some([first, median, last]) if point.repetitions.len() > 1 && median > 0.0 => Some((last - first) / median),
        _ => None,
    };
}

/// Marks the points of a sequence at which finer resolutions do not reduce the error further.
///
/// A sequence needs at least three points. The ratio of the finest error to the error before it must be from [`FLOOR`] to
/// 1/[`FLOOR`]. All points whose ratio to the finest error is in this range are marked.
fn mark_floors(tasks: &[&Task], points: &mut [Point]) {
    let mut sequences: BTreeMap<(String, String), Vec<(f64, usize)>> = BTreeMap::new();
    for (at, task) in tasks.iter().enumerate() {
        if let (Some(fineness), PointStatus::Measured) = (task.turn.sequence, points[at].standing) {
            let line = (task.turn.solver.clone(), task.turn.knobs.clone());
            sequences.entry(line).or_default().push((fineness, at));
        }
    }
    for sequence in sequences.values_mut() {
        sequence.sort_by(|a, b| a.0.total_cmp(&b.0));
        let &[_, .., before, finest] = sequence.as_slice() else { continue };
        let [before, finest] = [before, finest].map(|(_, at)| points[at].error.unwrap_or(f64::NAN));
        let meets = finest > ROUNDING && finest >= FLOOR * before && finest <= before / FLOOR;
        if !meets {
            continue;
        }
        for &(_, at) in sequence.iter() {
            let point = &mut points[at];
            if point.error.is_some_and(|error| error >= FLOOR * finest && error <= finest / FLOOR) {
                let knobs = if point.knobs.is_empty() { String::new() } else { format!(" at {}", point.knobs) };
                point.floor = Some(format!("{}{knobs}", tasks[at].floor));
            }
        }
    }
}
