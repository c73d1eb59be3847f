//! Ten thousand discs in plane shear, compared with LAMMPS and LIGGGHTS. Samples are compared up to the predictability
//! horizon, and time averages afterwards.

use crate::rows::programs::{ENERGY, PAIRS, kinetic_energy};
use crate::rows::rigid;
use grainbench_harness::compare::perturbed::{self, DivergenceColumns, PERTURBED, Sum};
use grainbench_harness::compare::pointwise::difference;
use grainbench_harness::prelude::*;
use grainbench_solver::perturbed::move_one;

const LEVELS: &[Level] = &[time_step("dt=1e-3 s", 1e-3), time_step("dt=1e-4 s", 1e-4)];

pub(crate) static CASE: Case = crate::heads::PLANE_SHEAR.with(LEVELS, 1, &claims).drawn_by(figures);

const fn sum(column: &'static str, words: &'static str, unit: &'static str) -> Sum {
    Sum { column, words, unit, logarithm: false }
}

/// Quantities whose time averages are compared after the horizon. For the energy, the logarithm is averaged, because
/// the energy varies by factors when shear waves pass.
const SUMS: [Sum; 5] = [
    Sum { logarithm: true, ..sum(ENERGY, "logarithm of the kinetic energy", "1") },
    sum("packing.sigma_xx", "stress σ_xx", "Pa"),
    sum("packing.sigma_yy", "stress σ_yy", "Pa"),
    sum("packing.sigma_xy", "stress σ_xy", "Pa"),
    sum("packing.coordination", "coordination number", "1"),
];

/// Reason why our solver cannot follow LIGGGHTS in each digit.
const STALE_STRETCH: &str = "LIGGGHTS 3.8.0 keeps the tangential spring displacement of an opened contact while the pair is on \
                             its neighbour list, and continues with it when the contact closes again (derivation)";

/// Returns a short run with a fine time step.
fn short(solver: &'static str) -> Run {
    Run::new(PLAIN, solver, LEVELS[1].resolution)
}

/// Returns the run that ends before a contact closes again, with frequent samples.
fn first(solver: &'static str) -> Run {
    Run::new("first", solver, LEVELS[1].resolution)
}

/// Returns the run beyond the predictability horizon.
fn long(solver: &'static str) -> Run {
    Run::new("long", solver, LEVELS[0].resolution)
}

/// Columns for the comparison of perturbed runs of our solver in the convention of LAMMPS.
const PARTING: DivergenceColumns = &[ENERGY, "packing.sigma_xx", "packing.sigma_xy"];

fn claims() -> Vec<Claim> {
    let friction = Control::our_contact_law("friction .1 for .5 in ours", |law| law.friction = 0.1);
    let [lammps, liggghts] = PAIRS;
    let other = |solver| Control::solver("ours in the convention of the other program", solver);
    let without = Control::without_the_error("our solver, which forgets", liggghts[0], LEVELS[0].resolution);
    let with_perturbed = |runs: [Run; 2]| {
        let perturbed = [long(lammps[0]).aside(), long(lammps[0]).adjusted(PERTURBED, move_one).aside()];
        [runs, perturbed].concat()
    };
    let known = [long(liggghts[0]).known(STALE_STRETCH).up_to(1e-4).slow(), long(liggghts[1])];
    let mut claims = vec![
        kinetic_energy("over 2000 steps", lammps.map(short), other(liggghts[0])),
        kinetic_energy("over 85 steps", liggghts.map(first), other(lammps[0])),
        perturbed::pointwise(PARTING, with_perturbed(lammps.map(long)), other(liggghts[0])),
        perturbed::pointwise(PARTING, with_perturbed(known), without),
    ];
    for pair in PAIRS {
        for sum in SUMS {
            let runs = pair.map(long).map(Run::slow);
            claims.push(perturbed::statistics(PARTING, sum, with_perturbed(runs), friction.clone()));
        }
    }
    claims.push(perturbed::horizon(PARTING, HORIZON, [long(lammps[0]), long(lammps[0]).adjusted(PERTURBED, move_one)]));
    claims.push(claim("refusal of periodic axes", "1").run(Run::new(PLAIN, "rigid", rigid::DEFAULT)).refused(
        "rapier has no periodic axes",
        Control::scene("no box, one grain, ten microseconds", |scene| {
            scene.domain = None;
            scene.grains.truncate(1);
            scene.duration = Duration::Seconds(1e-5);
        }),
    ));
    claims
}

/// Predictability horizon (number of steps of 1e-3 s).
const HORIZON: u64 = 800;

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let right = runner.run(&long(PAIRS[0][0]))?;
    let perturbed = runner.run(&long(PAIRS[0][0]).adjusted(PERTURBED, move_one))?;
    let horizon = perturbed::time_of_horizon(PARTING, &right, &perturbed).unwrap_or(f64::NAN);
    let mut partings = vec![("ours, one position moved by a rounding error".to_owned(), right, perturbed)];
    let mut courses = Vec::new();
    for [ours, program] in PAIRS {
        let ours = runner.run(&long(ours))?;
        // LAMMPS or LIGGGHTS has no curve if it is not installed and no run of it is stored.
        if let Ok(theirs) = runner.run(&long(program)) {
            courses.push((program.to_owned(), Stroke::Markers, theirs.clone()));
            partings.push((format!("{program} and ours"), ours.clone(), theirs));
        }
        courses.push((ours.record.provenance.solver.clone(), Stroke::Line, ours));
    }
    let graph = |name: &str, title: &str, caption: &str, y: Axis, curves| {
        Figure::graph(name, title, caption, [Axis::linear("time t (mean diameter / wall speed)"), y], curves)
    };
    let line = Curve::new("predictability horizon", Stroke::Dashed, vec![(horizon, 1e-16), (horizon, 1.0)]);
    let parted = partings.iter().map(|(label, a, b)| Curve::new(label, Stroke::Line, difference(a, b, ENERGY)));
    let course = |column: &str| -> Vec<Curve> {
        let curve = |(label, stroke, done): &(String, Stroke, FinishedRun)| {
            let values = done.series().column(column).unwrap_or_default();
            Curve::new(label, *stroke, done.series().time.iter().copied().zip(values.iter().copied()).collect())
        };
        courses.iter().map(curve).collect()
    };
    Ok(vec![
        graph(
            "parting",
            "Divergence of pairs of runs",
            "Difference of the kinetic energies of two runs, over their largest value. Before the predictability \
             horizon, runs are compared at each time. After it, they are compared by averages over blocks of time.",
            Axis::log("difference / largest value (1)"),
            parted.chain([line]).collect(),
        ),
        graph(
            "kinetic-energy",
            "Kinetic energy in plane shear",
            "The walls move at −1 and +1 from t = 0 on. LAMMPS and LIGGGHTS (markers) are compared with our solver \
             with the contact convention of each (lines).",
            Axis::linear("kinetic energy (LJ units)"),
            course(ENERGY),
        ),
        graph(
            "coordination",
            "Coordination number in plane shear",
            "Mean number of contacts of a grain. LAMMPS and LIGGGHTS (markers) are compared with our solver with the \
             contact convention of each (lines).",
            Axis::linear("coordination number (1)"),
            course("packing.coordination"),
        ),
    ])
}
