//! A gate compares a quantity of one or more records with an expectation that has a source, and says why its
//! tolerance is what it is. Every gate has a negative control: wrong physics that it must refuse.

use crate::effect::Effect;
use crate::scope::Scope;
use crate::verdict::Evidence;
use grainbench_dem::solver::Defect;
use grainbench_scene::record::{Record, Series};
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::Resolution;
use std::fmt;
use std::sync::Arc;

/// A change of a scene, by code.
pub type Change = Arc<dyn Fn(&mut Scene) + Send + Sync>;

/// One run that a gate reads.
#[derive(Clone)]
pub struct Run {
    /// Variant of the scene.
    pub variant: &'static str,
    /// Solver, by name.
    pub solver: &'static str,
    /// Resolution.
    pub resolution: Resolution,
    /// A change of the scene that belongs to the claim, such as another stiffness in a sweep: its name, which tells
    /// runs apart, and what it does.
    pub adjustment: Option<(String, Change)>,
    /// What is expected of the row.
    pub standing: Standing,
    /// The smallest set that it belongs to.
    pub set: Set,
    /// Whether it is there to judge by, and no negative control touches it.
    pub aside: bool,
}

/// Sets of runs, each with all of those before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Set {
    /// What the main job does: at most a few seconds a run.
    #[default]
    Main,
    /// What the tests do beside it.
    Tests,
    /// What takes minutes.
    Long,
}

/// What is expected of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Standing {
    /// It passes.
    #[default]
    Passes,
    /// The solver refuses the scene, because it cannot express it.
    Refused,
    /// The error of a method or program that is known to be off here, with the reason: shown amber for as long as it is
    /// outside what is allowed.
    Known(&'static str),
}

impl Run {
    /// A run of a variant as it stands.
    #[must_use]
    pub fn new(variant: &'static str, solver: &'static str, resolution: Resolution) -> Self {
        Self { variant, solver, resolution, adjustment: None, standing: Standing::Passes, set: Set::Main, aside: false }
    }

    /// The run with a change of the scene.
    #[must_use]
    pub fn adjusted(mut self, name: &str, change: impl Fn(&mut Scene) + Send + Sync + 'static) -> Self {
        self.adjustment = Some((name.to_owned(), Arc::new(change)));
        self
    }

    /// The run of a method that is known to be off here.
    #[must_use]
    pub fn known(self, reason: &'static str) -> Self {
        Self { standing: Standing::Known(reason), ..self }
    }

    /// The run as one that only the tests do, not the main job.
    #[must_use]
    pub fn slow(self) -> Self {
        Self { set: Set::Tests, ..self }
    }

    /// The run as one of the long set.
    #[must_use]
    pub fn long(self) -> Self {
        Self { set: Set::Long, ..self }
    }

    /// The run as one that judges and is not judged: negative controls leave it alone.
    #[must_use]
    pub fn aside(self) -> Self {
        Self { aside: true, ..self }
    }

    /// The same run at another resolution.
    #[must_use]
    pub fn at(&self, resolution: Resolution) -> Self {
        Self { resolution, ..self.clone() }
    }

    /// What tells this run from others of its case.
    #[must_use]
    pub fn key(&self) -> String {
        let adjustment = self.adjustment.as_ref().map(|(name, _)| name.as_str()).unwrap_or_default();
        format!("{}|{}|{:?}|{adjustment}", self.variant, self.solver, self.resolution)
    }
}

/// A run that was done: what the scene was meant to be, and what the solver left.
#[derive(Clone, Debug)]
pub struct Done {
    /// The scene as the case means it. In a negative control the solver was given a wrong one.
    pub scene: Arc<Scene>,
    /// The record.
    pub record: Arc<Record>,
}

/// A quantity that the records do not have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Missing(pub String);

impl fmt::Display for Missing {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "the record has no {}", self.0)
    }
}

impl Done {
    /// The time series.
    #[must_use]
    pub fn series(&self) -> &Series {
        &self.record.series
    }

    /// A column of the time series.
    ///
    /// # Errors
    /// When there is no such column or it is empty.
    pub fn column(&self, name: &str) -> Result<&[f64], Missing> {
        match self.series().column(name) {
            Some(values) if !values.is_empty() => Ok(values),
            _ => Err(Missing(format!("column `{name}`"))),
        }
    }

    /// The last value of a column.
    ///
    /// # Errors
    /// When there is no such column or it is empty.
    pub fn last(&self, name: &str) -> Result<f64, Missing> {
        Ok(self.column(name)?[self.column(name)?.len() - 1])
    }

    /// The value of a column at a step.
    ///
    /// # Errors
    /// When the column is missing or was not sampled at that step.
    pub fn at_step(&self, name: &str, step: u64) -> Result<f64, Missing> {
        let values = self.column(name)?;
        let at = self.series().step.iter().position(|&sampled| sampled == step);
        at.map(|at| values[at]).ok_or_else(|| Missing(format!("sample of `{name}` at step {step}")))
    }
}

/// What a gate measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The value.
    pub value: f64,
    /// What it should be.
    pub expected: f64,
    /// What the difference is divided by.
    pub scale: f64,
    /// For a comparison over time: time (s) and signed error of every sample, so that a failure can say when it began.
    pub course: Vec<(f64, f64)>,
}

impl Measured {
    /// A single value.
    #[must_use]
    pub const fn new(value: f64, expected: f64, scale: f64) -> Self {
        Self { value, expected, scale, course: Vec::new() }
    }

    /// The worst sample of a time series against an exact course.
    #[must_use]
    pub fn worst(time: &[f64], values: &[f64], exact: impl Fn(f64) -> f64, scale: f64) -> Self {
        let expected: Vec<f64> = time.iter().map(|&t| exact(t)).collect();
        Self::worst_of(time, values, &expected, scale)
    }

    /// The worst sample of a time series against another one.
    #[must_use]
    pub fn worst_of(time: &[f64], values: &[f64], expected: &[f64], scale: f64) -> Self {
        let errors = values.iter().zip(expected).map(|(value, expected)| (value - expected) / scale);
        let course: Vec<(f64, f64)> = time.iter().copied().zip(errors).collect();
        // A value that is not a number is worse than any other.
        let weight = |error: f64| if error.is_nan() { f64::INFINITY } else { error.abs() };
        let worst = (0..course.len()).max_by(|&a, &b| weight(course[a].1).total_cmp(&weight(course[b].1))).unwrap_or(0);
        let pick = |list: &[f64]| list.get(worst).copied().unwrap_or(f64::NAN);
        Self { value: pick(values), expected: pick(expected), scale, course }
    }

    /// When a comparison over time first left what is allowed, in words: what is not a number is called so.
    #[must_use]
    pub fn first_outside(&self, allowed: f64) -> Option<String> {
        let first = self.course.iter().find(|(_, error)| error.is_nan() || error.abs() > allowed);
        first.map(|(time, error)| {
            let how = if error.is_nan() { "not a number (NaN) from" } else { "first outside at" };
            format!("{how} t = {time:.6} s")
        })
    }

    /// Signed error, (value − expected)/scale.
    #[must_use]
    pub fn error(&self) -> f64 {
        (self.value - self.expected) / self.scale
    }
}

/// Wrong physics for a negative control.
#[derive(Clone)]
pub enum Wrong {
    /// The solver is given a wrong scene.
    Scene(Change),
    /// In a comparison with another program, our own solver is given a wrong scene.
    Ours(Change),
    /// The solver has a defect.
    Solver(Defect),
    /// Another solver takes its place.
    OtherSolver(&'static str),
    /// Another solver takes its place, at a resolution of its own.
    OtherRun(&'static str, Resolution),
}

/// A negative control: what is made wrong, in words and in deed.
#[derive(Clone)]
pub struct Control {
    /// What is wrong, such as `a sphere's inertia in a disc`.
    pub name: &'static str,
    /// How.
    pub wrong: Wrong,
}

impl Control {
    /// A wrong scene.
    #[must_use]
    pub fn scene(name: &'static str, change: impl Fn(&mut Scene) + Send + Sync + 'static) -> Self {
        Self { name, wrong: Wrong::Scene(Arc::new(change)) }
    }

    /// A scene without an effect that it calls for.
    #[must_use]
    pub fn without(effect: Effect) -> Self {
        Self { name: effect.absence(), wrong: Wrong::Scene(Arc::new(move |scene| effect.switch_off(scene))) }
    }

    /// A wrong scene for our own side of a comparison with another program.
    #[must_use]
    pub fn ours(name: &'static str, change: impl Fn(&mut Scene) + Send + Sync + 'static) -> Self {
        Self { name, wrong: Wrong::Ours(Arc::new(change)) }
    }

    /// A solver whose contacts forget.
    #[must_use]
    pub const fn forgets_history() -> Self {
        Self { name: "contacts forget their history", wrong: Wrong::Solver(Defect::ForgetsHistory) }
    }

    /// Another solver.
    #[must_use]
    pub const fn solver(name: &'static str, solver: &'static str) -> Self {
        Self { name, wrong: Wrong::OtherSolver(solver) }
    }

    /// Of a known error: a solver that does not have it, at a resolution of its own. The row must then pass.
    #[must_use]
    pub const fn without_the_error(name: &'static str, solver: &'static str, resolution: Resolution) -> Self {
        Self { name, wrong: Wrong::OtherRun(solver, resolution) }
    }
}

/// Reads the records of a gate's runs, in their order.
pub type Measure = Arc<dyn Fn(&[Done]) -> Result<Measured, Missing> + Send + Sync>;

/// A gate.
#[derive(Clone)]
pub struct Gate {
    /// What is measured, in words.
    pub quantity: String,
    /// Unit of value, expectation and scale; `1` for a pure number.
    pub unit: &'static str,
    /// Kind of source.
    pub evidence: Evidence,
    /// Whom it is fair to.
    pub scope: Scope,
    /// Where the expectation comes from.
    pub source: &'static str,
    /// Largest |error| that passes.
    pub allowed: f64,
    /// Why the tolerance is what it is.
    pub because: &'static str,
    /// What is read. The first run names the row.
    pub runs: Vec<Run>,
    /// How it is measured.
    pub measure: Measure,
    /// What it must refuse.
    pub control: Control,
}

impl Gate {
    /// A gate on named solvers: quantity and unit, the runs it reads, kind of source and source, tolerance and its reason,
    /// what it must refuse, and how it is measured.
    #[must_use]
    pub fn new(
        (quantity, unit): (impl Into<String>, &'static str),
        runs: Vec<Run>,
        (evidence, source): (Evidence, &'static str),
        (allowed, because): (f64, &'static str),
        control: Control,
        of: impl Fn(&[Done]) -> Result<Measured, Missing> + Send + Sync + 'static,
    ) -> Self {
        Self {
            quantity: quantity.into(),
            unit,
            scope: Scope::Named,
            evidence,
            source,
            allowed,
            because,
            runs,
            measure: measure(of),
            control,
        }
    }

    /// A scene that a solver must refuse: the row is amber, with the solver's reason. The control makes a scene of it
    /// that the solver can run, and then the row is red.
    #[must_use]
    pub fn refused(run: Run, quantity: &str, because: &'static str, control: Control) -> Self {
        Self {
            quantity: quantity.to_owned(),
            unit: "1",
            scope: Scope::Named,
            evidence: Evidence::Invariant,
            source: "what the method is",
            allowed: 0.0,
            because,
            runs: vec![Run { standing: Standing::Refused, ..run }],
            measure: measure(|_| Err(Missing("refusal: the solver ran the scene".to_owned()))),
            control,
        }
    }

    /// What is expected of the row: that of its first run.
    #[must_use]
    pub fn standing(&self) -> Standing {
        self.runs.first().map(|run| run.standing).unwrap_or_default()
    }

    /// The smallest set that has all its runs.
    #[must_use]
    pub fn set(&self) -> Set {
        self.runs.iter().map(|run| run.set).max().unwrap_or_default()
    }

    /// Resolutions in words: one, or the first and the last of several.
    #[must_use]
    pub fn resolution(&self) -> String {
        let words: Vec<String> = self.runs.iter().map(|run| run.resolution.to_string()).collect();
        match (words.first(), words.last()) {
            (Some(first), Some(last)) if first != last => format!("{first} … {last}"),
            (Some(first), _) => first.clone(),
            _ => String::new(),
        }
    }
}

/// Wraps a measurement.
pub fn measure(of: impl Fn(&[Done]) -> Result<Measured, Missing> + Send + Sync + 'static) -> Measure {
    Arc::new(of)
}
