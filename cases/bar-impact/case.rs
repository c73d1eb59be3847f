//! End-to-end impact of two elastic bars.

use crate::rows::elastic::{AHEAD, front, stiffen};
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[cells("L/20", 20.0, 2), cells("L/40", 40.0, 2), cells("L/80", 80.0, 2)];
const SOURCE: Source = Source::Derived("waves in a line of material (derivation)");

const VELOCITY: ClaimFigure = ClaimFigure {
    name: "velocity",
    title: "Velocity of the right bar",
    caption: "The velocity grows during contact, which lasts 2L/c, up to the initial velocity of the left bar. L/20 \
              to L/80 are cell lengths.",
    axes: ["time t (s); L/c = 1 s", "velocity (m/s)"],
    logarithmic: false,
};

pub(crate) static CASE: Case = crate::heads::BAR_IMPACT.with(LEVELS, 1, &claims).drawn_by(figures);

/// Impact velocity (m/s), wave speed (m/s), length (m) and density (kg/m³).
struct Impact {
    speed: f64,
    wave: f64,
    length: f64,
    density: f64,
}

impl Impact {
    fn from_scene(scene: &Scene) -> Self {
        let body = &scene.bodies[0];
        let (low, high) = body.shape.corners();
        let modulus = scene.deformable[0].map_or(f64::NAN, |material| material.longitudinal_modulus());
        Self {
            speed: body.velocity.x,
            wave: (modulus / body.density).sqrt(),
            length: high.x - low.x,
            density: body.density,
        }
    }

    /// Returns the velocity of the right bar's centre of mass (m/s) at a time (s).
    fn velocity(&self, time: f64) -> f64 {
        self.speed * (0.5 * time * self.wave / self.length).min(1.0)
    }

    fn stress(&self) -> f64 {
        0.5 * self.density * self.wave * self.speed
    }
}

/// Returns the width of a wave front after a path length 2L, divided by 2L.
fn width(resolution: Resolution) -> f64 {
    let Resolution::Grid { cells, .. } = resolution else { return f64::NAN };
    front(0.5 / cells, 1.0)
}

/// Momentum that the contact has yet to transfer when half of a front has arrived, in units of the front's width.
const LEFT_BEHIND: f64 = 0.446_522_992_649_999_3;

/// Returns the mean stress (Pa) in the middle of the right bar from 0.7 to 1.3 transit times L/c.
fn plateau(done: &FinishedRun) -> Result<f64, MissingData> {
    let impact = Impact::from_scene(&done.scene);
    let transit = impact.length / impact.wave;
    let mut stress = samples(done, "middle.sigma_xx")?;
    stress.retain(|(time, _)| (0.7 * transit..=1.3 * transit).contains(time));
    if stress.is_empty() {
        return Err("samples".into());
    }
    Ok(stress.iter().map(|(_, stress)| stress).sum::<f64>() / stress.len() as f64)
}

fn softer() -> Control {
    Control::scene("a tenth softer", |scene| stiffen(scene, 0.9))
}

fn claims() -> Vec<Claim> {
    let of_level = |level: &Level| {
        let run = || Run::new(PLAIN, "mpm", level.resolution);
        let width = width(level.resolution);
        [
            claim(format!("velocity of the right bar, worst, {} cells", level.name), "m/s")
                .run(run())
                .follows(
                    SOURCE,
                    |done| samples(done, "right.vx"),
                    |done, time| Impact::from_scene(&done.scene).velocity(time),
                    |done| Impact::from_scene(&done.scene).speed,
                )
                .within(computed(
                    2.0 * AHEAD * width,
                    "the grid disperses the front, so part of it arrives early: 2 (−Ai'(0)) δ/2L at the arrival time \
                     (derivation); in units of v",
                ))
                .refuses(softer().coarser(LEVELS[0].resolution))
                .solver_independent_continuum()
                .drawn(&VELOCITY, level.name),
            claim(format!("velocity of the left bar in the end, {} cells", level.name), "m/s")
                .run(run())
                .equals(SOURCE, |done| {
                    Ok(Measurement::new(done[0].last("left.vx")?, 0.0, Impact::from_scene(&done[0].scene).speed))
                })
                .within(computed(
                    LEFT_BEHIND * width,
                    "the bars separate when half of the dispersed front has arrived, before the contact has \
                     transferred all momentum: .447 δ/2L (derivation); in units of v",
                ))
                .refuses(
                    Control::scene("the right bar twice as dense", |scene| scene.bodies[1].density *= 2.0)
                        .coarser(LEVELS[0].resolution),
                )
                .solver_independent_continuum(),
        ]
    };
    let stress = claim("stress in the middle of the right bar, mean over .6 L/c", "Pa")
        .run(Run::new(PLAIN, "mpm", LEVELS[1].resolution))
        .equals(Source::Derived("σ = ρ c v/2 (derivation)"), |done| {
            let exact = -Impact::from_scene(&done[0].scene).stress();
            Ok(Measurement::new(plateau(&done[0])?, exact, -exact))
        })
        .within(estimated(0.015, "oscillation behind a discontinuous front"))
        .refuses(softer())
        .solver_independent_continuum();
    LEVELS.iter().flat_map(of_level).chain([stress]).collect()
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut stresses = Vec::new();
    for (solver, level) in [("mpm", LEVELS[0]), ("mpm", LEVELS[1]), ("mpm:gap", LEVELS[1])] {
        let done = runner.run(&Run::new(PLAIN, solver, level.resolution))?;
        let unit = Impact::from_scene(&done.scene).stress();
        let stress = samples(&done, "middle.sigma_xx").unwrap_or_default();
        let points = stress.into_iter().map(|(time, stress)| (time, stress / unit)).collect();
        stresses.push(Curve::new(format!("{solver}, {}", level.name), Stroke::Line, points));
    }
    let jump = vec![(0.0, 0.0), (0.5, 0.0), (0.5, -1.0), (1.5, -1.0), (1.5, 0.0), (3.0, 0.0)];
    stresses.push(Curve::new("exact", Stroke::Dashed, jump));
    Ok(vec![Figure::graph(
        "stress",
        "Stress in the middle of the right bar",
        "The exact wave front is a jump. Stresses on a grid oscillate behind it. L/20 and L/40 are cell lengths.",
        [Axis::linear("time t (s); L/c = 1 s"), Axis::linear("stress / (ρcv/2)")],
        stresses,
    )])
}
