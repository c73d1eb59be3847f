//! Prescribed motion of walls and grains. Positions are exact functions of time, so a motion ends at the same position
//! for any time step.

use crate::function::Function;
use nalgebra::{Rotation3, Unit, Vector3};
use serde::{Deserialize, Serialize};

/// Time in seconds or in calculation cycles (time steps).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Moment {
    /// Time (s).
    Seconds(f64),
    /// Calculation cycle.
    Cycle(u64),
    /// Never during the run.
    Never,
}

impl Moment {
    /// Returns the time (s) for cycles of `time_step` (s); infinite for never.
    #[must_use]
    pub fn seconds(self, time_step: f64) -> f64 {
        match self {
            Self::Seconds(time) => time,
            Self::Cycle(cycle) => cycle as f64 * time_step,
            Self::Never => f64::INFINITY,
        }
    }
}

/// Phase of constant velocity and spin between two times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phase {
    /// Velocity (m/s).
    pub velocity: Vector3<f64>,
    /// Angular velocity (rad/s) about [`Motion::centre`].
    pub spin: Vector3<f64>,
    /// Start of the phase.
    pub start: Moment,
    /// End of the phase.
    pub stop: Moment,
}

/// Motion of a wall, or of grains with prescribed motion: the sum of phases and functions. All rotations share one
/// axis.
#[derive(Clone, Default, PartialEq)]
pub struct Motion {
    /// Initial centre of rotation (m). It moves with the wall.
    pub centre: Vector3<f64>,
    /// Phases of constant velocity. The displacements of all phases are added.
    pub phases: Vec<Phase>,
    /// Oscillations and ramps. Their displacements are added too.
    pub functions: Vec<Function>,
}

/// Prints functions only if there are any, so that fingerprints of scenes without functions stay the same.
impl std::fmt::Debug for Motion {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut shown = formatter.debug_struct("Motion");
        shown.field("centre", &self.centre).field("phases", &self.phases);
        if !self.functions.is_empty() {
            shown.field("functions", &self.functions);
        }
        shown.finish()
    }
}

/// Displacement of a wall from its initial position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Displacement {
    /// Translation (m).
    pub translation: Vector3<f64>,
    /// Rotation vector about the centre (rad).
    pub rotation: Vector3<f64>,
}

impl Motion {
    /// Returns true if the wall ever moves.
    #[must_use]
    pub fn is_moving(&self) -> bool {
        self.phases.iter().any(|phase| phase.velocity.norm() > 0.0 || phase.spin.norm() > 0.0)
            || self.functions.iter().any(|function| function.fastest() > 0.0)
    }

    /// Returns true if the motion contains a rotation.
    #[must_use]
    pub fn rotates(&self) -> bool {
        self.phases.iter().any(|phase| phase.spin.norm() > 0.0)
    }

    /// Returns true if there are no phases and no functions. A phase of zero velocity counts as a phase.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.phases.is_empty() && self.functions.is_empty()
    }

    /// Returns an upper bound of the translational speed (m/s).
    #[must_use]
    pub fn fastest(&self) -> f64 {
        let phases = self.phases.iter().map(|phase| phase.velocity.norm());
        phases.chain(self.functions.iter().map(Function::fastest)).sum()
    }

    /// Removes all phases and functions.
    pub fn clear(&mut self) {
        self.phases.clear();
        self.functions.clear();
    }

    /// Returns the displacement from the initial position at `time` (s), for cycles of `time_step` (s).
    #[must_use]
    pub fn displacement(&self, time: f64, time_step: f64) -> Displacement {
        let mut result = Displacement { translation: Vector3::zeros(), rotation: Vector3::zeros() };
        for phase in &self.phases {
            let (start, stop) = (phase.start.seconds(time_step), phase.stop.seconds(time_step));
            let elapsed = (time.min(stop) - start).max(0.0);
            result.translation += phase.velocity * elapsed;
            result.rotation += phase.spin * elapsed;
        }
        for function in &self.functions {
            result.translation += function.way(time);
        }
        result
    }

    /// Returns the position (m) of a point of the wall after a displacement. `point` is its initial position (m).
    #[must_use]
    pub fn moved(&self, point: Vector3<f64>, displacement: &Displacement) -> Vector3<f64> {
        self.centre + displacement.translation + self.turned(point - self.centre, displacement)
    }

    /// Returns a direction that rotates with the wall, after a displacement.
    #[must_use]
    pub fn turned(&self, direction: Vector3<f64>, displacement: &Displacement) -> Vector3<f64> {
        match Unit::try_new_and_get(displacement.rotation, 0.0) {
            Some((axis, angle)) => Rotation3::from_axis_angle(&axis, angle) * direction,
            None => direction,
        }
    }

    /// Returns the rotation of the wall after a displacement.
    #[must_use]
    pub fn turning(&self, displacement: &Displacement) -> Rotation3<f64> {
        let turned = Unit::try_new_and_get(displacement.rotation, 0.0);
        turned.map_or_else(Rotation3::identity, |(axis, angle)| Rotation3::from_axis_angle(&axis, angle))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramp_ends_exactly_at_its_cycle() {
        let phase = Phase {
            velocity: Vector3::new(0.12, 0.0, 0.0),
            spin: Vector3::zeros(),
            start: Moment::Cycle(0),
            stop: Moment::Cycle(40),
        };
        let motion = Motion { phases: vec![phase], ..Motion::default() };
        let time_step = 0.015;
        let at = |cycle: u32| motion.displacement(f64::from(cycle) * time_step, time_step).translation.x;
        assert_eq!(at(40), 0.12 * (40.0 * time_step));
        assert_eq!(at(40), at(400));
        assert_eq!(at(0), 0.0);
    }

    #[test]
    fn quarter_turn_about_a_moving_centre() {
        let phase = Phase {
            velocity: Vector3::new(1.0, 0.0, 0.0),
            spin: Vector3::new(0.0, 0.0, std::f64::consts::FRAC_PI_2),
            start: Moment::Seconds(1.0),
            stop: Moment::Never,
        };
        let motion = Motion { centre: Vector3::new(1.0, 0.0, 0.0), phases: vec![phase], ..Motion::default() };
        let displacement = motion.displacement(2.0, 0.1);
        let point = motion.moved(Vector3::new(2.0, 0.0, 0.0), &displacement);
        assert!((point - Vector3::new(2.0, 1.0, 0.0)).norm() < 1e-15);
    }
}
