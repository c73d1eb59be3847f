//! Results of claims, as shown in all tables and written to `results.json`.

use crate::control::FailureMode;
use crate::evidence::Evidence;
use crate::expect::{ExpectedValue, Measurement};
use crate::tolerance::ToleranceOrigin;
use grainbench_solver::failure::RunError;
use serde::ser::SerializeStruct;
use serde::{Deserialize, Serialize, Serializer};

/// Colour of a result. It determines exit codes, pages and summaries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// The result passes.
    Green,
    /// The result is inconclusive, or it has a documented error.
    Amber,
    /// The result fails, its run crashed, or its reference belongs to another scene.
    Red,
}

/// Outcome of a result. Only `Pass` is green.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// The error is at most the allowed error.
    Pass,
    /// The error exceeds the allowed error.
    #[default]
    Fail,
    /// The error exceeds the allowed error, but is a documented error of the method or program.
    Known,
    /// The reference was made from another scene.
    Stale,
    /// The result passes, but uses a stored result of older solver sources.
    Outdated,
    /// There is no reference to compare with, or the tolerance is too large for a conclusion.
    NoReference,
    /// The solver cannot represent this scene.
    Unsupported,
    /// The program is not installed, or third-party data are missing.
    NotAvailable,
    /// The run ended with an error.
    Broken,
}

impl Outcome {
    /// Returns the colour of the outcome.
    #[must_use]
    pub const fn severity(self) -> Severity {
        match self {
            Self::Pass => Severity::Green,
            Self::Fail | Self::Broken | Self::Stale => Severity::Red,
            Self::Known | Self::Outdated | Self::NoReference | Self::Unsupported | Self::NotAvailable => {
                Severity::Amber
            }
        }
    }

    /// Returns true if the outcome is red.
    #[must_use]
    pub const fn is_red(self) -> bool {
        matches!(self.severity(), Severity::Red)
    }

    /// Returns true for all outcomes except those without a reference, an available program or a supported scene. A report
    /// without a judged result does not pass.
    #[must_use]
    pub const fn is_judged(self) -> bool {
        !matches!(self, Self::NoReference | Self::Unsupported | Self::NotAvailable)
    }

    /// Returns the name used in result files and tables.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Known => "known",
            Self::Stale => "stale",
            Self::Outdated => "outdated",
            Self::NoReference => "no-reference",
            Self::Unsupported => "unsupported",
            Self::NotAvailable => "not-available",
            Self::Broken => "broken",
        }
    }
}

impl From<&RunError> for Outcome {
    fn from(error: &RunError) -> Self {
        match error {
            RunError::Unsupported { .. } => Self::Unsupported,
            RunError::NotAvailable { .. } => Self::NotAvailable,
            RunError::Stale { .. } => Self::Stale,
            RunError::Resolution { .. }
            | RunError::Program { .. }
            | RunError::Broken(_)
            | RunError::NotFinite { .. }
            | RunError::NotStored(_)
            | RunError::Interrupted { .. }
            | RunError::Checkpoint(_) => Self::Broken,
        }
    }
}

/// Result of a claim: a row of `results.json`, `report.json`, `rows.csv`, and of the stored results of external solvers.
///
/// Stored results of earlier versions lack the fields with a default.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[must_use]
pub struct Verdict {
    /// Case name, such as `nine-discs`.
    pub case: String,
    /// Variant of the case's scene, such as `kappa-1`.
    pub variant: String,
    /// Solver and convention, such as `dem:lammps`.
    #[serde(default)]
    pub solver: String,
    /// Resolution level, or first and last of several levels, such as `dt=.1`.
    pub resolution: String,
    /// Measured quantity, in words.
    pub quantity: String,
    /// Unit of `value`, `expected` and `scale`; `1` for a pure number.
    pub unit: String,
    /// Measured value; absent if the run crashed.
    pub value: Option<f64>,
    /// Expected value, bound, band or order; absent if it is unknown.
    pub expected: Option<ExpectedValue>,
    /// Scale by which the error is divided.
    pub scale: Option<f64>,
    /// Signed `(value − expected)/scale`; for a bound, the distance beyond the bound, divided by `scale`. Absent if it
    /// is not finite.
    pub error: Option<f64>,
    /// Largest |error| that passes.
    pub allowed: f64,
    /// Origin of the tolerance.
    #[serde(default)]
    pub tolerance: ToleranceOrigin,
    /// Reason for the tolerance.
    #[serde(default)]
    pub because: String,
    /// Kind of evidence.
    #[serde(default)]
    pub evidence: Evidence,
    /// Source of the expected value.
    #[serde(default)]
    pub source: String,
    /// Outcome of the result.
    #[serde(rename = "verdict")]
    pub outcome: Outcome,
    /// Reason for an outcome other than pass or fail, or details of a failure, such as the time of the first sample outside
    /// the tolerance.
    pub detail: Option<String>,
}

/// The keys are a public interface. The colour is written beside the outcome from which it follows.
impl Serialize for Verdict {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut row = serializer.serialize_struct("Verdict", 18)?;
        row.serialize_field("case", &self.case)?;
        row.serialize_field("variant", &self.variant)?;
        row.serialize_field("solver", &self.solver)?;
        row.serialize_field("resolution", &self.resolution)?;
        row.serialize_field("quantity", &self.quantity)?;
        row.serialize_field("unit", &self.unit)?;
        row.serialize_field("value", &self.value)?;
        row.serialize_field("expected", &self.expected)?;
        row.serialize_field("scale", &self.scale)?;
        row.serialize_field("error", &self.error)?;
        row.serialize_field("allowed", &self.allowed)?;
        row.serialize_field("tolerance", &self.tolerance)?;
        row.serialize_field("because", &self.because)?;
        row.serialize_field("evidence", &self.evidence)?;
        row.serialize_field("source", &self.source)?;
        row.serialize_field("verdict", &self.outcome)?;
        row.serialize_field("detail", &self.detail)?;
        row.serialize_field("severity", &self.outcome.severity())?;
        row.end()
    }
}

impl Verdict {
    /// Returns the key of the result in a report: case, variant, solver, resolution and quantity.
    #[must_use]
    pub fn key(&self) -> [&str; 5] {
        [&self.case, &self.variant, &self.solver, &self.resolution, &self.quantity].map(String::as_str)
    }

    /// Returns a result that is not judged yet. Its outcome is `Fail`.
    pub fn open(case: impl Into<String>, quantity: impl Into<String>, unit: impl Into<String>) -> Self {
        Self {
            case: case.into(),
            quantity: quantity.into(),
            unit: unit.into(),
            tolerance: ToleranceOrigin::Exact,
            evidence: Evidence::Invariant,
            ..Self::default()
        }
    }

    /// Returns the result of a run that ended with an error.
    pub fn ended(self, error: &RunError) -> Self {
        Self { outcome: Outcome::from(error), detail: Some(error.to_string()), ..self }
    }

    /// Returns the result with another outcome and its reason.
    pub fn left(self, outcome: Outcome, reason: impl Into<String>) -> Self {
        Self { outcome, detail: Some(reason.into()), ..self }
    }

    /// Returns the judged result. It passes only if the error is finite and |error| is at most the allowed error.
    pub fn judged(self, found: &Measurement) -> Self {
        let finite = |value: f64| value.is_finite().then_some(value);
        let error = found.error();
        let passes = error.is_finite() && error.abs() <= self.allowed;
        Self {
            value: finite(found.value),
            expected: Some(found.expected).filter(|expected| expected.is_finite()),
            scale: finite(found.scale),
            error: finite(error),
            outcome: if passes { Outcome::Pass } else { Outcome::Fail },
            detail: if passes { None } else { found.first_outside(self.allowed) },
            ..self
        }
    }

    /// Makes a passed result amber, with a reason, if the allowed error exceeds `most`. Both are fractions of the scale.
    pub fn unless_wider_than(self, most: f64) -> Self {
        if self.outcome == Outcome::Pass && self.allowed > most {
            let [allowed, most] = [self.allowed, most].map(|part| 100.0 * part);
            let reason = format!("inconclusive: the tolerance is {allowed:.3} % of the scale, above {most} %");
            return self.left(Outcome::NoReference, reason);
        }
        self
    }

    /// Makes a passed result amber, with a reason, if a single value is expected and the allowed error is at least the
    /// scale. This does not apply to a confidence interval. A computed tolerance of exactly 1 is also accepted, because
    /// the scale is then the limit itself.
    pub fn unless_as_wide_as_the_scale(self) -> Self {
        let is_value = matches!(self.expected, Some(ExpectedValue::Value(_)));
        let is_wide = match self.tolerance {
            ToleranceOrigin::Interval => false,
            ToleranceOrigin::Computed => self.allowed > 1.0,
            _ => self.allowed >= 1.0,
        };
        if self.outcome == Outcome::Pass && is_value && is_wide {
            let allowed = 100.0 * self.allowed;
            let reason = format!("inconclusive: the tolerance is {allowed:.3} % of the scale, 100 % or more");
            return self.left(Outcome::NoReference, reason);
        }
        self
    }

    /// Returns the way in which the claim failed; none for an outcome other than `Fail` and `Broken`.
    #[must_use]
    pub fn red(&self) -> Option<FailureMode> {
        match self.outcome {
            Outcome::Fail if self.value.is_some() && self.error.is_some() => Some(FailureMode::Value),
            Outcome::Fail | Outcome::Broken => Some(FailureMode::Breaking),
            _ => None,
        }
    }

    /// Returns |error|/allowed, which is 1 at the limit; none if the allowed error is zero or the error is unknown.
    #[must_use]
    pub fn closeness(&self) -> Option<f64> {
        self.error.filter(|_| self.allowed > 0.0).map(|error| error.abs() / self.allowed)
    }
}

/// Result of a negative control, under whose wrong physics the claim must fail.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[must_use]
pub struct ControlResult {
    /// Case of the claim.
    pub case: String,
    /// Variant of the claim.
    pub variant: String,
    /// Solver of the claim's first run, or the external solver.
    pub solver: String,
    /// Quantity of the claim.
    pub quantity: String,
    /// Wrong physics, in words.
    pub wrong_physics: String,
    /// Required way of failing: by value or by error.
    pub how: FailureMode,
    /// Signed error under wrong physics; absent if it is not finite or the run crashed.
    pub error: Option<f64>,
    /// Largest |error| that passes.
    pub allowed: f64,
    /// True if the claim failed in the required way. For a known error, true if the claim passed.
    pub turned_red: bool,
    /// Detail of the result; absent if the claim failed in the required way.
    pub detail: Option<String>,
    /// Elapsed time (s). It includes runs that other controls share.
    pub seconds: f64,
}

impl ControlResult {
    /// Returns a control from a result under wrong physics. `how` is the required way of failing.
    pub fn new(row: Verdict, wrong_physics: &str, how: FailureMode, seconds: f64) -> Self {
        let turned_red = row.red() == Some(how);
        Self {
            turned_red,
            case: row.case,
            variant: row.variant,
            solver: row.solver,
            quantity: row.quantity,
            wrong_physics: wrong_physics.to_owned(),
            how,
            error: row.error,
            allowed: row.allowed,
            detail: if turned_red { None } else { row.detail },
            seconds,
        }
    }
}

/// Returns true if results and controls pass: at least one result is judged, none is red, and each control failed as required.
/// Exit codes, `results.json` and the tests of solvers follow this rule.
#[must_use]
pub fn passes<'a>(
    outcomes: impl IntoIterator<Item = Outcome>,
    controls: impl IntoIterator<Item = &'a ControlResult>,
) -> bool {
    let (mut is_judged, mut is_red) = (false, false);
    for outcome in outcomes {
        is_judged |= outcome.is_judged();
        is_red |= outcome.is_red();
    }
    is_judged && !is_red && controls.into_iter().all(|control| control.turned_red)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expect::Bound;

    /// One judged result is enough, also if it is a documented error. Negative controls of the rule: no judged result, a red
    /// result, and a control that did not fail.
    #[test]
    fn results_pass_if_one_is_judged_and_nothing_is_red() {
        let row = |outcome| Verdict { outcome, ..Verdict::open("case", "quantity", "1") };
        let passes = |outcomes: &[Outcome]| passes(outcomes.iter().copied(), []);
        let passing = [&[Outcome::Pass, Outcome::Unsupported][..], &[Outcome::Known], &[Outcome::Outdated]];
        let unjudged = [&[][..], &[Outcome::Unsupported], &[Outcome::NoReference, Outcome::NotAvailable]];
        let red = [&[Outcome::Pass, Outcome::Fail][..], &[Outcome::Broken], &[Outcome::Pass, Outcome::Stale]];
        assert!(passing.iter().all(|outcomes| passes(outcomes)));
        assert!(!unjudged.iter().chain(&red).any(|outcomes| passes(outcomes)));
        let green = ControlResult::new(row(Outcome::Pass), "half the friction", FailureMode::Value, 0.0);
        assert!(!super::passes([Outcome::Pass], [&green]));
        assert!(super::passes([Outcome::Pass], [&ControlResult { turned_red: true, ..green }]));
    }

    #[test]
    fn a_tolerance_as_large_as_the_scale_shows_nothing() {
        let row = |allowed, tolerance, expected: ExpectedValue| {
            let open = Verdict { allowed, tolerance, ..Verdict::open("case", "quantity", "1") };
            open.judged(&Measurement::new(1.5, expected, 1.0)).unless_as_wide_as_the_scale()
        };
        let outcome = |allowed, tolerance| row(allowed, tolerance, ExpectedValue::Value(1.0)).outcome;
        assert_eq!(outcome(0.99, ToleranceOrigin::Judged), Outcome::Pass);
        assert_eq!(outcome(1.0, ToleranceOrigin::Judged), Outcome::NoReference);
        assert_eq!(outcome(1.0, ToleranceOrigin::Computed), Outcome::Pass);
        assert_eq!(outcome(20.0, ToleranceOrigin::Computed), Outcome::NoReference);
        assert_eq!(outcome(1.0, ToleranceOrigin::Interval), Outcome::Pass);
        let bound = row(20.0, ToleranceOrigin::Judged, ExpectedValue::Bound(Bound::AtMost(1.0)));
        assert_eq!(bound.outcome, Outcome::Pass);
        let detail = row(20.0, ToleranceOrigin::Judged, ExpectedValue::Value(1.0)).detail;
        assert!(detail.is_some_and(|detail| detail.contains("the tolerance is 2000.000 % of the scale")));
    }

    /// This holds for every tolerance, because a failed run may have determined the tolerance.
    #[test]
    fn what_is_not_finite_is_never_green() {
        for allowed in [0.0, 1.0, f64::INFINITY, f64::NAN] {
            for value in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let row = Verdict { allowed, ..Verdict::open("case", "quantity", "1") };
                let judged = row.judged(&Measurement::new(value, 0.0, 1.0));
                assert_eq!(judged.outcome, Outcome::Fail, "{value} of {allowed}");
            }
        }
        let row = Verdict { allowed: f64::NAN, ..Verdict::open("case", "quantity", "1") };
        assert_eq!(row.judged(&Measurement::new(0.0, 0.0, 1.0)).outcome, Outcome::Fail);
    }
}
