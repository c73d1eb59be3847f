//! A small grain hits a large one at an angle and slips during the whole impact. The velocities and spins of both
//! grains have exact values.

use crate::rows::on_plane::stronger_friction;
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[fraction("dt=.1", 0.1), fraction("dt=.02", 0.02), fraction("dt=.005", 0.005)];
const VARIANTS: [&str; 3] = ["spheres", "discs", "hertz"];

pub(crate) static CASE: Case =
    Case { levels: LEVELS, default_level: LEVELS[1], claims: &claims, ..crate::heads::UNEQUAL_IMPACT };

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

/// Measured quantity with its name, unit, column and exact value. `given` returns the change due to the impulse, to
/// which errors are relative.
struct Quantity {
    name: &'static str,
    unit: &'static str,
    column: &'static str,
    exact: fn(&Impact) -> f64,
    given: fn(&Impact) -> f64,
}

const QUANTITIES: [Quantity; 6] = [
    Quantity {
        name: "velocity of the small grain along the line of centres",
        unit: "m/s",
        column: "small.vx",
        exact: |impact| impact.before[0] - impact.impulse[0] / impact.masses[0],
        given: |impact| impact.impulse[0] / impact.masses[0],
    },
    Quantity {
        name: "velocity of the large grain along the line of centres",
        unit: "m/s",
        column: "large.vx",
        exact: |impact| impact.impulse[0] / impact.masses[1],
        given: |impact| impact.impulse[0] / impact.masses[1],
    },
    Quantity {
        name: "velocity of the small grain across it",
        unit: "m/s",
        column: "small.vy",
        exact: |impact| impact.before[1] - impact.impulse[1] / impact.masses[0],
        given: |impact| impact.impulse[0] / impact.masses[0],
    },
    Quantity {
        name: "velocity of the large grain across it",
        unit: "m/s",
        column: "large.vy",
        exact: |impact| impact.impulse[1] / impact.masses[1],
        given: |impact| impact.impulse[0] / impact.masses[1],
    },
    Quantity {
        name: "spin of the small grain",
        unit: "rad/s",
        column: "small.omega",
        exact: |impact| -impact.impulse[1] * impact.radii[0] / impact.inertias[0],
        given: |impact| impact.impulse[1] * impact.radii[0] / impact.inertias[0],
    },
    Quantity {
        name: "spin of the large grain",
        unit: "rad/s",
        column: "large.omega",
        exact: |impact| -impact.impulse[1] * impact.radii[1] / impact.inertias[1],
        given: |impact| impact.impulse[1] * impact.radii[1] / impact.inertias[1],
    },
];

fn claims() -> Vec<Claim> {
    VARIANTS.into_iter().flat_map(|variant| QUANTITIES.iter().map(move |quantity| row(variant, quantity))).collect()
}

fn row(variant: &'static str, quantity: &'static Quantity) -> Claim {
    let flat = variant == "discs";
    let spins = quantity.column.ends_with("omega");
    let column = if spins && !flat { format!("{}_z", quantity.column) } else { quantity.column.to_owned() };
    let allowed = CASE.number(variant, |scene| {
        let impact = Impact::from_scene(scene);
        impact.off * ((quantity.given)(&impact) / (quantity.exact)(&impact)).abs()
    });
    let along = quantity.column.ends_with("vx");
    let heavier = Control::scene("the large grain a hundredth heavier", |scene| scene.grains[1].mass *= 1.01);
    claim(quantity.name, quantity.unit)
        .run(Run::new(variant, "dem", LEVELS[1].resolution))
        .equals(Source::Derived("momentum, restitution 1 and Coulomb's limit throughout (derivation)"), move |done| {
            Ok(Measurement::relative(done[0].last(&column)?, (quantity.exact)(&Impact::from_scene(&done[0].scene))))
        })
        .within(computed(
            allowed,
            "the line of centres turns by α during contact, α (1 + u/v); lever arms are between R and R − δ/2; contact \
             begins and ends within a step, (ωΔt)²/8; all relative to the impulse",
        ))
        .refuses(if along { heavier } else { stronger_friction() })
        .fair_to_any_springs()
}
