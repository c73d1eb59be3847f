//! The state of a run between two steps, from which it continues to the same bits.
//!
//! On disk: the line `grainbench checkpoint <format>`, length and hash (see `sealed`), and a [`Checkpoint`] in postcard's
//! format, which keeps every bit of a number.

use crate::scene::Scene;
use crate::sealed::{self, Broken};
use crate::text::tamed;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::{fmt, mem};
use thiserror::Error;

/// What a checkpoint begins with, before the number of its format.
const MAGIC: &[u8] = b"grainbench checkpoint ";
/// The format that this program writes: to be raised whenever anything that is stored changes its meaning or its place.
const FORMAT: u32 = 10;

/// Why a run cannot be continued from a checkpoint, or a checkpoint not be left.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum CheckpointError {
    /// Some other file.
    #[error("expected a checkpoint, which begins with `grainbench checkpoint`; found another kind of file")]
    Foreign,
    /// Written by an earlier version.
    #[error(
        "expected a checkpoint of format {FORMAT}, found format {found}: an older version of the program wrote it, and it \
         continues only there"
    )]
    Older {
        /// Its format.
        found: u32,
    },
    /// Written by a later version.
    #[error(
        "expected a checkpoint of format {FORMAT} or earlier, found format {found}: a newer version of the program wrote it"
    )]
    Newer {
        /// Its format.
        found: u32,
    },
    /// Cut off, or longer than it should be.
    #[error("expected {expected} bytes after the first line, found {found}: the checkpoint is not whole")]
    Length {
        /// Bytes there should be.
        expected: u64,
        /// Bytes there are.
        found: u64,
    },
    /// Its bytes are not those that were written.
    #[error("the checkpoint is damaged: {0}")]
    Damaged(String),
    /// It belongs to another run.
    #[error("the checkpoint is of another run: expected {what} {expected}, found {}", tamed(found, |_| false))]
    OtherRun {
        /// What differs.
        what: &'static str,
        /// Of the run that is to continue.
        expected: String,
        /// Of the checkpoint.
        found: String,
    },
    /// It could not be stored.
    #[error("{0}")]
    NotStored(String),
}

/// Which run a checkpoint belongs to: it continues no other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunIdentity {
    /// Solver and options, in words.
    pub solver: String,
    /// Title of the scene.
    pub scene: String,
    /// Hash of everything in the scene.
    pub fingerprint: String,
    /// Time step (s).
    pub time_step: f64,
    /// Steps of the whole run.
    pub steps: u64,
    /// What the solver keeps, in words that change when it does.
    pub layout: String,
}

/// What the identity of a run is taken from, when a checkpoint is.
#[derive(Clone, Debug)]
pub struct Run<'a> {
    /// Solver and options, in words.
    pub solver: String,
    /// The scene.
    pub scene: &'a Scene,
    /// Time step (s).
    pub time_step: f64,
    /// Steps of the whole run.
    pub steps: u64,
    /// What the solver keeps, in words that change when it does.
    pub layout: &'static str,
}

impl Run<'_> {
    /// The run as its checkpoints name it.
    #[must_use]
    pub fn identity(&self) -> RunIdentity {
        let &Self { ref solver, scene, time_step, steps, layout } = self;
        RunIdentity {
            solver: solver.clone(),
            scene: scene.title.clone(),
            fingerprint: fingerprint(scene).to_hex().to_string(),
            time_step,
            steps,
            layout: layout.to_owned(),
        }
    }
}

impl RunIdentity {
    fn require(&self, found: &Self) -> Result<(), CheckpointError> {
        let other = |what, expected: &dyn ToString, found: &dyn ToString| {
            Err(CheckpointError::OtherRun { what, expected: expected.to_string(), found: found.to_string() })
        };
        if self.solver != found.solver {
            return other("the solver", &self.solver, &found.solver);
        }
        if self.scene != found.scene {
            return other("the scene", &self.scene, &found.scene);
        }
        if self.time_step.to_bits() != found.time_step.to_bits() {
            return other("a time step (s) of", &self.time_step, &found.time_step);
        }
        if self.steps != found.steps {
            return other("a number of steps of", &self.steps, &found.steps);
        }
        if self.fingerprint != found.fingerprint {
            return other("a scene with the fingerprint", &self.fingerprint, &found.fingerprint);
        }
        if self.layout != found.layout {
            return other("the state of", &self.layout, &found.layout);
        }
        Ok(())
    }
}

/// The hash of everything in a scene: of the bits of its grains and of what contacts remember, which may be many, and of the
/// debug output of the rest, which tells every bit of a number.
#[must_use]
pub fn fingerprint(scene: &Scene) -> blake3::Hash {
    struct Hashed(blake3::Hasher);
    impl fmt::Write for Hashed {
        fn write_str(&mut self, text: &str) -> fmt::Result {
            self.0.update(text.as_bytes());
            Ok(())
        }
    }
    let mut rest = scene.clone();
    let (grains, springs) = (mem::take(&mut rest.grains), rest.springs.take());
    let mut hashed = Hashed(blake3::Hasher::new());
    for bits in [grains.bits(), springs.map_or_else(Vec::new, |springs| springs.bits())] {
        hashed.0.update(&bits.len().to_le_bytes());
        hashed.0.update(&bits);
    }
    // A hash takes any text.
    let _ = fmt::write(&mut hashed, format_args!("{rest:?}"));
    hashed.0.finalize()
}

/// The state of a run between two steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    identity: RunIdentity,
    step: u64,
    state: Vec<u8>,
    /// Of whoever stores it: what it needs to go on with the output of the run.
    output: Vec<u8>,
}

impl Checkpoint {
    /// Keeps a state.
    ///
    /// # Errors
    /// When the state has a part that cannot be written down.
    pub fn keep(identity: &RunIdentity, step: u64, state: &impl Serialize) -> Result<Self, CheckpointError> {
        Ok(Self { identity: identity.clone(), step, state: written(state)?, output: Vec::new() })
    }

    /// The same, with what whoever stores it needs to go on with the output of the run.
    #[must_use]
    pub fn with_output(self, output: Vec<u8>) -> Self {
        Self { output, ..self }
    }

    /// What was kept of the output of the run; nothing where nobody kept anything.
    #[must_use]
    pub fn output(&self) -> &[u8] {
        &self.output
    }

    /// Steps that were taken.
    #[must_use]
    pub const fn step(&self) -> u64 {
        self.step
    }

    /// The state, for the run that it belongs to.
    ///
    /// # Errors
    /// When it belongs to another run or cannot be read.
    pub fn state<T: DeserializeOwned>(&self, identity: &RunIdentity) -> Result<T, CheckpointError> {
        identity.require(&self.identity)?;
        postcard::from_bytes(&self.state).map_err(|error| CheckpointError::Damaged(error.to_string()))
    }

    /// The bytes of the file.
    ///
    /// # Errors
    /// Never, as far as is known.
    pub fn to_bytes(&self) -> Result<Vec<u8>, CheckpointError> {
        Ok(sealed::seal(MAGIC, FORMAT, &written(self)?))
    }

    /// Whether a file begins as a checkpoint of any format does.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn is_one(path: &std::path::Path) -> std::io::Result<bool> {
        let mut start = Vec::new();
        let file = std::fs::File::open(path)?;
        std::io::Read::read_to_end(&mut std::io::Read::take(file, MAGIC.len() as u64), &mut start)?;
        Ok(start == MAGIC)
    }

    /// A checkpoint from the bytes of a file.
    ///
    /// # Errors
    /// When the file is of another kind, of a newer format, cut off or damaged.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, CheckpointError> {
        let body = sealed::open(MAGIC, FORMAT, bytes).map_err(|broken| match broken {
            Broken::Foreign => CheckpointError::Foreign,
            Broken::Older(found) => CheckpointError::Older { found },
            Broken::Newer(found) => CheckpointError::Newer { found },
            Broken::Length(expected, found) => CheckpointError::Length { expected, found },
            Broken::Changed => CheckpointError::Damaged("its bytes are not those that were written".to_owned()),
        })?;
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
        assert!(matches!(Checkpoint::from_bytes(&longer), Err(CheckpointError::Length { .. })));
    }

    #[test]
    fn other_files_and_newer_formats_are_told_apart() {
        assert_eq!(Checkpoint::from_bytes(b"ITEM: TIMESTEP\n0\n"), Err(CheckpointError::Foreign));
        assert_eq!(Checkpoint::from_bytes(&[0; 100]), Err(CheckpointError::Foreign));
        let older = [b"grainbench checkpoint 1\n".as_slice(), &bytes()[24..]].concat();
        assert_eq!(Checkpoint::from_bytes(&older), Err(CheckpointError::Older { found: 1 }));
        let found = FORMAT + 1;
        let newer = [format!("grainbench checkpoint {found}\n").as_bytes(), &bytes()[24..]].concat();
        assert_eq!(Checkpoint::from_bytes(&newer), Err(CheckpointError::Newer { found }));
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
