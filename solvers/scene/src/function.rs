//! Motions given as functions of time: oscillations and ramps.

use nalgebra::Vector3;

/// Displacement as a function of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Function {
    /// Kind of function.
    pub kind: FunctionKind,
    /// Start (s). The displacement is zero until then.
    pub start: f64,
    /// Stop (s). The displacement stays constant from then on.
    pub stop: f64,
}

/// Kind of function of the time τ since the start (s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FunctionKind {
    /// Oscillation A (sin(2πfτ + φ) − sin φ), which starts at zero displacement.
    Sine {
        /// Amplitude A (m).
        amplitude: Vector3<f64>,
        /// Frequency f (Hz).
        frequency: f64,
        /// Phase φ (rad).
        phase: f64,
    },
    /// Ramp: the velocity rises from zero to V at a constant rate over a time T. The displacement is V τ²/2T until τ =
    /// T, and V (τ − T/2) afterwards.
    Ramp {
        /// Velocity V (m/s).
        velocity: Vector3<f64>,
        /// Time T (s).
        over: f64,
    },
}

impl Function {
    /// Returns the displacement since the start (m) at a time (s).
    #[must_use]
    pub fn way(&self, time: f64) -> Vector3<f64> {
        let elapsed = (time.min(self.stop) - self.start).max(0.0);
        match self.kind {
            FunctionKind::Sine { amplitude, frequency, phase } => {
                let angle = std::f64::consts::TAU * frequency * elapsed;
                amplitude * (libm::sin(angle + phase) - libm::sin(phase))
            }
            FunctionKind::Ramp { velocity, over } if elapsed < over => velocity * (0.5 * elapsed * elapsed / over),
            FunctionKind::Ramp { velocity, over } => velocity * (elapsed - 0.5 * over),
        }
    }

    /// Returns the largest speed (m/s).
    #[must_use]
    pub fn fastest(&self) -> f64 {
        match self.kind {
            FunctionKind::Sine { amplitude, frequency, .. } => std::f64::consts::TAU * frequency * amplitude.norm(),
            FunctionKind::Ramp { velocity, .. } => velocity.norm(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VELOCITY: Vector3<f64> = Vector3::new(2.0, 0.0, 0.0);

    #[test]
    fn a_ramp_goes_on_at_its_velocity() {
        let ramp = Function { kind: FunctionKind::Ramp { velocity: VELOCITY, over: 0.5 }, start: 1.0, stop: 3.0 };
        for (time, way) in [(0.5, 0.0), (1.25, 0.125), (1.5, 0.5), (2.0, 1.5), (3.0, 3.5), (9.0, 3.5)] {
            assert_eq!(ramp.way(time).x, way, "{time}");
        }
    }

    #[test]
    fn a_sine_starts_where_it_is() {
        let kind = FunctionKind::Sine { amplitude: VELOCITY, frequency: 0.5, phase: std::f64::consts::FRAC_PI_2 };
        let sine = Function { kind, start: 1.0, stop: f64::INFINITY };
        assert_eq!(sine.way(1.0).x, 0.0);
        assert!((sine.way(2.0).x + 4.0).abs() < 1e-14 && sine.way(3.0).x.abs() < 1e-14);
        assert!((sine.fastest() - std::f64::consts::TAU).abs() < 1e-14);
    }
}
