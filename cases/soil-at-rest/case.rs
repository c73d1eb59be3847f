//! Soil with the initial stress of its own weight.

use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[cells("H/4", 4.0, 3), cells("H/8", 8.0, 3), cells("H/10", 10.0, 3)];
const SOURCE: Source = Source::Derived("∂σ_yy/∂y = ρg carries the weight (derivation)");

pub(crate) static CASE: Case = crate::heads::SOIL_AT_REST.with(LEVELS, 1, &claims);

/// Returns the height of the soil (m), and the settlement of its top, ρgH²/2M (m), if the soil starts without stress.
fn soil(scene: &Scene) -> Option<[f64; 2]> {
    let body = scene.bodies.first()?;
    let BlockShape::Box { low, high } = body.shape else { return None };
    let height = high.y - low.y;
    let modulus = scene.deformable.first().copied().flatten()?.longitudinal_modulus();
    Some([height, 0.5 * body.density * -scene.gravity.y * height * height / modulus])
}

fn claims() -> Vec<Claim> {
    let all = LEVELS.iter().map(|level| ("hypoelastic", *level)).chain([("rubber", LEVELS[1])]);
    all.map(|(law, level)| {
        claim(format!("largest displacement, {law}, cells of {}", level.name), "m")
            .run(Run::new(law, "mpm", level.resolution))
            .equals(SOURCE, |done| {
                let [_, sinking] = soil(&done[0].scene).ok_or("soil in a box")?;
                let columns = ["middle.ux", "middle.uy", "top.ux", "top.uy"].map(|name| done[0].column(name));
                let mut most = 0.0_f64;
                for column in columns {
                    most = column?.iter().fold(most, |most, now| most.max(now.abs()));
                }
                Ok(Measurement::new(most, 0.0, sinking))
            })
            .within(required(
                1e-9,
                "rounding of the height in each of 137 to 342 steps, at most 1.2e-11 of the settlement under the weight",
            ))
            .refuses(Control::scene("the gradient of the stress with the other sign", |scene| {
                let stress = scene.bodies.iter_mut().filter_map(|body| body.stress.as_mut());
                stress.for_each(|stress| stress.gradient.iter_mut().for_each(|gradient| *gradient = -*gradient));
            }))
            .solver_independent_continuum()
    })
    .collect()
}
