//! Grains that yield, one packing sheared as far as in the paper: energy, what other contacts make of it, and what a finer grid changes.

use super::coarse::{kept, unaccounted};
use super::measures::{at, band, end, large_voids, plastic_strain, rotation_deg};
use super::paper::FIGURE_6;
use super::{FRAMES, at_least, at_most, chains, grid, to_shear};
use crate::gate::{Control, Done, Gate, Measured, Missing, Run, Wrong};
use crate::verdict::Evidence;
use grainbench_scene::record::Snapshot;
use grainbench_scene::scene::{Duration, Scene};

const REACHES: &str = "contact under traction acts from more than half a cell away, and grains of a few cells across that are held apart \
                       so push through each other instead of sliding";

const NO_VOIDS: &str = "in one velocity field grains are joined as soon as a cell lies between them: the slab flows as one body and its \
                        pores stay small, while with friction it dilates";
const OWN_NORMALS: &str = "each body meets the others along a normal of its own (2001): what one gains the other does not lose, which \
                           makes energy, the more the coarser the grid";
const PATCHES: &str = "grains flow where they touch, in patches of a cell or two: a finer grid shows more of it, by 24 % from 75² to 150² \
                       and 16 % from there to 300², and the motion is chaotic";

/// A packing to the end on half of the paper's grid.
pub(super) fn whole(packing: &'static str, solver: &'static str) -> Run {
    to_shear(Run::new(packing, solver, grid(75.0)), 0.8, FRAMES).long()
}

/// To the end on the paper's own grid, with a snapshot every 5 %.
fn on_the_papers_grid() -> Run {
    to_shear(Run::new("seed-1", "mpm", grid(150.0)), 0.8, 15).long()
}

type Of = fn(&Done, &Snapshot) -> f64;

/// A quantity of one run at a mean shear, over that of another.
pub(super) fn over(done: &[Done], shear: f64, of: Of) -> Result<f64, Missing> {
    let of = |done: &Done| Ok(of(done, at(done, shear)?));
    Ok(of(&done[0])? / of(&done[1])?)
}

fn voids(done: &Done, snapshot: &Snapshot) -> f64 {
    large_voids(done, snapshot) as f64
}

/// Every second of the larger grains that move freely has a tenth of its area; smaller ones would be lost in a cell.
fn shrunk(scene: &mut Scene) {
    const LARGER: f64 = 2.6e-5;
    let groups = scene.driven_group_of_grains();
    let free = scene.grains.iter_mut().zip(groups).filter(|(grain, group)| group.is_none() && grain.radius > LARGER);
    for (grain, _) in free.step_by(2) {
        grain.radius *= 0.1_f64.sqrt();
        (grain.mass, grain.inertia) = (0.1 * grain.mass, 0.01 * grain.inertia);
    }
}

/// Pores without slip.
fn pores() -> Gate {
    Gate::new(
        ("large voids without slip over those with friction, or one, 80 % shear, 5 or more", "1"),
        vec![whole("seed-1", "mpm:no-slip").known(NO_VOIDS), whole("seed-1", "mpm").aside()],
        FIGURE_6,
        (0.0, "several times"),
        Control::scene("every second of the larger grains a tenth as large, so that there are voids", shrunk),
        |done| Ok(at_least(voids(&done[0], end(&done[0])?) / voids(&done[1], end(&done[1])?).max(1.0), 5.0)),
    )
}

/// Other contacts in place of springs between surfaces.
fn other_contacts() -> Vec<Gate> {
    let springs = || Control::without_the_error("springs between surfaces", "mpm", grid(75.0));
    vec![
        Gate::new(
            ("plastic strain without slip over that with friction, 80 % shear, 5 or more", "1"),
            vec![whole("seed-1", "mpm:2001").known(REACHES), whole("seed-1", "mpm:no-slip").aside()],
            FIGURE_6,
            (0.0, "several times"),
            springs(),
            |done| Ok(at_least(1.0 / over(done, 0.8, plastic_strain)?, 5.0)),
        ),
        Gate::new(
            ("plastic strain over that with springs between surfaces, 80 % shear, 2 or more", "1"),
            vec![whole("seed-1", "mpm:2001"), whole("seed-1", "mpm").aside()],
            (Evidence::OtherCode, "independent prototype on a grid of 150²: 3.0; it grows with the reach of contact, which is that of a cell"),
            (0.0, "half of what that is above one"),
            Control::solver("springs between surfaces", "mpm"),
            |done| Ok(at_least(over(done, 0.8, plastic_strain)?, 2.0)),
        ),
    ]
}

/// Energy to the end.
fn energy() -> Vec<Gate> {
    let invariant = (Evidence::Invariant, "conservation of energy");
    let makes_energy = || Control::solver("contact on approach (2000), which makes energy", "mpm:2000");
    let mut gates = vec![Gate::new(
        ("where the work of the walls went, 80 % shear", "J"),
        vec![whole("seed-1", "mpm")],
        invariant,
        (0.02, "stress and elastic energy go together to second order in the step; of the work of the walls"),
        makes_energy(),
        |done| unaccounted(&done[0]),
    )];
    gates.push(Gate::new(
        ("where the work of the walls went on the paper's grid, 80 % shear", "J"),
        vec![on_the_papers_grid()],
        invariant,
        (0.01, "stress and elastic energy go together to second order in the step; of the work of the walls"),
        Control { name: "contact on approach (2000), which makes energy", wrong: Wrong::OtherRun("mpm:2000", grid(75.0)) },
        |done| unaccounted(&done[0]),
    ));
    let springs = || Control::without_the_error("springs between surfaces", "mpm", grid(75.0));
    let runs = [
        (whole("seed-1", "mpm"), makes_energy()),
        (whole("seed-1", "mpm:no-slip"), makes_energy()),
        (whole("seed-1", "mpm:2001").known(OWN_NORMALS), springs()),
    ];
    for (run, control) in runs {
        gates.push(Gate::new(
            ("kinetic, elastic and plastic energy over the work of the walls, 80 % shear, not above 1", "1"),
            vec![run],
            invariant,
            (0.01, "the budget closes within 2 %, and friction takes its share"),
            control,
            |done| Ok(at_most(kept(&done[0])?, 1.0)),
        ));
    }
    gates
}

/// Where grains move, and how load is carried.
fn motion() -> Vec<Gate> {
    let glued = || Control::solver("contacts glued: nothing is pressed", "mpm:no-slip");
    vec![
        Gate::new(
            ("width of the band at 25 m/s over that at 100 m/s, 25 % shear, 1.25 or more", "1"),
            vec![
                to_shear(Run::new("slow", "mpm", grid(75.0)), 0.25, 0).long(),
                to_shear(Run::new("seed-1", "mpm", grid(75.0)), 0.25, 0).long().aside(),
            ],
            (Evidence::OtherCode, "independent prototype on a grid of 150²: .78 against .31, for momentum has come further in"),
            (0.0, "an order: packings differ, and whole grains that are driven reach into the slab, where the prototype's sides are cut"),
            Control::scene("a quarter of the time, in which momentum comes no further", |scene| {
                if let Duration::Seconds(time) = &mut scene.duration {
                    *time *= 0.25;
                }
            }),
            |done| Ok(at_least(band(&done[0], end(&done[0])?) / band(&done[1], end(&done[1])?), 1.25)),
        ),
        Gate::new(
            ("part of the grains that carry more than the mean, 63 % shear, not above 0.5", "1"),
            vec![whole("seed-1", "mpm")],
            (Evidence::Paper, "Bardenhagen, Brackbill & Sulsky 2000: only a small fraction of the grains are significantly stressed"),
            (0.0, "a load that all carry alike has a half above its mean"),
            glued(),
            |done| {
                let snapshot = at(&done[0], super::CHAINS[0])?;
                if snapshot.contacts.is_empty() {
                    return Err(Missing("contacts that press".to_owned()));
                }
                Ok(at_most(chains::chains(snapshot).stressed, 0.5))
            },
        ),
    ]
}

/// What a finer grid changes.
fn refined() -> Vec<Gate> {
    type Quantity = (&'static str, Of, f64, Option<&'static str>);
    let quantities: [Quantity; 2] =
        [("plastic strain", plastic_strain, 0.1, Some(PATCHES)), ("rotation of grains", rotation_deg, 0.15, None)];
    let gate = |(words, of, allowed, known): Quantity, coarse: f64, runs: [Run; 2], shear: f64| {
        let ([run, finer], fine) = (runs, 2.0 * coarse);
        let glued = Wrong::OtherRun("mpm:no-slip", grid(coarse));
        let (run, control) = match known {
            Some(reason) => (run.known(reason), Control::without_the_error("the finer grid", "mpm", grid(fine))),
            None => (run, Control { name: "contacts glued on the coarser grid", wrong: glued }),
        };
        Gate::new(
            (format!("{words} on a grid of {coarse}² over that on one of {fine}², {:.0} % shear", 100.0 * shear), "1"),
            vec![run, finer.aside()],
            (Evidence::Convergence, "the same packing on a grid twice as fine"),
            (allowed, "the motion is chaotic: contacts a little stiffer change as much"),
            control,
            move |done| Ok(Measured::new(over(done, shear, of)?, 1.0, 1.0)),
        )
    };
    let early = |cells| to_shear(Run::new("seed-1", "mpm", grid(cells)), 0.15, 0).long();
    let coarser = quantities.map(|quantity| gate(quantity, 75.0, [whole("seed-1", "mpm"), on_the_papers_grid()], 0.4));
    let finer = quantities.map(|quantity| gate(quantity, 150.0, [early(150.0), early(300.0)], 0.15));
    [coarser, finer].into_iter().flatten().collect()
}

pub(super) fn gates() -> Vec<Gate> {
    [vec![pores()], other_contacts(), energy(), motion(), refined()].concat()
}
