//! Tolerances of a check: constant or over time, increased by the rounding of the printed digits.

use grainbench_harness::compare::peers::{ColumnComparison, DecisiveSample, Sample, WIDE};
use grainbench_harness::expect::Measurement;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reference::outputs::Outputs;
use grainbench_reports::number;

/// Evaluates a measured value, with the tolerance widened by the uncertainty of the printed digits. A tolerance above a
/// twentieth of the scale never gives a green result.
pub(super) fn judged(row: Verdict, open: f64, outputs: &Outputs, found: &Measurement) -> Verdict {
    widened(row, open, outputs).judged(found).unless_wider_than(WIDE)
}

/// Allowed error of a column, without the uncertainty of its digits.
pub(super) struct ErrorAllowance {
    /// Constant part of the tolerance, as a fraction of the scale.
    pub(super) floor: f64,
    /// Factor for the change from halving the time step.
    pub(super) times: f64,
    /// Description of the runs whose difference sets the tolerance.
    pub(super) conventions: &'static str,
}

/// Largest fraction of samples with a tolerance above [`WIDE`]. If more samples have one, a pass becomes inconclusive.
const FEW: f64 = 0.1;

/// Evaluates a column at each sample, with a tolerance from the differences between its runs around that time.
pub(super) fn judged_in_time(
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
