//! A disc hits a frictional wall at an angle and slips during nearly the whole impact. Its final velocities are exact.

use crate::exact::dashpot::lag;
use crate::rows::on_plane::stronger_friction;
use crate::rows::programs::{PAIRS, row, same_cycle};
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[fraction("dt=.05", 0.05), fraction("dt=.01", 0.01), fraction("dt=.002", 0.002)];
const VARIANTS: [&str; 2] = ["elastic", "damped"];

pub(crate) static CASE: Case = crate::heads::OBLIQUE_IMPACT.with(LEVELS, 2, &claims).drawn_by(figures);

/// Velocities after the impact.
struct Exit {
    /// Velocity along the wall (m/s).
    along: f64,
    /// Velocity across the wall (m/s).
    across: f64,
    /// Spin (rad/s).
    spin: f64,
}

/// Computes the exact velocities after the impact by quadrature over the closed form of the overlap (derivation).
fn exact(scene: &Scene) -> Exit {
    const PARTS: u32 = 100_000;
    let law = scene.laws[0].unwrap_or_default();
    let grain = &scene.grains[0];
    let (along, across) = (grain.velocity.x, -grain.velocity.y);
    let decay = 0.5 * law.normal_damping;
    let omega = (law.normal_stiffness() / grain.mass - decay * decay).sqrt();
    let interval = PI / omega / f64::from(PARTS);
    let turning = grain.mass * grain.radius * grain.radius / grain.inertia;
    // Slip velocity, tangential spring displacement, and impulse along the wall divided by the mass.
    let (mut slip, mut stretch, mut impulse) = (along - grain.spin.z * grain.radius, 0.0, 0.0);
    for part in 0..PARTS {
        let time = (f64::from(part) + 0.5) * interval;
        let size = across / omega * (-decay * time).exp();
        let overlap = size * (omega * time).sin();
        let rate = size * (omega * (omega * time).cos() - decay * (omega * time).sin());
        let limit = law.friction * (law.normal_stiffness() * overlap + law.normal_damping * grain.mass * rate).abs();
        stretch += slip * 0.5 * interval;
        let force = (law.tangential_stiffness() * stretch).clamp(-limit, limit);
        stretch = force / law.tangential_stiffness() + slip * 0.5 * interval;
        slip -= force / grain.mass * (1.0 + turning) * interval;
        impulse += force / grain.mass * interval;
    }
    Exit {
        along: along - impulse,
        across: (-decay * PI / omega).exp() * across,
        spin: grain.spin.z - impulse * turning / grain.radius,
    }
}

/// Error bounds due to finite time steps, and the overlap that limits the error of the lever arm.
struct StepErrors {
    /// Error of the normal impulse, divided by the mass (m/s).
    impulse: f64,
    /// Error of the impulse along the wall, divided by the mass and by μ (m/s).
    along: f64,
    /// Largest overlap, divided by the radius.
    overlap: f64,
}

/// Returns the velocity across the wall before the impact (m/s).
fn across(scene: &Scene) -> f64 {
    -scene.grains[0].velocity.y
}

fn friction(scene: &Scene) -> f64 {
    scene.laws[0].map_or(f64::NAN, |law| law.friction)
}

/// Returns the tolerance for finite steps. Half a step of the dashpot's force is added or lost at start and end of
/// contact, and the dashpot is half a step late, as in the collision of two discs. The remainder is of second order.
fn within_a_step(variant: &str, allowed: ErrorBound) -> Tolerance {
    let step_error = |scene: &Scene| {
        let (grain, law) = (&scene.grains[0], scene.laws[0].unwrap_or_default());
        let omega = (law.normal_stiffness() / grain.mass).sqrt();
        let phase = omega * LEVELS[2].step(scene);
        let zeta = 0.5 * law.normal_damping / omega;
        let (before, after) = (across(scene), exact(scene).across);
        let impulse = zeta * phase * (before + after) + lag(zeta) * phase * after + phase * phase * before;
        let (along, overlap) = (impulse + 2.0 * zeta * phase * before, before / omega / grain.radius);
        allowed(&StepErrors { impulse, along, overlap }, &exact(scene), scene).abs()
    };
    computed(
        CASE.number(variant, step_error),
        "normal velocity: start and end of contact within a step, ζ ωΔt (v + v′); dashpot half a step late, π ζ²/(2 (1 \
         − ζ²)^{3/2}) ωΔt v′; second order, (ωΔt)² v. Along the wall: μ times that, and a step until the spring \
         reaches the Coulomb limit of the first dashpot force, 2ζ ωΔt v. Spin: the same as the impulse, and a lever \
         arm between R and R − δ_max",
    )
}

type ErrorBound = fn(&StepErrors, &Exit, &Scene) -> f64;
type ExitValue = fn(&Exit) -> f64;

fn claims() -> Vec<Claim> {
    let stiffness_damping = || {
        Control::scene("stiffness-proportional damping of a fiftieth of the period", |scene| {
            let law = scene.laws[0].unwrap_or_default();
            let beta = 0.04 * (scene.grains[0].mass / law.normal_stiffness()).sqrt();
            scene.change_laws(|law| law.stiffness_damping = beta);
        })
    };
    let quantities: [(&str, &'static str, ErrorBound, Control, RunReader, ExitValue); 3] = [
        (
            "velocity along the wall after the impact",
            "m/s",
            |off, exit, scene| off.along * friction(scene) / exit.along,
            stronger_friction(),
            |done| done.last("grain.vx"),
            |exit| exit.along,
        ),
        (
            "velocity across the wall after the impact",
            "m/s",
            |off, exit, _| off.impulse / exit.across,
            stiffness_damping(),
            |done| done.last("grain.vy"),
            |exit| exit.across,
        ),
        (
            "spin after the impact",
            "rad/s",
            |off, _, scene| off.along / across(scene) + off.overlap,
            stronger_friction(),
            |done| done.last("grain.omega"),
            |exit| exit.spin,
        ),
    ];
    let mut claims = Vec::new();
    for variant in VARIANTS {
        for (quantity, unit, allowed, control, read, exact_value) in &quantities {
            let (allowed, read, exact_value) = (*allowed, *read, *exact_value);
            for solver in ["dem:lammps", "dem:liggghts"] {
                let row = claim(*quantity, unit)
                    .run(Run::new(variant, solver, LEVELS[2].resolution))
                    .equals(Source::Derived("momentum and Coulomb's limit, by quadrature (derivation)"), move |done| {
                        Ok(Measurement::relative(read(&done[0])?, exact_value(&exact(&done[0].scene))))
                    })
                    .within(within_a_step(variant, allowed))
                    .refuses(control.clone());
                // Only this claim is solver-independent. The results of the other claims depend on the release of the
                // dashpot and on the part of the dashpot in the Coulomb limit, in which solvers differ.
                claims.push(if solver == "dem:lammps" && variant == "elastic" {
                    row.solver_independent()
                } else {
                    row
                });
            }
        }
    }
    claims
        .extend(VARIANTS.into_iter().flat_map(|variant| PAIRS.into_iter().flat_map(move |pair| beside(variant, pair))));
    claims
}

/// Returns the claims that velocity and wall force agree with LAMMPS or LIGGGHTS. Velocities are in units of the
/// initial speed, and forces in units of the largest spring force.
fn beside(variant: &'static str, pair: [&'static str; 2]) -> [Claim; 2] {
    let runs = || pair.map(|solver| Run::new(variant, solver, LEVELS[1].resolution));
    let control = || Control::our_contact_law("friction ×1.001 in ours", |law| law.friction *= 1.001);
    let of_velocity = same_cycle("relative to the velocity before");
    let of_force = same_cycle("relative to the largest force of the spring, v√(km)");
    [
        row("velocity over the impact, worst", "m/s", of_velocity, runs(), control(), |done| {
            worst(done, &["grain.vx", "grain.vy"], done[0].scene.grains[0].velocity.norm())
        }),
        row("force on the wall, worst", "N", of_force, runs(), control(), |done| {
            let (grain, law) = (&done[0].scene.grains[0], done[0].scene.laws[0].unwrap_or_default());
            let largest = grain.velocity.y.abs() * (law.normal_stiffness() * grain.mass).sqrt();
            worst(done, &["wall.force_x", "wall.force_y"], largest)
        }),
    ]
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for variant in VARIANTS {
        let done = runner.run(&Run::new(variant, "dem:lammps", LEVELS[2].resolution))?;
        let end = done.series().time.last().copied().unwrap_or_default();
        let after = exact(&done.scene).along;
        let points = samples(&done, "grain.vx").unwrap_or_default();
        curves.push(Curve::new(format!("{variant}, dem:lammps"), Stroke::Line, points));
        let rest = vec![(0.55 * end, after), (end, after)];
        curves.push(Curve::new(format!("{variant}, exact after the impact"), Stroke::Dashed, rest));
    }
    Ok(vec![Figure::graph(
        "velocity",
        "Velocity along the wall",
        "The velocity along the wall is 4 m/s before the impact. It is 3 m/s after an elastic impact. A damped \
         impact takes less of it.",
        [Axis::linear("time t (s)"), Axis::linear("velocity along the wall (m/s)")],
        curves,
    )])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks the velocities after slip during the whole impact: 4 − μ·2 v_n (m/s) along the wall, and R |ω| = 2 μ·2
    /// v_n.
    #[test]
    fn the_quadrature_has_the_elastic_answer() {
        let exit = exact(&CASE.variant("elastic").unwrap());
        assert!((exit.along - 3.0).abs() < 1e-8 && (exit.across - 1.0).abs() < 1e-12, "{}", exit.along);
        assert!((exit.spin + 2.0).abs() < 1e-8);
    }
}
