//! Judging what any program left of a case: by the exact answers of the case's gates, and by what our solvers make of the
//! same scene.

use grainbench_cases::case::{Case, PLAIN};
use grainbench_cases::figure::{Axis, Curve, Drawing, Figure, Graph, Stroke};
use grainbench_cases::gate::{Done, Gate, Measured};
use grainbench_cases::scope::Scope;
use grainbench_cases::verdict::{Evidence, Outcome, Verdict};
use grainbench_dem::convention::Convention;
use grainbench_dem::solver::Dem;
use grainbench_reference::observer::Observed;
use grainbench_reference::outputs::{OutputError, Outputs};
use grainbench_reports::{Section, number};
use grainbench_scene::error::SceneError;
use grainbench_scene::motion::Moment;
use grainbench_scene::record::{Cost, Provenance, Record, Series};
use grainbench_scene::scene::{Duration, ProbeTarget, Sampling, Scene};
use grainbench_scene::solver::{Resolution, Solver};
use std::sync::Arc;
use thiserror::Error;

/// Why outputs cannot be judged.
#[derive(Debug, Error)]
pub enum NotChecked {
    /// The files are damaged or lack something.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The case's scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Several variants start as they do.
    #[error("{file}: expected the name of a variant, for several of {case} start so; found none of {variants}")]
    Ambiguous {
        /// The files.
        file: String,
        /// The case.
        case: String,
        /// The variants that start so.
        variants: String,
    },
    /// They are of another scene.
    #[error("{file}: expected the start of a scene of {case}, {expected}; found {found}")]
    OtherScene {
        /// The files.
        file: String,
        /// The case, with its variant.
        case: String,
        /// Where the first grain that differs should be.
        expected: String,
        /// Where it is.
        found: String,
    },
}

/// What our solvers owe each other beside what is measured: a millionth of the scale.
const FLOOR: f64 = 1e-6;
/// How far a start may be off, in radii, beside the printed digits.
const START: f64 = 1e-9;
/// Most values of our runs that are compared.
const MOST_SAMPLES: u64 = 2_000_000;

/// A scene that the outputs may be of.
struct Candidate {
    variant: String,
    scene: Scene,
    /// The gates whose scene it is.
    gates: Vec<Gate>,
}

/// Judges the outputs of a case's scene, of one variant or of whichever they start as.
///
/// # Errors
/// When the files cannot be read, or start as no scene of the case does.
pub fn check(case: &'static Case, variant: Option<&str>, outputs: &Outputs) -> Result<Section, NotChecked> {
    let mut first_miss = None;
    let mut matching: Vec<(Candidate, Observed)> = Vec::new();
    for candidate in candidates(case, variant)? {
        let observed = outputs.observe(&candidate.scene);
        let observed = match (observed, &first_miss) {
            (Ok(observed), _) => observed,
            // Another variant may have another number of grains; the first one is what is told.
            (Err(error), None) => {
                first_miss = Some(NotChecked::Output(error));
                continue;
            }
            (Err(_), Some(_)) => continue,
        };
        match misplaced(&candidate.scene, &observed) {
            None => matching.push((candidate, observed)),
            Some((expected, found)) if first_miss.is_none() => {
                let place = variant.map_or_else(|| case.name.to_owned(), |variant| format!("{}/{variant}", case.name));
                first_miss = Some(NotChecked::OtherScene { file: outputs.name(), case: place, expected, found });
            }
            Some(_) => {}
        }
    }
    let mut variants: Vec<&str> = matching.iter().map(|(candidate, _)| candidate.variant.as_str()).collect();
    variants.dedup();
    if variants.len() > 1 {
        let variants = variants.join(", ");
        return Err(NotChecked::Ambiguous { file: outputs.name(), case: case.name.to_owned(), variants });
    }
    if let Some((candidate, observed)) = matching.first() {
        return Ok(section(case, candidate, outputs, observed));
    }
    Err(first_miss.unwrap_or_else(|| NotChecked::OtherScene {
        file: outputs.name(),
        case: case.name.to_owned(),
        expected: "a variant with a scene".to_owned(),
        found: "none".to_owned(),
    }))
}

/// The scenes as they stand, and those that gates fair to any solver adjust.
fn candidates(case: &'static Case, variant: Option<&str>) -> Result<Vec<Candidate>, SceneError> {
    let mut names = case.variants()?;
    if !names.iter().any(|name| name == PLAIN) {
        names.push(PLAIN.to_owned());
    }
    names.retain(|name| variant.is_none_or(|variant| variant == name));
    let mut candidates: Vec<Candidate> = Vec::new();
    for name in names {
        candidates.push(Candidate { scene: case.variant(&name)?, variant: name, gates: Vec::new() });
    }
    for gate in (case.gates)() {
        let [run] = &gate.runs[..] else { continue };
        if gate.scope != Scope::AnySolver || variant.is_some_and(|variant| variant != run.variant) {
            continue;
        }
        let mut scene = case.variant(run.variant)?;
        if let Some((_, change)) = &run.adjustment {
            change(&mut scene);
        }
        let variant = run.variant.to_owned();
        match candidates.iter_mut().find(|other| other.variant == variant && other.scene == scene) {
            Some(candidate) => candidate.gates.push(gate),
            None => candidates.push(Candidate { variant, scene, gates: vec![gate] }),
        }
    }
    Ok(candidates)
}

/// Where the first grain that does not start as in the scene should be, and where it is.
fn misplaced(scene: &Scene, observed: &Observed) -> Option<(String, String)> {
    let time = observed.series.time.first().copied()?;
    if time.abs() > 0.0 {
        return Some(("at time 0".to_owned(), format!("a first sample at {time} s")));
    }
    for (at, column) in observed.series.columns.iter().enumerate() {
        let (probe, quantity) = column.name.rsplit_once('.')?;
        let probe = scene.probes.iter().find(|other| other.name == probe)?;
        let (ProbeTarget::Grain(grain), Some(axis)) =
            (probe.target, ["x", "y", "z"].iter().position(|axis| *axis == quantity))
        else {
            continue;
        };
        let (expected, radius) = (scene.grains[grain].position[axis], scene.grains[grain].radius);
        let (found, open) = (observed.series.values[at][0], observed.uncertainty[at][0]);
        if (found - expected).abs() > open + START * radius {
            return Some((format!("{} = {expected:?} m", column.name), format!("{found:?} m")));
        }
    }
    None
}

fn section(case: &'static Case, candidate: &Candidate, outputs: &Outputs, observed: &Observed) -> Section {
    let file = outputs.name();
    let step = outputs.time_step();
    let row = |quantity: String, unit: &str| Verdict {
        case: case.name.to_owned(),
        variant: candidate.variant.clone(),
        solver: file.clone(),
        resolution: step.map_or_else(|| "step not told".to_owned(), |step| Resolution::TimeStep(step).to_string()),
        quantity,
        unit: unit.to_owned(),
        value: None,
        expected: None,
        scale: None,
        error: None,
        allowed: 0.0,
        because: String::new(),
        evidence: Evidence::OtherCode,
        source: String::new(),
        outcome: Outcome::NoReference,
        detail: None,
    };
    let mut verdicts: Vec<Verdict> =
        candidate.gates.iter().map(|gate| exact(gate, candidate, outputs, observed, &row)).collect();
    let (compared, figures) = step.map_or_else(
        || (Err("the files do not tell the time step (--dt gives it)".to_owned()), Vec::new()),
        |step| match ours(&candidate.scene, step, observed) {
            Ok(ours) => {
                (Ok(compare(&candidate.scene, &ours, outputs, observed, &row)), figures(&ours, &file, observed))
            }
            Err(reason) => (Err(reason), Vec::new()),
        },
    );
    match compared {
        Ok(rows) => verdicts.extend(rows),
        Err(reason) => {
            let quantity = "comparison with our solvers".to_owned();
            verdicts.push(Verdict { detail: Some(reason), because: "none was made".to_owned(), ..row(quantity, "1") });
        }
    }
    Section {
        name: case.name.to_owned(),
        title: format!("{}: {file}", case.title),
        claim: format!(
            "The output of another program, `{file}`, printed with up to {} significant digits, against the exact answers of \
             this case and against our solvers on the same scene.",
            outputs.significant_digits()
        ),
        derivation: case.derivation.to_owned(),
        weak: case.weakness.to_owned(),
        figures,
        verdicts,
        controls: Vec::new(),
        runs: Vec::new(),
    }
}

/// A gate of the case, its tolerance widened by what the printed digits may have moved the quantity.
fn exact(
    gate: &Gate,
    candidate: &Candidate,
    outputs: &Outputs,
    observed: &Observed,
    row: &dyn Fn(String, &str) -> Verdict,
) -> Verdict {
    let scene = Arc::new(candidate.scene.clone());
    let measured = |series: Series| {
        let record = record(&candidate.scene, outputs, observed, series);
        (gate.measure)(&[Done { scene: Arc::clone(&scene), record: Arc::new(record) }])
    };
    let mut verdict = row(gate.quantity.clone(), gate.unit);
    verdict.evidence = gate.evidence;
    verdict.source = gate.source.to_owned();
    verdict.allowed = gate.allowed;
    verdict.because = gate.because.to_owned();
    let found = match measured(observed.series.clone()) {
        Ok(found) => found,
        Err(missing) => {
            verdict.detail = Some(missing.to_string());
            return verdict;
        }
    };
    let mut open = 0.0;
    for (at, moves) in observed.uncertainty.iter().enumerate() {
        let moved = |sign: f64| {
            let mut series = observed.series.clone();
            series.values[at].iter_mut().zip(moves).for_each(|(value, by)| *value += sign * by);
            measured(series).map_or(0.0, |moved| (moved.error() - found.error()).abs())
        };
        if moves.iter().any(|by| *by > 0.0) {
            open += moved(1.0).max(moved(-1.0));
        }
    }
    verdict.allowed += open;
    judge(&mut verdict, &found, open, outputs);
    verdict
}

/// Fills in what was measured, and how the row ends.
fn judge(verdict: &mut Verdict, found: &Measured, open: f64, outputs: &Outputs) {
    let finite = |value: f64| value.is_finite().then_some(value);
    let error = found.error();
    (verdict.value, verdict.expected) = (finite(found.value), finite(found.expected));
    (verdict.scale, verdict.error) = (finite(found.scale), finite(error));
    verdict.outcome = if error.abs() <= verdict.allowed { Outcome::Pass } else { Outcome::Fail };
    // Below a thousandth of the tolerance nobody need know.
    if open > 1e-3 * verdict.allowed {
        let digits = outputs.significant_digits();
        let widened = format!("; widened by {} for the digits printed, {digits} at most", number::fraction(open));
        verdict.because.push_str(&widened);
    }
    if verdict.outcome == Outcome::Fail {
        let outside = |error: &f64| error.is_nan() || error.abs() > verdict.allowed;
        let first = found.course.iter().find(|(_, error)| outside(error));
        verdict.detail = first.map(|(time, _)| format!("first outside at t = {time:.6} s"));
    }
}

fn record(scene: &Scene, outputs: &Outputs, observed: &Observed, series: Series) -> Record {
    let steps = observed.series.step.last().copied().unwrap_or_default();
    let critical = scene.critical_time_step();
    Record {
        provenance: Provenance {
            scene: scene.title.clone(),
            solver: outputs.name(),
            resolution: String::new(),
            time_step: outputs.time_step().unwrap_or(f64::NAN),
            critical_time_step: critical.is_finite().then_some(critical),
            effects: Vec::new(),
            options: Vec::new(),
        },
        series,
        snapshots: observed.snapshots.clone(),
        cost: Cost { steps, ..Cost::default() },
    }
}

/// What our solvers make of a scene at the times of some outputs.
struct Ours {
    /// Conventions, and one of them with half the time step.
    runs: Vec<(&'static str, Series)>,
    twin: Series,
    /// Place of each observed sample in the series of the runs.
    places: Vec<usize>,
}

fn ours(scene: &Scene, step: f64, observed: &Observed) -> Result<Ours, String> {
    let steps = &observed.series.step;
    let (Some(&last), true) = (steps.last(), steps.windows(2).all(|pair| pair[0] < pair[1])) else {
        return Err("the steps do not grow".to_owned());
    };
    let off = |(step_, time): (&u64, &f64)| (*step_ as f64 * step - time).abs() > 1e-6 * step.max(*time);
    if let Some(at) = steps.iter().zip(&observed.series.time).position(off) {
        return Err(format!("the time {} s is no whole number of steps of {step} s", observed.series.time[at]));
    }
    let interval = steps.iter().fold(0, |all, &step| common_divisor(all, step)).max(1);
    if last / interval > MOST_SAMPLES {
        return Err(format!("{} samples are more than {MOST_SAMPLES}", last / interval));
    }
    let run = |convention: Convention, halves: u64| {
        let sampling = Sampling::Cycles(interval * halves);
        let mut scene = Scene { duration: Duration::Cycles(last * halves), sampling, snapshots: 0, ..scene.clone() };
        // What lasts a number of cycles lasts twice as many of half the length.
        for phase in scene.walls.iter_mut().flat_map(|wall| &mut wall.motion.phases) {
            for moment in [&mut phase.start, &mut phase.stop] {
                if let Moment::Cycle(cycle) = moment {
                    *cycle *= halves;
                }
            }
        }
        let record = Dem::new(convention).run(&scene, &Resolution::TimeStep(step / halves as f64), &mut ());
        record.map(|record| record.series).map_err(|error| error.to_string())
    };
    let conventions = [Convention::CUNDALL_STRACK, Convention::LAMMPS, Convention::LIGGGHTS];
    let mut runs = Vec::new();
    for convention in conventions {
        runs.push((convention.name, run(convention, 1)?));
    }
    let places = steps.iter().map(|step| (step / interval) as usize).collect();
    Ok(Ours { runs, twin: run(Convention::LAMMPS, 2)?, places })
}

fn common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

impl Ours {
    /// A column of one of the runs at the observed samples.
    fn at(&self, series: &Series, name: &str) -> Option<Vec<f64>> {
        let values = series.column(name)?;
        self.places.iter().map(|&place| values.get(place).copied()).collect()
    }
}

/// Columns that are compared: of the motion, and the kinetic energy.
fn is_compared(name: &str) -> bool {
    let quantity = name.rsplit_once('.').map_or(name, |(_, quantity)| quantity);
    ["x", "y", "z", "vx", "vy", "vz", "kinetic_energy"].contains(&quantity) || quantity.starts_with("omega")
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().map(f64::abs).fold(0.0, f64::max)
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// Coordinates from where they start, all else as it is.
fn difference_from_start(values: &[f64], unit: &str) -> Vec<f64> {
    let start = if unit == "m" { values.first().copied().unwrap_or(0.0) } else { 0.0 };
    values.iter().map(|value| value - start).collect()
}

/// A row a column: against the convention that is nearest as a whole, within what the conventions and half the time step
/// leave open.
fn compare(
    scene: &Scene,
    ours: &Ours,
    outputs: &Outputs,
    observed: &Observed,
    row: &dyn Fn(String, &str) -> Verdict,
) -> Vec<Verdict> {
    struct Compared<'c> {
        name: &'c str,
        unit: &'c str,
        values: &'c [f64],
        scale: f64,
        runs: Vec<Vec<f64>>,
        twin: Vec<f64>,
        open: f64,
    }
    let mut columns: Vec<Compared<'_>> = Vec::new();
    for (at, column) in observed.series.columns.iter().enumerate().filter(|(_, column)| is_compared(&column.name)) {
        let runs: Option<Vec<Vec<f64>>> = ours.runs.iter().map(|(_, series)| ours.at(series, &column.name)).collect();
        let (Some(runs), Some(twin)) = (runs, ours.at(&ours.twin, &column.name)) else { continue };
        let (values, moves) = (&observed.series.values[at], &observed.uncertainty[at]);
        columns.push(Compared {
            name: &column.name,
            unit: &column.unit,
            values,
            scale: 0.0,
            runs,
            twin,
            open: largest(moves),
        });
    }
    let extent = |unit: &str| {
        let of_unit = columns.iter().filter(|column| column.unit == unit);
        of_unit.map(|column| largest(&difference_from_start(&column.runs[1], unit))).fold(0.0, f64::max)
    };
    // One scale for all columns of a unit: what does not move along one axis is not judged by its rounding there, nor what
    // hardly turns by its own spin.
    let radius = scene.grains.iter().map(|grain| grain.radius).fold(0.0, f64::max);
    let end = observed.series.time.last().copied().unwrap_or_default();
    let way = extent("m").max(1e-6 * radius);
    let speed = if end > 0.0 { extent("m/s").max(way / end) } else { extent("m/s") };
    let (spin, energy) = (extent("rad/s").max(speed / radius), extent("J"));
    for column in &mut columns {
        column.scale = match column.unit {
            "m" => way,
            "m/s" => speed,
            "rad/s" => spin,
            _ => energy,
        };
    }
    columns.retain(|column| column.scale > 0.0);
    let distance = |run: usize| -> f64 {
        columns.iter().map(|column| largest(&difference(column.values, &column.runs[run])) / column.scale).sum()
    };
    let nearest = (0..ours.runs.len()).min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
    let mut verdicts = Vec::new();
    for column in &columns {
        let expected = &column.runs[nearest];
        let between = column.runs.iter().map(|run| largest(&difference(run, expected))).fold(0.0, f64::max);
        let halved = largest(&difference(&column.twin, &column.runs[1]));
        let [between, halved, open] = [between, halved, column.open].map(|part| part / column.scale);
        let found = Measured::worst_of(&observed.series.time, column.values, expected, column.scale);
        let mut verdict = row(format!("{} over the run, worst", column.name), column.unit);
        verdict.source = format!("{}, the nearest of our conventions, at the file's time step", ours.runs[nearest].0);
        verdict.allowed = FLOOR + between + halved + open;
        verdict.because = format!(
            "conventions differ by {}, half the step by {}, and {} beside",
            number::fraction(between),
            number::fraction(halved),
            number::fraction(FLOOR)
        );
        judge(&mut verdict, &found, open, outputs);
        verdicts.push(verdict);
    }
    verdicts
}

/// The first moving columns: what was observed, and our runs.
fn figures(ours: &Ours, file: &str, observed: &Observed) -> Vec<Figure> {
    const MOST: usize = 4;
    const MARKERS: usize = 40;
    let time = &observed.series.time;
    let mut figures = Vec::new();
    for (at, column) in observed.series.columns.iter().enumerate().filter(|(_, column)| is_compared(&column.name)) {
        let values = &observed.series.values[at];
        let moves = values.iter().any(|value| Some(value) != values.first());
        if figures.len() == MOST || !moves {
            continue;
        }
        let every = values.len().div_ceil(MARKERS).max(1);
        let points = |values: &[f64], every: usize| {
            let finite = time.iter().copied().zip(values.iter().copied()).filter(|(_, value)| value.is_finite());
            finite.step_by(every).collect()
        };
        let mut curves = vec![Curve { label: file.to_owned(), stroke: Stroke::Markers, points: points(values, every) }];
        for (name, series) in &ours.runs {
            if let Some(values) = ours.at(series, &column.name) {
                let thin = values.len().div_ceil(500).max(1);
                curves.push(Curve { label: (*name).to_owned(), stroke: Stroke::Line, points: points(&values, thin) });
            }
        }
        let axis = |label: String| Axis { label, logarithmic: false };
        figures.push(Figure {
            name: column.name.replace('.', "-"),
            title: column.name.clone(),
            caption: "The output (markers) and our solvers on the same scene at its time step.".to_owned(),
            drawing: Drawing::Graph(Graph {
                x: axis("time t (s)".to_owned()),
                y: axis(format!("{} ({})", column.name, column.unit)),
                curves,
            }),
        });
    }
    figures
}
