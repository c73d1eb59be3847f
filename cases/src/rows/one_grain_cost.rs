//! Target quantity of the cost study for one grain on a plane: its displacement, compared with the rigid solution for
//! several stiffnesses of the contact and of the grain.

use crate::exact::one_grain::{OneGrain, State, rest_at_overlap};
use crate::rows::elastic::{Rest, settle, stiffen};
use crate::rows::on_plane::{DAMPING, end, touching};
use grainbench_harness::prelude::*;

/// Static overlaps of grains on springs, divided by the radius R.
const OVERLAPS: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-5];
/// Factors on the moduli of deformable grains.
const STIFFENED: [f64; 2] = [1.0, 10.0];

/// Returns the displacement at the time `seconds` (s) as a target quantity, one for each of the variants of a case. The
/// expected value is the rigid solution `exact`. All solvers run up to this time.
pub(crate) fn displacement(
    case: &'static Case,
    variants: &[&'static str],
    seconds: f64,
    exact: fn(&OneGrain, f64) -> State,
    source: &str,
) -> Vec<TargetQuantity> {
    let setup = |method, knobs, prepare, about| SolverSetup { method, knobs, prepare: Some(prepare), about };
    let dem = OVERLAPS.map(|ratio| {
        let at_rest = lasting(seconds, move |scene| rest_at_overlap(scene, ratio, DAMPING));
        setup(Method::Dem, format!("overlap/R = {ratio:e}"), at_rest, Resolution::CriticalFraction(0.1))
    });
    let rigid = setup(Method::Rigid, String::new(), lasting(seconds, touching), Resolution::substeps(8));
    let grid = STIFFENED.map(|factor| {
        let knobs = if factor == 1.0 { String::new() } else { format!("moduli × {factor}") };
        setup(Method::Grid, knobs, Arc::new(move |scene| settled(scene, factor, seconds)), Resolution::grid(8.0, 3))
    });
    let lanes: Vec<SolverSetup> = dem.into_iter().chain([rigid]).chain(grid).collect();
    let of_variant = |&variant: &&'static str| TargetQuantity {
        case,
        variant,
        quantity: format!("displacement at {seconds} s"),
        unit: "m",
        source: source.to_owned(),
        measure: Arc::new(move |done| end(done.first().ok_or("run")?, exact, |state| state.x)),
        lanes: lanes.clone(),
    };
    variants.iter().map(of_variant).collect()
}

fn lasting(seconds: f64, change: impl Fn(&mut Scene) + Send + Sync + 'static) -> Change {
    Arc::new(move |scene| {
        scene.duration = Duration::Seconds(seconds);
        change(scene);
    })
}

/// Lets the grain relax on the plane before the run, under the normal component of gravity. Multiplies moduli by
/// `factor`; missing moduli are K = 10 MPa and G = 2.5 MPa (Bardenhagen, Brackbill & Sulsky 2000).
fn settled(scene: &mut Scene, factor: f64, seconds: f64) {
    settle(scene, Rest { duration: 0.3, damping: 100.0 }, seconds);
    let paper = Deformable { bulk_modulus: 1e7, shear_modulus: 2.5e6, constitutive: Constitutive::NeoHookean };
    for material in &mut scene.deformable {
        material.get_or_insert(paper);
    }
    stiffen(scene, factor);
}
