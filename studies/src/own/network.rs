//! Stability limit of the contact network of a snapshot: 2/ω_max of central differences.
//!
//! Each contact is a normal spring and, if it does not slip, a tangential spring between two grains, or between a grain and a
//! wall. The springs act at the contact point, in the middle of the overlap. ω² is the largest eigenvalue of M⁻¹K, with the
//! matrix M of masses and moments of inertia and the stiffness matrix K. It is found by power iteration, without assembling
//! K. Dashpots are left out.

use grainbench_scene::scene::Scene;
use grainbench_solver::record::{ContactState, Partner, Snapshot};
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Largest number of iterations.
const ITERATIONS: usize = 2000;
/// Relative change of ω² at which the iteration ends.
const PRECISION: f64 = 1e-9;

/// Contact with its springs.
struct Link {
    grain: usize,
    /// Index of the other grain; none for a wall.
    other: Option<usize>,
    normal: Vector3<f64>,
    /// Distances from the centres to the contact point (m).
    arms: [f64; 2],
    /// Normal and tangential stiffness (N/m).
    stiffness: [f64; 2],
}

/// Displacement and rotation of a grain.
#[derive(Clone, Copy, Default)]
struct Motion {
    shift: Vector3<f64>,
    turn: Vector3<f64>,
}

/// Returns the largest stable time step (s) of the contacts of a snapshot; none if it has no contact with springs.
#[must_use]
pub fn largest_stable_step(scene: &Scene, snapshot: &Snapshot) -> Option<f64> {
    let places: BTreeMap<u32, usize> = snapshot.grains.iter().enumerate().map(|(at, grain)| (grain.id, at)).collect();
    let links: Vec<Link> =
        snapshot.told_contacts().iter().filter_map(|contact| link(scene, snapshot, &places, contact)).collect();
    if links.is_empty() {
        return None;
    }
    let groups = scene.driven_group_of_grains();
    // Grains with prescribed motion have no inertia of their own.
    let inverse: Vec<[f64; 2]> = snapshot
        .grains
        .iter()
        .map(|grain| {
            let at = grain.id as usize - 1;
            let is_free = groups.get(at).is_none_or(Option::is_none);
            if is_free { [1.0 / grain.mass, 1.0 / scene.grains[at].inertia] } else { [0.0; 2] }
        })
        .collect();
    let square = largest_eigenvalue(&links, &inverse, scene.dimension.count() == 2)?;
    Some(2.0 / square.sqrt())
}

fn link(scene: &Scene, snapshot: &Snapshot, places: &BTreeMap<u32, usize>, contact: &ContactState) -> Option<Link> {
    let grain = *places.get(&contact.grain)?;
    let own = &snapshot.grains[grain];
    let (other, material, radius) = match contact.partner {
        Partner::Grain(id) => {
            let other = *places.get(&id)?;
            (Some(other), snapshot.grains[other].material, Some(snapshot.grains[other].radius))
        }
        Partner::Wall(wall) => (None, scene.walls.get(usize::from(wall))?.material, None),
        Partner::Body(_) => return None,
    };
    let law = scene.law(own.material, material)?;
    let effective = radius.map_or(own.radius, |radius| own.radius * radius / (own.radius + radius));
    let (normal, tangential) = law.springs.stiffness(contact.overlap.max(0.0), effective);
    let tangential = if law.has_friction() && !contact.slipping { tangential } else { 0.0 };
    let half = 0.5 * contact.overlap;
    Some(Link {
        grain,
        other,
        normal: contact.normal,
        arms: [own.radius - half, radius.unwrap_or(0.0) - half],
        stiffness: [normal, tangential],
    })
}

/// Returns the largest eigenvalue of M⁻¹K; none if it is not positive.
fn largest_eigenvalue(links: &[Link], inverse: &[[f64; 2]], is_flat: bool) -> Option<f64> {
    let mut seed = 1_u64;
    let mut random = || {
        // Steps of a linear congruential generator give a start without symmetry.
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut vector = || Vector3::new(random(), random(), random());
    let mut motion: Vec<Motion> = inverse.iter().map(|_| Motion { shift: vector(), turn: vector() }).collect();
    if is_flat {
        for grain in &mut motion {
            grain.shift.z = 0.0;
            grain.turn = Vector3::new(0.0, 0.0, grain.turn.z);
        }
    }
    let mut square = 0.0;
    for _ in 0..ITERATIONS {
        let norm = energy(&motion, inverse);
        if norm.is_nan() || norm <= 0.0 {
            return None;
        }
        let scale = 1.0 / norm.sqrt();
        for grain in &mut motion {
            grain.shift *= scale;
            grain.turn *= scale;
        }
        let forces = forces(links, &motion);
        let work: f64 = motion
            .iter()
            .zip(&forces)
            .map(|(own, force)| own.shift.dot(&force.shift) + own.turn.dot(&force.turn))
            .sum();
        let before = square;
        square = work;
        for ((own, force), [mass, inertia]) in motion.iter_mut().zip(&forces).zip(inverse) {
            own.shift = force.shift * *mass;
            own.turn = force.turn * *inertia;
        }
        if (square - before).abs() <= PRECISION * square.abs() {
            break;
        }
    }
    (square.is_finite() && square > 0.0).then_some(square)
}

/// Returns xᵀMx of a motion x.
fn energy(motion: &[Motion], inverse: &[[f64; 2]]) -> f64 {
    let of_grain = |(own, [mass, inertia]): (&Motion, &[f64; 2])| {
        if *mass > 0.0 { own.shift.norm_squared() / mass + own.turn.norm_squared() / inertia } else { 0.0 }
    };
    motion.iter().zip(inverse).map(of_grain).sum()
}

/// Returns Kx of a motion x.
fn forces(links: &[Link], motion: &[Motion]) -> Vec<Motion> {
    let mut forces = vec![Motion::default(); motion.len()];
    for link in links {
        let [own_arm, other_arm] = [link.normal * link.arms[0], -link.normal * link.arms[1]];
        let own = &motion[link.grain];
        let mut relative = own.shift + own.turn.cross(&own_arm);
        if let Some(other) = link.other {
            relative -= motion[other].shift + motion[other].turn.cross(&other_arm);
        }
        let along = link.normal * relative.dot(&link.normal);
        let force = along * link.stiffness[0] + (relative - along) * link.stiffness[1];
        forces[link.grain].shift += force;
        forces[link.grain].turn += own_arm.cross(&force);
        if let Some(other) = link.other {
            forces[other].shift -= force;
            forces[other].turn -= other_arm.cross(&force);
        }
    }
    forces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stability::assembly;
    use grainbench_dem::convention::Convention;
    use grainbench_dem::solver::Dem;
    use grainbench_solver::Solver as _;
    use grainbench_solver::resolution::Resolution;

    /// The closed forms of all assemblies: rows, lattices and boxes of grains, with and without friction.
    #[test]
    fn assemblies_have_their_exact_limits() {
        let assemblies = assembly::all().unwrap();
        assert!(assemblies.len() > 10);
        for assembly in &assemblies {
            let mut scene = assembly.scene.clone();
            scene.snapshots = 3;
            let record = Dem::new(Convention::DEFAULT).run(&scene, &Resolution::TimeStep(0.05), &mut ()).unwrap();
            let steps = record.snapshots.iter().filter_map(|snapshot| largest_stable_step(&scene, snapshot));
            let found = steps.fold(f64::INFINITY, f64::min);
            let error = found / assembly.exact - 1.0;
            assert!(error.abs() < 2e-3, "{} {:?}: off by {error}", assembly.name, assembly.kappa);
            // Negative control: springs softer by a hundredth have another limit.
            scene.change_laws(|law| law.springs = law.springs.scaled([0.99; 2]));
            let softer = record.snapshots.iter().filter_map(|snapshot| largest_stable_step(&scene, snapshot));
            assert!((softer.fold(f64::INFINITY, f64::min) / assembly.exact - 1.0).abs() > 3e-3, "{}", assembly.name);
        }
    }
}
