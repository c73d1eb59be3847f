//! Collision of two discs: restitution in both release conventions, momentum and angular momentum.

use crate::exact::dashpot::{lag, no_tension_restitution};
use crate::rows::programs;
use crate::rows::rigid;
use grainbench_harness::prelude::*;

const LEVELS: &[Level] =
    &[fraction("dt=.02", 0.02), fraction("dt=.006", 0.006), fraction("dt=.002", 0.002), fraction("dt=.0006", 0.0006)];
const FINEST: Level = LEVELS[3];
const DAMPED: [&str; 4] = ["gamma-zeta.1", "gamma-zeta.2", "beta-zeta.1", "beta-zeta.2"];

pub(crate) static CASE: Case = crate::heads::COLLISION.with(LEVELS, 3, &claims).drawn_by(figures);

fn claims() -> Vec<Claim> {
    let mut claims = Vec::new();
    for solver in ["dem", "dem:1979"] {
        for variant in DAMPED {
            claims.extend([restitution(variant, solver), steps(variant, solver)]);
        }
    }
    claims.extend(momentum());
    claims.extend(angular_momentum());
    claims.extend(friction());
    claims.extend(by_impulses());
    claims.extend(DAMPED.into_iter().flat_map(|variant| programs::PAIRS.map(|pair| beside_program(variant, pair))));
    claims.push(force_that_moves());
    claims.extend(programs::PAIRS.map(force_that_is_printed));
    claims
}

fn by_impulses() -> Vec<Claim> {
    let run = |variant| Run::new(variant, "rigid", rigid::DEFAULT);
    let restitution = |variant| {
        claim("coefficient of restitution", "1")
            .run(run(variant))
            .equals(Source::Derived("damped oscillator that ends with its force (derivation)"), |done| {
                measured_restitution(&done[0])
            })
            .within(rounding(
                1.0,
                "rapier applies −e times the approach velocity once, at the end of the step of the impact",
            ))
            .refuses(Control::contact_law("damping ×1.05", |law| {
                law.stiffness_damping *= 1.05;
                law.normal_damping *= 1.05;
            }))
    };
    let momentum = |axis: (&'static str, usize)| {
        claim(format!("momentum along {}, worst", axis.0), "kg m/s")
            .run(run("oblique"))
            .holds("equal and opposite impulses", move |done| worst_momentum(&done[0], axis))
            .within(rounding(1.0, "in units of the momentum of one grain"))
            .refuses(Control::scene("a drag of 1e-9/s on every grain", |scene| scene.global_damping = 1e-9))
    };
    let angular_momentum = claim("angular momentum, worst", "kg m²/s")
        .run(run("oblique"))
        .holds("equal and opposite impulses at one point", |done| worst_angular_momentum(&done[0]))
        .within(estimated(
            3e-3,
            "normal and lever arms are taken at the start of the step, and the grains have moved when the impulse \
             acts: ∝ v Δt, in units of m v R",
        ))
        .refuses(Control::grains("the inertia of spheres", |grain| grain.inertia *= 0.8));
    DAMPED.map(restitution).into_iter().chain(AXES.map(momentum)).chain([angular_momentum]).collect()
}

fn beside_program(variant: &'static str, pair: [&'static str; 2]) -> Claim {
    let runs = pair.map(|solver| Run::new(variant, solver, LEVELS[1].resolution));
    let control = Control::our_contact_law("damping ×1.001 in ours", |law| {
        law.normal_damping *= 1.001;
        law.stiffness_damping *= 1.001;
    });
    let allowed = programs::same_cycle("in units of the approach velocity");
    programs::row("coefficient of restitution", "1", allowed, runs, control, |done| {
        let [ours, program] = [&done[0], &done[1]].map(measured_restitution);
        Ok(Measurement::new(ours?.value, program?.value, 1.0))
    })
}

/// Names of the axes, each with its number.
const AXES: [(&str, usize); 2] = [("x", 0), ("y", 1)];

/// Compares a momentum component with its initial value, in units of the first grain's momentum.
fn worst_momentum(done: &FinishedRun, (name, axis): (&str, usize)) -> Result<Measurement, MissingData> {
    let grains = &done.scene.grains;
    let start: f64 = grains.iter().map(|grain| grain.mass * grain.velocity[axis]).sum();
    let scale = grains[0].mass * grains[0].velocity.norm();
    let momentum = done.column(&format!("all.momentum_{name}"))?;
    Ok(Measurement::worst(&done.series().time, momentum, |_| start, scale))
}

/// Returns m v R of the first grain (kg m²/s).
fn lever(scene: &Scene) -> f64 {
    let grain = &scene.grains[0];
    grain.mass * grain.velocity.norm() * grain.radius
}

/// Compares the angular momentum with its initial value, in units of m v R.
fn worst_angular_momentum(done: &FinishedRun) -> Result<Measurement, MissingData> {
    let start = initial_angular_momentum(&done.scene);
    Ok(Measurement::worst(&done.series().time, done.column("all.angular_momentum")?, |_| start, lever(&done.scene)))
}

/// Returns effective mass (kg), undamped frequency ω (rad/s) and damping ratio ζ of the pair.
fn pair(scene: &Scene) -> (f64, f64, f64) {
    let law = scene.laws.iter().flatten().next().copied().unwrap_or_default();
    let mass = 1.0 / scene.grains.iter().map(|grain| 1.0 / grain.mass).sum::<f64>();
    let viscosity = law.stiffness_damping * law.normal_stiffness() + law.normal_damping * mass;
    (mass, (law.normal_stiffness() / mass).sqrt(), viscosity / (2.0 * (law.normal_stiffness() * mass).sqrt()))
}

/// Returns the coefficient of restitution. The dashpot may pull if `pulls`; otherwise the contact ends at zero force.
fn exact_restitution(zeta: f64, pulls: bool) -> f64 {
    if pulls { (-PI * zeta / (1.0 - zeta * zeta).sqrt()).exp() } else { no_tension_restitution(zeta) }
}

fn measured_restitution(done: &FinishedRun) -> Result<Measurement, MissingData> {
    let grains = &done.scene.grains;
    let before = grains[0].velocity.x - grains[1].velocity.x;
    let after = done.last("b.vx")? - done.last("a.vx")?;
    let pulls = !matches!(done.record.provenance.solver.as_str(), "dem" | "rigid");
    let (_, _, zeta) = pair(&done.scene);
    Ok(Measurement::new(after / before, exact_restitution(zeta, pulls), 1.0))
}

/// Variant whose contact force is compared: ζ = 0.2, with damping proportional to the stiffness (β).
const FELT: &str = DAMPED[3];
/// Largest spring force without damping, v√(k m*) (N), at an approach velocity of v = 2 m/s.
const LARGEST: f64 = 2.0 * 70.710_678_118_654_76;

/// Returns the force (N) of the pair with ζ = 0.2, from literal numbers: k = 1e4 N/m, c = 2ζ√(k m*) = 28.284271 N s/m.
fn damped_force(overlap: f64, rate: f64) -> f64 {
    if overlap > 0.0 { 1.0e4 * overlap + 28.284_271_247_461_902 * rate } else { 0.0 }
}

/// Returns the claim that the contact force recorded by `dem` is the force that moves the grains. The dashpot of `dem`
/// uses the velocity half a step before the sample, (δₙ − δₙ₋₁)/Δt.
fn force_that_moves() -> Claim {
    claim("force of a damped contact, the rate of overlap taken half a step back, worst", "N")
        .run(Run::new(FELT, "dem", LEVELS[1].resolution))
        .equals(
            Source::Derived("kδ + c (δ(n) − δ(n−1))/Δt if repulsive, with typed values (derivation)"),
            |done| {
                let (a, b, time) = (done[0].column("a.x")?, done[0].column("b.x")?, &done[0].series().time);
                let overlap = |at: usize| 2.0 - (b[at] - a[at]);
                let rate = |at: usize| (overlap(at) - overlap(at - 1)) / (time[at] - time[at - 1]);
                let force_at = |at: usize| damped_force(overlap(at), rate(at)).max(0.0);
                // The discs are not in contact at the first sample.
                let expected: Vec<f64> = std::iter::once(0.0).chain((1..time.len()).map(force_at)).collect();
                Ok(Measurement::worst_of(time, done[0].column("contact.normal_force")?, &expected, LARGEST))
            },
        )
        .within(computed(
            0.2 * (4.0 * f64::EPSILON / 2e-4 + f64::EPSILON * 500.0) + 8.0 * f64::EPSILON * 1.0e4 / LARGEST,
            "rounding: 4ε relative to the displacement v Δt = 2e-4 per step, and ε of up to 500 steps, times the \
             dashpot force c v = .2 of the largest force; 8ε of k times a radius",
        ))
        .refuses(Control::contact_law("damping × 1.001", |law| law.stiffness_damping *= 1.001))
}

/// Returns the claim on the contact force that LAMMPS or LIGGGHTS evaluates again at output. Its dashpot uses the
/// velocity of the sample, half a step later than in the force that moved the grains.
fn force_that_is_printed(pair: [&'static str; 2]) -> Claim {
    let control = Control::ours("discs 1e-6 nearer to each other in ours", |scene| scene.grains[0].position.x += 1e-6);
    let because = "rounding only, because both programs use the same integration cycle; in units of the largest force \
                   without damping";
    let runs = pair.map(|solver| Run::new(FELT, solver, LEVELS[1].resolution));
    let quantity = "force of a damped contact with the velocity of the sample, worst";
    programs::row(quantity, "N", oblique_rounding(1.0, because), runs, control, |done| {
        let compared_column = |column| together(&done[0], &done[1], column).map(|(ours, _)| ours);
        let (x, v) =
            ([compared_column("a.x")?, compared_column("b.x")?], [compared_column("a.vx")?, compared_column("b.vx")?]);
        let force = |at: usize| damped_force(2.0 - (x[1][at] - x[0][at]), v[0][at] - v[1][at]);
        let ours: Vec<f64> = (0..x[0].len()).map(force).collect();
        let theirs = done[1].column("contact.normal_force")?;
        Ok(Measurement::worst_of(&done[1].series().time, &ours, theirs, LARGEST))
    })
}

fn other(solver: &'static str) -> Control {
    if solver == "dem" {
        Control::solver("the dashpot may pull", "dem:1979")
    } else {
        Control::solver("the dashpot may not pull", "dem")
    }
}

fn restitution(variant: &'static str, solver: &'static str) -> Claim {
    claim("coefficient of restitution", "1")
        .run(Run::new(variant, solver, FINEST.resolution))
        .equals(Source::Derived("damped oscillator with this release (derivation)"), move |done| {
            // The exact value follows the convention of the claim, even if the control replaces the solver.
            let exact = exact_restitution(pair(&done[0].scene).2, solver != "dem");
            Ok(Measurement::new(measured_restitution(&done[0])?.value, exact, 1.0))
        })
        .within(computed(first_order(variant, FINEST.resolution), FIRST_ORDER))
        .refuses(other(solver))
}

const FIRST_ORDER: &str = "contact begins and ends within a step, which changes the impulse of the dashpot by up to \
                           half a step each, 2ζ ωΔt e; the dashpot is half a step late, so ζ is larger by the factor 1 \
                           + ζωΔt/2, π ζ²/(2 (1 − ζ²)^{3/2}) ωΔt e; (ωΔt)² for second-order terms (derivation)";

/// Returns the error bound of the restitution at a resolution.
fn first_order(variant: &str, resolution: Resolution) -> f64 {
    let Ok(scene) = CASE.variant(variant) else { return f64::NAN };
    let (_, omega, zeta) = pair(&scene);
    let phase = omega * resolution.steps(&scene).map_or(f64::NAN, |(step, _)| step);
    exact_restitution(zeta, false) * (2.0 * zeta + lag(zeta)) * phase + phase * phase
}

/// Returns the time step number `at` (0 to 15): 0.04 of the critical step divided by 1.3^`at`.
fn step(at: i32) -> Resolution {
    Resolution::CriticalFraction(0.04 * 1.3_f64.powi(-at))
}

/// Returns the claim that the error of the restitution is within the first-order bound for each of 16 time steps. An
/// order cannot be fitted, because the error of a single run depends on the position of the release within a step.
fn steps(variant: &'static str, solver: &'static str) -> Claim {
    claim("restitution's error over what is of first order in Δt, worst of 16 steps", "1")
        .runs((0..16).map(|at| Run::new(variant, solver, step(at))))
        .equals(Source::Derived("start, release and dashpot within a step (derivation)"), move |done| {
            Measurement::worst_read(done.iter().zip(0..).map(|(done, at)| {
                let exact = exact_restitution(pair(&done.scene).2, solver != "dem");
                let error = measured_restitution(done)?.value - exact;
                Ok(Measurement::new(error / first_order(variant, step(at)), 0.0, 1.0))
            }))
        })
        .within(computed(1.0, FIRST_ORDER))
        .refuses(other(solver))
}

/// Returns the tolerance for rounding errors in the oblique impact: `count` times ε in each step.
fn oblique_rounding(count: f64, because: &str) -> Tolerance {
    let steps = |scene: &Scene| LEVELS[1].resolution.steps(scene).map_or(f64::NAN, |(_, steps)| steps as f64);
    computed(count * f64::EPSILON * CASE.number("oblique", steps), because)
}

/// Starts a claim about the oblique impact.
fn oblique(quantity: impl Into<String>, unit: &'static str, solver: &'static str) -> Quantity {
    claim(quantity, unit).run(Run::new("oblique", solver, LEVELS[1].resolution))
}

fn momentum() -> Vec<Claim> {
    let momentum_claim = |axis: (&'static str, usize)| {
        oblique(format!("momentum along {}, worst", axis.0), "kg m/s", "dem")
            .holds("equal and opposite forces", move |done| worst_momentum(&done[0], axis))
            .within(oblique_rounding(
                2.0,
                "rounding of two velocities by ε per step; in units of the momentum of one grain",
            ))
            // The control applies to all solvers, because all support gravity.
            .refuses(Control::scene("a gravity of 1e-9 m/s² along x and y", |scene| {
                (scene.gravity.x, scene.gravity.y) = (1e-9, 1e-9);
            }))
            .solver_independent()
    };
    AXES.map(momentum_claim).to_vec()
}

fn initial_angular_momentum(scene: &Scene) -> f64 {
    let grain_momentum =
        |grain: &Grain| grain.mass * grain.position.xy().perp(&grain.velocity.xy()) + grain.inertia * grain.spin.z;
    scene.grains.iter().map(grain_momentum).sum()
}

fn angular_momentum() -> Vec<Claim> {
    const ROUNDING: &str = "rounding of two positions, two velocities and two spins by ε per step; in units of m v R";
    vec![
        oblique("angular momentum, arm R − overlap/2, worst", "kg m²/s", "dem:liggghts")
            .holds("tangential forces act at one point (derivation)", |done| worst_angular_momentum(&done[0]))
            .within(oblique_rounding(6.0, ROUNDING))
            .refuses(Control::solver("torque arm R", "dem")),
        oblique("change of angular momentum, arm R, against Σ overlap × F_t Δt", "kg m²/s", "dem")
            .equals(Source::Derived("lever arms R with a distance of centres R₁ + R₂ − δ (derivation)"), |done| {
                let scene = &done[0].scene;
                let (overlap, shear) = (done[0].column("contact.overlap")?, done[0].column("contact.shear_force")?);
                let impulse: f64 = overlap.iter().zip(shear).map(|(overlap, shear)| overlap * shear).sum();
                let change = done[0].last("all.angular_momentum")? - initial_angular_momentum(scene);
                // The shear force on the first grain is positive along t = (e₂, −e₁). Because e × t = −1, both lever
                // arms give a torque −R F_t.
                let expected = -impulse * done[0].record.provenance.time_step;
                Ok(Measurement::new(change, expected, lever(scene)))
            })
            .within(oblique_rounding(6.0, ROUNDING))
            .refuses(Control::solver("torque arm R − overlap/2", "dem:liggghts")),
    ]
}

/// Reason for the tolerance of the spin.
const OF_SPIN: &str = "rounding of the spin, at most 1.5 times its change, and of the sum, by ε per step";

/// Compares the change of the first disc's spin with −R/I times an impulse of friction (N s), in units of this value.
fn spin_of_friction(done: &FinishedRun, impulse: f64) -> Result<Measurement, MissingData> {
    let grain = &done.scene.grains[0];
    Ok(Measurement::relative(done.last("a.omega")? - grain.spin.z, -impulse * grain.radius / grain.inertia))
}

/// Returns the claims on friction in the oblique impact, in which it is at the Coulomb limit in each step. In Cundall &
/// Strack (1979), the limit applies to the spring force alone; in our solver, to the total F_n if it pushes.
fn friction() -> [Claim; 3] {
    [
        oblique("spin that friction gives the first disc, against R μ Σ k_n overlap Δt/I", "rad/s", "dem:1979")
            .equals(Source::Derived("Coulomb's limit at every step (derivation)"), |done| {
                let law = done[0].scene.laws.iter().flatten().next().copied().unwrap_or_default();
                let overlap: f64 = done[0].column("contact.overlap")?.iter().sum();
                let limit = law.friction * law.normal_stiffness() * overlap * done[0].record.provenance.time_step;
                spin_of_friction(&done[0], limit)
            })
            .within(oblique_rounding(3.0, OF_SPIN))
            .refuses(Control::without(Effect::Friction)),
        oblique("|F_s| − μ F_n where it pushes, largest over the impact, over the largest μ F_n", "1", "dem")
            .at_most(0.0, Source::Derived("Coulomb's law, |F_s| ≤ μ max(F_n, 0) (derivation)"), |done| {
                let law = done[0].scene.laws.iter().flatten().next().copied().unwrap_or_default();
                let (normal, shear) = (done[0].column("contact.normal_force")?, done[0].column("contact.shear_force")?);
                let beyond =
                    normal.iter().zip(shear).map(|(normal, shear)| shear.abs() - law.friction * normal.max(0.0));
                let largest = normal.iter().map(|force| law.friction * force).fold(0.0, f64::max);
                Ok(beyond.fold(f64::NEG_INFINITY, f64::max) / largest)
            })
            .within(computed(4.0 * f64::EPSILON, "rounding of a root, a quotient and two products by ε"))
            .refuses(Control::solver("the limit of the spring alone", "dem:1979")),
        oblique("spin that friction gives the first disc, against R μ Σ F_n Δt/I where it pushes", "rad/s", "dem")
            .holds(
                "the contact slides throughout: the recorded friction is μ times the recorded normal force and turns the disc",
                |done| {
                    let law = done[0].scene.laws.iter().flatten().next().copied().unwrap_or_default();
                    let pushes: f64 = done[0].column("contact.normal_force")?.iter().map(|force| force.max(0.0)).sum();
                    let impulse = law.friction * pushes * done[0].record.provenance.time_step;
                    spin_of_friction(&done[0], impulse)
                },
            )
            .within(oblique_rounding(3.0, OF_SPIN))
            .refuses(Control::solver("the limit of the spring alone", "dem:1979")),
    ]
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut errors = Vec::new();
    let mut forces = Vec::new();
    for (solver, release) in [("dem:1979", "may pull"), ("dem", "may not pull")] {
        for variant in ["gamma-zeta.1", "gamma-zeta.2"] {
            let mut points = Vec::new();
            for level in LEVELS {
                let done = runner.run(&Run::new(variant, solver, level.resolution))?;
                if let (Ok(measured), Some(critical)) =
                    (measured_restitution(&done), done.record.provenance.critical_time_step)
                {
                    points.push((done.record.provenance.time_step / critical, measured.error().abs()));
                }
            }
            errors.push(Curve::new(format!("{}, {release}", crate::rows::label(variant)), Stroke::MarkedLine, points));
        }
        let done = runner.run(&Run::new("gamma-zeta.2", solver, LEVELS[1].resolution))?;
        let force = done.series().column("contact.normal_force").unwrap_or_default();
        let points =
            done.series().time.iter().zip(force).map(|(t, force)| (t * 1e3, *force)).take_while(|(t, _)| *t < 30.0);
        forces.push(Curve::new(format!("dashpot {release}"), Stroke::Line, points.collect()));
    }
    errors.push(Curve::new("slope 1", Stroke::Dashed, vec![(0.0006, 3e-4), (0.02, 1e-2)]));
    Ok(vec![
        Figure::graph(
            "force",
            "Normal force during the impact, ζ = 0.2",
            "The two conventions differ only at the end. Either the dashpot pulls until the overlap is zero, or the \
             contact ends when the force is zero.",
            [Axis::linear("time t (ms)"), Axis::linear("normal force (N)")],
            forces,
        ),
        Figure::graph(
            "restitution",
            "Error of the coefficient of restitution",
            "The error is of first order in Δt. It scatters because the contact ends at some time within a step.",
            [Axis::log("Δt / critical step"), Axis::log("|e − exact|")],
            errors,
        ),
    ])
}
