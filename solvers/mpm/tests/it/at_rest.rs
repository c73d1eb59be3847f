//! Tests that bodies with the initial stress of their weight stay at rest.

use crate::support::{column, try_run};
use grainbench_mpm::options::{Basis, Setting, StressUpdate, Transfer};
use grainbench_solver::resolution::Resolution;

/// Density (kg/m³).
const DENSITY: f64 = 1800.0;
/// Gravity (m/s²).
const GRAVITY: f64 = 9.81;
/// Young's modulus (Pa).
const YOUNG: f64 = 1e6;
/// Poisson's ratio.
const POISSON: f64 = 0.3;
/// Height of the soil (m).
const HEIGHT: f64 = 1.0;

/// Returns soil in a smooth box under K₀ stress: σ_yy = ρg(y − H) and σ_xx = K₀ σ_yy, with K₀ = ν/(1 − ν).
///
/// The stress is given at half height, with `sign` times the correct gradient.
fn soil(law: &str, sign: f64) -> String {
    let (middle, gradient) = (-0.5 * DENSITY * GRAVITY * HEIGHT, sign * DENSITY * GRAVITY);
    let beside = POISSON / (1.0 - POISSON);
    format!(
        "dimension = 2\nduration = 0.2\ngravity = [0.0, -{GRAVITY}]\nreference_length = {HEIGHT}\n\
         materials.m = {{ density = {DENSITY}, young_modulus = {YOUNG}, poisson_ratio = {POISSON}, {law} }}\n\
         [bodies.soil]\nmaterial = 'm'\nbox = {{ low = [0.0, 0.0], high = [1.0, {HEIGHT}] }}\n\
         fixed = ['y-low']\nsliding = ['x-low', 'x-high']\nstress = [[{}, 0.0], [0.0, {middle}]]\n\
         stress_gradient = {{ y = [[{}, 0.0], [0.0, {gradient}]] }}\n\
         [output]\nevery = 0.01\n[probes]\ntop.point = {{ body = 'soil', at = [0.5, 0.99] }}\n\
         middle.point = {{ body = 'soil', at = [0.02, 0.5] }}\nall.system = true\n",
        beside * middle,
        beside * gradient
    )
}

/// Returns the settlement of the top without initial stress (m): ρgH²/2M with M = E(1 − ν)/((1 + ν)(1 − 2ν)).
fn settlement() -> f64 {
    let modulus = YOUNG * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
    0.5 * DENSITY * GRAVITY * HEIGHT * HEIGHT / modulus
}

/// Returns the largest displacement component of two points (m) in .2 s, and the number of steps. The wave crosses the
/// height five times in .2 s.
fn moved(change: impl FnOnce(&mut Setting), text: &str, cells: f64, points: u32) -> (f64, f64) {
    let record = try_run("mpm", change, text, Resolution::grid(cells, points)).unwrap();
    let columns = ["top.ux", "top.uy", "middle.ux", "middle.uy"];
    let most = columns.iter().flat_map(|name| column(&record, name)).fold(0.0, |most: f64, now| most.max(now.abs()));
    (most, record.cost.steps as f64)
}

/// With three points per cell, the sums over points equal the integrals of basis functions times the linear stress. Only
/// rounding errors remain, of at most ε H per step with the spacing ε of floating-point numbers at 1 and the height H.
#[test]
fn stress_of_the_weight_keeps_soil_at_rest() {
    let soft = soil("constitutive = 'hypoelastic'", 1.0);
    for basis in [Basis::Linear, Basis::Quadratic, Basis::Gimp] {
        for stress_update in [StressUpdate::First, StressUpdate::ModifiedLast] {
            for cells in [4.0, 8.0, 10.0] {
                let change = |setting: &mut Setting| {
                    let transfer =
                        if basis == Basis::Quadratic { setting.transfer } else { Transfer::Flip { pic: 0.0 } };
                    *setting = Setting { basis, stress_update, transfer, ..*setting };
                };
                let (found, steps) = moved(change, &soft, cells, 3);
                assert!(
                    found <= steps * f64::EPSILON * HEIGHT,
                    "{basis:?}, {stress_update:?}, {cells} cells: {found} m"
                );
            }
        }
    }
    for law in ["constitutive = 'neo-hookean'", "constitutive = 'von-mises', yield_stress = 1e5"] {
        let (found, steps) = moved(|_| (), &soil(law, 1.0), 8.0, 3);
        assert!(found <= steps * f64::EPSILON * HEIGHT, "{law}: {found} m");
    }
}

/// With two points per cell, the midpoint rule has an error at the free surface, of second order in the cell size. With
/// a gradient of the wrong sign, the stress differs by −2ρg(y − H/2) from the stress of the weight. The middle then
/// vibrates about a position that is lower by ρgH²/4M, half of the settlement.
#[test]
fn the_sign_of_a_stress_gradient_is_felt() {
    let [right, wrong] = [1.0, -1.0].map(|sign| moved(|_| (), &soil("constitutive = 'hypoelastic'", sign), 8.0, 2).0);
    assert!(right < settlement() / 64.0, "{right} m");
    assert!(wrong > 0.5 * settlement(), "{wrong} m");
}
