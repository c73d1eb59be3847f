//! A sphere (Bardenhagen et al. 2001) or a disc that is set down with spin and without velocity.

mod elastic;

use crate::exact::one_grain::{OneGrain, State, course, nearest, rest_at_overlap};
use crate::rows::on_plane::{self, DAMPING, NEARLY_RIGID, Plane, STEP, at_overlap, other_inertia, stronger_friction};
use crate::rows::one_grain_cost::displacement;
use crate::rows::rigid;
use crate::rows::{incline, programs};
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[fraction("dt=.1", 0.1), fraction("dt=.03", 0.03), fraction("dt=.01", 0.01)];
const VARIANTS: [&str; 2] = ["disc", "sphere"];
const RIGID: &[Plane] =
    &[Plane { variant: "disc", rolls: true, lifts: None }, Plane { variant: "sphere", rolls: true, lifts: None }];

pub(crate) static CASE: Case = crate::heads::BACKSPIN.with(LEVELS, 2, &claims).drawn_by(figures).priced_by(|case| {
    displacement(case, &VARIANTS, 0.5, OneGrain::rigid_backspin, "2001 paper, section on backspin; derivation")
});

const SOURCE: Source =
    Source::Derived("a rigid grain slides, then rolls (derivation; 2001 paper, section on backspin)");

fn claims() -> Vec<Claim> {
    let dem =
        VARIANTS.into_iter().flat_map(|variant| [rigid(variant), final_motion(variant), near_rigid(variant)].concat());
    let rigid = RIGID.iter().flat_map(|&plane| rigid::backspin(&CASE, plane));
    dem.chain(rigid).chain(programs::one_grain(&VARIANTS)).chain(elastic::claims()).collect()
}

/// Compares a quantity of the last state with the rigid solution, in units of the rigid solution.
fn end(done: &FinishedRun, pick: fn(State) -> f64) -> Result<Measurement, MissingData> {
    on_plane::end(done, OneGrain::rigid_backspin, pick)
}

/// Returns the grain at a static overlap of 1e-3 R, and the time step (s).
fn soft(variant: &str) -> Option<(OneGrain, f64)> {
    let mut scene = CASE.variant(variant).ok()?;
    rest_at_overlap(&mut scene, 1e-3, DAMPING);
    Some((OneGrain::from_scene(&scene), STEP.steps(&scene).ok()?.0))
}

/// Returns the tolerance for the velocity halfway through the slide. The first step may have no friction.
fn first_step(variant: &str) -> Tolerance {
    computed(
        soft(variant).map_or(f64::NAN, |(grain, step)| 2.0 * step / sliding(&grain)),
        "in the convention of LAMMPS the disc slides from the start, but friction may be absent in the first step: Δt \
         over half the time of sliding",
    )
}

/// Returns the relative tolerance for the displacement at 1 s: soft contact, and a first step without friction.
fn fallen_behind(variant: &str) -> Tolerance {
    let behind = |(grain, step): (OneGrain, f64)| {
        (grain.tail() + grain.friction * grain.onto * step * sliding(&grain)) / grain.rigid_backspin(1.0).x
    };
    computed(
        soft(variant).map_or(f64::NAN, behind),
        "the Coulomb limit includes the dashpot, so friction falls below the limit at the slip velocity s_c = γ_t μ g \
         (1 + 1/i)/(k_t/m), which costs up to f s_c γ_t/(k_t/m); friction may be absent in the first step, μ g Δt t_s",
    )
}

fn rigid(variant: &'static str) -> Vec<Claim> {
    let quantity_claim =
        |quantity: &str, unit| claim(quantity, unit).run(at_overlap(variant, "dem:lammps", 1e-3, DAMPING, STEP));
    vec![
        quantity_claim("displacement at 1 s", "m")
            .equals(SOURCE, |done| end(&done[0], |state| state.x))
            .within(fallen_behind(variant))
            .refuses(stronger_friction()),
        quantity_claim("spin at 1 s", "rad/s")
            .equals(SOURCE, |done| end(&done[0], |state| state.omega))
            .within(incline::come_to_roll(&CASE, variant, sliding))
            .refuses(other_inertia()),
        quantity_claim("velocity halfway through the slide", "m/s")
            .equals(Source::Derived("v = μ g t up to t_s"), |done| velocity_halfway(&done[0]))
            .within(first_step(variant))
            .refuses(stronger_friction()),
    ]
}

/// Returns solver-independent claims for a contact so stiff that all conventions nearly agree.
fn near_rigid(variant: &'static str) -> Vec<Claim> {
    let slides = |allowed| {
        estimated(
            allowed,
            "the contact is elastic before it slides and vibrates when it rolls: ∝ √(overlap/R), here 1e-5",
        )
        .up_to(2.0 * allowed)
    };
    // A lever arm a changes the velocity by (1−i)/(1+i) times (R−a)/R, and the spin by 2/(1+i) times (R−a)/R, with
    // i = 2/5 or 1/2.
    let arm = |times: f64| {
        computed(
            times * NEARLY_RIGID,
            "lever arm between R and R − overlap: overlap/R = 1e-5 times (1−i)/(1+i), for the spin times 2/(1+i)",
        )
    };
    let allowed = [slides(5e-5), slides(2e-4), arm(1.0), arm(1.5)];
    let [x, half, v, omega] = on_plane::near_rigid(variant, SOURCE, velocity_halfway, end, allowed);
    vec![
        x.at_other_numbers("displacement at the end", ELSEWHERE, displaced),
        half.at_other_numbers("velocity halfway through the slide", ELSEWHERE, halfway),
        v.at_other_numbers("velocity at the end", ELSEWHERE, rolling),
        omega.at_other_numbers("spin at the end", ELSEWHERE, rolling),
    ]
}

/// Reason for the tolerance under parameter variation.
const ELSEWHERE: &str = "half a period of each spring until friction acts in full, over the time of sliding; for \
                         rolling grains overlap/R for the lever arm and the velocity of the undamped vibration of the \
                         spring";

/// Returns the time at which sliding ends (s).
fn sliding(grain: &OneGrain) -> f64 {
    grain.backspin_velocity(grain.radius) / (grain.friction * grain.onto)
}

/// Returns the largest relative error of the velocity halfway through the slide, for varied parameters.
fn halfway(scene: &Scene) -> f64 {
    let grain = OneGrain::from_scene(scene);
    2.0 * grain.onset() / sliding(&grain)
}

/// Returns the largest relative error of final velocity and spin, for varied parameters.
fn rolling(scene: &Scene) -> f64 {
    let grain = OneGrain::from_scene(scene);
    grain.overlap_ratio + grain.ringing(grain.friction * grain.onto) / grain.backspin_velocity(grain.radius)
}

/// Returns the largest relative error of the displacement, for varied parameters.
fn displaced(scene: &Scene) -> f64 {
    let grain = OneGrain::from_scene(scene);
    let end = scene.duration.seconds().unwrap_or(f64::NAN);
    rolling(scene) + grain.backspin_velocity(grain.radius) * grain.onset() / grain.rigid_backspin(end).x
}

fn velocity_halfway(done: &FinishedRun) -> Result<Measurement, MissingData> {
    let grain = OneGrain::from_scene(&done.scene);
    let (t, state) = nearest(done, 0.5 * sliding(&grain))?;
    Ok(Measurement::relative(state.v, grain.rigid_backspin(t).v))
}

fn final_motion(variant: &'static str) -> Vec<Claim> {
    let source = Source::Derived("v = iR²Ω₀a/(a² + iR²) with arm a (derivation)");
    let exact = |scene: &Scene, arm| OneGrain::from_scene(scene).backspin_velocity(arm);
    on_plane::final_velocity(variant, source, exact, &incline::come_to_roll(&CASE, variant, sliding))
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for variant in VARIANTS {
        let done = runner.run(&at_overlap(variant, "dem:lammps", 1e-3, DAMPING, STEP))?;
        let grain = OneGrain::from_scene(&done.scene);
        let states = course(&done).unwrap_or_default();
        let surface = |state: &State| state.omega * grain.radius;
        let thin =
            |pick: &dyn Fn(&State) -> f64| states.iter().step_by(4).map(|(t, state)| (*t, pick(state))).collect();
        curves.push(Curve::new(format!("{variant}: v"), Stroke::Markers, thin(&|state| state.v)));
        curves.push(Curve::new(format!("{variant}: ΩR"), Stroke::Markers, thin(&surface)));
        let exact = |pick: &dyn Fn(State) -> f64| {
            (0..=200).map(|k| f64::from(k) / 200.0).map(|t| (t, pick(grain.rigid_backspin(t)))).collect()
        };
        curves.push(Curve::new(format!("{variant}: v, rigid"), Stroke::Dashed, exact(&|state| state.v)));
        curves.push(Curve::new(format!("{variant}: ΩR, rigid"), Stroke::Dashed, exact(&|state| surface(&state))));
    }
    let velocity = Figure::graph(
        "velocity",
        "From sliding to rolling",
        "The velocity v rises and the surface speed ΩR falls at constant rates until they are equal. Then the grain \
         rolls. `dem:lammps` at overlap/R = 10⁻³ (markers) is compared with the exact solution of a rigid grain \
         (dashes).",
        [Axis::linear("time t (s)"), Axis::linear("velocity v, surface speed ΩR (m/s)")],
        curves,
    );
    Ok(vec![velocity, rigid::figure(runner, RIGID, OneGrain::rigid_backspin)?, elastic::figure(runner)?])
}
