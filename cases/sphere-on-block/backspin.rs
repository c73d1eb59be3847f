//! A sphere with backspin on a deformable plane (Bardenhagen et al. 2001): it slides, loses its spin, and rolls.

use super::{AT_REST, FLAT, LEVELS, set_down};
use crate::rows::elastic_backspin::{excess, sphere};
use grainbench_harness::prelude::*;

const VARIANT: &str = "backspin";

pub(super) fn claims() -> Vec<Claim> {
    // Largest relative errors of the displacement at cells of R/4 and R/8, required before the solver existed.
    let against_reference = LEVELS[1..]
        .iter()
        .zip([0.03, 0.01])
        .flat_map(|(level, asked)| sphere(level.name, asked, Run::new(VARIANT, "mpm", level.resolution).long()));
    let nodal = ["mpm:2000", "mpm:2001"].map(|solver| {
        claim("displacement at .8 s over the rigid one, less 1, touching at the start, R/4", "1")
            .run(set_down(VARIANT, solver).long().known(FLAT).up_to(AT_REST))
            .equals(Source::Derived("a rigid sphere slides, then rolls (derivation of backspin)"), |done| {
                Ok(Measurement::new(excess(&done[0])?, 0.0, 1.0))
            })
            .within(judged(0.035, "accuracy of a contact that acts at the surface, at this resolution"))
            .refuses(Control::without_the_error("springs at the surface", "mpm", LEVELS[1].resolution))
    });
    against_reference.chain(nodal).collect()
}
