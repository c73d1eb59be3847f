//! Test for chaos: the change of the probes under a tiny displacement of one grain.

use grainbench_scene::scene::Scene;
use grainbench_solver::failure::RunError;
use grainbench_solver::record::Record;

/// Displacement of one grain in a perturbed run, over its radius. It is negligible, but large enough for perturbed runs to part
/// soon.
const PERTURBATION: f64 = 1e-6;
/// Number of perturbed runs of a chaotic scene.
const PERTURBED: usize = 4;
/// Largest value that is rounding noise, relative to the natural scale of its unit.
pub(crate) const ZERO: f64 = 1e-9;

/// Returns runs of the perturbed scene, or no runs if the scene is not chaotic. `record` is the unperturbed run, and `run`
/// repeats it with a changed scene.
///
/// The scene is chaotic if the first perturbed run changes a probe column by more than `matters`, relative to the largest
/// absolute value of the probe. A scene with one grain is never tested.
///
/// # Errors
/// When a run fails.
pub fn perturbed_runs(
    scene: &Scene,
    record: &Record,
    matters: f64,
    run: &mut dyn FnMut(&Scene) -> Result<Record, RunError>,
) -> Result<Vec<Record>, RunError> {
    let (mut perturbed, mut scene) = (Vec::new(), scene.clone());
    while scene.grains.len() > 1 && perturbed.len() < PERTURBED {
        let middle = scene.grains.len() / 2;
        scene.grains[middle].position.x += PERTURBATION * scene.grains[middle].radius;
        let other = run(&scene)?;
        let mut columns = 0..record.series.columns.len();
        let moves = |off: f64| off.is_nan() || off > matters;
        if perturbed.is_empty() && !columns.any(|at| farthest(&scene, record, &other, at).is_some_and(moves)) {
            break;
        }
        perturbed.push(other);
    }
    Ok(perturbed)
}

/// Returns the largest absolute value of the columns that belong to the same probe and have the same unit as a column.
#[must_use]
pub fn scale_of(whole: &Record, column: usize) -> f64 {
    let kind = |at: usize| {
        let column = &whole.series.columns[at];
        (column.name.rsplit_once('.').map_or("", |(probe, _)| probe), column.unit.as_str())
    };
    let alike = (0..whole.series.columns.len()).filter(|&at| kind(at) == kind(column));
    let values = alike.filter_map(|at| whole.series.values.get(at)).flatten();
    values.filter(|value| value.is_finite()).fold(0.0, |scale: f64, value| scale.max(value.abs()))
}

/// Returns the scale of the changes of a column: [`scale_of`] the run, or the natural scale of the unit if the run has only
/// rounding noise.
fn scale_of_changes(scene: &Scene, whole: &Record, column: usize) -> f64 {
    let natural = whole.series.columns.get(column).map_or(0.0, |column| natural(scene, &column.unit));
    let scale = scale_of(whole, column);
    if scale <= ZERO * natural { natural } else { scale }
}

/// Returns the natural scale of a unit in a scene, from its largest mass, its reference length and its duration; zero for other
/// units.
pub(crate) fn natural(scene: &Scene, unit: &str) -> f64 {
    let (length, time) = (scene.reference_length, scene.duration.seconds().unwrap_or(1.0));
    let mass = scene.grains.iter().map(|grain| grain.mass).fold(0.0, f64::max);
    match unit {
        "m" => length,
        "m/s" => length / time,
        "rad" | "1" => 1.0,
        "rad/s" => 1.0 / time,
        "N" => mass * length / (time * time),
        "N s" | "kg m/s" => mass * length / time,
        "J" => mass * (length / time).powi(2),
        "kg m²/s" => mass * length * length / time,
        _ => 0.0,
    }
}

/// Returns the change of the mean of a column over time, relative to the scale of [`farthest`].
///
/// The result is NaN or `None` as for [`farthest`].
#[must_use]
pub fn change_of_mean(scene: &Scene, whole: &Record, other: &Record, column: usize) -> Option<f64> {
    let pointwise = farthest(scene, whole, other, column)?;
    let values = whole.series.values.get(column)?;
    let others = other.series.column(&whole.series.columns.get(column)?.name).unwrap_or_default();
    let scale = scale_of_changes(scene, whole, column);
    if scale == 0.0 || !pointwise.is_finite() {
        return Some(pointwise);
    }
    let off = values.iter().zip(others).filter(|(value, _)| value.is_finite()).map(|(value, other)| other - value);
    Some((off.sum::<f64>() / values.len() as f64).abs() / scale)
}

/// Returns the largest difference of a column between two runs at equal samples, relative to [`scale_of`] the first run. If
/// the first run has only rounding noise, the scale is the natural one of the unit.
///
/// The result is NaN if the other run has another number of samples or a value that is NaN. It is `None` if the column is
/// empty.
#[must_use]
pub fn farthest(scene: &Scene, whole: &Record, other: &Record, column: usize) -> Option<f64> {
    let values = whole.series.values.get(column)?;
    let scale = scale_of_changes(scene, whole, column);
    let others = other.series.column(&whole.series.columns.get(column)?.name).unwrap_or_default();
    if scale == 0.0 {
        // Without a natural scale, any other value than zero counts as a relative change of 1.
        let largest = others.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        return (!values.is_empty()).then_some(if largest > 0.0 { 1.0 } else { 0.0 });
    }
    if others.len() != values.len() {
        return Some(f64::NAN);
    }
    let off =
        values.iter().zip(others).filter(|(value, _)| value.is_finite()).map(|(value, other)| (other - value).abs());
    Some(off.fold(0.0, |most: f64, off| if off.is_nan() || most.is_nan() { f64::NAN } else { most.max(off) }) / scale)
}
