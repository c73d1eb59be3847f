//! Conservation laws and invariances of deformable grains, for a coarse slab with small shear.

use super::measures::{deviator_squared, mean_stress, plastic_strain, with_their_start};
use super::paper::FIGURE_6;
use super::{entry, gained, grid, measures, momentum, sheared, to_shear};
use crate::rows::elastic::stiffen;
use grainbench_harness::prelude::*;

/// Number of cells across the slab.
const CELLS: f64 = 75.0;
/// Mean shear of the coarse slab.
const SHEAR: f64 = 0.08;
/// Number of steps to [`SHEAR`]. In a step, a wave of 3356 m/s travels 0.4 of a cell. The side moves at 100 m/s.
const STEPS: f64 = SHEAR * CELLS * 3356.0 / (0.4 * 100.0);
/// Mean shear at which two slabs that must agree are compared.
const BEGINNING: f64 = 0.01;
/// Shift of all grains in periods: 25 cells, so the grains keep their positions relative to the grid.
const MOVED: f64 = 1.0 / 3.0;

pub(super) const MAKES_ENERGY: &str = "the 2000 criterion ends contact on separation, which adds energy if grains \
                                       vibrate in contact: plastic and elastic energy exceed the work of the walls \
                                       from 1 % shear on";

fn slab(solver: &'static str) -> Run {
    to_shear(Run::new("seed-1", solver, grid(CELLS)), SHEAR, 0).slow()
}

/// Returns material, yield stress and hardening modulus (Pa) of the case's scene, also under a control.
fn yielding(done: &FinishedRun) -> Result<(Deformable, f64, f64), MissingData> {
    let deformable = done.scene.deformable.first().copied().flatten();
    match deformable.map(|deformable| (deformable, deformable.constitutive)) {
        Some((deformable, Constitutive::VonMises { yield_stress, hardening_modulus })) => {
            Ok((deformable, yield_stress, hardening_modulus))
        }
        _ => Err("yield stress in its scene".into()),
    }
}

/// Returns a change of the material of all deformable grains.
fn made_of(change: impl Fn(&mut Deformable) + Copy) -> impl Fn(&mut Scene) + Copy {
    move |scene| scene.deformable.iter_mut().flatten().for_each(change)
}

/// Returns a change that also shortens the run to 0.4 of its duration. Its effect is visible long before.
fn early(change: impl Fn(&mut Scene) + Send + Sync + 'static) -> impl Fn(&mut Scene) + Send + Sync + 'static {
    move |scene| {
        change(scene);
        if let Duration::Seconds(time) = &mut scene.duration {
            *time *= 0.4;
        }
    }
}

fn with_yield(
    change: impl Fn(&mut f64, &mut f64) + Copy + Send + Sync + 'static,
) -> impl Fn(&mut Scene) + Send + Sync + 'static {
    made_of(move |deformable: &mut Deformable| {
        if let Constitutive::VonMises { yield_stress, hardening_modulus } = &mut deformable.constitutive {
            change(yield_stress, hardening_modulus);
        }
    })
}

/// Compares the sum of all energies with the work of the walls, in units of this work. Elastic and plastic energy
/// follow from the state of each point and the scene: s:s/4G + σ_m²/2K and Y ε_p + H ε_p²/2 per volume.
fn unaccounted(done: &FinishedRun) -> Result<Measurement, MissingData> {
    let (deformable, yield_stress, hardening) = yielding(done)?;
    let snapshot = measures::end(done)?;
    let (mut elastic, mut plastic) = (0.0, 0.0);
    for point in &snapshot.points {
        let strain = point.plastic_strain;
        elastic += point.volume
            * (deviator_squared(point) / (4.0 * deformable.shear_modulus)
                + mean_stress(point).powi(2) / (2.0 * deformable.bulk_modulus));
        plastic += point.volume * (yield_stress * strain + 0.5 * hardening * strain * strain);
    }
    if snapshot.points.is_empty() {
        return Err("material points".into());
    }
    let work = entry(done, "work")?;
    let mut sum = elastic + plastic + gained(done, "kinetic")?;
    for name in ["springs", "friction", "transfer", "contact"] {
        sum += entry(done, name)?;
    }
    Ok(Measurement::new(sum - work, 0.0, work))
}

pub(super) fn accounted(quantity: &str, run: Run, allowed: f64, control: Control) -> Claim {
    claim(quantity, "J")
        .run(run)
        .holds("conservation of energy", |done| unaccounted(&done[0]))
        .within(judged(
            allowed,
            "stress and elastic energy agree to second order in the step; relative to the work of the walls",
        ))
        .refuses(control)
}

pub(super) fn makes_none(shear: &str, run: Run, control: Control) -> Claim {
    claim(format!("kinetic, elastic and plastic energy over the work of the walls, {shear}"), "1")
        .run(run)
        .holds("conservation of energy: stored and dissipated energy do not exceed the work", |done| {
            let budget_entry = |name| entry(&done[0], name);
            let kept = (gained(&done[0], "kinetic")? + budget_entry("elastic")? + budget_entry("plastic")?)
                / budget_entry("work")?;
            Ok(Measurement::new(kept, ExpectedValue::Bound(Bound::AtMost(1.0)), 1.0))
        })
        .within(required(
            0.01,
            "a hundredth was required before the solver was written; friction is accounted for separately",
        ))
        .refuses(control)
}

/// Returns the largest and the mean overlap of contacts at the end, in cells of this slab.
fn overlaps(done: &FinishedRun) -> Result<[f64; 2], MissingData> {
    let cell = measures::width(done) / CELLS;
    let overlaps: Vec<f64> =
        measures::end(done)?.told_contacts().iter().map(|contact| contact.overlap / cell).collect();
    if overlaps.is_empty() {
        return Err("contacts".into());
    }
    Ok([overlaps.iter().copied().fold(0.0, f64::max), overlaps.iter().sum::<f64>() / overlaps.len() as f64])
}

/// Returns the largest ratio of shear to normal force, over grain contacts with more than the mean normal force.
fn steepest(done: &FinishedRun) -> Result<f64, MissingData> {
    let contacts = measures::end(done)?.told_contacts();
    let between = contacts.iter().filter(|contact| matches!(contact.partner, Partner::Grain(_)));
    let mean = contacts.iter().map(|contact| contact.normal_force).sum::<f64>() / contacts.len() as f64;
    let steep = between.filter(|contact| contact.normal_force > mean);
    let steepest = steep.map(|contact| contact.shear_force.norm() / contact.normal_force).reduce(f64::max);
    steepest.ok_or_else(|| "contacts between grains".into())
}

/// Returns the largest ratio of von Mises stress to flow stress Y + H ε_p, over points with ε_p above 0.01.
fn on_the_yield_surface(done: &FinishedRun) -> Result<f64, MissingData> {
    let (_, yield_stress, hardening) = yielding(done)?;
    let flowed = measures::end(done)?.points.iter().filter(|point| point.plastic_strain > 0.01);
    let ratio =
        flowed.map(|point| (1.5 * deviator_squared(point)).sqrt() / (yield_stress + hardening * point.plastic_strain));
    ratio.reduce(f64::max).ok_or_else(|| "points that have flowed".into())
}

/// Returns the mean over the points of the volume change that the pressure does not explain, |ln J − σ_m/K| with J =
/// V/V₀. Plastic flow does not change the volume, so this mean should vanish.
fn volume(done: &FinishedRun) -> Result<f64, MissingData> {
    let (deformable, ..) = yielding(done)?;
    let points = with_their_start(done, measures::end(done)?)?;
    let off = points
        .iter()
        .map(|(now, start)| ((now.volume / start.volume).ln() - mean_stress(now) / deformable.bulk_modulus).abs());
    Ok(off.sum::<f64>() / points.len() as f64)
}

/// Moves all grains along the periodic axis by [`MOVED`] periods.
fn moved(scene: &mut Scene) {
    let Some(domain) = scene.domain else { return };
    let (low, length) = (domain.low.y, domain.high.y - domain.low.y);
    for grain in scene.grains.iter_mut() {
        grain.position.y = low + (grain.position.y + MOVED * length - low).rem_euclid(length);
    }
}

/// Returns the mean plastic strain of the free grains at the end.
fn yielded(done: &FinishedRun) -> Result<f64, MissingData> {
    Ok(plastic_strain(done, measures::end(done)?))
}

pub(super) fn claims() -> Vec<Claim> {
    let makes_energy = || Control::solver("contact on approach (2000), which makes energy", "mpm:2000");
    let percent = format!("{:.0} % shear", 100.0 * SHEAR);
    let half = Control::scene("half the yield stress", early(with_yield(|yield_stress, _| *yield_stress *= 0.5)));
    let springs = Control::without_the_error("springs between surfaces", "mpm", grid(CELLS));
    let mut claims = vec![
        accounted(&format!("where the work of the walls went, {percent}"), slab("mpm"), 0.02, half),
        makes_none(&percent, slab("mpm"), makes_energy()),
        makes_none(&percent, slab("mpm:2000").known(MAKES_ENERGY).up_to(1.0), springs),
        claim(format!("momentum less the impulse of the driven grains, {percent}, worst"), "N s")
            .run(slab("mpm"))
            .holds("equal and opposite impulses", |done| momentum(&done[0]))
            .within(judged(1e-10, "rounding, relative to the largest impulse"))
            .refuses(Control::solver("each body against its own normal (2000)", "mpm:2000")),
        claim(
            format!(
                "energy lost between points and nodes and at contacts, by the method, over the work of the walls, \
                 {percent}"
            ),
            "1",
        )
        .run(slab("mpm"))
        .holds("the method's own energy budget", |done| {
            let budget_entry = |name| entry(&done[0], name);
            Ok(Measurement::new(
                (budget_entry("transfer")? + budget_entry("contact")?) / budget_entry("work")?,
                0.0,
                1.0,
            ))
        })
        .within(judged(0.02, "springs between surfaces and a transfer with spin lose almost no energy"))
        .refuses(makes_energy()),
        claim(format!("plastic strain without slip over that with friction, {percent}"), "1")
            .runs([slab("mpm:no-slip"), slab("mpm")])
            .at_least(5.0, FIGURE_6, |done| Ok(yielded(&done[0])? / yielded(&done[1])?))
            .within(exactly("'extensive' compared with 'fairly little' is read as five times as much"))
            .refuses(Control::solver("contacts glued", "mpm:no-slip")),
        claim(format!("largest shear over normal force of a contact, {percent}"), "1")
            .run(slab("mpm"))
            .holds("Coulomb's law: friction of the scene", |done| {
                let friction = done[0].scene.laws[0].unwrap_or_default().friction;
                Ok(Measurement::relative(steepest(&done[0])?, friction))
            })
            .within(judged(0.02, "the forces of a contact area are summed, and their normals differ slightly"))
            .refuses(Control::scene(Effect::Friction.absence(), early(|scene| Effect::Friction.switch_off(scene)))),
        claim(format!("stress of von Mises over the flow stress where it has flowed, {percent}, largest"), "1")
            .run(slab("mpm"))
            .holds("radial return ends on the yield surface", |done| {
                Ok(Measurement::relative(on_the_yield_surface(&done[0])?, 1.0))
            })
            .within(computed(
                64.0 * f64::EPSILON,
                "rounding by ε in about thirty operations of the return and thirty of this check",
            ))
            .refuses(Control::scene("hardening off", early(with_yield(|_, hardening| *hardening = 0.0)))),
        claim(format!("change of volume that pressure does not account for, {percent}, mean"), "1")
            .run(slab("mpm"))
            .holds("plastic flow keeps volume: σ_m = K ln J", |done| Ok(Measurement::new(volume(&done[0])?, 0.0, 1.0)))
            .within(computed(
                1.0 / STEPS,
                "the deformation is integrated to first order, so a rotation by θ in n steps increases the volume by \
                 θ²/n: here θ = 1",
            ))
            .refuses(Control::scene("bulk modulus of a tenth", early(made_of(|grains| grains.bulk_modulus *= 0.1)))),
        claim(format!("plastic strain of a slab moved along its period, {:.0} % shear", 100.0 * BEGINNING), "1")
            .run(to_shear(Run::new("seed-1", "mpm", grid(CELLS)), BEGINNING, 0).slow())
            .run(Run::new("seed-1", "mpm", grid(CELLS)).slow().adjusted("moved", |scene| {
                sheared(scene, BEGINNING, 0);
                moved(scene);
            }))
            .holds("the slab is periodic", |done| {
                let (there, here) = (yielded(&done[1])?, yielded(&done[0])?);
                Ok(Measurement::new(there - here, 0.0, here))
            })
            .within(judged(1e-9, "rounding of positions, before the motion becomes chaotic"))
            .refuses(Control::without(Effect::PeriodicAxes)),
    ];
    let overlap = |which: usize, words: &str, allowed| {
        claim(format!("{words} overlap of surfaces, {percent}"), "cell")
            .run(slab("mpm"))
            .holds("surfaces do not penetrate each other", move |done| {
                Ok(Measurement::new(overlaps(&done[0])?[which], 0.0, 1.0))
            })
            .within(required(
                allowed,
                "required before the solver was written, for springs as stiff as a cell of the material",
            ))
            .refuses(Control::scene("moduli of a thousandth", |scene| stiffen(scene, 0.001)))
    };
    claims.extend([overlap(0, "largest", 0.15), overlap(1, "mean", 0.03)]);
    claims
}
