//! A small grain hits a large one at an angle and slips during the whole impact. The velocities and spins of both
//! grains have exact values.

use crate::rows::on_plane::stronger_friction;
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[fraction("dt=.1", 0.1), fraction("dt=.02", 0.02), fraction("dt=.005", 0.005)];
const VARIANTS: [&str; 3] = ["spheres", "discs", "hertz"];

pub(crate) static CASE: Case = crate::heads::UNEQUAL_IMPACT.with(LEVELS, 1, &claims);

/// Parameters and exact values of the impact.
struct Impact {
    /// Velocity of the small grain along the line of centres and across it (m/s).
    before: [f64; 2],
    /// Impulse along the normal and along the tangent (N s).
    impulse: [f64; 2],
    /// Masses of the small and the large grain (kg).
    masses: [f64; 2],
    /// Radii (m).
    radii: [f64; 2],
    /// Moments of inertia (kg m²).
    inertias: [f64; 2],
    /// Largest relative error of an impulse or a spin.
    off: f64,
}

impl Impact {
    fn from_scene(scene: &Scene) -> Self {
        let pair = |read: fn(&Grain) -> f64| [read(&scene.grains[0]), read(&scene.grains[1])];
        let (masses, radii) = (pair(|grain| grain.mass), pair(|grain| grain.radius));
        let before = [scene.grains[0].velocity.x, scene.grains[0].velocity.y];
        let law = scene.laws[0].unwrap_or_default();
        let reduced = masses[0] * masses[1] / (masses[0] + masses[1]);
        let normal = 2.0 * reduced * before[0];
        let effective = radii[0] * radii[1] / (radii[0] + radii[1]);
        let (overlap, time) = if law.is_hertz() {
            let stiffness = 4.0 / 3.0 * law.effective_modulus() * effective.sqrt();
            let overlap = (1.25 * reduced * before[0].powi(2) / stiffness).powf(0.4);
            (overlap, 2.943_275_184 * overlap / before[0])
        } else {
            let rate = (law.normal_stiffness() / reduced).sqrt();
            (before[0] / rate, PI / rate)
        };
        let turned = before[1] * time / (radii[0] + radii[1]);
        let step = LEVELS[1].step(scene);
        let phase = law.springs.stiffness(overlap, effective).0 / reduced * step * step / 8.0;
        let off = turned * (1.0 + before[1] / before[0]) + 0.5 * overlap / radii[0] + phase;
        let impulse = [normal, law.friction * normal];
        Self { before, impulse, masses, radii, inertias: pair(|grain| grain.inertia), off }
    }
}

/// Quantity of each grain: its name before and after the size of the grain, its unit and column, its exact value, and the
/// change due to the impulse, to which errors are relative. Both functions take the index of the grain.
type Quantity = ([&'static str; 2], &'static str, &'static str, GrainValue, GrainValue);
type GrainValue = fn(&Impact, usize) -> f64;

const QUANTITIES: [Quantity; 3] = [
    (
        ["velocity", " along the line of centres"],
        "m/s",
        "vx",
        |impact, at| match at {
            0 => impact.before[0] - impact.impulse[0] / impact.masses[0],
            _ => impact.impulse[0] / impact.masses[1],
        },
        |impact, at| impact.impulse[0] / impact.masses[at],
    ),
    (
        ["velocity", " across it"],
        "m/s",
        "vy",
        |impact, at| match at {
            0 => impact.before[1] - impact.impulse[1] / impact.masses[0],
            _ => impact.impulse[1] / impact.masses[1],
        },
        |impact, at| impact.impulse[0] / impact.masses[at],
    ),
    (
        ["spin", ""],
        "rad/s",
        "omega",
        |impact, at| -impact.impulse[1] * impact.radii[at] / impact.inertias[at],
        |impact, at| impact.impulse[1] * impact.radii[at] / impact.inertias[at],
    ),
];

fn claims() -> Vec<Claim> {
    let of_quantity =
        |variant, quantity| ["small", "large"].into_iter().enumerate().map(move |grain| row(variant, quantity, grain));
    let of_variant = |variant| QUANTITIES.into_iter().flat_map(move |quantity| of_quantity(variant, quantity));
    VARIANTS.into_iter().flat_map(of_variant).collect()
}

fn row(
    variant: &'static str,
    ([name, place], unit, column, exact, given): Quantity,
    (at, size): (usize, &str),
) -> Claim {
    let has_axis = column == "omega" && variant != "discs";
    let probed = format!("{size}.{column}{}", if has_axis { "_z" } else { "" });
    let allowed = CASE.number(variant, |scene| {
        let impact = Impact::from_scene(scene);
        impact.off * (given(&impact, at) / exact(&impact, at)).abs()
    });
    let heavier = Control::scene("the large grain a hundredth heavier", |scene| scene.grains[1].mass *= 1.01);
    claim(format!("{name} of the {size} grain{place}"), unit)
        .run(Run::new(variant, "dem", LEVELS[1].resolution))
        .equals(Source::Derived("momentum, restitution 1 and Coulomb's limit throughout (derivation)"), move |done| {
            Ok(Measurement::relative(done[0].last(&probed)?, exact(&Impact::from_scene(&done[0].scene), at)))
        })
        .within(computed(
            allowed,
            "the line of centres turns by α during contact, α (1 + u/v); lever arms are between R and R − δ/2; contact \
             begins and ends within a step, (ωΔt)²/8; all relative to the impulse",
        ))
        .refuses(if column == "vx" { heavier } else { stronger_friction() })
        .solver_independent_springs()
}
