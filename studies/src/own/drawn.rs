//! Test of the reported intervals on drawn scenes with closed forms: damped flight, a bounce, a disc between two springs, and a
//! disc that slips down a slope.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use super::*;
use grainbench_dem::convention::Convention;
use grainbench_dem::solver::Dem;
use grainbench_solver::failure::RunError;
use grainbench_solver::record::Record;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Number of drawn scenes.
const SCENES: u64 = 50;
/// Finenesses of the levels.
const LEVELS: [f64; 5] = [1.0, 2.0, 4.0, 8.0, 16.0];

/// Scene with the exact values of some columns at the end.
struct Drawn {
    text: String,
    exact: Vec<(&'static str, f64)>,
}

const HEAD: &str =
    "title = 'drawn'\ndimension = 2\nmaterials.m.density = 1000.0\n[probes]\nball = { grain = 'ball' }\n";

/// Mass of a disc of 1000 kg/m³ (kg/m).
fn mass(radius: f64) -> f64 {
    1000.0 * std::f64::consts::PI * radius * radius
}

/// Flight with the global damping α: v = w + (v₀ − w) e^{−αt} with w = g/α.
fn flight(dice: &mut dyn FnMut(f64, f64) -> f64) -> Drawn {
    let (rate, time) = (dice(0.2, 3.0), dice(0.3, 2.0));
    let ([vx, vy], y) = ([dice(1.0, 5.0), dice(1.0, 5.0)], dice(0.0, 2.0));
    let (rest, left) = (-9.81 / rate, (-rate * time).exp());
    let text = format!(
        "global_damping = {rate:?}\ngravity = [0.0, -9.81]\nduration = {time:?}\n{HEAD}[grains.ball]\nmaterial = 'm'\n\
         radius = 0.1\nposition = [0.0, {y:?}]\nvelocity = [{vx:?}, {vy:?}]\n"
    );
    let way = (1.0 - left) / rate;
    let exact = vec![
        ("ball.x", vx * way),
        ("ball.y", y + rest * time + (vy - rest) * way),
        ("ball.vx", vx * left),
        ("ball.vy", rest + (vy - rest) * left),
    ];
    Drawn { text, exact }
}

/// A disc falls on a floor with a spring and a dashpot, and rebounds. The contact ends when its force returns to zero.
fn bounce(dice: &mut dyn FnMut(f64, f64) -> f64) -> Drawn {
    let (radius, height, g) = (dice(0.05, 0.3), dice(0.05, 0.5), 9.81);
    let (omega, damping) = (dice(200.0, 600.0), dice(5.0, 100.0));
    let (stiffness, fall) = (mass(radius) * omega * omega, (2.0 * height / g).sqrt());
    let (half, speed) = (0.5 * damping, g * fall);
    let swing = (omega * omega - half * half).sqrt();
    // Overlap u and its rate, with u″ + γu′ + ω²u = g, u(0) = 0 and u′(0) = speed.
    let rest = g / (omega * omega);
    let sine = (speed - half * rest) / swing;
    let overlap = |t: f64| rest + (-half * t).exp() * (sine * (swing * t).sin() - rest * (swing * t).cos());
    let rate = |t: f64| {
        let (s, c) = (swing * t).sin_cos();
        (-half * t).exp() * (swing * (sine * c + rest * s) - half * (sine * s - rest * c))
    };
    let force = |t: f64| omega * omega * overlap(t) + damping * rate(t);
    let (mut low, mut high) = (0.3 * std::f64::consts::PI / swing, 1.2 * std::f64::consts::PI / swing);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if force(middle) > 0.0 { low = middle } else { high = middle }
    }
    let (start, up) = (radius - overlap(low), -rate(low));
    let after = dice(0.2, 0.8) * up / g;
    let time = fall + low + after;
    let text = format!(
        "gravity = [0.0, -9.81]\nduration = {time:?}\n{HEAD}[contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = \
         {stiffness:?}\nnormal_damping = {damping:?}\n[grains.ball]\nmaterial = 'm'\nradius = {radius:?}\nposition = [0.0, \
         {:?}]\n{FLOOR}",
        radius + height
    );
    let exact = vec![("ball.y", start + up * after - 0.5 * g * after * after), ("ball.vy", up - g * after)];
    Drawn { text, exact }
}

const FLOOR: &str = "[walls.floor]\nmaterial = 'm'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n";

/// A disc oscillates between two walls, which both stay in contact: x″ + 2γx′ + 2(k/m)x = 0.
fn between(dice: &mut dyn FnMut(f64, f64) -> f64) -> Drawn {
    let (omega, damping, amplitude) = (dice(50.0, 200.0), dice(0.0, 10.0), dice(0.1, 0.9) * 1e-3);
    let (radius, overlap) = (0.1, 1e-3);
    let stiffness = mass(radius) * omega * omega;
    let swing = (2.0 * omega * omega - damping * damping).sqrt();
    let time = dice(2.0, 12.0) * std::f64::consts::PI / swing;
    let (s, c) = (swing * time).sin_cos();
    let left = (-damping * time).exp() * amplitude;
    let reach = radius - overlap;
    let text = format!(
        "duration = {time:?}\n{HEAD}[contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = {stiffness:?}\nnormal_damping = \
         {damping:?}\n[grains.ball]\nmaterial = 'm'\nradius = {radius:?}\nposition = [{amplitude:?}, 0.0]\n[walls]\nleft = {{ \
         material = 'm', plane = {{ point = [{:?}, 0.0], normal = [1.0, 0.0] }} }}\nright = {{ material = 'm', plane = {{ \
         point = [{reach:?}, 0.0], normal = [-1.0, 0.0] }} }}\n",
        -reach
    );
    let exact = vec![
        ("ball.x", left * (c + damping / swing * s)),
        ("ball.vx", -left * (swing + damping * damping / swing) * s),
    ];
    Drawn { text, exact }
}

/// A disc is released on a slope at its static overlap. Its tangential spring of frequency ω² = 3 k_t/m loads until the Coulomb
/// limit, and the disc slips from then on (module `one_grain` of the cases).
fn slips(dice: &mut dyn FnMut(f64, f64) -> f64) -> Drawn {
    let (radius, along, onto, friction) = (0.1, dice(4.0, 8.0), dice(4.0, 8.0), dice(0.05, 0.2));
    let overlap = 1e-7 * radius;
    let stiffness = mass(radius) * onto / overlap;
    let tangential = dice(0.3, 0.9) * stiffness;
    let omega = (3.0 * tangential / mass(radius)).sqrt();
    let share = 1.0 / 3.0;
    let late = (1.0 - friction * onto / (share * along)).acos() / omega;
    let time = dice(1.5, 4.0) * late;
    let stuck = (
        along * ((1.0 - share) * late + share * (omega * late).sin() / omega),
        along * share / (0.5 * radius) * (late - (omega * late).sin() / omega),
    );
    let text = format!(
        "gravity = [{along:?}, {:?}]\nduration = {time:?}\n{HEAD}[contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = \
         {stiffness:?}\ntangential_stiffness = {tangential:?}\nfriction = {friction:?}\n[grains.ball]\nmaterial = 'm'\nradius = \
         {radius:?}\nposition = [0.0, {:?}]\n{FLOOR}",
        -onto,
        radius - overlap
    );
    let exact = vec![
        ("ball.vx", stuck.0 + (along - friction * onto) * (time - late)),
        ("ball.omega", -(stuck.1 + friction * onto / (0.5 * radius) * (time - late))),
    ];
    Drawn { text, exact }
}

fn middle(low: f64, high: f64) -> f64 {
    0.5 * (low + high)
}

/// Returns the study of a scene with fixed levels.
fn study(text: &str) -> SceneCost {
    with_study(text, (&ALWAYS, &|| false), Duration::from_secs(3600), |measurement| {
        for fineness in LEVELS {
            measurement.level(0, fineness, &mut ()).unwrap();
        }
    })
}

/// Returns the results of a study of a scene after some runs.
fn with_study(
    text: &str,
    (solvers, stop): (&dyn Solvers, &(dyn Fn() -> bool + Sync)),
    budget: Duration,
    runs: impl FnOnce(&mut Measurement<'_>),
) -> SceneCost {
    let scene = Scene::from_text("scene", text).unwrap();
    let cache = Directory::none();
    let study = SceneStudy {
        name: "drawn".to_owned(),
        scene: &scene,
        names: vec!["dem".to_owned()],
        solvers,
        quantities: Vec::new(),
        window: None,
        budget,
        cache: &cache,
        program: String::new(),
        stop,
    };
    let mut measurement = Measurement::new(&study);
    runs(&mut measurement);
    measurement.result()
}

/// Returns the drawn scenes with their studies.
fn all() -> Vec<(Drawn, SceneCost)> {
    let kinds = [flight, bounce, between, slips];
    (0..SCENES)
        .map(|seed| {
            let mut dice = Pcg64Mcg::seed_from_u64(seed);
            let drawn = kinds[seed as usize % kinds.len()](&mut |low, high| low + (high - low) * dice.random::<f64>());
            let study = study(&drawn.text);
            (drawn, study)
        })
        .collect()
}

/// Returns the fraction of reported intervals that contain the true error, with the uncertainty divided by a factor.
fn coverage(studies: &[(Drawn, SceneCost)], factor: f64) -> f64 {
    let mut counts = [0.0, 0.0];
    for (drawn, study) in studies {
        for (name, exact) in &drawn.exact {
            let quantity = study.quantities.iter().find(|quantity| quantity.name == *name).unwrap();
            for point in &quantity.points {
                let error = (point.value - exact).abs() / quantity.scale;
                let is_within = (error - point.error).abs() <= point.uncertainty / factor;
                counts[usize::from(is_within)] += 1.0;
            }
        }
    }
    counts[1] / (counts[0] + counts[1])
}

#[test]
fn intervals_contain_the_true_error() {
    let studies = all();
    let within = coverage(&studies, 1.0);
    assert!(within >= 0.9, "{within}");
    // Negative control: a tenth of the uncertainty is too small.
    let control = coverage(&studies, 10.0);
    assert!(control < 0.9, "{control}");

    // The setting that the sentence names has an error of at most the stated one.
    let (mut right, mut all) = (0.0, 0.0);
    for (drawn, study) in &studies {
        for target in [0.1, 0.01, 0.001] {
            let Some((setting, _)) = study.cheapest_for_all("dem", target) else { continue };
            let sentence = study.sentence(target, &[]);
            assert!(sentence.contains("dem ") && sentence.contains(setting), "{sentence}");
            for (name, exact) in &drawn.exact {
                let quantity = study.quantities.iter().find(|quantity| quantity.name == *name).unwrap();
                let point = quantity.points.iter().find(|point| point.setting == setting).unwrap();
                all += 1.0;
                right += f64::from((point.value - exact).abs() / quantity.scale <= target);
            }
        }
    }
    assert!(all > 100.0 && right / all >= 0.95, "{right} of {all}");
}

/// A scene that no level resolves: the sentence says so, and names the budget.
#[test]
fn a_sentence_states_that_no_solver_reaches_the_target() {
    let mut study = study(&flight(&mut middle).text);
    assert!(study.sentence(0.01, &[]).starts_with("1\u{202f}% in each of "), "{}", study.sentence(0.01, &[]));
    for point in study.quantities.iter_mut().flat_map(|quantity| &mut quantity.points) {
        point.uncertainty = 0.02;
    }
    let sentence = study.sentence(0.01, &[]);
    assert!(
        sentence.contains("no solver reaches it within the budget") && sentence.contains("at best 2"),
        "{sentence}"
    );
}

/// The scale of a column is its own largest value or its own mean absolute value. The largest velocity is vertical, and its
/// scale would be wrong for the horizontal one.
#[test]
fn each_column_has_its_own_scale() {
    let (rate, time, speed) = (1.6, 1.15, 3.0);
    let text = flight(&mut middle).text;
    with_study(&text, (&ALWAYS, &|| false), Duration::from_secs(3600), |measurement| {
        for fineness in LEVELS {
            measurement.level(0, fineness, &mut ()).unwrap();
        }
        let scale = |reduction, name: &str| {
            let found = measurement.quantities(reduction);
            found.into_iter().find(|quantity| quantity.name == name).unwrap().scale
        };
        assert!((scale(Reduction::End, "ball.vx") - speed).abs() < 1e-9);
        assert!(scale(Reduction::End, "ball.vy") > 1.2 * speed);
        let mean = speed * (1.0 - f64::exp(-rate * time)) / (rate * time);
        assert!((scale(Reduction::Mean, "ball.vx") / mean - 1.0).abs() < 1e-2);
    });
}

/// A stopped study has whole runs only, and no note. Negative control: without a stop there are further levels.
#[test]
fn a_stopped_study_has_whole_runs_only() {
    let text = between(&mut middle).text;
    let levels = |most: usize| {
        let asked = AtomicUsize::new(0);
        let stop = || asked.fetch_add(1, Ordering::Relaxed) >= most;
        with_study(&text, (&ALWAYS, &stop), Duration::from_secs(5), |measurement| {
            measurement.levels(&mut ()).unwrap();
        })
    };
    let (stopped, whole) = (levels(100), levels(usize::MAX));
    assert!(stopped.levels.len() < whole.levels.len(), "{} {}", stopped.levels.len(), whole.levels.len());
    assert!(stopped.levels.iter().all(|level| level.status == PointStatus::Measured) && stopped.notes.is_empty());
}

/// The solver `dem`, which breaks above a fraction of the critical time step.
struct Breaks(f64);

/// The solver `dem`, which never breaks.
const ALWAYS: Breaks = Breaks(f64::INFINITY);

impl Solver for Breaks {
    fn name(&self) -> String {
        "dem".to_owned()
    }

    fn run(&self, scene: &Scene, resolution: &Resolution, observer: &mut dyn Observer) -> Result<Record, RunError> {
        match resolution {
            Resolution::CriticalFraction(fraction) if *fraction > self.0 => {
                Err(RunError::Resolution { solver: self.name(), reason: "the step is too large".to_owned() })
            }
            _ => Dem::new(Convention::DEFAULT).run(scene, resolution, observer),
        }
    }
}

impl Solvers for Breaks {
    fn find(&self, _name: &str) -> Option<Arc<dyn Solver>> {
        Some(Arc::new(Self(self.0)))
    }
}

/// A solver that breaks at the first six levels still gets a value. Negative control: a solver that always breaks ends after
/// a limited number of levels, and the results name it.
#[test]
fn a_solver_that_breaks_at_coarse_levels_gets_finer_ones() {
    let text = between(&mut middle).text;
    let levels = |coarsest| {
        with_study(&text, (&Breaks(coarsest), &|| false), Duration::from_secs(5), |measurement| {
            measurement.levels(&mut ()).unwrap();
        })
    };
    let late = levels(0.4 / 50.0);
    let failed = late.levels.iter().take_while(|level| level.status == PointStatus::Failed).count();
    assert_eq!(failed, 6);
    assert!(late.levels[failed..].iter().filter(|level| level.status == PointStatus::Measured).count() >= 2);
    assert!(!late.sentence(0.01, &[]).contains("no value"), "{}", late.sentence(0.01, &[]));
    let never = levels(0.0);
    assert!(never.levels.len() == FAILURES[0] && never.quantities.is_empty());
    assert!(never.sentence(0.01, &[]).contains("dem has no value (12 levels failed)"), "{}", never.sentence(0.01, &[]));
    assert!(never.notes.iter().any(|note| note.starts_with("dem: 12 levels failed")), "{:?}", never.notes);
}
