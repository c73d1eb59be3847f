//! A grain between two grains that carry it along a circle with prescribed motion. In one variant the contact normals
//! rotate, and in another the contacts rotate about their normals.

use crate::exact::turning::{second_order, sprung};
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[fraction("dt=.1", 0.1), fraction("dt=.03", 0.03), fraction("dt=.01", 0.01)];
const STEP: Level = LEVELS[2];

pub(crate) static CASE: Case = crate::heads::CARRIED_GRAIN.with(LEVELS, 2, &claims);

/// Parameters of motion, springs and run that determine the exact position of the carried grain.
struct Motion {
    /// Angular velocity Ω (rad/s).
    spin: Vector3<f64>,
    /// Frequency ω of the springs (rad/s).
    frequency: f64,
    /// Largest overlap (m).
    overlap: f64,
    /// Half the sum over both contacts of overlap divided by distance of centres.
    curved: f64,
    start: Vector3<f64>,
    radius: f64,
    time: f64,
    step: f64,
}

impl Motion {
    fn from_scene(scene: &Scene) -> Self {
        let carried = &scene.grains[0];
        let stiffness = scene.laws[0].map_or(f64::NAN, |law| law.normal_stiffness());
        let distance = |other: &Grain| (other.position - carried.position).norm();
        let overlap = |other: &Grain| carried.radius + other.radius - distance(other);
        let drivers = || scene.grains.iter().skip(1);
        Self {
            spin: carried.spin,
            frequency: (2.0 * stiffness / carried.mass).sqrt(),
            overlap: drivers().map(overlap).fold(0.0, f64::max),
            curved: drivers().map(|other| 0.5 * overlap(other) / distance(other)).sum(),
            start: carried.position,
            radius: carried.radius,
            time: scene.duration.seconds().unwrap_or(f64::NAN),
            step: STEP.step(scene),
        }
    }

    /// Returns the tolerance of the final position (m), for an axis of rotation across or along the contact normals.
    fn off(&self, across: bool) -> f64 {
        let (rate, distance) = (self.spin.norm(), self.start.norm());
        let phase = 0.25 * self.frequency * self.time;
        let soft = 2.0 * (rate / self.frequency).powi(2) * self.curved * (0.5 + phase) * distance;
        let turned = (rate * self.time).min(2.0) * (rate / self.frequency).powi(2) * distance;
        let arms = if across { turned } else { 0.0 };
        second_order(distance, rate, self.frequency, [self.time, self.step]) + soft + arms
    }
}

/// Returns the final position of the carried grain (m).
fn place(done: &FinishedRun) -> Result<Vector3<f64>, MissingData> {
    let mut place = Vector3::zeros();
    for (axis, name) in ["carried.x", "carried.y", "carried.z"].iter().enumerate().take(done.scene.dimension.count()) {
        place[axis] = done.last(name)?;
    }
    Ok(place)
}

fn claims() -> Vec<Claim> {
    vec![after_a_turn("across"), after_a_turn("along"), spin()]
}

fn without_spin() -> Control {
    Control::scene("the drivers run on and do not spin", |scene| {
        scene.driven.iter_mut().for_each(|driven| driven.spin = Vector3::zeros());
    })
}

fn after_a_turn(variant: &'static str) -> Claim {
    let allowed = CASE.number(variant, |scene| {
        let motion = Motion::from_scene(scene);
        motion.off(variant == "across") / motion.start.norm()
    });
    claim(format!("place after a turn, axis {variant} the normals, off"), "m")
        .run(Run::new(variant, "dem", STEP.resolution))
        .holds("a mass on isotropic springs whose rest position rotates (derivation)", |done| {
            let motion = Motion::from_scene(&done[0].scene);
            let exact = sprung(motion.start, motion.spin, motion.frequency, motion.time);
            Ok(Measurement::new((place(&done[0])? - exact).norm(), 0.0, motion.start.norm()))
        })
        .within(computed(
            allowed,
            "time step (second order), d (ΩΔt)² (1 + θ)² and 2 d (Ω/ω)² ωT (ωΔt)²/24; curvature of the surfaces, 2 d \
             (Ω/ω)² c (1/2 + ωT/4); across the normals, lever arms, d (Ω/ω)² θ and at most twice d (Ω/ω)²",
        ))
        .refuses(without_spin())
        .solver_independent_springs()
}

fn spin() -> Claim {
    let allowed = CASE.number("across", |scene| {
        let motion = Motion::from_scene(scene);
        let (rate, step) = (motion.spin.norm(), motion.step);
        2.0 * motion.overlap / motion.radius + (rate * step * (1.0 + rate * motion.time)).powi(2)
    });
    claim("spin after a turn, axis across the normals", "rad/s")
        .run(Run::new("across", "dem", STEP.resolution))
        .equals(Source::Derived("the torques of both contacts are opposite (derivation)"), |done| {
            Ok(Measurement::relative(done[0].last("carried.omega")?, Motion::from_scene(&done[0].scene).spin.norm()))
        })
        .within(computed(allowed, "lever arms differ by up to the overlap, 2δ/R; time step, (ΩΔt)² (1 + θ)²"))
        .refuses(without_spin())
        .solver_independent_springs()
}
