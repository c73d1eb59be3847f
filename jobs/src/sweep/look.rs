//! Quantities that a sweep evaluates at each point: claims of the case and quantities of the sweep file.

use super::file::{QuantityEntry, SweepClaim};
use crate::fault::Fault;
use grainbench_cases::folder::{Expression, Formula, Numbers, RecordExpression, SampleReduction};
use grainbench_harness::case::Case;
use grainbench_harness::claim::Claim;
use grainbench_harness::expect::Measurement;
use grainbench_harness::run::{FinishedRun, MissingData};
use grainbench_harness::tolerance::ToleranceOrigin;
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reports::sweep::{Quantity, QuantityResult};
use grainbench_scene::error::did_you_mean;
use grainbench_scene::scene::Scene;
use grainbench_scene::source::SceneSource;
use std::path::Path;
use std::sync::Arc;

/// Quantity that a sweep evaluates at each point.
pub(super) enum EvaluatedQuantity {
    /// Claim of the case, and the largest error that passes if the sweep file sets it.
    Gate(Box<Claim>, Option<f64>),
    /// Quantity that the sweep file defines by an arithmetic expression.
    Own(Box<SweepQuantity>),
}

/// Quantity of the sweep file with parsed expressions.
#[derive(Debug)]
pub(super) struct SweepQuantity {
    quantity: String,
    unit: String,
    value: Expression,
    at: Option<f64>,
    over: Option<SampleReduction>,
    equals: Option<Expression>,
    scale: Option<Expression>,
    allowed: Option<f64>,
}

/// Finished run of a sweep point, with the scene and the factors of the point.
pub(super) struct EvaluatedRun<'a> {
    /// Scene text in which the keys of the sweep point are set.
    pub(super) source: &'a SceneSource,
    pub(super) done: &'a FinishedRun,
    /// Function that returns the value of a factor by name; `None` if the name is unknown or the value is not a number.
    pub(super) factor: &'a dyn Fn(&str) -> Option<f64>,
}

impl EvaluatedQuantity {
    /// Finds the claim of a case by its quantity. Only claims about a single run qualify. If several have this
    /// quantity, a claim about the given variant is preferred.
    pub(super) fn gate(
        path: &Path,
        gate: &SweepClaim,
        (case, variant): (Option<&'static Case>, &str),
    ) -> Result<Self, Fault> {
        let Some(case) = case else {
            let expected = "a case as `scene`, because only cases have claims";
            return Err(Fault::at_key(path, "gates", expected, "a scene that is not a case"));
        };
        let elsewhere = |claim: &Claim| claim.elsewhere.as_ref().map(|elsewhere| elsewhere.quantity);
        let mut claims = (case.claims)();
        claims.retain(|claim| claim.runs.len() == 1 && claim.runs.iter().all(|run| run.reading.is_none()));
        let named: Vec<&Claim> = claims
            .iter()
            .filter(|claim| claim.quantity == gate.quantity || elsewhere(claim) == Some(gate.quantity.as_str()))
            .collect();
        let of_variant = named.iter().find(|claim| claim.runs.iter().all(|run| run.variant == variant));
        let Some(claim) = of_variant.or(named.first()) else {
            let mut known: Vec<&str> = Vec::new();
            for words in claims.iter().flat_map(|claim| [elsewhere(claim), Some(claim.quantity.as_str())]).flatten() {
                if !known.contains(&words) {
                    known.push(words);
                }
            }
            let help = did_you_mean(&gate.quantity, known.iter().copied()).map(|help| format!(" ({help})"));
            let expected = format!("a claim of {} about a single run, one of {}", case.name, known.join("; "));
            let found = format!("`{}`{}", gate.quantity, help.unwrap_or_default());
            return Err(Fault::at_key(path, "gates", expected, found));
        };
        if gate.allowed.is_some_and(|allowed| !(allowed.is_finite() && allowed >= 0.0)) {
            return Err(Fault::at_key(path, "gates.allowed", "a number of zero or more", "another"));
        }
        Ok(Self::Gate(Box::new((*claim).clone()), gate.allowed))
    }

    /// Reads a quantity of the sweep file.
    pub(super) fn own(path: &Path, recorded: &QuantityEntry) -> Result<Self, Fault> {
        let wrong = |key: &str, expected: &str, found: &str| {
            Fault::at_key(path, format_args!("record ({}): {key}", recorded.quantity), expected, found)
        };
        let read = |key: &str, text: &str| {
            Expression::read(text).map_err(|error| wrong(key, "arithmetic", &format!("`{text}`: {error}")))
        };
        let formula = |key: &str, formula: &Formula| match formula {
            Formula::Number(value) => read(key, &format!("{value:?}")),
            Formula::Text(text) => read(key, text),
        };
        if recorded.at.is_some() && recorded.over.is_some() {
            return Err(wrong("at", "only one of `at` and `over`", "both"));
        }
        if recorded.over == Some(SampleReduction::Course) {
            return Err(wrong("over", "`max`, `min` or `mean`", "`course`"));
        }
        if recorded.allowed.is_some_and(|allowed| !(allowed.is_finite() && allowed >= 0.0)) {
            return Err(wrong("allowed", "a number of zero or more", "another"));
        }
        if recorded.allowed.is_some() && recorded.equals.is_none() {
            return Err(wrong("equals", "an expected value, because `allowed` is its tolerance", "none"));
        }
        if recorded.equals.is_some() && recorded.allowed.is_none() {
            return Err(wrong("allowed", "a tolerance, because `equals` is set", "none"));
        }
        Ok(Self::Own(Box::new(SweepQuantity {
            quantity: recorded.quantity.clone(),
            unit: recorded.unit.clone(),
            value: read("value", &recorded.value)?,
            at: recorded.at,
            over: recorded.over,
            equals: recorded.equals.as_ref().map(|equals| formula("equals", equals)).transpose()?,
            scale: recorded.scale.as_ref().map(|scale| formula("scale", scale)).transpose()?,
            allowed: recorded.allowed,
        })))
    }

    /// Checks the names in the arithmetic expressions of the sweep file. `value` may contain columns of the record and
    /// numbers of the scene. `equals` and `scale` may contain factors, numbers of the scene and the time `t`.
    pub(super) fn check_names(
        &self,
        file: &str,
        (source, scene): (&SceneSource, &Scene),
        is_factor: &dyn Fn(&str) -> bool,
    ) -> Result<(), Fault> {
        let Self::Own(own) = self else { return Ok(()) };
        let place = |key: &str| format!("{file}: record ({}): {key}", own.quantity);
        let table = source.table().map_err(|error| Fault::Input(error.to_string()))?;
        let numbers = Numbers::new(table, scene).map_err(Fault::Input)?;
        let is_column = |name: &str| numbers.columns.iter().any(|column| column == name);
        // Columns of deformable bodies depend on the solver, so the columns of such scenes are not checked here.
        let knows_columns = scene.needs_deformable().is_none();
        let unknown = |name: &&str| numbers.is_of_record(name) && !is_column(name);
        if let Some(name) = own.value.names().into_iter().find(unknown).filter(|_| knows_columns) {
            let help = did_you_mean(name, numbers.columns.iter().map(String::as_str)).map(|help| format!(" ({help})"));
            let expected = format!("one of the columns of the record, {}", numbers.columns.join(", "));
            return Err(Fault::expected(place("value"), expected, format!("`{name}`{}", help.unwrap_or_default())));
        }
        if !own.value.names().into_iter().any(|name| numbers.is_of_record(name)) {
            let found = "no column, so no result of a run affects the value";
            return Err(Fault::expected(place("value"), "a column of the record", found));
        }
        let constant = own.scale.as_ref().filter(|scale| scale.names().is_empty());
        if let Some(scale) = constant.map(|scale| scale.value(&|_| None)).filter(|scale| !is_scale(*scale)) {
            return Err(Fault::expected(place("scale"), "a number above zero", scale));
        }
        for (key, formula) in [("equals", &own.equals), ("scale", &own.scale)] {
            let names = formula.iter().flat_map(Expression::names);
            let unknown = |name: &&str| *name != "t" && !is_factor(name) && numbers.get(name).is_none();
            if let Some(name) = names.into_iter().find(unknown) {
                let expected = "factors, the time `t`, or keys of the scene with numbers";
                return Err(Fault::expected(place(key), expected, format!("`{name}`")));
            }
        }
        Ok(())
    }

    /// Returns a text that changes if the definition of the quantity changes.
    pub(super) fn identity(&self) -> String {
        match self {
            Self::Gate(..) => format!("{:?}", self.quantity()),
            Self::Own(own) => format!("{own:?}"),
        }
    }

    /// Returns name, unit and source of the quantity, and the error limit of the sweep file, for the report.
    pub(super) fn quantity(&self) -> Quantity {
        match self {
            Self::Gate(claim, allowed) => Quantity {
                words: claim.elsewhere.as_ref().map_or(&*claim.quantity, |other| other.quantity).to_owned(),
                unit: claim.unit.to_owned(),
                allowed: *allowed,
                source: claim.source.words(),
            },
            Self::Own(own) => Quantity {
                words: own.quantity.clone(),
                unit: own.unit.clone(),
                allowed: own.allowed,
                source: String::new(),
            },
        }
    }

    /// Evaluates the quantity for a finished run.
    pub(super) fn at(&self, seen: &EvaluatedRun<'_>) -> QuantityResult {
        let found = match self {
            Self::Gate(claim, allowed) => {
                let made = match (allowed, claim.tolerance.made) {
                    (None, made) | (Some(_), made @ ToleranceOrigin::Interval) => made,
                    (Some(_), _) => ToleranceOrigin::Judged,
                };
                let done = std::slice::from_ref(seen.done);
                // The scene of a sweep point may differ from the scene of the case.
                let elsewhere = || claim.elsewhere.as_ref().map(|other| (other.allowed)(&seen.done.scene));
                let allowed = || allowed.or_else(elsewhere).unwrap_or_else(|| claim.tolerance.allowed(done));
                (claim.measure)(done).map(|measured| judged(&measured, allowed(), made))
            }
            Self::Own(own) => own.at(seen),
        };
        found.unwrap_or_else(|missing| QuantityResult::without_value(Outcome::Unsupported, Some(missing.to_string())))
    }
}

/// Compares a measurement with the largest error that passes, and returns the result for the report.
fn judged(measured: &Measurement, allowed: f64, tolerance: ToleranceOrigin) -> QuantityResult {
    let row = Verdict { allowed, tolerance, ..Verdict::open("", "", "") };
    row.judged(measured).unless_as_wide_as_the_scale().into()
}

/// Returns true if a number is a valid scale: finite and above zero.
fn is_scale(scale: f64) -> bool {
    scale.is_finite() && scale > 0.0
}

impl SweepQuantity {
    fn at(&self, seen: &EvaluatedRun<'_>) -> Result<QuantityResult, MissingData> {
        let scene = &seen.done.scene;
        let table = seen.source.table().map_err(|error| MissingData(error.to_string()))?;
        let numbers = Arc::new(Numbers::new(table, scene).map_err(MissingData)?);
        let read = RecordExpression {
            value: self.value.clone(),
            numbers: Arc::clone(&numbers),
            at: self.at,
            over: self.over,
            follows_time: true,
        };
        let (time, value) = read.one(seen.done)?;
        let evaluated = |formula: &Expression| {
            formula.value(&|name| match name {
                "t" => Some(time),
                _ => (seen.factor)(name).or_else(|| numbers.get(name)),
            })
        };
        let Some(expected) = self.equals.as_ref().map(evaluated) else {
            let value = Some(value).filter(|value| value.is_finite());
            return Ok(QuantityResult { value, ..QuantityResult::default() });
        };
        let own_scale = self.scale.as_ref().map(evaluated);
        let scale = own_scale.unwrap_or(expected.abs());
        let measured = Measurement::new(value, expected, scale);
        let row = judged(&measured, self.allowed.unwrap_or_default(), ToleranceOrigin::Judged);
        if own_scale.is_some_and(|scale| !is_scale(scale)) {
            let detail = Some(format!("scale: expected a number above zero, found {scale}"));
            return Ok(QuantityResult { verdict: Some(Outcome::Broken), detail, ..row });
        }
        Ok(row)
    }
}
