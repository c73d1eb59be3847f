//! Final state of a run, and start of a run from a final state. The state contains the grains, with velocities at the
//! time of their positions, and the contact history.

use crate::contact::{MEMORY, Memory};
use crate::geometry::Geometry;
use crate::listed::Pairs;
use crate::meshes::PreviousContact;
use crate::observe::grain_states;
use crate::share::ThreadPartition;
use crate::simulation::DemSimulation;
use grainbench_scene::end_state::{EndState, Springs};
use grainbench_scene::scene::Grain;
use grainbench_solver::record::GrainState;
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Separator in the end state, between the name of a mesh wall and the number of a part of its surface.
const PART: &str = ", part ";

/// Returns the layout of the contact history as text. The arguments are the number of history values of the tangential
/// spring, that of the rolling spring, and the number of dimensions.
pub(crate) fn words([tangential, rolling, dimension]: [usize; 3]) -> String {
    format!("{tangential} numbers of a tangential and {rolling} of a rolling spring in {dimension} dimensions")
}

impl<S: Geometry> DemSimulation<S> {
    /// Returns the state after the last step, with the name of the solver. Absent grains are not included.
    pub(crate) fn final_state(&self, solver: &str) -> EndState {
        let scene = &self.scene;
        let states: Vec<_> = grain_states(self).collect();
        let place: BTreeMap<u32, u32> = states.iter().map(|grain| grain.id - 1).zip(0..).collect();
        let of_slot = |slot: u32| place[&self.grains.id[slot as usize]];
        let numbers = self.model.loops.layout().numbers;
        let pairs = self.neighbours.list.shares.iter().flat_map(|share| [&share.across.pairs, &share.near.pairs]);
        let mut springs = Springs {
            layout: words(self.model.loops.springs()),
            pairs: pairs
                .flat_map(Pairs::remembered)
                .map(|(row, partner, memory)| (of_slot(row), of_slot(partner), memory[..numbers].to_vec()))
                .collect(),
            walls: Vec::new(),
        };
        for wall in &self.walls {
            let name = &wall.initial.name;
            let near =
                wall.kept.near.iter().filter(|(_, memory)| memory[..numbers].iter().any(|&number| number != 0.0));
            let near = near.map(|(slot, memory)| (*slot, name.clone(), &memory[..numbers]));
            let held = wall.kept.at_mesh.held.iter();
            let held = held.map(|held| (held.slot, format!("{name}{PART}{}", held.group), &held.memory[..numbers]));
            springs.walls.extend(near.chain(held).map(|(slot, name, memory)| (of_slot(slot), name, memory.to_vec())));
        }
        // The order of the lists depends on the number of threads, so they are sorted.
        springs.pairs.sort_by_key(|&(first, second, _)| (first, second));
        springs.walls.sort_by(|one, other| (one.0, &one.1).cmp(&(other.0, &other.1)));
        let grain = |&GrainState { id, position, velocity, spin, .. }: &GrainState| Grain {
            position,
            velocity,
            spin,
            ..scene.grains[id as usize - 1]
        };
        EndState {
            of: [scene.title.clone(), solver.to_owned()],
            dimension: scene.dimension.count(),
            time: self.time(),
            materials: scene.materials.clone(),
            grains: states.iter().map(grain).collect(),
            springs,
        }
    }

    /// Restores the contact history with which the scene starts. It must be called before the first neighbour list is
    /// built. The history at walls that the scene does not contain is dropped.
    pub(crate) fn begin_with(&mut self, springs: &Springs) {
        let memory = |numbers: &[f64]| -> Memory<f64> {
            let mut memory = [0.0; MEMORY];
            memory.iter_mut().zip(numbers).for_each(|(memory, number)| *memory = *number);
            memory
        };
        let count = self.grains.len();
        let slot = |place: u32| self.grains.slot.get(place as usize).copied().filter(|&slot| (slot as usize) < count);
        let pairs: Vec<(u32, u32, Memory<f64>)> = springs
            .pairs
            .iter()
            .filter_map(|(first, second, numbers)| Some((slot(*first)?, slot(*second)?, memory(numbers))))
            .collect();
        let layout = self.model.loops.layout();
        if layout.numbers > 0 {
            let mut whole = ThreadPartition::new(0..count);
            whole.near.pairs = Pairs::remembering(count, layout, &pairs);
            self.neighbours.list.shares = vec![whole];
        }
        for (grain, name, numbers) in &springs.walls {
            let (name, part) =
                name.rsplit_once(PART).map_or((&name[..], None), |(wall, part)| (wall, part.parse().ok()));
            let mut walls = self.walls.iter_mut();
            let wall = walls.find(|wall| wall.initial.name == name && wall.mesh().is_some() == part.is_some());
            let (Some(wall), Some(slot)) = (wall, slot(*grain)) else { continue };
            match part {
                None => wall.kept.near.push((slot, memory(numbers))),
                // The infinite contact point prevents the contact from continuing on another part.
                Some(group) => wall.kept.at_mesh.held.push(PreviousContact {
                    slot,
                    group,
                    point: Vector3::repeat(f64::INFINITY),
                    memory: memory(numbers),
                }),
            }
        }
    }
}
