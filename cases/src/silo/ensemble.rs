//! Statistics of silo elements: means in steady flow, correlations, packing fraction φ against inertial number and
//! against strain, and the largest sine of the friction angle before an element dilates.

pub(crate) use super::flow::Flow;
use super::flow::{FLOWING, INERTIA, STEADY};
use grainbench_harness::reading::Table;
use grainbench_harness::run::{FinishedRun, MissingData};
use grainbench_harness::statistics::median;

/// Selected columns of a table, read row by row.
struct Rows<'a, const N: usize> {
    columns: [&'a [f64]; N],
    rows: usize,
}

impl<'a, const N: usize> Rows<'a, N> {
    fn from_table(table: &'a Table, names: [&str; N]) -> Result<Self, MissingData> {
        let mut columns: [&[f64]; N] = [&[]; N];
        for (column, name) in columns.iter_mut().zip(names) {
            *column = table.column(name).ok_or_else(|| MissingData(format!("column `{name}` of `{}`", table.name)))?;
        }
        Ok(Self { columns, rows: table.rows() })
    }

    /// Returns the rows without NaN or infinite numbers.
    fn whole(&self) -> impl Iterator<Item = [f64; N]> + '_ {
        let row = |at: usize| self.columns.map(|column| column[at]);
        (0..self.rows).map(row).filter(|row| row.iter().all(|number| number.is_finite()))
    }
}

/// Returns a quantity of all elements in steady flow, away from sides, surface and the cause of the flow.
pub(crate) fn steady(done: &FinishedRun, flow: Flow, quantity: &str) -> Result<Vec<f64>, MissingData> {
    let names = ["time", "x", "z", "side", "surface", "shear_rate", quantity];
    let rows = Rows::from_table(done.table("elements")?, names)?;
    let values: Vec<f64> = rows
        .whole()
        .filter(|&[time, x, z, side, surface, rate, _]| {
            time >= STEADY - 1e-9 && side + surface == 0.0 && rate >= FLOWING && flow.is_far(x, z)
        })
        .map(|row| row[6])
        .collect();
    enough(values, "steadily flowing elements")
}

/// Smallest number of values for a statistic.
const FEWEST: usize = 16;

fn enough(values: Vec<f64>, what: &str) -> Result<Vec<f64>, MissingData> {
    if values.len() < FEWEST {
        Err(MissingData(format!("{FEWEST} {what} (it has {})", values.len())))
    } else {
        Ok(values)
    }
}

/// Returns the arithmetic mean of some values.
pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Returns the fraction of the values between two bounds.
pub(crate) fn share(values: &[f64], [low, high]: [f64; 2]) -> f64 {
    values.iter().filter(|value| (low..=high).contains(*value)).count() as f64 / values.len() as f64
}

/// Returns two quantities of each element in steady flow, away from sides and surface, whose shear rate is at least
/// `rate` (1/τ).
fn pairs(done: &FinishedRun, rate: f64, names: [&str; 2]) -> Result<Vec<[f64; 2]>, MissingData> {
    pairs_of(done.table("elements")?, f64::INFINITY, rate, names)
}

/// Returns two quantities of each element of a table, away from sides and surface, from the start of steady flow to the
/// time `until` (τ), if its shear rate is at least `rate` (1/τ).
fn pairs_of(table: &Table, until: f64, rate: f64, names: [&str; 2]) -> Result<Vec<[f64; 2]>, MissingData> {
    let [a, b] = names;
    let rows = Rows::from_table(table, ["time", "side", "surface", "shear_rate", a, b])?;
    let is_seen = |time: f64| (STEADY - 1e-9..until + 1e-9).contains(&time);
    let flows = |row: &[f64; 6]| is_seen(row[0]) && row[1] + row[2] == 0.0 && row[3] >= rate;
    let found: Vec<[f64; 2]> = rows.whole().filter(flows).map(|row| [row[4], row[5]]).collect();
    if found.len() < FEWEST { Err(MissingData(format!("{FEWEST} flowing elements"))) } else { Ok(found) }
}

/// Returns Pearson's correlation between the Mohr-Coulomb sin φ and the Drucker-Prager ratio.
pub(crate) fn of_criteria(done: &FinishedRun) -> Result<f64, MissingData> {
    Ok(correlation(&pairs(done, FLOWING, ["sine_of_friction", "drucker_prager"])?))
}

/// Returns Pearson's correlation between log |D₀| from instantaneous velocities and log |D₀| from displacements over
/// 0.2 τ.
pub(crate) fn of_rates(done: &FinishedRun) -> Result<f64, MissingData> {
    let pairs = pairs(done, FLOWING, ["shear_rate", "shear_rate_between"])?;
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

/// Returns the mean packing fraction in each bin of |I₀| in steady flow, for elements away from sides and surface at
/// any shear rate. A bin with too few elements gives `None`.
pub(crate) fn over_inertia(done: &FinishedRun) -> Result<[Option<f64>; INERTIA.len()], MissingData> {
    over_inertia_until(done, f64::INFINITY)
}

/// Returns [`over_inertia`] for the frames up to `time` (τ).
pub(crate) fn over_inertia_until(done: &FinishedRun, time: f64) -> Result<[Option<f64>; INERTIA.len()], MissingData> {
    // For a large silo, the table `elements` skips some frames; the table `rates` has all of them.
    let table = done.table("rates").or_else(|_| done.table("elements"))?;
    let pairs = pairs_of(table, time, 0.0, ["inertial_number", "packing_fraction"])?;
    Ok(INERTIA.map(|bin| in_bin(&pairs, bin)))
}

/// Returns [`over_inertia`] for elements with |D₀| of at least 0.02/τ. The first bin is empty, because this rate gives
/// |I₀| = 0.007 at the pressure at 15 d.
pub(crate) fn over_inertia_flowing(done: &FinishedRun) -> Result<[Option<f64>; INERTIA.len()], MissingData> {
    let pairs = pairs(done, FLOWING, ["inertial_number", "packing_fraction"])?;
    Ok(INERTIA.map(|bin| in_bin(&pairs, bin)))
}

/// Pairs the values in bins of `found` (first) with the values of another flow in the same bins (second). A bin that
/// `found` lacks is an error.
pub(crate) fn in_bins_of(
    found: &[Option<f64>; INERTIA.len()],
    others: impl Iterator<Item = (usize, f64)>,
) -> Result<Vec<[f64; 2]>, MissingData> {
    let pair = |(bin, other): (usize, f64)| {
        let [low, high] = INERTIA[bin];
        let lacking = || MissingData(format!("{FEWEST} elements with |I₀| of {low} to {high}"));
        found[bin].map(|found| [found, other]).ok_or_else(lacking)
    };
    let pairs: Vec<[f64; 2]> = others.map(pair).collect::<Result<_, _>>()?;
    if pairs.is_empty() { Err(MissingData("bin of |I₀| to compare".to_owned())) } else { Ok(pairs) }
}

/// Returns the pair with the largest difference.
pub(crate) fn worst(pairs: &[[f64; 2]]) -> [f64; 2] {
    let apart = |[found, expected]: &&[f64; 2]| (found - expected).abs();
    pairs.iter().max_by(|a, b| apart(a).total_cmp(&apart(b))).copied().unwrap_or([f64::NAN; 2])
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
pub(crate) fn lowest(done: &FinishedRun) -> f64 {
    if done.scene.driven.is_empty() { 2.5 } else { 10.0 }
}

/// Returns pairs of strain |E| and packing fraction of tracers above [`lowest`].
pub(crate) fn strained(done: &FinishedRun) -> Result<Vec<[f64; 2]>, MissingData> {
    let rows = Rows::from_table(done.table("tracers")?, ["z", "strain", "packing_fraction"])?;
    let lowest = lowest(done);
    Ok(rows.whole().filter(|row| row[0] > lowest).map(|[_, strain, packing]| [strain, packing]).collect())
}

/// Returns the mean packing fraction of tracers strained beyond [`PLATEAU`].
pub(crate) fn plateau(done: &FinishedRun) -> Result<f64, MissingData> {
    let pairs = strained(done)?.into_iter().filter(|pair| pair[0] > PLATEAU).map(|pair| pair[1]);
    Ok(mean(&enough(pairs.collect(), "strained tracers")?))
}

/// Bounds of the bins of strain.
pub(crate) const STRAIN: [[f64; 2]; 8] =
    [[0.02, 0.04], [0.04, 0.08], [0.08, 0.1], [0.1, 0.15], [0.15, 0.2], [0.2, 0.3], [0.3, 0.4], [0.4, 0.8]];

/// Returns the mean packing fraction of tracers in bins of strain; `None` for a bin with too few tracers.
pub(crate) fn over_strain(done: &FinishedRun, bins: &[[f64; 2]]) -> Result<Vec<Option<f64>>, MissingData> {
    let pairs = strained(done)?;
    Ok(bins.iter().map(|&bin| in_bin(&pairs, bin)).collect())
}

/// Smallest number of tracers for a median.
const FEWEST_TRACERS: usize = 8;
/// Decrease of the packing fraction that counts as dilation.
const DILATION: f64 = 0.02;

/// Returns the largest sin φ before dilation, for each tracer that dilates.
pub(crate) fn before_dilation(done: &FinishedRun) -> Result<Vec<f64>, MissingData> {
    let rows = Rows::from_table(done.table("tracers")?, ["tracer", "packing_fraction", "sine_of_friction"])?;
    let mut courses: Vec<(f64, Vec<[f64; 2]>)> = Vec::new();
    for [tracer, packing, sine] in rows.whole() {
        match courses.iter_mut().find(|(number, _)| *number == tracer) {
            Some((_, course)) => course.push([packing, sine]),
            None => courses.push((tracer, vec![[packing, sine]])),
        }
    }
    let peak_sine = |(_, course): &(f64, Vec<[f64; 2]>)| {
        let dilated = course.iter().position(|[packing, _]| *packing < course[0][0] - DILATION)?;
        Some(course[..dilated].iter().map(|[_, sine]| *sine).fold(0.0, f64::max))
    };
    let found: Vec<f64> = courses.iter().filter_map(peak_sine).collect();
    if found.len() < FEWEST_TRACERS {
        Err(MissingData(format!("{FEWEST_TRACERS} tracers that dilate")))
    } else {
        Ok(found)
    }
}

/// Returns the median of the largest sin φ before dilation.
pub(crate) fn onset(done: &FinishedRun) -> Result<f64, MissingData> {
    Ok(median(&before_dilation(done)?))
}

/// Returns a column of the table `blocks`, such as an angle, for flowing blocks away from sides and surface. `averaged`
/// selects windows of frames instead of single frames.
pub(crate) fn angles(done: &FinishedRun, flow: Flow, averaged: bool, name: &str) -> Result<Vec<f64>, MissingData> {
    let names = ["time", "frames", "x", "z", "side", "surface", "shear_rate", name];
    let rows = Rows::from_table(done.table("blocks")?, names)?;
    let flows = |&[time, frames, x, z, side, surface, rate, _]: &[f64; 8]| {
        time >= STEADY - 1e-9
            && (frames > 1.0) == averaged
            && side + surface == 0.0
            && rate >= FLOWING
            && flow.is_far_block(x, z)
    };
    let values: Vec<f64> = rows.whole().filter(flows).map(|row| row[7]).collect();
    if values.len() < 4 { Err(MissingData("four flowing blocks".to_owned())) } else { Ok(values) }
}

/// Returns the mean rotation (degrees) about y from the axes of T to the axes of D, multiplied by the sign of x. With
/// this sign, both halves of a symmetric flow contribute equally.
pub(crate) fn turn(done: &FinishedRun, flow: Flow) -> Result<f64, MissingData> {
    let (turns, places) = (angles(done, flow, false, "turn")?, angles(done, flow, false, "x")?);
    // The column `turn` counts from x to z, which is opposite to a positive rotation about y.
    Ok(turns.iter().zip(&places).map(|(turn, x)| -turn * x.signum()).sum::<f64>() / turns.len() as f64)
}

/// Returns a column of the table `whole`, which describes the whole silo, in steady flow.
pub(crate) fn whole(done: &FinishedRun, name: &str) -> Result<Vec<f64>, MissingData> {
    let rows = Rows::from_table(done.table("whole")?, ["time", name])?;
    Ok(rows.whole().filter(|row| row[0] >= STEADY - 1e-9).map(|row| row[1]).collect())
}

/// Returns the packing fraction of the deposit: the mean over elements away from sides and surface in the first frame.
pub(crate) fn deposit(done: &FinishedRun) -> Result<f64, MissingData> {
    let rows = Rows::from_table(done.table("whole")?, ["packing_fraction"])?;
    let first = rows.whole().next();
    first.map(|[packing]| packing).ok_or_else(|| MissingData("a bulk at the start".to_owned()))
}

/// Returns the number of grains that have left the silo by the last frame. Their centres are below the floor, or they
/// have been removed.
pub(crate) fn gone(done: &FinishedRun) -> Result<f64, MissingData> {
    let rows = Rows::from_table(done.table("whole")?, ["grains"])?;
    let last = rows.whole().last();
    let there = last.map(|[grains]| grains).ok_or_else(|| MissingData("a frame".to_owned()))?;
    Ok(done.scene.grains.len() as f64 - there)
}

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

/// Replaces sin φ of each element by the value of another element, for a negative control.
pub(crate) fn friction_elsewhere(tables: &mut [Table]) {
    rotate(tables, "sine_of_friction");
}

/// Replaces sin φ by tan φ, for a negative control.
pub(crate) fn tangent(tables: &mut [Table]) {
    change(tables, "sine_of_friction", |table, row| at(table, "sine_of_friction", row).asin().tan());
}

/// Replaces the shear rate from displacements of each element by the value of another element, for a negative control.
pub(crate) fn rate_elsewhere(tables: &mut [Table]) {
    rotate(tables, "shear_rate_between");
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

/// Compares D of each block with the stress of another block, for a negative control.
pub(crate) fn stress_elsewhere(tables: &mut [Table]) {
    change(tables, "largest", |table, row| at(table, "largest_elsewhere", row));
}

/// Rotates D by ten degrees about y, outwards in both halves, for a negative control.
pub(crate) fn rate_turned(tables: &mut [Table]) {
    change(tables, "turn", |table, row| at(table, "turn", row) - 10.0 * at(table, "x", row).signum());
}

/// Computes the inertial number with a density of 1 instead of 6/π, for a negative control.
pub(crate) fn density_of_one(tables: &mut [Table]) {
    change(tables, "inertial_number", |table, row| {
        at(table, "inertial_number", row) * (std::f64::consts::PI / 6.0).sqrt()
    });
}

/// Omits elements after 14 τ, the end of the prototype's runs, from φ against |I₀|, for a negative control.
pub(crate) fn without_the_end(tables: &mut [Table]) {
    change(tables, "inertial_number", |table, row| {
        if at(table, "time", row) > 14.0 + 1e-9 { f64::NAN } else { at(table, "inertial_number", row) }
    });
}

/// Computes packing fractions with radii 1 % too large, for a negative control.
pub(crate) fn larger_radii(tables: &mut [Table]) {
    change(tables, "packing_fraction", |table, row| at(table, "packing_fraction", row) * 1.01_f64.powi(3));
}
