//! Impacts of Hertz spheres in the eight benchmark tests of Chung & Ooi (2011), compared with closed forms.

mod fair;
mod forms;
mod turning;

use crate::exact::dashpot::{no_tension_lag, no_tension_ratio};
use crate::rows::programs::{PAIRS, forces, row, same_cycle};
use crate::rows::rigid;
use forms::ImpactParameters;
use grainbench_harness::prelude::*;
use grainbench_scene::contact_law::ContactLaw;

const LEVELS: &[Level] = &[fraction("dt=.01", 0.01), fraction("dt=.003", 0.003), fraction("dt=.001", 0.001)];
const STEP: Level = LEVELS[2];
const ELASTIC: [&str; 4] = ["1-glass", "1-limestone", "2-aluminium-alloy", "2-magnesium-alloy"];
const DAMPED: [&str; 2] = ["3-aluminium-oxide", "3-cast-iron"];
const OBLIQUE: [&str; 2] = ["4-aluminium-oxide", "4-aluminium-alloy"];
const RESTITUTIONS: [f64; 5] = [0.1, 0.3, 0.5, 0.8, 1.0];
/// Impact angles from the normal (degrees) on the sliding branch.
const ANGLES: [f64; 5] = [40.0, 50.0, 60.0, 70.0, 80.0];
const HERTZ: Source = Source::Derived("energy and a quadrature of F = kδ^{3/2} (derivation)");
const RESTITUTION: Source = Source::Derived("damped oscillator in δ^{5/4}: v′/v = −e (derivation)");
const SLIDING: Source = Source::Derived("a contact that slides throughout has the impulse μ(1+e) m v_n (derivation)");

pub(crate) static CASE: Case = crate::heads::CHUNG_OOI.with(LEVELS, 2, &claims).drawn_by(figures);

fn claims() -> Vec<Claim> {
    let mut claims = [elastic(), restitution(), oblique(), rigid(), turning::claims(), fair::claims()].concat();
    for variant in [ELASTIC[0], ELASTIC[2], DAMPED[0], OBLIQUE[0]] {
        claims.extend(PAIRS.into_iter().flat_map(|pair| beside_program(variant, pair)));
    }
    for variant in [ELASTIC[0], ELASTIC[2]] {
        let run = |solver| Run::new(variant, solver, STEP.resolution);
        claims.extend(forces(run, &["contact.normal_force"], |scene| hertz(scene).1));
    }
    claims.push(force_that_moves());
    // At a wall, LAMMPS and LIGGGHTS output the force that moved the grain.
    let damped = |solver| Run::new(DAMPED[0], solver, STEP.resolution);
    claims.extend(forces(damped, &["contact.normal_force"], |scene| hertz(scene).1));
    claims
}

fn beside_program(variant: &'static str, pair: [&'static str; 2]) -> Vec<Claim> {
    let runs = || pair.map(|solver| Run::new(variant, solver, STEP.resolution));
    let allowed = same_cycle("relative to the velocity before");
    let control = Control::our_contact_law("E* × 1.00001 in ours", |law| law.scale_normal(1.00001));
    let mut claims = vec![row("velocity over the impact, worst", "m/s", allowed, runs(), control, |done| {
        worst(done, &["a.vx", "a.vz"], done[0].scene.grains[0].velocity.norm())
    })];
    if variant == OBLIQUE[0] {
        let allowed = same_cycle("relative to the velocity before over the radius");
        let control = Control::our_contact_law("G* × 1.00001 in ours", |law| law.scale_tangential(1.00001));
        claims.push(row("spin over the impact, worst", "rad/s", allowed, runs(), control, |done| {
            let grain = &done[0].scene.grains[0];
            worst(done, &["a.omega_y"], grain.velocity.norm() / grain.radius)
        }));
    }
    claims
}

/// Returns the contact law between the two spheres, or between the sphere and the plane.
fn law(scene: &Scene) -> ContactLaw {
    let partner = if scene.grains.len() == 2 { scene.grains[1].material } else { scene.walls[0].material };
    scene.law(scene.grains[0].material, partner).copied().unwrap_or_default()
}

/// Returns Hertz's stiffness k = (4/3)E*√R* (N/m^{3/2}), the effective mass (kg) and the approach velocity (m/s).
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
    (4.0 / 3.0 * law(scene).effective_modulus() * radius.sqrt(), mass, speed)
}

/// Returns the largest overlap (m), the largest force (N) and the duration (s) of an elastic impact.
fn hertz(scene: &Scene) -> (f64, f64, f64) {
    let (k, mass, speed) = impact(scene);
    let overlap = (5.0 * mass * speed * speed / (4.0 * k)).powf(0.4);
    (overlap, k * overlap.powf(1.5), 2.943_275_184 * overlap / speed)
}

/// Returns the largest sample, refined by a parabola through this sample and its two neighbours.
fn peak(values: &[f64]) -> f64 {
    let at = (1..values.len() - 1).max_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(1);
    let (left, top, right) = (values[at - 1], values[at], values[at + 1]);
    let bend = left - 2.0 * top + right;
    if bend < 0.0 { top - (right - left).powi(2) / (8.0 * bend) } else { top }
}

/// Returns the time (s) at which the overlap ends, extrapolated from the last two samples in contact.
fn duration(done: &FinishedRun) -> Result<f64, MissingData> {
    let overlap = done.column("contact.overlap")?;
    let time = &done.series().time;
    let last = overlap.iter().rposition(|&overlap| overlap > 0.0).ok_or("contact")?;
    let rate = (overlap[last - 1] - overlap[last]) / (time[last] - time[last - 1]);
    Ok(time[last] + overlap[last] / rate)
}

fn elastic() -> Vec<Claim> {
    type Formula = fn(&Scene) -> f64;
    const QUANTITIES: [(&str, &str, Formula, RunReader); 3] = [
        ("deepest overlap", "m", |scene| hertz(scene).0, |done| Ok(peak(done.column("contact.overlap")?))),
        ("largest force", "N", |scene| hertz(scene).1, |done| Ok(peak(done.column("contact.normal_force")?))),
        ("duration of contact", "s", |scene| hertz(scene).2, duration),
    ];
    let elastic_claims = |variant| {
        QUANTITIES.map(|(quantity, unit, exact, read)| {
            claim(quantity, unit)
                .run(Run::new(variant, "dem", STEP.resolution))
                .equals(HERTZ, move |done| Ok(Measurement::relative(read(&done[0])?, exact(&done[0].scene))))
                .within(estimated(1e-6, "discretisation of the impact by about a thousand steps"))
                .refuses(Control::contact_law("E* 1 % too large", |law| law.scale_normal(1.01)))
        })
    };
    ELASTIC.into_iter().flat_map(elastic_claims).collect()
}

/// Returns the damping ratio ζ that gives a coefficient of restitution.
fn damping_ratio(restitution: f64) -> f64 {
    let log = restitution.ln();
    -log / (PI * PI + log * log).sqrt()
}

fn with_restitution(variant: &'static str, restitution: f64) -> Run {
    Run::new(variant, "dem", STEP.resolution).adjusted(&format!("e = {restitution}"), move |scene| {
        scene.change_laws(|law| law.damping_ratio = damping_ratio(restitution));
    })
}

fn rebound(done: &FinishedRun) -> Result<f64, MissingData> {
    Ok(-done.last("a.vz")? / done.scene.grains[0].velocity.z)
}

/// Returns the tolerance of a coefficient of restitution. It is the error due to a dashpot that is half a step late.
fn late(variant: &str, restitution: f64) -> Tolerance {
    let error = |scene: &Scene| {
        let ((k, mass, speed), (overlap, ..)) = (impact(scene), hertz(scene));
        let step = STEP.step(scene);
        let (phase, zeta) = ((1.5 * k * overlap.sqrt() / mass).sqrt() * step, no_tension_ratio(restitution));
        let touch = 1.25 * zeta * (speed * step / overlap).powf(1.25);
        restitution * (no_tension_lag(zeta) * phase + touch)
    };
    computed(
        CASE.number(variant, error),
        "the dashpot is half a step late, so ζ is larger by the factor 1 + ζωΔt/2: e ζ² [acos ζ/(1 − ζ²)^{3/2} − ζ/(1 \
         − ζ²)] ωΔt with the frequency at the largest overlap; the start of contact costs up to half a step of the \
         dashpot's force, e (5/4) ζ (v Δt/δ_max)^{5/4}; the release adds no error, because the force is zero there",
    )
}

fn restitution() -> Vec<Claim> {
    let restitution_claims = |variant: &'static str, restitution: f64| {
        let (tolerance, control) = if restitution == 1.0 {
            let more = Control::contact_law("a little damping, e = .99", |law| law.damping_ratio = damping_ratio(0.99));
            (estimated(1e-6, "discretisation of the impact by about a thousand steps, without a dashpot"), more)
        } else {
            let more =
                Control::contact_law("the factor √(5/6) left out", |law| law.damping_ratio *= (6.0_f64 / 5.0).sqrt());
            (late(variant, restitution), more)
        };
        claim(format!("rebound velocity over impact velocity, e = {restitution}"), "1")
            .run(with_restitution(variant, restitution))
            .equals(RESTITUTION, move |done| Ok(Measurement::new(rebound(&done[0])?, restitution, 1.0)))
            .within(tolerance)
            .refuses(control)
    };
    DAMPED
        .into_iter()
        .flat_map(|variant| RESTITUTIONS.map(|restitution| restitution_claims(variant, restitution)))
        .collect()
}

/// Returns the force (N) on the sphere of aluminium oxide that hits the plane with e = 0.5, from literal numbers: k
/// δ^{3/2} + √5 ζ √(k m) δ^{1/4} δ̇ if positive. The damping ratio ζ is that of a contact that ends at zero force.
fn damped_force(overlap: f64, rate: f64) -> f64 {
    let (radius, density, modulus) = (0.0025_f64, 4000.0, 380.0e9 / (1.0 - 0.23 * 0.23));
    let stiffness = 4.0 / 3.0 * modulus * radius.sqrt();
    let mass = density * 4.0 / 3.0 * PI * radius.powi(3);
    let damping = 5.0_f64.sqrt() * no_tension_ratio(0.5) * (stiffness * mass).sqrt();
    if overlap > 0.0 { (stiffness * overlap.powf(1.5) + damping * overlap.powf(0.25) * rate).max(0.0) } else { 0.0 }
}

/// Returns the claim that the contact force recorded by `dem` is the force that moves the grain. The dashpot uses the
/// velocity half a step earlier, with which the sphere moved from the previous position to the present one.
fn force_that_moves() -> Claim {
    claim("force of a damped contact, the rate of overlap taken half a step back, worst", "N")
        .run(Run::new(DAMPED[0], "dem", STEP.resolution))
        .equals(
            Source::Derived("k δ^{3/2} + √5 ζ √(k m) δ^{1/4} δ̇, in numbers by hand (derivation)"),
            |done| {
                let (height, time) = (done[0].column("a.z")?, &done[0].series().time);
                let before = |at: usize| at.checked_sub(1);
                let rate = |at| before(at).map_or(3.9, |was| (height[was] - height[at]) / (time[at] - time[was]));
                let expected: Vec<f64> =
                    (0..height.len()).map(|at| damped_force(0.0025 - height[at], rate(at))).collect();
                let force = done[0].column("contact.normal_force")?;
                Ok(Measurement::worst_of(time, force, &expected, hertz(&done[0].scene).1))
            },
        )
        .within(computed(
            2.0 * f64::EPSILON * 1e5 + 2e4 * f64::EPSILON,
            "rounding relative to one step: 2 ε R of positions over the displacement v Δt = 1e-5 R, and ε t of times \
             over Δt, with t up to 2e4 Δt",
        ))
        .refuses(Control::contact_law("damping × 1.001", |law| law.damping_ratio *= 1.001))
}

fn at_angle(variant: &'static str, degrees: f64) -> Run {
    Run::new(variant, "dem", STEP.resolution).adjusted(&format!("{degrees}° from the normal"), move |scene| {
        let velocity = &mut scene.grains[0].velocity;
        let (speed, angle) = (velocity.norm(), degrees.to_radians());
        (velocity.x, velocity.z) = (speed * angle.sin(), -speed * angle.cos());
    })
}

/// Returns the tangential velocity after the impact, divided by the tangential velocity before it.
fn tangential(done: &FinishedRun) -> Result<f64, MissingData> {
    Ok(done.last("a.vx")? / done.scene.grains[0].velocity.x)
}

/// Returns tangential restitution and spin (rad/s) after sliding throughout, for the normal impulse m(1+e)v.
fn sliding(scene: &Scene) -> (f64, f64) {
    let meeting = ImpactParameters::from_scene(scene);
    let [along, spin] = meeting.after(scene, 1.0 + meeting.restitution);
    (along / scene.grains[0].velocity.x, spin)
}

fn oblique() -> Vec<Claim> {
    const ENDS: &str =
        "the spring sticks for an instant at both ends of the impact, where Mindlin's stiffness vanishes";
    let oblique_claims = |variant, degrees| {
        [
            claim(format!("tangential restitution at {degrees}°"), "1")
                .run(at_angle(variant, degrees))
                .equals(SLIDING, |done| Ok(Measurement::new(tangential(&done[0])?, sliding(&done[0].scene).0, 1.0)))
                .within(estimated(5e-5, ENDS))
                .refuses(more_friction()),
            claim(format!("spin after impact at {degrees}°"), "rad/s")
                .run(at_angle(variant, degrees))
                .equals(SLIDING, |done| {
                    Ok(Measurement::relative(done[0].last("a.omega_y")?, sliding(&done[0].scene).1))
                })
                .within(estimated(5e-5, ENDS))
                .refuses(Control::grains("a disc's inertia in a sphere", |grain| grain.inertia *= 0.5 / 0.4)),
        ]
    };
    let of_variant = |variant| ANGLES.into_iter().flat_map(move |degrees| oblique_claims(variant, degrees));
    OBLIQUE.into_iter().flat_map(of_variant).collect()
}

fn more_friction() -> Control {
    Control::contact_law("friction × 1.2", |law| law.friction *= 1.2)
}

/// Returns the claims on the solver `rigid`, which has no overlap and no contact duration, but an exact restitution.
/// The solver limits the friction impulse by μ m v_n, where m v_n is the impulse that stops the approach. Coulomb's
/// limit is μ(1+e) m v_n, because it includes the impulse of restitution.
fn rigid() -> Vec<Claim> {
    let rigid = |run: Run| Run { solver: "rigid", ..run.at(rigid::DEFAULT) };
    let oblique = || rigid(at_angle(OBLIQUE[0], 60.0));
    let rounding = || {
        computed(
            1e3 * f64::EPSILON,
            "an impulse at one contact is solved to rounding: ε in each of at most a thousand operations",
        )
    };
    vec![
        claim("rebound velocity over impact velocity, e = 0.8", "1")
            .run(rigid(with_restitution(DAMPED[0], 0.8)))
            .equals(RESTITUTION, |done| Ok(Measurement::new(rebound(&done[0])?, 0.8, 1.0)))
            .within(rounding())
            .refuses(Control::contact_law("e = .79", |law| law.damping_ratio = damping_ratio(0.79))),
        claim("tangential restitution at 60° with friction μ m v_n", "1")
            .run(oblique())
            .equals(
                Source::Derived("1 − μ v_n/v_t: friction limited by the impulse that stops the approach"),
                |done| {
                    let velocity = done[0].scene.grains[0].velocity;
                    let exact = 1.0 + law(&done[0].scene).friction * velocity.z / velocity.x;
                    Ok(Measurement::new(tangential(&done[0])?, exact, 1.0))
                },
            )
            .within(rounding())
            .refuses(more_friction()),
        claim("tangential restitution at 60°", "1")
            .run(oblique()
                .known(
                    "the friction limit uses the impulse that stops the approach, without the impulse of restitution",
                )
                .up_to(0.1))
            .equals(SLIDING, |done| Ok(Measurement::new(tangential(&done[0])?, sliding(&done[0].scene).0, 1.0)))
            .within(judged(2e-5, "accuracy of a solver with springs"))
            .refuses(Control::without_the_error("dem in its place", "dem", STEP.resolution)),
    ]
}

/// Returns the material of a variant and its test: `nylon (test 6)` for `6-nylon`.
fn test(variant: &str) -> String {
    let (number, material) = variant.split_once('-').unwrap_or_default();
    format!("{} (test {number})", material.replace('-', " "))
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut impacts = Vec::new();
    for variant in ["1-glass", "1-limestone"] {
        let done = runner.run(&Run::new(variant, "dem", STEP.resolution))?;
        let force = thinned(samples(&done, "contact.normal_force").unwrap_or_default(), 300);
        let points = force.into_iter().map(|(t, force)| (t * 1e6, force / 1e3)).collect();
        impacts.push(Curve::new(test(variant), Stroke::Line, points));
    }
    let (mut restitution, mut spin) = (Vec::new(), Vec::new());
    for variant in OBLIQUE {
        let (mut measured, mut turned) = (Vec::new(), Vec::new());
        for angle in [5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 50.0, 60.0, 70.0, 80.0] {
            let done = runner.run(&at_angle(variant, angle))?;
            if let (Ok(vx), Ok(omega)) = (done.last("a.vx"), done.last("a.omega_y")) {
                measured.push((angle, vx / done.scene.grains[0].velocity.x));
                turned.push((angle, omega));
            }
        }
        restitution.push(Curve::new(test(variant), Stroke::Markers, measured));
        spin.push(Curve::new(test(variant), Stroke::Markers, turned));
    }
    let scene = |angle: f64| runner.scene(&at_angle(OBLIQUE[0], angle));
    let (mut exact_restitution, mut exact_spin) = (Vec::new(), Vec::new());
    for angle in (33..=85).map(f64::from) {
        let at_angle = scene(angle)?;
        let (e, turn) = sliding(&at_angle);
        exact_restitution.push((angle, e));
        exact_spin.push((angle, turn));
    }
    restitution.push(Curve::new("slides throughout, rigid", Stroke::Dashed, exact_restitution));
    spin.push(Curve::new("slides throughout, rigid", Stroke::Dashed, exact_spin));
    let mut figures = vec![
        Figure::graph(
            "force",
            "Force during the impact of two spheres (test 1)",
            "Elastic spheres of radius 10 mm meet at ±10 m/s. Materials: glass and limestone.",
            [Axis::linear("time t (µs)"), Axis::linear("normal force (kN)")],
            impacts,
        ),
        Figure::graph(
            "tangential-restitution",
            "Tangential restitution of an oblique impact (test 4)",
            "Above 32.5° the surfaces slide during the whole impact, and the result depends on friction and \
             restitution alone (dashes). At smaller angles the surfaces stick and the tangential spring oscillates. \
             No closed form is known there, and no claim is made.",
            [Axis::linear("angle of impact from the normal (°)"), Axis::linear("v_t after / v_t before")],
            restitution,
        ),
        Figure::graph(
            "spin",
            "Spin after an oblique impact (test 4)",
            "Spin after the impact, from the runs of the previous figure. The dashed curve holds if the surfaces \
             slide during the whole impact.",
            [Axis::linear("angle of impact from the normal (°)"), Axis::linear("spin ω (rad/s)")],
            spin,
        ),
    ];
    figures.extend(turning::figures(runner)?);
    Ok(figures)
}
