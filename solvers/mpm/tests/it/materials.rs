//! Tests of constitutive laws at a point.

use grainbench_mpm::material::{Hypoelastic, KelvinVoigt, Law, NeoHookean, PointStep, State, VolumeRatio, VonMises};
use grainbench_solver::space::{Plane, Solid, Space};
use nalgebra::{Matrix3, Rotation3, Vector3};

const BULK: f64 = 11.4e9;
const SHEAR: f64 = 7.5e9;
const METAL: VonMises = VonMises {
    elastic: Hypoelastic { bulk_modulus: BULK, shear_modulus: SHEAR },
    yield_stress: 0.3e9,
    hardening_modulus: 0.01e9,
};

/// Converts the displacement gradient H at the middle of a step to the gradient at the start of the step, H (1 −
/// H/2)⁻¹.
fn at_start(middle: Matrix3<f64>) -> Matrix3<f64> {
    middle * (Matrix3::identity() - middle * 0.5).try_inverse().unwrap()
}

/// Integrates a state through steps. Their displacement gradients at mid-step add up to `strain`.
fn strained(law: impl Law, state: &mut State, strain: Matrix3<f64>, steps: u32) {
    let increment = at_start(strain / f64::from(steps));
    for _ in 0..steps {
        law.update(&increment, 1.0, state);
    }
}

fn equivalent(stress: &Matrix3<f64>) -> f64 {
    let deviator = stress - Matrix3::from_diagonal_element(stress.trace() / 3.0);
    (1.5 * deviator.norm_squared()).sqrt()
}

/// In pure shear e, the plastic strain is ε_p = (3G·2e/√3 − Y)/(3G + H).
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

/// Uniaxial strain −e gives ε_p = (2Ge − Y)/(3G + H). The return to zero strain adds (2Ge − 2q)/(3G + H). At −e, σ_xx =
/// −Ke − 2q/3.
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

/// In simple shear by 2 with the Jaumann rate, the stress follows the hardening without oscillating.
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

/// A full turn leaves the stress unchanged.
#[test]
fn rotation_makes_no_stress() {
    let law = Hypoelastic { bulk_modulus: BULK, shear_modulus: SHEAR };
    let mut state = State { stress: Matrix3::new(1.0, 2.0, 0.0, 2.0, -3.0, 0.0, 0.0, 0.0, 4.0), ..State::default() };
    let before = state.stress;
    // The rotation in each step is 2 atan(w/2), with the off-diagonal entry w of the displacement gradient.
    let steps = 1000;
    let rate = 2.0 * (std::f64::consts::PI / f64::from(steps)).tan();
    let rounding = f64::from(steps) * BULK * f64::EPSILON;
    strained(law, &mut state, Matrix3::new(0.0, -rate, 0.0, rate, 0.0, 0.0, 0.0, 0.0, 0.0) * f64::from(steps), steps);
    assert!((state.stress - before).norm() < rounding);
}

/// Returns a stress after a rotation about an axis in equal steps, each with the displacement gradient R − 1.
fn turned<S: Space>(stress: Matrix3<f64>, axis: Vector3<f64>, angle: f64, steps: u32) -> Matrix3<f64> {
    let law = Hypoelastic { bulk_modulus: BULK, shear_modulus: SHEAR };
    let rotation = Rotation3::new(axis * (angle / f64::from(steps))).into_inner();
    let increment = S::restrict_gradient(rotation - Matrix3::identity());
    let mut stress = S::restrict_symmetric(stress);
    for _ in 0..steps {
        let step = PointStep { increment, deformation: increment, volume: VolumeRatio::new(1.0), stress };
        stress = law.follow::<S>(step, &mut 0.0);
    }
    S::embed_symmetric(stress)
}

/// Rounding error of stress (Pa) in 250 steps, about the bulk modulus times the machine epsilon per step.
const ROUNDING: f64 = 250.0 * BULK * f64::EPSILON;

/// An eighth of a turn rotates the stress, σ' = R σ Rᵀ: σ_xx' = (σ_xx + σ_yy)/2 − σ_xy, σ_yy' = (σ_xx + σ_yy)/2 + σ_xy,
/// σ_xy' = (σ_xx − σ_yy)/2. A quarter of a turn would give the same stress in both directions.
#[test]
fn an_eighth_of_a_turn_carries_the_stress_along() {
    const STRESS: Matrix3<f64> = Matrix3::new(1.0, 2.0, 0.0, 2.0, -3.0, 0.0, 0.0, 0.0, 4.0);
    let expected = Matrix3::new(-3.0, 2.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 4.0);
    let eighth = std::f64::consts::FRAC_PI_4;
    for found in [
        turned::<Plane>(STRESS, Vector3::z(), eighth, 250),
        turned::<Solid>(STRESS, Vector3::z(), eighth, 250),
        turned::<Solid>(STRESS, Vector3::z(), eighth, 1),
    ] {
        assert!((found - expected).norm() < ROUNDING, "{found}");
    }
    // The test covers a general axis and both directions.
    let axis = Vector3::new(0.6, -0.48, 0.64);
    for angle in [eighth, -eighth] {
        let rotation = Rotation3::new(axis * angle).into_inner();
        let found = turned::<Solid>(STRESS, axis, angle, 250);
        assert!((found - rotation * STRESS * rotation.transpose()).norm() < ROUNDING, "{found}");
    }
}

/// A rotation of any size in a step gives no strain. Metal does not yield, and a viscous solid has no stress.
#[test]
fn a_rotation_strains_nothing() {
    let rotation = Rotation3::new(Vector3::new(0.6, -0.48, 0.64) * 0.3).into_inner();
    let increment = rotation - Matrix3::identity();
    let mut metal = State::default();
    METAL.update(&increment, 1.0, &mut metal);
    assert!(metal.stress.norm() < ROUNDING && metal.plastic_strain == 0.0, "{}", metal.stress);
    let rubber = NeoHookean { lame: 3.0, shear_modulus: 2.0 };
    let solid = KelvinVoigt { elastic: rubber, shear_viscosity: BULK, bulk_viscosity: BULK };
    let mut viscous = State { deformation: rotation, ..State::default() };
    solid.update(&increment, 1.0, &mut viscous);
    assert!(viscous.stress.norm() < ROUNDING, "{}", viscous.stress);
}

/// The stress is the derivative of the energy.
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
}

/// For a wave along n, ρ₀c² is the second derivative with respect to ε of the energy of (1 + ε n ⊗ n) F. The test uses
/// n along each axis.
#[test]
fn the_wave_speed_follows_from_the_energy() {
    let law = NeoHookean { lame: 3.0, shear_modulus: 2.0 };
    for stretch in [[1.0, 1.0], [1.3, 0.8], [0.5, 0.9], [0.7, 1.6]] {
        let deformation = Matrix3::from_diagonal(&Vector3::new(stretch[0], stretch[1], 1.0));
        let fastest = (0..3).map(|axis| {
            let energy = |by: f64| {
                let mut more = Matrix3::<f64>::identity();
                more[(axis, axis)] += by;
                law.energy(&State { deformation: more * deformation, ..State::default() })
            };
            (energy(1e-4) - 2.0 * energy(0.0) + energy(-1e-4)) / 1e-8
        });
        let fastest = fastest.fold(0.0, f64::max);
        let found = law.wave_modulus(deformation.determinant(), &(deformation * deformation.transpose()));
        assert!((found / fastest - 1.0).abs() < 1e-6, "{stretch:?}: {found} for {fastest}");
    }
}

/// For a given stress, `under_stress` returns a state without rotation from which the law gives the same stress. The
/// test covers a pressure, a shear, and stresses of a third of the moduli.
#[test]
fn a_law_starts_under_any_stress() {
    let rubber = NeoHookean { lame: 3.0, shear_modulus: 2.0 };
    let wanted = [
        Matrix3::from_diagonal_element(-0.2),
        Matrix3::new(0.0, 0.7, 0.0, 0.7, 0.0, 0.0, 0.0, 0.0, 0.0),
        Matrix3::new(-0.9, 0.3, 0.0, 0.3, 0.6, 0.0, 0.0, 0.0, 0.0),
        Matrix3::new(0.4, 0.3, -0.2, 0.3, -0.5, 0.1, -0.2, 0.1, 0.2),
        Matrix3::zeros(),
    ];
    for stress in wanted {
        for dimensions in [2, 3] {
            let mut state = rubber.under_stress(&stress, dimensions).unwrap();
            let deformation = state.deformation;
            assert!((deformation - deformation.transpose()).norm() < 1e-13, "{deformation}");
            rubber.update(&Matrix3::zeros(), deformation.determinant(), &mut state);
            let off = (state.stress - stress).fixed_view::<3, 3>(0, 0).into_owned();
            for (row, column) in (0..dimensions).flat_map(|row| (0..dimensions).map(move |column| (row, column))) {
                assert!(off[(row, column)].abs() < 1e-13, "{stress}, {dimensions}: {off}");
            }
        }
    }
    // The moduli limit tension but not compression. At a tension of fifty times the moduli no such state exists.
    assert!(rubber.under_stress(&Matrix3::from_diagonal_element(100.0), 3).is_none());
    // A law with history starts with the given stress, unless this stress exceeds the yield stress.
    let steel = Matrix3::new(0.17e9, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    assert_eq!(METAL.under_stress(&steel, 2).unwrap().stress, steel);
    assert!(METAL.under_stress(&(steel * 2.0), 2).is_none());
    // A pressure does not yield, even if it exceeds the yield stress.
    assert!(METAL.under_stress(&Matrix3::from_diagonal_element(-10.0 * METAL.yield_stress), 3).is_some());
}

/// The viscous stress is σ − σ_elastic = 2η dev D + ζ tr D 1. Its work on the strain of the step is (2η dev D : D + ζ
/// tr² D) Δt.
#[test]
fn kelvin_and_voigt_add_the_stress_of_a_fluid() {
    let rubber = NeoHookean { lame: 3.0, shear_modulus: 2.0 };
    let (viscosity, bulk, step) = (0.7, 0.4, 1e-3);
    let law = KelvinVoigt { elastic: rubber, shear_viscosity: viscosity / step, bulk_viscosity: bulk / step };
    let gradient = Matrix3::new(0.3, 0.8, 0.0, -0.2, -0.1, 0.0, 0.0, 0.0, 0.0);
    let deformation = Matrix3::new(1.1, 0.2, 0.0, -0.1, 0.95, 0.0, 0.0, 0.0, 1.0);
    let ratio = deformation.determinant();
    let [mut viscous, mut elastic] = [State { deformation, ..State::default() }; 2];
    law.update(&at_start(gradient * step), ratio, &mut viscous);
    rubber.update(&at_start(gradient * step), ratio, &mut elastic);
    let rate = (gradient + gradient.transpose()) * 0.5;
    let deviator = rate - Matrix3::from_diagonal_element(rate.trace() / 3.0);
    let exact = deviator * (2.0 * viscosity) + Matrix3::from_diagonal_element(bulk * rate.trace());
    assert!((viscous.stress - elastic.stress - exact).norm() < 1e-12, "{}", viscous.stress - elastic.stress);
    let [increment, deformation] = [at_start(gradient * step), deformation].map(Plane::restrict_gradient);
    let (volume, stress) = (VolumeRatio::new(ratio), Plane::restrict_symmetric(viscous.stress));
    let work = law.viscous_work::<Plane>(PointStep { increment, deformation, volume, stress });
    let exact = (2.0 * viscosity * deviator.norm_squared() + bulk * rate.trace().powi(2)) * step;
    assert!((work / exact - 1.0).abs() < 1e-9, "{work} and {exact}");
}
