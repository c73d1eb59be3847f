//! Extreme ratios of mass, size, stiffness and damping, and extreme units.

use super::{HardCase, case, end, head_on, kinetic, kinetic_at_start, near};
use crate::stability::failure::Failure;
use grainbench_scene::error::SceneError;
use grainbench_scene::scene::Scene;
use grainbench_solver::record::Record;

/// Returns the scene of an elastic head-on impact of two discs. The stiffness makes the largest overlap 1 % of the smaller
/// radius. The duration is three times the time of approach and contact.
fn impact([a, b]: [f64; 2], [first, second]: [f64; 2], length: f64) -> String {
    let speed = length;
    let mass = |radius: f64, density: f64| density * std::f64::consts::PI * (radius * length).powi(2);
    let reduced = 1.0 / (1.0 / mass(a, first) + 1.0 / mass(b, second));
    let overlap = 0.01 * a.min(b) * length;
    let stiffness = reduced * (speed / overlap).powi(2);
    let gap = 0.02 * a.min(b) * length;
    let duration = 3.0 * (gap / speed + std::f64::consts::PI * (reduced / stiffness).sqrt());
    // The moduli are so high that waves cross each grain in a hundredth of the time in which the smaller grain
    // moves by its radius. Otherwise a grain could leave before the other grain is in equilibrium. Waves would
    // remain in the other grain, and the velocities would differ from those of point masses.
    let modulus = |radius: f64, density: f64| 1e4 * density * (speed * radius / a.min(b)).powi(2);
    let (stiff_first, stiff_second) = (modulus(a, first), modulus(b, second));
    format!(
        "title = 'Head-on'\ndimension = 2\nduration = {duration:?}\n\
         [materials.a]\ndensity = {first:?}\nyoung_modulus = {stiff_first:?}\npoisson_ratio = 0.3\n\
         [materials.b]\ndensity = {second:?}\nyoung_modulus = {stiff_second:?}\npoisson_ratio = 0.3\n\
         [contacts.aa]\nbetween = ['a', 'a']\nnormal_stiffness = {stiffness:?}\n\
         [contacts.ab]\nbetween = ['a', 'b']\nnormal_stiffness = {stiffness:?}\n\
         [contacts.bb]\nbetween = ['b', 'b']\nnormal_stiffness = {stiffness:?}\n\
         [grains.a]\nmaterial = 'a'\nradius = {:?}\nposition = [0.0, 0.0]\nvelocity = [{speed:?}, 0.0]\n\
         [grains.b]\nmaterial = 'b'\nradius = {:?}\nposition = [{:?}, 0.0]\n[output]\nevery = {duration:?}\n\
         [probes]\nall = {{ system = true }}\n",
        a * length,
        b * length,
        (a + b) * length + gap,
    )
}

pub(super) fn cases() -> Result<Vec<HardCase>, SceneError> {
    const MOMENTA: &str = "after an elastic head-on impact both velocities agree with those of two point masses, \
         within 3 % of the approach speed";
    let mut cases = Vec::new();
    for (exponent, ratio) in [("1e-6", 1e-6), ("1e-3", 1e-3), ("1e3", 1e3), ("1e6", 1e6)] {
        let text = impact([1.0, 1.0], [1e3, 1e3 * ratio], 1.0);
        cases.push(case(format!("mass-ratio-{exponent}"), MOMENTA, &text, head_on)?);
    }
    cases.push(case("size-ratio-100", MOMENTA, &impact([1.0, 0.01], [1e3, 1e3], 1.0), head_on)?);
    for (name, length) in [("units-1e-9", 1e-9), ("units-1e9", 1e9)] {
        cases.push(case(name, MOMENTA, &impact([1.0, 0.8], [1e3, 1e3], length), head_on)?);
    }
    cases.push(case(
        "stiffness-ratio-1e4",
        "momentum is conserved to 1e-9 and energy to 1 % in a row of three discs whose contacts differ in stiffness by \
         the factor 1e4",
        STIFFNESS,
        three_in_a_row,
    )?);
    for ratio in [0.9, 1.0, 1.5, 10.0] {
        let must = "two discs separate with at most 20 % of their approach speed";
        cases.push(case(format!("damping-{ratio}-of-critical"), must, &damped(ratio), damped_impact)?);
    }
    cases.push(case(
        "high-spin",
        "a disc with a surface speed of 1e4 √(gR) is accelerated forwards by friction and gains no energy",
        SPIN,
        spin,
    )?);
    Ok(cases)
}

const STIFFNESS: &str = "title = 'Three in a row'\ndimension = 2\nduration = 0.5\n\
    [materials.soft]\ndensity = 1000.0\n[materials.hard]\ndensity = 1000.0\n\
    [contacts.ss]\nbetween = ['soft', 'soft']\nnormal_stiffness = 1.0e6\n\
    [contacts.sh]\nbetween = ['soft', 'hard']\nnormal_stiffness = 1.0e6\n\
    [contacts.hh]\nbetween = ['hard', 'hard']\nnormal_stiffness = 1.0e10\n\
    [grains.a]\nmaterial = 'soft'\nradius = 0.5\nposition = [0.0, 0.0]\nvelocity = [1.0, 0.0]\n\
    [grains.b]\nmaterial = 'hard'\nradius = 0.5\nposition = [1.01, 0.0]\n\
    [grains.c]\nmaterial = 'hard'\nradius = 0.5\nposition = [2.02, 0.0]\n\
    [output]\nevery = 0.5\n[probes]\nall = { system = true }\n";

fn three_in_a_row(scene: &Scene, record: &Record) -> Result<(), Failure> {
    let grains = end(record);
    let (before, after) = (kinetic_at_start(scene), kinetic(grains, scene));
    let momentum: f64 = grains.iter().map(|grain| grain.mass * grain.velocity.x).sum();
    let start: f64 = scene.grains.iter().map(|grain| grain.mass * grain.velocity.x).sum();
    near("momentum", momentum, start, 1e-9 * start)?;
    near("energy", after, before, 0.01 * before)
}

/// Returns the scene of two discs of unit mass with the damping ratio ζ = `ratio`. The dashpot has γ_n = 2ζ√(k/m*),
/// with the reduced mass m* = 1/2 and k = 1e4.
fn damped(ratio: f64) -> String {
    format!(
        "title = 'Damped impact'\ndimension = 2\nduration = 2.0\nmaterials.m.density = {:?}\n\
         [contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1.0e4\nnormal_damping = {:?}\n\
         [grains.a]\nmaterial = 'm'\nradius = 1.0\nposition = [-1.001, 0.0]\nvelocity = [1.0, 0.0]\n\
         [grains.b]\nmaterial = 'm'\nradius = 1.0\nposition = [1.001, 0.0]\nvelocity = [-1.0, 0.0]\n\
         [output]\nevery = 2.0\n[probes]\nall = {{ system = true }}\n",
        std::f64::consts::FRAC_1_PI,
        2.0 * ratio * 2e4_f64.sqrt()
    )
}

fn damped_impact(_scene: &Scene, record: &Record) -> Result<(), Failure> {
    let grains = end(record);
    let parting = grains[1].velocity.x - grains[0].velocity.x;
    near("speed of parting over that of approach", 0.5 * parting, 0.0, 0.2)?;
    if grains[1].position.x - grains[0].position.x < 1.9 {
        return Err(Failure::Freeze("they stay in each other".to_owned()));
    }
    Ok(())
}

const SPIN: &str = "title = 'High spin'\ndimension = 2\ngravity = [0.0, -10.0]\nduration = 0.5\n\
    [materials.m]\ndensity = 1000.0\n\
    [contacts.m]\nbetween = ['m', 'm']\nnormal_stiffness = 1.0e8\ntangential_stiffness = 2.857142857e7\nfriction = 0.5\n\
    normal_damping = 100.0\n\
    [grains.a]\nmaterial = 'm'\nradius = 1.0\nposition = [0.0, 1.0]\nspin = -31622.0\n\
    [walls.floor]\nmaterial = 'm'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n\
    [output]\nevery = 0.5\n[probes]\na = { grain = 'a' }\n";

/// Checks velocity, height and energy of the disc. The disc slides during the whole run, so v = μgt.
fn spin(scene: &Scene, record: &Record) -> Result<(), Failure> {
    let grains = end(record);
    near("velocity", grains[0].velocity.x, 0.5 * 10.0 * 0.5, 0.05)?;
    near("height", grains[0].position.y, 1.0, 0.01)?;
    let (before, after) = (kinetic_at_start(scene), kinetic(grains, scene));
    if after > before { Err(Failure::Growth(after / before)) } else { Ok(()) }
}
