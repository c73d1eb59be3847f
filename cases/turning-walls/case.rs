//! Grains on rotating walls. The walls are a drum, a tilting tray, and two plates that rotate about their normal.

use crate::exact::turning::{second_order, sprung};
use grainbench_harness::prelude::*;
use std::f64::consts::TAU;

const LEVELS: &[Level] = &[fraction("dt=.1", 0.1), fraction("dt=.05", 0.05), fraction("dt=.02", 0.02)];
const STEP: Level = LEVELS[1];

pub(crate) static CASE: Case = crate::heads::TURNING_WALLS.with(LEVELS, 1, &claims);

/// Returns the angular velocity of the walls (rad/s).
fn spin(scene: &Scene) -> Vector3<f64> {
    scene.walls[0].motion.phases.iter().map(|phase| phase.spin).sum()
}

/// Returns the angle of rotation of the walls (rad).
fn turned(scene: &Scene) -> f64 {
    spin(scene).norm() * scene.duration.seconds().unwrap_or(f64::NAN)
}

/// Returns the relative error of the integration scheme, (ΩΔt)² (1 + ΩT)².
fn scheme(scene: &Scene) -> f64 {
    let step = STEP.step(scene);
    (spin(scene).norm() * step * (1.0 + turned(scene))).powi(2)
}

/// Returns the overlap of the sphere with the drum (m).
fn in_drum(scene: &Scene) -> f64 {
    let (grain, law) = (&scene.grains[0], scene.laws[0].unwrap_or_default());
    let force = grain.mass * spin(scene).norm_squared() * grain.position.norm();
    force / law.normal_stiffness()
}

fn claims() -> Vec<Claim> {
    vec![orbit(), spin_in_drum(), tray(), clamped()]
}

fn slower() -> Control {
    Control::scene("walls that turn slower by a hundredth", |scene| {
        let phases = scene.walls.iter_mut().flat_map(|wall| &mut wall.motion.phases);
        phases.for_each(|phase| phase.spin *= 0.99);
    })
}

/// Returns the angle of the grain's path around the origin (rad), from its positions at all samples.
fn gone_round(done: &FinishedRun) -> Result<f64, MissingData> {
    let angles: Vec<f64> =
        done.column("grain.x")?.iter().zip(done.column("grain.y")?).map(|(x, y)| y.atan2(*x)).collect();
    let nearest = |change: f64| change - TAU * (change / TAU).round();
    Ok(angles.windows(2).map(|pair| nearest(pair[1] - pair[0])).sum())
}

fn orbit() -> Claim {
    let exact = CASE.number("drum", turned);
    claim("angle that the sphere has gone round in the drum", "rad")
        .run(Run::new("drum", "dem", STEP.resolution))
        .equals(Source::Derived("it stays at rest relative to the drum: ΩT (derivation)"), move |done| {
            Ok(Measurement::relative(gone_round(&done[0])?, exact))
        })
        .within(computed(
            CASE.number("drum", |scene| 2.0 * in_drum(scene) / scene.grains[0].position.norm() + scheme(scene)),
            "lever arms differ by up to the overlap, 2δ/r; time step, (ΩΔt)² (1 + ΩT)²",
        ))
        .refuses(slower())
        .solver_independent_springs()
}

fn spin_in_drum() -> Claim {
    let exact = CASE.number("drum", |scene| spin(scene).norm());
    claim("spin of the sphere in the drum", "rad/s")
        .run(Run::new("drum", "dem", STEP.resolution))
        .equals(Source::Derived("it turns with the drum: Ω (derivation)"), move |done| {
            Ok(Measurement::relative(done[0].last("grain.omega_z")?, exact))
        })
        .within(computed(
            CASE.number("drum", |scene| 2.0 * in_drum(scene) / scene.grains[0].radius + scheme(scene)),
            "lever arms differ by up to the overlap, 2δ/R; time step, (ΩΔt)² (1 + ΩT)²",
        ))
        .refuses(slower())
        .solver_independent_springs()
}

/// Returns the compliance of the disc along the tray (m/N): 1/k_t + R²/k_r.
fn softness(scene: &Scene) -> f64 {
    let (law, radius) = (scene.laws[0].unwrap_or_default(), scene.grains[0].radius);
    let rolling = 2.25 * law.normal_stiffness() * (law.rolling_friction * radius).powi(2);
    1.0 / law.tangential_stiffness() + radius * radius / rolling
}

/// Returns the largest error of the disc's position over Rφ, due to lever arms and vibration on the springs.
fn tray_off(scene: &Scene) -> f64 {
    let grain = &scene.grains[0];
    let (weight, angle) = (grain.mass * scene.gravity.norm(), turned(scene));
    let overlap = weight / scene.laws[0].map_or(f64::NAN, |law| law.normal_stiffness());
    let rate = (1.5 * grain.mass * softness(scene)).sqrt().recip();
    let swing = weight * spin(scene).norm() * softness(scene) / rate;
    (overlap * angle + 2.0 * swing) / (grain.radius * angle) + scheme(scene)
}

fn tray() -> Claim {
    claim("way of the disc down the tray", "m")
        .run(Run::new("tray", "dem", STEP.resolution))
        .equals(Source::Derived("m g sin φ (1/k_t + R²/k_r) (derivation)"), |done| {
            let scene = &done[0].scene;
            let (angle, grain) = (turned(scene), &scene.grains[0]);
            // The tray tilts down towards +x.
            let way = done[0].last("grain.x")? * angle.cos() - done[0].last("grain.y")? * angle.sin();
            let exact = grain.mass * scene.gravity.norm() * angle.sin() * softness(scene);
            Ok(Measurement::new(way, exact, grain.radius * angle))
        })
        .within(computed(
            CASE.number("tray", tray_off),
            "lever arms differ by up to the overlap, δφ; twice the vibration ẋ/ω on the springs; in units of Rφ",
        ))
        .refuses(Control::without(Effect::RollingResistance))
        .solver_independent_springs()
}

/// Returns the frequency of the springs of both plates (rad/s).
fn frequency(scene: &Scene) -> f64 {
    scene.laws[0].map_or(f64::NAN, |law| (2.0 * law.tangential_stiffness() / scene.grains[0].mass).sqrt())
}

/// Returns the component of a position across the z axis, about which the clamped sphere rotates.
fn across(place: Vector3<f64>) -> Vector3<f64> {
    Vector3::new(place.x, place.y, 0.0)
}

fn clamped() -> Claim {
    let allowed = CASE.number("clamped", |scene| {
        let step = STEP.step(scene);
        let time = scene.duration.seconds().unwrap_or(f64::NAN);
        second_order(1.0, spin(scene).norm(), frequency(scene), [time, step])
    });
    claim("place of the clamped sphere after a turn, off", "m")
        .run(Run::new("clamped", "dem", STEP.resolution))
        .holds("r̈ = −ω²(r − r₀(t)) (derivation)", |done| {
            let scene = &done[0].scene;
            let start = across(scene.grains[0].position);
            let time = scene.duration.seconds().unwrap_or(f64::NAN);
            let exact = sprung(start, spin(scene), frequency(scene), time);
            let end = Vector3::new(done[0].last("grain.x")?, done[0].last("grain.y")?, 0.0);
            Ok(Measurement::new((end - exact).norm(), 0.0, start.norm()))
        })
        .within(computed(allowed, "(ΩΔt)² (1 + ΩT)² and 2 (Ω/ω)² ωT (ωΔt)²/24, relative to r₀"))
        .refuses(Control::scene("the upper plate turns slower by a hundredth", |scene| {
            scene.walls[1].motion.phases.iter_mut().for_each(|phase| phase.spin *= 0.99);
        }))
        .solver_independent_springs()
}
