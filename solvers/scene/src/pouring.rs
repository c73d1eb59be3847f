//! Poured grains, which are inserted one after the other at a given rate. Their positions in a box are random numbers
//! from a seed, so that every solver inserts the same grains.

use crate::dimension::Dimension;
use crate::overlap::nearest_image;
use crate::packing::random_position;
use crate::scene::Domain;
use nalgebra::Vector3;
use rand::SeedableRng;
use rand_pcg::Pcg64;
use std::collections::VecDeque;

/// Parameters of pouring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pour {
    /// Number of grains.
    pub count: u32,
    /// Insertion rate (1/s).
    pub rate: f64,
    /// Seed of the generator.
    pub seed: u64,
    /// Radius of every grain (m).
    pub radius: f64,
    /// Initial velocity of the grains (m/s).
    pub velocity: Vector3<f64>,
    /// Gravity (m/s²).
    pub gravity: Vector3<f64>,
    /// Corners of the box in which centres are inserted (m).
    pub corners: [Vector3<f64>; 2],
    /// Time of the first insertion (s).
    pub start: f64,
}

/// Reason why grains cannot be poured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PouringError {
    /// No room was found for a grain in 10,000 tries.
    NoRoom,
    /// More than 20,000 grains remain near the box, because they do not fall out of the box or because it spans the
    /// domain.
    Crowd,
}

/// Returns the time (s) and the centre (m) of each insertion. A grain does not overlap earlier grains if these fall
/// freely. Other obstacles are not considered.
///
/// # Errors
/// When there is no room for all grains, or too many grains remain near the box.
pub fn poured(
    pour: &Pour,
    domain: Option<&Domain>,
    dimension: Dimension,
) -> Result<Vec<(f64, Vector3<f64>)>, PouringError> {
    const TRIES: u32 = 10_000;
    const CROWD: usize = 20_000;
    let mut generator = Pcg64::seed_from_u64(pour.seed);
    let [low, high] = pour.corners;
    let mut all = Vec::with_capacity(pour.count as usize);
    // Grains that may still be near the box.
    let mut near: VecDeque<(f64, Vector3<f64>)> = VecDeque::new();
    for number in 0..pour.count {
        let time = pour.start + f64::from(number) / pour.rate;
        let now = |&(since, from): &(f64, Vector3<f64>)| {
            let fallen = time - since;
            from + pour.velocity * fallen + pour.gravity * (0.5 * fallen * fallen)
        };
        let reach = 2.0 * pour.radius;
        let left = |place: Vector3<f64>| {
            let beyond = |axis: usize| place[axis] < low[axis] - reach || place[axis] > high[axis] + reach;
            (0..dimension.count()).any(|axis| beyond(axis) && !domain.is_some_and(|domain| domain.periodic[axis]))
        };
        while near.front().is_some_and(|first| left(now(first))) {
            near.pop_front();
        }
        if near.len() > CROWD {
            return Err(PouringError::Crowd);
        }
        let places: Vec<Vector3<f64>> = near.iter().map(now).collect();
        let is_free = |centre: &Vector3<f64>| {
            places.iter().all(|place| nearest_image(place - centre, domain).norm_squared() >= reach * reach)
        };
        let centre = (0..TRIES).find_map(|_| {
            let centre = random_position(&mut generator, low, high, dimension.count());
            is_free(&centre).then_some(centre)
        });
        let centre = centre.ok_or(PouringError::NoRoom)?;
        near.push_back((time, centre));
        all.push((time, centre));
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pour() -> Pour {
        Pour {
            count: 200,
            rate: 40.0,
            seed: 3,
            radius: 0.5,
            velocity: Vector3::new(0.0, 0.0, -17.0),
            gravity: Vector3::new(0.0, 0.0, -1.0),
            corners: [Vector3::new(0.0, 0.0, 9.0), Vector3::new(4.0, 4.0, 10.0)],
            start: 0.5,
        }
    }

    #[test]
    fn grains_come_at_their_rate_and_touch_none_that_falls() {
        let pour = pour();
        let periodic = [true, true, false];
        let domain = Domain { low: Vector3::zeros(), high: Vector3::new(4.0, 4.0, 20.0), periodic };
        let all = poured(&pour, Some(&domain), Dimension::Three).unwrap_or_default();
        assert_eq!(all.len(), 200);
        assert!((all[0].0 - 0.5).abs() < 1e-15 && (all[199].0 - (0.5 + 199.0 / 40.0)).abs() < 1e-12);
        for (number, &(time, centre)) in all.iter().enumerate() {
            for &(since, from) in &all[..number] {
                let fallen = time - since;
                let mut between = from + pour.velocity * fallen + pour.gravity * (0.5 * fallen * fallen) - centre;
                (0..2).for_each(|axis| between[axis] -= 4.0 * (between[axis] / 4.0).round());
                assert!(between.norm() >= 1.0, "{number}");
            }
        }
        assert_eq!(poured(&pour, Some(&domain), Dimension::Three), Ok(all));
    }

    #[test]
    fn a_rate_that_leaves_no_room_is_told() {
        let with = |pour: Pour| poured(&pour, None, Dimension::Three);
        assert_eq!(with(Pour { rate: 4000.0, ..pour() }), Err(PouringError::NoRoom));
        // The first pour has an infinite insertion time, and the grains of the second pour do not fall.
        assert_eq!(with(Pour { rate: 1e-320, ..pour() }), Err(PouringError::NoRoom));
        let (still, corners) = (Vector3::zeros(), [Vector3::zeros(), Vector3::repeat(1e4)]);
        let resting = Pour { count: 1_000_000, velocity: still, gravity: still, corners, ..pour() };
        assert_eq!(with(resting), Err(PouringError::Crowd));
    }
}
