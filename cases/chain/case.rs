//! A linear chain, driven at one end.

#[path = "bessel.rs"]
mod bessel;

use crate::bench::Bench;
use crate::case::{Case, PLAIN, Rung, fraction};
use crate::figure::{Axis, Curve, Drawing, Figure, Graph, Stroke};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run, measure};
use crate::measure::slope;
use crate::rigid_rows;
use crate::scope::Scope;
use crate::verdict::Evidence;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::RunError;

const LADDER: &[Rung] =
    &[fraction("dt=.1", 0.1), fraction("dt=.05", 0.05), fraction("dt=.025", 0.025), fraction("dt=.0125", 0.0125)];
const FINEST: Rung = LADDER[3];
const BEADS: [(usize, &str); 6] = [(5, "v5.vx"), (10, "v10.vx"), (15, "v15.vx"), (18, "v18.vx"), (20, "v20.vx"), (22, "v22.vx")];
const SOURCE: &str = "v_n = V∫(2n/s)J_2n(s)ds over 0 to 2ω₀t (derivation)";

pub(crate) static CASE: Case = Case {
    name: "chain",
    title: "A linear chain, driven at one end",
    claim: "A disturbance travels along a chain of discs with the dispersion of the discrete lattice: bead velocities follow \
            the Bessel answer to second order in Δt.",
    scene: include_str!("scene.toml"),
    derivation: include_str!("derivation.md"),
    weakness: "One dimension, frictionless, linear: contacts never open and grains never turn. It tests transport along many \
               contacts, not their law.",
    ladder: LADDER,
    default_rung: LADDER[3],
    gates,
    figures,
};

fn run(rung: Rung) -> Run {
    Run::new(PLAIN, "dem", rung.resolution)
}

/// Driving speed V (m/s), ω₀ (rad/s) and impedance √(km) (N s/m).
fn chain(scene: &Scene) -> (f64, f64, f64) {
    let stiffness = scene.laws.iter().flatten().map(|law| law.normal_stiffness).fold(0.0, f64::max);
    let mass = scene.grains[0].mass;
    (scene.walls[0].motion.phases[0].velocity.x, (stiffness / mass).sqrt(), (stiffness * mass).sqrt())
}

fn bead(done: &Done, n: usize, column: &str) -> Result<Measured, Missing> {
    let (speed, omega, _) = chain(&done.scene);
    let time = done.series().time.last().copied().unwrap_or_default();
    Ok(Measured::new(done.last(column)?, speed * bessel::velocity(n, 2.0 * omega * time), speed))
}

fn gates() -> Vec<Gate> {
    let heavier = || {
        Control::scene("beads half a percent too heavy", |scene: &mut Scene| {
            scene.grains.iter_mut().for_each(|grain| grain.mass *= 1.005);
        })
    };
    let at_bead = |(n, column): (usize, &'static str)| Gate {
        quantity: format!("velocity of bead {n} at 20/ω₀"),
        unit: "m/s",
        evidence: Evidence::Analytic,
        scope: Scope::AnySolver,
        source: SOURCE,
        allowed: 4e-4,
        because: "numerical dispersion of central differences at this step, in units of V",
        runs: vec![run(FINEST)],
        measure: measure(move |done| bead(&done[0], n, column)),
        control: heavier(),
    };
    let order = Gate {
        quantity: "order in Δt, rms over the six beads".to_owned(),
        unit: "1",
        evidence: Evidence::Convergence,
        scope: Scope::Named,
        source: "central differences are of second order",
        allowed: 0.05,
        because: "fitted over three halvings",
        runs: LADDER.iter().map(|&rung| run(rung)).collect(),
        measure: measure(|done| {
            let points: Result<Vec<(f64, f64)>, Missing> =
                done.iter().map(|done| Ok((done.record.provenance.time_step, rms(done)?))).collect();
            Ok(Measured::new(slope(&points?), 2.0, 1.0))
        }),
        control: heavier(),
    };
    let force = Gate {
        quantity: "mean force on the driver over the last half".to_owned(),
        unit: "N",
        evidence: Evidence::Analytic,
        scope: Scope::AnySolver,
        source: "impedance of the chain, V√(km)",
        allowed: 1e-3,
        because: "the force rings about the impedance with J₀ and J₁ of 2ω₀t; the mean keeps a part",
        runs: vec![run(FINEST)],
        measure: measure(|done| {
            let (speed, _, impedance) = chain(&done[0].scene);
            let force = done[0].column("driver.force_x")?;
            let half = &force[force.len() / 2..];
            let mean = half.iter().sum::<f64>() / half.len() as f64;
            Ok(Measured::new(-mean, speed * impedance, speed * impedance))
        }),
        control: Control::scene("contacts 2 % too stiff", |scene| {
            scene.change_laws(|law| law.normal_stiffness *= 1.02);
        }),
    };
    BEADS.into_iter().map(at_bead).chain([order, force, rigid()]).collect()
}

/// Rigid beads have no dispersion, and no unique answer either: many beads touch at once.
fn rigid() -> Gate {
    Gate {
        quantity: "velocity of bead 22 at 20/ω₀".to_owned(),
        unit: "m/s",
        evidence: Evidence::Analytic,
        scope: Scope::Named,
        source: SOURCE,
        allowed: 4e-4,
        because: "what a solver with springs reaches, in units of V",
        runs: vec![Run::new(PLAIN, "rigid", rigid_rows::DEFAULT).known(
            "contacts are rigid: an impulse passes through all beads in one step, and how many beads that touch at once share \
             it is up to the order in which the engine solves them",
        )],
        measure: measure(|done| bead(&done[0], 22, "v22.vx")),
        control: Control::without_the_error("dem in its place", "dem", FINEST.resolution),
    }
}

/// Root mean square error of the six beads in units of V.
fn rms(done: &Done) -> Result<f64, Missing> {
    let errors: Result<Vec<f64>, Missing> =
        BEADS.into_iter().map(|(n, column)| Ok(bead(done, n, column)?.error())).collect();
    Ok((errors?.iter().map(|error| error * error).sum::<f64>() / BEADS.len() as f64).sqrt())
}

fn figures(bench: &Bench) -> Result<Vec<Figure>, RunError> {
    let done = bench.run(&run(FINEST))?;
    let (speed, omega, _) = chain(&done.scene);
    let curve = |label: String, stroke, points| Curve { label, stroke, points };
    let mut profiles = Vec::new();
    for snapshot in done.record.snapshots.iter().skip(1) {
        let points = snapshot.grains.iter().take(32).map(|grain| (f64::from(grain.id), grain.velocity.x / speed)).collect();
        profiles.push(curve(format!("ω₀t = {:.0}, dem", omega * snapshot.time), Stroke::Markers, points));
    }
    for (at, snapshot) in done.record.snapshots.iter().skip(1).enumerate() {
        let x = 2.0 * omega * snapshot.time;
        let points = (1..=32).map(|n| (n as f64, bessel::velocity(n, x))).collect();
        let label = if at == 0 { "exact".to_owned() } else { format!("exact, {:.0}", omega * snapshot.time) };
        profiles.push(curve(label, Stroke::Dashed, points));
    }
    let mut errors = Vec::new();
    for &rung in LADDER {
        let done = bench.run(&run(rung))?;
        if let (Ok(rms), Some(critical)) = (rms(&done), done.record.provenance.critical_time_step) {
            errors.push((done.record.provenance.time_step / critical, rms));
        }
    }
    let axis = |label: &str, logarithmic| Axis { label: label.to_owned(), logarithmic };
    let figure = |name: &str, title: &str, caption: &str, x, y, curves| Figure {
        name: name.to_owned(),
        title: title.to_owned(),
        caption: caption.to_owned(),
        drawing: Drawing::Graph(Graph { x, y, curves }),
    };
    Ok(vec![
        figure(
            "profile",
            "Velocity along the chain",
            "The front moves one bead per 1/ω₀ and leaves a dispersive tail; markers dem, dashes the Bessel answer.",
            axis("bead n", false),
            axis("velocity v / V", false),
            profiles,
        ),
        figure(
            "convergence",
            "Error against the step",
            "Root mean square over beads 5, 10, 15, 18, 20 and 22 at ω₀t = 20.",
            axis("Δt / critical step", true),
            axis("rms error / V", true),
            vec![
                curve("dem".to_owned(), Stroke::MarkedLine, errors),
                curve("slope 2".to_owned(), Stroke::Dashed, vec![(0.0125, 3e-4), (0.1, 3e-4 * 64.0)]),
            ],
        ),
    ])
}
