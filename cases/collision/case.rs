//! Two discs collide: restitution in both release conventions, momentum and angular momentum.

use crate::bench::Bench;
use crate::case::{Case, Rung, fraction};
use crate::effect::Effect;
use crate::figure::{Axis, Curve, Drawing, Figure, Graph, Stroke};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run, measure};
use crate::measure::slope;
use crate::program_rows;
use crate::rigid_rows;
use crate::scope::Scope;
use crate::verdict::Evidence;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{Resolution, RunError};
use std::f64::consts::PI;

const LADDER: &[Rung] =
    &[fraction("dt=.02", 0.02), fraction("dt=.006", 0.006), fraction("dt=.002", 0.002), fraction("dt=.0006", 0.0006)];
const FINEST: Rung = LADDER[3];
const DAMPED: [&str; 4] = ["gamma-zeta.1", "gamma-zeta.2", "beta-zeta.1", "beta-zeta.2"];

pub(crate) static CASE: Case = Case {
    name: "collision",
    title: "Two discs collide",
    claim: "A linear spring and dashpot give the restitution of their closed form, whether the dashpot may pull at release or \
            not; momentum is kept to rounding, and angular momentum where the tangential forces act at one point.",
    scene: include_str!("scene.toml"),
    derivation: include_str!("derivation.md"),
    weakness: "Restitution is one number of a head-on impact: damping that depends on the overlap could give the same e at \
               this speed. Two grains of similar mass; no wall.",
    ladder: LADDER,
    default_rung: LADDER[3],
    gates,
    figures,
};

fn gates() -> Vec<Gate> {
    let mut gates = Vec::new();
    for solver in ["dem", "dem:no-tension"] {
        for variant in DAMPED {
            gates.extend([restitution(variant, solver), convergence(variant, solver)]);
        }
    }
    gates.extend(momentum());
    gates.extend(angular_momentum());
    gates.extend(DAMPED.map(|variant| rigid_rows::restitution(variant, measured_restitution)));
    gates.extend(rigid_invariants());
    gates.extend(program_rows::restitution(&DAMPED, LADDER[1].resolution));
    gates
}

/// Momentum and angular momentum of the oblique impact between rigid discs.
fn rigid_invariants() -> Vec<Gate> {
    let momentum = |column: &'static str, axis: usize| {
        rigid_rows::momentum("oblique", format!("momentum along {}, worst", ["x", "y"][axis]), move |done| {
            let grains = &done.scene.grains;
            let start: f64 = grains.iter().map(|grain| grain.mass * grain.velocity[axis]).sum();
            let scale = grains[0].mass * grains[0].velocity.norm();
            Ok(Measured::worst(&done.series().time, done.column(column)?, |_| start, scale))
        })
    };
    let angular = rigid_rows::angular_momentum("oblique", |done| {
        let (scene, grain) = (&done.scene, &done.scene.grains[0]);
        let scale = grain.mass * grain.velocity.norm() * grain.radius;
        let start = initial_angular_momentum(scene);
        Ok(Measured::worst(&done.series().time, done.column("all.angular_momentum")?, |_| start, scale))
    });
    vec![momentum("all.momentum_x", 0), momentum("all.momentum_y", 1), angular]
}

/// Effective mass (kg), frequency ω (rad/s) and damping ratio ζ of the pair.
fn pair(scene: &Scene) -> (f64, f64, f64) {
    let law = scene.laws.iter().flatten().next().copied().unwrap_or_default();
    let mass = 1.0 / scene.grains.iter().map(|grain| 1.0 / grain.mass).sum::<f64>();
    let viscosity = law.stiffness_damping * law.normal_stiffness + law.normal_damping * mass;
    (mass, (law.normal_stiffness / mass).sqrt(), viscosity / (2.0 * (law.normal_stiffness * mass).sqrt()))
}

/// Coefficient of restitution.
fn exact_restitution(zeta: f64, pulls: bool) -> f64 {
    let root = (1.0 - zeta * zeta).sqrt();
    let phase = if pulls { PI } else { PI - (2.0 * zeta * root).atan2(1.0 - 2.0 * zeta * zeta) };
    (-zeta / root * phase).exp()
}

fn measured_restitution(done: &Done) -> Result<Measured, Missing> {
    let grains = &done.scene.grains;
    let before = grains[0].velocity.x - grains[1].velocity.x;
    let after = done.last("b.vx")? - done.last("a.vx")?;
    let pulls = !done.record.provenance.solver.ends_with("no-tension");
    let (_, _, zeta) = pair(&done.scene);
    Ok(Measured::new(after / before, exact_restitution(zeta, pulls), 1.0))
}

/// The other release convention.
fn other(solver: &'static str) -> Control {
    if solver == "dem" {
        Control::solver("the dashpot may not pull", "dem:no-tension")
    } else {
        Control::solver("the dashpot may pull", "dem")
    }
}

fn restitution(variant: &'static str, solver: &'static str) -> Gate {
    Gate {
        quantity: "coefficient of restitution".to_owned(),
        unit: "1",
        evidence: Evidence::Analytic,
        scope: Scope::Named,
        source: "damped oscillator with this release (derivation)",
        allowed: 3e-4,
        because: "release falls within a step and the dashpot is half a step late: first order in Δt",
        runs: vec![Run::new(variant, solver, FINEST.resolution)],
        measure: measure(move |done| {
            // The convention judged is that of the row, also where another solver was put in its place.
            let mut measured = measured_restitution(&done[0])?;
            measured.expected = exact_restitution(pair(&done[0].scene).2, solver == "dem");
            Ok(measured)
        }),
        control: other(solver),
    }
}

/// Sixteen steps from .04 of the critical one downwards, a factor 1.3 apart.
fn step(at: i32) -> Resolution {
    Resolution::CriticalFraction(0.04 * 1.3_f64.powi(-at))
}

fn convergence(variant: &'static str, solver: &'static str) -> Gate {
    Gate {
        quantity: "order in Δt of the restitution's error".to_owned(),
        unit: "1",
        evidence: Evidence::Convergence,
        scope: Scope::Named,
        source: "dashpot half a step late: first order (derivation)",
        allowed: 0.15,
        because: "fitted over 16 steps: release falls anywhere within a step, which scatters the error by its own size",
        runs: (0..16).map(|at| Run::new(variant, solver, step(at))).collect(),
        measure: measure(move |done| {
            let points: Result<Vec<(f64, f64)>, Missing> = done
                .iter()
                .map(|done| {
                    let exact = exact_restitution(pair(&done.scene).2, solver == "dem");
                    Ok((done.record.provenance.time_step, measured_restitution(done)?.value - exact))
                })
                .collect();
            Ok(Measured::new(slope(&points?), 1.0, 1.0))
        }),
        control: other(solver),
    }
}

fn momentum() -> Vec<Gate> {
    let gate = |column: &'static str, axis: usize| Gate {
        quantity: format!("momentum along {}, worst", ["x", "y"][axis]),
        unit: "kg m/s",
        evidence: Evidence::Invariant,
        scope: Scope::AnySolver,
        source: "equal and opposite forces",
        allowed: 1e-12,
        because: "rounding, in units of one grain's momentum",
        runs: vec![Run::new("oblique", "dem", LADDER[1].resolution)],
        measure: measure(move |done| {
            let grains = &done[0].scene.grains;
            let start: f64 = grains.iter().map(|grain| grain.mass * grain.velocity[axis]).sum();
            let scale = grains[0].mass * grains[0].velocity.norm();
            Ok(Measured::worst(&done[0].series().time, done[0].column(column)?, |_| start, scale))
        }),
        control: Control::scene("a drag of 1e-9/s on every grain", |scene| scene.global_damping = 1e-9),
    };
    vec![gate("all.momentum_x", 0), gate("all.momentum_y", 1)]
}

fn initial_angular_momentum(scene: &Scene) -> f64 {
    let of = |grain: &grainbench_scene::scene::Grain| {
        grain.mass * grain.position.xy().perp(&grain.velocity.xy()) + grain.inertia * grain.spin.z
    };
    scene.grains.iter().map(of).sum()
}

fn angular_momentum() -> Vec<Gate> {
    let scale = |scene: &Scene| scene.grains[0].mass * scene.grains[0].velocity.norm() * scene.grains[0].radius;
    let kept = Gate {
        quantity: "angular momentum, arm R − overlap/2, worst".to_owned(),
        unit: "kg m²/s",
        evidence: Evidence::Invariant,
        scope: Scope::Named,
        source: "tangential forces act at one point (derivation)",
        allowed: 1e-12,
        because: "rounding, in units of m v R",
        runs: vec![Run::new("oblique", "dem:liggghts", LADDER[1].resolution)],
        measure: measure(move |done| {
            let scene = &done[0].scene;
            let start = initial_angular_momentum(scene);
            Ok(Measured::worst(&done[0].series().time, done[0].column("all.angular_momentum")?, |_| start, scale(scene)))
        }),
        control: Control::solver("torque arm R", "dem"),
    };
    let lost = Gate {
        quantity: "change of angular momentum, arm R, against Σ overlap × F_t Δt".to_owned(),
        unit: "kg m²/s",
        evidence: Evidence::Analytic,
        scope: Scope::Named,
        source: "arms R on centres R₁ + R₂ − δ apart (derivation)",
        allowed: 1e-12,
        because: "rounding, in units of m v R",
        runs: vec![Run::new("oblique", "dem", LADDER[1].resolution)],
        measure: measure(move |done| {
            let scene = &done[0].scene;
            let (overlap, shear) = (done[0].column("contact.overlap")?, done[0].column("contact.shear_force")?);
            let impulse: f64 = overlap.iter().zip(shear).map(|(overlap, shear)| overlap * shear).sum();
            let change = done[0].last("all.angular_momentum")? - initial_angular_momentum(scene);
            // The shear force on the first grain is positive along t = (e₂, −e₁): e × t = −1, so both arms turn it by −R F_t.
            let expected = -impulse * done[0].record.provenance.time_step;
            Ok(Measured::new(change, expected, scale(scene)))
        }),
        control: Control::solver("torque arm R − overlap/2", "dem:liggghts"),
    };
    vec![kept, lost, at_the_limit()]
}

/// In the oblique impact the tangential spring is at Coulomb's limit at every step: the spin of the first disc.
fn at_the_limit() -> Gate {
    Gate::new(
        ("spin that friction gives the first disc, against R μ Σ k_n overlap Δt/I", "rad/s"),
        vec![Run::new("oblique", "dem", LADDER[1].resolution)],
        (Evidence::Analytic, "Coulomb's limit at every step (derivation)"),
        (1e-12, "rounding, relative to the change"),
        Control::without(Effect::Friction),
        |done| {
            let grain = &done[0].scene.grains[0];
            let law = done[0].scene.laws.iter().flatten().next().copied().unwrap_or_default();
            let overlap: f64 = done[0].column("contact.overlap")?.iter().sum();
            let limit = law.friction * law.normal_stiffness * overlap * done[0].record.provenance.time_step;
            // Both discs are turned clockwise.
            let expected = -limit * grain.radius / grain.inertia;
            Ok(Measured::new(done[0].last("a.omega")? - grain.spin.z, expected, expected))
        },
    )
}

fn figures(bench: &Bench) -> Result<Vec<Figure>, RunError> {
    let curve = |label: String, stroke, points| Curve { label, stroke, points };
    let mut errors = Vec::new();
    let mut forces = Vec::new();
    for (solver, release) in [("dem", "may pull"), ("dem:no-tension", "may not pull")] {
        for variant in ["gamma-zeta.1", "gamma-zeta.2"] {
            let mut points = Vec::new();
            for rung in LADDER {
                let done = bench.run(&Run::new(variant, solver, rung.resolution))?;
                if let (Ok(measured), Some(critical)) = (measured_restitution(&done), done.record.provenance.critical_time_step) {
                    points.push((done.record.provenance.time_step / critical, measured.error().abs()));
                }
            }
            errors.push(curve(format!("{variant}, {release}"), Stroke::MarkedLine, points));
        }
        let done = bench.run(&Run::new("gamma-zeta.2", solver, LADDER[1].resolution))?;
        let force = done.series().column("contact.normal_force").unwrap_or_default();
        let points = done.series().time.iter().zip(force).map(|(t, force)| (t * 1e3, *force)).take_while(|(t, _)| *t < 30.0);
        forces.push(curve(format!("dashpot {release}"), Stroke::Line, points.collect()));
    }
    errors.push(curve("slope 1".to_owned(), Stroke::Dashed, vec![(0.0006, 3e-4), (0.02, 1e-2)]));
    let figure = |name: &str, title: &str, caption: &str, x, y, curves| Figure {
        name: name.to_owned(),
        title: title.to_owned(),
        caption: caption.to_owned(),
        drawing: Drawing::Graph(Graph { x, y, curves }),
    };
    let axis = |label: &str, logarithmic| Axis { label: label.to_owned(), logarithmic };
    Ok(vec![
        figure(
            "force",
            "Normal force during the impact, ζ = .2",
            "The two conventions differ only at the end: the dashpot pulls until the overlap is gone, or lets go.",
            axis("time t (ms)", false),
            axis("normal force (N)", false),
            forces,
        ),
        figure(
            "restitution",
            "Error of the coefficient of restitution",
            "Of first order in Δt, scattered by where in a step the release falls.",
            axis("Δt / critical step", true),
            axis("|e − exact|", true),
            errors,
        ),
    ])
}
