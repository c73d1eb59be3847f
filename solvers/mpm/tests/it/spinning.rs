//! Tests of freely spinning bodies. Incremental laws must keep their size, and the full inertia tensor must give their
//! spin.

use crate::support::{column, last, run};
use grainbench_solver::record::{Record, Snapshot};
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

/// Density (kg/m³).
const DENSITY: f64 = 1000.0;
/// Young's modulus (Pa).
const YOUNG: f64 = 1e6;
/// Poisson's ratio.
const POISSON: f64 = 0.3;
/// Radius (m).
const RADIUS: f64 = 0.1;
/// Spin (rad/s).
const SPIN: f64 = 10.0;

fn grain(dimension: u32, law: &str, spin: &str) -> String {
    format!(
        "dimension = {dimension}\nduration = {}\n\
         materials.m = {{ density = {DENSITY}, young_modulus = {YOUNG}, poisson_ratio = {POISSON}, {law} }}\n\
         [grains.g]\nmaterial = 'm'\nradius = {RADIUS}\nposition = {}\nspin = {spin}\n[output]\nevery = 0.1\n\
         [probes]\ng.grain = 'g'\nall.system = true\n",
        TAU / SPIN,
        if dimension == 2 { "[0.0, 0.0]" } else { "[0.0, 0.0, 0.0]" }
    )
}

/// Returns the relative growth of the radius of gyration of the material points.
fn growth(snapshot: &Snapshot) -> f64 {
    let count = snapshot.points.len() as f64;
    let gyration = |place: &dyn Fn(usize) -> Vector3<f64>| {
        let centre = (0..snapshot.points.len()).map(place).sum::<Vector3<f64>>() / count;
        (0..snapshot.points.len()).map(|at| (place(at) - centre).norm_squared()).sum::<f64>()
    };
    let points = &snapshot.points;
    let (now, start) =
        (gyration(&|at| points[at].position), gyration(&|at| points[at].position - points[at].displacement));
    (now / start).sqrt() - 1.0
}

fn growth_at_end(record: &Record) -> f64 {
    growth(record.snapshots.last().unwrap())
}

/// Returns the static growth of the radius of gyration of a spinning disc in plane strain.
///
/// The displacement is u = A r ((3 + ν')R² − (1 + ν')r²) with A = (1 − ν')ρΩ²/8E', E' = E/(1 − ν²) and ν' = ν/(1 − ν)
/// (Timoshenko & Goodier 1970, article 32). The ratio ⟨u r⟩/⟨r²⟩ over the disc is A R² ((3 + ν') − ⅔(1 + ν')).
fn centrifugal_growth() -> f64 {
    let (young, poisson) = (YOUNG / (1.0 - POISSON * POISSON), POISSON / (1.0 - POISSON));
    let scale = (1.0 - poisson) * DENSITY * (SPIN * RADIUS).powi(2) / (8.0 * young);
    scale * ((3.0 + poisson) - 2.0 / 3.0 * (1.0 + poisson))
}

/// A body that starts to spin vibrates about its static growth, up to twice this growth. With the strain on the
/// configuration at the start of a step, a disc would grow by πΩΔt per turn. A sphere would grow on two axes of three,
/// by 2πΩΔt/3. At four cells per radius, this is 27 and 18 times the static growth. The limit of the test is the
/// vibration plus the same amount for the grid. The spin varies as the inverse square of the radius of gyration, minus
/// the loss by lumped mass.
#[test]
fn an_incremental_law_keeps_the_size_of_what_spins() {
    for law in ["constitutive = 'hypoelastic'", "constitutive = 'von-mises', yield_stress = 1e9"] {
        for (dimension, spin, name) in [(2, "10.0", "g.omega"), (3, "[0.0, 6.0, 8.0]", "g.omega_y")] {
            let record = run("mpm", &grain(dimension, law, spin), 4.0, 2);
            let (static_growth, found) = (centrifugal_growth(), growth_at_end(&record));
            let grown_on_start = PI * SPIN * record.provenance.time_step * if dimension == 2 { 1.0 } else { 2.0 / 3.0 };
            assert!(grown_on_start > 8.0 * static_growth, "{grown_on_start}");
            assert!((found - static_growth).abs() < 2.0 * static_growth, "{law}, {dimension}: {found}");
            let spins = column(&record, name);
            assert!((spins[spins.len() - 1] / spins[0] - 1.0).abs() < 5e-3, "{law}, {dimension}: {spins:?}");
        }
    }
}

/// A box of 6 kg has the sides a, b, c = .3, .2 and .1 m: I = m/12 (b² + c², a² + c², a² + b²) = (.025, .05, .065) kg
/// m². With the spin (.2, 10, 0) rad/s its angular momentum is (.005, .5, 0) kg m²/s, which free flight conserves. Its
/// rotational energy is ½ ω·L = 2.5005 J. The remaining kinetic energy is due to deformation: zero at the start and
/// never negative.
#[test]
fn a_box_keeps_its_angular_momentum() {
    let text = "dimension = 3\nduration = 0.1\nreference_length = 0.1\n\
        materials.m = { density = 1000.0, young_modulus = 1e6, poisson_ratio = 0.0 }\n\
        [bodies.box]\nmaterial = 'm'\nbox = { low = [-0.15, -0.1, -0.05], high = [0.15, 0.1, 0.05] }\n\
        spin = [0.2, 10.0, 0.0]\n[output]\nevery = 0.01\n[probes]\nbox.body = 'box'\nall.system = true\n";
    let record = run("mpm", text, 4.0, 2);
    let momentum = ["x", "y", "z"].map(|axis| column(&record, &format!("all.angular_momentum_{axis}")));
    // Points at the centres of n parts of a side have 1 − 1/n² of the second moment of the side. The spacing is an
    // eighth of the shortest side.
    let [x, y, z] = [0.3_f64, 0.2, 0.1].map(|side| side * side - 0.0125 * 0.0125);
    let inertia = [y + z, x + z, x + y].map(|squares| 0.5 * squares);
    for (axis, spin) in [0.2, 10.0, 0.0].into_iter().enumerate() {
        let expected = inertia[axis] * spin;
        assert!((momentum[axis][0] - expected).abs() < 1e-12, "{:?} for {expected}", momentum[axis]);
        // The error of the angular momentum due to lumped mass is of second order in the ratio of cell to body. The
        // shortest side has four cells.
        let worst = momentum[axis].iter().map(|now| (now - momentum[axis][0]).abs()).fold(0.0, f64::max);
        assert!(worst < 0.5 / 64.0, "axis {axis}: {worst}");
    }
    let rotational = column(&record, "all.rotational_energy")[0];
    let expected = 0.5 * (inertia[0] * 0.2 * 0.2 + inertia[1] * 10.0 * 10.0);
    assert!((rotational / expected - 1.0).abs() < 1e-12, "{rotational} for {expected}");
    let kinetic = column(&record, "all.kinetic_energy");
    assert!(kinetic[0].abs() < 1e-12 * rotational && kinetic.iter().all(|&now| now > -1e-12), "{kinetic:?}");
    assert!((last(&record, "box.omega_y") / 10.0 - 1.0).abs() < 0.05);
}
