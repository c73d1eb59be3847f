//! Insertion and removal of grains.

use super::{Groups, Resolver};
use crate::error::SceneError;
use crate::file::{GrainsSpec, PouredSpec};
use crate::pouring::{Pour, PouringError, poured};
use crate::scene::{Block, Domain, Driven, Grain};
use crate::stays::{Entry, Removal, Stays};
use nalgebra::Vector3;

impl Resolver<'_> {
    /// Returns the insertion times (s) and centres (m) of the poured grains of a group.
    pub(super) fn pour(
        &self,
        name: &str,
        group: &GrainsSpec,
        spec: &PouredSpec,
        radius: f64,
        velocity: Vector3<f64>,
        domain: Option<&Domain>,
    ) -> Result<Vec<(f64, Vector3<f64>)>, SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("grains.{name}.poured.{part}");
        let low = check.vector(&key("low"), &spec.low)?;
        let high = check.vector(&key("high"), &spec.high)?;
        for axis in 0..check.dimension.count() {
            let found = along(low[axis], high[axis], axis);
            check.require(low[axis] <= high[axis], &key("high"), "a corner not below `low`", found)?;
        }
        check.require(spec.count > 0, &key("count"), "at least one grain", "0")?;
        let expected = "no spin, because the grains are poured";
        check.require(group.spin.is_none(), &format!("grains.{name}.spin"), expected, "one")?;
        let pour = Pour {
            count: spec.count,
            rate: check.positive(&key("rate"), spec.rate, "rate (1/s)")?,
            seed: spec.seed,
            radius,
            velocity,
            gravity: self.gravity()?,
            corners: [low, high],
            start: check.not_negative(&key("start"), spec.start, "time (s)")?,
        };
        poured(&pour, domain, check.dimension).map_err(|reason| {
            let expected = match reason {
                PouringError::NoRoom => "room in the box for each grain at its time",
                PouringError::Crowd => "a box that grains leave in time, by velocity, gravity or a lower rate",
            };
            // Tries a half, a quarter, … of the rate, until there is room for all grains.
            let slower = (1..=10).map(|halvings| pour.rate / f64::from(1 << halvings));
            let fits = |rate: &f64| poured(&Pour { rate: *rate, ..pour }, domain, check.dimension).is_ok();
            let help = slower.into_iter().find(fits).map(|rate| format!("at {rate} 1/s there is room"));
            let help = help.filter(|_| reason == PouringError::NoRoom);
            check.source.error(&key("rate"), expected, &format!("{} 1/s", spec.rate), help)
        })
    }

    pub(super) fn removal(&self) -> Result<Option<Removal>, SceneError> {
        let Some(spec) = &self.file.removal else { return Ok(None) };
        let check = &self.check;
        let [low, high] = self.corners("removal", &spec.low, &spec.high)?;
        check.require(spec.every_cycles > 0, "removal.every_cycles", "at least one cycle", "0")?;
        Ok(Some(Removal { low, high, every: spec.every_cycles }))
    }

    /// Rejects an inserted grain with an initial position at which grains are removed.
    pub(super) fn refuse_lost_pours(&self, stays: &Stays, grains: &[Grain], groups: &Groups) -> Result<(), SceneError> {
        let Some(removal) = stays.removal else { return Ok(()) };
        let dimension = self.check.dimension.count();
        let is_lost = |entry: &&Entry| removal.takes(grains[entry.grain].position, dimension);
        let Some(lost) = stays.entries.iter().find(is_lost) else { return Ok(()) };
        let group = groups.iter().find(|(_, range)| range.contains(&lost.grain)).map_or("", |(name, _)| name);
        let found = format_args!("a grain inserted at {:?}", &grains[lost.grain].position.as_slice()[..dimension]);
        let expected = "a box within the box of `removal`, because grains outside it are removed";
        Err(self.check.error(&format!("grains.{group}.poured"), expected, found))
    }

    /// Returns the corners of the box with the keys `low` and `high` below `key`. Each edge must have a positive
    /// length.
    pub(super) fn corners(&self, key: &str, low: &[f64], high: &[f64]) -> Result<[Vector3<f64>; 2], SceneError> {
        let check = &self.check;
        let (of_low, of_high) = (format!("{key}.low"), format!("{key}.high"));
        let (low, high) = (check.vector(&of_low, low)?, check.vector(&of_high, high)?);
        for axis in 0..check.dimension.count() {
            let found = along(low[axis], high[axis], axis);
            check.require(low[axis] < high[axis], &of_high, "a corner above `low`", found)?;
        }
        Ok([low, high])
    }

    /// Rejects insertion or removal of grains in scenes with `driven` grains or with deformable bodies.
    pub(super) fn refuse_passing(&self, stays: &Stays, driven: &[Driven], bodies: &[Block]) -> Result<(), SceneError> {
        let (check, is_always) = (&self.check, stays.is_always());
        let expected = "no driven grains in a scene that inserts or removes grains";
        check.require(is_always || driven.is_empty(), "driven", expected, "some")?;
        let key = if stays.entries.is_empty() { "removal" } else { "grains" };
        let expected = "no insertion or removal of grains in a scene with deformable bodies";
        check.require(is_always || bodies.is_empty(), key, expected, "some")
    }
}

/// Returns a range along an axis (m) as text for errors.
pub(super) fn along(low: f64, high: f64, axis: usize) -> String {
    format!("{low} to {high} along {}", ["x", "y", "z"][axis])
}
