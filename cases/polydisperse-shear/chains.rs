//! Force chains: quasi-linear rows of grains that carry more than the mean stress, after Peters, Muthuswamy, Wibowo &
//! Tordesillas, Physical Review E 72 (2005) 041307.
//!
//! The stress of a grain is σ = (1/πR²) Σ r ⊗ f over its contacts, where r is the vector from the centre of the grain
//! to the contact. A grain is stressed if its largest principal compression exceeds the mean over all grains. Two
//! stressed grains in contact are linked if, for both, the line between their centres is within 45° of the direction of
//! this compression. A chain is a connected group of three or more grains.

use grainbench_solver::record::{Partner, Snapshot};
use nalgebra::{Matrix2, SymmetricEigen, Vector2, Vector3};
use std::collections::BTreeSet;

/// Force chains of a snapshot.
#[derive(Clone, Debug, Default)]
pub(crate) struct Chains {
    /// Fraction of the grains that are stressed.
    pub(crate) stressed: f64,
    /// Number of grains in each chain.
    pub(crate) lengths: Vec<usize>,
    /// Mean direction of compression of grains in chains, from the x axis (degrees, from −90 to 90).
    pub(crate) direction_deg: f64,
    /// Linked pairs of grains in chains.
    pub(crate) links: BTreeSet<(u32, u32)>,
}

impl Chains {
    /// Returns the fraction of these chain links that also exist in a later snapshot.
    pub(crate) fn surviving(&self, later: &Self) -> f64 {
        self.links.intersection(&later.links).count() as f64 / self.links.len() as f64
    }
}

/// Finds the chains of a snapshot. Without contacts, no grains are linked.
pub(crate) fn chains(snapshot: &Snapshot) -> Chains {
    let count = snapshot.grains.len();
    let nearest = |mut between: Vector3<f64>| {
        for axis in (0..3).filter(|&axis| snapshot.periodic[axis]) {
            let length = snapshot.bounds.1[axis] - snapshot.bounds.0[axis];
            between[axis] -= length * (between[axis] / length).round();
        }
        Vector2::new(between.x, between.y)
    };
    let mut stresses = vec![Matrix2::zeros(); count];
    let mut touching = Vec::new();
    for contact in snapshot.told_contacts() {
        let force = (contact.shear_force - contact.normal * contact.normal_force).xy();
        let mut add = |id: u32, force: Vector2<f64>| {
            let grain = &snapshot.grains[id as usize - 1];
            let arm = nearest(contact.point - grain.position);
            stresses[id as usize - 1] += arm * force.transpose() / (std::f64::consts::PI * grain.radius * grain.radius);
        };
        add(contact.grain, force);
        if let Partner::Grain(other) = contact.partner {
            add(other, -force);
            let between =
                snapshot.grains[other as usize - 1].position - snapshot.grains[contact.grain as usize - 1].position;
            touching.push((contact.grain.min(other), contact.grain.max(other), nearest(between)));
        }
    }
    let principal: Vec<(f64, Vector2<f64>)> = stresses
        .iter()
        .map(|stress| {
            let eigen = SymmetricEigen::new((stress + stress.transpose()) * 0.5);
            let least = eigen.eigenvalues.imin();
            (-eigen.eigenvalues[least], eigen.eigenvectors.column(least).into_owned())
        })
        .collect();
    let mean = principal.iter().map(|(compression, _)| compression).sum::<f64>() / count as f64;
    let is_stressed = |id: u32| principal[id as usize - 1].0 > mean;
    let is_along = |id: u32, between: &Vector2<f64>| {
        principal[id as usize - 1].1.dot(between).abs() >= between.norm() * std::f64::consts::FRAC_1_SQRT_2
    };
    let linked = |&(a, b, between): &(u32, u32, Vector2<f64>)| {
        is_stressed(a) && is_stressed(b) && is_along(a, &between) && is_along(b, &between)
    };
    let links: Vec<(u32, u32)> = touching.into_iter().filter(linked).map(|(a, b, _)| (a, b)).collect();
    let groups = groups(count, &links);
    let size = |root: usize| groups.iter().filter(|&&other| other == root).count();
    let sizes: Vec<usize> = (0..count).map(|grain| if groups[grain] == grain { size(grain) } else { 0 }).collect();
    let in_chain = |id: u32| sizes[groups[id as usize - 1]] >= 3;
    // Directions have no sign, so the mean is over the doubled angle.
    let double = (1..=count as u32).filter(|&id| in_chain(id)).fold(Vector2::zeros(), |sum, id| {
        let (compression, along) = principal[id as usize - 1];
        let twice = 2.0 * along.y.atan2(along.x);
        sum + Vector2::new(twice.cos(), twice.sin()) * compression
    });
    Chains {
        stressed: (1..=count as u32).filter(|&id| is_stressed(id)).count() as f64 / count as f64,
        lengths: sizes.iter().copied().filter(|&size| size >= 3).collect(),
        direction_deg: 0.5 * double.y.atan2(double.x).to_degrees(),
        links: links.into_iter().filter(|&(a, _)| in_chain(a)).collect(),
    }
}

/// Returns the first grain of the group of each of `count` grains.
fn groups(count: usize, links: &[(u32, u32)]) -> Vec<usize> {
    let mut first: Vec<usize> = (0..count).collect();
    for &(a, b) in links {
        let (a, b) = (first[a as usize - 1], first[b as usize - 1]);
        first.iter_mut().filter(|first| **first == a.max(b)).for_each(|first| *first = a.min(b));
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_scene::scene::Grain;
    use grainbench_solver::record::{ContactState, GrainState};

    /// Checks that a row of four compressed discs is a chain, without a disc that leans on it with a small force.
    #[test]
    fn a_pressed_row_is_a_chain() {
        let grain = |id: u32, x: f64, y: f64| {
            let position = Vector3::new(x, y, 0.0);
            let start = Grain { radius: 0.5, mass: 1.0, inertia: 1.0, position, ..Grain::default() };
            GrainState::start(id, &start)
        };
        let grains: Vec<GrainState> =
            vec![grain(1, 0.5, 0.5), grain(2, 1.5, 0.5), grain(3, 2.5, 0.5), grain(4, 3.5, 0.5), grain(5, 1.0, 1.4)];
        let touch = |a: u32, b: u32, force: f64| {
            let [from, to] = [a, b].map(|id| grains[id as usize - 1].position);
            // The row is closed across the periodic boundary.
            let mut between = to - from;
            between.x -= 4.0 * (between.x / 4.0).round();
            ContactState {
                grain: a,
                partner: Partner::Grain(b),
                point: from + between * 0.5,
                normal: between.normalize(),
                overlap: 0.01,
                normal_force: force,
                ..ContactState::default()
            }
        };
        let contacts = vec![
            touch(1, 2, 5.0),
            touch(2, 3, 5.0),
            touch(3, 4, 5.0),
            touch(1, 4, 5.0),
            touch(1, 5, 0.1),
            touch(2, 5, 0.1),
        ];
        let snapshot = Snapshot {
            bounds: (Vector3::zeros(), Vector3::new(4.0, 2.0, 1.0)),
            periodic: [true, false, false],
            grains,
            contacts: Some(contacts),
            ..Snapshot::default()
        };
        let found = chains(&snapshot);
        assert_eq!((found.lengths.as_slice(), found.links.len()), ([4].as_slice(), 4));
        assert!((found.stressed - 0.8).abs() < 1e-12 && found.direction_deg.abs() < 1.0, "{found:?}");
        let mut opened = snapshot;
        opened.contacts.as_mut().unwrap().retain(|contact| contact.grain > 1 && contact.normal_force > 1.0);
        assert!(found.surviving(&found) == 1.0 && found.surviving(&chains(&opened)) < 1.0);
    }
}
