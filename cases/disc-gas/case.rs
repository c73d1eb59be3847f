//! Energy conservation of a hundred elastic discs in a box.

use crate::rows::rigid;
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[fraction("dt=.1", 0.1), fraction("dt=.03", 0.03), fraction("dt=.01", FINEST)];

pub(crate) static CASE: Case = crate::heads::DISC_GAS.with(LEVELS, 2, &claims).drawn_by(figures);

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
    Measurement::drift_of(done, "all.total_energy")
}

fn claims() -> Vec<Claim> {
    let conserved = claim("total energy over 10⁵ steps, worst", "J")
        .run(run(FINEST))
        .holds("conservation of energy", |done| energy(&done[0]))
        .within(estimated(
            1e-4,
            "the kink of the force where contacts begin and end, at a hundredth of the critical step",
        ))
        .refuses(Control::scene("dashpots of 1e-3 of critical", |scene| damp(scene, 2e-3)))
        .solver_independent();
    let kept_in = claim("number of discs in the box in the end", "1")
        .run(run(FINEST))
        .holds("walls keep the discs in", |done| {
            let snapshot = done[0].record.snapshots.last().ok_or("snapshot")?;
            let inside = |x: f64| (0.0..=40.0).contains(&x);
            let count =
                snapshot.grains.iter().filter(|grain| inside(grain.position.x) && inside(grain.position.y)).count();
            Ok(Measurement::new(count as f64, done[0].scene.grains.len() as f64, 1.0))
        })
        .within(exactly("a count"))
        .refuses(Control::scene("one wall missing", |scene| {
            scene.walls.pop();
        }))
        .solver_independent();
    vec![conserved, kept_in, rigid::refuses_cycles(PLAIN), by_impulses()]
}

/// Returns the claim on the energy with the solver `rigid`, which does not support a duration in cycles.
fn by_impulses() -> Claim {
    let run = Run::new(PLAIN, "rigid", rigid::DEFAULT).adjusted("9 s", |scene| scene.duration = Duration::Seconds(9.0));
    claim("total energy over 9 s, worst", "J")
        .run(run)
        .holds("conservation of energy", |done| energy(&done[0]))
        .within(judged(
            1.5e-2,
            "single impacts conserve the energy to rounding. If a disc hits two discs in one step, the two approach \
             velocities are reversed one after the other, and the second reversal undoes a part of the first one. This \
             happens once in this run; smaller steps make the error rarer, not smaller",
        ))
        .refuses(Control::scene("dashpots of a hundredth of critical", |scene| {
            damp(scene, 2e-2);
            scene.duration = Duration::Seconds(0.2 * 9.0);
        }))
}

/// Sets the dashpots to a rate of `part` times √(k_n/m).
fn damp(scene: &mut Scene, part: f64) {
    let law = scene.laws[0].unwrap_or_default();
    let rate = part * (law.normal_stiffness() / scene.grains[0].mass).sqrt();
    scene.change_laws(|law| law.normal_damping = rate);
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for fraction in FRACTIONS {
        let done = runner.run(&run(fraction))?;
        let energy = samples(&done, "all.total_energy").unwrap_or_default();
        let off = |&(t, value): &(f64, f64)| (t, (value / energy[0].1 - 1.0) * 1e3);
        let points = thinned(energy.iter().map(off).collect(), 400);
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
