//! Arrival of force in chains of discs struck at one end (Bardenhagen et al. 2001, Figs 9 to 11).

mod elastic;
mod fringes;
mod modal;

use crate::rows::rigid;
use crate::sources::literature::bardenhagen_2001;
use grainbench_harness::prelude::*;
use modal::Modes;

const LEVELS: &[Level] = &[fraction("dt=.02", 0.02), fraction("dt=.01", 0.01), fraction("dt=.005", 0.005)];
const STEP: Level = LEVELS[2];
/// Force that counts as arrival, as a fraction of the impedance force V√(k m).
const ARRIVED: f64 = 0.1;
/// Longitudinal wave speed of the paper's material (m/s). The unit of time is the transit of one disc, d/c.
const WAVE_SPEED: f64 = 10_208.355_710_680_81;
/// Source of the claims that force arrives earlier in one chain than in another.
const FASTER: Source = Source::Printed(
    &bardenhagen_2001::WORK,
    "text to Figs 10 and 11: fringes pass the line, and the glued zig-zag, much faster than the zig-zag that slips",
);
/// Largest ratio of arrival times that counts as an earlier arrival. The paper states no ratio.
const SOONER: f64 = 0.99;
const SMOOTH: &str = "zig-zag-smooth";
const GLUED: &str = "zig-zag-glued";

pub(crate) static CASE: Case = crate::heads::DISK_CHAINS.with(LEVELS, 2, &claims).drawn_by(figures);

/// Returns the two discs of a contact between neighbours as indices in the scene, which lists discs of odd number first.
fn pair(scene: &Scene, first: usize) -> [usize; 2] {
    let odd = scene.grains.len().div_ceil(2);
    let place = |number: usize| if number % 2 == 1 { number / 2 } else { odd + number / 2 - 1 };
    let (a, b) = (place(first), place(first + 1));
    [a.min(b), a.max(b)]
}

/// Returns the threshold force 0.1 V√(k m) (N).
fn threshold(scene: &Scene) -> f64 {
    let stiffness = scene.laws.iter().flatten().map(|law| law.normal_stiffness()).fold(0.0, f64::max);
    ARRIVED * scene.walls[0].motion.phases[0].velocity.norm() * (stiffness * scene.grains[0].mass).sqrt()
}

/// Returns the time at which a column first exceeds a threshold (s), interpolated between two samples.
fn first_above(done: &FinishedRun, column: &str, threshold: f64) -> Result<f64, MissingData> {
    let (time, values) = (&done.series().time, done.column(column)?);
    let at = values.iter().position(|&value| value > threshold).filter(|&at| at > 0);
    let at = at.ok_or_else(|| format!("`{column}` above its threshold"))?;
    let share = (threshold - values[at - 1]) / (values[at] - values[at - 1]);
    Ok(time[at - 1] + share * (time[at] - time[at - 1]))
}

/// Returns the arrival time (s) of force at the contact between a disc and the next disc.
fn arrival(done: &FinishedRun, first: usize) -> Result<f64, MissingData> {
    first_above(done, &format!("{first}-{}.normal_force", first + 1), threshold(&done.scene))
}

fn duration(scene: &Scene) -> f64 {
    scene.duration.seconds().unwrap_or(f64::NAN)
}

/// Returns the run with a thousandth of the striker's speed. The modal solution neglects changes of geometry.
fn gentle(variant: &'static str) -> Run {
    Run::new(variant, "dem", STEP.resolution).adjusted("striker at a thousandth of its speed", |scene| {
        scene.walls[0].motion.phases[0].velocity *= 1e-3;
    })
}

fn claims() -> Vec<Claim> {
    let contacts = [("line", 2..=3), (SMOOTH, 2..=4)];
    let mut claims: Vec<Claim> =
        contacts.into_iter().flat_map(|(variant, all)| all.map(move |first| exact(variant, first))).collect();
    claims.push(glued());
    claims.push(sooner(GLUED, "glued zig-zag over that of the slipping one"));
    claims.push(sooner("line", "line over that of the slipping zig-zag"));
    claims.push(rigid());
    claims.extend(elastic::claims());
    claims
}

fn exact(variant: &'static str, first: usize) -> Claim {
    claim(format!("arrival of force between discs {first} and {}", first + 1), "s")
        .run(gentle(variant))
        .equals(Source::Derived("modes of the assembly (derivation)"), move |done| {
            let scene = &done[0].scene;
            let modes = Modes::from_scene(scene);
            let exact = modes.arrival(pair(scene, first), threshold(scene), duration(scene));
            Ok(Measurement::relative(arrival(&done[0], first)?, exact))
        })
        .within(computed(
            0.02_f64.powi(2) / 24.0 + 2e-6,
            "(ωΔt)²/24 of central differences at ωΔt = .02 for the fastest mode of a chain; displacements of 2e-6 R \
             turn the normals",
        ))
        .refuses(Control::contact_law("contacts 1 % too stiff", |law| law.scale_normal(1.01)))
}

fn glued() -> Claim {
    claim("force between discs 1 and 2 until a contact opens, worst", "N")
        .run(gentle(GLUED))
        .equals(Source::Derived("modes of the assembly with sticking contacts (derivation)"), |done| {
            let done = &done[0];
            let scene = &done.scene;
            let modes = Modes::from_scene(scene);
            let opens = modes.first_opening(duration(scene));
            let (time, force) = (&done.series().time, done.column("1-2.normal_force")?);
            let count = time.iter().take_while(|&&time| time < opens).count();
            let exact = |time| modes.force(pair(scene, 1), time);
            Ok(Measurement::worst(&time[..count], &force[..count], exact, threshold(scene) / ARRIVED))
        })
        .within(judged(
            1e-4,
            "central differences at ω₀Δt = .01; contacts with a tension below a hundredth of the striker's \
             displacement count as closed; in units of V√(k m)",
        ))
        .refuses(Control::contact_law("tangential springs 1 % too soft", |law| law.scale_tangential(0.99)))
}

fn sooner(variant: &'static str, chain: &str) -> Claim {
    claim(format!("arrival at disc 4 of the {chain}"), "1")
        .run(Run::new(variant, "dem", STEP.resolution))
        .run(Run::new("zig-zag", "dem", STEP.resolution))
        .at_most(SOONER, FASTER, |done| Ok(arrival(&done[0], 3)? / arrival(&done[1], 3)?))
        .within(exactly(
            "the paper states an order of fringes and no ratio; earlier by a hundredth or more is required",
        ))
        .refuses(Control::scene("the slipping zig-zag four times as stiff", |scene| {
            let slips = scene.laws.iter().flatten().any(|law| law.friction == 0.5);
            scene.change_laws(|law| law.scale_normal(if slips { 4.0 } else { 1.0 }));
        }))
}

fn rigid() -> Claim {
    claim("time until disc 4 moves at a tenth of the striker's speed", "s")
        .run(Run::new("line", "rigid", rigid::DEFAULT)
            .known("contacts are rigid: an impulse passes through all discs in one step, like a wave of infinite speed")
            // The relative error is at least −1, because no arrival is earlier than the impact.
            .up_to(1.0))
        .equals(Source::Derived("modes of the assembly (derivation)"), |done| {
            let scene = &done[0].scene;
            let speed = ARRIVED * scene.walls[0].motion.phases[0].velocity.norm();
            let exact = Modes::from_scene(scene).moving(pair(scene, 3)[1], speed, duration(scene));
            Ok(Measurement::relative(first_above(&done[0], "fourth.vx", speed)?, exact))
        })
        .within(judged(1e-3, "accuracy of a solver with springs"))
        .refuses(Control::without_the_error("dem in its place", "dem", STEP.resolution))
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut figures = Vec::new();
    let mut arrivals = Vec::new();
    for (variant, title) in [
        ("line", "Forces along the line of four"),
        ("zig-zag", "Forces along the zig-zag, μ = 0.5"),
        (GLUED, "Forces along the glued zig-zag"),
    ] {
        let done = runner.run(&Run::new(variant, "dem", STEP.resolution))?;
        let scene = &done.scene;
        let unit = 2.0 * scene.grains[0].radius / WAVE_SPEED;
        let impedance = threshold(scene) / ARRIVED;
        let mut curves = Vec::new();
        let mut arrived = Vec::new();
        for first in 1..scene.grains.len() {
            let force = done.series().column(&format!("{first}-{}.normal_force", first + 1)).unwrap_or_default();
            let samples = done.series().time.iter().zip(force).step_by(4);
            let points = samples.map(|(time, force)| (time / unit, force / impedance)).collect();
            curves.push(Curve::new(format!("discs {first} and {}", first + 1), Stroke::Line, points));
            if let Ok(time) = arrival(&done, first) {
                arrived.push((first as f64 + 1.0, time / unit));
            }
        }
        figures.push(Figure::graph(
            variant,
            title,
            "Normal forces between neighbouring discs, over the impedance force V√(k m). The arrival is the time at \
             which a force reaches a tenth of the impedance force.",
            [Axis::linear("time t c/d (1)"), Axis::linear("normal force / V√(k m)")],
            curves,
        ));
        let label = if variant == GLUED { "glued zig-zag" } else { variant };
        arrivals.push(Curve::new(label, Stroke::MarkedLine, arrived));
    }
    figures.push(Figure::graph(
        "arrivals",
        "Arrival times of the contact force",
        "Time at which the force arrives at the contact of each disc with the previous disc.",
        [Axis::linear("number of the disc"), Axis::linear("time of arrival t c/d (1)")],
        arrivals,
    ));
    figures.push(elastic::figure(runner)?);
    figures.extend(fringes::figures(runner)?);
    Ok(figures)
}
