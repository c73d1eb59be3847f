//! A claim: a quantity of one or more records, what is expected of it and from which source, how far it may be off and
//! why, and which wrong physics it must refuse.
//!
//! It is said in this order, and the compiler asks for each part:
//!
//! ```
//! # use grainbench_harness::claim::claim;
//! # use grainbench_harness::control::Control;
//! # use grainbench_harness::expect::Measured;
//! # use grainbench_harness::run::Run;
//! # use grainbench_harness::source::Source;
//! # use grainbench_harness::tolerance::computed;
//! # use grainbench_scene::solver::Resolution;
//! let fall = claim("speed after 1 s of free fall", "m/s")
//!     .of(Run::new("plain", "dem", Resolution::TimeStep(1e-3)))
//!     .equals(Source::Derived("v = gt"), |done| {
//!         let exact = done[0].scene.gravity.norm();
//!         Ok(Measured::new(-done[0].last("grain.vy")?, exact, exact))
//!     })
//!     .within(computed(1000.0 * f64::EPSILON, "every one of 1000 steps rounds by ε"))
//!     .refuses(Control::scene("gravity a hundredth too large", |scene| scene.gravity *= 1.01));
//! ```

use crate::control::{Control, Red};
use crate::course::{Plate, Trace};
use crate::evidence::Evidence;
use crate::expect::{Bound, Expected, Measured};
use crate::run::{Done, Missing, Run, Set, Standing};
use crate::scope::Scope;
use crate::source::{Cited, Source};
use crate::tolerance::{Tolerance, exactly};
use grainbench_scene::scene::Scene;
use std::sync::Arc;

/// Reads the records of a claim's runs, in their order.
pub type Measure = Arc<dyn Fn(&[Done]) -> Result<Measured, Missing> + Send + Sync>;

/// What kind of thing is expected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Expectation {
    /// A value, which the scene or a work gives.
    Equals,
    /// That a conserved quantity stays what it was, or that a law holds whatever the answer is.
    Holds,
    /// What another run gives.
    Agrees,
    /// A bound or a band.
    Bound(Bound),
    /// An order of convergence, or a bound of one.
    Converges(Bound),
    /// That the solver refuses the scene.
    Refusal,
}

/// A claim.
#[derive(Clone)]
pub struct Claim {
    /// What is measured, in words.
    pub quantity: String,
    /// Unit of value, expectation and scale; `1` for a pure number.
    pub unit: &'static str,
    /// Whom it is fair to.
    pub scope: Scope,
    /// What is read. The first run names the row.
    pub runs: Vec<Run>,
    /// What is expected.
    pub expectation: Expectation,
    /// Where the expectation comes from.
    pub source: Source,
    /// How far it may be off, and why.
    pub tolerance: Tolerance,
    /// How it is measured.
    pub measure: Measure,
    /// What it must refuse.
    pub control: Control,
    /// Both curves, where a whole course is compared.
    pub trace: Option<Trace>,
    /// The graph that it is drawn in, and its label there.
    pub drawn: Option<(&'static Plate, String)>,
    /// How far it may be off where a scene of its kind has other numbers; none where that is not known.
    pub elsewhere: Option<Elsewhere>,
}

/// What is claimed of scenes of a kind whatever their numbers, with a tolerance that follows the scene.
#[derive(Clone)]
pub struct Elsewhere {
    /// What is measured, in words.
    pub quantity: &'static str,
    /// Largest |error| that passes.
    pub allowed: Arc<dyn Fn(&Scene) -> f64 + Send + Sync>,
    /// Why, with the formula.
    pub because: &'static str,
}

/// Begins a claim: a quantity in words, and its unit.
pub fn claim(quantity: impl Into<String>, unit: &'static str) -> Quantity {
    Quantity { quantity: quantity.into(), unit, runs: Vec::new() }
}

/// A claim of which nothing is expected yet.
#[must_use = "a claim ends with what it refuses"]
pub struct Quantity {
    quantity: String,
    unit: &'static str,
    runs: Vec<Run>,
}

/// A claim of which something is expected, but not how nearly.
#[must_use = "a claim ends with what it refuses"]
pub struct Expecting {
    pub(crate) quantity: Quantity,
    pub(crate) expectation: Expectation,
    pub(crate) source: Source,
    pub(crate) measure: Measure,
    pub(crate) trace: Option<Trace>,
}

/// A claim that has no control yet.
#[must_use = "a claim ends with what it refuses"]
pub struct Tolerated {
    expecting: Expecting,
    tolerance: Tolerance,
}

impl Quantity {
    /// Read of this run too.
    pub fn of(mut self, run: Run) -> Self {
        self.runs.push(run);
        self
    }

    /// Read of these runs too.
    pub fn of_all(mut self, runs: impl IntoIterator<Item = Run>) -> Self {
        self.runs.extend(runs);
        self
    }

    pub(crate) fn expects(
        self,
        expectation: Expectation,
        source: Source,
        measure: impl Fn(&[Done]) -> Result<Measured, Missing> + Send + Sync + 'static,
    ) -> Expecting {
        Expecting { quantity: self, expectation, source, measure: Arc::new(measure), trace: None }
    }

    /// Equals, at one moment or over time, what the source says of the scene.
    pub fn equals(
        self,
        source: Source,
        measure: impl Fn(&[Done]) -> Result<Measured, Missing> + Send + Sync + 'static,
    ) -> Expecting {
        self.expects(Expectation::Equals, source, measure)
    }

    /// Equals a number that a work gives, in units of `scale`.
    pub fn equals_cited(
        self,
        cited: Cited,
        scale: f64,
        value: impl Fn(&[Done]) -> Result<f64, Missing> + Send + Sync + 'static,
    ) -> Expecting {
        let measure = move |done: &[Done]| Ok(Measured::new(value(done)?, cited.value, scale));
        self.expects(Expectation::Equals, cited.source(), measure)
    }

    /// Stays what it was: a conserved quantity, a law that holds whatever the answer is.
    pub fn holds(
        self,
        law: &'static str,
        measure: impl Fn(&[Done]) -> Result<Measured, Missing> + Send + Sync + 'static,
    ) -> Expecting {
        self.expects(Expectation::Holds, Source::Derived(law), measure)
    }

    /// Is what another of the runs gives.
    pub fn agrees(
        self,
        source: Source,
        measure: impl Fn(&[Done]) -> Result<Measured, Missing> + Send + Sync + 'static,
    ) -> Expecting {
        self.expects(Expectation::Agrees, source, measure)
    }

    fn bounded(
        self,
        expectation: Expectation,
        bound: Bound,
        source: Source,
        value: impl Fn(&[Done]) -> Result<f64, Missing> + Send + Sync + 'static,
    ) -> Expecting {
        let measure = move |done: &[Done]| Ok(Measured::new(value(done)?, Expected::Bound(bound), scale_of(bound)));
        self.expects(expectation, source, measure)
    }

    /// Is this or more.
    pub fn at_least(
        self,
        bound: f64,
        source: Source,
        value: impl Fn(&[Done]) -> Result<f64, Missing> + Send + Sync + 'static,
    ) -> Expecting {
        let bound = Bound::AtLeast(bound);
        self.bounded(Expectation::Bound(bound), bound, source, value)
    }

    /// Is this or less.
    pub fn at_most(
        self,
        bound: f64,
        source: Source,
        value: impl Fn(&[Done]) -> Result<f64, Missing> + Send + Sync + 'static,
    ) -> Expecting {
        let bound = Bound::AtMost(bound);
        self.bounded(Expectation::Bound(bound), bound, source, value)
    }

    /// Lies between two values.
    pub fn between(
        self,
        band: [f64; 2],
        source: Source,
        value: impl Fn(&[Done]) -> Result<f64, Missing> + Send + Sync + 'static,
    ) -> Expecting {
        let bound = Bound::Between(band);
        self.bounded(Expectation::Bound(bound), bound, source, value)
    }

    /// Converges with this order.
    pub fn converges(
        self,
        order: f64,
        source: Source,
        value: impl Fn(&[Done]) -> Result<f64, Missing> + Send + Sync + 'static,
    ) -> Expecting {
        let bound = Bound::Order(order);
        self.bounded(Expectation::Converges(bound), bound, source, value)
    }

    /// Converges with this order or a higher one.
    pub fn converges_at_least(
        self,
        order: f64,
        source: Source,
        value: impl Fn(&[Done]) -> Result<f64, Missing> + Send + Sync + 'static,
    ) -> Expecting {
        let bound = Bound::AtLeast(order);
        self.bounded(Expectation::Converges(bound), bound, source, value)
    }

    /// Converges with this order at most, or not at all.
    pub fn converges_at_most(
        self,
        order: f64,
        source: Source,
        value: impl Fn(&[Done]) -> Result<f64, Missing> + Send + Sync + 'static,
    ) -> Expecting {
        let bound = Bound::AtMost(order);
        self.bounded(Expectation::Converges(bound), bound, source, value)
    }

    /// A scene that the solver must refuse: the row is amber, with the solver's reason. The control makes a scene of it
    /// that the solver can run, and then the row is red.
    #[must_use]
    pub fn refused(self, because: &'static str, control: Control) -> Claim {
        let refused = |run| Run { standing: Standing::Refused, ..run };
        let quantity = Self { runs: self.runs.into_iter().map(refused).collect(), ..self };
        quantity
            .expects(Expectation::Refusal, Source::Derived("what the method is"), |_| Ok(Measured::new(1.0, 0.0, 1.0)))
            .within(exactly(because))
            .refuses(control)
    }
}

/// What errors of a bound are divided by: the bound itself, the width of a band, 1 for an order and for zero.
fn scale_of(bound: Bound) -> f64 {
    match bound {
        Bound::AtLeast(at) | Bound::AtMost(at) if at != 0.0 => at.abs(),
        Bound::Between([low, high]) if high > low => high - low,
        _ => 1.0,
    }
}

impl Expecting {
    pub(crate) fn traced(self, trace: Trace) -> Self {
        Self { trace: Some(trace), ..self }
    }

    /// How far it may be off.
    pub fn within(self, tolerance: Tolerance) -> Tolerated {
        Tolerated { expecting: self, tolerance }
    }
}

impl Tolerated {
    /// What it must refuse, by its value.
    #[must_use]
    pub fn refuses(self, control: Control) -> Claim {
        let Self { expecting: Expecting { quantity, expectation, source, measure, trace }, tolerance } = self;
        let Quantity { quantity, unit, runs } = quantity;
        let (scope, drawn, elsewhere) = (Scope::Named, None, None);
        Claim { quantity, unit, scope, runs, expectation, source, tolerance, measure, control, trace, drawn, elsewhere }
    }

    /// Wrong physics that ends the run, or leaves nothing to read.
    #[must_use]
    pub fn breaks(self, control: Control) -> Claim {
        self.refuses(Control { red: Red::Breaking, ..control })
    }
}

impl Claim {
    /// The claim as one that is fair to any solver that can express the scene.
    #[must_use]
    pub fn fair_to_any(self) -> Self {
        Self { scope: Scope::AnySolver, ..self }
    }

    /// The claim as one that is fair to any solver whose bodies deform.
    #[must_use]
    pub fn fair_to_any_continuum(self) -> Self {
        Self { scope: Scope::AnyContinuum, ..self }
    }

    /// The claim as one that is fair to any solver with the springs of the scene.
    #[must_use]
    pub fn fair_to_any_springs(self) -> Self {
        Self { scope: Scope::AnySprings, ..self }
    }

    /// The claim as one that holds of scenes of its kind with other numbers too, within a tolerance that follows them.
    #[must_use]
    pub fn at_other_numbers(
        self,
        quantity: &'static str,
        because: &'static str,
        allowed: impl Fn(&Scene) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self { elsewhere: Some(Elsewhere { quantity, allowed: Arc::new(allowed), because }), ..self }
    }

    /// Draws what is compared, of a claim of a whole course.
    #[must_use]
    pub fn drawn(self, plate: &'static Plate, label: impl Into<String>) -> Self {
        Self { drawn: Some((plate, label.into())), ..self }
    }

    /// What kind of evidence it is: by its source and by what is expected.
    #[must_use]
    pub fn evidence(&self) -> Evidence {
        use crate::source::Kind;
        match (self.source, self.expectation) {
            (Source::Program, _) => Evidence::OtherCode,
            (Source::Regression(_), _) => Evidence::Regression,
            // That a prototype has the order of a method tells it no better than the method does.
            (Source::Printed(..), Expectation::Converges(_)) => Evidence::Convergence,
            (Source::Printed(work, _), _) => match work.kind {
                Kind::Literature => Evidence::Paper,
                Kind::Experiment => Evidence::Experiment,
                Kind::Prototype => Evidence::Prototype,
            },
            (Source::Ourselves(_), _) | (Source::Derived(_), Expectation::Converges(_)) => Evidence::Convergence,
            (Source::Derived(_), Expectation::Holds | Expectation::Refusal) => Evidence::Invariant,
            (Source::Derived(_), Expectation::Equals | Expectation::Agrees | Expectation::Bound(_)) => {
                Evidence::Analytic
            }
        }
    }

    /// What is expected of the row: that of its first run.
    #[must_use]
    pub fn standing(&self) -> Standing {
        self.runs.first().map(|run| run.standing).unwrap_or_default()
    }

    /// The smallest set in which it can be judged.
    #[must_use]
    pub fn set(&self) -> Set {
        self.runs.iter().map(Run::judged_in).max().unwrap_or_default()
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
