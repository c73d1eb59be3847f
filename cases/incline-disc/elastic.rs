//! The disc as an elastic body, set down on the plane and let go: what the material point method gives.
//!
//! The disc rests on the plane under g cos θ, damped, and is released at t = 0. An elastic disc is no rigid one: it sticks, and
//! stretches, before it slips, and rolls on a flattened side; its displacement differs from the rigid one by a few per cent that
//! no resolution takes away. The expected values are an independent prototype's, extrapolated from four resolutions
//! (quadratic B-splines, APIC, springs at the surface). Larger moduli need no reference: they lead to the rigid answer.

use crate::bench::Bench;
use crate::elastic::{Rest, settle, stiffen};
use crate::figure::{Axis, Curve, Figure, Stroke};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run};
use crate::one_grain::{OneGrain, State, course, last};
use crate::verdict::Evidence;
use grainbench_scene::solver::{Resolution, RunError};

/// One slope with what is known of the elastic disc on it.
#[derive(Clone, Copy)]
struct Elastic {
    variant: &'static str,
    /// When it is measured (s).
    time: f64,
    /// Displacement over the rigid one, less one, of the converged elastic disc, and its uncertainty.
    excess: f64,
    uncertainty: f64,
    /// Allowed deviation from it, in fractions of the rigid displacement, by cells per radius.
    allowed: &'static [(f64, f64)],
    /// What the kinematic nodal contact of the 2000 paper gives, touching at the start, by cells per radius.
    kinematic: [(f64, f64); 3],
    sticks: bool,
}

const SLOPES: [Elastic; 4] = [
    Elastic {
        variant: "60deg-mu.3",
        time: 0.3,
        excess: 0.0147,
        uncertainty: 0.0005,
        allowed: &[(4.0, 0.003), (8.0, 0.003)],
        kinematic: [(2.0, 0.013), (4.0, 0.008), (8.0, 0.0)],
        sticks: false,
    },
    Elastic {
        variant: "60deg-mu.9",
        time: 0.3,
        excess: 0.0065,
        uncertainty: 0.001,
        allowed: &[(2.0, 0.07), (4.0, 0.02), (8.0, 0.006)],
        kinematic: [(2.0, -0.37), (4.0, -0.21), (8.0, -0.11)],
        sticks: true,
    },
    Elastic {
        variant: "60deg-mu.5",
        time: 0.3,
        excess: 0.0375,
        uncertainty: 0.0005,
        allowed: &[(4.0, 0.004), (8.0, 0.003)],
        kinematic: [(2.0, 0.013), (4.0, -0.016), (8.0, -0.033)],
        sticks: false,
    },
    Elastic {
        variant: "30deg-mu.5",
        time: 0.4,
        excess: -0.003,
        uncertainty: 0.001,
        allowed: &[(2.0, 0.08), (4.0, 0.035), (8.0, 0.01)],
        kinematic: [(2.0, -0.66), (4.0, -0.58), (8.0, -0.40)],
        sticks: true,
    },
];

const REFERENCE: &str = "independent prototype of the elastic disc, Richardson over 2 to 16 cells a radius";
const REST: Rest = Rest { duration: 0.3, damping: 100.0 };
/// Points per cell and axis, as in the paper.
const POINTS: u32 = 3;
const LADDER: [f64; 3] = [2.0, 4.0, 8.0];
const FINEST: f64 = 16.0;

fn run(slope: Elastic, solver: &'static str, cells: f64) -> Run {
    stiffened(slope, solver, cells, 1.0)
}

/// The moduli times a factor.
fn stiffened(slope: Elastic, solver: &'static str, cells: f64, factor: f64) -> Run {
    let name = format!("elastic and settled, moduli × {factor}");
    Run::new(slope.variant, solver, Resolution::grid(cells, POINTS)).adjusted(&name, move |scene| {
        settle(scene, REST, slope.time);
        stiffen(scene, factor);
    })
}

/// Displacement over that of a rigid disc, less one.
fn excess(done: &Done) -> Result<f64, Missing> {
    let (t, state) = last(done)?;
    Ok(state.x / OneGrain::of(&done.scene).rigid_incline(t).x - 1.0)
}

/// Time at the end over which rolling is averaged (s): about one period of the disc rocking on its contact, which nothing damps and
/// which swings ΩR/v by four hundredths.
const ROCKS: f64 = 0.1;

/// Mean ΩR over mean v at the end.
fn rolling(done: &Done) -> Result<f64, Missing> {
    let (end, _) = last(done)?;
    let states: Vec<State> = course(done)?.into_iter().filter(|(t, _)| *t > end - ROCKS).map(|(_, state)| state).collect();
    let sum = |of: fn(&State) -> f64| states.iter().map(of).sum::<f64>();
    Ok(sum(|state| state.omega) * done.scene.grains[0].radius / sum(|state| state.v))
}

pub(super) fn gates() -> Vec<Gate> {
    let mut gates = Vec::new();
    for slope in SLOPES {
        gates.extend(slope.allowed.iter().map(|&(cells, allowed)| against_reference(slope, cells, allowed)));
        gates.extend(slope.kinematic.map(|(cells, expected)| reproduced(slope, cells, expected)));
        gates.push(stiff(slope, 10.0));
        gates.push(stiff(slope, 100.0));
        if slope.sticks {
            gates.push(order(slope));
            gates.push(known(slope));
            gates.push(turns_as_it_goes(slope));
            gates.push(extrapolated(slope));
        }
    }
    gates.push(does_not_roll());
    gates
}

fn telling(slope: Elastic) -> Control {
    if slope.sticks {
        Control::solver("nodal contact that acts at a distance (2000)", "mpm:2000")
    } else {
        Control::scene("half the friction", |scene| scene.change_laws(|law| law.friction *= 0.5))
    }
}

fn against_reference(slope: Elastic, cells: f64, allowed: f64) -> Gate {
    Gate::new(
        (excess_words(slope, cells), "1"),
        vec![run(slope, "mpm", cells)],
        (Evidence::OtherCode, REFERENCE),
        (allowed + slope.uncertainty, "discretisation at this resolution, and the reference's own uncertainty"),
        telling(slope),
        move |done| Ok(Measured::new(excess(&done[0])?, slope.excess, 1.0)),
    )
}

fn excess_words(slope: Elastic, cells: f64) -> String {
    format!("displacement at {} s over the rigid one, less 1, {cells} cells a radius", slope.time)
}

/// How fast the deviation from the elastic disc falls with the cell.
fn order(slope: Elastic) -> Gate {
    Gate::new(
        ("order in the cell of the deviation from the elastic disc, 2 to 8 cells a radius", "1"),
        LADDER.into_iter().map(|cells| run(slope, "mpm", cells)).collect(),
        (Evidence::Convergence, REFERENCE),
        (1.0, "at least 1.5, at most 3.5: a contact that gains one tracer after another has no exact order"),
        telling(slope),
        move |done| {
            let points: Result<Vec<(f64, f64)>, Missing> = done
                .iter()
                .zip(LADDER)
                .map(|(done, cells)| Ok((1.0 / cells, (excess(done)? - slope.excess).abs())))
                .collect();
            Ok(Measured::new(crate::measure::slope(&points?), 2.5, 1.0))
        },
    )
}

/// Moduli ten and a hundred times larger: nearer to the rigid answer, which needs no reference.
fn stiff(slope: Elastic, factor: f64) -> Gate {
    let run = stiffened(slope, "mpm", 8.0, factor);
    // Where it hardly slips (tan 60° against 3μ = 1.5) it sticks for long first, and 3.75 % fall by √10 to 1.2 %.
    let (run, allowed) = match factor > 10.0 {
        true => (run.long(), 8e-3),
        false if slope.variant == "60deg-mu.5" => (run.slow(), 0.016),
        false => (run.slow(), 0.01),
    };
    Gate::new(
        (
            format!("displacement at {} s over the rigid one, less 1, moduli × {factor}, 8 cells a radius", slope.time),
            "1",
        ),
        vec![run],
        (Evidence::Analytic, "MPM 2000 eq. 25"),
        (
            allowed,
            "where it rolls, flattening falls with the modulus; where it slips, the time it sticks first, with its square root; \
             what is left is the discretisation of the contact at this resolution",
        ),
        telling(slope),
        move |done| Ok(Measured::new(excess(&done[0])?, 0.0, 1.0)),
    )
}

/// The 2000 paper's contact gives what it is known to give.
fn reproduced(slope: Elastic, cells: f64, expected: f64) -> Gate {
    let control = if slope.sticks { Control::solver("springs at the surface", "mpm") } else { telling(slope) };
    Gate::new(
        (excess_words(slope, cells), "1"),
        vec![run(slope, "mpm:2000", cells)],
        (Evidence::OtherCode, "independent prototype of the 2000 criterion, touching and settled"),
        (
            0.022,
            "two implementations of one method at the same resolution, with other material points; while discs settle ours damps points, \
             not nodes, which is worth up to .004",
        ),
        control,
        move |done| Ok(Measured::new(excess(&done[0])?, expected, 1.0)),
    )
}

/// Its error against the elastic disc, shown for what it is.
fn known(slope: Elastic) -> Gate {
    let run = run(slope, "mpm:2000", 4.0).known(
        "nodal contact holds the disc up over a patch of about √(2Rh), as if it had a flat side: at these resolutions it rolls \
         too little or not at all",
    );
    Gate::new(
        (format!("displacement at {} s over the rigid one, less 1, against the elastic disc", slope.time), "1"),
        vec![run],
        (Evidence::OtherCode, REFERENCE),
        (0.035 + slope.uncertainty, "what a contact that acts at the surface reaches at this resolution"),
        Control::without_the_error("springs at the surface", "mpm", Resolution::grid(4.0, POINTS)),
        move |done| Ok(Measured::new(excess(&done[0])?, slope.excess, 1.0)),
    )
}

/// At two cells a radius a disc in nodal contact does not roll (2001 paper, of the sphere at R/2).
fn does_not_roll() -> Gate {
    Gate::new(
        ("mean ΩR over mean v at the end, where a rigid disc has 1, 2 cells a radius", "1"),
        vec![run(SLOPES[3], "mpm:2000", 2.0)],
        (Evidence::Paper, "Bardenhagen et al. 2001, text to Fig. 3: at the coarsest resolution it does not roll"),
        (0.05, "it turns by no more than its flat side rocks"),
        Control::solver("springs at the surface", "mpm"),
        |done| Ok(Measured::new(rolling(&done[0])?, 0.0, 1.0)),
    )
}

/// Our own extrapolation, by the order seen over 4, 8 and 16 cells a radius, beside the reference.
fn extrapolated(slope: Elastic) -> Gate {
    Gate::new(
        (format!("displacement at {} s over the rigid one, less 1, extrapolated from 4, 8 and 16 cells a radius", slope.time), "1"),
        [4.0, 8.0, FINEST].map(|cells| run(slope, "mpm", cells).long()).to_vec(),
        (Evidence::OtherCode, REFERENCE),
        (0.004 + slope.uncertainty, "three rungs fix the order only roughly, and the last step is multiplied by it"),
        telling(slope),
        move |done| {
            let [coarse, middle, fine] = [excess(&done[0])?, excess(&done[1])?, excess(&done[2])?];
            let ratio = (middle - coarse) / (fine - middle);
            Ok(Measured::new(fine + (fine - middle) / (ratio - 1.0), slope.excess, 1.0))
        },
    )
}

/// ΩR/v at 8 cells a radius against the finest rung.
fn turns_as_it_goes(slope: Elastic) -> Gate {
    Gate::new(
        ("mean ΩR over mean v at the end, 8 cells a radius against 16", "1"),
        vec![run(slope, "mpm", 8.0).long(), run(slope, "mpm", FINEST).long()],
        (Evidence::Convergence, "the finest rung"),
        (0.02, "discretisation"),
        Control::solver("nodal contact that acts at a distance (2000)", "mpm:2000"),
        |done| Ok(Measured::new(rolling(&done[0])?, rolling(&done[1])?, 1.0)),
    )
}

pub(super) fn figures(bench: &Bench) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for slope in SLOPES {
        for (solver, stroke) in [("mpm", Stroke::MarkedLine), ("mpm:2000", Stroke::Dashed)] {
            let mut points = Vec::new();
            for cells in LADDER {
                if let Ok(excess) = excess(&bench.run(&run(slope, solver, cells))?) {
                    points.push((cells, (excess - slope.excess).abs()));
                }
            }
            curves.push(Curve::new(format!("{} {solver}", slope.variant), stroke, points));
        }
    }
    Ok(vec![Figure::graph(
        "elastic",
        "An elastic disc: deviation from its converged displacement",
        "Settled start. `mpm` has springs where surfaces meet; the 2000 paper's criterion acts at nodes, .6 to .9 of a cell before \
         they do, and the disc does not roll until the cell is small.",
        [Axis::log("cells a radius"), Axis::log("|x − x_elastic| / x_rigid")],
        curves,
    )])
}
