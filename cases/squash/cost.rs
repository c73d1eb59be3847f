//! Target quantity of the cost study: the motion of a disc between the walls in continuous time, without the finite
//! time step of the paper.
//!
//! m ü = F_A − F_B, with F_A = k(vt − u), F_B = 2ku for equal and opposite discs: u = vt/3 − (v/3W) sin Wt, W =
//! √(3k/m).

use grainbench_harness::prelude::*;

/// Duration of the run (s), several periods of the pair of discs. The period is 2π/√3 = 3.63 s.
const SECONDS: f64 = 20.0;

pub(super) fn targets(case: &'static Case) -> Vec<TargetQuantity> {
    let lane = |method, about| SolverSetup {
        method,
        knobs: String::new(),
        prepare: Some(Arc::new(|scene: &mut Scene| {
            scene.duration = Duration::Seconds(SECONDS);
            scene.sampling = Sampling::Seconds(0.1);
            scene.probes.push(Probe { name: "x".to_owned(), target: ProbeTarget::Grain(0) });
        })),
        about,
    };
    vec![TargetQuantity {
        case,
        variant: PLAIN,
        quantity: "displacement of disc x over 20 s, worst".to_owned(),
        unit: "m",
        source: "u = vt/3 − (v/3W) sin Wt, W = √(3k/m) (derivation)".to_owned(),
        measure: Arc::new(|done| {
            let done = done.first().ok_or("run")?;
            let scene = &done.scene;
            let stiffness = scene.laws.iter().flatten().map(|law| law.normal_stiffness()).fold(0.0, f64::max);
            let speed = scene.walls[0].motion.phases[0].velocity.x;
            let frequency = (3.0 * stiffness / scene.grains[0].mass).sqrt();
            let start = scene.grains[0].position.x;
            let moved: Vec<f64> = done.column("x.x")?.iter().map(|x| x - start).collect();
            let exact = |t: f64| speed / 3.0 * (t - (frequency * t).sin() / frequency);
            Ok(Measurement::worst(&done.series().time, &moved, exact, speed / frequency / 3.0))
        }),
        lanes: vec![lane(Method::Dem, Resolution::CriticalFraction(0.1)), lane(Method::Rigid, Resolution::substeps(8))],
    }]
}
