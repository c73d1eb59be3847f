//! Claims on the slab with grains on springs: energy budget, momentum, and comparison with LAMMPS and LIGGGHTS.

use super::{entry, gained, measures, to_shear};
use crate::rows::programs::{PAIRS, kinetic_energy};
use grainbench_harness::prelude::*;

const STEP: Resolution = Resolution::CriticalFraction(0.05);
/// Time step of the comparison with LAMMPS and LIGGGHTS at each sample.
const WITH_PROGRAMS: Resolution = Resolution::CriticalFraction(0.1);
/// Mean shears up to which sixteen digits of our solver agree with LAMMPS and LIGGGHTS. LIGGGHTS differs once a contact
/// closes again, because it keeps the tangential displacement of opened contacts (derivation of `plane-shear`).
const BEGINNINGS: [f64; 2] = [0.05, 0.025];

/// Returns the run of a packing of grains on springs with closed sides, up to a mean shear.
pub(super) fn to(packing: &'static str, shear: f64, snapshots: u32) -> Run {
    let name = format!("sides closed, to {:.0} % shear", 100.0 * shear);
    Run::new(packing, "dem", STEP).adjusted(&name, move |scene| {
        super::sheared(scene, shear, snapshots);
        super::sides::close(scene);
    })
}

pub(super) fn slab() -> Run {
    to("seed-1", 0.8, super::FRAMES)
}

/// Compares the increase of the grains' momentum along the slab with the impulse of the grains with prescribed motion.
/// The masses belong to the scene of the case, also under a negative control.
fn momentum(done: &FinishedRun) -> Result<Measurement, MissingData> {
    let start: f64 = done.scene.grains.iter().map(|grain| grain.mass * grain.velocity.y).sum();
    let masses = done.scene.grains.iter().map(|grain| grain.mass);
    let now: f64 = measures::end(done)?.grains.iter().zip(masses).map(|(grain, mass)| mass * grain.velocity.y).sum();
    let impulse = entry(done, "impulse_y")?;
    Ok(Measurement::new(now - start - impulse, 0.0, impulse))
}

pub(super) fn claims() -> Vec<Claim> {
    let energy = claim(
        "energy that is neither stored nor rubbed away, over the work of the walls, 80 % shear, grains on springs",
        "1",
    )
    .run(slab())
    .holds("conservation of energy", |done| {
        Ok(Measurement::new(gained(&done[0], "unbalanced")? / entry(&done[0], "work")?, 0.0, 1.0))
    })
    .within(judged(1e-3, "second order in the step"))
    .refuses(Control::run("steps four times as long", "dem", Resolution::CriticalFraction(0.2)));
    let momentum = claim("momentum gained along the slab, 80 % shear", "N s")
        .run(slab())
        .holds("equal and opposite forces", |done| momentum(&done[0]))
        .within(rounding(1.0, "of the largest impulse"))
        .refuses(Control::grains("grains heavier by a thousandth", |grain| grain.mass *= 1.001));
    let beside = PAIRS.into_iter().zip(BEGINNINGS).map(|(pair, beginning)| {
        let runs = pair.map(|solver| to_shear(Run::new("seed-1", solver, WITH_PROGRAMS), beginning, 0));
        let control = Control::our_contact_law("friction .29 for .3 in ours", |law| law.friction = 0.29);
        kinetic_energy(&format!("to {:.1} % shear", 100.0 * beginning), runs, control)
    });
    [energy, momentum].into_iter().chain(beside).collect()
}
