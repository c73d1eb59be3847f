//! Final state of a run, and the difference between two final states.

use crate::expect::larger;
use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::record::{GrainState, Record};
use grainbench_solver::resolution::Resolution;

#[derive(Clone, Debug)]
pub(super) struct End {
    pub(super) time: f64,
    /// Grains in the order of the scene.
    pub(super) grains: Vec<GrainState>,
    pub(super) time_step: f64,
    pub(super) steps: f64,
}

/// Reason why there is no final state to compare.
pub(super) enum NoEnd {
    Run(RunError),
    /// Reason in words, if the record lacks data or a scene is invalid.
    Record(String),
}

impl From<RunError> for NoEnd {
    fn from(error: RunError) -> Self {
        Self::Run(error)
    }
}

impl End {
    /// Runs a scene and returns its final state.
    pub(super) fn from_solver(solver: &dyn Solver, scene: &Scene, resolution: &Resolution) -> Result<Self, NoEnd> {
        Self::read(scene, &solver.run(scene, resolution, &mut ())?)
    }

    pub(super) fn read(scene: &Scene, record: &Record) -> Result<Self, NoEnd> {
        let missing = |what: &str| NoEnd::Record(format!("the record has no {what}"));
        let last = record.snapshots.last().ok_or_else(|| missing("snapshot"))?;
        if last.grains.len() != scene.grains.len() || last.step == 0 {
            return Err(missing("snapshot of all grains at the end"));
        }
        let mut grains = last.grains.clone();
        grains.sort_by_key(|grain| grain.id);
        let time_step = record.provenance.time_step;
        Ok(Self { time: last.time, grains, time_step, steps: last.step as f64 })
    }

    /// Returns the largest difference between two final states (m/s).
    ///
    /// For each grain, compares velocity, spin times radius, and position divided by the time of the run. The relative
    /// difference of the final times also counts, as a plain number.
    pub(super) fn apart(&self, other: &Self) -> f64 {
        let pairs = self.grains.iter().zip(&other.grains);
        let worst = pairs.map(|(a, b)| {
            let spin = (a.spin - b.spin).norm() * a.radius;
            let place = (a.position - b.position).norm() / self.time;
            [(a.velocity - b.velocity).norm(), spin, place].into_iter().fold(0.0, larger)
        });
        worst.fold((self.time - other.time).abs() / self.time, larger)
    }

    /// Returns the largest distance of a grain from the origin (m) and the largest surface speed of a grain (m/s).
    pub(super) fn reach(&self) -> (f64, f64) {
        let far = self.grains.iter().map(|grain| grain.position.norm()).fold(0.0, larger);
        let fast = self.grains.iter().map(|grain| grain.velocity.norm() + grain.spin.norm() * grain.radius);
        (far, fast.fold(0.0, larger))
    }
}

/// Returns the speed error (m/s) that rounding can cause between two runs of collisions.
///
/// Every step rounds positions of size L by εL. This changes velocities by ω²εLΔt, where ω = 2/Δt_crit is the frequency of
/// the stiffest contact and ε is the machine precision. Every step also rounds velocities U by εU.
pub(super) fn rounding(scene: &Scene, ends: [&End; 2]) -> f64 {
    let rate = 2.0 / scene.critical_time_step();
    let rounding_error = |end: &End| {
        let (far, fast) = end.reach();
        f64::EPSILON * (far * rate * rate * end.time + fast * end.steps)
    };
    rounding_error(ends[0]).max(rounding_error(ends[1]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_scene::scene::Grain;
    use nalgebra::Vector3;

    /// The difference of two states is the largest difference of a grain. NaN counts as the largest.
    #[test]
    fn ends_that_are_not_numbers_are_apart() {
        let grain = |speed: f64| {
            let (position, velocity, spin) = (Vector3::zeros(), Vector3::x() * speed, Vector3::zeros());
            let grain = Grain { material: 0, radius: 1.0, mass: 1.0, inertia: 1.0, position, velocity, spin };
            GrainState::start(1, &grain)
        };
        let end = |speeds: [f64; 2]| End { time: 1.0, grains: speeds.map(grain).to_vec(), time_step: 0.1, steps: 10.0 };
        assert_eq!(end([0.0, 0.0]).apart(&end([1.0, -3.0])), 3.0);
        for lost in [[f64::NAN, 5.0], [5.0, f64::NAN], [-f64::NAN, 0.0]] {
            assert!(end([0.0, 0.0]).apart(&end(lost)).is_nan() && end(lost).reach().1.is_nan(), "{lost:?}");
        }
    }
}
