//! Rows of the suite: the same kind as those of gates.

use super::end::NoEnd;
use super::scenes::Named;
use crate::verdict::{Evidence, Outcome, Verdict};
use grainbench_scene::error::SceneError;
use grainbench_scene::solver::{Resolution, Solver};

/// What the rows of one property share.
pub(super) struct Rows<'a> {
    pub(super) solver: &'a dyn Solver,
    pub(super) property: &'static str,
    pub(super) evidence: Evidence,
    pub(super) source: &'static str,
    pub(super) because: &'static str,
}

/// What a property measured on one scene.
pub(super) struct Found {
    pub(super) value: f64,
    pub(super) expected: f64,
    pub(super) scale: f64,
    pub(super) allowed: f64,
}

impl Found {
    /// A deviation that should be zero; `allowed` in the same unit.
    pub(super) fn deviation(value: f64, scale: f64, allowed: f64) -> Self {
        Self { value, expected: 0.0, scale, allowed: allowed / scale }
    }
}

impl Rows<'_> {
    /// A row for every scene: a quantity with its unit, and how it is found.
    pub(super) fn each(
        &self,
        scenes: Result<Vec<Named>, SceneError>,
        resolution: &Resolution,
        (quantity, unit): (&str, &str),
        find: impl Fn(&Named) -> Result<Found, NoEnd>,
    ) -> Vec<Verdict> {
        match scenes {
            Ok(scenes) => {
                scenes.iter().map(|named| self.row(named.name, resolution, (quantity, unit), find(named))).collect()
            }
            Err(error) => {
                vec![self.row("scenes", resolution, (quantity, unit), Err(NoEnd::Record(error.to_string())))]
            }
        }
    }

    /// The row of one scene.
    fn row(
        &self,
        scene: &str,
        resolution: &Resolution,
        (quantity, unit): (&str, &str),
        found: Result<Found, NoEnd>,
    ) -> Verdict {
        let mut row = Verdict {
            case: "conformance".to_owned(),
            variant: format!("{}/{scene}", self.property),
            solver: self.solver.name(),
            resolution: resolution.to_string(),
            quantity: quantity.to_owned(),
            unit: unit.to_owned(),
            value: None,
            expected: None,
            scale: None,
            error: None,
            allowed: 0.0,
            because: self.because.to_owned(),
            evidence: self.evidence,
            source: self.source.to_owned(),
            outcome: Outcome::Fail,
            detail: None,
        };
        match found {
            Err(NoEnd::Run(error)) => {
                row.outcome = Outcome::from(&error);
                row.detail = Some(error.to_string());
            }
            Err(NoEnd::Record(lack)) => row.detail = Some(lack),
            Ok(found) => {
                let error = (found.value - found.expected) / found.scale;
                let finite = |value: f64| value.is_finite().then_some(value);
                row.value = finite(found.value);
                row.expected = finite(found.expected);
                row.scale = finite(found.scale);
                row.error = finite(error);
                row.allowed = found.allowed;
                if error.abs() <= found.allowed {
                    row.outcome = Outcome::Pass;
                }
            }
        }
        row
    }
}
