//! Claims shared by `incline-disc` and `incline-sphere`, in which a grain is released from rest on an inclined plane.
//! Each case has its own scene, slopes and elastic body.

use super::on_plane::{DAMPING, NEARLY_RIGID, Plane, STEP, at_overlap, end, nearly_rigid, stronger_friction};
use super::rigid;
use super::set_down::{self, Dashpots};
use super::{label, programs};
use crate::exact::one_grain::{OneGrain, State, course, last, rest_at_overlap};
use grainbench_harness::prelude::*;

/// Parameters of the case `incline-disc` or `incline-sphere`.
pub(crate) struct Incline {
    /// Case that defines the variants.
    pub(crate) case: &'static Case,
    /// Inclined planes of the case, each a variant of the scene.
    pub(crate) slopes: &'static [Plane],
    /// Variant for the claims on a grain that is set down, and the coefficients of the dashpots in these claims.
    pub(crate) set_down: (&'static str, Dashpots),
    /// Returns the claims on the elastic body.
    pub(crate) elastic_claims: fn() -> Vec<Claim>,
    /// Returns the figure of the elastic body.
    pub(crate) elastic_figure: fn(&Runner) -> Result<Figure, RunError>,
}

/// Levels of resolution of these cases.
pub(crate) const LEVELS: &[Level] = &[fraction("dt=.1", 0.1), fraction("dt=.03", 0.03), fraction("dt=.01", 0.01)];

impl Incline {
    pub(crate) fn claims(&self) -> Vec<Claim> {
        let (variant, dashpots) = self.set_down;
        let variants: Vec<_> = self.slopes.iter().map(|slope| slope.variant).collect();
        [
            springs(self.case, self.slopes),
            set_down::claims(variant, dashpots),
            self.slopes.iter().flat_map(|&slope| rigid::incline(self.case, slope)).collect(),
            programs::one_grain(&variants),
            (self.elastic_claims)(),
        ]
        .concat()
    }

    pub(crate) fn figures(&self, runner: &Runner) -> Result<Vec<Figure>, RunError> {
        let mut figures = motion(runner, self.slopes)?;
        figures.push(rigid::figure(runner, self.slopes, OneGrain::rigid_incline)?);
        figures.push((self.elastic_figure)(runner)?);
        Ok(figures)
    }
}

const COMPLIANCE: ClaimFigure = ClaimFigure {
    name: "compliance",
    title: "Deviation from a rigid grain over the contact overlap",
    caption: "The deviation of rolling grains is proportional to overlap/R. The deviation of slipping grains is \
              proportional to √(overlap/R), because the tangential spring must first be stretched.",
    axes: ["static overlap / R", "|x − x_rigid| / x_rigid at 1 s"],
    logarithmic: true,
};

/// Time step of the undamped run that is compared with the compliant solution.
const FINE: Resolution = Resolution::CriticalFraction(0.0025);
/// Numbers of steps before slip begins, in the undamped runs for the order of convergence. In each run, slip begins in
/// the middle of a step, because the coefficient of the error depends on the position within the step.
const STEPS_BEFORE_SLIP: [f64; 4] = [16.5, 32.5, 64.5, 128.5];
/// Static overlaps of the sweep, divided by R.
const OVERLAPS: [f64; 5] = [1e-3, 3e-4, 1e-4, 3e-5, NEARLY_RIGID];

fn springs(case: &Case, slopes: &[Plane]) -> Vec<Claim> {
    let mut claims = Vec::new();
    for &slope in slopes {
        if !slope.rolls {
            claims.extend(compliant(case, slope));
        }
        claims.extend(rigid(case, slope));
        claims.push(exponent(slope));
        claims.extend(near_rigid(case, slope));
        if slope.rolls {
            claims.extend(final_motion(case, slope));
        }
    }
    claims
}

/// Returns the claims on an undamped slipping grain against the compliant solution, of second order in the step.
fn compliant(case: &Case, slope: Plane) -> Vec<Claim> {
    const SOURCE: Source =
        Source::Derived("closed form with the tangential spring (derivation); MPM 2000 eq. 25 for the slip law");
    let run = |step| at_overlap(slope.variant, "dem:lammps", 1e-3, 0.0, step);
    let slips_from = case.number(slope.variant, |scene| OneGrain::from_scene(scene).slips_from());
    let error = |done: &FinishedRun| end(done, OneGrain::compliant_incline, |state| state.x);
    vec![
        claim("displacement at 1 s, undamped, against the elastic answer", "m")
            .run(run(FINE))
            .equals(SOURCE, move |done| error(&done[0]))
            .within(estimated(3e-7, "discretisation, of second order in Δt; relative to the displacement"))
            .refuses(stronger_friction()),
        claim("order in Δt of that displacement", "1")
            .runs(STEPS_BEFORE_SLIP.iter().map(|steps| run(Resolution::TimeStep(slips_from / steps))))
            .fits(2.0, Source::Derived("central differences are of second order"), move |done| {
                Ok((done.record.provenance.time_step, error(done)?.error()))
            })
            .within(computed(
                2.0 * 9.0 / 80.0 * (PI / STEPS_BEFORE_SLIP[0]).powi(2),
                "the next power of ωΔt: a step turns the spring by 2 arcsin(ωΔt/2) = ωΔt (1 + (ωΔt)²/24 (1 + 9 (ωΔt)²/80)), \
                 which changes the order by 2 × 9 (ωΔt)²/80, with ωΔt ≤ π/16.5 at the coarsest",
            ))
            .refuses(stronger_friction()),
    ]
}

/// Reason why a rolling grain may deviate from the rigid solution.
const SWINGS: &str = "the tangential spring vibrates by up to twice its static displacement f g_t/ω², ω² = (k_t/m)(1 + \
                      1/i)";
/// Reason why a slipping grain may deviate from the rigid solution.
const LATE: &str = "friction may be absent until an undamped spring has reached Coulomb's limit, t_s = arccos(1 − μ \
                    g_n/(f g_t))/ω: t_s/t for the spin, μ g_n t_s/v for the velocity, twice that for the displacement";

/// Returns the largest fractional effect of compliance on the state at 1 s, at a static overlap of `ratio`·R.
fn compliance(case: &Case, slope: Plane, ratio: f64) -> State {
    let unknown = State { x: f64::NAN, v: f64::NAN, omega: f64::NAN };
    case.variant(slope.variant).map_or(unknown, |mut scene| {
        rest_at_overlap(&mut scene, ratio, DAMPING);
        OneGrain::from_scene(&scene).compliance(1.0)
    })
}

/// Returns the tolerance for the velocity of a rolling grain at 1 s: the fraction of the slip velocity that remains at
/// 1 s, plus the rounding of velocities. `slides` returns the duration of sliding (s).
pub(crate) fn come_to_roll(case: &Case, variant: &str, slides: impl Fn(&OneGrain) -> f64) -> Tolerance {
    let left = case.variant(variant).map_or(f64::NAN, |mut scene| {
        rest_at_overlap(&mut scene, 1e-3, DAMPING);
        let grain = OneGrain::from_scene(&scene);
        let steps = STEP.steps(&scene).map_or(f64::NAN, |(_, steps)| steps as f64);
        2.0 * steps * f64::EPSILON + grain.rung(1.0 - slides(&grain))
    });
    computed(
        left,
        "angular momentum about the contact determines the value; remaining slip e^{−λt}, with λ the slower rate of \
         the damped tangential spring, and two roundings per step",
    )
}

fn rigid(case: &Case, slope: Plane) -> Vec<Claim> {
    let allowed = compliance(case, slope, 1e-3);
    let rigid_claim = |quantity: &str, unit, pick: fn(State) -> f64| {
        claim(quantity, unit)
            .run(at_overlap(slope.variant, "dem:lammps", 1e-3, DAMPING, STEP))
            .equals(rigid::SOLUTION, move |done| end(&done[0], OneGrain::rigid_incline, pick))
            .within(computed(pick(allowed), if slope.rolls { SWINGS } else { LATE }))
            .refuses(slope.control())
    };
    let mut claims = vec![rigid_claim("displacement at 1 s", "m", |state| state.x)];
    // Velocity and spin of a rolling grain have a claim with a tolerance of rounding size, in `final_motion`.
    if !slope.rolls {
        claims.push(rigid_claim("velocity at 1 s", "m/s", |state| state.v));
        claims.push(rigid_claim("spin at 1 s", "rad/s", |state| state.omega));
    }
    claims
}

/// Returns the claim on the exponent n in the relation error ∝ (overlap/R)^n with the rigid solution.
fn exponent(slope: Plane) -> Claim {
    let expected: f64 = if slope.rolls { 1.0 } else { 0.5 };
    let middle = (OVERLAPS[0] * NEARLY_RIGID).sqrt();
    claim("exponent of the displacement's error in overlap/R, 1e-3 to 1e-5", "1")
        .runs(OVERLAPS.iter().map(|&ratio| at_overlap(slope.variant, "dem:lammps", ratio, DAMPING, STEP)))
        .scales(
            expected,
            1.0,
            Source::Derived("elastic phase before slip lasts ∝ √(overlap/R), its stretch ∝ overlap/R (derivation)"),
            |done| {
                let error = end(done, OneGrain::rigid_incline, |state| state.x)?.error();
                Ok((OneGrain::from_scene(&done.scene).overlap_ratio, error))
            },
        )
        .within(computed(
            expected * middle.powf(expected),
            "the next power (of the overlap for rolling, of its square root for slipping), with a coefficient of the \
             same size, changes the exponent by its value times its power; taken at the middle of the two decades, \
             overlap/R = 1e-4",
        ))
        .refuses(slope.control())
        .drawn(&COMPLIANCE, format!("{} ({})", label(slope.variant), if slope.rolls { "rolls" } else { "slips" }))
}

/// Returns solver-independent claims for a contact so stiff that all conventions nearly agree.
fn near_rigid(case: &Case, slope: Plane) -> Vec<Claim> {
    let allowed = compliance(case, slope, NEARLY_RIGID);
    let near_rigid_claims = |quantity: [&'static str; 2], unit, pick: fn(State) -> f64| {
        let tolerance = if slope.rolls {
            computed(
                NEARLY_RIGID,
                "compliance, and a lever arm between R and R − overlap/2: both ∝ overlap/R, here 1e-5",
            )
        } else {
            computed(pick(allowed), LATE)
        };
        claim(format!("{} at 1 s, nearly rigid contact", quantity[0]), unit)
            .run(nearly_rigid(slope.variant, slope.rolls))
            .equals(rigid::SOLUTION, move |done| end(&done[0], OneGrain::rigid_incline, pick))
            .within(tolerance)
            .refuses(slope.control())
            .solver_independent()
            .at_other_numbers(quantity[1], ELSEWHERE, move |scene| pick(elsewhere(scene)))
    };
    vec![
        near_rigid_claims(["displacement", "displacement at the end"], "m", |state| state.x),
        near_rigid_claims(["velocity", "velocity at the end"], "m/s", |state| state.v),
        near_rigid_claims(["spin", "spin at the end"], "rad/s", |state| state.omega),
    ]
}

/// Reason for the tolerance under parameter variation.
const ELSEWHERE: &str = "rolling: overlap/R for the lever arm, plus the spring displacement over the total \
                         displacement, or the velocity of its undamped vibration; slipping: half a period of each \
                         spring until friction acts in full, over the time";

/// Returns the largest relative deviations from the rigid solution at the end, for a slope with varied parameters.
fn elsewhere(scene: &Scene) -> State {
    let grain = OneGrain::from_scene(scene);
    let end = scene.duration.seconds().unwrap_or(f64::NAN);
    let exact = grain.rigid_incline(end);
    if grain.sticks() {
        let taken = grain.share() * grain.along;
        State {
            x: grain.overlap_ratio + grain.stretch(taken) / exact.x,
            v: grain.overlap_ratio + grain.ringing(taken) / exact.v,
            omega: grain.overlap_ratio + grain.ringing(grain.along - taken) / exact.v,
        }
    } else {
        let missing = grain.onset() / end;
        let velocity = missing * grain.friction * grain.onto / (exact.v / end);
        State { x: 2.0 * velocity, v: velocity, omega: missing }
    }
}

/// Returns the claims that final v and ΩR agree to rounding with the solution for the lever arm of a convention.
fn final_motion(case: &Case, slope: Plane) -> Vec<Claim> {
    let speed_claim = |solver: &'static str, quantity: &str, of_spin: bool| {
        claim(quantity, "m/s")
            .run(at_overlap(slope.variant, solver, 1e-3, DAMPING, STEP))
            .equals(Source::Derived("v(1 + i(R/a)²) = g_t t with arm a (derivation)"), move |done| {
                let (t, state) = last(&done[0])?;
                let grain = OneGrain::from_scene(&done[0].scene);
                let arm = grain.arm(solver);
                let exact = grain.rolling_velocity(t, arm);
                Ok(Measurement::relative(if of_spin { state.omega * arm } else { state.v }, exact))
            })
            .within(come_to_roll(case, slope.variant, |_| 0.0))
            .refuses(if solver == "dem:liggghts" {
                Control::solver("torque arm R", "dem:lammps")
            } else {
                Control::solver("torque arm R − overlap/2", "dem:liggghts")
            })
    };
    vec![
        speed_claim("dem:lammps", "final velocity, rolling, arm R", false),
        speed_claim("dem:lammps", "final ΩR, rolling, arm R", true),
        speed_claim("dem:liggghts", "final velocity, rolling, arm R − overlap/2", false),
        speed_claim("dem:liggghts", "final Ωa, rolling, arm a = R − overlap/2", true),
    ]
}

fn motion(runner: &Runner, slopes: &[Plane]) -> Result<Vec<Figure>, RunError> {
    let mut displacement = Vec::new();
    let mut spin = Vec::new();
    for slope in slopes {
        let done = runner.run(&at_overlap(slope.variant, "dem:lammps", 1e-3, DAMPING, STEP))?;
        let grain = OneGrain::from_scene(&done.scene);
        let states = thinned(course(&done).unwrap_or_default(), 12);
        let exact: Vec<(f64, State)> =
            (0..=50).map(|k| f64::from(k) / 50.0).map(|t| (t, grain.rigid_incline(t))).collect();
        let (measured, rigid) = (label(slope.variant), format!("{}, rigid", label(slope.variant)));
        for (label, stroke, states) in [(measured, Stroke::Markers, states), (rigid, Stroke::Dashed, exact)] {
            let points = |pick: fn(&State) -> f64| states.iter().map(|(t, state)| (*t, pick(state))).collect();
            displacement.push(Curve::new(label.clone(), stroke, points(|state| state.x)));
            spin.push(Curve::new(label, stroke, points(|state| state.omega)));
        }
    }
    Ok(vec![
        Figure::graph(
            "displacement",
            "Displacement down the slope",
            "`dem:lammps` at overlap/R = 10⁻³ (markers) is compared with the exact solution of a rigid grain (dashes).",
            [Axis::linear("time t (s)"), Axis::linear("displacement x (m)")],
            displacement,
        ),
        Figure::graph(
            "spin",
            "Spin on the slope",
            "Spin in the runs of the previous figure. A grain that slides without friction has none.",
            [Axis::linear("time t (s)"), Axis::linear("spin Ω (rad/s)")],
            spin,
        ),
    ])
}
