//! Grains that come or go, and walls that are taken away: what a scene has only for a while.

use nalgebra::Vector3;

/// Which grains are there from when on, and where they are taken out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stays {
    /// Grains that are not there from the start, in order of time.
    pub entries: Vec<Entry>,
    /// Where grains are taken out, if they are.
    pub removal: Option<Removal>,
}

/// A grain that enters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// The grain, by place in [`crate::scene::Scene::grains`]: where, how fast and with which spin it is there at first.
    pub grain: usize,
    /// When (s): it is there from the first step on that does not end before.
    pub time: f64,
}

/// Where grains are taken out: beyond the sides of a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Removal {
    /// Lower corner (m).
    pub low: Vector3<f64>,
    /// Upper corner (m).
    pub high: Vector3<f64>,
    /// They are looked for every so many steps.
    pub every: u64,
}

impl Removal {
    /// Whether a grain with its centre at a place (m) is taken out, in a space of so many dimensions.
    #[must_use]
    pub fn takes(&self, place: Vector3<f64>, dimension: usize) -> bool {
        (0..dimension).any(|axis| !(self.low[axis]..=self.high[axis]).contains(&place[axis]))
    }
}

impl Stays {
    /// Whether all grains are there all the time.
    #[must_use]
    pub const fn is_always(&self) -> bool {
        self.entries.is_empty() && self.removal.is_none()
    }

    /// How many of the entries have come at a time (s). Rounding keeps none from the step that ends at its time.
    #[must_use]
    pub fn entered_by(&self, time: f64) -> usize {
        let now = time + 1e-9 * time.abs();
        self.entries.partition_point(|entry| entry.time <= now)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_at_the_end_of_a_step_is_in_time() {
        let entries = [0.1, 0.3, 0.7].map(|time| Entry { grain: 0, time }).to_vec();
        let stays = Stays { entries, removal: None };
        let times = [0.0, 0.1, 0.1 + 0.2, 0.299, 0.7, 9.0];
        assert_eq!(times.map(|time| stays.entered_by(time)), [0, 1, 2, 1, 3, 3]);
    }

    #[test]
    fn beyond_any_side_is_out() {
        let removal = Removal { low: Vector3::new(0.0, 0.0, 0.0), high: Vector3::new(1.0, 1.0, 1.0), every: 1 };
        let at = |x: f64, z: f64| removal.takes(Vector3::new(x, 0.5, z), 3);
        assert_eq!([at(0.5, 0.5), at(1.0, 0.0), at(1.1, 0.5), at(0.5, -0.1)], [false, false, true, true]);
        assert!(removal.takes(Vector3::new(f64::NAN, 0.5, 0.5), 3));
        assert!(!removal.takes(Vector3::new(0.5, 0.5, -9.0), 2));
    }
}
