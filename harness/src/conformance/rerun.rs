//! A rerun gives the same bits.

use super::end::NoEnd;
use super::row::{Found, Rows};
use super::{Flaw, Property, scenes};
use crate::evidence::Evidence;
use crate::verdict::Verdict;
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
        let run = || solver.run(&named.scene, &terms.resolution, &mut ()).map(lines).map_err(NoEnd::Run);
        let (first, second) = (run()?, run()?);
        let longer = first.len().abs_diff(second.len());
        let differ = first.iter().zip(&second).filter(|(a, b)| a != b).count() + longer;
        Ok(Found::deviation(differ as f64, 1.0, 0.0))
    })
}

/// A record without its times. Debug output tells every bit of a number but the sign of a NaN.
pub(super) fn lines(mut record: Record) -> Vec<String> {
    record.cost = Cost { wall_seconds: 0.0, ..record.cost };
    format!("{record:#?}").lines().map(str::to_owned).collect()
}
