//! Impacts of Hertz spheres: benchmark tests 1 to 4 of Chung & Ooi (2011).

use crate::bench::Bench;
use crate::case::{Case, Rung, fraction};
use crate::figure::{Axis, Curve, Drawing, Figure, Graph, Stroke};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run, measure};
use crate::program_forces::forces;
use crate::program_rows::hertz_impact;
use crate::rigid_rows;
use crate::scope::Scope;
use crate::verdict::Evidence;
use grainbench_scene::scene::{ContactLaw, Scene};
use grainbench_scene::solver::RunError;
use std::f64::consts::PI;

const LADDER: &[Rung] = &[fraction("dt=.01", 0.01), fraction("dt=.003", 0.003), fraction("dt=.001", 0.001)];
const STEP: Rung = LADDER[2];
const ELASTIC: [&str; 4] = ["1-glass", "1-limestone", "2-aluminium-alloy", "2-magnesium-alloy"];
const DAMPED: [&str; 2] = ["3-aluminium-oxide", "3-cast-iron"];
const OBLIQUE: [&str; 2] = ["4-aluminium-oxide", "4-aluminium-alloy"];
const RESTITUTIONS: [f64; 5] = [0.1, 0.3, 0.5, 0.8, 1.0];
/// Angles of impact from the normal (degrees) on the sliding branch.
const ANGLES: [f64; 5] = [40.0, 50.0, 60.0, 70.0, 80.0];
const SOURCE: &str = "Chung & Ooi 2011, tests 1-4; closed forms in the derivation";

pub(crate) static CASE: Case = Case {
    name: "chung-ooi",
    title: "Impacts of Hertz spheres",
    claim: "Elastic impacts have Hertz's deepest overlap, force and duration; a coefficient of restitution is given back \
            exactly; an oblique impact that slides has the tangential restitution and spin of its friction impulse.",
    scene: include_str!("scene.toml"),
    derivation: include_str!("derivation.md"),
    weakness: "Impacts of one contact. The sliding branch is felt by μ and e alone: any tangential spring that reaches the \
               limit soon passes, so Mindlin's stiffness is not gated here, only drawn.",
    ladder: LADDER,
    default_rung: STEP,
    gates,
    figures,
};

fn gates() -> Vec<Gate> {
    let mut gates = [elastic(), restitution(), oblique(), rigid()].concat();
    for variant in [ELASTIC[0], ELASTIC[2], DAMPED[0], OBLIQUE[0]] {
        gates.extend(hertz_impact(variant, STEP.resolution, variant == OBLIQUE[0]));
    }
    for variant in [ELASTIC[0], ELASTIC[2]] {
        let run = |solver| Run::new(variant, solver, STEP.resolution);
        gates.extend(forces(run, &["contact.normal_force"], 1e-13, |scene, _| hertz(scene).1));
    }
    gates
}

/// The law of the contact that the scene is about: between spheres where there are two, else with the plane.
fn law(scene: &Scene) -> ContactLaw {
    let partner = if scene.grains.len() == 2 { scene.grains[1].material } else { scene.walls[0].material };
    scene.law(scene.grains[0].material, partner).copied().unwrap_or_default()
}

/// Hertz's k = (4/3)E*√R*, effective mass and closing speed.
fn impact(scene: &Scene) -> (f64, f64, f64) {
    let first = &scene.grains[0];
    let (radius, mass, speed) = match scene.grains.get(1) {
        Some(second) => (
            first.radius * second.radius / (first.radius + second.radius),
            first.mass * second.mass / (first.mass + second.mass),
            (first.velocity - second.velocity).norm(),
        ),
        None => (first.radius, first.mass, first.velocity.z.abs()),
    };
    (4.0 / 3.0 * law(scene).effective_modulus * radius.sqrt(), mass, speed)
}

/// Deepest overlap (m), largest force (N) and duration (s) of an elastic impact.
fn hertz(scene: &Scene) -> (f64, f64, f64) {
    let (k, mass, speed) = impact(scene);
    let overlap = (5.0 * mass * speed * speed / (4.0 * k)).powf(0.4);
    (overlap, k * overlap.powf(1.5), 2.943_275_184 * overlap / speed)
}

/// The largest value of a column, refined by the parabola through the three samples about it.
fn peak(values: &[f64]) -> f64 {
    let at = (1..values.len() - 1).max_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(1);
    let (left, top, right) = (values[at - 1], values[at], values[at + 1]);
    let bend = left - 2.0 * top + right;
    if bend < 0.0 { top - (right - left).powi(2) / (8.0 * bend) } else { top }
}

/// When the overlap ends: the last touching sample, and on at the closing speed it has there.
fn duration(done: &Done) -> Result<f64, Missing> {
    let overlap = done.column("contact.overlap")?;
    let time = &done.series().time;
    let last = overlap.iter().rposition(|&overlap| overlap > 0.0).ok_or_else(|| Missing("contact".to_owned()))?;
    let rate = (overlap[last - 1] - overlap[last]) / (time[last] - time[last - 1]);
    Ok(time[last] + overlap[last] / rate)
}

fn elastic() -> Vec<Gate> {
    let stiffer = || Control::scene("E* 1 % too large", |scene| scene.change_laws(|law| law.effective_modulus *= 1.01));
    let gate = |variant: &'static str, quantity: &str, unit, of: fn(&Done) -> Result<Measured, Missing>| Gate {
        quantity: quantity.to_owned(),
        unit,
        scope: Scope::Named,
        evidence: Evidence::Analytic,
        source: SOURCE,
        allowed: 1e-6,
        because: "discretisation of the impact by some thousand steps",
        runs: vec![Run::new(variant, "dem", STEP.resolution)],
        measure: measure(move |done| of(&done[0])),
        control: stiffer(),
    };
    let mut gates = Vec::new();
    for variant in ELASTIC {
        gates.push(gate(variant, "deepest overlap", "m", |done| {
            let exact = hertz(&done.scene).0;
            Ok(Measured::new(peak(done.column("contact.overlap")?), exact, exact))
        }));
        gates.push(gate(variant, "largest force", "N", |done| {
            let exact = hertz(&done.scene).1;
            Ok(Measured::new(peak(done.column("contact.normal_force")?), exact, exact))
        }));
        gates.push(gate(variant, "duration of contact", "s", |done| {
            let exact = hertz(&done.scene).2;
            Ok(Measured::new(duration(done)?, exact, exact))
        }));
    }
    gates
}

/// ζ of a coefficient of restitution.
fn damping_ratio(restitution: f64) -> f64 {
    let log = restitution.ln();
    -log / (PI * PI + log * log).sqrt()
}

fn with_restitution(variant: &'static str, restitution: f64) -> Run {
    Run::new(variant, "dem", STEP.resolution).adjusted(&format!("e = {restitution}"), move |scene| {
        scene.change_laws(|law| law.damping_ratio = damping_ratio(restitution));
    })
}

fn rebound(done: &Done) -> Result<f64, Missing> {
    Ok(-done.last("a.vz")? / done.scene.grains[0].velocity.z)
}

fn restitution() -> Vec<Gate> {
    let gate = |variant: &'static str, restitution: f64| Gate {
        quantity: format!("rebound velocity over impact velocity, e = {restitution}"),
        unit: "1",
        scope: Scope::Named,
        evidence: Evidence::Analytic,
        source: SOURCE,
        allowed: 2e-4,
        because: "the dashpot is half a step late and release falls within a step: first order in Δt",
        runs: vec![with_restitution(variant, restitution)],
        measure: measure(move |done| Ok(Measured::new(rebound(&done[0])?, restitution, 1.0))),
        control: if restitution == 1.0 {
            Control::scene("a little damping, e = .99", |scene| {
                scene.change_laws(|law| law.damping_ratio = damping_ratio(0.99));
            })
        } else {
            Control::scene("the factor √(5/6) left out", |scene| {
                scene.change_laws(|law| law.damping_ratio *= (6.0_f64 / 5.0).sqrt());
            })
        },
    };
    DAMPED.into_iter().flat_map(|variant| RESTITUTIONS.map(|restitution| gate(variant, restitution))).collect()
}

fn at_angle(variant: &'static str, degrees: f64) -> Run {
    Run::new(variant, "dem", STEP.resolution).adjusted(&format!("{degrees}° from the normal"), move |scene| {
        let velocity = &mut scene.grains[0].velocity;
        let (speed, angle) = (velocity.norm(), degrees.to_radians());
        (velocity.x, velocity.z) = (speed * angle.sin(), -speed * angle.cos());
    })
}

/// Tangential velocity after impact over that before.
fn tangential(done: &Done) -> Result<f64, Missing> {
    Ok(done.last("a.vx")? / done.scene.grains[0].velocity.x)
}

/// μ(1+e) with the restitution that the law was given.
fn impulse(scene: &Scene) -> f64 {
    let law = law(scene);
    let ratio = law.damping_ratio;
    law.friction * (1.0 + (-PI * ratio / (1.0 - ratio * ratio).sqrt()).exp())
}

/// Tangential restitution and spin (rad/s) after an impact that slides throughout.
fn sliding(scene: &Scene) -> (f64, f64) {
    let grain = &scene.grains[0];
    let (along, onto) = (grain.velocity.x, grain.velocity.z.abs());
    (1.0 - impulse(scene) * onto / along, 2.5 * impulse(scene) * onto / grain.radius)
}

fn oblique() -> Vec<Gate> {
    let gate = |variant: &'static str, degrees: f64, spin: bool| Gate {
        quantity: format!("{} at {degrees}°", if spin { "spin after impact" } else { "tangential restitution" }),
        unit: if spin { "rad/s" } else { "1" },
        scope: Scope::Named,
        evidence: Evidence::Analytic,
        source: SOURCE,
        allowed: 2e-5,
        because: "the spring sticks for an instant at both ends of the impact, where Mindlin's stiffness vanishes",
        runs: vec![at_angle(variant, degrees)],
        measure: measure(move |done| {
            let (restitution, turn) = sliding(&done[0].scene);
            if spin {
                return Ok(Measured::new(done[0].last("a.omega_y")?, turn, turn));
            }
            Ok(Measured::new(tangential(&done[0])?, restitution, 1.0))
        }),
        control: if spin {
            Control::scene("a disc's inertia in a sphere", |scene| {
                scene.grains.iter_mut().for_each(|grain| grain.inertia *= 0.5 / 0.4);
            })
        } else {
            Control::scene("friction × 1.2", |scene| scene.change_laws(|law| law.friction *= 1.2))
        },
    };
    let angles = |variant: &'static str| ANGLES.into_iter().flat_map(move |angle| [gate(variant, angle, false), gate(variant, angle, true)]);
    OBLIQUE.into_iter().flat_map(angles).collect()
}

/// A rigid-body engine has neither overlap nor duration; restitution it gives back exactly. Friction it limits by the impulse
/// that stops the approach, μ m v_n, and leaves out what restitution adds: μ(1+e) m v_n is Coulomb's.
fn rigid() -> Vec<Gate> {
    let gate = |quantity: &str, unit, run: Run, control, of: fn(&Done) -> Result<Measured, Missing>| Gate {
        quantity: quantity.to_owned(),
        unit,
        scope: Scope::Named,
        evidence: Evidence::Analytic,
        source: SOURCE,
        allowed: 1e-9,
        because: "an impulse at one contact is solved to rounding",
        runs: vec![Run { solver: "rigid", ..run.at(rigid_rows::DEFAULT) }],
        measure: measure(move |done| of(&done[0])),
        control,
    };
    let oblique = || at_angle(OBLIQUE[0], 60.0);
    let known = gate(
        "tangential restitution at 60°",
        "1",
        oblique().known("friction is limited by the impulse that stops the approach; what restitution adds to it is left out"),
        Control::without_the_error("dem in its place", "dem", STEP.resolution),
        |done| Ok(Measured::new(tangential(done)?, sliding(&done.scene).0, 1.0)),
    );
    vec![
        gate(
            "rebound velocity over impact velocity, e = 0.8",
            "1",
            with_restitution(DAMPED[0], 0.8),
            Control::scene("e = .79", |scene| scene.change_laws(|law| law.damping_ratio = damping_ratio(0.79))),
            |done| Ok(Measured::new(rebound(done)?, 0.8, 1.0)),
        ),
        gate(
            "tangential restitution at 60° with friction μ m v_n",
            "1",
            oblique(),
            Control::scene("friction × 1.2", |scene| scene.change_laws(|law| law.friction *= 1.2)),
            |done| {
                let velocity = done.scene.grains[0].velocity;
                let exact = 1.0 + law(&done.scene).friction * velocity.z / velocity.x;
                Ok(Measured::new(tangential(done)?, exact, 1.0))
            },
        ),
        Gate { allowed: 2e-5, because: "what a solver with springs reaches", ..known },
    ]
}

fn figures(bench: &Bench) -> Result<Vec<Figure>, RunError> {
    let curve = |label: String, stroke, points| Curve { label, stroke, points };
    let axis = |label: &str| Axis { label: label.to_owned(), logarithmic: false };
    let figure = |name: &str, title: &str, caption: &str, x, y, curves| Figure {
        name: name.to_owned(),
        title: title.to_owned(),
        caption: caption.to_owned(),
        drawing: Drawing::Graph(Graph { x, y, curves }),
    };
    let mut impacts = Vec::new();
    for variant in ["1-glass", "1-limestone"] {
        let done = bench.run(&Run::new(variant, "dem", STEP.resolution))?;
        let (force, time) = (done.series().column("contact.normal_force").unwrap_or_default(), &done.series().time);
        let every = force.len().div_ceil(300).max(1);
        let points = time.iter().zip(force).step_by(every).map(|(t, force)| (t * 1e6, force / 1e3)).collect();
        impacts.push(curve(variant.to_owned(), Stroke::Line, points));
    }
    let (mut restitution, mut spin) = (Vec::new(), Vec::new());
    for variant in OBLIQUE {
        let (mut measured, mut turned) = (Vec::new(), Vec::new());
        for angle in [5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 50.0, 60.0, 70.0, 80.0] {
            let done = bench.run(&at_angle(variant, angle))?;
            if let (Ok(vx), Ok(omega)) = (done.last("a.vx"), done.last("a.omega_y")) {
                measured.push((angle, vx / done.scene.grains[0].velocity.x));
                turned.push((angle, omega));
            }
        }
        restitution.push(curve(variant.to_owned(), Stroke::Markers, measured));
        spin.push(curve(variant.to_owned(), Stroke::Markers, turned));
    }
    let scene = |angle: f64| bench.scene(&at_angle(OBLIQUE[0], angle));
    let (mut exact_restitution, mut exact_spin) = (Vec::new(), Vec::new());
    for angle in (33..=85).map(f64::from) {
        let (e, turn) = sliding(&scene(angle)?);
        exact_restitution.push((angle, e));
        exact_spin.push((angle, turn));
    }
    restitution.push(curve("slides throughout, rigid".to_owned(), Stroke::Dashed, exact_restitution));
    spin.push(curve("slides throughout, rigid".to_owned(), Stroke::Dashed, exact_spin));
    Ok(vec![
        figure(
            "force",
            "Force during the impact of two spheres (test 1)",
            "R = 10 mm, ±10 m/s, elastic.",
            axis("time t (µs)"),
            axis("normal force (kN)"),
            impacts,
        ),
        figure(
            "tangential-restitution",
            "Tangential restitution of an oblique impact (test 4)",
            "Above 32.5° the impact slides throughout and depends on friction and restitution alone; below, Mindlin's spring \
             sticks and rings: there is no closed form, and no gate.",
            axis("angle of impact from the normal (°)"),
            axis("v_t after / v_t before"),
            restitution,
        ),
        figure(
            "spin",
            "Spin after an oblique impact (test 4)",
            "The same runs.",
            axis("angle of impact from the normal (°)"),
            axis("spin ω (rad/s)"),
            spin,
        ),
    ])
}
