//! Claims that our solver in the contact convention of LAMMPS or LIGGGHTS gives the results of a stored or live run of
//! that program.

use crate::rows::on_plane::{DAMPING, at_overlap};
use grainbench_harness::compare::pointwise::worst;
use grainbench_harness::prelude::*;
use grainbench_scene::dimension::GrainShape;

/// Pairs of solvers: our solver in the contact convention of a program, and the program.
pub const PAIRS: [[&str; 2]; 2] = [["dem:lammps", "lammps"], ["dem:liggghts", "liggghts"]];

/// Time step for one grain on a plane: 1e-4 s.
const STEP: Resolution = Resolution::TimeStep(1e-4);

/// Returns the claim that our run (first) agrees with the run of LAMMPS or LIGGGHTS (second).
pub(crate) fn row(
    quantity: &str,
    unit: &'static str,
    tolerance: Tolerance,
    runs: [Run; 2],
    control: Control,
    measure: impl RunsReader<Measurement>,
) -> Claim {
    claim(format!("{quantity}, against {}", runs[1].solver), unit)
        .runs(runs)
        .agrees(Source::Program, measure)
        .within(tolerance)
        .refuses(control)
}

/// Returns the tolerance for rounding in two programs with the same integration cycle. `unit` states the unit of the error.
pub(crate) fn same_cycle(unit: &str) -> Tolerance {
    rounding(1.0, format!("rounding only, because both programs use the same integration cycle; {unit}"))
}

/// Returns the claims on the position of one grain on a plane over one second, undamped and damped. In the damped runs,
/// the conventions of LAMMPS and LIGGGHTS give different results.
#[must_use]
pub fn one_grain(variants: &[&'static str]) -> Vec<Claim> {
    let mut claims = Vec::new();
    for &variant in variants {
        for (pair, [other, _]) in PAIRS.into_iter().zip([PAIRS[1], PAIRS[0]]) {
            claims.push(on_a_plane(
                pair.map(|solver| at_overlap(variant, solver, 1e-3, 0.0, STEP)),
                "undamped",
                telling(),
            ));
            let other = Control::solver("ours in the convention of the other program", other);
            claims.push(on_a_plane(
                pair.map(|solver| at_overlap(variant, solver, 1e-3, DAMPING, STEP)),
                "damped",
                other,
            ));
        }
    }
    claims
}

/// Returns a negative control with a tangential stiffness 0.1 % too large. The stiffness affects when a grain starts to
/// slip and how a grain starts to roll.
fn telling() -> Control {
    Control::our_contact_law("tangential stiffness × 1.001 in ours", |law| law.scale_tangential(1.001))
}

fn on_a_plane(runs: [Run; 2], damping: &str, control: Control) -> Claim {
    let allowed = same_cycle("in units of R");
    row(&format!("position over 1 s, {damping}, worst"), "m", allowed, runs, control, |done| {
        let scene = &done[0].scene;
        let axes = if scene.dimension.count() == 2 { &["grain.x", "grain.y"][..] } else { &["grain.x", "grain.z"] };
        worst(done, axes, scene.grains[0].radius)
    })
}

/// Returns the claims on the coefficient of restitution of two grains: separation velocity divided by approach
/// velocity.
#[must_use]
pub fn restitution(variants: &[&'static str], resolution: Resolution) -> Vec<Claim> {
    fn restitution_coefficient(done: &FinishedRun) -> Result<f64, MissingData> {
        let grains = &done.scene.grains;
        Ok((done.last("b.vx")? - done.last("a.vx")?) / (grains[0].velocity.x - grains[1].velocity.x))
    }
    let mut claims = Vec::new();
    for &variant in variants {
        for pair in PAIRS {
            let runs = pair.map(|solver| Run::new(variant, solver, resolution));
            let control = Control::our_contact_law("damping ×1.001 in ours", |law| {
                law.normal_damping *= 1.001;
                law.stiffness_damping *= 1.001;
            });
            let allowed = same_cycle("in units of the approach velocity");
            claims.push(row("coefficient of restitution", "1", allowed, runs, control, |done| {
                Ok(Measurement::new(restitution_coefficient(&done[0])?, restitution_coefficient(&done[1])?, 1.0))
            }));
        }
    }
    claims
}

/// Replaces discs by spheres of the same mass in one layer, because LIGGGHTS moves walls inwards in three dimensions
/// only.
fn layer_of_spheres(scene: &mut Scene) {
    scene.grain_shape = GrainShape::Sphere;
    let factor = GrainShape::Sphere.inertia_factor();
    scene.grains.iter_mut().for_each(|grain| grain.inertia = factor * grain.mass * grain.radius * grain.radius);
}

/// Returns the run of discs that is compared with a program: for LIGGGHTS a run of one layer of spheres.
pub(crate) fn discs_for(program: &str, run: Run) -> Run {
    if program == "liggghts" { run.adjusted("one layer of spheres", layer_of_spheres) } else { run }
}

/// Returns a negative control with a stiffness 1e-6 too large.
pub(crate) fn stiffer() -> Control {
    Control::our_contact_law("stiffness off by 1e-6 in ours", |law| law.scale_normal(1.0 + 1e-6))
}

/// Columns of the nine-discs case with the compared positions.
const NINE_DISCS: [&str; 4] = ["edge.x", "edge.y", "corner.x", "corner.y"];

/// Returns the claims on the positions of the nine discs over all cycles. `travel` returns the unit of the error (m),
/// and `rounded` the rounding tolerance for a variant.
#[must_use]
pub fn nine_discs(
    variants: &[&'static str],
    resolution: Resolution,
    travel: fn(&FinishedRun) -> f64,
    rounded: fn(&str) -> Tolerance,
) -> Vec<Claim> {
    let mut claims = Vec::new();
    for &variant in variants {
        for pair in PAIRS {
            let runs = pair.map(|solver| discs_for(pair[1], Run::new(variant, solver, resolution)));
            let quantity = "position over all cycles, worst";
            claims.push(row(quantity, "m", rounded(variant), runs, stiffer(), move |done| {
                worst(done, &NINE_DISCS, travel(&done[0]))
            }));
        }
    }
    claims
}

/// Returns the claims on the positions of the nine discs while the walls rotate. The runs are undamped for two reasons:
/// LAMMPS and LIGGGHTS have no mass-proportional damping, and a damped contact of LIGGGHTS depends on where one `run`
/// command ends and the next begins. `places` is the largest position, divided by the travel of the walls.
#[must_use]
pub fn turning_walls(
    variant: &'static str,
    resolution: Resolution,
    travel: fn(&FinishedRun) -> f64,
    places: f64,
) -> Vec<Claim> {
    fn undamped(scene: &mut Scene) {
        scene.global_damping = 0.0;
        scene.change_laws(|law| law.stiffness_damping = 0.0);
    }
    let wall_row = |pair: [&'static str; 2]| {
        let runs = pair.map(|solver| {
            let run = Run::new(variant, solver, resolution);
            if pair[1] == "liggghts" {
                run.adjusted("undamped, one layer of spheres", |scene| {
                    undamped(scene);
                    layer_of_spheres(scene);
                })
            } else {
                run.adjusted("undamped", undamped)
            }
        });
        let control = Control::ours("walls that turn faster by 1e-6 in ours", |scene| {
            scene.walls.iter_mut().flat_map(|wall| &mut wall.motion.phases).for_each(|phase| phase.spin *= 1.0 + 1e-6);
        });
        let allowed = rounding(
            places,
            "rounding only, because both programs use the same integration cycle: sliding \
                                        contacts preserve the rounding of positions up to 3R",
        );
        row("position while the walls turn, worst", "m", allowed, runs, control, move |done| {
            worst(done, &NINE_DISCS, travel(&done[0]))
        })
    };
    PAIRS.map(wall_row).to_vec()
}

/// Returns the claims on the velocity of a Hertz sphere during an impact. If `turns` is true, they include the spin.
#[must_use]
pub fn hertz_impact(variant: &'static str, resolution: Resolution, turns: bool) -> Vec<Claim> {
    let mut claims = Vec::new();
    for pair in PAIRS {
        let allowed = same_cycle("relative to the velocity before");
        let runs = || pair.map(|solver| Run::new(variant, solver, resolution));
        let control = Control::our_contact_law("E* × 1.00001 in ours", |law| law.scale_normal(1.00001));
        claims.push(row("velocity over the impact, worst", "m/s", allowed, runs(), control, |done| {
            worst(done, &["a.vx", "a.vz"], done[0].scene.grains[0].velocity.norm())
        }));
        if turns {
            let allowed = same_cycle("relative to the velocity before over the radius");
            let control = Control::our_contact_law("G* × 1.00001 in ours", |law| law.scale_tangential(1.00001));
            claims.push(row("spin over the impact, worst", "rad/s", allowed, runs(), control, |done| {
                let grain = &done[0].scene.grains[0];
                worst(done, &["a.omega_y"], grain.velocity.norm() / grain.radius)
            }));
        }
    }
    claims
}

/// Returns the claims on the position of a grain that rolls to rest on a flat plane, in units of R = 1 m. `ahead` is
/// the tolerance for LIGGGHTS.
#[must_use]
pub fn rolling(variant: &'static str, step: Resolution, ahead: &Tolerance) -> Vec<Claim> {
    let rolling_rows = |pair: [&'static str; 2]| {
        let same = same_cycle("in units of R");
        let allowed = if pair[1] == "lammps" { same } else { ahead.clone() };
        let runs = pair.map(|solver| Run::new(variant, solver, step));
        let control =
            Control::our_contact_law("rolling resistance × 1.00001 in ours", |law| law.rolling_friction *= 1.00001);
        row("position over 1 s, worst", "m", allowed, runs, control, |done| worst(done, &["grain.x"], 1.0))
    };
    PAIRS.map(rolling_rows).to_vec()
}

/// Returns the claim on a grain that starts from rest on a slope, with a damped rolling spring, against LIGGGHTS.
/// `tilted` returns the run of each solver.
#[must_use]
pub fn rolling_off(tilted: impl Fn(&'static str) -> Run) -> Claim {
    let allowed = same_cycle("in units of R");
    let runs = PAIRS[1].map(tilted);
    let control = Control::our_contact_law("the dashpot of the rolling spring × .999 in ours", |law| {
        law.rolling_damping *= 0.999
    });
    row("position over 4 s, worst", "m", allowed, runs, control, |done| worst(done, &["grain.x"], 1.0))
}

/// Returns the claims on the velocity of one grain that hits a wall and on the force on the wall. Velocities are in
/// units of the initial speed, and forces in units of the largest spring force.
#[must_use]
pub fn impact(variants: &[&'static str], resolution: Resolution) -> Vec<Claim> {
    let mut claims = Vec::new();
    for &variant in variants {
        for pair in PAIRS {
            let allowed = same_cycle("relative to the velocity before");
            let control = Control::our_contact_law("friction ×1.001 in ours", |law| law.friction *= 1.001);
            let runs = pair.map(|solver| Run::new(variant, solver, resolution));
            claims.push(row("velocity over the impact, worst", "m/s", allowed, runs, control.clone(), |done| {
                worst(done, &["grain.vx", "grain.vy"], done[0].scene.grains[0].velocity.norm())
            }));
            let allowed = same_cycle("relative to the largest force of the spring, v√(km)");
            let runs = pair.map(|solver| Run::new(variant, solver, resolution));
            claims.push(row("force on the wall, worst", "N", allowed, runs, control, |done| {
                let (grain, law) = (&done[0].scene.grains[0], done[0].scene.laws[0].unwrap_or_default());
                let largest = grain.velocity.y.abs() * (law.normal_stiffness() * grain.mass).sqrt();
                worst(done, &["wall.force_x", "wall.force_y"], largest)
            }));
        }
    }
    claims
}
