//! A grain placed on a moving belt slides until it rolls.

use crate::exact::one_grain::{OneGrain, State, course, last, nearest, rest_at_overlap};
use crate::rows::on_plane::{
    self, DAMPING, NEARLY_RIGID, STEP, at_overlap, nearly_rigid, other_inertia, stronger_friction,
};
use crate::rows::{programs, rigid};
use grainbench_harness::prelude::*;
use grainbench_rigid::settings::Settings;
use std::f64::consts::TAU;

const LEVELS: &[Level] = &[fraction("dt=.1", 0.1), fraction("dt=.03", 0.03), fraction("dt=.01", 0.01)];
const VARIANTS: [&str; 2] = ["disc", "sphere"];
/// Variant with a belt that stops.
const STOPS: &str = "stops";

const SOURCE: Source = Source::Derived("a rigid grain slides on the belt, then rolls (derivation)");
const STOPPED: Source =
    Source::Derived("no angular momentum about the belt: at rest after the displacement f V T (derivation)");

pub(crate) static CASE: Case = crate::heads::BELT.with(LEVELS, 2, &claims).drawn_by(figures);

struct Belt {
    grain: OneGrain,
    /// Belt speed V (m/s).
    speed: f64,
    /// Time at which the belt stops (s).
    stop: f64,
}

impl Belt {
    fn from_scene(scene: &Scene) -> Self {
        let phase = scene.walls[0].motion.phases.first();
        Self {
            grain: OneGrain::from_scene(scene),
            speed: phase.map_or(f64::NAN, |phase| phase.velocity.x),
            stop: phase.map_or(f64::NAN, |phase| phase.stop.seconds(f64::INFINITY)),
        }
    }

    /// Returns the acceleration by friction, μ g (m/s²).
    fn push(&self) -> f64 {
        self.grain.friction * self.grain.onto
    }

    /// Returns the velocity of rolling, f V (m/s).
    fn rolling(&self) -> f64 {
        self.grain.share() * self.speed
    }

    /// Returns the duration t_s of sliding (s).
    fn sliding(&self) -> f64 {
        self.rolling() / self.push()
    }

    /// Returns the state of a rigid grain at t (s). The belt stops after the grain has started to roll, or never.
    fn rigid(&self, t: f64) -> State {
        let Self { grain, stop, .. } = self;
        let turn = grain.inertia_factor * grain.radius;
        let sped_up = |t: f64| {
            let slid = t.min(self.sliding());
            let v = self.push() * slid;
            State { x: 0.5 * v * slid + v * (t - slid), v, omega: -v / turn }
        };
        let (now, since) = (sped_up(t), sped_up((t - stop).max(0.0)));
        // Superposition: from the stop on, the motion due to a second belt, which runs backwards, is added.
        State { x: now.x - since.x, v: now.v - since.v, omega: now.omega - since.omega }
    }

    /// Returns the velocity of rolling for a lever arm of friction (m/s).
    fn rolling_at(&self, arm: f64) -> f64 {
        let moment = self.grain.inertia_factor * self.grain.radius.powi(2);
        self.speed * moment / (moment + arm * arm)
    }

    /// Returns the largest delay (s) until friction is fully mobilised: spring displacement over V, plus a step (s).
    fn lag(&self, step: f64) -> f64 {
        self.grain.stretch(self.push()) / self.speed + step
    }

    /// Returns the largest relative error of the displacement at t (s), for a time step (s).
    fn displaced(&self, t: f64, step: f64) -> f64 {
        (self.rolling() * self.lag(step) + self.grain.stretch(self.push())) / self.rigid(t).x
    }

    /// Returns the largest error of the distance of the second slide (m). The spring oscillates at the start of this
    /// slide with a velocity of up to μ g/ω, and sliding lasts f V/(μ g).
    fn rung(&self) -> f64 {
        self.rolling() * self.grain.ringing(self.push()) / self.push()
    }

    /// Returns the velocity after the first step (m/s) if the Coulomb limit does not apply to the dashpot: for a belt
    /// that moves from step 1 on, and for a belt that moves from step 0 on.
    fn kicked(&self, scene: &Scene, step: f64) -> [f64; 2] {
        let law = scene.laws.iter().flatten().next().copied().unwrap_or_default();
        let spring = self.grain.tangential_stiffness / self.grain.mass * step;
        let pushed = |slip: f64| 0.5 * step * (law.tangential_damping + spring) * slip;
        let half = 0.5 * law.tangential_damping * self.speed * step;
        let slip = self.speed - (1.0 + 1.0 / self.grain.inertia_factor) * half;
        [pushed(self.speed), half + pushed(slip)]
    }
}

fn claims() -> Vec<Claim> {
    let of_both = |variant| [near_rigid(variant).to_vec(), final_motion(variant), by_impulses(variant)].concat();
    let mut claims: Vec<Claim> = VARIANTS.into_iter().flat_map(of_both).collect();
    claims.extend(stopped());
    claims.push(kick());
    // Damped runs against LIGGGHTS are left out. At step 0, the belt moves for the dashpot of LIGGGHTS and is at rest
    // for our dashpot: see `kick`.
    let is_kicked = |claim: &Claim| claim.runs[1].solver == "liggghts" && claim.quantity.contains(", damped,");
    claims.extend(programs::one_grain(&VARIANTS).into_iter().filter(|claim| !is_kicked(claim)));
    claims
}

/// Compares a quantity of the last state with the rigid solution, in units of the rigid solution.
fn end(done: &FinishedRun, pick: fn(State) -> f64) -> Result<Measurement, MissingData> {
    let (t, state) = last(done)?;
    Ok(Measurement::relative(pick(state), pick(Belt::from_scene(&done.scene).rigid(t))))
}

/// Compares the velocity at half the time of sliding with the rigid solution.
fn velocity_halfway(done: &FinishedRun) -> Result<Measurement, MissingData> {
    let belt = Belt::from_scene(&done.scene);
    let (t, state) = nearest(done, 0.5 * belt.sliding())?;
    Ok(Measurement::relative(state.v, belt.rigid(t).v))
}

/// Returns a number computed from the belt of a nearly rigid run and from the time step (s) of this run.
fn stiff(variant: &str, value: impl FnOnce(&Belt, f64) -> f64) -> f64 {
    CASE.number(variant, |scene| {
        let mut scene = scene.clone();
        rest_at_overlap(&mut scene, NEARLY_RIGID, DAMPING);
        let belt = Belt::from_scene(&scene);
        let Resolution::CriticalFraction(fraction) = STEP else { return f64::NAN };
        let step = fraction * 2.0 * (belt.grain.mass / belt.grain.normal_stiffness).sqrt();
        value(&belt, step)
    })
}

/// Returns solver-independent claims for a contact so stiff that all conventions nearly agree.
fn near_rigid(variant: &'static str) -> [Claim; 4] {
    let arm = |times: f64| {
        computed(
            times * NEARLY_RIGID,
            "lever arm between R and R − overlap: at most 2/(1+i) < 2 times overlap/R = 1e-5, for the spin half of \
             that",
        )
    };
    let displaced = computed(
        stiff(variant, |belt, step| belt.displaced(1.0, step)),
        "(f V (s/V + Δt) + s)/x: spring displacement s = μ m g/k_t before and after sliding, and one step without \
         friction",
    );
    let halfway = computed(
        stiff(variant, |belt, step| 2.0 * belt.lag(step) / belt.sliding()),
        "2 (s/V + Δt)/t_s: the spring must reach the displacement s = μ m g/k_t, and friction may be absent in the \
         first step",
    );
    on_plane::near_rigid(variant, SOURCE, velocity_halfway, end, [displaced, halfway, arm(2.0), arm(1.0)])
}

/// Returns the tolerance for the rounding error of a sum over all steps of a run at overlap/R = 1e-3.
fn rounding() -> Tolerance {
    let steps = 1.0 / (0.01 * 2.0 * (1e-3_f64 * 0.5 / 9.8).sqrt());
    computed(
        steps * f64::EPSILON,
        "rounding, 2⁻⁵² in each of 7000 steps: angular momentum determines the value once the spring is at rest",
    )
}

fn final_motion(variant: &'static str) -> Vec<Claim> {
    let source = Source::Derived("v = V iR²/(iR² + a²) with arm a (derivation)");
    on_plane::final_velocity(variant, source, |scene, arm| Belt::from_scene(scene).rolling_at(arm), &rounding())
}

/// Returns the claims on the solver `rigid` (rapier), whose contacts have no compliance. The error of `rigid` comes
/// from the time step and from the overlap at rest (see `cases/src/rows/rigid.rs`).
fn by_impulses(variant: &'static str) -> Vec<Claim> {
    let step = Resolution::RIGID_STEP / f64::from(rigid::SUBSTEPS);
    let sunk =
        stiff(variant, |belt, _| belt.grain.onto / (TAU * Settings::default().frequency).powi(2) / belt.grain.radius);
    let lag = stiff(variant, |belt, _| belt.rolling() * step / belt.rigid(1.0).x);
    let arm = "lever arm between R and R − δ with the static overlap δ = g/(2πf)²: at most 2/(1+i) < 2 times δ/R, for \
               the spin half of that";
    let late = "f V Δt/x: friction begins or ends up to a step Δt late";
    let allowed = [computed(lag, late), computed(2.0 * sunk, arm), computed(sunk, arm)];
    rigid::against(variant, SOURCE, end, [stronger_friction(), other_inertia()], allowed)
}

/// Returns the claims on a disc on a belt that stops. Velocity and spin become zero.
fn stopped() -> Vec<Claim> {
    let turning = || {
        Control::scene("a disc that turns at first, at a thousandth of the belt's speed", |scene| {
            scene.grains[0].spin.z = -0.01;
        })
    };
    let stopped_claim =
        |quantity: &str, unit, tolerance, tangential_dashpot, control, pick: fn(State, &Belt) -> [f64; 3]| {
            claim(format!("{quantity} after the belt has stopped, nearly rigid contact"), unit)
                .run(nearly_rigid(STOPS, tangential_dashpot))
                .equals(STOPPED, move |done| {
                    let (_, state) = last(&done[0])?;
                    let [value, exact, scale] = pick(state, &Belt::from_scene(&done[0].scene));
                    Ok(Measurement::new(value, exact, scale))
                })
                .within(tolerance)
                .refuses(control)
                .solver_independent()
        };
    let displaced = computed(
        stiff(STOPS, |belt, step| {
            let way = belt.rolling() * belt.stop;
            (2.0 * (belt.rolling() * belt.lag(step) + belt.grain.stretch(belt.push())) + belt.rung()) / way
        }),
        "(2 f V (s/V + Δt) + 2 s + f V/ω)/(f V T): spring displacement s = μ m g/k_t before and after sliding and one \
         step without friction, each for both slides; and the vibration of the spring with ω, whose phase at the stop \
         of the belt is unknown",
    );
    let rest = || {
        computed(
            2.0 * NEARLY_RIGID,
            "overlap/R = 1e-5 for the lever arm of each of the two slides, an upper bound: an arm that differs leaves \
             i/(1 + i)² < 1/4 of it; in units of the speed of the belt",
        )
    };
    vec![
        stopped_claim("displacement", "m", displaced, false, other_inertia(), |state, belt| {
            let way = belt.rolling() * belt.stop;
            [state.x, way, way]
        }),
        stopped_claim("velocity", "m/s", rest(), true, turning(), |state, belt| [state.v, 0.0, belt.speed]),
        stopped_claim("spin", "rad/s", rest(), true, turning(), |state, belt| {
            [state.omega, 0.0, belt.speed / belt.grain.radius]
        }),
    ]
}

/// Returns the claim on the first step of LIGGGHTS, whose dashpot acts at step 0, when our belt is still at rest.
fn kick() -> Claim {
    let runs = ["dem:liggghts", "liggghts"].map(|solver| {
        Run::new("disc", solver, Resolution::TimeStep(1e-4)).adjusted("one step, overlap/R = 1e-3", |scene| {
            rest_at_overlap(scene, 1e-3, DAMPING);
            scene.duration = Duration::Cycles(1);
            scene.sampling = Sampling::Cycles(1);
        })
    });
    claim("velocity after the first step, LIGGGHTS' less ours", "m/s")
        .runs(runs)
        .equals(Source::Derived("a dashpot without Coulomb limit, from step 0 or 1 on (derivation)"), |done| {
            let [ours, program] = [last(&done[0])?.1.v, last(&done[1])?.1.v];
            let kicked = Belt::from_scene(&done[0].scene).kicked(&done[0].scene, done[0].record.provenance.time_step);
            Ok(Measurement::new(program - ours, kicked[1] - kicked[0], kicked[1]))
        })
        .within(computed(
            1e-3,
            "overlap/R, for a lever arm between R and R − overlap; in units of the velocity of LIGGGHTS",
        ))
        .refuses(Control::our_contact_law("a dashpot along the belt × 1.05 in ours", |law| {
            law.tangential_damping *= 1.05
        }))
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for (variant, shown) in [("disc", "disc"), ("sphere", "sphere"), (STOPS, "disc, belt stops")] {
        let done = runner.run(&at_overlap(variant, "dem:lammps", 1e-3, DAMPING, STEP))?;
        let belt = Belt::from_scene(&done.scene);
        let states = course(&done).unwrap_or_default();
        let thin = states.iter().step_by(4).map(|(t, state)| (*t, state.v)).collect();
        curves.push(Curve::new(format!("{shown}: v"), Stroke::Markers, thin));
        let exact = (0..=200).map(|k| f64::from(k) / 200.0).map(|t| (t, belt.rigid(t).v)).collect();
        curves.push(Curve::new(format!("{shown}: v, rigid"), Stroke::Dashed, exact));
    }
    Ok(vec![Figure::graph(
        "velocity",
        "From sliding to rolling on a belt",
        "The belt runs at 3 m/s. The velocity rises at μ g until the grain rolls, at 1/3 (disc) or 2/7 (sphere) of \
         the belt's velocity. When the belt stops, the disc comes to rest. `dem:lammps` at overlap/R = 10⁻³ \
         (markers) is compared with the exact solution of a rigid grain (dashes).",
        [Axis::linear("time t (s)"), Axis::linear("velocity v (m/s)")],
        curves,
    )])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that displacement and velocity equal those of `backspin` with the initial surface speed R Ω₀ = V.
    #[test]
    fn is_backspin_seen_from_the_belt() {
        let belt = Belt::from_scene(&CASE.variant("disc").unwrap());
        let grain = OneGrain { spin: belt.speed / belt.grain.radius, ..belt.grain };
        for t in [0.1, 0.3, 0.4, 1.0] {
            let (here, there) = (belt.rigid(t), grain.rigid_backspin(t));
            assert!((here.x - there.x).abs() < 1e-12 && (here.v - there.v).abs() < 1e-12, "{t}");
        }
    }

    /// Checks that the disc comes to rest after the displacement f V T and slides equally long on both belts.
    #[test]
    fn a_belt_that_stops_brings_it_to_rest() {
        let belt = Belt::from_scene(&CASE.variant(STOPS).unwrap());
        let end = belt.rigid(1.0);
        assert!(end.v.abs() < 1e-14 && end.omega.abs() < 1e-13);
        assert!((end.x - 0.5).abs() < 1e-14, "{}", end.x);
        assert!(belt.sliding() < belt.stop && belt.stop + belt.sliding() < 1.0);
    }
}
