//! Rounded form of a final state, about half as large as the exact form. For a scene of a hundred thousand grains, the
//! file is small enough for a source repository.
//!
//! Values are rounded once, when the file is written, so that every solver starts from the same numbers. The roundings
//! are:
//!
//! ```text
//! positions                    to whole multiples of s = 2⁻³⁶ of the power of two at or below the smallest radius
//! velocities, spins, springs   to 24 bits
//! sizes, materials, contacts   not at all
//! ```
//!
//! A centre moves by at most s/2 along each axis. The force of a contact of stiffness k thus changes by less than √3 k
//! s. For spheres of diameter d and weight mg with k = 2·10⁵ mg/d, this change is 3·10⁻⁶ mg. Overlaps in a heap are of
//! the order of 10⁻⁴ d, which is 10⁷ rounding steps. The heap comes to rest again within a few contact times. The
//! contact springs, which support the heap, keep their values within a relative error of 6·10⁻⁸.
//!
//! The file of a bed at rest without springs is even smaller: the rounding step is 2⁻²⁰ of the same power of two, and
//! velocities and spins are omitted. For spheres of radius 1 mm with E = 1 GPa (material M1), this step is 9·10⁻¹⁰ m.
//! For comparison, the weight of a single grain causes an overlap of 3.5·10⁻⁸ m.
//!
//! A file contains the line `grainbench rounded state <format>`, length and hash (see `sealed`), and a zlib stream of a
//! [`PackedState`] in postcard's format. Each column stores the lowest bytes of all numbers first, then the next bytes,
//! and so on. The high bytes of different numbers hardly differ, so they compress well.

use crate::end_state::{EndState, Springs};
use crate::scene::Grain;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// First bytes of a file, before the format number.
pub(crate) const MAGIC: &[u8] = b"grainbench rounded state ";
/// Format that this program writes.
pub(crate) const FORMAT: u32 = 1;
/// Rounding step of positions, in units of the power of two at or below the smallest radius: 2⁻³⁶.
pub(crate) const ROUNDING: f64 = 1.0 / (1_u64 << 36) as f64;
/// Rounding step of positions in a bed at rest, in the same units: 2⁻²⁰.
pub(crate) const ROUNDING_AT_REST: f64 = 1.0 / (1_u64 << 20) as f64;
/// Largest multiple of the rounding step that a position may be, so that multiples are exact.
const FARTHEST: f64 = (1_u64 << 53) as f64;

/// Rounded state with its data in columns.
#[derive(Serialize, Deserialize)]
pub(crate) struct PackedState {
    of: [String; 2],
    dimension: usize,
    time: f64,
    materials: Vec<String>,
    /// Rounding step of positions (m).
    step: f64,
    /// Combinations of material, and radius (m), mass (kg; kg per metre of depth for discs) and moment of inertia (kg m²).
    kinds: Vec<(u16, [f64; 3])>,
    layout: String,
    /// Number of history values per contact.
    numbers: u32,
    /// Names of the walls in the contact history.
    names: Vec<String>,
    /// Columns of the grains: index in `kinds`, position as multiples of the step along three axes, velocity and spin.
    grains: [Vec<u8>; 10],
    /// Columns of the contacts between grains. The first column is the first grain index, less that of the previous
    /// contact. The second column is the second grain index, less the first index.
    pairs: [Vec<u8>; 2],
    /// Columns of the contacts with walls. The first column is the grain index, less that of the previous contact. The
    /// second column is the index of the wall in `names`.
    walls: [Vec<u8>; 2],
    /// History values, one column per value: first of the contacts between grains, then of the contacts with walls.
    springs: Vec<Vec<u8>>,
}

/// Returns the largest power of two that is not above a number, from its exponent.
fn power_of_two(number: f64) -> f64 {
    f64::from_bits(number.to_bits() & f64::INFINITY.to_bits())
}

/// Returns the column of numbers: the lowest bytes of all numbers, then the next bytes, and so on.
fn column<const N: usize>(numbers: impl Iterator<Item = [u8; N]>) -> Vec<u8> {
    let all: Vec<[u8; N]> = numbers.collect();
    (0..N).flat_map(|byte| all.iter().map(move |number| number[byte])).collect()
}

/// Returns the numbers of a column, each as its bytes from lowest to highest.
fn numbers<const N: usize>(column: &[u8]) -> Result<Vec<[u8; N]>, String> {
    if !column.len().is_multiple_of(N) {
        return Err(format!("a column of {} bytes, although each number has {N}", column.len()));
    }
    let count = column.len() / N;
    Ok((0..count).map(|at| std::array::from_fn(|byte| column[byte * count + at])).collect())
}

fn singles(values: impl Iterator<Item = f64>) -> Vec<u8> {
    column(values.map(|value| (value as f32).to_le_bytes()))
}

fn read_singles(column: &[u8]) -> Result<Vec<f64>, String> {
    Ok(numbers(column)?.into_iter().map(|bytes| f64::from(f32::from_le_bytes(bytes))).collect())
}

/// Returns the column of the differences between two indices: the first of each pair less the second.
fn places(values: impl Iterator<Item = (u32, u32)>) -> Vec<u8> {
    column(values.map(|(place, from)| place.wrapping_sub(from).to_le_bytes()))
}

fn read_places(column: &[u8]) -> Result<Vec<u32>, String> {
    Ok(numbers(column)?.into_iter().map(u32::from_le_bytes).collect())
}

/// Returns the cumulative sums of differences, which are indices.
fn following(steps: &[u32]) -> Vec<u32> {
    let mut place = 0_u32;
    let next = |step: &u32| {
        place = place.wrapping_add(*step);
        place
    };
    steps.iter().map(next).collect()
}

/// Returns each index with the previous index; 0 precedes the first index.
fn after(places: &[u32]) -> impl Iterator<Item = (u32, u32)> + '_ {
    places.iter().copied().zip(std::iter::once(0).chain(places.iter().copied()))
}

impl PackedState {
    /// Creates the rounded form of a state. The rounding step of positions is `rounding` times the largest power of two
    /// at or below the smallest radius (m).
    pub(crate) fn new(state: &EndState, rounding: f64) -> Result<Self, String> {
        let smallest = state.grains.iter().map(|grain| grain.radius).fold(f64::INFINITY, f64::min);
        let step = if smallest.is_finite() { power_of_two(smallest) * rounding } else { 1.0 };
        let far = |grain: &Grain| !grain.position.iter().all(|&along| (along / step).abs() < FARTHEST);
        if step <= 0.0 || state.grains.iter().any(far) {
            return Err("a grain that is too far away or too small to be rounded".to_owned());
        }
        let mut kinds = Vec::new();
        let mut known = BTreeMap::new();
        let mut kind = |grain: &Grain| {
            let size = [grain.radius, grain.mass, grain.inertia];
            *known.entry((grain.material, size.map(f64::to_bits))).or_insert_with(|| {
                kinds.push((grain.material, size));
                kinds.len() as u32 - 1
            })
        };
        let of_kinds = places(state.grains.iter().map(|grain| (kind(grain), 0)));
        let position = |axis: usize| {
            column(state.grains.iter().map(|grain| ((grain.position[axis] / step).round() as i64).to_le_bytes()))
        };
        let velocity = |axis: usize| singles(state.grains.iter().map(|grain| grain.velocity[axis]));
        let spin = |axis: usize| singles(state.grains.iter().map(|grain| grain.spin[axis]));
        let ([x, y, z], [v_x, v_y, v_z]) = ([0, 1, 2].map(position), [0, 1, 2].map(velocity));
        let [spin_x, spin_y, spin_z] = [0, 1, 2].map(spin);
        let Springs { layout, pairs, walls } = &state.springs;
        let memories = || pairs.iter().map(|pair| &pair.2).chain(walls.iter().map(|wall| &wall.2));
        let count = memories().next().map_or(0, Vec::len);
        if memories().any(|memory| memory.len() != count) {
            return Err("contacts with different amounts of history".to_owned());
        }
        let mut names: Vec<String> = walls.iter().map(|wall| wall.1.clone()).collect();
        names.sort();
        names.dedup();
        let name = |word: &String| names.binary_search(word).unwrap_or_default() as u32;
        let firsts: Vec<u32> = pairs.iter().map(|pair| pair.0).collect();
        let at_walls: Vec<u32> = walls.iter().map(|wall| wall.0).collect();
        Ok(Self {
            of: state.of.clone(),
            dimension: state.dimension,
            time: state.time,
            materials: state.materials.clone(),
            step,
            grains: [of_kinds, x, y, z, v_x, v_y, v_z, spin_x, spin_y, spin_z],
            pairs: [places(after(&firsts)), places(pairs.iter().map(|pair| (pair.1, pair.0)))],
            walls: [places(after(&at_walls)), places(walls.iter().map(|wall| (name(&wall.1), 0)))],
            springs: (0..count).map(|number| singles(memories().map(|memory| memory[number]))).collect(),
            kinds,
            layout: layout.clone(),
            numbers: count as u32,
            names,
        })
    }

    /// Returns the state with the rounded values.
    pub(crate) fn state(&self) -> Result<EndState, String> {
        let kinds = read_places(&self.grains[0])?;
        let [x, y, z] = [1, 2, 3].map(|axis| numbers::<8>(&self.grains[axis]));
        let positions = [x?, y?, z?];
        let singles: Vec<Vec<f64>> =
            self.grains[4..].iter().map(|singles_of| read_singles(singles_of)).collect::<Result<_, _>>()?;
        let lengths = positions.iter().map(Vec::len).chain(singles.iter().map(Vec::len));
        let firsts = following(&read_places(&self.pairs[0])?);
        let seconds = read_places(&self.pairs[1])?;
        let at_walls = following(&read_places(&self.walls[0])?);
        let names = read_places(&self.walls[1])?;
        let springs: Vec<Vec<f64>> =
            self.springs.iter().map(|singles_of| read_singles(singles_of)).collect::<Result<_, _>>()?;
        let contacts = firsts.len() + at_walls.len();
        let fits = lengths.into_iter().all(|length| length == kinds.len())
            && kinds.iter().all(|&kind| (kind as usize) < self.kinds.len())
            && seconds.len() == firsts.len()
            && names.len() == at_walls.len()
            && names.iter().all(|&name| (name as usize) < self.names.len())
            && springs.len() == self.numbers as usize
            && springs.iter().all(|singles_of| singles_of.len() == contacts);
        if !fits {
            return Err("columns of different lengths".to_owned());
        }
        let vector = |component: &dyn Fn(usize) -> f64| Vector3::new(component(0), component(1), component(2));
        let grain = |(at, &kind): (usize, &u32)| {
            let (material, [radius, mass, inertia]) = self.kinds[kind as usize];
            Grain {
                material,
                radius,
                mass,
                inertia,
                position: vector(&|axis| i64::from_le_bytes(positions[axis][at]) as f64 * self.step),
                velocity: vector(&|axis| singles[axis][at]),
                spin: vector(&|axis| singles[3 + axis][at]),
            }
        };
        let memory = |contact: usize| springs.iter().map(|singles_of| singles_of[contact]).collect::<Vec<f64>>();
        let pair = |(at, (&first, &second)): (usize, (&u32, &u32))| (first, first.wrapping_add(second), memory(at));
        let wall = |(at, (&grain, &name)): (usize, (&u32, &u32))| {
            (grain, self.names[name as usize].clone(), memory(firsts.len() + at))
        };
        Ok(EndState {
            of: self.of.clone(),
            dimension: self.dimension,
            time: self.time,
            materials: self.materials.clone(),
            grains: kinds.iter().enumerate().map(grain).collect(),
            springs: Springs {
                layout: self.layout.clone(),
                pairs: firsts.iter().zip(&seconds).enumerate().map(pair).collect(),
                walls: at_walls.iter().zip(&names).enumerate().map(wall).collect(),
            },
        })
    }
}
