//! Energy conservation of a hundred elastic discs in a box.

use crate::rows::rigid;
use grainbench_harness::prelude::*;
use grainbench_scene::scene::Duration;

const LEVELS: &[Level] = &[fraction("dt=.1", 0.1), fraction("dt=.03", 0.03), fraction("dt=.01", FINEST)];

pub(crate) static CASE: Case =
    Case { levels: LEVELS, default_level: LEVELS[2], claims: &claims, figures, ..crate::heads::DISC_GAS };

/// Time steps of the runs in the figure, as fractions of the critical time step.
const FRACTIONS: [f64; 3] = [0.1, 0.03, FINEST];
const FINEST: f64 = 0.01;

/// Returns the run at a time step. The simulated time is the same for each time step: 10⁵ of the finest steps.
fn run(fraction: f64) -> Run {
    let cycles = (1e5 * FINEST / fraction).round() as u64;
    Run::new(PLAIN, "dem", Resolution::CriticalFraction(fraction)).adjusted(&format!("{cycles} cycles"), move |scene| {
        scene.duration = Duration::Cycles(cycles);
    })
}

fn energy(done: &FinishedRun) -> Result<Measurement, MissingData> {
    let energy = done.column("all.total_energy")?;
    Ok(Measurement::drift(&done.series().time, energy, energy[0]))
}

fn claims() -> Vec<Claim> {
    let conserved = claim("total energy over 10⁵ steps, worst", "J")
        .run(run(FINEST))
        .holds("conservation of energy", |done| energy(&done[0]))
        .within(estimated(
            1e-4,
            "the kink of the force where contacts begin and end, at a hundredth of the critical step",
        ))
        .refuses(Control::scene("dashpots of 1e-3 of critical", |scene| {
            let law = scene.laws[0].unwrap_or_default();
            let rate = 2e-3 * (law.normal_stiffness() / scene.grains[0].mass).sqrt();
            scene.change_laws(|law| law.normal_damping = rate);
        }))
        .fair_to_any();
    let kept_in = claim("number of discs in the box in the end", "1")
        .run(run(FINEST))
        .holds("walls keep the discs in", |done| {
            let snapshot = done[0].record.snapshots.last().ok_or_else(|| MissingData("snapshot".to_owned()))?;
            let inside = |x: f64| (0.0..=40.0).contains(&x);
            let count =
                snapshot.grains.iter().filter(|grain| inside(grain.position.x) && inside(grain.position.y)).count();
            Ok(Measurement::new(count as f64, done[0].scene.grains.len() as f64, 1.0))
        })
        .within(exactly("a count"))
        .refuses(Control::scene("one wall missing", |scene| {
            scene.walls.pop();
        }))
        .fair_to_any();
    vec![conserved, kept_in, rigid::refuses_cycles(PLAIN), rigid::gas_energy(PLAIN, 9.0, energy)]
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for fraction in FRACTIONS {
        let done = runner.run(&run(fraction))?;
        let energy = done.series().column("all.total_energy").unwrap_or_default();
        let samples = energy.len().div_ceil(400).max(1);
        let points = done.series().time.iter().zip(energy).step_by(samples);
        let points = points.map(|(t, e)| (*t, (e / energy[0] - 1.0) * 1e3)).collect();
        curves.push(Curve::new(format!("Δt = {fraction} of critical"), Stroke::Line, points));
    }
    Ok(vec![Figure::graph(
        "energy",
        "Drift of the total energy",
        "Relative error of the total energy at three time steps, over the same simulated time. Spikes occur during \
         impacts. Jumps are the lasting error after an impact.",
        [Axis::linear("time t (s)"), Axis::linear("(E − E₀)/E₀ (10⁻³)")],
        curves,
    )])
}
