//! The worked example of Cundall & Strack (1979): two discs between two walls, with exact values of the calculation
//! cycle.

mod elastic;

use crate::rows::rigid;
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[fraction("dt=.05", 0.05)];
/// Rounding error of forces, in units of k v Δt: error of positions up to 4 R, over the wall's step of 1e-3 R.
const ROUNDING: f64 = 4.0 * f64::EPSILON / 1e-3;

const FORCES: ClaimFigure = ClaimFigure {
    name: "forces",
    title: "Forces at the walls and between the discs",
    caption: "Normal force at contact A (left wall and disc) and at contact B (between the discs), in each cycle. \
              The solver is compared with the closed solution of the paper's recurrence. The force at the wall grows \
              first. The disturbance reaches contact B later.",
    axes: ["time t (s); a cycle is Δt", "normal force (N)"],
    logarithmic: false,
};

pub(crate) static CASE: Case = crate::heads::SQUASH
    .with(LEVELS, 0, &claims)
    .drawn_by(|runner| Ok(vec![elastic::figure(runner)?]))
    .priced_by(targets);

fn run() -> Run {
    Run::new(PLAIN, "dem", LEVELS[0].resolution)
}

/// Returns q = kΔt²/m and the unit of force k v Δt (N), from the scene and the time step of the run.
fn units(done: &FinishedRun) -> (f64, f64) {
    let stiffness = done.scene.laws.iter().flatten().map(|law| law.normal_stiffness()).fold(0.0, f64::max);
    let time_step = done.record.provenance.time_step;
    let speed = done.scene.walls[0].motion.phases[0].velocity.norm();
    (stiffness * time_step * time_step / done.scene.grains[0].mass, stiffness * speed * time_step)
}

/// Returns the displacement of disc x after `n` cycles in units of vΔt.
fn displacement(n: f64, q: f64) -> f64 {
    let theta = 2.0 * ((3.0 * q).sqrt() / 2.0).asin();
    (n - (n * theta).sin() / theta.sin()) / 3.0
}

/// Returns the forces (F_A, F_B) of the first three cycles in units of k v Δt.
fn first_cycles(cycle: u32, q: f64) -> (f64, f64) {
    match cycle {
        1 => (1.0, 0.0),
        2 => (2.0 - q, 2.0 * q),
        _ => (3.0 - 4.0 * q + 3.0 * q * q, 8.0 * q - 6.0 * q * q),
    }
}

fn claims() -> Vec<Claim> {
    let of_cycle = |cycle: u32, contact: &'static str| {
        claim(format!("normal force at {contact}, cycle {cycle}"), "N")
            .run(run())
            .equals(Source::Derived("Cundall & Strack 1979, eqs. 1-7 (derivation)"), move |done| {
                let (q, unit) = units(&done[0]);
                let (side, middle) = first_cycles(cycle, q);
                let expected = if contact == "B" { middle } else { side };
                let force = done[0].at_step(&format!("{contact}.normal_force"), u64::from(cycle))?;
                Ok(Measurement::new(force, expected * unit, unit))
            })
            .within(computed(ROUNDING, "rounding of positions up to 4 R by ε; in units of k v Δt with v Δt = 1e-3 R"))
            .refuses(match (cycle, contact) {
                (1, "B") => Control::scene("the discs overlap by 1e-6 R at the start", |scene| {
                    scene.grains[1].position.x -= 1e-6;
                }),
                (3, _) => Control::grains("the mass of the discs off by a millionth", |grain| grain.mass *= 1.0 + 1e-6),
                (_, "C") => late("the right wall starts one cycle late", 1),
                _ => late("the left wall starts one cycle late", 0),
            })
    };
    let over_cycles = |contact: &'static str, force: fn(&FinishedRun, f64) -> f64| {
        claim(format!("normal force at {contact} over 200 cycles, worst"), "N")
            .run(run())
            .follows(
                Source::Derived("closed solution of the paper's recurrence (derivation)"),
                move |done| samples(done, &format!("{contact}.normal_force")),
                force,
                |done| units(done).1,
            )
            .within(computed(
                200_f64.sqrt() * ROUNDING,
                "random rounding of positions up to 4 R by ε over 200 cycles; in units of k v Δt with v Δt = 1e-3 R",
            ))
            .refuses(Control::contact_law("damping of 1e-6 of critical", |law| law.normal_damping = 2e-6))
            .drawn(&FORCES, contact)
    };
    let mut claims: Vec<Claim> =
        (1..=3).flat_map(|cycle| ["A", "B", "C"].map(|contact| of_cycle(cycle, contact))).collect();
    claims.push(over_cycles("A", force_at_a));
    claims.push(over_cycles("B", |done, time| 2.0 * moved(done, time)));
    claims.push(rigid::refuses_cycles(PLAIN));
    claims.extend(elastic::DISCS.claims(&CASE, |run| run));
    claims
}

fn late(name: &'static str, wall: usize) -> Control {
    Control::scene(name, move |scene| scene.walls[wall].motion.phases[0].start = Moment::Cycle(1))
}

/// Returns the number of the cycle that ends at a time (s).
fn cycle(done: &FinishedRun, time: f64) -> f64 {
    (time / done.record.provenance.time_step).round()
}

/// Returns the displacement of disc x at a time (s), times k (N).
fn moved(done: &FinishedRun, time: f64) -> f64 {
    let (q, unit) = units(done);
    displacement(cycle(done, time), q) * unit
}

/// Returns the force of the left wall (N) at a time (s).
fn force_at_a(done: &FinishedRun, time: f64) -> f64 {
    let (q, unit) = units(done);
    let n = cycle(done, time);
    (n - displacement(n, q)) * unit
}

/// Duration of the run (s), several periods of the pair of discs. The period is 2π/√3 = 3.63 s.
const SECONDS: f64 = 20.0;

/// Returns the target quantity of the cost study: the motion of a disc between the walls in continuous time, without the
/// finite time step of the paper.
///
/// m ü = F_A − F_B, with F_A = k(vt − u), F_B = 2ku for equal and opposite discs: u = vt/3 − (v/3W) sin Wt, W =
/// √(3k/m).
fn targets(case: &'static Case) -> Vec<TargetQuantity> {
    let lane = |method, about| SolverSetup {
        method,
        knobs: String::new(),
        prepare: Some(Arc::new(|scene: &mut Scene| {
            scene.duration = Duration::Seconds(SECONDS);
            scene.sampling = Sampling::Seconds(0.1);
            scene.probes.push(Probe { name: "x".to_owned(), target: ProbeTarget::Grain(0) });
        })),
        about,
    };
    vec![TargetQuantity {
        case,
        variant: PLAIN,
        quantity: "displacement of disc x over 20 s, worst".to_owned(),
        unit: "m",
        source: "u = vt/3 − (v/3W) sin Wt, W = √(3k/m) (derivation)".to_owned(),
        measure: Arc::new(|done| {
            let done = done.first().ok_or("run")?;
            let scene = &done.scene;
            let stiffness = scene.laws.iter().flatten().map(|law| law.normal_stiffness()).fold(0.0, f64::max);
            let speed = scene.walls[0].motion.phases[0].velocity.x;
            let frequency = (3.0 * stiffness / scene.grains[0].mass).sqrt();
            let start = scene.grains[0].position.x;
            let moved: Vec<f64> = done.column("x.x")?.iter().map(|x| x - start).collect();
            let exact = |t: f64| speed / 3.0 * (t - (frequency * t).sin() / frequency);
            Ok(Measurement::worst(&done.series().time, &moved, exact, speed / frequency / 3.0))
        }),
        lanes: vec![lane(Method::Dem, Resolution::CriticalFraction(0.1)), lane(Method::Rigid, Resolution::substeps(8))],
    }]
}
