//! Insertion and removal of grains.

use nalgebra::Vector3;

/// Insertion and removal of grains during a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stays {
    /// Grains that are absent at the start, in order of insertion time.
    pub entries: Vec<Entry>,
    /// Removal of grains; absent if no grains are removed.
    pub removal: Option<Removal>,
}

/// Inserted grain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Index in [`crate::scene::Scene::grains`], which holds the initial position, velocity and spin.
    pub grain: usize,
    /// Insertion time (s). The grain is present from the first step that ends at or after this time.
    pub time: f64,
}

/// Removal of grains whose centre lies outside a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Removal {
    /// Lower corner (m).
    pub low: Vector3<f64>,
    /// Upper corner (m).
    pub high: Vector3<f64>,
    /// Number of steps between searches for grains to remove.
    pub every: u64,
}

impl Removal {
    /// Returns true if a grain with its centre at a position (m) is removed. `dimension` is the number of dimensions.
    #[must_use]
    pub fn takes(&self, place: Vector3<f64>, dimension: usize) -> bool {
        (0..dimension).any(|axis| !(self.low[axis]..=self.high[axis]).contains(&place[axis]))
    }
}

impl Stays {
    /// Returns true if no grains are inserted or removed.
    #[must_use]
    pub const fn is_always(&self) -> bool {
        self.entries.is_empty() && self.removal.is_none()
    }

    /// Returns the number of grains inserted until a time (s). Because of a tolerance, rounding does not exclude
    /// insertions at this time.
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
