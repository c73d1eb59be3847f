//! Manifest `SOLVER.toml`, which describes the commands, the features and the output of a program.

use crate::read::read_error::{ReadError, one_line, quoted};
use grainbench_scene::contact_law::SpringsKind;
use grainbench_scene::effect::Effect;
use grainbench_scene::material::ConstitutiveKind;
use grainbench_scene::text::written;
use grainbench_scene::toml_error::TomlError;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Component, Path};

/// Characters that names of programs may contain in addition to letters and digits.
const IN_NAMES: &str = "-_.+ ";

/// Content of a manifest.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// Name of the solver in results, up to 40 characters.
    pub name: String,
    /// Command that prints the version, whose first line is stored in the provenance of runs. Empty by default.
    #[serde(default)]
    pub version: Vec<String>,
    /// Command of a run as a list of words. Either `run` or `worker` is required.
    ///
    /// The program is started in a new folder. `{scene}` is replaced by the path of the scene file, `{out}` by the path
    /// of this folder, and `{here}` by the path of the manifest's folder. A word that names a file beside the manifest
    /// is replaced by the file's path.
    #[serde(default)]
    pub run: Vec<String>,
    /// Alternative to `run`: command of a program that keeps running and accepts one run per line of its standard
    /// input.
    #[serde(default)]
    pub worker: Vec<String>,
    /// Command that is executed once in the folder of the manifest, before the first run. It is not timed. Empty by
    /// default.
    #[serde(default)]
    pub prepare: Vec<String>,
    /// Further files of the adapter, by their paths relative to the manifest. Stored results depend on the contents of
    /// these files.
    #[serde(default)]
    pub files: Vec<String>,
    /// Format of the scene file; JSON by default.
    #[serde(default)]
    pub scene: SceneFormat,
    /// Features of the program.
    pub can: Capabilities,
    /// Parameters of the runs that measure convergence and computing time.
    #[serde(default)]
    pub knobs: ParameterValues,
    /// Output files of a run.
    pub output: Output,
    /// Limits of a run.
    #[serde(default)]
    pub limits: Limits,
}

/// Format of the scene file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SceneFormat {
    /// JSON.
    #[default]
    Json,
    /// TOML.
    Toml,
}

/// Features that a program declares. A scene that needs another feature is not run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Capabilities {
    /// Supported numbers of dimensions: 2, 3 or both.
    pub dimension: Vec<usize>,
    /// Supported contact laws of rigid grains. Without them, `deformable` is required.
    #[serde(default)]
    pub laws: Vec<SpringsKind>,
    /// Supported constitutive laws of deformable grains and bodies. None by default.
    #[serde(default)]
    pub deformable: Vec<ConstitutiveKind>,
    /// Supported shapes of walls. None by default.
    #[serde(default)]
    pub walls: Vec<Wall>,
    /// Supported effects except gravity, by their names in files ([`Effect::key_word`]). None by default.
    #[serde(default)]
    pub effects: Vec<String>,
    /// True if the program supports driven grains, false by default.
    #[serde(default)]
    pub driven: bool,
}

/// Shape of a wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Wall {
    /// Plane.
    Plane,
    /// Line segment in two dimensions.
    Segment,
    /// Rectangle in three dimensions.
    Rectangle,
    /// Side of a cylinder or cone.
    Round,
    /// Mesh of triangles.
    Mesh,
}

/// Parameters of convergence runs. If a list is empty, the cost study uses its own values.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct ParameterValues {
    /// Time steps as fractions of the critical time step, above 0 and below 1.
    pub critical_fraction: Vec<f64>,
    /// Numbers of cells per reference length of the scene. The reference length is the radius of a grain if there are
    /// grains.
    pub cells: Vec<f64>,
}

/// Output files of a run, by their paths relative to the folder of the run. `grains` or `series` is required.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// File or files with the grains at every sample.
    pub grains: Option<Grains>,
    /// Contact forces at the same steps, as a dump in the format of LAMMPS. The grains must be a dump too.
    pub contacts: Option<String>,
    /// Table with further columns of the scene's series, one row per sample.
    pub series: Option<String>,
    /// Report of the program about its run, as JSON.
    pub report: Option<String>,
}

/// File with the grains and its format.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grains {
    /// Path of the file. For VTK files it may contain `*` in place of the step.
    pub path: String,
    /// Format of the file.
    pub format: GrainFormat,
    /// Names of columns that differ from those of LAMMPS, for example `x = "position_x"`.
    #[serde(default)]
    pub map: BTreeMap<String, String>,
}

/// Format of a file with grains.
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
    /// VTK files, one per sample, with `*` in the path for the step, or one HDF5 file (`.vtkhdf`) with all samples.
    #[serde(alias = "vtkhdf")]
    Vtk,
}

/// Limits of a run.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Limits {
    /// Time limit of a run (s), 600 by default.
    pub seconds: u64,
    /// Maximum address space of each process (MiB). No limit by default.
    pub memory_mib: Option<u64>,
    /// Number of threads, 1 by default.
    pub threads: u16,
}

impl Default for Limits {
    fn default() -> Self {
        Self { seconds: 600, memory_mib: None, threads: 1 }
    }
}

impl Manifest {
    /// Returns the command to start: `run` or, if the manifest has one, `worker`.
    #[must_use]
    pub fn command(&self) -> &[String] {
        if self.worker.is_empty() { &self.run } else { &self.worker }
    }

    /// Reads and checks a manifest.
    ///
    /// # Errors
    /// If the manifest is not valid. The error contains the position, the expected and the actual content.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let file = path.to_string_lossy();
        let error =
            |place: &str, expected: &str, found: String| ReadError::whole(&format!("{file}: {place}"), expected, found);
        let text = written(path).map_err(|(expected, found)| ReadError::whole(&file, expected, found))?;
        let wrong = |reason: toml::de::Error| {
            let TomlError { line, expected, found, .. } = TomlError::new(&text, &reason);
            error(&format!("line {line}"), &expected, one_line(&found))
        };
        let manifest: Self = toml::from_str(&text).map_err(wrong)?;
        manifest.check().map_err(|(place, expected, found)| error(place, &expected, found))?;
        Ok(manifest)
    }

    /// Checks all values. An error consists of the key, the expected and the actual content.
    fn check(&self) -> Result<(), (&'static str, String, String)> {
        let wrong = |key, expected: &str, found: String| Err((key, expected.to_owned(), found));
        let is_plain = |letter: char| letter.is_ascii_alphanumeric() || IN_NAMES.contains(letter);
        if self.name.trim().is_empty() || self.name.len() > 40 || !self.name.chars().all(is_plain) {
            return wrong("name", "up to 40 letters, digits, `-`, `_`, `.` and blanks", quoted(&self.name));
        }
        match (self.run.is_empty(), self.worker.is_empty()) {
            (true, true) => return wrong("run", "a program with its arguments, or a `worker`", "neither".to_owned()),
            (false, false) => return wrong("run", "one of `run` and `worker`", "both".to_owned()),
            _ => {}
        }
        if !self.run.is_empty() && !self.run.iter().any(|word| word.contains("{scene}")) {
            return wrong("run", "an argument with `{scene}`, the path of the scene", quoted(&self.run.join(" ")));
        }
        if let Some(other) = self.can.dimension.iter().find(|count| ![2, 3].contains(*count)) {
            return wrong("can.dimension", "only 2 and 3", other.to_string());
        }
        if self.can.dimension.is_empty() {
            return wrong("can.dimension", "2, 3 or both", "none".to_owned());
        }
        let names = || Effect::ALL.map(Effect::key_word);
        if let Some(unknown) = self.can.effects.iter().find(|name| !names().contains(&name.as_str())) {
            return wrong("can.effects", &format!("names among {}", names().join(", ")), quoted(unknown));
        }
        if let Some(other) = self.knobs.critical_fraction.iter().find(|part| !(**part > 0.0 && **part < 1.0)) {
            let expected = "fractions of the critical step, above 0 and below 1";
            return wrong("knobs.critical-fraction", expected, other.to_string());
        }
        if let Some(other) = self.knobs.cells.iter().find(|cells| !(cells.is_finite() && **cells > 0.0)) {
            return wrong("knobs.cells", "numbers of cells above zero", other.to_string());
        }
        if self.can.laws.is_empty() && self.can.deformable.is_empty() {
            let expected = "a contact law, or laws of deformable materials (`can.deformable`)";
            return wrong("can.laws", expected, "none".to_owned());
        }
        let output = &self.output;
        if output.grains.is_none() && output.series.is_none() {
            let expected = "`grains`, or a `series` if the bodies of the program deform";
            return wrong("output", expected, "neither".to_owned());
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
            return wrong("output.contacts", "grains in the format `lammps`", "grains in another format".to_owned());
        }
        let Limits { seconds, memory_mib, threads } = self.limits;
        if seconds == 0 || threads == 0 || memory_mib == Some(0) {
            return wrong("limits", "numbers above zero", "0".to_owned());
        }
        Ok(())
    }
}
