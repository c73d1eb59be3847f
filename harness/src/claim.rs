//! Claims: a quantity of one or more records, its expected value and source, its tolerance and reason, and a negative control.
//!
//! A claim is built in this order, and the compiler requires each part:
//!
//! ```
//! # use grainbench_harness::claim::claim;
//! # use grainbench_harness::control::Control;
//! # use grainbench_harness::expect::Measurement;
//! # use grainbench_harness::run::Run;
//! # use grainbench_harness::source::Source;
//! # use grainbench_harness::tolerance::computed;
//! # use grainbench_solver::resolution::Resolution;
//! let fall = claim("speed after 1 s of free fall", "m/s")
//!     .run(Run::new("plain", "dem", Resolution::TimeStep(1e-3)))
//!     .equals(Source::Derived("v = gt"), |done| {
//!         Ok(Measurement::relative(-done[0].last("grain.vy")?, done[0].scene.gravity.norm()))
//!     })
//!     .within(computed(1000.0 * f64::EPSILON, "every one of 1000 steps rounds by ε"))
//!     .refuses(Control::scene("gravity a hundredth too large", |scene| scene.gravity *= 1.01));
//! ```

use crate::control::{Control, FailureMode};
use crate::evidence::Evidence;
use crate::expect::{Bound, ExpectedValue, Measurement};
use crate::run::{ExpectedOutcome, FinishedRun, MissingData, Run, Set};
use crate::scope::Scope;
use crate::source::{CitedNumber, Source};
use crate::tolerance::{Tolerance, exactly};
use grainbench_scene::scene::Scene;
use std::sync::Arc;

/// Reads the measured value from the records of a claim's runs, in the order of the runs.
pub type Measure = Arc<dyn Fn(&[FinishedRun]) -> Result<Measurement, MissingData> + Send + Sync>;

/// Function that reads a value from the finished runs of a claim, in the order of the runs.
pub trait RunsReader<T>: Fn(&[FinishedRun]) -> Result<T, MissingData> + Send + Sync + 'static {}

impl<T, F: Fn(&[FinishedRun]) -> Result<T, MissingData> + Send + Sync + 'static> RunsReader<T> for F {}

/// Kind of the expected result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expectation {
    /// A value from the scene or from a cited work.
    Equals,
    /// Conservation of a quantity, or a law that holds for every solution.
    Holds,
    /// Agreement of two runs.
    Agrees,
    /// A bound or a band.
    Bound,
    /// An order of convergence, or a bound on it.
    Converges,
    /// A scene that the solver must reject as unsupported.
    Refusal,
}

/// Claim of a case: runs, measured quantity, expectation, tolerance and negative control.
#[derive(Clone)]
#[must_use]
pub struct Claim {
    /// Measured quantity, in words.
    pub quantity: String,
    /// Unit of the measured value, the expected value and the scale; `1` for a pure number.
    pub unit: &'static str,
    /// Solvers to which the claim applies.
    pub scope: Scope,
    /// Runs that the claim reads. The first run gives the result its variant, solver and expected outcome.
    pub runs: Vec<Run>,
    /// Kind of expectation, such as a value, a bound or an order of convergence.
    pub expectation: Expectation,
    /// Source of the expectation.
    pub source: Source,
    /// Tolerance and its reason.
    pub tolerance: Tolerance,
    /// Reads the measured value from the runs.
    pub measure: Measure,
    /// Negative control: wrong physics under which the claim must fail.
    pub control: Control,
    /// Measured and expected curves, if the claim compares curves.
    pub trace: Option<Trace>,
    /// Figure in which the claim is plotted, and the label of its curve.
    pub drawn: Option<(&'static ClaimFigure, String)>,
    /// Claim for other parameter values of the case's scene; none if its tolerance is unknown there.
    pub elsewhere: Option<ParameterVariation>,
}

/// Points (x, y).
pub type Points = Vec<(f64, f64)>;

/// The curves of a claim: measured points, and expected points if the expectation is a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct ClaimCurves {
    /// Points (x, y) from the runs.
    pub measured: Points,
    /// Points (x, y) of the expected curve, or of a guide line with the expected slope.
    pub expected: Points,
    /// Power of the guide line; none if there is no guide line.
    pub slope: Option<f64>,
}

/// Reads the measured and the expected curve from the runs of a claim.
pub type Trace = Arc<dyn Fn(&[FinishedRun]) -> Result<ClaimCurves, MissingData> + Send + Sync>;

/// Figure in which a claim is plotted. Claims with the same figure share one graph.
#[derive(Debug)]
pub struct ClaimFigure {
    /// Name of the figure.
    pub name: &'static str,
    /// Title above the graph.
    pub title: &'static str,
    /// Caption, which describes the expected result.
    pub caption: &'static str,
    /// Labels of both axes.
    pub axes: [&'static str; 2],
    /// True for logarithmic axes.
    pub logarithmic: bool,
}

/// Form of a claim for the case's scene with other parameter values. The tolerance is computed from the changed scene.
#[derive(Clone)]
pub struct ParameterVariation {
    /// Measured quantity, in words.
    pub quantity: &'static str,
    /// Function that returns the largest |error| that passes for a scene; not finite if it is unknown for the scene.
    pub allowed: Arc<dyn Fn(&Scene) -> f64 + Send + Sync>,
    /// Reason for the tolerance, with its formula.
    pub because: &'static str,
}

/// Begins a claim about a quantity, described in words, with its unit.
pub fn claim(quantity: impl Into<String>, unit: &'static str) -> Quantity {
    Quantity { quantity: quantity.into(), unit, runs: Vec::new() }
}

/// Quantity and runs of a claim that has no expectation yet.
#[must_use = "a claim needs a negative control"]
pub struct Quantity {
    quantity: String,
    unit: &'static str,
    runs: Vec<Run>,
}

/// A claim that has an expectation, but no tolerance yet.
#[must_use = "a claim needs a negative control"]
pub struct ClaimWithExpectation {
    pub(crate) quantity: Quantity,
    pub(crate) expectation: Expectation,
    pub(crate) source: Source,
    pub(crate) measure: Measure,
    pub(crate) trace: Option<Trace>,
}

/// A claim that has an expectation and a tolerance, but no negative control yet.
#[must_use = "a claim needs a negative control"]
pub struct ClaimWithTolerance {
    expecting: ClaimWithExpectation,
    tolerance: Tolerance,
}

impl Quantity {
    /// Adds a run that the claim reads.
    pub fn run(mut self, run: Run) -> Self {
        self.runs.push(run);
        self
    }

    /// Adds several runs that the claim reads.
    pub fn runs(mut self, runs: impl IntoIterator<Item = Run>) -> Self {
        self.runs.extend(runs);
        self
    }

    pub(crate) fn expects(
        self,
        expectation: Expectation,
        source: Source,
        measure: impl RunsReader<Measurement>,
    ) -> ClaimWithExpectation {
        ClaimWithExpectation { quantity: self, expectation, source, measure: Arc::new(measure), trace: None }
    }

    /// Expects the value that the source gives for the scene. The value may be a single number or the worst sample of a
    /// time series.
    pub fn equals(self, source: Source, measure: impl RunsReader<Measurement>) -> ClaimWithExpectation {
        self.expects(Expectation::Equals, source, measure)
    }

    /// Expects a number from a cited work. The error is the difference divided by `scale`.
    pub fn equals_cited(self, cited: CitedNumber, scale: f64, value: impl RunsReader<f64>) -> ClaimWithExpectation {
        let measure = move |done: &[FinishedRun]| Ok(Measurement::new(value(done)?, cited.value, scale));
        self.expects(Expectation::Equals, cited.source(), measure)
    }

    /// Expects a law that holds for every solution, such as the conservation of a quantity.
    pub fn holds(self, law: &'static str, measure: impl RunsReader<Measurement>) -> ClaimWithExpectation {
        self.expects(Expectation::Holds, Source::Derived(law), measure)
    }

    /// Expects the value of another run of the claim.
    pub fn agrees(self, source: Source, measure: impl RunsReader<Measurement>) -> ClaimWithExpectation {
        self.expects(Expectation::Agrees, source, measure)
    }

    fn bounded(
        self,
        expectation: Expectation,
        bound: Bound,
        source: Source,
        value: impl RunsReader<f64>,
    ) -> ClaimWithExpectation {
        let measure = move |done: &[FinishedRun]| {
            Ok(Measurement::new(value(done)?, ExpectedValue::Bound(bound), scale_of(bound)))
        };
        self.expects(expectation, source, measure)
    }

    /// Expects a value of at least `bound`.
    pub fn at_least(self, bound: f64, source: Source, value: impl RunsReader<f64>) -> ClaimWithExpectation {
        self.bounded(Expectation::Bound, Bound::AtLeast(bound), source, value)
    }

    /// Expects a value of at most `bound`.
    pub fn at_most(self, bound: f64, source: Source, value: impl RunsReader<f64>) -> ClaimWithExpectation {
        self.bounded(Expectation::Bound, Bound::AtMost(bound), source, value)
    }

    /// Expects a value within a band.
    pub fn between(self, band: [f64; 2], source: Source, value: impl RunsReader<f64>) -> ClaimWithExpectation {
        self.bounded(Expectation::Bound, Bound::Between(band), source, value)
    }

    /// Expects this order of convergence.
    pub fn converges(self, order: f64, source: Source, value: impl RunsReader<f64>) -> ClaimWithExpectation {
        self.bounded(Expectation::Converges, Bound::Order(order), source, value)
    }

    /// Expects at least this order of convergence.
    pub fn converges_at_least(self, order: f64, source: Source, value: impl RunsReader<f64>) -> ClaimWithExpectation {
        self.bounded(Expectation::Converges, Bound::AtLeast(order), source, value)
    }

    /// Expects at most this order of convergence. An error that does not decrease also passes.
    pub fn converges_at_most(self, order: f64, source: Source, value: impl RunsReader<f64>) -> ClaimWithExpectation {
        self.bounded(Expectation::Converges, Bound::AtMost(order), source, value)
    }

    /// Expects that the solver rejects the scene as unsupported. The result is then amber and states the solver's reason.
    ///
    /// The negative control replaces the scene by one that the solver can run. The result must then be red.
    pub fn refused(self, because: &'static str, control: Control) -> Claim {
        let refused = |run| Run { standing: ExpectedOutcome::Refused, ..run };
        let quantity = Self { runs: self.runs.into_iter().map(refused).collect(), ..self };
        quantity
            .expects(Expectation::Refusal, Source::Derived("definition of the method"), |_| {
                Ok(Measurement::new(1.0, 0.0, 1.0))
            })
            .within(exactly(because))
            .refuses(control)
    }
}

/// Returns the scale of the error of a bound. The scale is the magnitude of a non-zero bound, the width of a band, and
/// 1 otherwise.
fn scale_of(bound: Bound) -> f64 {
    match bound {
        Bound::AtLeast(at) | Bound::AtMost(at) if at != 0.0 => at.abs(),
        Bound::Between([low, high]) if high > low => high - low,
        _ => 1.0,
    }
}

impl ClaimWithExpectation {
    pub(crate) fn traced(self, trace: Trace) -> Self {
        Self { trace: Some(trace), ..self }
    }

    /// Sets the tolerance.
    pub fn within(self, tolerance: Tolerance) -> ClaimWithTolerance {
        ClaimWithTolerance { expecting: self, tolerance }
    }
}

impl ClaimWithTolerance {
    /// Sets the negative control. The claim must fail by value under its wrong physics.
    pub fn refuses(self, control: Control) -> Claim {
        let Self { expecting: ClaimWithExpectation { quantity, expectation, source, measure, trace }, tolerance } =
            self;
        let Quantity { quantity, unit, runs } = quantity;
        let (scope, drawn, elsewhere) = (Scope::Named, None, None);
        Claim { quantity, unit, scope, runs, expectation, source, tolerance, measure, control, trace, drawn, elsewhere }
    }

    /// Sets a negative control under which the claim must fail by error: the run ends with an error or the quantity
    /// cannot be measured.
    pub fn breaks(self, control: Control) -> Claim {
        self.refuses(Control { red: FailureMode::Breaking, ..control })
    }
}

impl Claim {
    /// Extends the claim to every solver that can run the scene.
    pub fn solver_independent(self) -> Self {
        Self { scope: Scope::AnySolver, ..self }
    }

    /// Extends the claim to every solver with deformable bodies.
    pub fn solver_independent_continuum(self) -> Self {
        Self { scope: Scope::AnyContinuum, ..self }
    }

    /// Extends the claim to every solver whose contacts have the springs and dashpots of the scene.
    pub fn solver_independent_springs(self) -> Self {
        Self { scope: Scope::AnySprings, ..self }
    }

    /// Extends the claim to the case's scene with other parameter values. `allowed` computes the tolerance from the changed
    /// scene.
    pub fn at_other_numbers(
        self,
        quantity: &'static str,
        because: &'static str,
        allowed: impl Fn(&Scene) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self { elsewhere: Some(ParameterVariation { quantity, allowed: Arc::new(allowed), because }), ..self }
    }

    /// Plots the measured and the expected curve of the claim in a figure.
    pub fn drawn(self, plate: &'static ClaimFigure, label: impl Into<String>) -> Self {
        Self { drawn: Some((plate, label.into())), ..self }
    }

    /// Returns the kind of evidence, which follows from the source and the expectation.
    #[must_use]
    pub fn evidence(&self) -> Evidence {
        use crate::source::Kind;
        match (self.source, self.expectation) {
            (Source::Program, _) => Evidence::OtherCode,
            (Source::Regression(_), _) => Evidence::Regression,
            // The method determines the order. Agreement of a prototype with this order is no stronger evidence.
            (Source::Printed(..), Expectation::Converges) => Evidence::Convergence,
            (Source::Printed(work, _), _) => match work.kind {
                Kind::Literature => Evidence::Paper,
                Kind::Experiment => Evidence::Experiment,
                Kind::Prototype => Evidence::Prototype,
            },
            (Source::Ourselves(_), _) | (Source::Derived(_), Expectation::Converges) => Evidence::Convergence,
            (Source::Derived(_), Expectation::Holds | Expectation::Refusal) => Evidence::Invariant,
            (Source::Derived(_), Expectation::Equals | Expectation::Agrees | Expectation::Bound) => Evidence::Analytic,
        }
    }

    /// Returns the expected outcome of the first run, which is the expected outcome of the claim.
    #[must_use]
    pub fn standing(&self) -> ExpectedOutcome {
        self.runs.first().map(|run| run.standing).unwrap_or_default()
    }

    /// Returns the smallest tier in which all runs of the claim are available.
    #[must_use]
    pub fn set(&self) -> Set {
        self.runs.iter().map(Run::judged_in).max().unwrap_or_default()
    }

    /// Returns the resolution in words: the only level, or the first and the last level.
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
