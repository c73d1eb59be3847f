//! A sphere rolls to rest and rocks on its rolling spring. In two further variants, a disc rocks between two driven
//! discs, which translate without rotation.

use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[fraction("dt=.1", 0.1), fraction("dt=.03", 0.03), fraction("dt=.01", 0.01)];
const STEP: Level = LEVELS[1];

pub(crate) static CASE: Case = crate::heads::ROCKING.with(LEVELS, 1, &claims);

/// Parameters of a sphere that rolls to rest.
struct RollToRest {
    radius: f64,
    /// Angle at which the rolling spring yields (rad).
    yields: f64,
    /// Distance that the sphere rolls until it first stops (m).
    way: f64,
    /// Largest relative errors of the way back 2Rθ_y, and of the distance `way`.
    off: [f64; 2],
}

impl RollToRest {
    fn from_scene(scene: &Scene) -> Self {
        let (grain, law) = (&scene.grains[0], scene.laws[0].unwrap_or_default());
        let (radius, gravity, speed) = (grain.radius, scene.gravity.norm(), grain.velocity.norm());
        let arm = law.rolling_friction * radius;
        let (rolling, limit) = (2.25 * law.normal_stiffness() * arm * arm, arm * grain.mass * gravity);
        let yields = limit / rolling;
        let way = 0.7 * grain.mass * speed * speed * radius / limit + 0.5 * radius * yields;
        let soft = rolling / (law.tangential_stiffness() * radius * radius);
        // Bound of the velocity of the tangential spring's vibration after the moment has grown, over the initial speed.
        let swing = 20.0 / 49.0 * soft;
        let step = STEP.step(scene);
        // Samples are ten steps apart, so the turning points of the oscillation, 2Rθ apart, lie between samples.
        let phase = (10.0 * step).powi(2) * rolling / (1.4 * grain.mass * radius * radius) / 8.0;
        Self { radius, yields, way, off: [soft + phase + swing * way / (radius * yields), 2.0 * swing + soft] }
    }
}

/// Returns the largest position, and the smallest later position (m).
fn turning_points(done: &FinishedRun) -> Result<[f64; 2], MissingData> {
    let places = done.column("grain.x")?;
    let farthest = (0..places.len()).max_by(|&a, &b| places[a].total_cmp(&places[b])).unwrap_or(0);
    Ok([places[farthest], places[farthest..].iter().copied().fold(f64::INFINITY, f64::min)])
}

fn claims() -> Vec<Claim> {
    vec![back(), way(), between("between"), between("backwards")]
}

fn back() -> Claim {
    claim("way back from where the sphere came to rest", "m")
        .run(Run::new("to-rest", "dem", STEP.resolution))
        .equals(Source::Derived("2Rθ_y, θ_y = μ_r R F_n/k_r (derivation)"), |done| {
            let [stop, back] = turning_points(&done[0])?;
            let rest = RollToRest::from_scene(&done[0].scene);
            let exact = 2.0 * rest.radius * rest.yields;
            Ok(Measurement::relative(stop - back, exact))
        })
        .within(computed(
            CASE.number("to-rest", |scene| RollToRest::from_scene(scene).off[0]),
            "compliance of the tangential spring, k_r/k_tR²; its vibration at the start, (20/49) k_r/k_tR² of the \
             velocity, times x_s/Rθ_y; turning points between samples, (ω_rΔt)²/8",
        ))
        .refuses(Control::contact_law("rolling resistance × 1.1", |law| law.rolling_friction *= 1.1))
        .solver_independent_springs()
}

fn way() -> Claim {
    claim("way to rest", "m")
        .run(Run::new("to-rest", "dem", STEP.resolution))
        .equals(Source::Derived("(7/10) m v₀² = μ_r m g (x_s/R − θ_y/2) R (derivation)"), |done| {
            Ok(Measurement::relative(turning_points(&done[0])?[0], RollToRest::from_scene(&done[0].scene).way))
        })
        .within(computed(
            CASE.number("to-rest", |scene| RollToRest::from_scene(scene).off[1]),
            "vibration of the tangential spring at the start, twice (20/49) k_r/k_tR² of the velocity; and k_r/k_tR²",
        ))
        .refuses(Control::contact_law("rolling resistance × 1.1", |law| law.rolling_friction *= 1.1))
        .solver_independent_springs()
}

/// Returns the frequency of the disc's rocking between two discs (rad/s), and the largest relative error of the spin.
fn rocks(scene: &Scene) -> [f64; 2] {
    let (grain, law) = (&scene.grains[0], scene.laws[0].unwrap_or_default());
    let each = |other: &Grain| {
        let effective = grain.radius * other.radius / (grain.radius + other.radius);
        let rolling = 2.25 * law.normal_stiffness() * (law.rolling_friction * effective).powi(2);
        law.tangential_stiffness() * grain.radius.powi(2) + rolling
    };
    let touches = |other: &&Grain| (other.position - grain.position).norm() < grain.radius + other.radius;
    let stiffness: f64 = scene.grains.iter().skip(1).filter(touches).map(each).sum();
    let rate = (stiffness / grain.inertia).sqrt();
    let phase = rate * scene.duration.seconds().unwrap_or(f64::NAN);
    let step = STEP.step(scene);
    let overlap = 1e-3;
    [rate, phase * (0.5 * overlap / grain.radius + (rate * step).powi(2) / 24.0) + (rate * step).powi(2) / 8.0]
}

fn between(variant: &'static str) -> Claim {
    let forth = if variant == "between" { "forth" } else { "back" };
    claim(format!("spin of the disc between two that run {forth}, worst"), "rad/s")
        .run(Run::new(variant, "dem", STEP.resolution))
        .follows(
            Source::Derived("ω₀ cos ω_s t, ω_s² = Σ (k_t R² + k_r)/I (derivation)"),
            |done| samples(done, "grain.omega"),
            |done, time| done.scene.grains[0].spin.z * (rocks(&done.scene)[0] * time).cos(),
            |done| done.scene.grains[0].spin.z,
        )
        .within(computed(
            CASE.number(variant, |scene| rocks(scene)[1]),
            "lever arms differ by up to the overlap, ω_s t δ/2R; central differences, ω_s t (ω_sΔt)²/24 and (ω_sΔt)²/8 \
             of a velocity; relative to ω₀",
        ))
        .refuses(Control::contact_law("rolling resistance × 1.05", |law| law.rolling_friction *= 1.05))
        .solver_independent_springs()
}
