//! Statistics of silo elements: means in steady flow, correlations, packing fraction φ against inertial number and
//! against strain, and the largest sine of the friction angle before an element dilates.

pub(crate) use super::flow::Flow;
use super::flow::{FLOWING, INERTIA, STEADY, rows};
use grainbench_harness::prelude::*;
use grainbench_harness::statistics::median;

/// Returns a quantity of all elements in steady flow, away from sides, surface and the cause of the flow.
pub(crate) fn steady(done: &FinishedRun, quantity: &str) -> Result<Vec<f64>, MissingData> {
    let flow = Flow::from_scene(&done.scene);
    let names = ["time", "x", "z", "side", "surface", "shear_rate", quantity];
    let flows = |&[time, x, z, side, surface, rate, _]: &[f64; 7]| {
        time >= STEADY - 1e-9 && side + surface == 0.0 && rate >= FLOWING && flow.is_far([x, z], [7.5, 12.5])
    };
    let values = rows(done, "elements", names)?.into_iter().filter(flows).map(|row| row[6]);
    enough(values.collect(), FEWEST, "steadily flowing elements")
}

/// Smallest number of values for a statistic.
const FEWEST: usize = 16;

fn enough<T>(values: Vec<T>, fewest: usize, what: &str) -> Result<Vec<T>, MissingData> {
    if values.len() < fewest {
        Err(MissingData(format!("{fewest} {what} (it has {})", values.len())))
    } else {
        Ok(values)
    }
}

/// Returns the fraction of the values between two bounds.
pub(crate) fn share(values: &[f64], [low, high]: [f64; 2]) -> f64 {
    values.iter().filter(|value| (low..=high).contains(*value)).count() as f64 / values.len() as f64
}

/// Returns two quantities of each element of a table, away from sides and surface, from the start of steady flow to the
/// time `until` (τ), if its shear rate is at least `rate` (1/τ).
fn pairs(
    done: &FinishedRun,
    table: &str,
    until: f64,
    rate: f64,
    [a, b]: [&str; 2],
) -> Result<Vec<[f64; 2]>, MissingData> {
    let is_seen = |time: f64| (STEADY - 1e-9..until + 1e-9).contains(&time);
    let flows = |row: &[f64; 6]| is_seen(row[0]) && row[1] + row[2] == 0.0 && row[3] >= rate;
    let found = rows(done, table, ["time", "side", "surface", "shear_rate", a, b])?.into_iter().filter(flows);
    enough(found.map(|row| [row[4], row[5]]).collect(), FEWEST, "flowing elements")
}

/// Returns two quantities of each flowing element in steady flow, away from sides and surface.
fn flowing(done: &FinishedRun, names: [&str; 2]) -> Result<Vec<[f64; 2]>, MissingData> {
    pairs(done, "elements", f64::INFINITY, FLOWING, names)
}

/// Returns Pearson's correlation between the Mohr-Coulomb sin φ and the Drucker-Prager ratio.
pub(crate) fn of_criteria(done: &FinishedRun) -> Result<f64, MissingData> {
    Ok(correlation(&flowing(done, ["sine_of_friction", "drucker_prager"])?))
}

/// Returns Pearson's correlation between log |D₀| from velocities and from displacements over 0.2 τ.
pub(crate) fn of_rates(done: &FinishedRun) -> Result<f64, MissingData> {
    let pairs = flowing(done, ["shear_rate", "shear_rate_between"])?;
    Ok(correlation(&pairs.into_iter().map(|pair| pair.map(f64::ln)).collect::<Vec<_>>()))
}

fn correlation(pairs: &[[f64; 2]]) -> f64 {
    let count = pairs.len() as f64;
    let [x, y] = [0, 1].map(|side| pairs.iter().map(|pair| pair[side]).sum::<f64>() / count);
    let sum =
        |product: &dyn Fn(f64, f64) -> f64| pairs.iter().map(|pair| product(pair[0] - x, pair[1] - y)).sum::<f64>();
    sum(&|x, y| x * y) / (sum(&|x, _| x * x) * sum(&|_, y| y * y)).sqrt()
}

/// Number of bins, counted from the first, with at least a hundred elements in the tall silo at a tenth of the paper's
/// size. With fewer elements, the means of two packings differ by more than 0.008 (99 %), because the standard
/// deviation of φ is 0.014 to 0.02.
pub(crate) const FULL: usize = 6;

/// Mean packing fraction in each bin of |I₀|; `None` for a bin with too few elements.
type Bins = [Option<f64>; INERTIA.len()];

/// Returns the mean packing fraction in each bin of |I₀| in steady flow up to `until` (τ), at any shear rate.
pub(crate) fn over_inertia(done: &FinishedRun, until: f64) -> Result<Bins, MissingData> {
    // For a large silo, the table `elements` skips some frames; the table `rates` has all of them.
    let table = if done.table("rates").is_ok() { "rates" } else { "elements" };
    let pairs = pairs(done, table, until, 0.0, ["inertial_number", "packing_fraction"])?;
    Ok(INERTIA.map(|bin| in_bin(&pairs, bin)))
}

/// Returns [`over_inertia`] for elements with |D₀| of at least 0.02/τ. The first bin is empty, because this rate gives
/// |I₀| = 0.007 at the pressure at 15 d.
pub(crate) fn over_inertia_flowing(done: &FinishedRun) -> Result<Bins, MissingData> {
    let pairs = flowing(done, ["inertial_number", "packing_fraction"])?;
    Ok(INERTIA.map(|bin| in_bin(&pairs, bin)))
}

/// Pairs values in bins of `found` with values of another flow in the same bins. A bin that `found` lacks is an error.
pub(crate) fn in_bins_of(
    found: &Bins,
    others: impl Iterator<Item = (usize, f64)>,
) -> Result<Vec<[f64; 2]>, MissingData> {
    let pair = |(bin, other): (usize, f64)| {
        let [low, high] = INERTIA[bin];
        let lacking = || MissingData(format!("{FEWEST} elements with |I₀| of {low} to {high}"));
        found[bin].map(|found| [found, other]).ok_or_else(lacking)
    };
    let pairs: Vec<[f64; 2]> = others.map(pair).collect::<Result<_, _>>()?;
    if pairs.is_empty() { Err("bin of |I₀| to compare".into()) } else { Ok(pairs) }
}

/// Compares the values of the pair with the largest difference.
pub(crate) fn worst(pairs: &[[f64; 2]]) -> Measurement {
    let apart = |[found, expected]: &&[f64; 2]| (found - expected).abs();
    let worst = pairs.iter().max_by(|a, b| apart(a).total_cmp(&apart(b)));
    let [found, expected] = worst.copied().unwrap_or([f64::NAN; 2]);
    Measurement::new(found, expected, 1.0)
}

/// Returns the mean of the second values of pairs whose first value is in a bin; `None` for too few pairs.
fn in_bin(pairs: &[[f64; 2]], [low, high]: [f64; 2]) -> Option<f64> {
    let values: Vec<f64> = pairs.iter().filter(|pair| (low..high).contains(&pair[0])).map(|pair| pair[1]).collect();
    (values.len() >= FEWEST).then(|| mean(&values))
}

/// Strain |E| beyond which the packing fraction has reached its plateau.
const PLATEAU: f64 = 0.4;

/// Returns the height above which tracers are read (d). Tracers below 2.5 d leave a draining silo. In a pushed silo,
/// boxes of 5 d around tracers below 10 d contain fixed grains.
fn lowest(done: &FinishedRun) -> f64 {
    match Flow::from_scene(&done.scene) {
        Flow::Drained => 2.5,
        Flow::Pushed => 10.0,
    }
}

/// Returns pairs of strain |E| and packing fraction of tracers above [`lowest`].
pub(crate) fn strained(done: &FinishedRun) -> Result<Vec<[f64; 2]>, MissingData> {
    let above = rows(done, "tracers", ["z", "strain", "packing_fraction"])?.into_iter();
    Ok(above.filter(|row| row[0] > lowest(done)).map(|[_, strain, packing]| [strain, packing]).collect())
}

/// Returns the mean packing fraction of tracers strained beyond [`PLATEAU`].
pub(crate) fn plateau(done: &FinishedRun) -> Result<f64, MissingData> {
    let pairs = strained(done)?.into_iter().filter(|pair| pair[0] > PLATEAU).map(|pair| pair[1]);
    Ok(mean(&enough(pairs.collect(), FEWEST, "strained tracers")?))
}

/// Bounds of the bins of strain.
pub(crate) const STRAIN: [[f64; 2]; 8] =
    [[0.02, 0.04], [0.04, 0.08], [0.08, 0.1], [0.1, 0.15], [0.15, 0.2], [0.2, 0.3], [0.3, 0.4], [0.4, 0.8]];

/// Returns the mean packing fraction of tracers in the bins of [`STRAIN`]; `None` for a bin with too few tracers.
pub(crate) fn over_strain(done: &FinishedRun) -> Result<[Option<f64>; STRAIN.len()], MissingData> {
    let pairs = strained(done)?;
    Ok(STRAIN.map(|bin| in_bin(&pairs, bin)))
}

/// Smallest number of tracers for a median.
const FEWEST_TRACERS: usize = 8;
/// Decrease of the packing fraction that counts as dilation.
const DILATION: f64 = 0.02;

/// Groups rows by the tracer in their first column, in the order of its numbers.
fn by_tracer<const N: usize>(rows: &[[f64; N]]) -> Vec<Vec<[f64; N]>> {
    let mut tracers: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    tracers.sort_by(f64::total_cmp);
    tracers.dedup();
    tracers.into_iter().map(|tracer| rows.iter().filter(|row| row[0] == tracer).copied().collect()).collect()
}

/// Returns two quantities along the path of each tracer, as far as it is above [`lowest`].
pub(crate) fn courses(done: &FinishedRun, [a, b]: [&str; 2]) -> Result<Vec<Vec<[f64; 2]>>, MissingData> {
    let mut all = rows(done, "tracers", ["tracer", "z", a, b])?;
    all.retain(|row| row[1] > lowest(done));
    Ok(by_tracer(&all).into_iter().map(|course| course.into_iter().map(|row| [row[2], row[3]]).collect()).collect())
}

/// Returns the median over tracers that dilate of the largest sin φ before dilation.
pub(crate) fn onset(done: &FinishedRun) -> Result<f64, MissingData> {
    let peak_sine = |course: Vec<[f64; 3]>| {
        let dilated = course.iter().position(|[_, packing, _]| *packing < course[0][1] - DILATION)?;
        Some(course[..dilated].iter().map(|[.., sine]| *sine).fold(0.0, f64::max))
    };
    let all = rows(done, "tracers", ["tracer", "packing_fraction", "sine_of_friction"])?;
    let found = by_tracer(&all).into_iter().filter_map(peak_sine).collect();
    Ok(median(&enough(found, FEWEST_TRACERS, "tracers that dilate")?))
}

/// Returns a column of the table `blocks`, such as an angle, for flowing blocks away from sides and surface. `averaged`
/// selects windows of frames instead of single frames.
pub(crate) fn angles(done: &FinishedRun, averaged: bool, name: &str) -> Result<Vec<f64>, MissingData> {
    let flow = Flow::from_scene(&done.scene);
    let names = ["time", "frames", "x", "z", "side", "surface", "shear_rate", name];
    let flows = |&[time, frames, x, z, side, surface, rate, _]: &[f64; 8]| {
        time >= STEADY - 1e-9
            && (frames > 1.0) == averaged
            && side + surface == 0.0
            && rate >= FLOWING
            && flow.is_far([x, z], [5.0, 10.0])
    };
    let values = rows(done, "blocks", names)?.into_iter().filter(flows).map(|row| row[7]);
    enough(values.collect(), 4, "flowing blocks")
}

/// Returns the mean angle (degrees) between the major principal axes of stress T and strain rate D. `averaged` selects
/// axes that are averaged over a window of frames.
pub(crate) fn angle(done: &FinishedRun, averaged: bool) -> Result<f64, MissingData> {
    Ok(mean(&angles(done, averaged, "largest")?))
}

/// Returns the mean rotation (degrees) about y from the axes of T to the axes of D, multiplied by the sign of x. With
/// this sign, both halves of a symmetric flow contribute equally.
pub(crate) fn turn(done: &FinishedRun) -> Result<f64, MissingData> {
    let (turns, places) = (angles(done, false, "turn")?, angles(done, false, "x")?);
    // The column `turn` counts from x to z, which is opposite to a positive rotation about y.
    Ok(turns.iter().zip(&places).map(|(turn, x)| -turn * x.signum()).sum::<f64>() / turns.len() as f64)
}

/// Returns a column of the table `whole`, which describes the whole silo, in steady flow.
pub(crate) fn whole(done: &FinishedRun, name: &str) -> Result<Vec<f64>, MissingData> {
    let all = rows(done, "whole", ["time", name])?.into_iter();
    Ok(all.filter(|row| row[0] >= STEADY - 1e-9).map(|row| row[1]).collect())
}

/// Returns the packing fraction of the deposit: the mean over elements away from sides and surface in the first frame.
pub(crate) fn deposit(done: &FinishedRun) -> Result<f64, MissingData> {
    let first = rows(done, "whole", ["packing_fraction"])?.first().map(|row| row[0]);
    first.ok_or_else(|| "a bulk at the start".into())
}

/// Returns the number of grains below the floor, or removed, in the last frame.
pub(crate) fn gone(done: &FinishedRun) -> Result<f64, MissingData> {
    let last = rows(done, "whole", ["grains"])?.last().map(|row| row[0]);
    Ok(done.scene.grains.len() as f64 - last.ok_or("a frame")?)
}

pub(crate) const FRICTION_ELSEWHERE: Control =
    Control::misread("each element beside the friction of another", |tables| rotate(tables, "sine_of_friction"));
pub(crate) const RATE_ELSEWHERE: Control =
    Control::misread("each element beside the rate of another", |tables| rotate(tables, "shear_rate_between"));

/// Shifts a column by half the rows of the table, so that each element has the value of another element.
fn rotate(tables: &mut [Table], name: &str) {
    for table in tables {
        for (column, values) in table.columns.iter().zip(&mut table.values) {
            if column == name {
                let half = values.len() / 2;
                values.rotate_left(half);
            }
        }
    }
}

/// Replaces sin φ by tan φ, as the paper's wording for μ suggests, for a negative control.
pub(crate) fn tangent(tables: &mut [Table]) {
    change(tables, "sine_of_friction", |table, row| at(table, "sine_of_friction", row).asin().tan());
}

/// Replaces a column. `to` computes each new value from the table and the row.
fn change(tables: &mut [Table], name: &str, to: impl Fn(&Table, usize) -> f64) {
    for table in tables {
        if let Some(place) = table.columns.iter().position(|column| column == name) {
            let changed = (0..table.rows()).map(|row| to(table, row)).collect();
            table.values[place] = changed;
        }
    }
}

fn at(table: &Table, name: &str, row: usize) -> f64 {
    table.column(name).map_or(f64::NAN, |values| values[row])
}

pub(crate) const STRESS_ELSEWHERE: Control = Control::misread("each block beside the stress of another", |tables| {
    change(tables, "largest", |table, row| at(table, "largest_elsewhere", row));
});

/// Negative control that rotates D by ten degrees about y, outwards in both halves.
pub(crate) const RATE_TURNED: Control = Control::misread("D turned by 10°", |tables| {
    change(tables, "turn", |table, row| at(table, "turn", row) - 10.0 * at(table, "x", row).signum());
});

pub(crate) const DENSITY_OF_ONE: Control = Control::misread("the density of the grains 1 for 6/π", |tables| {
    change(tables, "inertial_number", |table, row| at(table, "inertial_number", row) * (PI / 6.0).sqrt());
});

/// Negative control that omits elements after 14 τ, the end of the prototype's runs, from φ against |I₀|.
pub(crate) const WITHOUT_THE_END: Control = Control::misread("what comes after 14 τ left out", |tables| {
    change(tables, "inertial_number", |table, row| {
        if at(table, "time", row) > 14.0 + 1e-9 { f64::NAN } else { at(table, "inertial_number", row) }
    });
});

/// Negative control with radii 1.01 times as large, so that volumes are 1.01³ times as large.
pub(crate) const LARGER_RADII: Control = Control::misread("radii a hundredth too large", |tables| {
    change(tables, "packing_fraction", |table, row| at(table, "packing_fraction", row) * 1.01_f64.powf(3.0));
});
