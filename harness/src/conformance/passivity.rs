//! Passivity: undamped collisions gain no energy, and a closed cycle of a contact with prescribed motion yields no work.

use super::end::{End, NoEnd};
use super::objectivity::is_rigid;
use super::row::{PropertyValue, Rows};
use super::scenes::{self, NamedScene, scene_of};
use super::{Flaw, Property};
use crate::evidence::Evidence;
use crate::expect::{Bound, ExpectedValue, Measurement, larger};
use crate::tolerance::ToleranceOrigin;
use crate::verdict::Verdict;
use grainbench_scene::error::SceneError;
use grainbench_scene::scene::{Duration, Scene};
use grainbench_solver::record::{GrainState, Record};

pub(super) const PROPERTY: Property = Property {
    name: "passivity",
    claim: "bouncing grains never have more kinetic energy than at the start, and a closed cycle of a driven contact \
            without slip yields no work",
    flaw: Flaw::Pumped,
    evidence: Evidence::Invariant,
    source: "springs store at most the work done on them",
    because: "central differences conserve ½mv² + ½k x x′ in a contact, where x and x′ belong to consecutive steps. \
              Because a contact opens and closes within a step, each of N contacts adds (ωΔt)²/4 of the energy, with ω \
              of the stiffest spring. Levels are scaled by Δt to the power of the claimed order. Without springs the \
              error is rounding in each step. In a closed cycle the force may be one step late, which gives 2/n of the \
              spring energy for a leg of n steps",
    check,
};

/// Quantity and unit of the results of collisions.
const GAIN: (&str, &str) = ("energy gained, largest of the run", "1");
/// Quantity and unit of the results of a grain between two planes, with the claimed order n.
const LEVELS: (&str, &str) = ("energy gained × (Δt₀/Δt)ⁿ, largest of three time steps", "1");
/// Quantity and unit of the results of closed cycles.
const WORK: (&str, &str) = ("work gained in a closed cycle over the energy of its spring", "1");

/// Number of pairs in a collision of five grains. It bounds the number of contacts.
const PAIRS: f64 = 10.0;
/// Gap between two planes minus the diameter of the bouncing grain (m).
const ROOM: f64 = 0.02;
/// Duration of the run of the bouncing grain (s).
const BOUNCING: f64 = 0.3;
/// Initial speed of the bouncing grain normal to the planes (m/s).
const ACROSS: f64 = 1.0;
/// Young's modulus of Hertz contacts (Pa).
const YOUNG: f64 = 1.1375e5;

fn check(rows: &Rows<'_>) -> Vec<Verdict> {
    let resolution = &rows.terms.resolution;
    let collisions = rows.each(scenes::collisions(), resolution, GAIN, |named| {
        let record = rows.solver.run(&named.scene, resolution, &mut ())?;
        let allowed = allowed(&named.scene, &record, PAIRS, rows)?;
        Ok(gained(gain(&named.scene, &record)?, allowed))
    });
    let bouncing = rows.each(bouncing(rows), resolution, LEVELS, |named| levels(rows, named));
    let cycles = if rows.solver.deforms() { Ok(Vec::new()) } else { cycles() };
    let work = rows.each(cycles, resolution, WORK, |named| work(rows, named));
    [collisions, bouncing, work].concat()
}

fn gained(gain: f64, allowed: f64) -> PropertyValue {
    let measured = Measurement::new(gain, ExpectedValue::Bound(Bound::AtMost(0.0)), 1.0);
    PropertyValue { measured, allowed, made: ToleranceOrigin::Computed }
}

/// Returns scenes of a grain that bounces between two planes, one scene per contact law and friction coefficient.
///
/// For deformable bodies, there are no Hertz contacts. With `terms.long`, a run has at least 10⁵ steps.
fn bouncing(rows: &Rows<'_>) -> Result<Vec<NamedScene>, SceneError> {
    let linear =
        |friction: f64| format!("normal_stiffness = 1e4\ntangential_stiffness = 5e3\nfriction = {friction:?}\n");
    let hertz = |friction: f64| format!("law = 'hertz'\nfriction = {friction:?}\n");
    let mut all = vec![
        between_planes("between-planes-2d", 2, &linear(100.0))?,
        between_planes("between-planes-2d-slip", 2, &linear(0.3))?,
    ];
    if !rows.solver.deforms() {
        all.push(between_planes("between-planes-3d-hertz", 3, &hertz(100.0))?);
        all.push(between_planes("between-planes-3d-hertz-slip", 3, &hertz(1.0))?);
    }
    for named in all.iter_mut().filter(|_| rows.terms.long) {
        let step = rows.terms.resolution.steps(&named.scene).map_or(1e-5, |(step, _)| step);
        named.scene.duration = Duration::Seconds(BOUNCING.max(1.01e5 * step));
    }
    Ok(all)
}

/// Returns the scene of a grain of mass 1 kg and radius 1 m between two planes.
fn between_planes(name: &'static str, dimension: usize, law: &str) -> Result<NamedScene, SceneError> {
    let flat = dimension == 2;
    let density = if flat { 1.0 } else { 0.75 } / std::f64::consts::PI;
    let moduli = if law.contains("hertz") {
        format!("young_modulus = {YOUNG:?}\npoisson_ratio = 0.3")
    } else {
        "bulk_modulus = 1e4\nshear_modulus = 6e3".to_owned()
    };
    let vector = |[x, y, z]: [f64; 3]| if flat { format!("{:?}", [x, z]) } else { format!("{:?}", [x, y, z]) };
    let upright = |size: f64| vector([0.0, 0.0, size]);
    let spin = if flat { "0.4" } else { "[0.3, -0.2, 0.4]" };
    let height = 2.0 + ROOM;
    let text = format!(
        "title = 'A grain between two planes'\ndimension = {dimension}\nduration = {BOUNCING:?}\noutput.snapshots = 29\n\
         [materials.m]\ndensity = {density:?}\n{moduli}\n[contacts.m]\nbetween = ['m', 'm']\n{law}\
         [grains.a]\nmaterial = 'm'\nradius = 1.0\nposition = {}\nvelocity = {}\nspin = {spin}\n\
         [walls.low]\nmaterial = 'm'\nplane = {{ point = {}, normal = {} }}\n\
         [walls.high]\nmaterial = 'm'\nplane = {{ point = {}, normal = {} }}\n",
        upright(0.5 * height),
        vector([0.5, 0.2, -ACROSS]),
        upright(0.0),
        upright(1.0),
        upright(height),
        upright(-1.0)
    );
    scene_of(name, &[&text], true)
}

/// Ratio of the coarse time step to the solver's time step. 0.02 of the critical time step becomes the usual 0.1.
const COARSE: f64 = 5.0;

/// Returns the largest gain of energy, scaled by (Δt₀/Δt)ⁿ. The solver runs with its time step Δt₀. If it claims an order
/// n, it also runs with the time steps Δt₀/4 and [`COARSE`] Δt₀.
fn levels(rows: &Rows<'_>, named: &NamedScene) -> Result<PropertyValue, NoEnd> {
    let order = rows.terms.order.map_or(0.0, |order| order.expected);
    let factors: &[f64] = if order > 0.0 { &[1.0, 0.25, COARSE] } else { &[1.0] };
    let (mut worst, mut most) = (0.0, f64::NAN);
    for &factor in factors {
        let Some(resolution) = rows.terms.resolution.coarser(factor) else { continue };
        let record = rows.solver.run(&named.scene, &resolution, &mut ())?;
        if factor == 1.0 {
            most = allowed(&named.scene, &record, contacts(&named.scene), rows)?;
        }
        worst = larger(gain(&named.scene, &record)? / factor.powf(order), worst);
    }
    Ok(gained(worst, most))
}

/// Returns the largest number of contacts of a grain between two planes. The grain crosses the gap and reverses within
/// half a period of the contact spring.
fn contacts(scene: &Scene) -> f64 {
    let time = scene.duration.seconds().unwrap_or(f64::NAN);
    let grain = &scene.grains[0];
    let (stiffness, _) = stiffest(scene);
    1.0 + time / (ROOM / ACROSS + std::f64::consts::PI * (grain.mass / stiffness).sqrt())
}

/// Returns the kinetic energy of a grain's rigid motion (J). Without a reported spin, only the translational energy counts.
fn kinetic(scene: &Scene, grain: &GrainState) -> f64 {
    let inertia = scene.grains[grain.id as usize - 1].inertia;
    let turning = if grain.spin.iter().all(|spin| spin.is_nan()) { 0.0 } else { inertia * grain.spin.norm_squared() };
    0.5 * (grain.mass * grain.velocity.norm_squared() + turning)
}

/// Returns the largest relative gain of kinetic energy. All energy is kinetic at the start; later, part of it is stored
/// in springs.
fn gain(scene: &Scene, record: &Record) -> Result<f64, NoEnd> {
    let of_start = |grain: &grainbench_scene::scene::Grain| {
        0.5 * (grain.mass * grain.velocity.norm_squared() + grain.inertia * grain.spin.norm_squared())
    };
    let start: f64 = scene.grains.iter().map(of_start).sum();
    End::read(scene, record)?;
    let asked = (u64::from(scene.snapshots) + 2).min(record.cost.steps + 1);
    let found = record.snapshots.len();
    if (found as u64) < asked {
        let lack = format!("the record has {found} snapshots, but the scene requests {asked}");
        return Err(NoEnd::Record(lack));
    }
    let moving = |grains: &[GrainState]| grains.iter().map(|grain| kinetic(scene, grain)).sum::<f64>();
    let energies =
        record.snapshots.iter().filter(|snapshot| snapshot.step > 0).map(|snapshot| moving(&snapshot.grains));
    Ok(energies.fold(0.0, larger) / start - 1.0)
}

/// Returns the normal and tangential stiffness (N/m) at the largest overlap that the initial energy allows.
fn stiffest(scene: &Scene) -> (f64, f64) {
    let fastest = scene.grains.iter().map(|grain| grain.velocity.norm()).fold(0.0, f64::max);
    let heaviest = scene.grains.iter().map(|grain| grain.mass).fold(0.0, f64::max);
    let energy = 0.5 * heaviest * fastest.powi(2);
    let law = scene.laws.iter().flatten().next().copied().unwrap_or_default();
    // ∫F dδ = (2/5) k δ^{5/2} with k = (4/3) E* √R, overlap δ and effective modulus E*.
    let radius = scene.grains[0].radius;
    let spring = 4.0 / 3.0 * law.effective_modulus() * radius.sqrt();
    let overlap = if law.is_hertz() { (2.5 * energy / spring).powf(0.4) } else { 1.0 };
    law.springs.stiffness(overlap, radius)
}

/// Returns the largest allowed gain: (ωΔt)²/4 for each contact, with contact frequency ω and time step Δt.
///
/// In a deformable body, ω is the frequency of a wave that crosses a diameter in half a period. Contacts of rigid
/// bodies have no springs, so only the rounding of each step counts.
fn allowed(scene: &Scene, record: &Record, contacts: f64, rows: &Rows<'_>) -> Result<f64, NoEnd> {
    let step = record.provenance.time_step;
    if !(step.is_finite() && step > 0.0) {
        return Err(NoEnd::Record("the record has no time step".to_owned()));
    }
    let lightest = scene.grains.iter().map(|grain| grain.mass).fold(f64::INFINITY, f64::min);
    let turning = 1.0 + 1.0 / scene.grain_shape.inertia_factor();
    let rate = if rows.solver.deforms() {
        std::f64::consts::FRAC_PI_2 / scene.crossing_time(1.0)
    } else if is_rigid(&rows.terms.resolution) {
        return Ok(4.0 * f64::EPSILON * record.cost.steps as f64);
    } else {
        let (normal, tangential) = stiffest(scene);
        (normal.max(turning * tangential) / lightest).sqrt()
    };
    Ok(contacts * (rate * step).powi(2) / 4.0)
}

/// Small overlap of the Hertz contact with prescribed motion (m).
const SHALLOW: f64 = 0.005;
/// Large overlap of the contact (m).
const DEEP: f64 = 0.01;
/// Tangential displacement of the contact (m).
const SHEAR: f64 = 5.0e-4;
/// Duration of each leg of the cycle (s).
const LEG: f64 = 0.02;

/// Returns two closed cycles of a contact with prescribed motion.
///
/// In the first cycle, the contact is sheared at a small overlap and sheared back at a large overlap. This cycle yields
/// work if the spring force is the present stiffness times the whole displacement. In the second cycle, the overlaps are
/// exchanged. This cycle yields work if unloading does not reduce the spring force.
fn cycles() -> Result<Vec<NamedScene>, SceneError> {
    let legs = |name, [first, second]: [f64; 2]| {
        cycle(name, &[[0.0, first], [SHEAR, first], [SHEAR, second], [0.0, second], [0.0, 0.0]])
    };
    Ok(vec![legs("cycle-pressed-under-shear", [SHALLOW, DEEP])?, legs("cycle-relieved-under-shear", [DEEP, SHALLOW])?])
}

/// Returns the scene of a sphere pressed on a plane. Each leg prescribes a tangential displacement and an overlap (m).
fn cycle(name: &'static str, legs: &[[f64; 2]]) -> Result<NamedScene, SceneError> {
    let place = |(leg, [shear, overlap]): (usize, &[f64; 2])| {
        format!(", [{:?}, {shear:?}, 0.0, {:?}]", LEG * (leg + 1) as f64, -overlap)
    };
    let table: String = legs.iter().enumerate().map(place).collect();
    let text = format!(
        "title = 'A driven contact'\ndimension = 3\nduration = {:?}\noutput.every_cycles = 1\n\
         materials.m = {{ density = 0.238732414637843, young_modulus = {YOUNG:?}, poisson_ratio = 0.3 }}\n\
         contacts.m = {{ between = ['m', 'm'], law = 'hertz', friction = 100.0 }}\n\
         grains.ball = {{ material = 'm', radius = 1.0, position = [0.0, 0.0, 1.0] }}\n\
         driven.ball = {{ grains = 'ball', motion = [{{ table = [[0.0, 0.0, 0.0, 0.0]{table}] }}] }}\n\
         walls.floor = {{ material = 'm', plane = {{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }} }}\n\
         probes = {{ ball = {{ grain = 'ball' }}, floor = {{ wall = 'floor' }} }}\n",
        LEG * legs.len() as f64
    );
    scene_of(name, &[&text], true)
}

/// Returns the work gained in a closed cycle, divided by the energy of the tangential spring at the largest overlap.
fn work(rows: &Rows<'_>, named: &NamedScene) -> Result<PropertyValue, NoEnd> {
    let record = rows.solver.run(&named.scene, &rows.terms.resolution, &mut ())?;
    let column =
        |name: &str| record.series.column(name).ok_or_else(|| NoEnd::Record(format!("the record has no {name}")));
    let mut put_in = 0.0;
    for axis in ["x", "z"] {
        let (place, force) = (column(&format!("ball.{axis}"))?, column(&format!("floor.force_{axis}"))?);
        let pairs = place.windows(2).zip(force.windows(2));
        put_in += pairs.map(|(place, force)| 0.5 * (force[0] + force[1]) * (place[1] - place[0])).sum::<f64>();
    }
    let law = named.scene.laws[0].unwrap_or_default();
    let (_, stiffness) = law.springs.stiffness(DEEP, named.scene.grains[0].radius);
    let stored = 0.5 * stiffness * SHEAR * SHEAR;
    let steps = LEG / record.provenance.time_step;
    Ok(gained(-put_in / stored, 2.0 / steps))
}

#[cfg(test)]
mod tests {
    use super::super::flaw::tests::RefusingSolver;
    use super::*;
    use grainbench_solver::resolution::Resolution;
    use grainbench_solver::terms::Terms;

    #[test]
    fn every_scene_is_right() {
        let scenes = |terms: &Terms| {
            bouncing(&Rows { solver: &RefusingSolver, again: &RefusingSolver, terms, property: &PROPERTY }).unwrap()
        };
        assert_eq!((scenes(&Terms::SECOND_ORDER).len(), cycles().unwrap().len()), (4, 2));
        let steps = |named: &NamedScene| Resolution::CriticalFraction(0.02).steps(&named.scene).unwrap().1;
        assert!(scenes(&Terms::SECOND_ORDER.at_length()).iter().all(|named| steps(named) >= 100_000));
    }
}
