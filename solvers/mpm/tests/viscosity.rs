//! Tests of energy dissipation by viscosity.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use grainbench_solver::resolution::Resolution;
use support::{collision, column, last, try_run};

/// Two viscous discs collide. Their viscous dissipation is part of the damping entry, and the budget closes to first
/// order in the time step. Without viscosity the damping entry is zero.
#[test]
fn the_budget_of_a_viscous_collision_closes() {
    let budget_error = |viscosity: &str, courant: f64| {
        let modulus = "shear_modulus = 6.0";
        let text =
            collision(0.02, 0.0, 0.5).replace(modulus, &format!("{modulus}, {viscosity}")) + "budget.budget = true\n";
        let record = try_run("mpm", |_| (), &text, Resolution::Grid { cells: 8.0, points: 3, courant }).unwrap();
        let kinetic = column(&record, "budget.kinetic")[0];
        let open = last(&record, "budget.unbalanced") - column(&record, "budget.unbalanced")[0];
        (last(&record, "budget.damping") / kinetic, open / kinetic)
    };
    let viscous = "constitutive = 'kelvin-voigt', viscosity = 0.5, bulk_viscosity = 0.2";
    let (lost, coarse) = budget_error(viscous, 0.4);
    let (_, fine) = budget_error(viscous, 0.1);
    assert!(lost > 0.05, "{lost}");
    assert!(fine.abs() < 1e-3 && (fine.abs() < 0.4 * coarse.abs() || fine.abs() < 1e-5), "{coarse} and {fine}");
    let (nothing, _) = budget_error("constitutive = 'neo-hookean'", 0.4);
    assert_eq!(nothing, 0.0);
}
