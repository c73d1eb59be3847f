//! Checkpoints: states of a run between two steps, from which the run continues bit for bit.
//!
//! A file contains the line `grainbench checkpoint <format>`, length and hash (see `sealed`), and a [`Checkpoint`] in
//! postcard's format, which keeps every bit of a number.

use grainbench_scene::scene::Scene;
use grainbench_scene::sealed::{self, SealError};
use grainbench_scene::text::tamed;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::{fmt, mem};
use thiserror::Error;

/// First bytes of a checkpoint, before the format number.
const MAGIC: &[u8] = b"grainbench checkpoint ";
/// Format that this program writes. It must be increased whenever the meaning or the position of stored data changes.
const FORMAT: u32 = 10;

/// Reason why a run cannot continue from a checkpoint, or why a checkpoint cannot be stored.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum CheckpointError {
    /// Wrong file type, format or length, or a checksum that does not match.
    #[error("{}", seal_words(.0))]
    NotSealed(SealError),
    /// Data that do not fit together or to the scene.
    #[error("the checkpoint is damaged: {0}")]
    Damaged(String),
    /// Checkpoint of another run.
    #[error("the checkpoint belongs to another run: expected {what} {expected}, found {}", tamed(found, |_| false))]
    OtherRun {
        /// Property that differs.
        what: &'static str,
        /// Value of the run that is to continue.
        expected: String,
        /// Value in the checkpoint.
        found: String,
    },
    /// The checkpoint could not be stored.
    #[error("{0}")]
    NotStored(String),
}

/// Returns the message for bytes that are not a sealed checkpoint of this format.
fn seal_words(error: &SealError) -> String {
    match error {
        SealError::Foreign => {
            "expected a checkpoint, which begins with `grainbench checkpoint`; found another kind of file".to_owned()
        }
        SealError::Older(found) => format!(
            "expected a checkpoint of format {FORMAT}, found format {found}: an older version of the program wrote it, \
             and only that version can continue it"
        ),
        SealError::Newer(found) => format!(
            "expected a checkpoint of format {FORMAT} or earlier, found format {found}: a newer version of the program \
             wrote it"
        ),
        SealError::Length(expected, found) => {
            format!("expected {expected} bytes after the first line, found {found}: the checkpoint is incomplete")
        }
        SealError::Changed => "the checkpoint is damaged: its bytes differ from the written bytes".to_owned(),
    }
}

/// Identity of a run. A checkpoint continues only a run of the same identity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunIdentity {
    /// Solver and options, as text.
    pub solver: String,
    /// Title of the scene.
    pub scene: String,
    /// Hash of all data of the scene.
    pub fingerprint: String,
    /// Time step (s).
    pub time_step: f64,
    /// Number of steps of the whole run.
    pub steps: u64,
    /// Text that identifies the layout of the solver's state.
    pub layout: String,
}

impl RunIdentity {
    /// Returns the properties with their names, in the order in which they are compared.
    fn properties(&self) -> [(&'static str, String); 6] {
        [
            ("the solver", self.solver.clone()),
            ("the scene", self.scene.clone()),
            ("a time step (s) of", self.time_step.to_string()),
            ("a number of steps of", self.steps.to_string()),
            ("a scene with the fingerprint", self.fingerprint.clone()),
            ("the state of", self.layout.clone()),
        ]
    }

    /// Compares properties as text, which shows all digits of the time step.
    fn require(&self, found: &Self) -> Result<(), CheckpointError> {
        for ((what, expected), (_, found)) in self.properties().into_iter().zip(found.properties()) {
            if expected != found {
                return Err(CheckpointError::OtherRun { what, expected, found });
            }
        }
        Ok(())
    }
}

/// Returns the hash of all data of a scene. Grains and contact history may be large, so their bytes are hashed. All
/// other data are hashed as debug output, which shows all digits of a number.
#[must_use]
pub fn fingerprint(scene: &Scene) -> blake3::Hash {
    struct HashWriter(blake3::Hasher);
    impl fmt::Write for HashWriter {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            self.0.update(text.as_bytes());
            Ok(())
        }
    }
    let mut rest = scene.clone();
    let (grains, springs) = (mem::take(&mut rest.grains), rest.springs.take());
    let mut hashed = HashWriter(blake3::Hasher::new());
    for bits in [grains.bits(), springs.map_or_else(Vec::new, |springs| springs.bits())] {
        hashed.0.update(&bits.len().to_le_bytes());
        hashed.0.update(&bits);
    }
    // Writing to a hash cannot fail.
    let _ = fmt::write(&mut hashed, format_args!("{rest:?}"));
    hashed.0.finalize()
}

/// State of a run between two steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    identity: RunIdentity,
    step: u64,
    state: Vec<u8>,
    /// Data that the storing program needs to continue the output of the run.
    output: Vec<u8>,
}

impl Checkpoint {
    /// Creates a checkpoint with a state after `step` steps.
    ///
    /// # Errors
    /// When a part of the state cannot be serialised.
    pub fn keep(identity: &RunIdentity, step: u64, state: &impl Serialize) -> Result<Self, CheckpointError> {
        Ok(Self { identity: identity.clone(), step, state: written(state)?, output: Vec::new() })
    }

    /// Adds data that the storing program needs to continue the output of the run.
    #[must_use]
    pub fn with_output(self, output: Vec<u8>) -> Self {
        Self { output, ..self }
    }

    /// Returns the stored data on the output of the run; empty if there are none.
    #[must_use]
    pub fn output(&self) -> &[u8] {
        &self.output
    }

    /// Returns the number of steps taken.
    #[must_use]
    pub const fn step(&self) -> u64 {
        self.step
    }

    /// Returns the state, if it belongs to this run.
    ///
    /// # Errors
    /// When the state belongs to another run or cannot be read.
    pub fn state<T: DeserializeOwned>(&self, identity: &RunIdentity) -> Result<T, CheckpointError> {
        identity.require(&self.identity)?;
        postcard::from_bytes(&self.state).map_err(|error| CheckpointError::Damaged(error.to_string()))
    }

    /// Returns the bytes of the file.
    ///
    /// # Errors
    /// When the checkpoint cannot be serialised. No such case is known.
    pub fn to_bytes(&self) -> Result<Vec<u8>, CheckpointError> {
        Ok(sealed::seal(MAGIC, FORMAT, &written(self)?))
    }

    /// Returns true if a file begins as a checkpoint of any format does.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn is_one(path: &std::path::Path) -> std::io::Result<bool> {
        let mut start = Vec::new();
        let file = std::fs::File::open(path)?;
        std::io::Read::read_to_end(&mut std::io::Read::take(file, MAGIC.len() as u64), &mut start)?;
        Ok(start == MAGIC)
    }

    /// Reads a checkpoint from the bytes of a file.
    ///
    /// # Errors
    /// When the file is of another kind or another format, truncated or damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, CheckpointError> {
        let body = sealed::open(MAGIC, FORMAT, bytes).map_err(CheckpointError::NotSealed)?;
        postcard::from_bytes(body).map_err(|error| CheckpointError::Damaged(error.to_string()))
    }
}

fn written(value: &impl Serialize) -> Result<Vec<u8>, CheckpointError> {
    postcard::to_allocvec(value).map_err(|error| CheckpointError::NotStored(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn identity() -> RunIdentity {
        RunIdentity {
            solver: "dem".to_owned(),
            scene: "A disc".to_owned(),
            fingerprint: "0".to_owned(),
            time_step: 0.1,
            steps: 10,
            layout: "numbers".to_owned(),
        }
    }

    fn bytes() -> Vec<u8> {
        Checkpoint::keep(&identity(), 3, &vec![0.1_f64, -0.0, f64::MIN_POSITIVE]).unwrap().to_bytes().unwrap()
    }

    #[test]
    fn a_state_comes_back_in_every_bit() {
        let checkpoint = Checkpoint::from_bytes(&bytes()).unwrap();
        let state: Vec<f64> = checkpoint.state(&identity()).unwrap();
        assert_eq!(checkpoint.step(), 3);
        let bits: Vec<u64> = state.iter().map(|value| value.to_bits()).collect();
        assert_eq!(bits, [0.1_f64, -0.0, f64::MIN_POSITIVE].map(f64::to_bits));
    }

    #[test]
    fn wherever_it_is_cut_or_changed_it_is_refused() {
        let whole = bytes();
        for length in 0..whole.len() {
            assert!(Checkpoint::from_bytes(&whole[..length]).is_err(), "cut at {length}");
            let mut changed = whole.clone();
            changed[length] ^= 1;
            assert!(Checkpoint::from_bytes(&changed).is_err(), "changed at {length}");
        }
        let longer = [whole.as_slice(), b"x"].concat();
        assert!(matches!(Checkpoint::from_bytes(&longer), Err(CheckpointError::NotSealed(SealError::Length(..)))));
    }

    #[test]
    fn other_files_and_newer_formats_are_told_apart() {
        let (after, newer) = (&bytes()[24..], FORMAT + 1);
        for (start, expected) in [
            ("ITEM: TIMESTEP\n0\n".to_owned(), SealError::Foreign),
            ("\0".repeat(100), SealError::Foreign),
            ("grainbench checkpoint 1\n".to_owned(), SealError::Older(1)),
            (format!("grainbench checkpoint {newer}\n"), SealError::Newer(newer)),
        ] {
            let read = Checkpoint::from_bytes(&[start.as_bytes(), after].concat());
            assert_eq!(read, Err(CheckpointError::NotSealed(expected)), "{start}");
        }
    }

    #[test]
    fn it_continues_no_other_run() {
        let checkpoint = Checkpoint::from_bytes(&bytes()).unwrap();
        let others = [
            RunIdentity { solver: "dem:lammps".to_owned(), ..identity() },
            RunIdentity { scene: "Another".to_owned(), ..identity() },
            RunIdentity { fingerprint: "1".to_owned(), ..identity() },
            RunIdentity { time_step: 0.2, ..identity() },
            RunIdentity { steps: 11, ..identity() },
            RunIdentity { layout: "words".to_owned(), ..identity() },
        ];
        for other in others {
            let refused = checkpoint.state::<Vec<f64>>(&other).unwrap_err();
            assert!(matches!(refused, CheckpointError::OtherRun { .. }), "{other:?}");
        }
    }
}
