//! Time series of the probes of a scene.

use crate::probe_columns::{ENERGIES, columns, mean_stresses, stresses};
use crate::record::{BodyState, Column, ContactState, GrainState, Partner, Series, Snapshot, StepState};
use grainbench_scene::dimension::Dimension;
use grainbench_scene::scene::{Probe, ProbeTarget, Scene, WallShape};
use nalgebra::{Matrix3, Vector3};

/// Value of a quantity that a solver does not report.
const UNKNOWN: Vector3<f64> = Vector3::new(f64::NAN, f64::NAN, f64::NAN);

/// Returns the columns of all probes of a scene, without samples.
pub(crate) fn empty_series(scene: &Scene) -> Series {
    let columns: Vec<Column> = scene
        .probes
        .iter()
        .flat_map(|probe| {
            columns(probe.target, scene.dimension)
                .into_iter()
                .map(|(name, unit)| Column { name: format!("{}.{name}", probe.name), unit: unit.to_owned() })
        })
        .collect();
    let values = vec![Vec::new(); columns.len()];
    Series { columns, values, ..Series::default() }
}

/// Adds one sample of every probe.
pub(crate) fn sample(series: &mut Series, scene: &Scene, look: &StepState) {
    series.step.push(look.snapshot.step);
    series.time.push(look.snapshot.time);
    let values = scene.probes.iter().flat_map(|probe| values(probe, scene, look));
    for (column, value) in series.values.iter_mut().zip(values) {
        column.push(value);
    }
}

/// Returns the mean stress of the grains from the contacts between them, and then the coordination number; see
/// [`grainbench_scene::file::ProbeSpec::stress`].
fn mean_stress(snapshot: &Snapshot, dimension: Dimension) -> Vec<f64> {
    let (low, high) = snapshot.bounds;
    let volume: f64 = (high - low).iter().take(dimension.count()).product();
    let mut stress = Matrix3::zeros();
    let mut contacts = 0_u32;
    for contact in snapshot.contacts.iter().flatten() {
        let Partner::Grain(other) = contact.partner else { continue };
        let radius = |id: u32| snapshot.grain(id).map_or(0.0, |grain| grain.radius);
        let line = contact.normal * (radius(contact.grain) + radius(other) - contact.overlap);
        stress += line * (contact.shear_force - contact.normal * contact.normal_force).transpose();
        contacts += 1;
    }
    let mut all: Vec<f64> = mean_stresses(dimension).iter().map(|&at| stress[at] / volume).collect();
    // Without grains there are no contacts, and the coordination number is zero.
    all.push(2.0 * f64::from(contacts) / snapshot.grains.len().max(1) as f64);
    all
}

fn values(probe: &Probe, scene: &Scene, look: &StepState) -> Vec<f64> {
    let count = scene.dimension.count();
    let flat = scene.dimension == Dimension::Two;
    let snapshot = &look.snapshot;
    let vector = |v: &Vector3<f64>| v.iter().copied().take(count).collect::<Vec<f64>>();
    let spin = |v: &Vector3<f64>| if flat { vec![v.z] } else { v.iter().copied().collect() };
    let moving = |position: &Vector3<f64>, velocity: &Vector3<f64>, turning: &Vector3<f64>, angle: f64| {
        let angle = if flat { vec![angle] } else { Vec::new() };
        [vector(position), vector(velocity), spin(turning), angle].concat()
    };
    match probe.target {
        ProbeTarget::Grain(grain) => {
            let grain = &snapshot.grains[grain];
            moving(&grain.position, &grain.velocity, &grain.spin, grain.angle.unwrap_or(f64::NAN))
        }
        ProbeTarget::Body(body) => {
            let body = &snapshot.bodies[body];
            moving(&body.position, &body.velocity, &body.spin, body.angle)
        }
        ProbeTarget::Point(at) => {
            let point = &look.spots[at];
            let mut all = vector(&point.displacement);
            all.extend(vector(&point.velocity));
            all.extend(&point.stress[..stresses(scene.dimension)]);
            all.push(point.plastic_strain);
            all
        }
        ProbeTarget::Pair(a, b) => contact_values(look, a, Partner::Grain(b as u32 + 1), flat),
        ProbeTarget::GrainWall(grain, wall) => contact_values(look, grain, Partner::Wall(wall as u16), flat),
        ProbeTarget::Wall(wall) => vector(&snapshot.walls[wall].force.unwrap_or(UNKNOWN)),
        ProbeTarget::Piston(wall) => {
            let WallShape::Plane { point, normal } = scene.walls[wall].shape else { return vec![f64::NAN] };
            vec![snapshot.walls[wall].corners.first().map_or(f64::NAN, |now| (now - point).dot(&normal))]
        }
        ProbeTarget::Driven(group) => vector(look.driven.get(group).unwrap_or(&UNKNOWN)),
        ProbeTarget::Budget => {
            let Some(budget) = &look.budget else { return vec![f64::NAN; ENERGIES.len() + 2 * count] };
            let mut all = Vec::from(ENERGIES.map(|(_, energy)| energy(budget)));
            all.extend(vector(&budget.momentum));
            all.extend(vector(&budget.impulse));
            all
        }
        ProbeTarget::Stress => mean_stress(snapshot, scene.dimension),
        ProbeTarget::Count => {
            let first = scene.grains.len() - scene.stays.entries.len();
            let (present, entered) = (snapshot.grains.len(), first + scene.stays.entered_by(snapshot.time));
            vec![present as f64, entered as f64, entered as f64 - present as f64]
        }
        ProbeTarget::System => {
            let bodies = &snapshot.bodies;
            let half_squared = |mass: f64, velocity: &Vector3<f64>| 0.5 * mass * velocity.norm_squared();
            let of_grains: f64 = snapshot.grains.iter().map(|grain| half_squared(grain.mass, &grain.velocity)).sum();
            let of_bodies: f64 = bodies.iter().map(|body| half_squared(body.mass, &body.velocity)).sum();
            let kinetic = of_grains + (of_bodies + look.inner_kinetic_energy);
            let inertia = |grain: &GrainState| scene.grains[grain.id as usize - 1].inertia;
            let of_grains: f64 = snapshot.grains.iter().map(|grain| half_squared(inertia(grain), &grain.spin)).sum();
            let of_bodies: f64 = bodies.iter().map(|body| half_squared(body.inertia, &body.spin)).sum();
            let rotational = of_grains + (of_bodies + look.uneven_rotational_energy);
            let height = |mass: f64, position: &Vector3<f64>| -mass * scene.gravity.dot(position);
            let of_grains: f64 = snapshot.grains.iter().map(|grain| height(grain.mass, &grain.position)).sum();
            let gravitational = of_grains + bodies.iter().map(|body| height(body.mass, &body.position)).sum::<f64>();
            let mut momentum: Vector3<f64> = snapshot.grains.iter().map(|grain| grain.velocity * grain.mass).sum();
            let mut angular: Vector3<f64> = snapshot
                .grains
                .iter()
                .map(|grain| grain.position.cross(&(grain.velocity * grain.mass)) + grain.spin * inertia(grain))
                .sum();
            for BodyState { mass, inertia, position, velocity, spin, .. } in bodies {
                momentum += velocity * *mass;
                angular += position.cross(&(velocity * *mass)) + spin * *inertia;
            }
            angular += look.uneven_angular_momentum;
            let total = kinetic + rotational + look.elastic_energy + gravitational;
            let mut all = vec![kinetic, rotational, look.elastic_energy, gravitational, total];
            all.extend(vector(&momentum));
            all.extend(spin(&angular));
            let [contacts, slipping] = look.touching.map_or([f64::NAN; 2], |counts| counts.map(|count| count as f64));
            let fastest = snapshot.grains.iter().map(|grain| grain.spin.norm()).fold(0.0, f64::max);
            all.extend([contacts, slipping, fastest]);
            all
        }
    }
}

/// Returns overlap (m), normal force (N), shear force (N) and slipping (0 or 1) of one contact. They are zero without
/// contact, and NaN if the solver does not report contacts. In two dimensions, the shear force on the first grain is
/// positive along `t = (e₂, −e₁)`, which is the normal `e` to the partner, rotated clockwise by 90°.
fn contact_values(look: &StepState, grain: usize, partner: Partner, flat: bool) -> Vec<f64> {
    let id = grain as u32 + 1;
    let Some(contacts) = &look.snapshot.contacts else { return vec![f64::NAN; 4] };
    let found = contacts.iter().find(|contact| {
        let straight = contact.grain == id && contact.partner == partner;
        let exchanged = partner == Partner::Grain(contact.grain) && contact.partner == Partner::Grain(id);
        straight || exchanged
    });
    found.map_or_else(
        || vec![0.0; 4],
        |contact| {
            vec![contact.overlap, contact.normal_force, shear(contact, flat), f64::from(u8::from(contact.slipping))]
        },
    )
}

/// Returns the shear force (N). In two dimensions, its sign does not depend on the order of the grains, because force
/// and normal both change sign.
fn shear(contact: &ContactState, flat: bool) -> f64 {
    let force = contact.shear_force;
    if flat { force.x * contact.normal.y - force.y * contact.normal.x } else { force.norm() }
}
