//! A solitary wave in a chain of Hertz spheres.

use crate::rows::programs::forces;
use crate::rows::rigid;
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[fraction("dt=.04", 0.04), fraction("dt=.02", 0.02)];
/// Coefficient of the wave speed in the discrete chain. The test at the end of this file computes it.
const COEFFICIENT: f64 = 0.688_672_8;
/// Speeds of the striker (m/s).
const SPEEDS: [f64; 4] = [0.3, 1.0, 3.0, 10.0];
/// Number of beads between the two probed contacts.
const BEADS: f64 = 40.0;

pub(crate) static CASE: Case = crate::heads::HERTZ_CHAIN.with(LEVELS, 1, &claims).drawn_by(figures);

/// Returns the run for a speed of the striker (m/s). The duration scales with the travel time of the wave, the time step
/// with the stiffness at the overlap of the wave, Δt ∝ v^{-1/5}. The critical time step refers to the overlap R/100.
fn strike(speed: f64) -> Run {
    let resolution = Resolution::CriticalFraction(0.02 * speed.powf(-0.2));
    Run::new(PLAIN, "dem", resolution).adjusted(&format!("striker at {speed} m/s"), move |scene| {
        if let Some(striker) = scene.grains.last_mut() {
            striker.velocity.x = speed;
        }
        if let Duration::Seconds(duration) = scene.duration {
            scene.duration = Duration::Seconds(4.0 * duration * speed.powf(-0.2));
        }
    })
}

/// Returns time (s) and height (N) of the peak of a force, by a parabola through the highest sample and its neighbours.
fn peak(done: &FinishedRun, column: &str) -> Result<(f64, f64), MissingData> {
    let (time, values) = (&done.series().time, done.column(column)?);
    let at = (1..values.len() - 1).max_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(1);
    let (left, top, right) = (values[at - 1], values[at], values[at + 1]);
    let bend = left - 2.0 * top + right;
    let shift = if bend < 0.0 { 0.5 * (left - right) / bend } else { 0.0 };
    Ok((time[at] + shift * (time[at] - time[at - 1]), top - 0.25 * (left - right) * shift))
}

/// Returns the speed of the wave (m/s) between the two probed contacts, and its mean peak force there (N).
fn wave(done: &FinishedRun) -> Result<(f64, f64), MissingData> {
    let (near, far) = (peak(done, "near.normal_force")?, peak(done, "far.normal_force")?);
    let distance = BEADS * 2.0 * done.scene.grains[0].radius;
    Ok((distance / (far.0 - near.0), 0.5 * (near.1 + far.1)))
}

/// Returns the scale (2E/(2Rρ^{3/2}(1−ν²)))^{1/3}, with E/(1−ν²) = 2E* between equal spheres.
fn scale(scene: &Scene) -> f64 {
    let law = scene.laws.iter().flatten().next().copied().unwrap_or_default();
    let grain = &scene.grains[0];
    let density = grain.mass / (4.0 / 3.0 * PI * grain.radius.powi(3));
    (4.0 * law.effective_modulus() / (2.0 * grain.radius * density.powf(1.5))).cbrt()
}

/// Returns the wave speed divided by [`scale`] and by the sixth root of the peak force.
fn coefficient(done: &FinishedRun) -> Result<f64, MissingData> {
    let (speed, force) = wave(done)?;
    Ok(speed / (scale(&done.scene) * force.powf(1.0 / 6.0)))
}

fn claims() -> Vec<Claim> {
    let exponent = claim("exponent of the speed in the force", "1")
        .runs(SPEEDS.map(strike))
        .scales(1.0 / 6.0, 1.0 / 6.0, Source::Derived("scaling of F = kδ^{3/2} (derivation)"), |done| {
            wave(done).map(|(speed, force)| (force, speed))
        })
        .within(rounding(
            7.0,
            "the discretisation of the pulse is the same at every speed; rounding of speeds and forces, which counts \
             seven sixths in an exponent",
        ))
        .refuses(Control::contact_law("a dashpot of γ = 2000/s, which does not scale", |law| {
            law.normal_damping = 2000.0
        }));
    let of_speed = claim("coefficient of the speed", "1")
        .run(strike(1.0))
        .equals(Source::Derived("travelling wave of the discrete chain (derivation)"), |done| {
            Ok(Measurement::relative(coefficient(&done[0])?, COEFFICIENT))
        })
        .within(estimated(2e-5, "discretisation of the pulse; the long-wave limit has an error of 1.2 %"))
        .refuses(Control::contact_law("E* 1 % too large", |law| law.scale_normal(1.01)));
    let rigid = claim("refusal of forces over time", "1").run(Run::new(PLAIN, "rigid", rigid::DEFAULT)).refused(
        "momentum passes through rigid beads in one step, so there is no wave with a largest force",
        Control::scene("no probes", |scene| scene.probes.clear()),
    );
    // The runs end when the wave has passed. Afterwards the beads separate and have no contacts.
    let sampled = |solver| {
        Run { solver, ..strike(1.0) }.adjusted("until the wave has passed, every 20 cycles", |scene| {
            scene.sampling = Sampling::Cycles(20);
            if let Duration::Seconds(duration) = scene.duration {
                scene.duration = Duration::Seconds(1.75 * duration);
            }
        })
    };
    let programs = forces(sampled, &["near.normal_force", "far.normal_force"], |scene| {
        // Typical force of a contact in the wave: k δ^{3/2} at the largest overlap of two beads that collide at the
        // striker's speed.
        let (law, grain) = (scene.laws.iter().flatten().next().copied().unwrap_or_default(), &scene.grains[0]);
        let k = 4.0 / 3.0 * law.effective_modulus() * (0.5 * grain.radius).sqrt();
        let speed = scene.grains.last().map_or(0.0, |striker| striker.velocity.norm());
        k * (5.0 * grain.mass * speed * speed / (8.0 * k)).powf(0.6)
    });
    [exponent, of_speed, rigid].into_iter().chain(programs).collect()
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut measured = Vec::new();
    for speed in SPEEDS {
        let done = runner.run(&strike(speed))?;
        measured.extend(coefficient(&done).ok().zip(wave(&done).ok()).map(|(found, (_, force))| (force, found)));
    }
    let level = |coefficient: f64| measured.iter().map(|(force, _)| (*force, coefficient)).collect();
    let (discrete, long_wave) = (level(COEFFICIENT), level(0.680_24));
    Ok(vec![Figure::graph(
        "speed",
        "Coefficient of the speed of the solitary wave",
        "Steel beads of 20 mm. The coefficient is the speed over (4E*/(2Rρ^(3/2)))^(1/3) F^(1/6), with the peak \
         force F of the wave. It does not depend on F for Hertz contacts. `dem` is compared with the values of a \
         discrete chain and of the long-wave limit (dashes).",
        [Axis::log("peak force F (N)"), Axis::linear("coefficient of the speed (1)")],
        vec![
            Curve::new("dem", Stroke::Markers, measured),
            Curve::new("discrete chain, 0.68867", Stroke::Dashed, discrete),
            Curve::new("long-wave limit, 0.68024", Stroke::Dashed, long_wave),
        ],
    )])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the wave speed in sites per time for a largest force 1 and k = m = 1, by iteration with `cells` points
    /// per site. The overlap r(ξ) obeys c² r(ξ) = ∫ (1 − |s|) r(ξ + s)^{3/2} ds over |s| < 1.
    fn sites_per_time(cells: usize) -> f64 {
        let step = 1.0 / cells as f64;
        let mut overlap: Vec<f64> = (0..=6 * cells).map(|at| (-(at as f64 * step).powi(2)).exp()).collect();
        let mut square = 0.0;
        for _ in 0..60 {
            let force = |at: isize| overlap.get(at.unsigned_abs()).copied().unwrap_or(0.0).powf(1.5);
            let reach = cells as isize;
            let mean = |at: isize| -> f64 {
                (-reach..=reach).map(|s| (1.0 - s.unsigned_abs() as f64 * step) * force(at + s) * step).sum()
            };
            let next: Vec<f64> = (0..overlap.len()).map(|at| mean(at as isize)).collect();
            square = next[0];
            overlap = next.iter().map(|value| value / square).collect();
        }
        square.sqrt()
    }

    /// Checks the coefficient of V = 2R c (k^{2/3} F^{1/3}/m)^{1/2}, k = (4/3) E* √(R/2), which is .76053 c.
    #[test]
    fn the_travelling_wave_has_the_coefficient() {
        let [coarse, fine] = [10, 20].map(sites_per_time);
        let sites = fine + (fine - coarse) / 3.0;
        let (stiffness, mass) = (4.0 / 3.0 * 0.5_f64.sqrt(), 4.0 / 3.0 * PI);
        let coefficient = 2.0 * sites * (stiffness.powf(2.0 / 3.0) / mass).sqrt() / 2_f64.cbrt();
        assert!((sites - 0.905_515_8).abs() < 1.5e-7, "{sites}");
        assert!((coefficient - COEFFICIENT).abs() < 1e-7, "{coefficient}");
    }
}
