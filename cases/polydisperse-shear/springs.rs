//! The same slab of grains on springs: its budget, and the programs.

use super::{entry, gained, measures, to_shear};
use crate::chaos;
use crate::gate::{Control, Done, Gate, Measured, Missing, Run, Wrong};
use crate::program_rows::PAIRS;
use crate::verdict::Evidence;
use grainbench_scene::solver::Resolution;

const STEP: Resolution = Resolution::CriticalFraction(0.05);
/// Step at which programs are followed sum by sum, and the mean shear to which they are. LIGGGHTS parts when a contact closes
/// again, for it keeps the stretch of those that open (see the derivation of `plane-shear`); before that there are sixteen digits.
const WITH_PROGRAMS: Resolution = Resolution::CriticalFraction(0.1);
const BEGINNINGS: [f64; 2] = [0.05, 0.025];

/// A packing of grains on springs between closed sides, to a mean shear.
pub(super) fn to(packing: &'static str, shear: f64, snapshots: u32) -> Run {
    let name = format!("sides closed, to {:.0} % shear", 100.0 * shear);
    Run::new(packing, "dem", STEP).adjusted(&name, move |scene| {
        super::sheared(scene, shear, snapshots);
        super::sides::close(scene);
    })
}

/// The first packing to the end.
pub(super) fn slab() -> Run {
    to("seed-1", 0.8, super::FRAMES)
}

/// Momentum of the grains, by the masses of the scene as the case means it, gained since the start along the slab, less the
/// impulse of the driven grains.
fn momentum(done: &Done) -> Result<Measured, Missing> {
    let start: f64 = done.scene.grains.iter().map(|grain| grain.mass * grain.velocity.y).sum();
    let masses = done.scene.grains.iter().map(|grain| grain.mass);
    let now: f64 = measures::end(done)?.grains.iter().zip(masses).map(|(grain, mass)| mass * grain.velocity.y).sum();
    let impulse = entry(done, "impulse_y")?;
    Ok(Measured::new(now - start, impulse, impulse))
}

pub(super) fn gates() -> Vec<Gate> {
    let mut gates = vec![
        Gate::new(
            ("energy that is neither stored nor rubbed away, over the work of the walls, 80 % shear, grains on springs", "1"),
            vec![slab()],
            (Evidence::Invariant, "conservation of energy"),
            (1e-3, "second order in the step"),
            Control { name: "steps of .8 of the critical one", wrong: Wrong::OtherRun("dem", Resolution::CriticalFraction(0.8)) },
            |done| Ok(Measured::new(gained(&done[0], "unbalanced")? / entry(&done[0], "work")?, 0.0, 1.0)),
        ),
        Gate::new(
            ("momentum gained along the slab, 80 % shear", "N s"),
            vec![slab()],
            (Evidence::Invariant, "equal and opposite forces"),
            (1e-13, "rounding; of the largest impulse"),
            Control::scene("grains heavier by a thousandth", |scene| {
                scene.grains.iter_mut().for_each(|grain| grain.mass *= 1.001);
            }),
            |done| momentum(&done[0]),
        ),
    ];
    for (pair, beginning) in PAIRS.into_iter().zip(BEGINNINGS) {
        gates.push(Gate::new(
            (format!("kinetic energy of translation to {:.1} % shear, worst, against {}", 100.0 * beginning, pair[1]), "J"),
            pair.map(|solver| to_shear(Run::new("seed-1", solver, WITH_PROGRAMS), beginning, 0)).into(),
            (Evidence::OtherCode, "the program, run on the deck of the same scene"),
            (1e-12, "order of sums; relative to the largest value"),
            Control::ours("friction .29 for .3 in ours", |scene| scene.change_laws(|law| law.friction = 0.29)),
            |done| {
                let (theirs, ours) = chaos::together(&done[0], &done[1], "all.kinetic_energy")?;
                let largest = ours.iter().copied().fold(0.0, f64::max);
                Ok(Measured::worst_of(&done[0].series().time, &theirs, &ours, largest))
            },
        ));
    }
    gates
}
