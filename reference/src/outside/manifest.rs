//! `SOLVER.toml`, which describes the commands, the features and the output of a program.

use crate::observer::Names;
use crate::read::read_error::{one_line, quoted};
use grainbench_scene::contact_law::SpringsKind;
use grainbench_scene::effect::Effect;
use grainbench_scene::material::ConstitutiveKind;
use grainbench_scene::text::{line_of, written};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Component, Path};
use thiserror::Error;

/// Characters that are allowed in the name of a program in addition to letters and digits.
const IN_NAMES: &str = "-_.+ ";

/// Checked content of a manifest.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// Name of the solver in results.
    pub name: String,
    /// Command that prints the version. Its first line is stored in the provenance of the runs.
    #[serde(default)]
    pub version: Vec<String>,
    /// Command of a run.
    ///
    /// The program is started in a new folder. `{scene}` is replaced by the file with the scene, `{out}` by this
    /// folder, and `{here}` by the folder of the manifest. A word that names a file beside the manifest is replaced
    /// by its path.
    #[serde(default)]
    pub run: Vec<String>,
    /// Alternative to `run`: command of a program that keeps running and accepts one run per line.
    #[serde(default)]
    pub worker: Vec<String>,
    /// Command that is executed once in the folder of the manifest, before the first run. It is not timed.
    #[serde(default)]
    pub prepare: Vec<String>,
    /// Further files of the adapter, by their paths relative to the manifest. They are part of its fingerprint, so
    /// stored results depend on them.
    #[serde(default)]
    pub files: Vec<String>,
    /// Format of the scene.
    #[serde(default)]
    pub scene: SceneFormat,
    /// Features of the program.
    pub can: Capabilities,
    /// Parameters of the runs that measure convergence and computing time.
    #[serde(default)]
    pub knobs: ParameterValues,
    /// Output of the program.
    pub output: Output,
    /// Limits of a run.
    #[serde(default)]
    pub limits: Limits,
}

/// Format of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SceneFormat {
    /// JSON.
    #[default]
    Json,
    /// TOML.
    Toml,
}

/// Features that a program declares. A scene that requires more is not run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Capabilities {
    /// Supported numbers of dimensions.
    pub dimension: Vec<usize>,
    /// Contact laws of grains that keep their shape.
    #[serde(default)]
    pub laws: Vec<SpringsKind>,
    /// Constitutive laws, for programs with deformable grains and bodies.
    #[serde(default)]
    pub deformable: Vec<ConstitutiveKind>,
    /// Supported shapes of walls.
    #[serde(default)]
    pub walls: Vec<Wall>,
    /// Effects other than gravity, by the names of [`Effect::key_word`].
    #[serde(default)]
    pub effects: Vec<String>,
    /// True if the program supports driven grains.
    #[serde(default)]
    pub driven: bool,
}

/// Shape of a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Wall {
    /// Plane.
    Plane,
    /// Segment, in two dimensions.
    Segment,
    /// Rectangle, in three dimensions.
    Rectangle,
    /// Side of a cylinder or cone.
    Round,
    /// Mesh of triangles.
    Mesh,
}

/// Parameters that are varied.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct ParameterValues {
    /// Time steps as fractions of the critical time step.
    #[serde(default)]
    pub critical_fraction: Vec<f64>,
    /// Cells per reference length of the scene. This is the radius of a grain if there are grains.
    #[serde(default)]
    pub cells: Vec<f64>,
}

/// Output files of a run, by their paths in the folder of the run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Grains at every sample.
    #[serde(default)]
    pub grains: Option<Grains>,
    /// Contact forces at the same steps, as a dump in the format of LAMMPS.
    #[serde(default)]
    pub contacts: Option<String>,
    /// Table with further columns of the scene's series.
    #[serde(default)]
    pub series: Option<String>,
    /// Report of the program about its run.
    #[serde(default)]
    pub report: Option<String>,
}

/// File with the grains.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grains {
    /// Path of the file.
    pub path: String,
    /// Format of the file.
    pub format: GrainFormat,
    /// Names of its columns, for example `x = "position_x"`.
    #[serde(default)]
    pub map: BTreeMap<String, String>,
}

impl Grains {
    /// Returns the names of the columns.
    #[must_use]
    pub fn names(&self) -> Names {
        Names(self.map.iter().map(|(ours, theirs)| (ours.clone(), theirs.clone())).collect())
    }
}

/// Format of grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum GrainFormat {
    /// Dump in the format of LAMMPS, which LIGGGHTS uses too.
    #[serde(alias = "liggghts")]
    Lammps,
    /// Table with one row per grain and sample, as text or Parquet.
    #[serde(alias = "parquet")]
    Csv,
    /// NumPy arrays `position`, `velocity` and `spin` of the shape (samples, grains, 3), and `step`.
    Npz,
    /// VTK files, one per sample, where `*` in the path replaces the step. An HDF5 file with all samples is possible
    /// too.
    #[serde(alias = "vtkhdf")]
    Vtk,
}

/// Limits of a run.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Limits {
    /// Time of a run (s).
    pub seconds: u64,
    /// Address space of each process (MiB). Without a value there is no limit.
    pub memory_mib: Option<u64>,
    /// Number of threads.
    pub threads: u16,
}

impl Default for Limits {
    fn default() -> Self {
        Self { seconds: 600, memory_mib: None, threads: 1 }
    }
}

/// Error in a manifest: file, key, expected and found content.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{file}: {place}expected {expected}, found {found}")]
pub struct ManifestError {
    /// Path of the manifest.
    pub file: String,
    /// Key or line of the error followed by a colon, or empty for the whole file.
    pub place: String,
    /// Expected content.
    pub expected: String,
    /// Actual content.
    pub found: String,
}

impl Manifest {
    /// Returns the command that is started, once per run or once for all runs.
    #[must_use]
    pub fn command(&self) -> &[String] {
        if self.worker.is_empty() { &self.run } else { &self.worker }
    }

    /// Reads a manifest.
    ///
    /// # Errors
    /// If the manifest is not valid. The error contains the key, the expected and the actual content.
    pub fn read(path: &Path) -> Result<Self, ManifestError> {
        let file = one_line(&path.to_string_lossy());
        let error = |place: &str, expected: &str, found: String| ManifestError {
            file: file.clone(),
            place: if place.is_empty() { String::new() } else { format!("{place}: ") },
            expected: expected.to_owned(),
            found,
        };
        let text = written(path).map_err(|(expected, found)| error("", expected, found))?;
        let wrong = |reason: toml::de::Error| {
            let place = line_of(&text, &reason).map(|line| format!("line {line}")).unwrap_or_default();
            error(&place, "the keys of a manifest", one_line(reason.message()))
        };
        let manifest: Self = toml::from_str(&text).map_err(wrong)?;
        manifest.check().map_err(|(place, expected, found)| error(place, &expected, found))?;
        Ok(manifest)
    }

    /// Checks all values. The error consists of the key, the expected and the actual content.
    fn check(&self) -> Result<(), (&'static str, String, String)> {
        let wrong = |key, expected: &str, found: String| Err((key, expected.to_owned(), found));
        let is_plain = |letter: char| letter.is_ascii_alphanumeric() || IN_NAMES.contains(letter);
        if self.name.trim().is_empty() || self.name.len() > 40 || !self.name.chars().all(is_plain) {
            return wrong("name", "up to 40 letters, digits, `-`, `_`, `.` and blanks", quoted(&self.name));
        }
        match (self.run.is_empty(), self.worker.is_empty()) {
            (true, true) => return wrong("run", "a program and its words, or a `worker`", "neither".to_owned()),
            (false, false) => return wrong("run", "one of `run` and `worker`", "both".to_owned()),
            _ => {}
        }
        if !self.run.is_empty() && !self.run.iter().any(|word| word.contains("{scene}")) {
            return wrong("run", "a word with `{scene}`, the scene of the run", quoted(&self.run.join(" ")));
        }
        if let Some(other) = self.can.dimension.iter().find(|count| ![2, 3].contains(*count)) {
            return wrong("can.dimension", "2 and 3 alone", other.to_string());
        }
        if self.can.dimension.is_empty() {
            return wrong("can.dimension", "2, 3 or both", "none".to_owned());
        }
        let names = || Effect::ALL.map(Effect::key_word);
        if let Some(unknown) = self.can.effects.iter().find(|name| !names().contains(&name.as_str())) {
            return wrong("can.effects", &format!("names among {}", names().join(", ")), quoted(unknown));
        }
        if let Some(other) = self.knobs.critical_fraction.iter().find(|part| !(**part > 0.0 && **part < 1.0)) {
            return wrong(
                "knobs.critical-fraction",
                "parts of the critical step, above 0 and below 1",
                other.to_string(),
            );
        }
        if let Some(other) = self.knobs.cells.iter().find(|cells| !(cells.is_finite() && **cells > 0.0)) {
            return wrong("knobs.cells", "numbers of cells above zero", other.to_string());
        }
        if self.can.laws.is_empty() && self.can.deformable.is_empty() {
            return wrong(
                "can.laws",
                "a contact law, or laws of materials that deform (`can.deformable`)",
                "none".to_owned(),
            );
        }
        let output = &self.output;
        if output.grains.is_none() && output.series.is_none() {
            return wrong("output", "`grains`, or of a program whose bodies deform a `series`", "neither".to_owned());
        }
        let path = output.grains.as_ref().map(|grains| &grains.path);
        let files = [("output.grains.path", path), ("output.contacts", output.contacts.as_ref())];
        let tables = [("output.series", output.series.as_ref()), ("output.report", output.report.as_ref())];
        for (key, path) in files.into_iter().chain(tables).filter_map(|(key, path)| Some((key, path?))) {
            let mut parts = Path::new(path).components();
            if path.is_empty() || !parts.all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
                return wrong(key, "a path inside the folder of the run", quoted(path));
            }
        }
        let is_dump = output.grains.as_ref().is_some_and(|grains| grains.format == GrainFormat::Lammps);
        if output.contacts.is_some() && !is_dump {
            return wrong("output.contacts", "grains as a dump beside it", "grains in another format".to_owned());
        }
        let Limits { seconds, memory_mib, threads } = self.limits;
        if seconds == 0 || threads == 0 || memory_mib == Some(0) {
            return wrong("limits", "numbers above zero", "0".to_owned());
        }
        Ok(())
    }
}
