//! Measures the points: one at a time, repetitions of one subject in turn.

use super::knobs::{self, Turn};
use crate::clock::{self, Clocked};
use crate::result_cache::ResultCache;
use crate::{Follow, identity};
use grainbench_harness::run::{Change, Done};
use grainbench_harness::solvers::Solvers;
use grainbench_harness::statistics::range;
use grainbench_harness::subject::Subject;
use grainbench_reports::WriteError;
use grainbench_reports::study::point::{Counts, Diagram, Point, Standing, Timing};
use grainbench_scene::record::Record;
use grainbench_scene::scene::{Duration, Scene};
use grainbench_scene::solver::{RunError, Solver};
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

/// Repetitions of a point that takes less than a second.
const REPETITIONS: usize = 5;
/// What takes longer than this (s) is measured once.
const SHORT: f64 = 1.0;
/// A repetition lasts this long at least (s): of what is shorter, it is several runs in a row.
const LEAST: f64 = 2e-3;
/// The reference is timed for this share of a run's time, before it and after it,
const SHARE: f64 = 0.025;
/// but no longer than this (s),
const LONG_ENOUGH: f64 = 0.01;
/// and as long as this (s) around a first run, for nothing is known of it yet.
const AT_FIRST: f64 = 0.002;
/// What takes this long (s) needs no run to warm the machine up: its first one counts.
const WARM: f64 = 0.05;
/// Most runs in a row.
const MOST: f64 = 50.0;
/// Points that take longer than this (s) are left to those who ask for all.
const LONGEST: f64 = 20.0;
/// Time of a program over that of ours, of the step of a grain: what is expected of one before it is run.
const PROGRAM: f64 = 4.0;
/// A refinement that leaves this much of the error has met a floor.
const FLOOR: f64 = 0.8;
/// The floor of a program's error.
const UNKNOWN: &str = "what no finer step takes away";
/// Errors below this are rounding, and no floor.
const ROUNDING: f64 = 1e-11;

/// What is wanted.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Only these solvers; all when none is named.
    pub solvers: Vec<String>,
    /// Points over twenty seconds too.
    pub all: bool,
    /// Errors and counts alone, of one run each, whose times are as they happen to be.
    pub counts: bool,
}

/// A point as it is known before it is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Planned {
    /// Its name in the result cache.
    pub name: String,
    /// Solver, its settings spelt out.
    pub solver: String,
    /// Resolution, with the other knobs, in words.
    pub setting: String,
    /// What all its repetitions are expected to take (s).
    pub seconds: f64,
}

/// One point to measure.
struct Task {
    turn: Turn,
    /// What is left of its error when the resolution is as fine as one likes.
    floor: &'static str,
    scene: Arc<Scene>,
    solver: Arc<dyn Solver>,
    /// The result cache.
    name: String,
    /// Processor time of a run of one step (s), of a program; what a program needs to start is no part of what steps
    /// cost. It is that of the scene, whatever the step.
    start: Arc<OnceLock<f64>>,
    /// Whether the solver is another program.
    is_program: bool,
    /// Whether it stays from run to run.
    stays: bool,
}

impl Task {
    /// Processor time that is not that of the steps (s).
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

/// Measures with solvers by name.
pub struct Meter<'a> {
    /// Hash of this program.
    pub program: String,
    /// Where finished points are kept.
    pub cache: &'a ResultCache,
    /// What is wanted.
    pub wanted: Wanted,
    /// Gives the solver of a name.
    pub solvers: &'a dyn Solvers,
}

impl<'a> Meter<'a> {
    /// A meter of some solvers.
    #[must_use]
    pub fn new(cache: &'a ResultCache, wanted: Wanted, solvers: &'a dyn Solvers) -> Self {
        Self { program: identity::of_this_program(), cache, wanted, solvers }
    }

    /// How many points a subject has.
    #[must_use]
    pub fn count(&self, subject: &Subject) -> usize {
        self.tasks(subject).len()
    }

    /// The points of a subject, in the order in which they are measured first.
    #[must_use]
    pub fn planned(&self, subject: &Subject) -> Vec<Planned> {
        let planned = |task: Task| {
            let once = knobs::nominal_seconds(&task.scene, &task.turn.resolution);
            let once = if task.is_program { PROGRAM * once } else { once };
            let times = if self.wanted.counts || once >= SHORT { 1.0 } else { 1.0 + REPETITIONS as f64 };
            // A repetition is no shorter than what the clock tells, and the reference is timed around each.
            let seconds = times * once.max(if self.wanted.counts { 0.0 } else { LEAST });
            let Turn { solver, resolution, knobs, .. } = task.turn;
            let setting = if knobs.is_empty() { resolution.to_string() } else { format!("{resolution}, {knobs}") };
            Planned { name: task.name, solver, setting, seconds }
        };
        self.tasks(subject).into_iter().map(planned).collect()
    }

    /// Measures a subject over all knobs.
    ///
    /// # Errors
    /// When a point cannot be kept.
    pub fn diagram(&self, subject: &Subject, follow: &mut dyn Follow) -> Result<Diagram, WriteError> {
        let tasks = self.tasks(subject);
        let points = self.measure(subject, &tasks, follow)?;
        Ok(drawn(subject, &tasks, points))
    }

    /// The diagram of what of a subject is finished, without measuring anything.
    #[must_use]
    pub fn finished(&self, subject: &Subject) -> Diagram {
        let mut tasks = self.tasks(subject);
        let mut points: Vec<Option<Point>> = tasks.iter().map(|task| self.cache.take(&task.name)).collect();
        let mut is_there = points.iter().map(Option::is_some).collect::<Vec<_>>().into_iter();
        tasks.retain(|_| is_there.next().unwrap_or_default());
        points.retain(Option::is_some);
        drawn(subject, &tasks, points)
    }

    /// Measures those points of a subject that have one of these names, in turn, and keeps each.
    ///
    /// # Errors
    /// When a point cannot be kept.
    pub fn measure_named(
        &self,
        subject: &Subject,
        wanted: &dyn Fn(&str) -> bool,
        follow: &mut dyn Follow,
    ) -> Result<(), WriteError> {
        let mut tasks = self.tasks(subject);
        tasks.retain(|task| wanted(&task.name));
        self.measure(subject, &tasks, follow).map(drop)
    }

    /// Measures tasks of a subject, what is finished left out: one at a time, repetitions in turn.
    fn measure(
        &self,
        subject: &Subject,
        tasks: &[Task],
        follow: &mut dyn Follow,
    ) -> Result<Vec<Option<Point>>, WriteError> {
        let mut points: Vec<Option<Point>> = tasks.iter().map(|task| self.cache.take(&task.name)).collect();
        points.iter().flatten().for_each(|_| follow.done(true));
        let mut open: Vec<(usize, f64, Point)> = Vec::new();
        for (at, task) in tasks.iter().enumerate() {
            if points[at].is_some() {
                continue;
            }
            follow.now(&format!("{} · {} {}", subject.case.name, task.turn.solver, task.turn.resolution));
            let point = first(subject, task);
            let whole = point.repetitions.first().map_or(0.0, |timing| timing.wall + timing.start_up);
            if whole < SHORT && point.standing == Standing::Measured && !self.wanted.counts {
                let repetitions = if whole < WARM { Vec::new() } else { point.repetitions };
                open.push((at, whole, Point { repetitions, ..point }));
            } else {
                self.cache.put(&task.name, &point)?;
                points[at] = Some(point);
                follow.done(false);
            }
        }
        for round in 1..=REPETITIONS {
            for (at, whole, point) in open.iter_mut().filter(|(_, _, point)| point.repetitions.len() < round) {
                follow.now(&format!("{} · {} again", subject.case.name, tasks[*at].turn.solver));
                point.repetitions.extend(repeated(&tasks[*at], *whole));
            }
        }
        for (at, _, mut point) in open {
            summarise(&mut point);
            self.cache.put(&tasks[at].name, &point)?;
            points[at] = Some(point);
            follow.done(false);
        }
        Ok(points)
    }

    fn tasks(&self, subject: &Subject) -> Vec<Task> {
        let Ok(plain) = subject.case.variant(subject.variant) else { return Vec::new() };
        let strangers = self.solvers.strangers();
        let mut tasks = Vec::new();
        let mut solvers: BTreeMap<String, Option<Arc<dyn Solver>>> = BTreeMap::new();
        for lane in &subject.lanes {
            let mut scene = plain.clone();
            if let Some(change) = &lane.prepare {
                let change: &Change = change;
                change(&mut scene);
            }
            let scene = Arc::new(scene);
            let mut starts: BTreeMap<String, Arc<OnceLock<f64>>> = BTreeMap::new();
            for turn in knobs::turns(lane, &strangers) {
                let named = &self.wanted.solvers;
                if !named.is_empty() && !named.iter().any(|name| *name == turn.solver || *name == turn.line) {
                    continue;
                }
                let is_program = self.solvers.is_program(&turn.solver);
                let slower = if is_program { PROGRAM } else { 1.0 };
                if !self.wanted.all && slower * knobs::nominal_seconds(&scene, &turn.resolution) > LONGEST {
                    continue;
                }
                let solver = solvers.entry(turn.solver.clone()).or_insert_with(|| self.solvers.find(&turn.solver));
                let Some(solver) = solver.clone() else { continue };
                let once = if self.wanted.counts { "|once" } else { "" };
                let read = format!("{}|{}|{}{once}", subject.quantity, subject.variant, turn.knobs);
                let program = self.program.clone() + &self.solvers.edition(&turn.solver);
                let name = identity::of_run(&program, &turn.solver, &scene, &turn.resolution, &read);
                // Two lanes may lead to the same run.
                if tasks.iter().all(|task: &Task| task.name != name) {
                    let start = Arc::clone(starts.entry(turn.solver.clone()).or_default());
                    let scene = Arc::clone(&scene);
                    let stranger = strangers.iter().find(|stranger| stranger.name == turn.solver);
                    let stays = stranger.is_some_and(|stranger| stranger.stays);
                    // Of a program nothing is known but that no finer step helps.
                    let floor = stranger.map_or(lane.method.floor(), |_| UNKNOWN);
                    tasks.push(Task { turn, floor, scene, solver, name, start, is_program, stays });
                }
            }
        }
        tasks
    }
}

/// The diagram of the points of some tasks.
fn drawn(subject: &Subject, tasks: &[Task], points: Vec<Option<Point>>) -> Diagram {
    let mut points: Vec<Point> = points.into_iter().flatten().collect();
    mark_floors(tasks, &mut points);
    Diagram {
        case: subject.case.name.to_owned(),
        variant: subject.variant.to_owned(),
        quantity: subject.quantity.clone(),
        source: subject.source.clone(),
        points,
    }
}

/// Runs a task once, with its times; none of them where nothing ran. The reference is timed for `lasting` seconds
/// before and after.
fn timed(task: &Task, lasting: f64) -> (Option<Timing>, Result<Record, RunError>) {
    let clocked = clock::clocked(lasting, || task.solver.run(&task.scene, &task.turn.resolution, &mut ()));
    let Clocked { done: record, cpu, wall: whole, reference } = clocked;
    let ran = matches!(record, Ok(_) | Err(RunError::Broken(_) | RunError::Program { .. }));
    // A run that broke left no record: all of its time is that of the loop.
    let wall = record.as_ref().map_or(whole, |record| record.cost.wall_seconds);
    let cpu = match (&record, task.stays) {
        // Time of a program that stays is not told before it ends: of one thread it is that of the clock.
        (Ok(_), true) => wall,
        (Ok(_), false) => (cpu - task.start()).max(0.0),
        (Err(_), _) => cpu,
    };
    (ran.then_some(Timing { wall, cpu, start_up: (whole - wall).max(0.0), reference }), record)
}

/// One repetition: the mean of some runs in a row, each of which takes about `whole` seconds.
fn repeated(task: &Task, whole: f64) -> Option<Timing> {
    let runs = (LEAST / whole).ceil().clamp(1.0, MOST) as usize;
    let lasting = (SHARE * whole).min(LONG_ENOUGH);
    let timings: Option<Vec<Timing>> = (0..runs).map(|_| timed(task, lasting).0).collect();
    let timings = timings?;
    let mean = |of: fn(&Timing) -> f64| timings.iter().map(of).sum::<f64>() / runs as f64;
    Some(Timing {
        wall: mean(|t| t.wall),
        cpu: mean(|t| t.cpu),
        start_up: mean(|t| t.start_up),
        reference: mean(|t| t.reference),
    })
}

/// The first run, with the error.
fn first(subject: &Subject, task: &Task) -> Point {
    let (timing, record) = timed(task, AT_FIRST);
    let mut point = Point {
        case: subject.case.name.to_owned(),
        variant: subject.variant.to_owned(),
        solver: task.turn.line.clone(),
        resolution: task.turn.resolution.to_string(),
        knobs: task.turn.knobs.clone(),
        quantity: subject.quantity.clone(),
        unit: subject.unit.to_owned(),
        standing: Standing::Failed,
        value: None,
        expected: None,
        error: None,
        floor: None,
        wall_seconds: None,
        wall_spread: None,
        cpu_seconds: None,
        start_up_seconds: None,
        repetitions: timing.into_iter().collect(),
        counts: Counts::default(),
        detail: None,
    };
    match record {
        Ok(record) => {
            point.counts = Counts::from(&record.cost);
            let done = Done::new(Arc::clone(&task.scene), Arc::new(record));
            match (subject.measure)(&[done]) {
                Ok(measured) if measured.error().is_finite() => {
                    point.standing = Standing::Measured;
                    point.value = Some(measured.value);
                    point.expected = measured.expected.value();
                    point.error = Some(measured.error().abs());
                }
                Ok(_) => point.detail = Some("its error is not finite".to_owned()),
                Err(missing) => {
                    point.standing = Standing::Unsupported;
                    point.detail = Some(missing.to_string());
                }
            }
        }
        Err(error) => {
            point.standing = match &error {
                RunError::Unsupported { .. } => Standing::Unsupported,
                RunError::NotAvailable { .. } => Standing::NotAvailable,
                _ => Standing::Failed,
            };
            point.detail = Some(error.to_string());
        }
    }
    summarise(&mut point);
    point
}

/// Medians and spread of the repetitions.
fn summarise(point: &mut Point) {
    let range_of = |of: fn(&Timing) -> f64| range(&point.repetitions.iter().map(of).collect::<Vec<_>>());
    let median_of = |of: fn(&Timing) -> f64| range_of(of).map(|[_, median, _]| median);
    let (walls, cpu_seconds, start_up) =
        (range_of(|timing| timing.wall), median_of(|timing| timing.cpu), median_of(|timing| timing.start_up));
    // Of a program that does not tell it is the whole less a run of no steps: nothing is left where the start varies by more.
    point.wall_seconds = walls.map(|[_, median, _]| median).filter(|median| *median > 0.0);
    point.start_up_seconds = start_up;
    // Of a program it is the difference of two times, which tells nothing where both are mostly start-up.
    let told = |cpu: &f64| *cpu >= 0.1 * point.start_up_seconds.unwrap_or(0.0);
    point.cpu_seconds = cpu_seconds.filter(told);
    point.wall_spread = match walls {
        Some([first, median, last]) if point.repetitions.len() > 1 && median > 0.0 => Some((last - first) / median),
        _ => None,
    };
}

/// Marks where finer resolutions no longer make the error smaller: the last two of a sequence, if they differ by less
/// than a fifth.
fn mark_floors(tasks: &[Task], points: &mut [Point]) {
    let mut sequences: BTreeMap<(String, String), Vec<(f64, usize)>> = BTreeMap::new();
    for (at, task) in tasks.iter().enumerate() {
        if let (Some(fineness), Standing::Measured) = (task.turn.sequence, points[at].standing) {
            let line = (task.turn.solver.clone(), task.turn.knobs.clone());
            sequences.entry(line).or_default().push((fineness, at));
        }
    }
    for sequence in sequences.values_mut() {
        sequence.sort_by(|a, b| a.0.total_cmp(&b.0));
        let error = |place: usize| points[sequence[place].1].error.unwrap_or(f64::NAN);
        let last = sequence.len() - 1;
        if last < 2 {
            continue;
        }
        let (before, finest) = (error(last - 1), error(last));
        let meets = finest > ROUNDING && finest >= FLOOR * before && finest <= before / FLOOR;
        if !meets {
            continue;
        }
        let at_floor: Vec<usize> = sequence
            .iter()
            .map(|(_, at)| *at)
            .filter(|&at| points[at].error.is_some_and(|error| error >= FLOOR * finest && error <= finest / FLOOR))
            .collect();
        for at in at_floor {
            let knobs = if points[at].knobs.is_empty() { String::new() } else { format!(" at {}", points[at].knobs) };
            points[at].floor = Some(format!("{}{knobs}", tasks[at].floor));
        }
    }
}
