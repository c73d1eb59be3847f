//! Claims on the solver `rigid`: one grain on a plane against the rigid solution, and the parts of the error.
//!
//! rapier takes substeps h = Δt/4 in a step Δt, with symplectic Euler. It detects a contact once a step; the contact
//! points are then fixed on the bodies. Three errors follow, and no other is observed:
//!
//! ```text
//! position     x leads the velocities: (x − x_exact)/x_exact = h/t at constant acceleration
//! lift-off     a contact point that turns with the grain rises by R(1 − cos ΩΔt) in a step, the contact opens and the
//!              grain falls: at any moment friction lacks the impulse μ m |v_n| with the velocity v_n of that fall
//! overlap      the correction towards zero overlap acts as a spring of frequency f = 60 Hz at fixed walls: at rest
//!              the overlap is δ = g_n/(2πf)² at every Δt, and friction has the lever arm R − δ/2
//! ```
//!
//! Derivation of the overlap: at rest, the solver with this correction (bias) keeps the impulse P = m g_n h, P = (P + m
//! δ b)/(1 + c), with b = ω/(hω + 2ζ) and c = b/(hω²), ω = 2πf. Hence δ = g_n h c/b = g_n/ω². The overlap is reached
//! within a time of about 2ζ/ω + 1/(hω²), which increases as the step decreases.

use crate::exact::one_grain::{OneGrain, State, last};
use crate::rows::on_plane::{EndReader, Plane, end, stronger_friction, touching};
use grainbench_harness::prelude::*;
use grainbench_rigid::settings::Settings;
use std::f64::consts::TAU;

/// Name of the solver.
const RIGID: &str = "rigid";
/// Default number of substeps in 1/60 s.
pub(crate) const SUBSTEPS: u32 = 8;
/// Default resolution of the claims.
pub(crate) const DEFAULT: Resolution = Resolution::substeps(SUBSTEPS);
/// Numbers of substeps in 1/60 s that the figure shows.
const LEVELS: [u32; 8] = [1, 2, 4, 8, 16, 32, 64, 128];
/// Numbers of substeps in 1/60 s at which rotating grains no longer lift off.
const FINE: [u32; 5] = [16, 32, 64, 128, 256];

/// Source of the rigid solutions.
pub(crate) const SOLUTION: Source =
    Source::Derived("rolling or slipping under gravity: MPM 2000 eq. 25; 2001 eqs. 23-26 (derivation)");
const ORDER_SOURCE: Source = Source::Derived("symplectic Euler is of first order in positions");

/// Returns a run of the grain in contact without overlap, because a rigid contact has no static overlap.
fn run(variant: &'static str, resolution: Resolution) -> Run {
    Run::new(variant, RIGID, resolution).adjusted("touching", touching)
}

/// Returns the overlap at rest under the scene's gravity (m).
fn rest_overlap(grain: &OneGrain) -> f64 {
    grain.onto / (TAU * Settings::default().wall_frequency).powi(2)
}

/// Returns the claims on displacement, velocity and spin at 1 s. The first control belongs to the displacement.
pub(crate) fn against(
    variant: &'static str,
    source: Source,
    end: EndReader,
    [x_control, control]: [Control; 2],
    [x, v, omega]: [Tolerance; 3],
) -> Vec<Claim> {
    let rigid_claim = |quantity: &str, unit, tolerance, control, pick: fn(State) -> f64| {
        claim(quantity, unit)
            .run(run(variant, DEFAULT))
            .equals(source, move |done| end(&done[0], pick))
            .within(tolerance)
            .refuses(control)
    };
    vec![
        rigid_claim("displacement at 1 s", "m", x, x_control, |state| state.x),
        rigid_claim("velocity at 1 s", "m/s", v, control.clone(), |state| state.v),
        rigid_claim("spin at 1 s", "rad/s", omega, control, |state| state.omega),
    ]
}

/// Returns one run for each number of substeps in [`FINE`].
fn fine(plane: Plane) -> impl Iterator<Item = Run> {
    FINE.iter().map(move |&substeps| run(plane.variant, Resolution::substeps(substeps)))
}

fn order(plane: Plane) -> Claim {
    claim("order in Δt of the displacement's error", "1")
        .runs(fine(plane))
        .fits(1.0, ORDER_SOURCE, |done| {
            let error = end(done, OneGrain::rigid_incline, |state| state.x)?.error();
            Ok((done.record.provenance.time_step, error))
        })
        .within(asymptotic(1.0))
        .refuses(plane.control())
}

/// Returns the claim on the displacement of a rolling grain, corrected for the error h/t. The corrected displacement
/// lies between the exact displacements for two lever arms of friction. The lever arm is R until the overlap at rest δ
/// is reached, and R − δ/2 afterwards. With a finer step, the overlap is reached later: after half a second with 256
/// substeps. The remaining error has no order in the time step.
fn between_arms(case: &Case, plane: Plane) -> Claim {
    let (overlap, i) = arm(case, plane);
    let width = overlap * i / (1.0 + i);
    let coarsest = Resolution::RIGID_STEP / f64::from(Resolution::RIGID_ITERATIONS * FINE[0]);
    claim("displacement less h/t, between arms of R − δ/2 and R, farthest of 16 to 256 substeps", "1")
        .runs(fine(plane))
        .between(
            [0.0, 1.0],
            Source::Derived("v(1 + i(R/a)²) = g_t t, a from R to R − δ/2 (derived with the claim)"),
            |done| {
                let places = done.iter().map(|done| {
                    let (t, state) = last(done)?;
                    let grain = OneGrain::from_scene(&done.scene);
                    let [shortest, longest] = [grain.radius - 0.5 * rest_overlap(&grain), grain.radius]
                        .map(|arm| 0.5 * t * grain.rolling_velocity(t, arm));
                    let ahead = done.record.provenance.time_step / f64::from(Resolution::RIGID_ITERATIONS) / t;
                    Ok((state.x / (1.0 + ahead) - shortest) / (longest - shortest))
                });
                let places = places.collect::<Result<Vec<f64>, MissingData>>()?;
                let farthest = places.into_iter().max_by(|a, b| (a - 0.5).abs().total_cmp(&(b - 0.5).abs()));
                Ok(farthest.ok_or("runs")?)
            },
        )
        .within(computed(
            coarsest * coarsest / width,
            "(h/t)² of the coarsest step, in units of the effect of the lever arms, δ i/(R (1 + i))",
        ))
        .refuses(plane.control())
}

/// Returns the overlap at rest divided by the radius, and the inertia factor I/(mR²).
fn arm(case: &Case, plane: Plane) -> (f64, f64) {
    let grain = case.variant(plane.variant).map(|scene| OneGrain::from_scene(&scene));
    grain.map_or((f64::NAN, f64::NAN), |grain| (rest_overlap(&grain) / grain.radius, grain.inertia_factor))
}

/// Returns the claims on a grain released on a slope.
pub(crate) fn incline(case: &Case, plane: Plane) -> Vec<Claim> {
    const X: &str = "with symplectic Euler, positions are ahead of the velocities by h/t = 5.2e-4, h = Δt/4; if \
                     rotation lifts the contact point off the plane, the friction impulse of the fall is missing";
    const LIFTED: &str = "rotation lifts the contact point off for a part of a step: the friction impulse μ m |v_n| is \
                          missing, which vanishes at smaller steps";
    let (overlap, i) = arm(case, plane);
    let of_arm = |factor: f64, because: &str| computed(factor * overlap, because);
    let [v, omega] = match plane.lifts {
        Some(most) => most.map(|most| estimated(most, LIFTED)),
        None if plane.rolls => [
            of_arm(
                2.0 * i / (1.0 + i),
                "lever arm between R and R − δ in v(1 + i(R/a)²) = g_t t: 2i/(1 + i) times δ/R",
            ),
            of_arm((1.0 - i) / (1.0 + i), "lever arm between R and R − δ in Ω = v/a: (1 − i)/(1 + i) times δ/R"),
        ],
        None => [
            rounding(1.0, "friction is constant during slip"),
            of_arm(1.0, "the torque of friction has a lever arm between R and R − δ: δ/R"),
        ],
    };
    let end = |done: &FinishedRun, pick: fn(State) -> f64| end(done, OneGrain::rigid_incline, pick);
    let controls = [plane.control(), plane.control()];
    let mut claims = against(plane.variant, SOLUTION, end, controls, [estimated(2e-3, X), v, omega]);
    claims.push(if plane.rolls { between_arms(case, plane) } else { order(plane) });
    if plane.rolls {
        claims.push(final_velocity(case, plane));
    }
    claims
}

/// Returns the velocity of rolling (m/s) at t (s). Friction has the lever arm R − δ/2, with rapier's overlap at rest δ.
fn rolling(grain: &OneGrain, t: f64) -> f64 {
    grain.rolling_velocity(t, grain.radius - 0.5 * rest_overlap(grain))
}

/// Returns the claim on the velocity at 1 s with fine steps. Two effects remain: the lever arm of friction, and the
/// slow growth of the overlap that determines the lever arm. An overdamped contact of frequency f and damping ratio ζ
/// approaches its overlap at rest as exp(−t/τ), τ = 2ζ/(2πf). A part τ/t of the effect of the lever arm is therefore
/// missing at t.
fn final_velocity(case: &Case, plane: Plane) -> Claim {
    /// Time at which the velocity is compared (s).
    const END: f64 = 1.0;
    let Settings { wall_frequency, damping_ratio, .. } = Settings::default();
    let ((overlap, i), lag) = (arm(case, plane), 2.0 * damping_ratio / (TAU * wall_frequency));
    claim("velocity at 1 s, arm R − δ/2", "m/s")
        .run(run(plane.variant, Resolution::substeps(32)))
        .equals(
            Source::Derived("v(1 + i(R/a)²) = g_t t with arm a = R − δ/2, δ = g_n/(2πf)² (derived with the claim)"),
            |done| {
                let (t, state) = last(&done[0])?;
                let exact = rolling(&OneGrain::from_scene(&done[0].scene), t);
                Ok(Measurement::relative(state.v, exact))
            },
        )
        .within(computed(
            lag / END * i / (1.0 + i) * overlap,
            "the overlap approaches its value with exp(−t/τ), τ = 2ζ/(2πf) = .053 s: τ/t times the effect of the lever \
             arm, i/(1 + i) times δ/R",
        ))
        .refuses(plane.control())
}

/// Returns the claims on a grain set down with spin.
pub(crate) fn backspin(case: &Case, plane: Plane) -> Vec<Claim> {
    const X: &str = "while RΩ² exceeds g, the contact point lifts off faster than the grain can fall: friction starts \
                     up to a step late and is intermittent";
    let (overlap, i) = arm(case, plane);
    let of_arm = |factor: f64, because: &str| computed(factor * overlap, because);
    let allowed = [
        estimated(2e-3, X),
        of_arm(
            (1.0 - i) / (1.0 + i),
            "lever arm between R and R − δ in v = iR²Ω₀a/(a² + iR²): (1 − i)/(1 + i) times δ/R",
        ),
        of_arm(2.0 / (1.0 + i), "lever arm between R and R − δ in Ω = v/a: 2/(1 + i) times δ/R"),
    ];
    let end = |done: &FinishedRun, pick: fn(State) -> f64| end(done, OneGrain::rigid_backspin, pick);
    against(plane.variant, SOLUTION, end, [stronger_friction(), plane.control()], allowed)
}

/// Returns a figure of the error of the displacement against the number of substeps; an error if a run fails for another
/// reason than a crash of the solver.
pub(crate) fn figure(
    runner: &Runner,
    planes: &[Plane],
    exact: fn(&OneGrain, f64) -> State,
) -> Result<Figure, RunError> {
    let mut curves = Vec::new();
    for plane in planes {
        let mut points = Vec::new();
        for substeps in LEVELS {
            let done = match runner.run(&run(plane.variant, Resolution::substeps(substeps))) {
                // The step is too coarse for a grain that rotates this fast, so there is no point.
                Err(RunError::Broken(_)) => continue,
                done => done?,
            };
            if let Ok(displacement) = end(&done, exact, |state| state.x) {
                points.push((f64::from(substeps), displacement.error().abs()));
            }
        }
        curves.push(Curve::new(super::label(plane.variant), Stroke::MarkedLine, points));
    }
    let ends = [LEVELS[0], LEVELS[LEVELS.len() - 1]].map(f64::from);
    let small = Resolution::RIGID_STEP / f64::from(Resolution::RIGID_ITERATIONS);
    let ahead = ends.iter().map(|&substeps| (substeps, small / substeps)).collect();
    curves.push(Curve::new("h/t", Stroke::Dashed, ahead));
    Ok(Figure::graph(
        "rigid-substeps",
        "rigid: error over the number of substeps",
        "A rigid-body engine has no contact compliance, so its error comes from the time step. Symplectic Euler has \
         a position error of h/t (dashed), where h is a quarter of a substep. Larger errors arise when rotation \
         lifts contact points off the plane. A run whose grain rotates too far in a step has no point.",
        [Axis::log("substeps in 1/60 s"), Axis::log("|x − x_rigid| / x_rigid at 1 s")],
        curves,
    ))
}

/// Returns the claim that `rigid` reports a duration in cycles as unsupported.
pub(crate) fn refuses_cycles(variant: &'static str) -> Claim {
    claim("refusal of a length in calculation cycles", "1").run(Run::new(variant, RIGID, DEFAULT)).refused(
        "a cycle is a fraction of the period of the contact springs, and rigid contacts have no springs",
        Control::scene("a length in seconds, walls at rest, no recorded forces", |scene| {
            scene.duration = Duration::Seconds(0.1);
            scene.walls.iter_mut().for_each(|wall| wall.motion.phases.clear());
            scene.probes.clear();
        }),
    )
}
