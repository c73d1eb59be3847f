//! Results of the conformance suite, in the same form as results of claims.

use super::Property;
use super::end::NoEnd;
use super::scenes::{NamedScene, flat};
use crate::expect::Measurement;
use crate::tolerance::ToleranceOrigin;
use crate::verdict::{Outcome, Verdict};
use grainbench_scene::error::SceneError;
use grainbench_solver::Solver;
use grainbench_solver::resolution::Resolution;
use grainbench_solver::terms::Terms;
use std::borrow::Borrow;

/// Inputs that all results of a property share.
pub(super) struct Rows<'a> {
    pub(super) solver: &'a dyn Solver,
    /// Solver under test without a cache, for runs that must be repeated or observed.
    pub(super) again: &'a dyn Solver,
    pub(super) terms: &'a Terms,
    pub(super) property: &'a Property,
}

/// Measured value of a property on one scene, and its tolerance.
pub(super) struct PropertyValue {
    pub(super) measured: Measurement,
    pub(super) allowed: f64,
    pub(super) made: ToleranceOrigin,
}

impl PropertyValue {
    /// Returns a deviation from zero. `value`, `scale` and `allowed` have the same unit.
    pub(super) fn deviation(value: f64, scale: f64, allowed: f64) -> Self {
        let measured = Measurement::new(value, 0.0, scale);
        Self { measured, allowed: allowed / scale, made: ToleranceOrigin::Computed }
    }
}

impl Rows<'_> {
    /// Returns one result for each scene. Three-dimensional scenes are left out if `terms.in_space` is false. `find`
    /// measures the quantity.
    pub(super) fn each<T: Borrow<NamedScene>>(
        &self,
        scenes: Result<Vec<T>, SceneError>,
        resolution: &Resolution,
        quantity: (&str, &str),
        find: impl Fn(&T) -> Result<PropertyValue, NoEnd>,
    ) -> Vec<Verdict> {
        let scenes = match scenes {
            Ok(scenes) => scenes,
            Err(error) => return vec![self.row("scenes", resolution, quantity, Err(NoEnd::Record(error.to_string())))],
        };
        let asked = scenes.iter().filter(|entry| self.terms.in_space || flat(&(*entry).borrow().scene));
        asked.map(|entry| self.row(entry.borrow().name, resolution, quantity, find(entry))).collect()
    }

    fn row(
        &self,
        scene: &str,
        resolution: &Resolution,
        (quantity, unit): (&str, &str),
        found: Result<PropertyValue, NoEnd>,
    ) -> Verdict {
        let row = Verdict {
            variant: format!("{}/{scene}", self.property.name),
            solver: self.solver.name(),
            resolution: resolution.to_string(),
            because: self.property.because.to_owned(),
            evidence: self.property.evidence,
            source: self.property.source.to_owned(),
            ..Verdict::open("conformance", quantity, unit)
        };
        match found {
            Err(NoEnd::Run(error)) => row.ended(&error),
            Err(NoEnd::Record(lack)) => row.left(Outcome::Fail, lack),
            Ok(PropertyValue { measured, allowed, made }) => {
                let row = Verdict { allowed, tolerance: made, ..row }.judged(&measured);
                match self.terms.less_of(self.property.name, quantity) {
                    Some(less) if row.outcome == Outcome::Fail && measured.error().abs() <= less.at_most => {
                        row.left(Outcome::Known, less.because)
                    }
                    _ => row,
                }
            }
        }
    }
}
