//! Two elastic discs collide.

use crate::bench::Bench;
use crate::case::{Case, Rung, cells};
use crate::figure::{Axis, Curve, Figure, Stroke};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run};
use crate::verdict::Evidence;
use grainbench_scene::solver::{Resolution, RunError};

const LADDER: &[Rung] = &[cells("R/4", 4.0, 3), cells("R/8", 8.0, 3), cells("R/16", 16.0, 3)];
const REFERENCE: &str = "independent prototype, converged over 4, 8 and 16 cells a radius";
/// Restitution of the centres of mass at .01 c: what is missing is vibration of the discs.
const RESTITUTION: f64 = 0.98;
/// Spin times R over the speed of each disc after the oblique impact with μ = .9 and ν = .25.
const OBLIQUE_SPIN: f64 = 0.40;
/// When the discs of the Sulsky variant touch (s): 3 − √2.
const TOUCH: f64 = 3.0 - std::f64::consts::SQRT_2;

pub(crate) static CASE: Case = Case {
    name: "two-discs",
    title: "Two elastic discs collide",
    claim: "Elastic discs meet when their surfaces do, keep energy and momentum, rebound with what vibration leaves, and turn each \
            other by friction as much as they should.",
    scene: include_str!("scene.toml"),
    derivation: include_str!("derivation.md"),
    weakness: "Restitution and spin are known from an independent prototype of the same family of methods, not in closed form.",
    ladder: LADDER,
    default_rung: LADDER[1],
    gates,
    figures,
};

/// Shorter steps than usual: contact springs and waves at an impact.
const fn grid(cells: f64) -> Resolution {
    Resolution::Grid { cells, points: 3, courant: 0.3 }
}

fn speed(done: &Done) -> f64 {
    done.scene.grains[0].velocity.norm()
}

/// Speed along the line of approach after the impact over that before.
fn restitution(done: &Done) -> Result<f64, Missing> {
    let velocity = done.scene.grains[0].velocity;
    let (vx, vy) = (done.last("left.vx")?, done.last("left.vy")?);
    Ok(-(vx * velocity.x + vy * velocity.y) / velocity.norm_squared())
}

/// Total energy at the end over that at the start.
fn energy(done: &Done) -> Result<f64, Missing> {
    let energy = done.column("all.total_energy")?;
    Ok(done.last("all.total_energy")? / energy[0])
}

/// Mean ΩR/v₀ of the two discs.
fn spin(done: &Done) -> Result<f64, Missing> {
    let radius = done.scene.grains[0].radius;
    Ok(0.5 * (done.last("left.omega")? + done.last("right.omega")?) * radius / speed(done))
}

/// Gap of the surfaces (m) when the first contact force is seen, by the undeformed radii.
fn first_gap(done: &Done) -> Result<f64, Missing> {
    let force = done.column("contact.normal_force")?;
    // The force of a step is that of the positions it began with.
    let at = force.iter().position(|&force| force > 0.0).ok_or_else(|| Missing("contact".to_owned()))?.max(1) - 1;
    let along = |axis: &str| Ok(done.column(&format!("right.{axis}"))?[at] - done.column(&format!("left.{axis}"))?[at]);
    Ok(f64::hypot(along("x")?, along("y")?) - 2.0 * done.scene.grains[0].radius)
}

fn run(variant: &'static str, solver: &'static str) -> Run {
    Run::new(variant, solver, grid(8.0))
}

fn gates() -> Vec<Gate> {
    let energetic = || Control::solver("nodal contact on approach (2000), which makes energy", "mpm:2000");
    let mut gates = Vec::new();
    for (cells, allowed) in [(8.0, 0.015), (16.0, 0.01)] {
        let run = Run::new("head-on", "mpm", grid(cells));
        let runs = || vec![if cells > 8.0 { run.clone().slow() } else { run.clone() }];
        gates.push(Gate::new(
            (format!("energy after over before, {cells} cells a radius"), "1"),
            runs(),
            (Evidence::Invariant, "conservation of energy"),
            (5e-3, "damping by the grid, and half a step between velocities and springs"),
            energetic(),
            |done| Ok(Measured::new(energy(&done[0])?, 1.0, 1.0)),
        ));
        gates.push(Gate::new(
            (format!("restitution, {cells} cells a radius"), "1"),
            runs(),
            (Evidence::OtherCode, REFERENCE),
            (allowed, "discretisation, and what the reference is certain of"),
            energetic(),
            |done| Ok(Measured::new(restitution(&done[0])?, RESTITUTION, 1.0)),
        ));
    }
    for variant in ["head-on", "inclined", "oblique"] {
        gates.push(Gate::new(
            ("momentum in the end", "kg m/s"),
            vec![run(variant, "mpm")],
            (Evidence::Invariant, "equal and opposite impulses"),
            (1e-14, "impulses are equal and opposite; rounding; in units of m v₀"),
            Control::scene("one disc faster by a millionth", |scene| scene.grains[0].velocity *= 1.0 + 1e-6),
            |done| momentum(&done[0]),
        ));
    }
    gates.push(Gate::new(
        ("spurious spin ΩR/v₀, frictionless, 30° to the grid", "1"),
        vec![run("inclined", "mpm")],
        (Evidence::Invariant, "no torque without friction"),
        (5e-3, "frictionless surfaces of tracers are not quite smooth"),
        Control::solver("nodal contact on approach (2000)", "mpm:2000"),
        |done| Ok(Measured::new(spin(&done[0])?, 0.0, 1.0)),
    ));
    gates.extend(oblique());
    gates.extend(three());
    gates.extend(touching());
    gates.push(Gate::new(
        ("energy after over before, manufactured by the 2000 criterion", "1"),
        vec![run("head-on", "mpm:2000")],
        (
            Evidence::OtherCode,
            "independent prototype: 1.2 to 1.8 at 4 to 16 cells a radius; release on departure adds energy",
        ),
        (0.03, "at this position of the discs on the grid; others give between .1 and .3 more energy than there was"),
        Control::solver("springs at the surface", "mpm"),
        |done| Ok(Measured::new(energy(&done[0])?, 1.2, 1.0)),
    ));
    gates.push(Gate::new(
        ("energy after over before", "1"),
        vec![
            run("head-on", "mpm:2000")
                .known("released on departure, whatever the traction: each release leaves more energy than there was"),
        ],
        (Evidence::Invariant, "conservation of energy"),
        (5e-3, "what springs at the surface reach"),
        Control::without_the_error("springs at the surface", "mpm", grid(8.0)),
        |done| Ok(Measured::new(energy(&done[0])?, 1.0, 1.0)),
    ));
    gates
}

/// Momentum in the end, where none was, in units of that of one disc.
fn momentum(done: &Done) -> Result<Measured, Missing> {
    let (x, y) = (done.last("all.momentum_x")?, done.last("all.momentum_y")?);
    let scale = done.scene.grains[0].mass * speed(done);
    Ok(Measured::new(f64::hypot(x, y), 0.0, scale))
}

/// Three discs that meet at one point: contacts act in pairs, however many bodies share a node.
fn three() -> Vec<Gate> {
    let gate = |run: Run, control| {
        Gate::new(
            ("momentum in the end, three discs at one point", "kg m/s"),
            vec![run],
            (Evidence::Invariant, "equal and opposite impulses"),
            (1e-12, "impulses are equal and opposite; rounding, of the start too; in units of m v₀"),
            control,
            |done| {
                let at_start = |axis: &str| Ok(done[0].column(&format!("all.momentum_{axis}"))?[0]);
                let gained = momentum(&done[0])?;
                let before = f64::hypot(at_start("x")?, at_start("y")?);
                Ok(Measured::new((gained.value - before).abs(), 0.0, gained.scale))
            },
        )
    };
    let faster = || {
        Control::solver("each body against the common velocity, along its own normal (2001)", "mpm:2001")
    };
    let mut gates: Vec<Gate> = ["mpm", "mpm:gap"].map(|solver| gate(run("three", solver), faster())).into();
    for solver in ["mpm:2000", "mpm:2001"] {
        let known = run("three", solver).known("each body meets the common velocity along its own normal: impulses do not add up to nothing");
        gates.push(gate(known, Control::without_the_error("springs at the surface", "mpm", grid(8.0))));
    }
    gates
}

/// Spin by friction.
fn oblique() -> Vec<Gate> {
    let gate = |run: Run, quantity: &str, because, control| {
        Gate::new(
            (quantity, "1"),
            vec![run],
            (Evidence::OtherCode, REFERENCE),
            (0.01, because),
            control,
            |done| Ok(Measured::new(spin(&done[0])?.abs(), OBLIQUE_SPIN, 1.0)),
        )
    };
    vec![
        gate(
            run("oblique", "mpm"),
            "ΩR/v₀ after an oblique impact, μ = .9",
            "discretisation at this resolution, and what the reference is certain of",
            Control::scene("a third of the friction", |scene| scene.change_laws(|law| law.friction /= 3.0)),
        ),
        gate(
            Run::new("oblique", "mpm", grid(16.0)).slow().known(
                "points' own spin, which neighbours do not resist, lets the layer at the surface give way along the contact: \
                 the spin does not converge to the reference",
            ),
            "ΩR/v₀ after an oblique impact, μ = .9, 16 cells a radius",
            "what the reference is certain of",
            Control::without_the_error("APIC, whose spin is the grid's", "mpm+apic", grid(16.0)),
        ),
    ]
}

/// Where and when the discs of Sulsky's scene touch.
fn touching() -> Vec<Gate> {
    vec![
        Gate::new(
            ("gap at first contact", "m"),
            vec![run("sulsky", "mpm")],
            (Evidence::Analytic, "surfaces meet at t = 3 − √2 (derivation)"),
            (0.07, "in cells; the way of one step, after which a contact is seen, and tracers that stand in for a surface"),
            Control::scene("discs a sixth of a cell too large", |scene| {
                scene.grains.iter_mut().for_each(|grain| {
                    grain.radius *= 1.02;
                    grain.mass *= 1.02 * 1.02;
                });
            }),
            |done| {
                let cell = done[0].scene.grains[0].radius / 8.0;
                Ok(Measured::new(first_gap(&done[0])?, 0.0, cell))
            },
        ),
        Gate::new(
            ("time of first contact", "s"),
            vec![run("sulsky", "mpm")],
            (Evidence::Analytic, "Sulsky, Chen & Schreyer 1994; t = 3 − √2"),
            (0.01, "two steps of .0065 s: contact is seen in the step after the one in which surfaces met"),
            Control::scene("five per cent slower", |scene| {
                scene.grains.iter_mut().for_each(|grain| grain.velocity *= 0.95);
            }),
            |done| {
                let force = done[0].column("contact.normal_force")?;
                let at = force.iter().position(|&force| force > 0.0).ok_or_else(|| Missing("contact".to_owned()))?;
                Ok(Measured::new(done[0].series().time[at], TOUCH, TOUCH))
            },
        ),
    ]
}

fn figures(bench: &Bench) -> Result<Vec<Figure>, RunError> {
    let mut energies = Vec::new();
    let mut speeds = Vec::new();
    for solver in ["mpm", "mpm:gap", "mpm:2000"] {
        let done = bench.run(&Run::new("head-on", solver, grid(8.0)))?;
        let speed = speed(&done);
        let series = |name: &str, scale: f64| -> Vec<(f64, f64)> {
            let values = done.series().column(name).unwrap_or_default();
            done.series().time.iter().zip(values).map(|(&time, &value)| (time, value / scale)).collect()
        };
        let start = done.series().column("all.total_energy").and_then(|all| all.first()).copied().unwrap_or(1.0);
        energies.push(Curve::new(solver, Stroke::Line, series("all.total_energy", start)));
        speeds.push(Curve::new(solver, Stroke::Line, series("left.vx", speed)));
    }
    Ok(vec![
        Figure::graph(
            "energy",
            "Total energy through a head-on impact at .01 c",
            "8 cells a radius. Kinetic, elastic and spring energy together.",
            [Axis::linear("time t (s)"), Axis::linear("energy / energy at the start")],
            energies,
        ),
        Figure::graph(
            "velocity",
            "Velocity of the left disc",
            "Nodal contact acts before the surfaces meet.",
            [Axis::linear("time t (s)"), Axis::linear("velocity v / v₀")],
            speeds,
        ),
    ])
}
