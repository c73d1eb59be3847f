//! Assemblies with exactly known largest stable time steps. Grains have unit mass and contacts unit stiffness, so that
//! time steps are in units of √(m/k).
//!
//! Central differences are stable up to Δt = 2/ω, where ω is the highest angular frequency. Every assembly except the
//! free pair is compressed, so that no contact opens. Each degree of freedom is perturbed at random by up to a
//! millionth of the overlap, because a symmetric start never excites the critical mode. A run is unstable if a
//! displacement (m) or a spin (rad/s) exceeds 1000 times this amplitude. In the table, κ = k_s/k_n is the ratio of
//! tangential to normal stiffness, and I is the moment of inertia:
//!
//! ```text
//! grain on a wall     ω² = k/m; with a tangential spring κk that does not slip also κ(k/m)(1 + 1/i), i = I/(mR²)
//! free pair           ω² = 2k/m
//! long chain          ω² = 4k/m
//! square lattice      ω² = 4k/m; without slip max(4 + 4κ, 16κ) k/m for discs
//! two discs, squashed ω² = 3k/m
//! nine discs in a box the largest eigenvalue of 27 equations: 2/ω = 1.08239, .65402, .53418 for κ = 0, 2/3, 1
//! ```
//!
//! A free pair starts at rest with overlap δ. Near its limit, 2/ω = √2, it separates within two steps. In central
//! differences ½v²(1 − ω²Δt²/4) ≤ ½ω²δ²(1 − ω²Δt²/4) holds at the step of separation. The pair therefore separates with
//! more energy than its spring stored if and only if Δt > 2/ω.

use super::failure::{Failure, finite};
use grainbench_scene::error::SceneError;
use grainbench_scene::scene::{Duration, Sampling, Scene};
use grainbench_solver::record::Record;
use nalgebra::Vector3;
use std::f64::consts::SQRT_2;
use std::fmt::Write as _;

/// Overlap of every contact (m). All radii are 1 m.
const OVERLAP: f64 = 1e-5;
/// Largest perturbation of a degree of freedom (m).
const PERTURBATION: f64 = 1e-6 * OVERLAP;
/// Ratio of a displacement to the largest perturbation above which a run counts as unstable.
const GROWTH: f64 = 1000.0;
/// Number of steps. If the time step exceeds the limit by a small fraction ε, a perturbation grows by a factor of 1 +
/// √(8ε) per step.
///
/// In a compressed lattice without friction, rows always slide off each other, at a rate of about √(overlap/R · k/m).
/// Within 400 steps this is negligible.
const STEPS: u64 = 400;
/// Number of steps of a free pair, within which it separates.
const APART: u64 = 60;

/// Criterion of instability.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Judge {
    Growth,
    /// Kinetic energy after separation.
    Energy,
}

/// Assembly of grains whose largest stable time step is measured.
#[derive(Clone, Debug)]
pub struct Assembly {
    /// Name in tables, such as `square lattice of discs`.
    pub name: &'static str,
    /// Ratio κ = k_s/k_n of contacts that do not slip; `None` for frictionless assemblies in which κ is not varied.
    pub kappa: Option<f64>,
    /// Exact limit of the time step (√(m/k)).
    pub exact: f64,
    /// Scene with perturbed grains.
    pub scene: Scene,
    /// Equilibrium positions of the grains (m).
    rest: Vec<Vector3<f64>>,
    judge: Judge,
}

impl Assembly {
    /// Checks that a run of the assembly was stable.
    ///
    /// # Errors
    /// The kind of failure if the run was unstable.
    pub fn judge(&self, record: &Record) -> Result<(), Failure> {
        record.snapshots.iter().try_for_each(finite)?;
        match self.judge {
            Judge::Energy => {
                let Some(last) = record.snapshots.last() else { return Err(Failure::NotFinite) };
                let kinetic: f64 =
                    last.grains.iter().map(|grain| 0.5 * grain.mass * grain.velocity.norm_squared()).sum();
                let held = 0.5 * OVERLAP * OVERLAP;
                if kinetic > held * (1.0 + 1e-6) { Err(Failure::Growth(kinetic / held)) } else { Ok(()) }
            }
            Judge::Growth => {
                let grains = record.snapshots.iter().flat_map(|snapshot| &snapshot.grains);
                let away = |grain: &grainbench_solver::record::GrainState| {
                    let moved = self.nearest_image(grain.position - self.rest[grain.id as usize - 1]);
                    moved.norm().max(grain.spin.norm())
                };
                let farthest = grains.map(away).fold(0.0, f64::max);
                if farthest > GROWTH * PERTURBATION { Err(Failure::Growth(farthest / PERTURBATION)) } else { Ok(()) }
            }
        }
    }

    /// Returns the minimum image of a displacement (m) in a periodic domain.
    fn nearest_image(&self, mut way: Vector3<f64>) -> Vector3<f64> {
        if let Some(domain) = self.scene.domain {
            for axis in (0..3).filter(|&axis| domain.periodic[axis]) {
                let length = domain.high[axis] - domain.low[axis];
                way[axis] -= length * (way[axis] / length).round();
            }
        }
        way
    }
}

/// Returns all assemblies.
///
/// # Errors
/// When a scene cannot be read, which occurs only if the scene format has changed.
pub fn all() -> Result<Vec<Assembly>, SceneError> {
    let mut all = Vec::new();
    // The limits of discs on a wall and in the lattice have a kink at κ = 1/3.
    for kappa in [0.0, 0.1, 0.2, 2.0 / 7.0, 1.0 / 3.0, 0.5, 2.0 / 3.0, 1.0, 1.5, 2.0] {
        all.push(on_a_wall(kappa)?);
        all.push(lattice(kappa)?);
    }
    all.push(sphere_on_a_wall()?);
    all.push(pair()?);
    all.push(chain()?);
    all.push(squash()?);
    for (kappa, exact) in [(0.0, 1.082_392_2), (2.0 / 3.0, 0.654_02), (1.0, 0.534_18)] {
        all.push(nine_discs(kappa, exact)?);
    }
    Ok(all)
}

/// Returns the first part of a scene file with discs or spheres of unit mass.
fn head(dimension: u32, kappa: f64) -> String {
    let density = if dimension == 2 { std::f64::consts::FRAC_1_PI } else { 0.75 * std::f64::consts::FRAC_1_PI };
    // The friction coefficient is so high that no contact slips.
    let friction = match kappa > 0.0 {
        true => format!("contacts.m.tangential_stiffness = {kappa:?}\ncontacts.m.friction = 100.0\n"),
        false => String::new(),
    };
    format!(
        "title = 'An assembly'\ndimension = {dimension}\nduration_cycles = {STEPS}\nmaterials.m.density = {density:?}\n\
         contacts.m.between = ['m', 'm']\ncontacts.m.normal_stiffness = 1.0\n{friction}"
    )
}

/// Adds a disc of material `m` to the text of a scene file.
pub(super) fn grain(text: &mut String, number: usize, radius: f64, [x, y]: [f64; 2]) {
    let _ = write!(text, "[grains.g{number}]\nmaterial = 'm'\nradius = {radius:?}\nposition = [{x:?}, {y:?}]\n");
}

/// Adds a plane of material `m` to the text of a scene file.
pub(super) fn wall(text: &mut String, name: &str, point: [f64; 2], normal: [f64; 2]) {
    let _ = write!(text, "[walls.{name}]\nmaterial = 'm'\nplane = {{ point = {point:?}, normal = {normal:?} }}\n");
}

fn finish(
    name: &'static str,
    kappa: Option<f64>,
    exact: f64,
    text: &str,
    judge: Judge,
) -> Result<Assembly, SceneError> {
    let mut scene = Scene::from_text(&format!("stability/{name}"), text)?;
    scene.sampling = Sampling::Count(1);
    scene.snapshots = 20;
    let rest = scene.grains.iter().map(|grain| grain.position).collect();
    match judge {
        Judge::Growth => perturb(&mut scene, kappa.unwrap_or(0.0) > 0.0),
        Judge::Energy => scene.duration = Duration::Cycles(APART),
    }
    Ok(Assembly { name, kappa, exact, scene, rest, judge })
}

/// Displaces every grain by a random part of the perturbation. If rotation matters, also gives it a random spin of at
/// most `PERTURBATION`.
///
/// Grains in a row are displaced only along x, because the row would buckle otherwise.
fn perturb(scene: &mut Scene, turns: bool) {
    let mut dice = dice();
    let row = scene.grains.len() > 1 && scene.grains.iter().all(|grain| grain.position.y == scene.grains[0].position.y);
    let dimensions = scene.dimension.count();
    for grain in scene.grains.iter_mut() {
        for axis in 0..if row { 1 } else { dimensions } {
            grain.position[axis] += PERTURBATION * dice();
        }
        if turns && dimensions == 2 {
            grain.spin.z = PERTURBATION * dice();
        } else if turns {
            grain.spin.y = PERTURBATION * dice();
        }
    }
}

/// Returns a linear congruential generator of numbers from −1 to 1.
pub(crate) fn dice() -> impl FnMut() -> f64 {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        2.0 * (state >> 11) as f64 / (1_u64 << 53) as f64 - 1.0
    }
}

fn on_a_wall(kappa: f64) -> Result<Assembly, SceneError> {
    let mut text = format!("gravity = [0.0, {:?}]\n", -OVERLAP) + &head(2, kappa);
    grain(&mut text, 1, 1.0, [0.0, 1.0 - OVERLAP]);
    wall(&mut text, "floor", [0.0, 0.0], [0.0, 1.0]);
    let exact = if kappa > 0.0 { 2.0_f64.min(2.0 / (3.0 * kappa).sqrt()) } else { 2.0 };
    finish("disc on a wall", Some(kappa), exact, &text, Judge::Growth)
}

fn sphere_on_a_wall() -> Result<Assembly, SceneError> {
    let text = format!("gravity = [0.0, 0.0, {:?}]\n", -OVERLAP)
        + &head(3, 1.0)
        + &format!("[grains.g1]\nmaterial = 'm'\nradius = 1.0\nposition = [0.0, 0.0, {:?}]\n", 1.0 - OVERLAP)
        + "[walls.floor]\nmaterial = 'm'\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n";
    finish("sphere on a wall", Some(1.0), 2.0 / 3.5_f64.sqrt(), &text, Judge::Growth)
}

fn pair() -> Result<Assembly, SceneError> {
    let mut text = head(2, 0.0);
    grain(&mut text, 1, 1.0, [0.0, 0.0]);
    grain(&mut text, 2, 1.0, [2.0 - OVERLAP, 0.0]);
    finish("free pair", None, SQRT_2, &text, Judge::Energy)
}

/// Returns a periodic row of 64 grains. The number is even, so that neighbours can move in opposite directions.
fn chain() -> Result<Assembly, SceneError> {
    const COUNT: usize = 64;
    let spacing = 2.0 - OVERLAP;
    let length = COUNT as f64 * spacing;
    let mut text = format!("domain = {{ low = [0.0, -4.0], high = [{length:?}, 4.0], periodic = [true, false] }}\n")
        + &head(2, 0.0);
    for at in 0..COUNT {
        grain(&mut text, at + 1, 1.0, [(at as f64 + 0.5) * spacing, 0.0]);
    }
    finish("long chain", None, 1.0, &text, Judge::Growth)
}

fn lattice(kappa: f64) -> Result<Assembly, SceneError> {
    const COUNT: usize = 6;
    let spacing = 2.0 - OVERLAP;
    let length = COUNT as f64 * spacing;
    let mut text =
        format!("domain = {{ low = [0.0, 0.0], high = [{length:?}, {length:?}], periodic = [true, true] }}\n")
            + &head(2, kappa);
    for at in 0..COUNT * COUNT {
        grain(&mut text, at + 1, 1.0, [((at % COUNT) as f64 + 0.5) * spacing, ((at / COUNT) as f64 + 0.5) * spacing]);
    }
    let exact = 2.0 / (4.0 + 4.0 * kappa).max(16.0 * kappa).sqrt();
    finish("square lattice of discs", Some(kappa), exact, &text, Judge::Growth)
}

fn squash() -> Result<Assembly, SceneError> {
    let mut text = head(2, 0.0);
    grain(&mut text, 1, 1.0, [1.0 - OVERLAP, 0.0]);
    grain(&mut text, 2, 1.0, [3.0 - 2.0 * OVERLAP, 0.0]);
    wall(&mut text, "left", [0.0, 0.0], [1.0, 0.0]);
    wall(&mut text, "right", [4.0 - 3.0 * OVERLAP, 0.0], [-1.0, 0.0]);
    finish("two discs between walls", None, 2.0 / 3.0_f64.sqrt(), &text, Judge::Growth)
}

fn nine_discs(kappa: f64, exact: f64) -> Result<Assembly, SceneError> {
    let mut text = head(2, kappa);
    let place = |at: usize| (at as f64 - 1.0) * (2.0 - OVERLAP);
    for at in 0..9 {
        grain(&mut text, at + 1, 1.0, [place(at % 3), place(at / 3)]);
    }
    let reach = 3.0 - 2.0 * OVERLAP;
    wall(&mut text, "left", [-reach, 0.0], [1.0, 0.0]);
    wall(&mut text, "right", [reach, 0.0], [-1.0, 0.0]);
    wall(&mut text, "bottom", [0.0, -reach], [0.0, 1.0]);
    wall(&mut text, "top", [0.0, reach], [0.0, -1.0]);
    finish("nine discs in a box", Some(kappa), exact, &text, Judge::Growth)
}
