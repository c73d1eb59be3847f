//! A rerun gives the same bits.

use super::end::NoEnd;
use super::row::{Found, Rows};
use super::{Flaw, Property, scenes};
use crate::evidence::Evidence;
use crate::verdict::Verdict;
use grainbench_scene::kept_record;
use grainbench_scene::record::{Cost, Record};

pub(super) const PROPERTY: Property = Property {
    name: "rerun",
    claim: "the same scene at the same resolution leaves the same record, but for its times",
    flaw: Flaw::Irreproducible,
    evidence: Evidence::Invariant,
    source: "a program is a function of its input",
    because: "bits are the same or not",
    check,
};

fn check(rows: &Rows<'_>) -> Vec<Verdict> {
    let (solver, terms) = (rows.solver, rows.terms);
    let quantity = ("lines of the record that differ", "1");
    rows.each(scenes::collisions(), &terms.resolution, quantity, |named| {
        let run = || solver.run(&named.scene, &terms.resolution, &mut ()).map_err(NoEnd::Run);
        let differ = differing(run()?, run()?);
        Ok(Found::deviation(differ as f64, 1.0, 0.0))
    })
}

/// How many lines of two records differ, but for their times. Debug output tells every bit of a number but the sign of a NaN;
/// the bytes that a record is kept as tell all.
pub(super) fn differing(mut first: Record, mut second: Record) -> usize {
    for record in [&mut first, &mut second] {
        record.cost = Cost { wall_seconds: 0.0, ..record.cost };
    }
    let bytes = |record: &Record| kept_record::to_bytes("", record).ok();
    if let (Some(first), Some(second)) = (bytes(&first), bytes(&second))
        && first == second
    {
        return 0;
    }
    let lines = |record: &Record| -> Vec<String> { format!("{record:#?}").lines().map(str::to_owned).collect() };
    let (first, second) = (lines(&first), lines(&second));
    first.iter().zip(&second).filter(|(a, b)| a != b).count() + first.len().abs_diff(second.len())
}
