//! A grain set down on a slope with an overlap larger than its static overlap, and with so much friction that it
//! sticks. It oscillates about its static overlap along the normal, and about rolling along the slope. The contact
//! neither opens nor slips. The motion therefore depends only on the springs and dashpots, which are equal in all soft
//! contact laws.
//!
//! With the static overlap δ_s = m g_n/k_n and the slip velocity s = v − ΩR:
//!
//! ```text
//! m d²δ/dt² + c_n dδ/dt + k_n δ = m g_n                          δ(0) = 3/2 δ_s, at rest
//! ds/dt = g_t − (1 + 1/i)(k_t ∫s dt + c_t s)/m                   s(0) = 0
//! ```
//!
//! Both equations are damped oscillators, with c_n = γ_n m + β k_n and c_t = γ_t m + β k_t. Source: Newton's and
//! Euler's laws.

use crate::exact::one_grain::{OneGrain, course, normal_axis, rest_at_overlap};
use crate::rows::on_plane::STEP;
use grainbench_harness::prelude::*;

const SPRINGS: ClaimFigure = ClaimFigure {
    name: "set-down",
    title: "Overlap of a grain released at 1.5 times its static overlap",
    caption: "The contact neither opens nor slips, so its springs and dashpots are a damped oscillator with an exact \
              solution.",
    axes: ["time t (s)", "overlap δ (m)"],
    logarithmic: false,
};

/// Coefficients of the dashpots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Dashpots {
    /// γ_n and γ_t (1/s): damping proportional to the mass.
    OfMass,
    /// β (s): damping proportional to the stiffness.
    OfStiffness,
}

/// Static overlap divided by the radius.
const RATIO: f64 = 1e-4;
/// Initial overlap divided by the static overlap.
const DEEPER: f64 = 1.5;
/// Damping ratio along the normal.
const DAMPING: f64 = 0.1;
/// Friction coefficient so large that the grain never slips.
const STICKING: f64 = 5.0;
/// Duration of the run and time between two samples, in units of 1/ω_n.
const TIMES: [f64; 2] = [40.0, 0.2];

const SOURCE: Source = Source::Derived("damped oscillators along the normal and along the slope (derivation)");
const BECAUSE: &str = "steps of a hundredth of the critical one, ωΔt ≤ .02: the dashpot is late by half a step, which \
                       increases the frequency by ζωΔt/2; until the vibration has decayed as e^(−ζωt), this is less \
                       than ωΔt/2 = .01 of the amplitude; the lever arm is between R and R − overlap, 1.5e-4 R";

/// Damped oscillator that is released at unit distance from equilibrium.
#[derive(Clone, Copy)]
struct Oscillator {
    /// Undamped frequency ω (rad/s).
    frequency: f64,
    /// Damping ratio ζ < 1.
    damping: f64,
}

impl Oscillator {
    /// Builds the oscillator from stiffness and damping, both divided by the mass.
    fn new(stiffness: f64, dashpot: f64) -> Self {
        let frequency = stiffness.sqrt();
        Self { frequency, damping: 0.5 * dashpot / frequency }
    }

    /// Returns the frequency of the damped oscillation (rad/s).
    fn ringing(self) -> f64 {
        self.frequency * (1.0 - self.damping * self.damping).sqrt()
    }

    /// Returns the distance from equilibrium at t (s).
    fn distance(self, t: f64) -> f64 {
        let (decay, phase) = (self.damping * self.frequency, self.ringing() * t);
        (-decay * t).exp() * (phase.cos() + decay / self.ringing() * phase.sin())
    }

    /// Returns −d(distance)/dt at t (s).
    fn approach(self, t: f64) -> f64 {
        let decay = self.damping * self.frequency;
        (-decay * t).exp() * self.frequency * self.frequency / self.ringing() * (self.ringing() * t).sin()
    }
}

/// Returns the oscillators along the normal and along the slope, from the scene's contact law and the grain's mass.
fn oscillators(scene: &Scene) -> [Oscillator; 2] {
    let (grain, law) = (OneGrain::from_scene(scene), scene.laws.iter().flatten().next().copied().unwrap_or_default());
    let (normal, tangential) = (law.normal_stiffness() / grain.mass, law.tangential_stiffness() / grain.mass);
    let turning = 1.0 + 1.0 / grain.inertia_factor;
    [
        Oscillator::new(normal, law.normal_damping + law.stiffness_damping * normal),
        Oscillator::new(turning * tangential, turning * (law.tangential_damping + law.stiffness_damping * tangential)),
    ]
}

/// Returns the static overlap (m).
fn rest(scene: &Scene) -> f64 {
    let grain = OneGrain::from_scene(scene);
    grain.overlap_ratio * grain.radius
}

fn set_down(scene: &mut Scene, dashpots: Dashpots) {
    rest_at_overlap(scene, RATIO, DAMPING);
    let axis = normal_axis(scene);
    let grain = &mut scene.grains[0];
    grain.position[axis] = grain.radius * (1.0 - DEEPER * RATIO);
    scene.change_laws(|law| law.friction = STICKING);
    let frequency = oscillators(scene)[0].frequency;
    if dashpots == Dashpots::OfStiffness {
        scene.change_laws(|law| {
            (law.normal_damping, law.tangential_damping) = (0.0, 0.0);
            law.stiffness_damping = 2.0 * DAMPING / frequency;
        });
    }
    scene.duration = Duration::Seconds(TIMES[0] / frequency);
    scene.sampling = Sampling::Seconds(TIMES[1] / frequency);
}

/// Returns the claims on overlap and slip velocity over time, for a grain on a slope.
pub(crate) fn claims(variant: &'static str, dashpots: Dashpots) -> Vec<Claim> {
    let name = match dashpots {
        Dashpots::OfMass => "set down, damping by mass",
        Dashpots::OfStiffness => "set down, damping by stiffness",
    };
    let run = || Run::new(variant, "dem:lammps", STEP).adjusted(name, move |scene| set_down(scene, dashpots));
    vec![
        claim("overlap while it rings, largest deviation", "m")
            .run(run())
            .follows(
                SOURCE,
                |done| samples(done, "contact.overlap"),
                |done, t| {
                    let rest = rest(&done.scene);
                    rest + (DEEPER - 1.0) * rest * oscillators(&done.scene)[0].distance(t)
                },
                |done| (DEEPER - 1.0) * rest(&done.scene),
            )
            .within(estimated(0.01, BECAUSE).up_to(0.02))
            .refuses(Control::contact_law("springs ×1.05", |law| law.springs = law.springs.scaled([1.05; 2])))
            .solver_independent_springs()
            .drawn(&SPRINGS, super::label(variant)),
        claim("slip velocity v − ΩR while it rings, largest deviation", "m/s")
            .run(run())
            .follows(
                SOURCE,
                |done| {
                    let radius = done.scene.grains[0].radius;
                    Ok(course(done)?.into_iter().map(|(t, state)| (t, state.v - state.omega * radius)).collect())
                },
                |done, t| {
                    let oscillator = oscillators(&done.scene)[1];
                    OneGrain::from_scene(&done.scene).along / (oscillator.frequency * oscillator.frequency)
                        * oscillator.approach(t)
                },
                // Peak slip velocity of a sticking grain on an undamped tangential spring: g_t/ω.
                |done| OneGrain::from_scene(&done.scene).along / oscillators(&done.scene)[1].frequency,
            )
            .within(estimated(0.01, BECAUSE).up_to(0.02))
            .refuses(Control::contact_law("dashpots a tenth too weak", |law| {
                law.normal_damping *= 0.9;
                law.tangential_damping *= 0.9;
                law.stiffness_damping *= 0.9;
            }))
            .solver_independent_springs(),
    ]
}
