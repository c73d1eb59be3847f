//! Photoelastic fringes in the discs at the paper's frame times, and an animation of the line.
//!
//! The paper chose its fringe constant f by eye from its own pictures of the line and does not print it. Here f is
//! fitted once, also to the line. In the last frame of the line, the first grey fringe, cos(Δσ/f) = 0, is at the centre of
//! the fourth disc. The zig-zags use the same f.

use super::WAVE_SPEED;
use super::elastic::{grid, principal_difference, run};
use grainbench_fields::picture::{Shot, film, pictures};
use grainbench_fields::quantity::Quantity;
use grainbench_harness::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// Chain of discs in the paper, with the times and observations of its figure.
struct Chain {
    variant: &'static str,
    title: &'static str,
    /// Times of the frames in the paper's simulation, in transits of a disc.
    frames: [f64; 3],
    /// Times of the frames in the paper's experiment, in transits of a disc.
    experiment: [f64; 3],
    /// Observation of the paper in these frames, for the caption.
    seen: &'static str,
}

/// Chains of Figs 9, 10 and 11 of the paper.
const CHAINS: [Chain; 3] = [
    Chain {
        variant: "line",
        title: "four discs in a line, Fig. 9",
        frames: [2.2, 5.5, 7.7],
        experiment: [2.6, 6.6, 9.2],
        seen: "The fringes cross the contacts one after the other.",
    },
    Chain {
        variant: "zig-zag",
        title: "zig-zag, μ = 0.5, Fig. 10",
        frames: [3.0, 6.0, 9.0],
        experiment: [5.3, 10.5, 15.8],
        seen: "As in the paper, the load first goes from the contact to the wall, and passes to the next disc when its \
               contact sticks.",
    },
    Chain {
        variant: "zig-zag-glued",
        title: "glued zig-zag, Fig. 11",
        frames: [1.4, 3.6, 5.8],
        experiment: [1.6, 4.2, 6.8],
        seen: "As in the paper, the load first goes from contact to contact, and later to the walls.",
    },
];
/// Number of frames of the animation, a quarter of a transit apart.
const FILM: u32 = 44;
const PIXELS: u32 = 720;
const FILM_PIXELS: u32 = 400;

/// Returns the transit time of a disc, d/c (s).
fn transit(scene: &Scene) -> f64 {
    2.0 * scene.grains[0].radius / WAVE_SPEED
}

/// Returns the times of the snapshots of a variant (s).
pub(super) fn times(scene: &Scene, variant: &str) -> Vec<f64> {
    let frames = CHAINS.iter().filter(|chain| chain.variant == variant).flat_map(|chain| chain.frames);
    let film = (1..=FILM).map(|frame| 0.25 * f64::from(frame)).filter(|_| variant == "line");
    frames.chain(film).map(|transits| transits * transit(scene)).collect()
}

/// Returns the snapshot nearest to a time in transits.
fn at(done: &FinishedRun, transits: f64) -> Option<&Snapshot> {
    let time = transits * transit(&done.scene);
    let away = |snapshot: &&Snapshot| (snapshot.time - time).abs();
    done.record.snapshots.iter().min_by(|a, b| away(a).total_cmp(&away(b)))
}

/// Returns the fringe constant (Pa) fitted to the line, as described at the top of this file.
fn constant(line: &FinishedRun) -> f64 {
    let time = CHAINS[0].frames[2] * transit(&line.scene);
    let sample = line.series().time.iter().position(|&sampled| sampled >= time).unwrap_or_default();
    principal_difference(line, 4).map_or(f64::NAN, |difference| difference(sample)) / FRAC_PI_2
}

/// Returns the fringes of all chains at the paper's times, and the animation.
pub(super) fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let (cells, points) = if runner.is_thorough() { (20.0, 2) } else { (8.0, 2) };
    let done = |variant| runner.run(&run(variant, "mpm", grid(cells, points), 15.0));
    let line = done("line")?;
    let constant = constant(&line);
    let quantity = Quantity::Fringes(constant);
    let resolution = format!(
        "{} cells per diameter, f = {:.3} ρcv. Regions without stress are bright. The striker is on the left; in the \
         paper it is on the right.",
        2.0 * cells,
        constant / impact_stress(&line)
    );
    let mut figures = Vec::new();
    for Chain { variant, title, frames, experiment, seen } in CHAINS {
        let done = done(variant)?;
        let shots: Vec<Shot<'_>> = frames
            .iter()
            .zip(experiment)
            .filter_map(|(&time, theirs)| {
                Some(Shot::new(format!("t c/d = {time} (in the experiment {theirs})"), at(&done, time)?))
            })
            .collect();
        figures.push(Figure::field(
            &format!("fringes-{variant}"),
            &format!("Fringes: {title}"),
            &format!(
                "Fringes cos((σ₁ − σ₂)/f) at the times of the paper's frames. {resolution} The stress f is fitted \
                 once: at t c/d = 7.7, the first grey fringe is at the centre of the fourth disc of the line. {seen}"
            ),
            pictures(quantity, &shots, PIXELS, None),
        ));
    }
    let clock: Vec<f64> = (1..=FILM).map(|frame| 0.25 * f64::from(frame)).collect();
    let frames: Vec<&Snapshot> = clock.iter().filter_map(|&time| at(&line, time)).collect();
    let moving =
        film(quantity, &[Shot { title: String::new(), frames }], ("time t c/d (1)", &clock), FILM_PIXELS, None);
    figures.push(Figure::field(
        "fringes-film",
        "Fringes along the line of four discs",
        &format!("Animation of the line of Fig. 9 from the impact on. {resolution}"),
        moving,
    ));
    Ok(figures)
}

/// Returns the impact stress ρcv of the striker (Pa).
fn impact_stress(done: &FinishedRun) -> f64 {
    let scene = &done.scene;
    let density = scene.grains[0].mass / (PI * scene.grains[0].radius.powi(2));
    density * WAVE_SPEED * scene.walls[0].motion.phases[0].velocity.norm()
}
