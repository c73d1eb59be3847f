//! Files of final states.
//!
//! A file contains the line `grainbench state <format>`, length and hash (see `sealed`), and a zlib stream of an
//! [`EndState`] in postcard's format, which keeps every bit of a number. `rounded_state` describes a smaller form.

use crate::end_state::{EndState, Springs};
use crate::rounded_state::{self, PackedState};
use crate::scene::Grain;
use crate::sealed::{self, SealError};
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use nalgebra::Vector3;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::io::{Read, Write};

/// First bytes of a file, before the format number.
const MAGIC: &[u8] = b"grainbench state ";
/// Format that this program writes.
const FORMAT: u32 = 1;
/// Largest decompressed size of a state (B).
const MOST: u64 = 1 << 32;

impl EndState {
    /// Returns the bytes of a file that keeps every bit of the state.
    ///
    /// # Errors
    /// When a part of the state cannot be serialised; the error is a message.
    pub fn to_bytes(&self) -> Result<Vec<u8>, String> {
        sealed_body(self, MAGIC, FORMAT)
    }

    /// Returns the bytes of a file about half as large as that of [`Self::to_bytes`]. Positions, velocities, spins and
    /// springs are rounded.
    ///
    /// # Errors
    /// When a part of the state cannot be rounded; the error is a message.
    pub fn to_rounded_bytes(&self) -> Result<Vec<u8>, String> {
        sealed_body(&PackedState::new(self, rounded_state::ROUNDING)?, rounded_state::MAGIC, rounded_state::FORMAT)
    }

    /// Returns the bytes of a file for a bed at rest. A sphere takes about 12 B, compared with about 70 B in a file of
    /// [`Self::to_rounded_bytes`] with springs. Positions are rounded more coarsely. Velocities, spins and springs are
    /// omitted.
    ///
    /// # Errors
    /// When a part of the state cannot be rounded; the error is a message.
    pub fn to_bytes_at_rest(&self) -> Result<Vec<u8>, String> {
        let at_rest = |grain: &Grain| Grain { velocity: Vector3::zeros(), spin: Vector3::zeros(), ..*grain };
        let grains = self.grains.iter().map(at_rest).collect();
        let state = Self {
            of: self.of.clone(),
            materials: self.materials.clone(),
            grains,
            springs: Springs::default(),
            ..*self
        };
        let packed = PackedState::new(&state, rounded_state::ROUNDING_AT_REST)?;
        sealed_body(&packed, rounded_state::MAGIC, rounded_state::FORMAT)
    }

    /// Reads a state from the bytes of an exact or a rounded file.
    ///
    /// # Errors
    /// When the bytes are not a valid state. The error is a description of the found data.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, String> {
        let state: Self = if bytes.starts_with(rounded_state::MAGIC) {
            body_of::<PackedState>(bytes, rounded_state::MAGIC, rounded_state::FORMAT)?.state()?
        } else {
            body_of(bytes, MAGIC, FORMAT)?
        };
        let count = state.grains.len();
        let is_place = |place: &u32| (*place as usize) < count;
        let of_grains = state.springs.pairs.iter().all(|(a, b, _)| a != b && is_place(a) && is_place(b))
            && state.springs.walls.iter().all(|(grain, ..)| is_place(grain))
            && state.grains.iter().all(|grain| usize::from(grain.material) < state.materials.len());
        let numbers = |grain: &Grain| [grain.position, grain.velocity, grain.spin].iter().all(is_finite);
        let of_springs = |memory: &[f64]| memory.iter().all(|number| number.is_finite());
        let finite = state.grains.iter().all(numbers)
            && state.springs.pairs.iter().all(|(.., memory)| of_springs(memory))
            && state.springs.walls.iter().all(|(.., memory)| of_springs(memory));
        match (of_grains, finite) {
            (true, true) => Ok(state),
            (true, false) => Err("a number that is not finite".to_owned()),
            (false, _) => Err("springs or materials of grains that the file does not contain".to_owned()),
        }
    }
}

fn is_finite(vector: &Vector3<f64>) -> bool {
    vector.iter().all(|number| number.is_finite())
}

/// Returns the bytes of a sealed file with a compressed value.
fn sealed_body(body: &impl Serialize, magic: &[u8], format: u32) -> Result<Vec<u8>, String> {
    let body = postcard::to_allocvec(body).map_err(|error| error.to_string())?;
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::default());
    let packed = packed.write_all(&body).and_then(|()| packed.finish()).map_err(|error| error.to_string())?;
    Ok(sealed::seal(magic, format, &packed))
}

/// Reads the compressed value in a sealed file.
fn body_of<T: DeserializeOwned>(bytes: &[u8], magic: &[u8], format: u32) -> Result<T, String> {
    let packed = sealed::open(magic, format, bytes).map_err(|broken| match broken {
        SealError::Foreign => "another kind of file".to_owned(),
        SealError::Older(found) => format!("format {found}, which an older version of the program wrote"),
        SealError::Newer(found) => format!("format {found}, which a newer version of the program wrote"),
        SealError::Length(expected, found) => {
            format!("{found} bytes instead of the stated {expected}; the file is truncated or changed")
        }
        SealError::Changed => "bytes that differ from the written bytes".to_owned(),
    })?;
    let mut body = Vec::new();
    let unpacked = ZlibDecoder::new(packed).take(MOST).read_to_end(&mut body);
    unpacked.map_err(|error| error.to_string())?;
    postcard::from_bytes(&body).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state() -> EndState {
        let grain = |x: f64| Grain {
            material: 0,
            radius: 0.5,
            mass: 1.0,
            inertia: 0.1,
            position: Vector3::new(x, -0.0, f64::from_bits(1)),
            velocity: Vector3::x(),
            spin: Vector3::z(),
        };
        let springs = Springs {
            layout: "numbers".to_owned(),
            pairs: vec![(0, 1, vec![0.25])],
            walls: vec![(1, "floor".to_owned(), vec![-0.5])],
        };
        let origin = ["a".to_owned(), "dem".to_owned()];
        let materials = vec!["m".to_owned()];
        EndState { of: origin, dimension: 3, time: 1.5, materials, grains: vec![grain(0.1), grain(0.2)], springs }
    }

    /// Positions move by at most half a rounding step. The step is 2⁻²⁰ · 2⁻¹ m, because the smallest radius is 2⁻¹ m.
    #[test]
    fn a_bed_at_rest_keeps_its_places_and_nothing_else() {
        let bytes = state().to_bytes_at_rest().unwrap();
        let back = EndState::from_bytes(&bytes).unwrap();
        assert!(bytes.len() < state().to_rounded_bytes().unwrap().len());
        assert_eq!(back.springs, Springs::default());
        for (grain, given) in back.grains.iter().zip(state().grains) {
            assert!((grain.position - given.position).amax() <= 0.25 / f64::from(1 << 20));
            let still = Vector3::zeros();
            assert_eq!(grain, &Grain { position: grain.position, velocity: still, spin: still, ..given });
        }
    }

    #[test]
    fn a_state_comes_back_in_every_bit_and_wherever_it_is_cut_or_changed_it_is_refused() {
        let whole = state().to_bytes().unwrap();
        assert_eq!(format!("{:?}", EndState::from_bytes(&whole).unwrap()), format!("{:?}", state()));
        for whole in [whole, state().to_rounded_bytes().unwrap()] {
            for length in 0..whole.len() {
                assert!(EndState::from_bytes(&whole[..length]).is_err(), "cut at {length}");
                let mut changed = whole.clone();
                changed[length] ^= 1;
                assert!(EndState::from_bytes(&changed).is_err(), "changed at {length}");
            }
        }
        let strange =
            EndState { springs: Springs { pairs: vec![(0, 2, Vec::new())], ..Springs::default() }, ..state() };
        assert!(EndState::from_bytes(&strange.to_bytes().unwrap()).is_err());
        assert!(EndState::from_bytes(&strange.to_rounded_bytes().unwrap()).is_err());
    }

    #[test]
    fn a_state_is_rounded_once_and_by_as_much_as_is_said() {
        let mut exact = state();
        // The state has two sizes of grains, two walls, and contacts in which the first index is the smaller or the
        // larger one.
        let position = Vector3::new(-70.1, 1.0 / 3.0, 1e-3);
        let third = Grain { radius: 0.3, mass: 0.2, inertia: 0.05, position, ..exact.grains[0] };
        exact.grains.push(third);
        exact.grains[1].velocity = Vector3::new(1.0 / 3.0, -1e-30, 7.0);
        exact.springs.pairs = vec![(0, 2, vec![0.1]), (1, 0, vec![-1e-5]), (1, 2, vec![0.0])];
        exact.springs.walls = vec![(0, "right".to_owned(), vec![0.7]), (2, "floor".to_owned(), vec![-0.5])];
        let bytes = exact.to_rounded_bytes().unwrap();
        let rounded = EndState::from_bytes(&bytes).unwrap();
        assert_eq!(rounded.to_rounded_bytes().unwrap(), bytes, "rounding what is rounded changes nothing");
        // The smallest radius, 0.3 m, lies between 2⁻² m and 2⁻¹ m.
        let step = (-2.0_f64 - 36.0).exp2();
        for (found, exact) in rounded.grains.iter().zip(&exact.grains) {
            let Grain { position, velocity, spin, .. } = *found;
            assert_eq!(*found, Grain { position, velocity, spin, ..*exact });
            assert!((found.position - exact.position).amax() <= 0.5 * step);
            for (found, exact) in found.velocity.iter().zip(&exact.velocity).chain(found.spin.iter().zip(&exact.spin)) {
                assert!((found - exact).abs() <= exact.abs() * (-24.0_f64).exp2());
            }
        }
        assert!((rounded.grains[2].position.y - 1.0 / 3.0).abs() > 1e-3 * step, "a third is no multiple");
        let spring_texts = |springs: &Springs| {
            let pairs = springs.pairs.iter().map(|(a, b, memory)| format!("{a} {b} {}", memory[0] as f32));
            pairs
                .chain(springs.walls.iter().map(|(a, b, memory)| format!("{a} {b} {}", memory[0] as f32)))
                .collect::<Vec<_>>()
        };
        assert_eq!(spring_texts(&rounded.springs), spring_texts(&exact.springs));
        // Values that cannot be rounded are rejected.
        exact.grains[0].position.x = 1e9;
        assert!(exact.to_rounded_bytes().is_err());
        exact.grains[0].position.x = f64::NAN;
        assert!(exact.to_rounded_bytes().is_err());
        exact.grains[0].position.x = 0.0;
        exact.springs.pairs[0].2.push(1.0);
        assert!(exact.to_rounded_bytes().is_err());
    }
}
