//! Constitutive laws at a point.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use grainbench_mpm::material::{Hypoelastic, Law, NeoHookean, State, VonMises};
use grainbench_mpm::off::Off;
use grainbench_scene::space::{Plane, Solid, Space};
use nalgebra::Matrix3;

const BULK: f64 = 11.4e9;
const SHEAR: f64 = 7.5e9;
const METAL: VonMises = VonMises {
    elastic: Hypoelastic { bulk_modulus: BULK, shear_modulus: SHEAR },
    yield_stress: 0.3e9,
    hardening_modulus: 0.01e9,
};

fn strained(law: impl Law, state: &mut State, strain: Matrix3<f64>, steps: u32) {
    let increment = strain / f64::from(steps);
    for _ in 0..steps {
        law.update(&increment, 1.0, state);
    }
}

fn equivalent(stress: &Matrix3<f64>) -> f64 {
    let deviator = stress - Matrix3::from_diagonal_element(stress.trace() / 3.0);
    (1.5 * deviator.norm_squared()).sqrt()
}

/// Pure shear e: ε_p = (3G·2e/√3 − Y)/(3G + H).
#[test]
fn plastic_shear_is_exact() {
    for steps in [10, 100, 1000] {
        let (e, mut state) = (0.05, State::default());
        strained(METAL, &mut state, Matrix3::new(0.0, e, 0.0, e, 0.0, 0.0, 0.0, 0.0, 0.0), steps);
        let exact =
            (3.0 * SHEAR * 2.0 * e / 3.0_f64.sqrt() - METAL.yield_stress) / (3.0 * SHEAR + METAL.hardening_modulus);
        assert!((state.plastic_strain / exact - 1.0).abs() < 1e-12);
        assert!(state.stress.m33.abs() < 1e-3 && state.stress.trace().abs() < 1e-3);
    }
}

/// Uniaxial strain −e and back: ε_p = (2Ge − Y)/(3G + H), then (2Ge − 2q)/(3G + H) more; σ_xx = −Ke − 2q/3.
#[test]
fn plastic_compression_and_back_is_exact() {
    for steps in [10, 100, 1000] {
        let (e, mut state) = (0.05, State::default());
        let strain = Matrix3::new(-e, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        strained(METAL, &mut state, strain, steps);
        let stiffness = 3.0 * SHEAR + METAL.hardening_modulus;
        let first = (2.0 * SHEAR * e - METAL.yield_stress) / stiffness;
        let yielded = METAL.yield_stress + METAL.hardening_modulus * first;
        assert!((state.plastic_strain / first - 1.0).abs() < 1e-12);
        assert!((state.stress.m11 / (-BULK * e - 2.0 / 3.0 * yielded) - 1.0).abs() < 1e-12);
        strained(METAL, &mut state, -strain, steps);
        let second = (2.0 * SHEAR * e - 2.0 * yielded) / stiffness;
        assert!((state.plastic_strain / (first + second) - 1.0).abs() < 1e-12);
    }
}

/// Simple shear by 2 with the Jaumann rate: the stress follows the hardening without oscillating.
#[test]
fn large_plastic_shear_does_not_oscillate() {
    let mut state = State::default();
    let mut before = 0.0;
    for step in 0..2000 {
        METAL.update(&Matrix3::new(0.0, 0.001, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), 1.0, &mut state);
        assert!(step < 40 || state.stress.m12 >= before * (1.0 - 1e-6));
        before = state.stress.m12;
    }
    let yielded = METAL.yield_stress + METAL.hardening_modulus * state.plastic_strain;
    assert!((equivalent(&state.stress) / yielded - 1.0).abs() < 1e-9);
    assert!((state.stress.m12 * 3.0_f64.sqrt() / yielded - 0.9997).abs() < 2e-4);
    assert!((state.plastic_strain / 1.140_55 - 1.0).abs() < 1e-4);
}

/// Whole turns leave the stress as it was, turned with the body.
#[test]
fn rotation_makes_no_stress() {
    let law = Hypoelastic { bulk_modulus: BULK, shear_modulus: SHEAR };
    let mut state = State { stress: Matrix3::new(1.0, 2.0, 0.0, 2.0, -3.0, 0.0, 0.0, 0.0, 4.0), ..State::default() };
    let before = state.stress;
    // The rotation of a step is 2 atan(w/2).
    let steps = 1000;
    let rate = 2.0 * (std::f64::consts::PI / f64::from(steps)).tan();
    strained(law, &mut state, Matrix3::new(0.0, -rate, 0.0, rate, 0.0, 0.0, 0.0, 0.0, 0.0) * f64::from(steps), steps);
    assert!((state.stress - before).norm() < 1e-11);
}

/// A quarter turn carries the stress along, σ' = R σ Rᵀ: what lies along x lies along y then, and shear changes its sign. A
/// whole turn would come back to the same stress whichever way it went.
#[test]
fn a_quarter_turn_carries_the_stress_along() {
    fn turned<S: Space>(gradient: Matrix3<f64>, steps: u32) -> Matrix3<f64> {
        let law = Hypoelastic { bulk_modulus: BULK, shear_modulus: SHEAR };
        let increment = S::restrict_gradient(gradient);
        let mut stress = S::restrict_symmetric(STRESS);
        for _ in 0..steps {
            stress = law.follow::<S>(increment, 1.0, increment, stress, &mut Off);
        }
        S::embed_symmetric(stress)
    }
    const STRESS: Matrix3<f64> = Matrix3::new(1.0, 2.0, 0.0, 2.0, -3.0, 0.0, 0.0, 0.0, 4.0);
    let steps = 250;
    let rate = 2.0 * (std::f64::consts::FRAC_PI_4 / f64::from(steps)).tan();
    let about_z = Matrix3::new(0.0, -rate, 0.0, rate, 0.0, 0.0, 0.0, 0.0, 0.0);
    let expected = Matrix3::new(-3.0, -2.0, 0.0, -2.0, 1.0, 0.0, 0.0, 0.0, 4.0);
    assert!((turned::<Plane>(about_z, steps) - expected).norm() < 1e-11);
    assert!((turned::<Solid>(about_z, steps) - expected).norm() < 1e-11);
    // About x: y goes to z, z to −y.
    let about_x = Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -rate, 0.0, rate, 0.0);
    let expected = Matrix3::new(1.0, 0.0, 2.0, 0.0, 4.0, 0.0, 2.0, 0.0, -3.0);
    assert!((turned::<Solid>(about_x, steps) - expected).norm() < 1e-11);
}

/// The stress is the derivative of the energy, and of the pressure asked for.
#[test]
fn neo_hookean_energy_gives_its_stress() {
    let law = NeoHookean { lame: 3.0, shear_modulus: 2.0 };
    let deformation = Matrix3::new(1.1, 0.2, 0.0, -0.1, 0.95, 0.0, 0.0, 0.0, 1.0);
    let energy = |deformation| law.energy(&State { deformation, ..State::default() });
    let mut state = State { deformation, ..State::default() };
    let volume_ratio = deformation.determinant();
    law.update(&Matrix3::zeros(), volume_ratio, &mut state);
    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1), (2, 2)] {
        let mut there = Matrix3::zeros();
        there[(i, j)] = 1e-6;
        let work = (energy((Matrix3::identity() + there) * deformation)
            - energy((Matrix3::identity() - there) * deformation))
            / 2e-6;
        assert!((work - volume_ratio * state.stress[(i, j)]).abs() < 1e-8);
    }
    for dimensions in [2, 3] {
        let (stretch, stress) = law.under_pressure(0.2, dimensions);
        assert!(stretch < 1.0 && (stress.m11 + 0.2).abs() < 1e-13 && (stress.m22 + 0.2).abs() < 1e-13);
    }
}
