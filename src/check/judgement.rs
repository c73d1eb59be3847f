//! Tolerances of a check, constant or varying in time, increased by the uncertainty of the printed digits.

use grainbench_harness::compare::peers::{ColumnComparison, DecisiveSample, Sample, WIDE};
use grainbench_harness::expect::Measurement;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reference::outputs::Outputs;
use grainbench_reports::number;

/// Judges a measured value. The uncertainty `open` of the printed digits is added to the tolerance. The result is not
/// green if the tolerance exceeds [`WIDE`], a twentieth of the scale.
pub(super) fn judged(row: Verdict, open: f64, outputs: &Outputs, found: &Measurement) -> Verdict {
    widened(row, open, outputs).judged(found).unless_wider_than(WIDE)
}

/// Allowed error of a column without the uncertainty of the printed digits.
pub(super) struct ErrorAllowance {
    /// Constant part of the allowed error, as a fraction of the scale.
    pub(super) floor: f64,
    /// Factor for the change due to half the time step.
    pub(super) times: f64,
    /// Treatment of the difference between the runs.
    pub(super) between: Between,
}

/// Treatment of the difference between the nearest run and the other runs.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Between {
    /// The difference is part of the allowed error; with the name of the runs.
    Allowed(&'static str),
    /// The difference is not allowed, because each run is a different convention.
    Refused,
    /// An error above the allowed error but within the difference is inconclusive.
    Inconclusive,
}

/// Returns true if a sample is outside the tolerance of the convention with which it was compared.
pub(super) fn is_outside(row: &Verdict) -> bool {
    row.detail.as_deref().is_some_and(|detail| detail.starts_with(OUTSIDE))
}

/// First words of the detail of a result with a sample outside the tolerance.
pub(super) const OUTSIDE: &str = "first outside at t = ";

/// Largest fraction of samples with an allowed error above [`WIDE`]. If the fraction is larger, the result is inconclusive.
const FEW: f64 = 0.1;

/// Judges a column at each sample. The allowed error follows from the differences between the runs around that time.
pub(super) fn judged_in_time(
    row: Verdict,
    compared: &ColumnComparison<'_>,
    beside: &ErrorAllowance,
    outputs: &Outputs,
) -> Verdict {
    let own = |sample: &Sample| beside.floor + beside.times * sample.halved;
    let allowed = |sample: &Sample| match beside.between {
        Between::Allowed(_) => own(sample) + sample.between,
        Between::Refused | Between::Inconclusive => own(sample),
    };
    let Some(decisive) = compared.decisive(|sample| allowed(sample) + compared.open) else {
        return row.left(Outcome::NoReference, "the output has no sample");
    };
    let DecisiveSample { sample, wide, first_outside, .. } = decisive;
    let times =
        if beside.times == 1.0 { String::new() } else { format!(", times {}", number::significant(beside.times, 3)) };
    let runs = match beside.between {
        Between::Allowed(runs) => format!("{runs} differ by {}, ", number::fraction(sample.between)),
        Between::Refused | Between::Inconclusive => String::new(),
    };
    let because = format!(
        "tolerance near t = {} s: {runs}halving the step changes {}{times}, plus {}",
        number::significant(sample.time, 6),
        number::fraction(sample.halved),
        number::fraction(beside.floor)
    );
    let row = widened(Verdict { allowed: allowed(&sample), because, ..row }, compared.open, outputs);
    let row = row.judged(&compared.measured(&sample));
    let count = compared.samples.len();
    match (row.outcome, first_outside) {
        (Outcome::Fail, Some(time)) => {
            let how = if row.error.is_none() { "not a number (NaN) from t = " } else { OUTSIDE };
            let row = Verdict { detail: Some(format!("{how}{time:.6} s")), ..row };
            let within = compared.decisive(|sample| own(sample) + sample.between + compared.open);
            let is_within = within.is_some_and(|decisive| decisive.first_outside.is_none());
            if beside.between != Between::Inconclusive || !is_within {
                return row;
            }
            let detail = row.detail.clone().unwrap_or_default();
            let between = number::fraction(sample.between);
            let words = "inconclusive: our conventions differ by";
            row.left(Outcome::NoReference, format!("{detail}; {words} {between} (--convention selects one)"))
        }
        (Outcome::Pass, _) if wide as f64 > FEW * count as f64 => {
            let most = 100.0 * WIDE;
            let found = format!("for {wide} of {count} samples the tolerance is above {most} % of the scale");
            row.left(Outcome::NoReference, format!("inconclusive: {found}"))
        }
        (Outcome::Pass, _) if wide > 0 => {
            let because = format!("{}; {wide} of {count} samples with too large a tolerance are skipped", row.because);
            Verdict { because, ..row }
        }
        _ => row,
    }
}

/// Adds the uncertainty of the printed digits to the tolerance.
fn widened(mut row: Verdict, open: f64, outputs: &Outputs) -> Verdict {
    row.allowed += open;
    // An addition below a thousandth of the tolerance is not reported.
    if open > 1e-3 * row.allowed {
        let digits = outputs.significant_digits;
        let words = format!("; plus {} for the printed digits, at most {digits}", number::fraction(open));
        row.because.push_str(&words);
    }
    row
}
