//! A linear chain of beads, driven at one end.

mod bessel;

use crate::rows::rigid;
use grainbench_harness::prelude::*;

const LEVELS: &[Level] =
    &[fraction("dt=.1", 0.1), fraction("dt=.05", 0.05), fraction("dt=.025", 0.025), fraction("dt=.0125", 0.0125)];
const FINEST: Level = LEVELS[3];
const BEADS: [(usize, &str); 6] =
    [(5, "v5.vx"), (10, "v10.vx"), (15, "v15.vx"), (18, "v18.vx"), (20, "v20.vx"), (22, "v22.vx")];
const BESSEL: Source = Source::Derived("v_n = V∫(2n/s)J_2n(s)ds over 0 to 2ω₀t (derivation)");

const CONVERGENCE: ClaimFigure = ClaimFigure {
    name: "convergence",
    title: "Error over the time step",
    caption: "Root mean square error of the velocities of beads 5, 10, 15, 18, 20 and 22 at ω₀t = 20. The order of \
              convergence is 2.",
    axes: ["time step Δt (s)", "rms error / V"],
    logarithmic: true,
};

pub(crate) static CASE: Case = crate::heads::CHAIN.with(LEVELS, 3, &claims).drawn_by(figures);

fn run(level: Level) -> Run {
    Run::new(PLAIN, "dem", level.resolution)
}

/// Returns the driving speed V (m/s), ω₀ (rad/s) and the impedance √(km) (N s/m).
fn chain(scene: &Scene) -> (f64, f64, f64) {
    let stiffness = scene.laws.iter().flatten().map(|law| law.normal_stiffness()).fold(0.0, f64::max);
    let mass = scene.grains[0].mass;
    (scene.walls[0].motion.phases[0].velocity.x, (stiffness / mass).sqrt(), (stiffness * mass).sqrt())
}

fn bead(done: &FinishedRun, n: usize, column: &str) -> Result<Measurement, MissingData> {
    let (speed, omega, _) = chain(&done.scene);
    let time = done.series().time.last().copied().unwrap_or_default();
    Ok(Measurement::new(done.last(column)?, speed * bessel::velocity(n, 2.0 * omega * time), speed))
}

fn claims() -> Vec<Claim> {
    let heavier = || Control::grains("beads half a percent too heavy", |grain| grain.mass *= 1.005);
    let at_bead = |(n, column): (usize, &'static str)| {
        claim(format!("velocity of bead {n} at 20/ω₀"), "m/s")
            .run(run(FINEST))
            .equals(BESSEL, move |done| bead(&done[0], n, column))
            .within(estimated(4e-4, "numerical dispersion of central differences at this step, in units of V"))
            .refuses(heavier())
            .solver_independent()
    };
    let order = claim("order in Δt, rms over the six beads", "1")
        .runs(LEVELS.iter().map(|&level| run(level)))
        .fits(2.0, Source::Derived("central differences are of second order"), |done| {
            Ok((done.record.provenance.time_step, rms(done)?))
        })
        .within(asymptotic(2.0))
        .refuses(heavier())
        .drawn(&CONVERGENCE, "dem");
    let force = claim("mean force on the driver over the last half", "N")
        .run(run(FINEST))
        .equals(Source::Derived("impedance of the chain, V√(km)"), |done| {
            let (speed, _, impedance) = chain(&done[0].scene);
            let force = done[0].column("driver.force_x")?;
            Ok(Measurement::relative(-mean(&force[force.len() / 2..]), speed * impedance))
        })
        .within(computed(
            2.0 * (2.0 / PI).sqrt() * 20_f64.powf(-2.5),
            "the force oscillates about the impedance by √(2/π) x^(−3/2), x = 2ω₀t; the mean from x = 20 to 40 \
             contains at most one uncancelled half wave, 2√(2/π) 20^(−5/2)",
        ))
        .refuses(Control::contact_law("contacts 2 % too stiff", |law| law.scale_normal(1.02)))
        .solver_independent();
    // Rigid beads have no dispersion. If many beads are in contact at once, the solution is not unique.
    let rigid = claim("velocity of bead 22 at 20/ω₀", "m/s")
        .run(Run::new(PLAIN, "rigid", rigid::DEFAULT).known(
            "contacts are rigid: an impulse passes through all beads in one step, and its distribution over beads in contact \
             depends on the solution order of the engine",
        )
        .up_to(2.0))
        .equals(BESSEL, |done| bead(&done[0], 22, "v22.vx"))
        .within(judged(4e-4, "accuracy of a solver with springs, in units of V"))
        .refuses(Control::without_the_error("dem in its place", "dem", FINEST.resolution));
    BEADS.into_iter().map(at_bead).chain([order, force, rigid]).collect()
}

/// Returns the root mean square error of the velocities of the six beads, in units of V.
fn rms(done: &FinishedRun) -> Result<f64, MissingData> {
    let errors: Result<Vec<f64>, MissingData> =
        BEADS.into_iter().map(|(n, column)| Ok(bead(done, n, column)?.error())).collect();
    Ok((errors?.iter().map(|error| error * error).sum::<f64>() / BEADS.len() as f64).sqrt())
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let done = runner.run(&run(FINEST))?;
    let (speed, omega, _) = chain(&done.scene);
    let mut profiles = Vec::new();
    for snapshot in done.record.snapshots.iter().skip(1) {
        let points =
            snapshot.grains.iter().take(32).map(|grain| (f64::from(grain.id), grain.velocity.x / speed)).collect();
        profiles.push(Curve::new(format!("ω₀t = {:.0}, dem", omega * snapshot.time), Stroke::Markers, points));
    }
    for snapshot in done.record.snapshots.iter().skip(1) {
        let x = 2.0 * omega * snapshot.time;
        let points = (1..=32).map(|n| (n as f64, bessel::velocity(n, x))).collect();
        let label = format!("ω₀t = {:.0}, exact", omega * snapshot.time);
        profiles.push(Curve::new(label, Stroke::Dashed, points));
    }
    Ok(vec![Figure::graph(
        "profile",
        "Velocity along the chain",
        "The front moves one bead per 1/ω₀ and leaves a dispersive tail. `dem` (markers) is compared with the exact \
         solution in Bessel functions (dashes).",
        [Axis::linear("bead n"), Axis::linear("velocity v / V")],
        profiles,
    )])
}
