//! Radii and region of randomly placed grains.

use super::Resolver;
use super::stays::along;
use crate::dimension::GrainShape;
use crate::error::SceneError;
use crate::file::{RandomSpec, RegionSpec};
use crate::radii::Radii;
use crate::scene::Domain;

/// Smallest fraction of a log-normal distribution that must lie within its range. Radii outside the range are drawn
/// again, and a smaller fraction would need many draws.
const LEAST: f64 = 0.01;

impl Resolver<'_> {
    /// Returns the distribution of radii. By default, all grains have the `radius` of the group.
    pub(super) fn radii(
        &self,
        key: &str,
        spec: &RandomSpec,
        shape: GrainShape,
        radius: &dyn Fn() -> Result<f64, SceneError>,
    ) -> Result<Radii, SceneError> {
        let check = &self.check;
        let Some(radii) = &spec.radii else {
            let Some(range) = spec.radius_range else { return Ok(Radii::Uniform([radius()?; 2])) };
            return Ok(Radii::Uniform(self.range(&format!("{key}.radius_range"), range)?));
        };
        check.require(spec.radius_range.is_none(), key, "one of `radius_range` and `radii`", "both")?;
        let key = format!("{key}.radii");
        check.exactly_one(&key, &[("log_normal", radii.log_normal.is_some()), ("by_mass", radii.by_mass.is_some())])?;
        if let Some(spec) = &radii.log_normal {
            let key = |part: &str| format!("{key}.log_normal.{part}");
            let range = self.range(&key("range"), spec.range)?;
            let median = check.positive(&key("median"), spec.median, "radius (m)")?;
            let deviation = check.not_negative(&key("deviation"), spec.deviation, "ratio")?;
            let is_within = (range[0]..=range[1]).contains(&median);
            check.require(is_within, &key("median"), "a radius within `range`", median)?;
            let share =
                |radius: f64| 0.5 * libm::erf(libm::log(radius / median) / (deviation * std::f64::consts::SQRT_2));
            let is_wide = deviation <= 0.0 || share(range[1]) - share(range[0]) >= LEAST;
            let expected = format!("a range that contains at least {LEAST} of the distribution");
            check.require(is_wide, &key("range"), &expected, format_args!("{} to {} m", range[0], range[1]))?;
            return Ok(Radii::LogNormal { median, deviation, range });
        }
        let curve = radii.by_mass.as_deref().unwrap_or_default();
        let key = format!("{key}.by_mass");
        let rises = curve.windows(2).all(|pair| pair[0].0 <= pair[1].0 && pair[0].1 <= pair[1].1);
        let is_whole =
            curve.first().is_some_and(|first| first.1 == 0.0) && curve.last().is_some_and(|last| last.1 == 1.0);
        let is_valid = rises && is_whole && curve.iter().all(|(radius, _)| radius.is_finite() && *radius > 0.0);
        let expected = "pairs [radius (m), mass fraction of the grains up to this radius] in increasing order, with \
                        fractions from 0 to 1";
        let pairs: Vec<[f64; 2]> = curve.iter().map(|&(radius, fraction)| [radius, fraction]).collect();
        check.require(is_valid, &key, expected, format_args!("{pairs:?}"))?;
        Ok(Radii::by_mass(curve, if shape == GrainShape::Disc { 2 } else { 3 }))
    }

    /// Returns the smallest and largest radius (m), after checking that they are positive, finite and in this order.
    fn range(&self, key: &str, [small, large]: [f64; 2]) -> Result<[f64; 2], SceneError> {
        self.check.positive(key, small, "radius (m)")?;
        let found = format_args!("{small} to {large}");
        self.check.require(large.is_finite() && large >= small, key, "an increasing range", found)?;
        Ok([small, large])
    }

    /// Returns the part of the domain within a box. This part is periodic along the periodic axes that the box spans
    /// completely.
    pub(super) fn region_of(&self, key: &str, spec: &RegionSpec, domain: &Domain) -> Result<Domain, SceneError> {
        let [low, high] = self.corners(key, &spec.low, &spec.high)?;
        let mut part = *domain;
        for axis in 0..self.check.dimension.count() {
            let is_within = low[axis] >= domain.low[axis] && high[axis] <= domain.high[axis];
            let expected = format!("a box within the domain, {} to {}", domain.low[axis], domain.high[axis]);
            self.check.require(is_within, key, &expected, along(low[axis], high[axis], axis))?;
            let is_whole = low[axis] == domain.low[axis] && high[axis] == domain.high[axis];
            (part.low[axis], part.high[axis]) = (low[axis], high[axis]);
            part.periodic[axis] = domain.periodic[axis] && is_whole;
        }
        Ok(part)
    }
}
