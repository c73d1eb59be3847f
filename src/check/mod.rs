//! Checks the output of any program for a case: against exact solutions of its claims, our solvers, and stored runs of
//! other programs.

mod covered;
mod exact;
mod figures;
mod horizon;
mod ours;
mod power;
mod stored;
mod subject;

pub use power::{Power, is_of_power};
pub use subject::DeclaredScene;

use covered::Coverage;
use exact::exact;
use figures::figures;
use grainbench_cases::solvers::Registry;
use grainbench_harness::compare::peers::{ColumnComparison, DecisiveSample, Peer, Sample, WIDE};
use grainbench_harness::evidence::Evidence;
use grainbench_harness::expect::Measurement;
use grainbench_harness::mistake;
use grainbench_harness::solvers::Solvers;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reference::observer::DumpRecord;
use grainbench_reference::outputs::{Origin, OutputError, Outputs, steps_in_words};
use grainbench_reports::{Section, number};
use grainbench_scene::error::SceneError;
use grainbench_scene::nalgebra::Vector3;
use grainbench_scene::scene::{Dimension, ProbeTarget, Scene};
use grainbench_scene::solver::Resolution;
use ours::{Plan, ours};
use power::CheckInputs;
use std::sync::Arc;
use subject::Candidate;
use thiserror::Error;

/// Reasons why output cannot be checked.
#[derive(Debug, Error)]
pub enum CheckError {
    /// The files are damaged or lack something.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The case's scene is wrong.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The output matches the start of several variants.
    #[error(
        "{file}: expected the name of a variant, because several variants of {case} have this start; found none of \
             {variants}"
    )]
    Ambiguous {
        /// Files of the output.
        file: String,
        /// Name of the case.
        case: String,
        /// Names of the matching variants.
        variants: String,
    },
    /// The time step is not below the critical one.
    #[error(
        "{file}: expected a time step below the critical one of the scene, 2√(m_min/k_max) = {critical:.6e} s; found {step} s, \
         {:.3} of it (--allow-unstable permits it)",
        .step / .critical
    )]
    Unstable {
        /// Files of the output.
        file: String,
        /// Critical time step (s).
        critical: f64,
        /// Longest time step of the files (s).
        step: f64,
    },
    /// The output belongs to another scene.
    #[error("{file}: expected the start of a scene of {case}, {expected}; found {found}")]
    OtherScene {
        /// Files of the output.
        file: String,
        /// Name of the case, with its variant.
        case: String,
        /// Expected value of the first grain that differs.
        expected: String,
        /// Its value in the output.
        found: String,
    },
}

/// Options of a check.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// True if the output may end early or have few samples.
    pub partial: bool,
    /// True if time steps at or above the critical one are accepted.
    pub allow_unstable: bool,
    /// Extent of the search for the power of the check.
    pub power: Power,
}

/// Accepted deviation from the start beyond the printed digits: in radii for positions, and as a fraction of the fastest
/// rim for speeds.
const START: f64 = 1e-9;
/// Names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Checks output against a case or a scene of the user. For a case without a named variant, the first sample selects
/// the variant.
///
/// If the output does not reach the end of the run, claims about the whole run have no result. The result for the
/// coverage is then red, or amber with `partial`.
///
/// # Errors
/// When the files cannot be read, start unlike every scene of the case, or have a time step that is not below the
/// critical one.
pub fn check(subject: &DeclaredScene<'_>, outputs: &Outputs, options: Options) -> Result<Section, CheckError> {
    let mut first_miss = None;
    let mut matching: Vec<(Candidate, DumpRecord)> = Vec::new();
    for candidate in subject.candidates()? {
        let observed = outputs.observe(&candidate.scene);
        let observed = match (observed, &first_miss) {
            (Ok(observed), _) => observed,
            // Other variants may have other numbers of grains; only the first error is reported.
            (Err(error), None) => {
                first_miss = Some(CheckError::Output(error));
                continue;
            }
            (Err(_), Some(_)) => continue,
        };
        match misplaced(&candidate.scene, outputs, &observed) {
            None => matching.push((candidate, observed)),
            Some((expected, found)) if first_miss.is_none() => {
                first_miss =
                    Some(CheckError::OtherScene { file: outputs.name(), case: subject.place(), expected, found });
            }
            Some(_) => {}
        }
    }
    let mut variants: Vec<&str> = matching.iter().map(|(candidate, _)| candidate.variant.as_str()).collect();
    variants.dedup();
    if variants.len() > 1 {
        let variants = variants.join(", ");
        return Err(CheckError::Ambiguous { file: outputs.name(), case: subject.name(), variants });
    }
    // With few printed digits, several scenes of a variant can match. The nearest scene counts, and the first of
    // equally near ones.
    let starts = matching.len();
    let distance = |(candidate, observed): &(Candidate, DumpRecord)| distance(&candidate.scene, observed);
    matching.sort_by(|a, b| distance(a).total_cmp(&distance(b)));
    if let Some((candidate, observed)) = matching.first_mut() {
        let covered = Coverage::new(candidate, outputs.time_step(), observed, options.partial);
        refuse_unstable(&candidate.scene, outputs, options)?;
        let mut section = section(subject, candidate, outputs, observed, &covered, options);
        if let Some(row) = section.verdicts.first_mut().filter(|_| starts > 1) {
            let words = format!(
                "; {starts} scenes of the variant match the first sample within the printed digits; the \
                         nearest is used"
            );
            row.because.push_str(&words);
        }
        return Ok(section);
    }
    Err(first_miss.unwrap_or_else(|| CheckError::OtherScene {
        file: outputs.name(),
        case: subject.name(),
        expected: "a variant with a scene".to_owned(),
        found: "none".to_owned(),
    }))
}

/// Quantity of a grain in the first sample.
struct Start {
    name: String,
    unit: &'static str,
    /// Value in the scene.
    expected: f64,
    /// Difference of the sample from the scene. Along a periodic axis it does not count whole periods.
    off: f64,
    /// Uncertainty of the sample due to its printed digits.
    open: f64,
    /// Scale of the quantity.
    scale: f64,
}

impl Start {
    /// Returns true if the sample differs from the scene by more than its printed digits and a rounding.
    fn is_off(&self) -> bool {
        self.off.abs() > self.open + START * self.scale
    }
}

/// Returns the coordinates of probed grains in the first sample.
fn probed<'o>(scene: &'o Scene, observed: &'o DumpRecord) -> impl Iterator<Item = Start> + 'o {
    observed.series.columns.iter().enumerate().filter_map(|(at, column)| {
        let (probe, quantity) = column.name.rsplit_once('.')?;
        let probe = scene.probes.iter().find(|other| other.name == probe)?;
        let axis = AXES.iter().position(|axis| *axis == quantity)?;
        let ProbeTarget::Grain(grain) = probe.target else { return None };
        let (expected, radius) = (scene.grains[grain].position[axis], scene.grains[grain].radius);
        let (found, open) = (*observed.series.values[at].first()?, *observed.uncertainty[at].first()?);
        let off = to_nearest_image(scene, axis, found - expected);
        Some(Start { name: column.name.clone(), unit: "m", expected, off, open, scale: radius })
    })
}

/// Returns positions, velocities and spins of all grains in the first snapshot, if the files have them. `step` is the
/// time step (s). Components out of the plane of the scene are left out.
fn of_snapshot<'o>(scene: &'o Scene, step: Option<f64>, observed: &'o DumpRecord) -> impl Iterator<Item = Start> + 'o {
    let axes = if scene.dimension == Dimension::Two { (0..2, 2..3) } else { (0..3, 0..3) };
    let rim = scene.grains.iter().map(|grain| grain.velocity.norm() + grain.radius * grain.spin.norm());
    let fastest = rim.fold(0.0, f64::max);
    // Some programs store velocities half a step before or after the positions.
    let fall = scene.gravity.norm() * step.unwrap_or_default();
    let groups = scene.driven_group_of_grains();
    let printed = observed.snapshots.first().map_or(&[][..], |first| &first.grains);
    let shifted = observed.shifted_start.as_ref().map_or(printed, |first| &first.grains);
    printed.iter().zip(shifted).flat_map(move |(found, shifted)| {
        let place = found.id as usize - 1;
        let grain = &scene.grains[place];
        let start = move |name: &str, unit, axis: usize, [expected, found, shifted]: [Vector3<f64>; 3], scale| {
            let name = format!("{name}{} of grain {}", AXES[axis], place + 1);
            let (expected, off) = (expected[axis], found[axis] - expected[axis]);
            Start { name, unit, expected, off, open: (shifted[axis] - found[axis]).abs(), scale }
        };
        let (linear, turning) = axes.clone();
        let places = linear.clone().map(move |axis| {
            let start = start("", "m", axis, [grain.position, found.position, shifted.position], grain.radius);
            Start { off: to_nearest_image(scene, axis, start.off), ..start }
        });
        let speeds = linear.map(move |axis| {
            let start = start("v", "m/s", axis, [grain.velocity, found.velocity, shifted.velocity], fastest);
            Start { open: start.open + fall, ..start }
        });
        let spins = turning.map(move |axis| {
            start("omega", "rad/s", axis, [grain.spin, found.spin, shifted.spin], fastest / grain.radius)
        });
        // Programs differ in the velocity that they print for a grain with prescribed motion.
        let is_free = groups[place].is_none();
        places.chain(speeds.chain(spins).filter(move |_| is_free))
    })
}

/// Returns a difference of coordinates (m) without whole periods of its axis.
fn to_nearest_image(scene: &Scene, axis: usize, off: f64) -> f64 {
    match scene.domain.filter(|domain| domain.periodic[axis]) {
        Some(domain) => off - (off / (domain.high - domain.low)[axis]).round() * (domain.high - domain.low)[axis],
        None => off,
    }
}

/// Returns the largest distance of a coordinate from the start of a scene, in grain radii.
fn distance(scene: &Scene, observed: &DumpRecord) -> f64 {
    let starts = probed(scene, observed).chain(of_snapshot(scene, None, observed)).filter(|start| start.unit == "m");
    starts.map(|start| start.off.abs() / start.scale).fold(0.0, f64::max)
}

/// Returns the expected and the found value of the first grain that does not start as in the scene.
fn misplaced(scene: &Scene, outputs: &Outputs, observed: &DumpRecord) -> Option<(String, String)> {
    let late = outputs.origin().map(|origin| format!("a first sample at {}", at(origin)));
    let mut is_placed = false;
    for start in probed(scene, observed).chain(of_snapshot(scene, outputs.time_step(), observed)) {
        if start.is_off() {
            let late = late.map(|late| format!(" in {late}")).unwrap_or_default();
            let Start { name, unit, expected, off, .. } = start;
            return Some((format!("{name} = {expected:?} {unit}"), format!("{:?} {unit}{late}", expected + off)));
        }
        is_placed = true;
    }
    // A first sample counts as time 0 only if it shows the start of the scene.
    late.filter(|_| !is_placed).map(|late| ("at time 0".to_owned(), late))
}

/// Returns step and time of a first sample, in words.
fn at(origin: Origin) -> String {
    let time = origin.time.map(|time| format!(" (t = {time} s)")).unwrap_or_default();
    format!("step {}{time}", origin.step)
}

/// Rejects time steps at or above the critical one, because our own solvers would be unstable.
fn refuse_unstable(scene: &Scene, outputs: &Outputs, options: Options) -> Result<(), CheckError> {
    let critical = scene.critical_time_step();
    match outputs.time_step() {
        Some(step) if scene.is_unstable_at(step) && !options.allow_unstable => {
            Err(CheckError::Unstable { file: outputs.name(), critical, step })
        }
        _ => Ok(()),
    }
}

fn section(
    subject: &DeclaredScene<'_>,
    candidate: &Candidate,
    outputs: &Outputs,
    observed: &DumpRecord,
    covered: &Coverage,
    options: Options,
) -> Section {
    let file = outputs.name();
    let steps = outputs.time_steps();
    let row = |quantity: String, unit: &str| {
        let resolution = match steps {
            None => "step unknown".to_owned(),
            Some([shortest, longest]) if shortest == longest => Resolution::TimeStep(longest).to_string(),
            Some(steps) => format!("dt={}", steps_in_words(steps)),
        };
        Verdict {
            variant: candidate.variant.clone(),
            solver: file.clone(),
            resolution,
            evidence: Evidence::OtherCode,
            outcome: Outcome::NoReference,
            ..Verdict::open(subject.name(), quantity, unit)
        }
    };
    let mut verdicts = vec![covered.row(outputs, row("time of the last sample".to_owned(), "s"))];
    let judge = |claim| exact(claim, candidate, outputs, observed, covered, &row);
    let mut of_claims: Vec<Option<Verdict>> = candidate.claims.iter().map(|claim| Some(judge(claim))).collect();
    if let Some(case) = subject.as_stored() {
        let solvers: Arc<dyn Solvers> = Arc::new(Registry);
        mistake::explain(case, &solvers, &candidate.claims, &mut of_claims);
    }
    verdicts.extend(of_claims.into_iter().flatten());
    let amber = |reason: String| (Outcome::NoReference, reason);
    let unknown = || amber("the files do not contain the time step (--time-step sets it)".to_owned());
    let plan = steps.ok_or_else(unknown).and_then(|steps| Plan::new(observed, steps));
    let of_ours = plan.and_then(|plan| against_ours(&candidate.scene, plan).map_err(amber));
    let (verdicts_of_ours, figures) = match of_ours {
        Ok(of_ours) => {
            let made = of_ours.made(candidate, outputs, observed, covered);
            let power = if subject.case().is_some() { Power::Off } else { options.power };
            (rows_of_ours(&made, power, &row), figures(&of_ours.peers, &file, observed))
        }
        Err((Outcome::Fail, reason)) if options.partial => {
            let reason = format!("{reason}; a part of the run is meant (--partial)");
            (vec![no_comparison(&row, Outcome::Known, reason)], Vec::new())
        }
        Err((Outcome::Fail, reason)) => {
            let reason = format!("{reason}; --partial judges the existing samples");
            (vec![no_comparison(&row, Outcome::Fail, reason)], Vec::new())
        }
        Err((outcome, reason)) => (vec![no_comparison(&row, outcome, reason)], Vec::new()),
    };
    let dense = |row: Verdict| if is_of_power(&row) { row } else { covered.dense(row) };
    verdicts.extend(verdicts_of_ours.into_iter().map(dense));
    if let Some(case) = subject.as_stored() {
        verdicts.extend(stored::compare(case, candidate, outputs, observed, covered, &row));
    }
    let (derivation, weak) = match subject.case() {
        Some(case) => (case.derivation, case.weakness),
        None => ("", "A scene without a case has no exact solution here. Our solvers are the only reference."),
    };
    Section {
        name: subject.name(),
        title: format!("{}: {file}", subject.title()),
        claim: format!(
            "The output of another program, `{file}`, printed with up to {} significant digits, against exact answers where \
             they hold, against our solvers on the same scene, and against stored runs of it where there are some.",
            outputs.significant_digits()
        ),
        derivation: derivation.to_owned(),
        weak: weak.to_owned(),
        figures,
        verdicts,
        controls: Vec::new(),
        runs: Vec::new(),
    }
}

/// Our runs of a scene.
struct OwnRuns {
    plan: Plan,
    peers: Vec<Peer>,
    /// Time (s) up to which the run can be predicted; `None` if it can be predicted to its end.
    horizon: Option<f64>,
}

impl OwnRuns {
    fn made<'c>(
        &'c self,
        candidate: &'c Candidate,
        outputs: &'c Outputs,
        observed: &'c DumpRecord,
        covered: &'c Coverage,
    ) -> CheckInputs<'c> {
        let (plan, ours, horizon, scene) = (&self.plan, &self.peers, self.horizon, &candidate.scene);
        CheckInputs { scene, plan, ours, horizon, outputs, observed, covered }
    }
}

fn against_ours(scene: &Scene, plan: Plan) -> Result<OwnRuns, String> {
    let peers = ours(scene, &plan)?;
    let horizon = horizon::find(scene, &plan, &peers)?;
    Ok(OwnRuns { plan, peers, horizon })
}

/// Compares the output with our runs: sample by sample up to the horizon, and by means after it. Adds the power of the
/// check.
fn rows_of_ours(made: &CheckInputs<'_>, power: Power, row: &dyn Fn(String, &str) -> Verdict) -> Vec<Verdict> {
    let mut rows = made.compare(made.observed, row);
    if rows.is_empty() {
        let reason = "fewer than two samples are at times of our runs, or the files contain no compared quantity";
        rows.push(no_comparison(row, Outcome::NoReference, reason.to_owned()));
    }
    rows.extend(made.power(power, row));
    rows
}

fn no_comparison(row: &dyn Fn(String, &str) -> Verdict, outcome: Outcome, reason: String) -> Verdict {
    let row = Verdict { because: "none was made".to_owned(), ..row("comparison with our solvers".to_owned(), "1") };
    row.left(outcome, reason)
}

/// Evaluates a measured value, with the tolerance widened by the uncertainty of the printed digits. A tolerance above a
/// twentieth of the scale never gives a green result.
fn judged(row: Verdict, open: f64, outputs: &Outputs, found: &Measurement) -> Verdict {
    widened(row, open, outputs).judged(found).unless_wider_than(WIDE)
}

/// Allowed error of a column, without the uncertainty of its digits.
struct ErrorAllowance {
    /// Constant part, as a fraction of the scale.
    floor: f64,
    /// Factor for the change from halving the time step.
    times: f64,
    /// Name of the runs that differ from each other, in words.
    conventions: &'static str,
}

/// Largest fraction of samples that may allow too large an error if the other samples decide the result of a column.
const FEW: f64 = 0.1;

/// Evaluates a column at each sample, with a tolerance from the differences between its runs around that time.
fn judged_in_time(
    row: Verdict,
    compared: &ColumnComparison<'_>,
    beside: &ErrorAllowance,
    outputs: &Outputs,
) -> Verdict {
    let allowed = |sample: &Sample| beside.floor + sample.between + beside.times * sample.halved;
    let Some(decisive) = compared.decisive(|sample| allowed(sample) + compared.open) else {
        return row.left(Outcome::NoReference, "there is no sample");
    };
    let DecisiveSample { sample, wide, first_outside, .. } = decisive;
    let times = if beside.times == 1.0 { String::new() } else { format!(", times {}", beside.times) };
    let because = format!(
        "tolerance near t = {} s: {} differ by {}, halving the step changes {}{times}, plus {}",
        number::significant(sample.time, 6),
        beside.conventions,
        number::fraction(sample.between),
        number::fraction(sample.halved),
        number::fraction(beside.floor)
    );
    let row = widened(Verdict { allowed: allowed(&sample), because, ..row }, compared.open, outputs);
    let row = row.judged(&compared.measured(&sample));
    let count = compared.samples.len();
    match (row.outcome, first_outside) {
        (Outcome::Fail, Some(time)) => {
            let how = if row.error.is_none() { "not a number (NaN) from" } else { "first outside at" };
            Verdict { detail: Some(format!("{how} t = {time:.6} s")), ..row }
        }
        (Outcome::Pass, _) if wide as f64 > FEW * count as f64 => {
            let most = 100.0 * WIDE;
            let reason = format!("inconclusive: {wide} of {count} samples allow an error above {most} % of the scale");
            row.left(Outcome::NoReference, reason)
        }
        (Outcome::Pass, _) if wide > 0 => {
            let because = format!("{}; {wide} of {count} samples with too large a tolerance are skipped", row.because);
            Verdict { because, ..row }
        }
        _ => row,
    }
}

/// Widens the tolerance by the uncertainty of the printed digits.
fn widened(mut row: Verdict, open: f64, outputs: &Outputs) -> Verdict {
    row.allowed += open;
    // A widening below a thousandth of the tolerance is not reported.
    if open > 1e-3 * row.allowed {
        let digits = outputs.significant_digits();
        let words = format!("; plus {} for the printed digits, at most {digits}", number::fraction(open));
        row.because.push_str(&words);
    }
    row
}
