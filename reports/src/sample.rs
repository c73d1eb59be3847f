//! A small report for tests, with all kinds of results and figures.

use crate::study::effects::{EffectResult, Entry, Shift};
use crate::study::point::{Diagram, Point, PointStatus};
use crate::study::stability::{HardCaseResult, Hardness, Limit};
use grainbench_harness::case::Physics;
use grainbench_harness::control::FailureMode;
use grainbench_harness::evidence::Evidence;
use grainbench_harness::expect::ExpectedValue;
use grainbench_harness::figure::{Axis, Curve, Figure, ForceBar, ForcePlot, Stroke};
use grainbench_harness::tolerance::ToleranceOrigin;
use grainbench_harness::verdict::{ControlResult, Outcome, Verdict};

use crate::judged::ExternalResults;
use crate::measured::{Costs, Effects, Measurements, Stability};
use crate::report::{Provenance, Report, RunCost, Section};
use crate::study::Study;

/// Returns a result that passes if |value − expected|/|expected| is at most `allowed`, and fails otherwise.
pub(crate) fn verdict(case: &str, solver: &str, quantity: &str, value: f64, expected: f64, allowed: f64) -> Verdict {
    let error = (value - expected) / expected.abs();
    Verdict {
        solver: solver.into(),
        resolution: "dt=.1".into(),
        value: Some(value),
        expected: Some(ExpectedValue::Value(expected)),
        scale: Some(expected.abs()),
        error: Some(error),
        allowed,
        tolerance: ToleranceOrigin::Judged,
        because: "the scheme is first order in Δt".into(),
        evidence: Evidence::Analytic,
        source: "rigid sphere under Coulomb friction, eq. 26".into(),
        outcome: if error.abs() <= allowed { Outcome::Pass } else { Outcome::Fail },
        ..Verdict::open(case, quantity, "m/s")
    }
}

fn without_value(row: Verdict) -> Verdict {
    Verdict { value: None, error: None, ..row }
}

fn control(case: &str, quantity: &str, wrong_physics: &str, turned_red: bool) -> ControlResult {
    let (error, outcome) = if turned_red { (0.31, Outcome::Fail) } else { (0.004, Outcome::Pass) };
    let row =
        Verdict { outcome, value: Some(1.0), error: Some(error), allowed: 0.02, ..Verdict::open(case, quantity, "1") };
    ControlResult::new(Verdict { solver: "dem".into(), ..row }, wrong_physics, FailureMode::Value, 0.01)
}

fn run(solver: &str, resolution: &str, time_step: f64, steps: u64) -> RunCost {
    RunCost {
        key: String::new(),
        variant: String::new(),
        solver: solver.into(),
        resolution: resolution.into(),
        steps,
        particle_steps: steps,
        contact_evaluations: Some(steps),
        wall_seconds: steps as f64 / 2.5e7,
        time_step,
        fraction_of_critical: Some(time_step / 2e-4),
    }
}

fn backspin() -> Section {
    let case = "backspin";
    let times = || (0..=400).map(|step| f64::from(step) * 0.002);
    // The sphere slides until t = 0.2913 s, and then rolls.
    let exact = |t: f64| {
        if t < 0.2913 { 2.0 - 1.9620 * t } else { 1.428_471 }
    };
    let broken = without_value(verdict(case, "mpm", "v(t=0.5 s)", 1.0, 1.428_571, 0.02));
    let broken = Verdict { resolution: "R/8".into(), ..broken }
        .left(Outcome::Broken, "not finite at t=0.213 s, step 1065; Δt=1.5×10⁻⁴ s would have been stable");
    let fail = verdict(case, "dem:liggghts", "v(t=0.5 s)", 1.391, 1.428_571, 0.02)
        .left(Outcome::Fail, "first outside at t=0.21 s");
    let mut known = verdict(case, "mpm:2000", "spin at the end", -1.21, -1.0, 0.02)
        .left(Outcome::Known, "the contact of 2000 does not release, as its paper says");
    known.unit = "rad/s".into();
    known.evidence = Evidence::Paper;
    known.source = "Bardenhagen and others (2000), fig. 7".into();
    let mut momentum = verdict(case, "dem", "largest momentum drift", 2.2e-16, 1.0, 1e-12);
    momentum.unit = "kg m/s".into();
    momentum.expected = Some(ExpectedValue::Value(0.0));
    momentum.scale = Some(0.5);
    momentum.error = Some(4.4e-16);
    momentum.evidence = Evidence::Invariant;
    momentum.source = "Newton's third law".into();
    momentum.because = "a thousand roundings of double precision".into();
    momentum.outcome = Outcome::Pass;
    let levels = [0.4, 0.2, 0.1, 0.05, 0.025, 0.0125];
    let convergence = Figure::graph(
        "convergence",
        "Error against time step",
        "Error of the end speed over the levels. The in-house solver converges with the first power of the step, LAMMPS' \
         convention with the second.",
        [Axis::log("Δt / critical (1)"), Axis::log("|error| of v(t = 0.5 s) (1)")],
        vec![
            Curve::new("dem", Stroke::MarkedLine, levels.map(|x| (x, 0.03 * x)).to_vec()),
            Curve::new("dem:lammps", Stroke::MarkedLine, levels.map(|x| (x, 0.19 * x * x)).to_vec()),
            Curve::new(
                "rigid, 8 substeps",
                Stroke::MarkedLine,
                levels.map(|x| (x, if x < 0.02 { 0.0 } else { 4e-4 + 0.01 * x })).to_vec(),
            ),
            Curve::new("allowed", Stroke::Dashed, vec![(0.0125, 0.02), (0.4, 0.02)]),
            Curve::new("first order", Stroke::Dashed, vec![(0.0125, 1.25e-3), (0.1, 1e-2)]),
        ],
    );
    let velocity = Figure::graph(
        "velocity",
        "Velocity of the centre",
        "Sliding, then rolling. The kink is at t* = 0.291 s.",
        [Axis::linear("time t (s)"), Axis::linear("velocity v (m/s)")],
        vec![
            Curve::new("dem", Stroke::Line, times().map(|t| (t, exact(t) + 0.004 * (60.0 * t).sin())).collect()),
            Curve::new("dem:liggghts", Stroke::Line, times().map(|t| (t, exact(t) * (1.0 - 0.05 * t))).collect()),
            Curve::new(
                "rigid, 8 substeps",
                Stroke::Line,
                times().map(|t| (t, exact(t) + 0.03 * (1.0 - (-9.0 * t).exp()))).collect(),
            ),
            Curve::new("exact", Stroke::Dashed, times().map(|t| (t, exact(t))).collect()),
        ],
    );
    Section {
        name: case.into(),
        title: "A sphere with backspin on a rough floor".into(),
        physics: Physics::Rolling,
        claim: "A sphere set down with velocity v₀ and backspin slides, slows at μg and rolls from t* on at a speed \
                that depends neither on friction nor on stiffness. A solver that has Coulomb friction, the lever arm \
                and the moment of inertia right must reach it."
            .into(),
        derivation: "While the contact slips, friction is μmg and both equations are linear:\n\n\
                     ```\nv(t) = v₀ − μ g t\nω(t) = ω₀ + (5/2) μ g t / R\n```\n\n\
                     Slip ends when v = ωR, that is at `t* = (2/7)(v₀ − ω₀R)/(μg)`. From then on\n\n\
                     ```\nv = (5 v₀ + 2 ω₀ R)/7\n```\n\n\
                     ## Limits\n\nThe contact is soft: the first oscillation of the normal force lasts \
                     *√(m/k)* and changes v by less than 10⁻⁴.\n\n\
                     | μ | t* (s) |\n|---|---|\n| 0.2 | 0.291 |\n| 0.4 | 0.146 |\n"
            .into(),
        weak:
            "One contact only: neighbour search and history transfer are not tested. The final speed does not depend \
               on μ; only **t\\*** depends on it."
                .into(),
        omitted: None,
        figures: vec![convergence, velocity],
        verdicts: vec![
            verdict(case, "dem", "v(t=0.5 s)", 1.4268, 1.428_571, 0.02),
            fail,
            verdict(case, "rigid", "v(t=0.5 s)", 1.4411, 1.428_571, 0.02),
            broken,
            known,
            momentum,
        ],
        controls: vec![
            control(case, "v(t=0.5 s)", "moment of inertia of a disc, ½ m R²", true),
            control(case, "v(t=0.5 s)", "friction ten per cent too high", false),
        ],
        runs: vec![
            run("dem", "dt=.1", 2e-5, 25_000),
            run("dem", "dt=.05", 1e-5, 50_000),
            RunCost { fraction_of_critical: None, ..run("rigid", "8 substeps", 1.0 / 480.0, 1_234_567) },
        ],
    }
}

fn nine_discs() -> Section {
    let case = "nine-discs";
    let radius = 0.05;
    let disc = |place: u32| {
        let (column, row) = (f64::from(place % 3), f64::from(place / 3));
        ([0.06 + 0.1 * column + 0.012 * (row % 2.0), 0.05 + 0.098 * row], radius, 0.4 * f64::from(place) - 1.0)
    };
    let discs: Vec<_> = (0..9).map(disc).collect();
    // Neighbours in a row, neighbours in a column, and the lowest row with the floor.
    let beside = (0..9_usize).filter(|at| at % 3 < 2).map(|at| (discs[at].0, discs[at + 1].0));
    let above = (0..6).map(|at| (discs[at].0, discs[at + 3].0));
    let below = discs[..3].iter().map(|([x, y], ..)| ([*x, *y], [*x, 0.0]));
    let bars = (0_u32..).zip(beside.chain(above).chain(below));
    let bar = |(at, (from, to)): (u32, ([f64; 2], [f64; 2]))| ForceBar {
        from,
        to,
        force: f64::from(12 + 6 * at),
        slipping: at % 4 == 1,
    };
    let bars = bars.map(bar).collect();
    let walls = vec![([0.0, 0.0], [0.34, 0.0]), ([0.0, 0.0], [0.0, 0.31]), ([0.34, 0.0], [0.34, 0.31])];
    let mut absent = without_value(verdict(case, "lammps", "force on the floor", 1.0, 214.9, 0.01))
        .left(Outcome::NotAvailable, "the program `lmp` is not on the path");
    absent.unit = "N".into();
    absent.evidence = Evidence::OtherCode;
    absent.source = "the same scene in LAMMPS".into();
    let mut paper = verdict(case, "dem", "force on the floor", 215.02, 214.9, 0.01);
    paper.unit = "N".into();
    paper.variant = "kappa-1".into();
    paper.evidence = Evidence::Paper;
    paper.source = "Cundall and Strack (1979), table 2".into();
    paper.because = "the table prints three digits".into();
    let unsupported = Verdict { solver: "rigid".into(), ..absent.clone() }
        .left(Outcome::Unsupported, "rapier has no contact stiffness");
    Section {
        name: case.into(),
        title: "Nine discs in a box whose walls close".into(),
        physics: Physics::Contacts,
        claim: "Nine discs between four walls carry the load of the paper's first test, contact by contact.".into(),
        derivation: "The expected forces are those that the paper prints.".into(),
        weak: "Three digits were printed.".into(),
        omitted: None,
        figures: vec![Figure::forces(
            "forces",
            "Contact forces at the end",
            "Width is proportional to force; radii show rotation since the start.",
            ForcePlot { discs, walls, bars },
        )],
        verdicts: vec![paper, absent, unsupported],
        controls: vec![control(case, "force on the floor", "gravity turned off", true)],
        runs: vec![run("dem", "dt=.1", 2e-5, 40_000)],
    }
}

fn report_provenance() -> Provenance {
    Provenance {
        version: "0.1.0".into(),
        commit: "0123456789ab".into(),
        date: "2025-03-01 12:00 UTC".into(),
        machine: "x86_64, 2 cores, Linux".into(),
        rustc: "rustc 1.95.0".into(),
        options: vec!["--levels default".into()],
        wall_seconds: 12.3,
    }
}

/// Returns a report on two cases with every kind of result.
pub(crate) fn report() -> Report {
    let mut report = Report::new(report_provenance(), vec![backspin(), nine_discs()]);
    report.measured = Measurements {
        cost: Some(Costs::from_study(&costs(), &|_| None)),
        stability: Some(Stability::from_study(&stability(), &|_| None)),
        effects: Some(Effects::from_study(&effects(), &|_| None)),
    };
    let names = ["other", "other 1.0", "0123"].map(str::to_owned);
    report.judged = vec![ExternalResults::new(names, &report.provenance, &report.sections)];
    report
}

/// Returns the cost of two quantities with three solvers. `dem` takes 1 ms and 4 ms, and `mpm` takes 100 ms and 400 ms.
/// `rigid` reaches 1 % only for the first quantity.
pub(crate) fn costs() -> Study {
    let point = |solver: &str, quantity: &str, error: f64, wall: f64| Point {
        case: "backspin".into(),
        variant: "plain".into(),
        solver: solver.into(),
        resolution: "dt=.1".into(),
        quantity: quantity.into(),
        unit: "m".into(),
        standing: PointStatus::Measured,
        value: Some(1.0 + error),
        expected: Some(1.0),
        error: Some(error),
        wall_seconds: Some(wall),
        cpu_seconds: Some(wall),
        start_up_seconds: Some(0.0),
        ..Point::default()
    };
    let diagram = |quantity: &str, points: &[(&str, f64, f64)]| Diagram {
        case: "backspin".into(),
        variant: "plain".into(),
        quantity: quantity.into(),
        source: "rigid sphere under Coulomb friction".into(),
        points: points.iter().map(|(solver, error, wall)| point(solver, quantity, *error, *wall)).collect(),
    };
    let diagrams = vec![
        diagram("velocity", &[("dem", 5e-4, 1e-3), ("dem", 1e-5, 3e-3), ("mpm", 8e-3, 0.1), ("rigid", 5e-3, 2e-3)]),
        diagram("spin", &[("dem", 5e-4, 4e-3), ("mpm", 8e-3, 0.4), ("rigid", 0.05, 2e-3)]),
    ];
    let sources = ["dem", "mpm", "rigid"].map(|solver| (solver.to_owned(), "as then".to_owned())).into();
    Study { diagrams, sources, ..Study::new(report_provenance()) }
}

/// Returns the stability of two solvers: largest stable time steps with and without an exact limit, and two hard cases.
pub(crate) fn stability() -> Study {
    let limit = |solver: &str, unit: &str, at: f64, found: f64, exact: Option<f64>| Limit {
        scene: "disc on a wall".into(),
        knob: "k_s/k_n".into(),
        at: Some(at),
        solver: solver.into(),
        unit: unit.into(),
        found: Some(found),
        exact,
        default: Some(0.2),
        ..Limit::default()
    };
    let hard = |case: &str, solver: &str, standing: Hardness| HardCaseResult {
        case: case.into(),
        must: "velocities stay those of two points".into(),
        solver: solver.into(),
        standing,
        resolution: "dt=.1".into(),
        detail: String::new(),
    };
    let limits = vec![
        limit("dem", "√(m/k)", 0.0, 1.99, Some(2.0)),
        limit("lammps", "√(m/k)", 0.0, 1.99, Some(2.0)),
        limit("dem", "√(m/k)", 1.0, 1.15, Some(1.155)),
        limit("lammps", "√(m/k)", 1.0, 1.15, Some(1.155)),
        limit("mpm", "h/c", 25.0, 2.1, None),
    ];
    let hard = vec![
        hard("mass-ratio", "dem", Hardness::Holds),
        hard("mass-ratio", "lammps", Hardness::Holds),
        hard("fast-impact", "dem", Hardness::HoldsAtASmallerStep),
        hard("fast-impact", "lammps", Hardness::QuietlyWrong),
    ];
    Study { limits, hard, ..Study::new(report_provenance()) }
}

/// Returns effects of two scenes. Without friction, the results change by a tenth, a fifth and a half of their scale.
pub(crate) fn effects() -> Study {
    let shift = |without: f64| Shift {
        quantity: "velocity".into(),
        solver: "dem".into(),
        with: Some(0.0),
        without: Some(without),
        allowed: 1e-3,
        red: true,
    };
    let entry = |effect: &str, on: bool, worth: EffectResult, shifts: Vec<Shift>| Entry {
        case: "backspin".into(),
        variant: "plain".into(),
        effect: effect.into(),
        on,
        key: "contact.friction".into(),
        worth,
        shifts,
        counts: Some(1.1),
        time: None,
        tried: Vec::new(),
        detail: None,
    };
    let ledger = vec![
        entry("friction", true, EffectResult::Needed, vec![shift(0.5), shift(-0.1), shift(0.2)]),
        entry("gravity", true, EffectResult::NotWorthSimulating, vec![shift(1e-7)]),
        entry("cohesion", false, EffectResult::Inert, Vec::new()),
    ];
    Study { ledger, ..Study::new(report_provenance()) }
}

/// Returns a report in which every text would end its HTML element if it were not escaped.
pub(crate) fn hostile() -> Report {
    const TEXT: &str =
        "\"'></title></svg></style><script>alert(1)</script><img src=x onload=\"y\"> &amp; ![i](a) [l](javascript:z)";
    fn is<T: serde::de::DeserializeOwned>(text: &str) -> bool {
        serde_json::from_value::<T>(text.into()).is_ok()
    }
    fn poison(value: &mut serde_json::Value) {
        match value {
            serde_json::Value::String(text) => {
                // Texts that name variants of enumerations must stay valid.
                let fixed = ["Line", "Dashed", "Markers", "MarkedLine"];
                let readers = [is::<Outcome>, is::<Physics>, is::<Evidence>, is::<PointStatus>, is::<Hardness>];
                let others = [is::<EffectResult>, is::<ToleranceOrigin>, is::<FailureMode>];
                if !(fixed.contains(&text.as_str()) || readers.iter().chain(&others).any(|is| is(text))) {
                    *text = TEXT.to_owned();
                }
            }
            serde_json::Value::Array(items) => items.iter_mut().for_each(poison),
            serde_json::Value::Object(fields) => fields.values_mut().for_each(poison),
            _ => {}
        }
    }
    let mut value = serde_json::to_value(report()).unwrap();
    poison(&mut value);
    serde_json::from_value(value).unwrap()
}
