//! Comparison of output with our solvers on the same scene.

use super::covered::CheckedOutput;
use super::judgement::{Between, ErrorAllowance, judged_in_time};
use super::start::continuous;
use grainbench_dem::convention::Convention;
use grainbench_dem::solver::Dem;
use grainbench_harness::compare::peers::{ColumnComparison, Peer, against};
use grainbench_harness::tolerance::ToleranceOrigin;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reference::observer::DumpRecord;
use grainbench_scene::scene::{Probe, ProbeTarget, Scene};
use grainbench_solver::Solver;
use grainbench_solver::record::{Record, Series, Snapshot};
use grainbench_solver::refined::refined;

/// Names of the contact conventions on the command line. The first one stands for the nearest of the others.
pub const CONVENTION_NAMES: [&str; 5] = ["nearest", "dem", "dem:1979", "dem:lammps", "dem:liggghts"];

/// Returns the first `samples` samples of a series.
pub(super) fn truncated(mut series: Series, samples: usize) -> Series {
    series.step.truncate(samples);
    series.time.truncate(samples);
    series.values.iter_mut().for_each(|values| values.truncate(samples));
    series
}

/// Returns our runs and the output up to a time (s), or to their ends without a time.
pub(super) fn until(time: Option<f64>, runs: &[Peer], observed: &DumpRecord) -> (Vec<Peer>, DumpRecord) {
    let count =
        |series: &Series| time.map_or(series.time.len(), |time| series.time.partition_point(|&sample| sample <= time));
    let cut = |series: &Series| truncated(series.clone(), count(series));
    let run = |run: &Peer| Peer {
        name: run.name.clone(),
        series: cut(&run.series),
        half_step: run.half_step.as_ref().map(cut),
    };
    let mut seen = observed.clone();
    seen.keep(count(&observed.series));
    (runs.iter().map(run).collect(), seen)
}

/// Returns the contact convention of one of our runs.
pub(super) fn convention(run: &Peer) -> Convention {
    CONVENTIONS.into_iter().find(|other| other.name == run.name).unwrap_or(Convention::DEFAULT)
}

/// Contact conventions of our runs, the default first.
const CONVENTIONS: [Convention; 4] =
    [Convention::DEFAULT, Convention::CUNDALL_STRACK, Convention::LAMMPS, Convention::LIGGGHTS];
/// Allowed difference in addition to the measured differences, as a fraction of the scale.
pub(super) const FLOOR: f64 = 1e-6;
/// Largest number of particle-steps of one run of our solvers, which takes about half an hour.
const MOST_WORK: f64 = 2e10;
/// Largest number of samples of our runs.
const MOST_SAMPLES: u64 = 2_000_000;

/// Time steps of our runs, which reproduce the sample times of the output.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    /// Time step (s).
    pub(super) step: f64,
    /// Two numbers: the number of steps to the last sample, and the greatest common divisor of the step numbers of all samples.
    counts: [u64; 2],
    /// Number of steps of the finer run per step of the plan. It is at least 2, and the finer step is at most the
    /// shortest step of the output.
    parts: u64,
}

impl Plan {
    /// Returns a plan whose time step divides all sample times. The time step is the longest time step of the output
    /// (s), or the shortest if the longest does not divide all sample times. If there is no such plan, returns an
    /// outcome with its reason. The outcome is red if neither time step divides all sample times.
    pub(super) fn new(observed: &DumpRecord, [shortest, longest]: [f64; 2]) -> Result<Self, (Outcome, String)> {
        let amber = |reason: String| (Outcome::NoReference, reason);
        let times = &observed.series.time;
        if !times.windows(2).all(|pair| pair[0] < pair[1]) {
            return Err(amber("the times do not increase".to_owned()));
        }
        let off = |step: f64| {
            let is_off = |time: &f64| ((time / step).round() * step - time).abs() > 1e-6 * step.max(*time);
            times.iter().copied().find(is_off)
        };
        let step = match (off(longest), off(shortest)) {
            (None, _) => longest,
            (_, None) => shortest,
            (Some(time), _) => {
                let reason = format!("the time {time} s is not a whole number of steps of {longest} s");
                return Err((Outcome::Fail, reason));
            }
        };
        let steps: Vec<u64> = times.iter().map(|time| (time / step).round() as u64).collect();
        let last = steps.last().copied().ok_or_else(|| amber("there is no sample".to_owned()))?;
        let interval = steps.iter().fold(0, |all, &step| common_divisor(all, step)).max(1);
        if last / interval > MOST_SAMPLES {
            return Err(amber(format!("the output has {} samples, more than {MOST_SAMPLES}", last / interval)));
        }
        let parts = ((step / shortest * (1.0 - 1e-6)).ceil() as u64).max(2);
        Ok(Self { step, counts: [last, interval], parts })
    }

    /// Returns the work of the comparison with our solvers, in units of one run.
    pub(super) const fn work(&self) -> u64 {
        CONVENTIONS.len() as u64 + self.parts
    }

    /// Runs a scene with a contact convention. Each step of the plan is divided into `parts` steps.
    pub(super) fn run(&self, scene: &Scene, convention: Convention, parts: u64) -> Result<Record, String> {
        let mut scene = Scene { snapshots: 0, snapshot_times: Vec::new(), ..scene.clone() };
        // Numbers of grains show only late that two runs part. The kinetic energy shows it at once.
        if scene.probes.iter().all(|probe| probe.target == ProbeTarget::Count) {
            scene.probes.push(Probe { name: String::new(), target: ProbeTarget::System });
        }
        let (scene, resolution) = refined(&scene, self.step, self.counts, parts);
        let record = Dem::new(convention).run(&scene, &resolution, &mut ()).map_err(|error| error.to_string())?;
        Ok(Record { series: continuous(&scene, record.series), ..record })
    }
}

/// Runs a scene up to the last sample of the output with each of our contact conventions. Each run comes
/// with its last snapshot.
pub(super) fn ours(scene: &Scene, plan: &Plan) -> Result<(Vec<Peer>, Vec<Option<Snapshot>>), String> {
    let [last, _] = plan.counts;
    if last as f64 * scene.grains.len() as f64 > MOST_WORK {
        return Err(format!("{last} steps of {} s exceed the limit of work for our solvers", plan.step));
    }
    let run = |convention: Convention| {
        let Record { series, mut snapshots, .. } = plan.run(scene, convention, 1)?;
        Ok((Peer { name: convention.name.to_owned(), series, half_step: None }, snapshots.pop()))
    };
    CONVENTIONS.map(run).into_iter().collect::<Result<Vec<_>, String>>().map(|runs| runs.into_iter().unzip())
}

/// Moves the run in the nearest or chosen convention to the front, and repeats it with smaller time steps. Samples after
/// the horizon (s) do not count for the nearest convention. Returns the previous index of the run.
pub(super) fn nearest_first(
    scene: &Scene,
    plan: &Plan,
    peers: &mut [Peer],
    observed: &DumpRecord,
    horizon: Option<f64>,
    choice: Option<&str>,
) -> Result<usize, String> {
    let (runs, seen) = until(horizon, peers, observed);
    let name = against_runs(scene, &runs, &seen, choice).map(|(name, _)| name);
    let nearest = peers.iter().position(|peer| Some(peer.name.as_str()) == name).unwrap_or_default();
    peers[..=nearest].rotate_right(1);
    peers[0].half_step = Some(plan.run(scene, convention(&peers[0]), plan.parts)?.series);
    Ok(nearest)
}

fn common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { common_divisor(b, a % b) }
}

/// Returns true if a column is compared: motion, kinetic energy, contact forces, forces on walls, mean stress, or the
/// numbers of present grains and of grains that have left.
pub(super) fn is_compared(name: &str) -> bool {
    let quantity = name.rsplit_once('.').map_or(name, |(_, quantity)| quantity);
    ["x", "y", "z", "vx", "vy", "vz", "kinetic_energy", "normal_force", "shear_force"].contains(&quantity)
        || quantity.starts_with("omega")
        || quantity.starts_with("force_")
        || quantity.starts_with("sigma_")
        || is_count(name)
}

/// Returns true if a column counts grains.
fn is_count(name: &str) -> bool {
    name.ends_with(".present") || name.ends_with(".left")
}

/// Compares all columns with our run in the nearest or chosen contact convention. The allowed error contains the
/// change of our run when its time step is reduced.
pub(super) fn compare(ours: &[Peer], choice: Option<&str>, output: &CheckedOutput<'_>) -> Vec<Verdict> {
    let compared = against_runs(&output.candidate.scene, ours, output.observed, choice);
    let Some((name, columns)) = compared else { return Vec::new() };
    columns.into_iter().map(|compared| column(&compared, name, choice, output)).collect()
}

/// Compares the columns with the nearest or chosen run. Returns its name and one comparison per column.
fn against_runs<'a>(
    scene: &Scene,
    ours: &'a [Peer],
    observed: &'a DumpRecord,
    choice: Option<&str>,
) -> Option<(&'a str, Vec<ColumnComparison<'a>>)> {
    let radius = scene.grains.iter().map(|grain| grain.radius).fold(0.0, f64::max);
    let mass: f64 = scene.grains.iter().map(|grain| grain.mass).sum();
    let end = observed.series.time.last().copied().unwrap_or_default();
    // The scale must exceed the rounding of grains at rest. The smallest displacement scale is therefore 10⁻⁶ of the largest
    // radius. The smallest speed scale is that displacement divided by the run time, and the smallest angular velocity has that
    // speed at the rim. The smallest energy is the kinetic energy of all grains at 10⁻³ of the speed scale.
    let scale = |extent: &dyn Fn(&str) -> f64, unit: &str| {
        let way = extent("m").max(1e-6 * radius);
        let speed = if end > 0.0 { extent("m/s").max(way / end) } else { extent("m/s") };
        match unit {
            "m" => way,
            "m/s" => speed,
            "rad/s" => extent("rad/s").max(speed / radius),
            "N" | "Pa" => extent(unit),
            "1" => extent("1").max(1.0),
            _ => extent("J").max(0.5 * mass * (1e-3 * speed).powi(2)),
        }
    };
    against(&observed.series, &observed.uncertainty, ours, choice, is_compared, scale)
}

fn column(compared: &ColumnComparison<'_>, name: &str, choice: Option<&str>, output: &CheckedOutput<'_>) -> Verdict {
    // Programs print forces that depend on velocities half a step later than the velocities that moved the grains. For
    // a dashpot, this difference is twice the change due to half the time step, so three times this change is allowed.
    let times = if matches!(compared.unit, "N" | "Pa") { 3.0 } else { 1.0 };
    // A grain may cross the edge of a box between two samples in one run and after them in the other.
    let floor = if is_count(compared.name) { 1.0 / compared.scale } else { FLOOR };
    let (how, between) = match choice {
        Some(_) => ("the chosen convention", Between::Refused),
        None => ("our nearest convention", Between::Inconclusive),
    };
    let row = Verdict {
        source: format!("{name}, {how}, at the time step of the file"),
        tolerance: ToleranceOrigin::Computed,
        ..output.row(format!("{}, {}", compared.name, output.covered.words()), compared.unit)
    };
    let beside = ErrorAllowance { floor, times, between };
    output.covered.all(compared.samples.len(), judged_in_time(row, compared, &beside, output.outputs))
}
