//! What is found from the elements of a silo taken together: means over those that flow steadily, correlations, φ over the
//! inertial number and over strain, and how large sin φ was before an element dilated.

use super::reader::STEADY;
use grainbench_harness::reading::Table;
use grainbench_harness::run::{Done, Missing};
use grainbench_harness::statistics::median;

/// What makes the grains flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flow {
    /// They leave by a slit in the middle of the floor.
    Drained,
    /// Half of the floor is pushed up.
    Pushed,
}

/// |D₀| from which on an element flows (1/τ).
pub(crate) const FLOWING: f64 = 0.02;

impl Flow {
    /// Whether an element of 2.5 d is far from what makes the grains flow: 7.5 d from the slit, or above 12.5 d.
    fn is_far(self, x: f64, z: f64) -> bool {
        match self {
            Self::Drained => x.hypot(z) >= 7.5,
            Self::Pushed => z > 12.5,
        }
    }

    /// The same of a block of 5 d: 5 d from the slit, or above 10 d.
    fn is_far_block(self, x: f64, z: f64) -> bool {
        match self {
            Self::Drained => x.hypot(z) >= 5.0,
            Self::Pushed => z > 10.0,
        }
    }

    /// Where elements are looked at, in words.
    pub(crate) const fn words(self) -> &'static str {
        match self {
            Self::Drained => "from 7.5 d off the slit on",
            Self::Pushed => "above 12.5 d",
        }
    }
}

/// Columns of a table, row by row.
struct Rows<'a, const N: usize> {
    columns: [&'a [f64]; N],
    rows: usize,
}

impl<'a, const N: usize> Rows<'a, N> {
    fn of(table: &'a Table, names: [&str; N]) -> Result<Self, Missing> {
        let mut columns: [&[f64]; N] = [&[]; N];
        for (column, name) in columns.iter_mut().zip(names) {
            *column = table.column(name).ok_or_else(|| Missing(format!("column `{name}` of `{}`", table.name)))?;
        }
        Ok(Self { columns, rows: table.rows() })
    }

    /// Rows in which every number is one.
    fn whole(&self) -> impl Iterator<Item = [f64; N]> + '_ {
        let row = |at: usize| self.columns.map(|column| column[at]);
        (0..self.rows).map(row).filter(|row| row.iter().all(|number| number.is_finite()))
    }
}

/// A quantity of the elements of the bulk that flow steadily and lie far from what moves them.
pub(crate) fn steady(done: &Done, flow: Flow, quantity: &str) -> Result<Vec<f64>, Missing> {
    let names = ["time", "x", "z", "side", "surface", "shear_rate", quantity];
    let rows = Rows::of(done.table("elements")?, names)?;
    let values: Vec<f64> = rows
        .whole()
        .filter(|&[time, x, z, side, surface, rate, _]| {
            time >= STEADY - 1e-9 && side + surface == 0.0 && rate >= FLOWING && flow.is_far(x, z)
        })
        .map(|row| row[6])
        .collect();
    enough(values, "steadily flowing elements")
}

/// Fewer numbers than this are no ensemble.
const FEWEST: usize = 16;

fn enough(values: Vec<f64>, what: &str) -> Result<Vec<f64>, Missing> {
    if values.len() < FEWEST { Err(Missing(format!("{FEWEST} {what} (it has {})", values.len()))) } else { Ok(values) }
}

/// The mean.
pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Part of the values that lie between two.
pub(crate) fn share(values: &[f64], [low, high]: [f64; 2]) -> f64 {
    values.iter().filter(|value| (low..=high).contains(*value)).count() as f64 / values.len() as f64
}

/// A pair of quantities of all elements of the bulk that shear at so high a rate.
fn pairs(done: &Done, rate: f64, names: [&str; 2]) -> Result<Vec<[f64; 2]>, Missing> {
    pairs_of(done.table("elements")?, f64::INFINITY, rate, names)
}

/// The same of a table, up to a time.
fn pairs_of(table: &Table, until: f64, rate: f64, names: [&str; 2]) -> Result<Vec<[f64; 2]>, Missing> {
    let [a, b] = names;
    let rows = Rows::of(table, ["time", "side", "surface", "shear_rate", a, b])?;
    let is_seen = |time: f64| (STEADY - 1e-9..until + 1e-9).contains(&time);
    let flows = |row: &[f64; 6]| is_seen(row[0]) && row[1] + row[2] == 0.0 && row[3] >= rate;
    let found: Vec<[f64; 2]> = rows.whole().filter(flows).map(|row| [row[4], row[5]]).collect();
    if found.len() < FEWEST { Err(Missing(format!("{FEWEST} flowing elements"))) } else { Ok(found) }
}

/// Pearson's correlation of sin φ after Mohr and Coulomb with Drucker and Prager's ratio.
pub(crate) fn of_criteria(done: &Done) -> Result<f64, Missing> {
    Ok(correlation(&pairs(done, FLOWING, ["sine_of_friction", "drucker_prager"])?))
}

/// Pearson's correlation of log |D₀| of the instant with that from where grains were .2 τ before.
pub(crate) fn of_rates(done: &Done) -> Result<f64, Missing> {
    let pairs = pairs(done, FLOWING, ["shear_rate", "shear_rate_between"])?;
    Ok(correlation(&pairs.into_iter().map(|pair| pair.map(f64::ln)).collect::<Vec<_>>()))
}

fn correlation(pairs: &[[f64; 2]]) -> f64 {
    let count = pairs.len() as f64;
    let [x, y] = [0, 1].map(|side| pairs.iter().map(|pair| pair[side]).sum::<f64>() / count);
    let sum = |of: &dyn Fn(f64, f64) -> f64| pairs.iter().map(|pair| of(pair[0] - x, pair[1] - y)).sum::<f64>();
    sum(&|x, y| x * y) / (sum(&|x, _| x * x) * sum(&|_, y| y * y)).sqrt()
}

/// Bounds of the bins of |I₀|.
pub(crate) const INERTIA: [[f64; 2]; 10] = [
    [0.002, 0.005],
    [0.005, 0.01],
    [0.01, 0.02],
    [0.02, 0.04],
    [0.04, 0.07],
    [0.07, 0.1],
    [0.1, 0.15],
    [0.15, 0.2],
    [0.2, 0.3],
    [0.4, 0.6],
];

/// Bins, the first so many, that hold a hundred elements and more in a tenth of the tall silo: a mean of fewer is not told by two
/// draws within .008 with 99 %, for their standard deviation is .014 to .02.
pub(crate) const FULL: usize = 6;

/// Mean packing fraction of each bin of |I₀|, of the bulk without the elements at sides, whether they flow or creep; none of a
/// bin with few.
pub(crate) fn over_inertia(done: &Done) -> Result<[Option<f64>; INERTIA.len()], Missing> {
    over_inertia_until(done, f64::INFINITY)
}

/// The same of the flow up to a time.
pub(crate) fn over_inertia_until(done: &Done, time: f64) -> Result<[Option<f64>; INERTIA.len()], Missing> {
    // Of a large silo some frames of elements are left out, and what this is made of is kept of all of them.
    let table = done.table("rates").or_else(|_| done.table("elements"))?;
    let pairs = pairs_of(table, time, 0.0, ["inertial_number", "packing_fraction"])?;
    Ok(INERTIA.map(|bin| in_bin(&pairs, bin)))
}

/// The same of elements that flow, of which the first bin has none: |D₀| of .02/τ is |I₀| of .007 at the pressure of 15 d.
pub(crate) fn over_inertia_flowing(done: &Done) -> Result<[Option<f64>; INERTIA.len()], Missing> {
    let pairs = pairs(done, FLOWING, ["inertial_number", "packing_fraction"])?;
    Ok(INERTIA.map(|bin| in_bin(&pairs, bin)))
}

/// What is found in every bin that another has, beside what that one has: a bin that is lacking is told, not passed over.
pub(crate) fn in_bins_of(
    found: &[Option<f64>; INERTIA.len()],
    others: impl Iterator<Item = (usize, f64)>,
) -> Result<Vec<[f64; 2]>, Missing> {
    let pair = |(bin, other): (usize, f64)| {
        let [low, high] = INERTIA[bin];
        let lacking = || Missing(format!("{FEWEST} elements with |I₀| of {low} to {high}"));
        found[bin].map(|found| [found, other]).ok_or_else(lacking)
    };
    let pairs: Vec<[f64; 2]> = others.map(pair).collect::<Result<_, _>>()?;
    if pairs.is_empty() { Err(Missing("bin of |I₀| to compare".to_owned())) } else { Ok(pairs) }
}

/// The pair that lies farthest apart.
pub(crate) fn worst(pairs: &[[f64; 2]]) -> [f64; 2] {
    let apart = |[found, expected]: &&[f64; 2]| (found - expected).abs();
    pairs.iter().max_by(|a, b| apart(a).total_cmp(&apart(b))).copied().unwrap_or([f64::NAN; 2])
}

/// Mean of the second of pairs whose first lies in a bin.
fn in_bin(pairs: &[[f64; 2]], [low, high]: [f64; 2]) -> Option<f64> {
    let values: Vec<f64> = pairs.iter().filter(|pair| (low..high).contains(&pair[0])).map(|pair| pair[1]).collect();
    (values.len() >= FEWEST).then(|| mean(&values))
}

/// Strain |E| beyond which the packing fraction has come to its plateau.
const PLATEAU: f64 = 0.4;

/// Height above which tracers are looked at (d): below it they leave, or boxes of 5 d have grains that are held.
pub(crate) fn lowest(done: &Done) -> f64 {
    if done.scene.driven.is_empty() { 2.5 } else { 10.0 }
}

/// Strain |E| and packing fraction of tracers.
pub(crate) fn strained(done: &Done) -> Result<Vec<[f64; 2]>, Missing> {
    let rows = Rows::of(done.table("tracers")?, ["z", "strain", "packing_fraction"])?;
    let lowest = lowest(done);
    Ok(rows.whole().filter(|row| row[0] > lowest).map(|[_, strain, packing]| [strain, packing]).collect())
}

/// Mean packing fraction of tracers strained beyond [`PLATEAU`].
pub(crate) fn plateau(done: &Done) -> Result<f64, Missing> {
    let pairs = strained(done)?.into_iter().filter(|pair| pair[0] > PLATEAU).map(|pair| pair[1]);
    Ok(mean(&enough(pairs.collect(), "strained tracers")?))
}

/// Bounds of the bins of strain.
pub(crate) const STRAIN: [[f64; 2]; 8] =
    [[0.02, 0.04], [0.04, 0.08], [0.08, 0.1], [0.1, 0.15], [0.15, 0.2], [0.2, 0.3], [0.3, 0.4], [0.4, 0.8]];

/// Mean packing fraction of tracers in bins of strain.
pub(crate) fn over_strain(done: &Done, bins: &[[f64; 2]]) -> Result<Vec<Option<f64>>, Missing> {
    let pairs = strained(done)?;
    Ok(bins.iter().map(|&bin| in_bin(&pairs, bin)).collect())
}

/// Fewer tracers than this have no median.
const FEWEST_TRACERS: usize = 8;
/// A drop of the packing fraction that counts as dilation.
const DILATION: f64 = 0.02;

/// Of each tracer that dilates, the largest sin φ that it met before.
pub(crate) fn before_dilation(done: &Done) -> Result<Vec<f64>, Missing> {
    let rows = Rows::of(done.table("tracers")?, ["tracer", "packing_fraction", "sine_of_friction"])?;
    let mut courses: Vec<(f64, Vec<[f64; 2]>)> = Vec::new();
    for [tracer, packing, sine] in rows.whole() {
        match courses.iter_mut().find(|(number, _)| *number == tracer) {
            Some((_, course)) => course.push([packing, sine]),
            None => courses.push((tracer, vec![[packing, sine]])),
        }
    }
    let of = |(_, course): &(f64, Vec<[f64; 2]>)| {
        let dilated = course.iter().position(|[packing, _]| *packing < course[0][0] - DILATION)?;
        Some(course[..dilated].iter().map(|[_, sine]| *sine).fold(0.0, f64::max))
    };
    let found: Vec<f64> = courses.iter().filter_map(of).collect();
    if found.len() < FEWEST_TRACERS { Err(Missing(format!("{FEWEST_TRACERS} tracers that dilate"))) } else { Ok(found) }
}

/// The median of what tracers met before they dilated.
pub(crate) fn onset(done: &Done) -> Result<f64, Missing> {
    Ok(median(&before_dilation(done)?))
}

/// An angle of the flowing blocks of the bulk, of single frames or of windows.
pub(crate) fn angles(done: &Done, flow: Flow, averaged: bool, name: &str) -> Result<Vec<f64>, Missing> {
    let names = ["time", "frames", "x", "z", "side", "surface", "shear_rate", name];
    let rows = Rows::of(done.table("blocks")?, names)?;
    let flows = |&[time, frames, x, z, side, surface, rate, _]: &[f64; 8]| {
        time >= STEADY - 1e-9
            && (frames > 1.0) == averaged
            && side + surface == 0.0
            && rate >= FLOWING
            && flow.is_far_block(x, z)
    };
    let values: Vec<f64> = rows.whole().filter(flows).map(|row| row[7]).collect();
    if values.len() < 4 { Err(Missing("four flowing blocks".to_owned())) } else { Ok(values) }
}

/// The mean turn about y from the axes of T to those of D, with the sign of x, so that both halves of a symmetric flow
/// count alike.
pub(crate) fn turn(done: &Done, flow: Flow) -> Result<f64, Missing> {
    let (turns, places) = (angles(done, flow, false, "turn")?, angles(done, flow, false, "x")?);
    // From x to z is against the sense about y.
    Ok(turns.iter().zip(&places).map(|(turn, x)| -turn * x.signum()).sum::<f64>() / turns.len() as f64)
}

/// A column of what the silo is as a whole, from the steady flow on.
pub(crate) fn whole(done: &Done, name: &str) -> Result<Vec<f64>, Missing> {
    let rows = Rows::of(done.table("whole")?, ["time", name])?;
    Ok(rows.whole().filter(|row| row[0] >= STEADY - 1e-9).map(|row| row[1]).collect())
}

/// Packing fraction of the deposit: of the bulk in the first frame.
pub(crate) fn deposit(done: &Done) -> Result<f64, Missing> {
    let rows = Rows::of(done.table("whole")?, ["packing_fraction"])?;
    let first = rows.whole().next();
    first.map(|[packing]| packing).ok_or_else(|| Missing("a bulk at the start".to_owned()))
}

/// Grains that have left by the last frame: their centres are below the floor, or they are taken out.
pub(crate) fn gone(done: &Done) -> Result<f64, Missing> {
    let rows = Rows::of(done.table("whole")?, ["grains"])?;
    let last = rows.whole().last();
    let there = last.map(|[grains]| grains).ok_or_else(|| Missing("a frame".to_owned()))?;
    Ok(done.scene.grains.len() as f64 - there)
}

/// Elements that are given a quantity of others: each that of the one half the table away.
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

/// Friction of other elements.
pub(crate) fn friction_elsewhere(tables: &mut [Table]) {
    rotate(tables, "sine_of_friction");
}

/// The tangent of the angle of friction for its sine.
pub(crate) fn tangent(tables: &mut [Table]) {
    change(tables, "sine_of_friction", |table, row| at(table, "sine_of_friction", row).asin().tan());
}

/// Rates of other elements.
pub(crate) fn rate_elsewhere(tables: &mut [Table]) {
    rotate(tables, "shear_rate_between");
}

/// Changes the numbers of a column, row by row, of all columns of the row.
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

/// D of blocks beside the stress of other blocks.
pub(crate) fn stress_elsewhere(tables: &mut [Table]) {
    change(tables, "largest", |table, row| at(table, "largest_elsewhere", row));
}

/// D turned by ten degrees about y.
pub(crate) fn rate_turned(tables: &mut [Table]) {
    change(tables, "turn", |table, row| at(table, "turn", row) - 10.0 * at(table, "x", row).signum());
}

/// The inertial number with a density of 1 in place of 6/π.
pub(crate) fn density_of_one(tables: &mut [Table]) {
    change(tables, "inertial_number", |table, row| {
        at(table, "inertial_number", row) * (std::f64::consts::PI / 6.0).sqrt()
    });
}

/// Elements of the time after that of the prototype's runs left out of φ over |I₀|.
pub(crate) fn without_the_end(tables: &mut [Table]) {
    change(tables, "inertial_number", |table, row| {
        if at(table, "time", row) > 14.0 + 1e-9 { f64::NAN } else { at(table, "inertial_number", row) }
    });
}

/// Grains whose radii are taken a hundredth too large.
pub(crate) fn larger_radii(tables: &mut [Table]) {
    change(tables, "packing_fraction", |table, row| at(table, "packing_fraction", row) * 1.01_f64.powi(3));
}
