//! Prescribed motion of walls: exact positions at any time, so that a ramp ends where it should whatever the step.

use crate::function::Function;
use nalgebra::{Rotation3, Unit, Vector3};
use serde::{Deserialize, Serialize};

/// A moment that is given in seconds or in calculation cycles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Moment {
    /// A time (s).
    Seconds(f64),
    /// A calculation cycle.
    Cycle(u64),
    /// Not within the run.
    Never,
}

impl Moment {
    /// The moment in seconds when a cycle lasts `time_step`.
    #[must_use]
    pub fn seconds(self, time_step: f64) -> f64 {
        match self {
            Self::Seconds(time) => time,
            Self::Cycle(cycle) => cycle as f64 * time_step,
            Self::Never => f64::INFINITY,
        }
    }
}

/// One phase: constant velocity and spin between two moments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phase {
    /// Velocity (m/s).
    pub velocity: Vector3<f64>,
    /// Angular velocity (rad/s) about [`Motion::centre`].
    pub spin: Vector3<f64>,
    /// When it starts.
    pub start: Moment,
    /// When it stops.
    pub stop: Moment,
}

/// The motion of a wall, or of driven grains: phases and functions that add up. All rotations of a wall share one axis.
#[derive(Clone, Default, PartialEq)]
pub struct Motion {
    /// Centre of rotation at the start (m); it moves with the wall.
    pub centre: Vector3<f64>,
    /// The phases.
    pub phases: Vec<Phase>,
    /// The functions of time beside them.
    pub functions: Vec<Function>,
}

/// Functions are shown where there are any: what scenes are known by does not change where a key is not used.
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

/// Where a wall is, relative to its start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Displacement {
    /// Translation (m).
    pub translation: Vector3<f64>,
    /// Rotation vector about the centre (rad).
    pub rotation: Vector3<f64>,
}

impl Motion {
    /// Whether the wall ever moves.
    #[must_use]
    pub fn is_moving(&self) -> bool {
        self.phases.iter().any(|phase| phase.velocity.norm() > 0.0 || phase.spin.norm() > 0.0)
            || self.functions.iter().any(|function| function.fastest() > 0.0)
    }

    /// Whether there is none, not even one that stands still.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.phases.is_empty() && self.functions.is_empty()
    }

    /// A bound of the speed that it ever has (m/s), but for what turns.
    #[must_use]
    pub fn fastest(&self) -> f64 {
        let phases = self.phases.iter().map(|phase| phase.velocity.norm());
        phases.chain(self.functions.iter().map(Function::fastest)).sum()
    }

    /// Takes all motion away.
    pub fn clear(&mut self) {
        self.phases.clear();
        self.functions.clear();
    }

    /// Displacement since the start at `time` (s), with cycles of `time_step` (s).
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

    /// Where a point of the wall (m, at the start) is after a displacement.
    #[must_use]
    pub fn moved(&self, point: Vector3<f64>, displacement: &Displacement) -> Vector3<f64> {
        self.centre + displacement.translation + self.turned(point - self.centre, displacement)
    }

    /// Where a direction of the wall points after a displacement.
    #[must_use]
    pub fn turned(&self, direction: Vector3<f64>, displacement: &Displacement) -> Vector3<f64> {
        match Unit::try_new_and_get(displacement.rotation, 0.0) {
            Some((axis, angle)) => Rotation3::from_axis_angle(&axis, angle) * direction,
            None => direction,
        }
    }

    /// How the wall is turned after a displacement.
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
