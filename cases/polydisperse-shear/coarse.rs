//! Hard gates on deformable grains: a coarse slab, sheared a little.

use super::measures::{deviator_squared, mean_stress, plastic_strain, with_their_start};
use super::{at_least, at_most, entry, gained, grid, measures, momentum, to_shear};
use crate::effect::Effect;
use crate::gate::{Control, Done, Gate, Measured, Missing, Run};
use crate::verdict::Evidence;
use grainbench_scene::body::{Constitutive, Deformable};
use grainbench_scene::record::Partner;
use grainbench_scene::scene::{Duration, Scene};

/// Cells across.
const CELLS: f64 = 75.0;
/// Mean shear of the coarse slab.
const SHEAR: f64 = 0.08;
/// Mean shear after which two slabs are compared that are one.
const BEGINNING: f64 = 0.01;
/// How far the slab is moved along its period: a third, which is a whole number of cells.
const MOVED: f64 = 1.0 / 3.0;

pub(super) const MAKES_ENERGY: &str = "the 2000 criterion lets go on departure and so makes energy when grains vibrate in contact: plastic and \
                            elastic energy exceed the work of the walls from the first per cent of shear on";

fn slab(solver: &'static str) -> Run {
    to_shear(Run::new("seed-1", solver, grid(CELLS)), SHEAR, 0).slow()
}

/// The constants of von Mises' law in the scene as the case means it.
fn yielding(done: &Done) -> Result<(Deformable, f64, f64), Missing> {
    let deformable = done.scene.deformable.first().copied().flatten();
    match deformable.map(|deformable| (deformable, deformable.constitutive)) {
        Some((deformable, Constitutive::VonMises { yield_stress, hardening_modulus })) => {
            Ok((deformable, yield_stress, hardening_modulus))
        }
        _ => Err(Missing("yield stress in its scene".to_owned())),
    }
}

/// A scene whose grains are made of something else.
fn made_of(change: impl Fn(&mut Deformable) + Copy) -> impl Fn(&mut Scene) + Copy {
    move |scene| scene.deformable.iter_mut().flatten().for_each(change)
}

/// The same wrong physics on part of the way: it shows long before the end.
fn early(change: impl Fn(&mut Scene) + Send + Sync + 'static) -> impl Fn(&mut Scene) + Send + Sync + 'static {
    move |scene| {
        change(scene);
        if let Duration::Seconds(time) = &mut scene.duration {
            *time *= 0.4;
        }
    }
}

fn with_yield(change: impl Fn(&mut f64, &mut f64) + Copy + Send + Sync + 'static) -> impl Fn(&mut Scene) + Send + Sync + 'static {
    made_of(move |deformable: &mut Deformable| {
        if let Constitutive::VonMises { yield_stress, hardening_modulus } = &mut deformable.constitutive {
            change(yield_stress, hardening_modulus);
        }
    })
}

/// Work of the walls less all that it became, over the work: stored and plastic energy from the state of every point by the
/// constants of the scene, s:s/4G + σ_m²/2K and Y ε_p + H ε_p²/2 a volume.
pub(super) fn unaccounted(done: &Done) -> Result<Measured, Missing> {
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
        return Err(Missing("material points".to_owned()));
    }
    let work = entry(done, "work")?;
    let mut sum = elastic + plastic + gained(done, "kinetic")?;
    for name in ["springs", "friction", "transfer", "contact"] {
        sum += entry(done, name)?;
    }
    Ok(Measured::new(sum, work, work))
}

/// Kinetic, elastic and plastic energy gained, over the work of the walls.
pub(super) fn kept(done: &Done) -> Result<f64, Missing> {
    Ok((gained(done, "kinetic")? + entry(done, "elastic")? + entry(done, "plastic")?) / entry(done, "work")?)
}

/// Largest and mean overlap of contacts at the end, in cells of this slab.
fn overlaps(done: &Done) -> Result<[f64; 2], Missing> {
    let cell = measures::width(done) / CELLS;
    let overlaps: Vec<f64> = measures::end(done)?.contacts.iter().map(|contact| contact.overlap / cell).collect();
    if overlaps.is_empty() {
        return Err(Missing("contacts".to_owned()));
    }
    Ok([overlaps.iter().copied().fold(0.0, f64::max), overlaps.iter().sum::<f64>() / overlaps.len() as f64])
}

/// Largest shear over normal force of the contacts between grains that carry more than the mean.
fn steepest(done: &Done) -> Result<f64, Missing> {
    let contacts = &measures::end(done)?.contacts;
    let between = contacts.iter().filter(|contact| matches!(contact.partner, Partner::Grain(_)));
    let mean = contacts.iter().map(|contact| contact.normal_force).sum::<f64>() / contacts.len() as f64;
    let steep = between.filter(|contact| contact.normal_force > mean);
    let steepest = steep.map(|contact| contact.shear_force.norm() / contact.normal_force).reduce(f64::max);
    steepest.ok_or_else(|| Missing("contacts between grains".to_owned()))
}

/// Largest stress of von Mises over the flow stress Y + H ε_p, of points that have flowed by more than a hundredth.
fn on_the_yield_surface(done: &Done) -> Result<f64, Missing> {
    let (_, yield_stress, hardening) = yielding(done)?;
    let flowed = measures::end(done)?.points.iter().filter(|point| point.plastic_strain > 0.01);
    let ratio = flowed.map(|point| (1.5 * deviator_squared(point)).sqrt() / (yield_stress + hardening * point.plastic_strain));
    ratio.reduce(f64::max).ok_or_else(|| Missing("points that have flowed".to_owned()))
}

/// Change of volume that pressure does not account for, |ln J − σ_m/K| with J = V/V₀, mean over the points: plastic flow changes
/// no volume.
fn volume(done: &Done) -> Result<f64, Missing> {
    let (deformable, ..) = yielding(done)?;
    let points = with_their_start(done, measures::end(done)?)?;
    let off = points.iter().map(|(now, start)| {
        ((now.volume / start.volume).ln() - mean_stress(now) / deformable.bulk_modulus).abs()
    });
    Ok(off.sum::<f64>() / points.len() as f64)
}

/// Moves all grains along the periodic axis.
fn moved(scene: &mut Scene) {
    let Some(domain) = scene.domain else { return };
    let (low, length) = (domain.low.y, domain.high.y - domain.low.y);
    for grain in &mut scene.grains {
        grain.position.y = low + (grain.position.y + MOVED * length - low).rem_euclid(length);
    }
}

pub(super) fn gates() -> Vec<Gate> {
    let invariant = |source| (Evidence::Invariant, source);
    let makes_energy = || Control::solver("contact on approach (2000), which makes energy", "mpm:2000");
    let glued = || Control::solver("contacts glued", "mpm:no-slip");
    let percent = format!("{:.0} % shear", 100.0 * SHEAR);
    let mut gates = vec![
        Gate::new(
            (format!("where the work of the walls went, {percent}"), "J"),
            vec![slab("mpm")],
            invariant("conservation of energy"),
            (0.02, "stress and elastic energy go together to second order in the step; of the work of the walls"),
            Control::scene("half the yield stress", early(with_yield(|yield_stress, _| *yield_stress *= 0.5))),
            |done| unaccounted(&done[0]),
        ),
        Gate::new(
            (format!("momentum less the impulse of the driven grains, {percent}, worst"), "N s"),
            vec![slab("mpm")],
            invariant("equal and opposite impulses"),
            (1e-10, "rounding; of the largest impulse"),
            Control::solver("each body against its own normal (2000)", "mpm:2000"),
            |done| momentum(&done[0]),
        ),
        Gate::new(
            (format!("energy lost between points and nodes and at contacts, by the method, over the work of the walls, {percent}"), "1"),
            vec![slab("mpm")],
            invariant("the method's own energy budget"),
            (0.02, "springs between surfaces and a transfer that keeps spin lose next to nothing"),
            makes_energy(),
            |done| Ok(Measured::new((entry(&done[0], "transfer")? + entry(&done[0], "contact")?) / entry(&done[0], "work")?, 0.0, 1.0)),
        ),
        Gate::new(
            (format!("kinetic, elastic and plastic energy over the work of the walls, {percent}, not above 1"), "1"),
            vec![slab("mpm")],
            invariant("conservation of energy"),
            (0.01, "the budget closes within 2 %, and friction takes its share"),
            makes_energy(),
            |done| Ok(at_most(kept(&done[0])?, 1.0)),
        ),
        Gate::new(
            (format!("kinetic, elastic and plastic energy over the work of the walls, {percent}, not above 1"), "1"),
            vec![slab("mpm:2000").known(MAKES_ENERGY)],
            invariant("conservation of energy"),
            (0.01, "as for the others"),
            Control::without_the_error("springs between surfaces", "mpm", grid(CELLS)),
            |done| Ok(at_most(kept(&done[0])?, 1.0)),
        ),
        Gate::new(
            (format!("plastic strain without slip over that with friction, {percent}, 5 or more"), "1"),
            vec![slab("mpm:no-slip"), slab("mpm")],
            (Evidence::Paper, "Bardenhagen, Brackbill & Sulsky 2000, Fig. 6: extensive plastic deformation, against fairly little"),
            (0.0, "several times, in every packing"),
            glued(),
            |done| {
                let of = |done: &Done| Ok(plastic_strain(done, measures::end(done)?));
                Ok(at_least(of(&done[0])? / of(&done[1])?, 5.0))
            },
        ),
        Gate::new(
            (format!("largest shear over normal force of a contact, {percent}"), "1"),
            vec![slab("mpm")],
            invariant("Coulomb's law: friction of the scene"),
            (0.02, "forces of a patch are summed, whose normals differ a little"),
            Control::scene(Effect::Friction.absence(), early(|scene| Effect::Friction.switch_off(scene))),
            |done| {
                let friction = done[0].scene.laws[0].unwrap_or_default().friction;
                Ok(Measured::new(steepest(&done[0])?, friction, friction))
            },
        ),
        Gate::new(
            (format!("stress of von Mises over the flow stress where it has flowed, {percent}, largest"), "1"),
            vec![slab("mpm")],
            invariant("radial return ends on the yield surface"),
            (1e-6, "rounding"),
            Control::scene("hardening off", early(with_yield(|_, hardening| *hardening = 0.0))),
            |done| Ok(Measured::new(on_the_yield_surface(&done[0])?, 1.0, 1.0)),
        ),
        Gate::new(
            (format!("change of volume that pressure does not account for, {percent}, mean"), "1"),
            vec![slab("mpm")],
            invariant("plastic flow keeps volume: σ_m = K ln J"),
            (2e-3, "a point that turns by θ at ω in steps of Δt swells by θ ω Δt, for its deformation is summed to first order"),
            Control::scene("bulk modulus of a tenth", early(made_of(|deformable| deformable.bulk_modulus *= 0.1))),
            |done| Ok(Measured::new(volume(&done[0])?, 0.0, 1.0)),
        ),
        Gate::new(
            (format!("plastic strain of a slab moved along its period, {:.0} % shear", 100.0 * BEGINNING), "1"),
            vec![
                to_shear(Run::new("seed-1", "mpm", grid(CELLS)), BEGINNING, 0).slow(),
                Run { adjustment: Some(("moved".to_owned(), std::sync::Arc::new(beginning_moved))), ..Run::new("seed-1", "mpm", grid(CELLS)).slow() },
            ],
            invariant("the slab is periodic"),
            (1e-9, "rounding of positions; nothing has become chaotic yet"),
            Control::without(Effect::PeriodicAxes),
            |done| {
                let of = |done: &Done| Ok(plastic_strain(done, measures::end(done)?));
                let (there, here) = (of(&done[1])?, of(&done[0])?);
                Ok(Measured::new(there, here, here))
            },
        ),
    ];
    for (which, words, bound) in [(0, "largest", 0.15), (1, "mean", 0.03)] {
        gates.push(Gate::new(
            (format!("{words} overlap of surfaces, {percent}, not above {bound}"), "cell"),
            vec![slab("mpm")],
            invariant("surfaces do not go through each other"),
            (0.0, "springs as stiff as a cell of the material"),
            Control::scene("moduli of a thousandth", made_of(|deformable| {
                deformable.bulk_modulus *= 0.001;
                deformable.shear_modulus *= 0.001;
            })),
            move |done| Ok(at_most(overlaps(&done[0])?[which], bound)),
        ));
    }
    gates
}

/// The beginning of the shear of a slab that was moved.
fn beginning_moved(scene: &mut Scene) {
    if let Some((_, to_the_beginning)) = to_shear(Run::new("", "", grid(CELLS)), BEGINNING, 0).adjustment {
        to_the_beginning(scene);
    }
    moved(scene);
}
