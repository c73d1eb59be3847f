//! Determinism: a repeated run gives the same bits.

use super::end::NoEnd;
use super::row::{PropertyValue, Rows};
use super::{Flaw, Property, scenes};
use crate::evidence::Evidence;
use crate::verdict::Verdict;
use grainbench_solver::Solver;
use grainbench_solver::kept_record;
use grainbench_solver::record::{Cost, Record};

pub(super) const PROPERTY: Property = Property {
    name: "rerun",
    claim: "the same scene at the same resolution gives the same record, except for computing times",
    flaw: Flaw::Irreproducible,
    evidence: Evidence::Invariant,
    source: "a program is a function of its input",
    because: "bits must be equal",
    check,
};

fn check(rows: &Rows<'_>) -> Vec<Verdict> {
    let (solver, terms) = (rows.solver, rows.terms);
    let quantity = ("bytes of the record that differ", "1");
    rows.each(scenes::collisions(), &terms.resolution, quantity, |named| {
        let run = |solver: &dyn Solver| solver.run(&named.scene, &terms.resolution, &mut ()).map_err(NoEnd::Run);
        let differ = differing(run(solver)?, run(rows.again)?)?;
        Ok(PropertyValue::deviation(differ as f64, 1.0, 0.0))
    })
}

/// Returns the number of bytes in which two stored records differ. The measured run time is ignored.
pub(super) fn differing(mut first: Record, mut second: Record) -> Result<usize, NoEnd> {
    for record in [&mut first, &mut second] {
        record.cost = Cost { wall_seconds: 0.0, ..record.cost };
    }
    let bytes = |record: &Record| kept_record::body("", record).map_err(NoEnd::Record);
    let (first, second) = (bytes(&first)?, bytes(&second)?);
    Ok(first.iter().zip(&second).filter(|(a, b)| a != b).count() + first.len().abs_diff(second.len()))
}
