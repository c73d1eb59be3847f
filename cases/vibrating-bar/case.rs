//! Longitudinal vibration of a bar.

use crate::rows::elastic::{AHEAD, front, stiffen};
use grainbench_harness::prelude::*;
use grainbench_scene::body::Hold;

const LEVELS: &[Level] = &[cells("L/12", 12.5, 2), cells("L/25", 25.0, 2), cells("L/50", 50.0, 2)];
/// Variant of the bar between smooth sides.
const HELD: &str = "held-sideways";
/// Variant of the bar of viscous material.
const VISCOUS: &str = "viscous";
/// Variant of the bar with an initial stress.
const STRETCHED: &str = "stretched";
const REST: &str = "the solution includes the dispersion of quadratic B-splines with two points per cell and of the \
                    time step, (1/4 + 1/96)(kh)² − (ωΔt)²/24; the rest is (kh)⁴ and at most ε² with the strain ε = \
                    v₀√(ρ/E)";
const SOURCE: Source = Source::Derived("u_tt = (E/ρ) u_xx, fixed-free (derivation)");
const DISPERSED: Source =
    Source::Derived("u_tt = (E/ρ) u_xx, fixed-free, slowed by the dispersion of cells of this size (derivation)");

const VELOCITY: ClaimFigure = ClaimFigure {
    name: "velocity",
    title: "Mean velocity of the bar",
    caption: "Two periods of the first mode. L/12 to L/50 are cell lengths.",
    axes: ["time t (s)", "mean velocity (m/s)"],
    logarithmic: false,
};

const VISCOUS_VELOCITY: ClaimFigure = ClaimFigure {
    name: "viscous",
    title: "Mean velocity of a bar of viscous material",
    caption: "Two periods of the first mode, during which 60 % of the amplitude is lost. L/25 is the cell length.",
    ..VELOCITY
};

const STRETCHED_VELOCITY: ClaimFigure = ClaimFigure {
    name: "stretched",
    title: "Mean velocity of a stretched bar after release at one end",
    caption: "One period. A wave front travels to the fixed end and back, twice. L/12 to L/50 are cell lengths.",
    ..VELOCITY
};

pub(crate) static CASE: Case = crate::heads::VIBRATING_BAR.with(LEVELS, 1, &claims).priced_by(targets);

/// Returns the frequency ω of the mode (rad/s) and the mean initial velocity (m/s).
fn mode(scene: &Scene) -> (f64, f64) {
    let bar = &scene.bodies[0];
    let wave = bar.wave.map_or((f64::NAN, f64::NAN), |wave| (wave.wave_number, wave.amplitude));
    let material = scene.deformable[0].map_or(f64::NAN, |material| material.longitudinal_modulus());
    (wave.0 * (material / bar.density).sqrt(), 2.0 / PI * wave.1)
}

/// Returns (kh)² of the mode at a resolution, k = π/2L with the cell h, and the largest strain v₀√(ρ/E).
fn small(resolution: Resolution) -> (f64, f64) {
    let strain = CASE.variant(PLAIN).ok().and_then(|scene| {
        let wave = scene.bodies[0].wave?;
        Some(wave.amplitude * wave.wave_number / mode(&scene).0)
    });
    ((PI / 2.0 / cells_of(resolution)).powi(2), strain.unwrap_or(f64::NAN))
}

/// Returns the number of cells in the length of the bar.
fn cells_of(resolution: Resolution) -> f64 {
    if let Resolution::Grid { cells, .. } = resolution { cells } else { f64::NAN }
}

/// Returns the relative decrease of a mode's frequency on the grid: (1/4 + 1/96)(kh)² − (ωΔt)²/24 (derivation).
fn slower(wave_number_squared: f64) -> f64 {
    (25.0 / 96.0 - Resolution::COURANT.powi(2) / 24.0) * wave_number_squared
}

/// Returns the relative error that remains after the correction by [`slower`]: (kh)⁴, and ε² of the law at a strain ε.
fn rest(squared: f64, strain: f64) -> f64 {
    squared * squared + strain * strain
}

/// Period between smooth sides (s), 10 √(E/M): E = 100 Pa and M = E (1 − ν)/((1 + ν)(1 − 2ν)) = 70/(1.3 · .4) Pa at ν = .3.
const HELD_PERIOD: f64 = 8.618_916_073_713_347;

/// Returns the mean period between zero crossings (s).
fn period(done: &FinishedRun) -> Result<f64, MissingData> {
    let (time, velocity) = (&done.series().time, done.column("bar.vx")?);
    let crossings: Vec<f64> = (1..velocity.len())
        .filter(|&at| velocity[at - 1] * velocity[at] < 0.0)
        .map(|at| {
            let share = velocity[at - 1] / (velocity[at - 1] - velocity[at]);
            time[at - 1] + share * (time[at] - time[at - 1])
        })
        .collect();
    match (crossings.first(), crossings.last()) {
        (Some(first), Some(last)) if crossings.len() > 2 => Ok(2.0 * (last - first) / (crossings.len() - 1) as f64),
        _ => Err("crossings of zero".into()),
    }
}

/// A mode of a bar of viscous material: its frequency without viscosity ω (rad/s), its decay rate δ (1/s), and its mean
/// initial velocity (m/s).
struct DampedMode {
    frequency: f64,
    decay: f64,
    amplitude: f64,
}

impl DampedMode {
    fn from_scene(scene: &Scene) -> Self {
        let (frequency, amplitude) = mode(scene);
        let bar = &scene.bodies[0];
        let wave_number = bar.wave.map_or(f64::NAN, |wave| wave.wave_number);
        let viscosity = scene.deformable[0].map_or(f64::NAN, |material| material.longitudinal_viscosity());
        Self { frequency, decay: 0.5 * viscosity * wave_number * wave_number / bar.density, amplitude }
    }

    fn velocity(&self, time: f64) -> f64 {
        let &Self { frequency, decay, amplitude } = self;
        let damped = (frequency * frequency - decay * decay).sqrt();
        amplitude * (-decay * time).exp() * ((damped * time).cos() - decay / damped * (damped * time).sin())
    }
}

/// Returns the largest error of the damped mode over `time` (s), in units of the initial amplitude (derivation).
fn damped_off(resolution: Resolution, scene: &Scene, time: f64) -> f64 {
    let ((squared, strain), DampedMode { frequency, decay, .. }) = (small(resolution), DampedMode::from_scene(scene));
    let step = resolution.steps_on_grid(scene).map_or(f64::NAN, |(step, _)| step);
    let (phase, lost, lag) = (frequency * time, decay * time, decay * step);
    25.0 / 96.0 * squared * (phase + 2.0 * lost) + (0.5 * phase + lost) * lag + 0.355 * strain
}

/// Returns the initial stress of the bar (Pa), ρL (kg/m²) and L/c (s).
fn stretched(scene: &Scene) -> (f64, f64, f64) {
    let bar = &scene.bodies[0];
    let (low, high) = bar.shape.corners();
    let (length, modulus) =
        (high.x - low.x, scene.deformable[0].map_or(f64::NAN, |deformable| deformable.longitudinal_modulus()));
    let stress = bar.stress.map_or(f64::NAN, |stress| stress.centre.m11);
    (stress, bar.density * length, length / (modulus / bar.density).sqrt())
}

/// Returns the mean velocity of the released bar (m/s): a triangle wave.
fn triangle(scene: &Scene, time: f64) -> f64 {
    let (stress, mass, transit) = stretched(scene);
    let phase = (time / transit + 1.0).rem_euclid(4.0);
    let wave = if phase < 2.0 { 1.0 - phase } else { phase - 3.0 };
    stress / mass * transit * wave
}

/// Returns the claims on the bar of viscous material and on the bar with an initial stress.
fn of_others() -> Vec<Claim> {
    let at = LEVELS[1];
    let time = 20.0;
    let off = CASE.number(VISCOUS, |scene| damped_off(at.resolution, scene, time));
    let viscous = claim(format!("mean velocity of a viscous bar over two periods, worst, {} cells", at.name), "m/s")
        .run(Run::new(VISCOUS, "mpm", at.resolution))
        .follows(
            Source::Derived("ρ u_tt = M u_xx + (4η/3 + ζ) u_txx, fixed-free (derivation)"),
            |done| samples(done, "bar.vx"),
            |done, time| DampedMode::from_scene(&done.scene).velocity(time),
            |done| DampedMode::from_scene(&done.scene).amplitude,
        )
        .within(computed(
            off,
            "k² of the grid is lower by (25/48)(kh)², the viscous stress is one step late, and the law adds .355 ε \
                 (derivation); in units of the initial amplitude",
        ))
        .refuses(Control::scene("half the shear viscosity", |scene| {
            for material in scene.deformable.iter_mut().flatten() {
                if let Constitutive::KelvinVoigt { viscosity, .. } = &mut material.constitutive {
                    *viscosity *= 0.5;
                }
            }
        }))
        .drawn(&VISCOUS_VELOCITY, at.name);
    let stretched = |level: &Level| {
        claim(format!("mean velocity of a stretched bar let go, a period, worst, {} cells", level.name), "m/s")
            .run(Run::new(STRETCHED, "mpm", level.resolution))
            .follows(
                Source::Derived("d'Alembert's waves of a stressed bar, fixed-free (derivation)"),
                |done| samples(done, "bar.vx"),
                |done, time| triangle(&done.scene, time),
                |done| triangle(&done.scene, 3.0 * stretched(&done.scene).2),
            )
            .within(computed(
                2.0 * AHEAD * front(1.0 / cells_of(level.resolution), 3.0),
                "the grid disperses the front over the distance 3L, so part of it arrives early: 2 (−Ai'(0)) δ/L at the \
                 arrival time (derivation); in units of σ/ρc",
            ))
            .refuses(Control::scene("half the stress", |scene| {
                if let Some(stress) = &mut scene.bodies[0].stress {
                    stress.centre *= 0.5;
                }
            }))
            .drawn(&STRETCHED_VELOCITY, level.name)
    };
    [viscous].into_iter().chain(LEVELS.iter().map(stretched)).collect()
}

fn claims() -> Vec<Claim> {
    let softer = || Control::scene("two per cent softer", |scene| stiffen(scene, 0.98));
    let run = |level: Level| Run::new(PLAIN, "mpm", level.resolution);
    let period_of = |level: &Level| {
        let (squared, strain) = small(level.resolution);
        claim(format!("period, {} cells", level.name), "s")
            .run(run(*level))
            .equals(DISPERSED, move |done| {
                let exact = 2.0 * PI / mode(&done[0].scene).0 * (1.0 + slower(squared));
                Ok(Measurement::relative(period(&done[0])?, exact))
            })
            .within(computed(rest(squared, strain), REST))
            .refuses(softer())
    };
    let velocity = |level: &Level| {
        let (squared, strain) = small(level.resolution);
        claim(format!("mean velocity over two periods, worst, {} cells", level.name), "m/s")
            .run(run(*level))
            .follows(
                SOURCE,
                |done| samples(done, "bar.vx"),
                |done, time| {
                    let (frequency, amplitude) = mode(&done.scene);
                    amplitude * (frequency * time).cos()
                },
                |done| mode(&done.scene).1,
            )
            .within(computed(
                4.0 * PI * slower(squared) + 0.355 * strain,
                "phase error of dispersion and time step in two periods, 4π ((1/4 + 1/96)(kh)² − (ωΔt)²/24), and .355 ε \
                 of the law at a strain ε; in units of the amplitude",
            ))
            .refuses(softer())
            .solver_independent_continuum()
            .drawn(&VELOCITY, level.name)
    };
    let (squared, strain) = small(LEVELS[1].resolution);
    let held = claim(format!("period between smooth sides, {} cells", LEVELS[1].name), "s")
        .run(Run::new(HELD, "mpm", LEVELS[1].resolution))
        .equals(
            Source::Derived("u_tt = ((K + 4G/3)/ρ) u_xx, fixed-free, slowed by the grid's dispersion (derivation)"),
            move |done| Ok(Measurement::relative(period(&done[0])?, HELD_PERIOD * (1.0 + slower(squared)))),
        )
        .within(computed(rest(squared, strain), REST))
        .refuses(Control::scene("free sides: the period of E/(1 − ν²)", |scene| {
            scene.bodies[0].sides[1] = [Hold::Free; 2];
        }));
    let energy = claim("total energy over two periods, worst", "J")
        .run(run(LEVELS[1]))
        .holds("conservation of energy", |done| Measurement::drift_of(&done[0], "all.total_energy"))
        .within(computed(
            8.0 / (9.0 * PI) * strain + Resolution::COURANT.powi(2) * squared,
            "(8/9π) ε because the elastic energy is computed as quadratic in σ, and (ωΔt)² because velocities are half a \
             step from stresses",
        ))
        .refuses(Control::scene("damping of a hundredth per second", |scene| scene.global_damping = 0.01));
    let of_mode = LEVELS.iter().map(period_of).chain([held]).chain(LEVELS.iter().map(velocity));
    of_mode.chain([energy]).chain(of_others()).collect()
}

/// Returns the target quantities of the cost study: periods, compared with the exact ones. The effect of the grid counts
/// as an error.
fn targets(case: &'static Case) -> Vec<TargetQuantity> {
    let target = |variant, quantity: &str, source: &str, exact: fn(&Scene) -> f64| TargetQuantity {
        case,
        variant,
        quantity: quantity.to_owned(),
        unit: "s",
        source: source.to_owned(),
        measure: Arc::new(move |done| {
            let done = done.first().ok_or("run")?;
            let exact = exact(&done.scene);
            Ok(Measurement::relative(period(done)?, exact))
        }),
        lanes: vec![SolverSetup {
            method: Method::Grid,
            knobs: String::new(),
            prepare: None,
            about: LEVELS[1].resolution,
        }],
    };
    vec![
        target(PLAIN, "period", "2π/(β√(E/ρ)) (derivation)", |scene| 2.0 * PI / mode(scene).0),
        target(HELD, "period between smooth sides", "10 √(E/M) s (derivation)", |_| HELD_PERIOD),
    ]
}
