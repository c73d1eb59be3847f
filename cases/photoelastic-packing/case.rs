//! 197 discs between four walls (Cundall & Strack 1979, verification test).

#[path = "elastic.rs"]
mod elastic;
#[path = "figures.rs"]
mod figures;

use crate::case::{Case, PLAIN, Rung, cells, fraction};
use crate::chaos::{self, Parting};
use crate::effect::Effect;
use crate::gate::{Control, Done, Gate, Measured, Missing, Run};
use crate::program_rows::{PAIRS, layer_of_spheres};
use crate::stage::Stage;
use crate::verdict::Evidence;
use grainbench_reference::statistics::{next_value, spread};
use grainbench_scene::motion::Moment;
use grainbench_scene::solver::Resolution;
use nalgebra::Vector3;

const LADDER: &[Rung] = &[fraction("dt=.2", 0.2), fraction("dt=.1", 0.1), cells("R/2", 2.0, 3)];
/// The time step of the programs (s): the walls stop between no two steps.
const STEP: Resolution = Resolution::TimeStep(5e-3);

pub(crate) static CASE: Case = Case {
    name: "photoelastic-packing",
    title: "197 discs between four walls",
    claim: "Packings of the discs of the photoelastic test, led to the ratio of wall forces of its stage A, stand in equilibrium, \
            and sheared until the vertical force has grown by 4.348 % they carry a horizontal force within the range of the \
            paper's runs and of the experiment. LAMMPS and LIGGGHTS go the same way from the same start. Elastic discs, whose \
            contacts need no stiffness, do as discs on springs do.",
    scene: include_str!("scene.toml"),
    derivation: include_str!("derivation.md"),
    weakness: "The photographed packing is lost: packings from a seed have its sizes, not its places, and single forces cannot \
               be compared. The range of F_H/F_V is wide, and stage A fixes much of it.",
    ladder: LADDER,
    default_rung: LADDER[0],
    gates,
    figures: figures::figures,
};

/// Packings with the numbers of each table of the paper, of ten those that come down to the ratio of stage A (derivation).
const TABLES: [&[&str]; 3] = [
    &["table-1", "table-1-seed-2", "table-1-seed-3", "table-1-seed-4", "table-1-seed-5", "table-1-seed-6", "table-1-seed-7", "table-1-seed-8", "table-1-seed-9", "table-1-seed-11"],
    &[PLAIN, "seed-2", "seed-3", "seed-4", "seed-5", "seed-6", "seed-7", "seed-8", "seed-9", "seed-11"],
    &["table-3", "table-3-seed-2", "table-3-seed-3", "table-3-seed-4", "table-3-seed-8", "table-3-seed-9"],
];
/// F_H/F_V that the paper prints for stage B with the numbers of Tables 1 and 2. In its Table 3 stage A stands at .46 already.
const PRINTED: [f64; 2] = [0.40, 0.40];
/// F_H/F_V at stage A, from the experiment.
const RATIO: f64 = 0.39;
/// By how much F_V grows from stage A to stage B.
const GROWTH: f64 = 0.04348;
/// Where F_H/F_V at stage B has been seen: from the load-controlled experiment to the paper's runs, with room for a packing.
const RANGE: [f64; 2] = [0.30, 0.47];
const IMPOSED: &str = "imposed by the motion of the walls (derivation)";
const FOUND: &str = "how near the search for the motion of the walls ends";
const PAPER: &str = "Cundall & Strack 1979, Tables 1-3";

fn run(variant: &'static str) -> Run {
    Run::new(variant, "dem", LADDER[0].resolution)
}

/// Stages A and B.
fn stages(done: &Done) -> Result<[Stage; 2], Missing> {
    match &done.record.snapshots[..] {
        [_, a, b] => Ok([Stage::of(a), Stage::of(b)]),
        _ => Err(Missing("snapshots of stages A and B".to_owned())),
    }
}

/// What is read from the stages of a packing.
type Read = fn(&[Stage; 2]) -> f64;

/// The packing that is farthest from what is expected.
fn farthest(done: &[Done], expected: f64, scale: f64, read: Read) -> Result<Measured, Missing> {
    let mut worst: Option<Measured> = None;
    for done in done {
        let found = Measured::new(read(&stages(done)?), expected, scale);
        if found.error().is_nan() || worst.as_ref().is_none_or(|worst| found.error().abs() > worst.error().abs()) {
            worst = Some(found);
        }
    }
    worst.ok_or_else(|| Missing("packings".to_owned()))
}

fn ratio_at_b([_, b]: &[Stage; 2]) -> f64 {
    b.ratio()
}

fn gates() -> Vec<Gate> {
    let mut gates = of_packings(&[run("fifty")], "50 discs");
    gates.extend(of_packings(&[run(PLAIN).slow()], "197 discs"));
    for (table, number) in TABLES.iter().zip(1..) {
        let packings: Vec<Run> = table.iter().map(|variant| run(variant).long()).collect();
        let words = format!("{} packings, Table {number}", table.len());
        gates.extend(of_packings(&packings, &words));
        if let Some(&printed) = PRINTED.get(number - 1) {
            gates.push(as_printed(packings, &words, printed));
        }
    }
    gates.push(step());
    gates.extend(programs());
    gates.extend(elastic::gates());
    gates
}

/// Walls that go a tenth too far after stage A.
fn further_to_b() -> Control {
    Control::scene("walls that go a tenth further from stage A to stage B", |scene| {
        scene.walls.iter_mut().for_each(|wall| wall.motion.phases[1].velocity *= 1.1);
    })
}

/// What any packing on springs must do; of several the worst counts.
fn of_packings(packings: &[Run], words: &str) -> Vec<Gate> {
    let mut gates = equilibrium(packings, words);
    gates.push(Gate::new(
        (format!("growth of F_V from stage A to stage B, {words}"), "1"),
        packings.to_vec(),
        (Evidence::Invariant, IMPOSED),
        (2e-4, FOUND),
        further_to_b(),
        |done| farthest(done, GROWTH, 1.0, |[a, b]| b.vertical / a.vertical - 1.0),
    ));
    gates
}

/// What any packing must be like at its stages; of several the worst counts.
fn equilibrium(packings: &[Run], words: &str) -> Vec<Gate> {
    let gate = |quantity: &str, evidence, allowed, control, expected: f64, scale, read: Read| {
        let of = move |done: &[Done]| farthest(done, expected, scale, read);
        Gate::new((format!("{quantity}, {words}"), "1"), packings.to_vec(), evidence, allowed, control, of)
    };
    let imposed = (Evidence::Invariant, IMPOSED);
    let balance = (Evidence::Invariant, "equilibrium: what goes into the discs at one wall comes out at the others");
    let paper = (Evidence::Paper, PAPER);
    let smooth = || Control::without(Effect::Friction);
    let weight = || Control::scene("discs that have weight", |scene| scene.gravity = Vector3::new(0.0, -1.0, 0.0));
    let further = || {
        Control::scene("walls that go a tenth further", |scene| {
            scene.walls.iter_mut().for_each(|wall| wall.motion.phases[0].velocity *= 1.1);
        })
    };
    let none = 0.0;
    vec![
        gate(
            "F_H/F_V at stage A",
            (Evidence::Experiment, "De Josselin de Jong & Verruijt 1969, stage A; imposed (derivation)"),
            (0.01, "as the experiment is imposed"),
            smooth(),
            RATIO,
            1.0,
            |[a, _]| a.ratio(),
        ),
        gate("mean overlap / mean radius at stage A", imposed, (0.01, FOUND), further(), 1e-3, 1e-3, |[a, _]| a.overlap),
        gate(
            "forces added up over the four walls / largest, stages A and B",
            balance,
            (1e-3, "what still moves"),
            weight(),
            none,
            1.0,
            |[a, b]| a.residual.max(b.residual),
        ),
        gate(
            "largest unbalanced / largest contact force, stage A",
            paper,
            (0.026, "the largest of the paper's three"),
            weight(),
            none,
            1.0,
            |[a, _]| a.unbalanced,
        ),
        gate(
            "largest unbalanced / largest contact force, stage B",
            paper,
            (1e-3, "the paper's, Tables 1 and 2"),
            weight(),
            none,
            1.0,
            |[_, b]| b.unbalanced,
        ),
        gate(
            "F_H/F_V at stage B",
            (Evidence::Paper, "Cundall & Strack 1979, Tables 1-3, and the experiment"),
            (0.5 * (RANGE[1] - RANGE[0]), "from .30 to .47: the paper's .40 to .47, the experiment's .33, and a packing's own"),
            smooth(),
            0.5 * (RANGE[0] + RANGE[1]),
            1.0,
            ratio_at_b,
        ),
    ]
}

/// What the paper prints for its one packing, as one more of them.
fn as_printed(packings: Vec<Run>, words: &str, printed: f64) -> Gate {
    Gate::new(
        (format!("F_H/F_V at stage B, mean of {words}"), "1"),
        packings,
        (Evidence::Paper, PAPER),
        (1.0, "in units of the half-width of the 99 % interval in which one more packing lies"),
        Control::without(Effect::Friction),
        move |done| {
            let values = done.iter().map(|done| Ok(ratio_at_b(&stages(done)?))).collect::<Result<Vec<f64>, Missing>>()?;
            let (mean, half_width) = next_value(&values).ok_or_else(|| Missing("packings that differ".to_owned()))?;
            Ok(Measured::new(mean, printed, half_width))
        },
    )
}

/// Half the time step leads to the same stage B.
fn step() -> Gate {
    Gate::new(
        ("F_H/F_V at stage B, against half the step", "1"),
        vec![run(PLAIN).slow(), run(PLAIN).at(LADDER[1].resolution).aside()],
        (Evidence::Convergence, "the same at half the time step"),
        (0.01, "slip comes in jumps, and the step decides which comes first: by up to .005"),
        Control::without(Effect::Friction),
        |done| Ok(Measured::new(ratio_at_b(&stages(&done[0])?), ratio_at_b(&stages(&done[1])?), 1.0)),
    )
}

/// What twins are watched by, and programs.
const PARTING: Parting = Parting { columns: &["all.kinetic_energy", "left.force_x", "right.force_x", "bottom.force_y", "top.force_y"] };

/// The predictability horizon (steps): discs that only touch meet and part many times before they bear.
const HORIZON: u64 = 620;

/// What keeps LIGGGHTS' own arithmetic from being followed in every digit.
const STALE_STRETCH: &str = "LIGGGHTS 3.8.0 tells no force of a mesh at step 0; and it keeps the stretch of a contact that opens while the pair \
                             is on its neighbour list (plane-shear), where discs that only touch part and meet again";

/// A run that both programs can do. LIGGGHTS moves walls in three dimensions only.
fn common(variant: &'static str, solver: &'static str, program: &str) -> Run {
    let run = Run::new(variant, solver, STEP).slow();
    if program == "liggghts" { run.adjusted("one layer of spheres", layer_of_spheres) } else { run }
}

/// Ours, a disc moved by one unit in the last place.
fn twin(variant: &'static str, disc: usize) -> Run {
    Run::new(variant, PAIRS[0][1], STEP).slow().adjusted(&format!("disc {} moved by 1 ulp", disc + 1), move |scene| {
        let place = &mut scene.grains[disc].position.x;
        *place = place.next_up();
    })
}

/// Both programs from the same start, with dashpots that both have: sample by sample for as long as twins are together, stage by
/// stage after it.
fn programs() -> Vec<Gate> {
    let softer = || Control::ours("stiffness off by 1e-6 in ours", |scene| {
        scene.change_laws(|law| law.normal_stiffness *= 1.0 + 1e-6);
    });
    let smooth = || Control::ours("friction .1 in ours", |scene| scene.change_laws(|law| law.friction = 0.1));
    let [lammps, liggghts] = PAIRS;
    let of = |variant, pair: [&'static str; 2]| {
        let twins = [Run::new(variant, lammps[1], STEP).slow().aside(), twin(variant, 0).aside()];
        pair.map(|solver| common(variant, solver, pair[0])).into_iter().chain(twins).collect::<Vec<Run>>()
    };
    let mut known = of("first", liggghts);
    known[0] = known[0].clone().known(STALE_STRETCH);
    let without = Control::without_the_error("our solver, which forgets", liggghts[1], STEP);
    let mut gates = vec![
        chaos::pointwise(PARTING, of("first", lammps), softer()),
        chaos::pointwise(PARTING, known, without),
        chaos::horizon(PARTING, HORIZON, [Run::new("first", lammps[1], STEP).slow(), twin("first", 0)]),
    ];
    for pair in PAIRS {
        for (stage, part) in [("A", 2), ("B", 1)] {
            let twins = (0..4).map(|disc| twin("programs", disc).aside());
            gates.push(Gate::new(
                (format!("F_H/F_V at stage {stage}, against {}", pair[1]), "1"),
                pair.map(|solver| common("programs", solver, pair[0])).into_iter().chain(twins).collect(),
                (Evidence::OtherCode, "the program, run on the deck of the same scene"),
                (1.0, "in units of the 99 % interval of the difference of two twins, from the spread of four"),
                smooth(),
                move |done| {
                    let twins = done[2..].iter().map(|twin| ratio_in(twin, part)).collect::<Result<Vec<f64>, _>>()?;
                    let interval = spread(&twins).ok_or_else(|| Missing("twins that differ".to_owned()))?;
                    Ok(Measured::new(ratio_in(&done[0], part)?, ratio_in(&done[1], part)?, interval))
                },
            ));
        }
    }
    gates
}

/// F_H/F_V from the series, in the last sample before the end of one of so many equal parts of the run, where all rests: of a stored
/// run not every sample is kept.
fn ratio_in(done: &Done, parts: u64) -> Result<f64, Missing> {
    let steps = &done.series().step;
    let end = steps.last().map_or(0, |last| last / parts);
    let step = steps.iter().copied().take_while(|&step| step <= end).last().unwrap_or_default();
    let [left, right, bottom, top] =
        ["left.force_x", "right.force_x", "bottom.force_y", "top.force_y"].map(|column| done.at_step(column, step));
    Ok((right? - left?) / (top? - bottom?))
}

/// Vertical strain of the box at a time (s): how far top and bottom have come in over the height at the start.
fn vertical_strain(done: &Done, time: f64) -> f64 {
    let [_, _, bottom, top] = &done.scene.walls[..] else { return f64::NAN };
    let moved = |wall: &grainbench_scene::scene::Wall| wall.motion.displacement(time, 0.0).translation.y;
    let at = |wall: &grainbench_scene::scene::Wall| wall.shape.corners().0[0].y;
    (moved(bottom) - moved(top)) / (at(top) - at(bottom))
}

/// The time of stage A (s): when the walls start again.
fn time_of_a(done: &Done) -> f64 {
    match done.scene.walls.first().and_then(|wall| wall.motion.phases.get(1)).map(|phase| phase.start) {
        Some(Moment::Seconds(time)) => time,
        _ => f64::NAN,
    }
}
