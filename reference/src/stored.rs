//! Runs of other programs that are kept with the sources, so that they can be compared with where those programs are
//! not installed.

use std::fs;
use std::path::{Path, PathBuf};

use crate::file_hash::hash_file;
use crate::provenance::Provenance;
use crate::stored_error::StoredError;
use crate::thermo::{ThermoRow, read_thermo};

const PROVENANCE: &str = "provenance.toml";
const SERIES: &str = "thermo.csv";
const HALF_STEP_SERIES: &str = "thermo-half-step.csv";

/// A stored run whose files have been found to be the ones that were stored.
#[derive(Debug, Clone)]
pub struct StoredRun {
    directory: PathBuf,
    provenance: Provenance,
    thermo: Vec<ThermoRow>,
    thermo_half_step: Vec<ThermoRow>,
}

impl StoredRun {
    /// Loads the run `id` of `program` (`lammps`, …) from the folder of this crate's sources.
    ///
    /// # Errors
    /// A file is missing, changed or damaged; see [`StoredError`].
    pub fn load(program: &str, id: &str) -> Result<Self, StoredError> {
        let mut directory = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        for name in [program, id] {
            check_name(name, "a stored run")?;
            directory.push(name);
        }
        Self::load_from(&directory)
    }

    /// Loads the run in `directory`: its `provenance.toml`, every file listed there, and its two series.
    ///
    /// # Errors
    /// A file is missing, changed or damaged; see [`StoredError`].
    pub fn load_from(directory: &Path) -> Result<Self, StoredError> {
        let provenance = read_provenance(&directory.join(PROVENANCE))?;
        let mut run =
            Self { directory: directory.to_owned(), provenance, thermo: Vec::new(), thermo_half_step: Vec::new() };
        for (name, expected) in &run.provenance.blake3 {
            run.verify(name, expected)?;
        }
        run.thermo = read_thermo(&run.file(SERIES)?)?;
        run.thermo_half_step = read_thermo(&run.file(HALF_STEP_SERIES)?)?;
        run.check_twin()?;
        Ok(run)
    }

    /// The folder of the run.
    #[must_use]
    pub fn directory(&self) -> &Path {
        &self.directory
    }

    /// Where the run comes from.
    #[must_use]
    pub fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    /// What the program printed.
    #[must_use]
    pub fn thermo(&self) -> &[ThermoRow] {
        &self.thermo
    }

    /// What the program printed at the same times with half the time step: the difference is what the time step of
    /// the run is worth, its own uncertainty.
    #[must_use]
    pub fn thermo_half_step(&self) -> &[ThermoRow] {
        &self.thermo_half_step
    }

    /// The path of a file of the run that its provenance vouches for.
    ///
    /// # Errors
    /// The provenance does not list the file.
    pub fn file(&self, name: &str) -> Result<PathBuf, StoredError> {
        if self.provenance.blake3.contains_key(name) {
            return Ok(self.directory.join(name));
        }
        Err(StoredError::Unlisted { provenance: self.directory.join(PROVENANCE), name: name.to_owned() })
    }

    /// Refuses a file that is not the stored one.
    fn verify(&self, name: &str, expected: &str) -> Result<(), StoredError> {
        check_name(name, &self.directory.join(PROVENANCE).to_string_lossy())?;
        let path = self.directory.join(name);
        match hash_file(&path) {
            Ok(found) if found == expected => Ok(()),
            Ok(found) => Err(StoredError::Changed { path, expected: expected.to_owned(), found }),
            Err(source) => Err(StoredError::Unreadable { path, source }),
        }
    }

    /// Refuses a twin that was printed at other times.
    fn check_twin(&self) -> Result<(), StoredError> {
        let (run, twin) = (&self.thermo, &self.thermo_half_step);
        let differing = || StoredError::Twin {
            path: self.directory.join(HALF_STEP_SERIES),
            found: format!("{} rows where that has {}", twin.len(), run.len()),
        };
        if run.len() != twin.len() {
            return Err(differing());
        }
        for (run, twin) in run.iter().zip(twin) {
            // Steps are summed up in the programs, so that equal times differ in their last digits.
            if (run.time - twin.time).abs() > 1e-9 * run.time.max(twin.time) {
                return Err(StoredError::Twin {
                    path: self.directory.join(HALF_STEP_SERIES),
                    found: format!("{:?} where that has {:?}", twin.time, run.time),
                });
            }
        }
        Ok(())
    }
}

fn read_provenance(path: &Path) -> Result<Provenance, StoredError> {
    let text = fs::read_to_string(path).map_err(|source| StoredError::Unreadable { path: path.to_owned(), source })?;
    toml::from_str(&text).map_err(|source: toml::de::Error| {
        let place = source.span().map_or(0, |span| span.start);
        let before = text.as_bytes().get(..place).unwrap_or_default();
        StoredError::Provenance {
            path: path.to_owned(),
            line: 1 + before.iter().filter(|byte| **byte == b'\n').count(),
            source: Box::new(source),
        }
    })
}

/// Refuses a name that is a path: a stored run reads nothing outside of its folder.
fn check_name(name: &str, place: &str) -> Result<(), StoredError> {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"._-".contains(&byte);
    if !name.is_empty() && !name.starts_with('.') && name.bytes().all(plain) {
        return Ok(());
    }
    Err(StoredError::Name { place: place.to_owned(), name: name.to_owned() })
}
