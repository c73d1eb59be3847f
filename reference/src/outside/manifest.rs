//! `SOLVER.toml`: how a program is started, what it can, and what it leaves.

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

/// Characters that a program's name may have beside letters and digits.
const IN_NAMES: &str = "-_.+ ";

/// What a manifest says, checked.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// What rows call the solver.
    pub name: String,
    /// The command that prints its version; the first line goes into the provenance of its runs.
    #[serde(default)]
    pub version: Vec<String>,
    /// The command of a run. `{scene}` stands for the file with the scene, `{out}` for the fresh folder in which it is started,
    /// `{here}` for the folder of the manifest; a word that names a file beside the manifest is that file.
    #[serde(default)]
    pub run: Vec<String>,
    /// In its place, the command of a program that stays and takes a run a line.
    #[serde(default)]
    pub worker: Vec<String>,
    /// A command that is run once in the manifest's folder before the first run, and is not timed.
    #[serde(default)]
    pub prepare: Vec<String>,
    /// Files elsewhere that it is made of too, by their paths from the manifest: what is kept of its rows is of them as well.
    #[serde(default)]
    pub files: Vec<String>,
    /// In which format it is given the scene.
    #[serde(default)]
    pub scene: SceneFormat,
    /// What it can.
    pub can: Can,
    /// What it is run with to see how its error falls and what it costs.
    #[serde(default)]
    pub knobs: Knobs,
    /// What it leaves.
    pub output: Output,
    /// What it may take.
    #[serde(default)]
    pub limits: Limits,
}

/// Formats of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SceneFormat {
    /// JSON.
    #[default]
    Json,
    /// TOML.
    Toml,
}

/// What a program declares that it can. A scene that calls for more is not given to it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Can {
    /// Numbers of dimensions.
    pub dimension: Vec<usize>,
    /// Contact laws of grains that keep their shape.
    #[serde(default)]
    pub laws: Vec<SpringsKind>,
    /// Laws of materials, of programs whose grains and bodies deform.
    #[serde(default)]
    pub deformable: Vec<ConstitutiveKind>,
    /// Kinds of walls.
    #[serde(default)]
    pub walls: Vec<Wall>,
    /// Effects beside gravity, by the names of [`Effect::key_word`].
    #[serde(default)]
    pub effects: Vec<String>,
    /// Whether grains can be driven.
    #[serde(default)]
    pub driven: bool,
}

/// Kinds of walls.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Wall {
    /// Planes.
    Plane,
    /// Segments, in the plane.
    Segment,
    /// Rectangles, in space.
    Rectangle,
    /// Sides of cylinders and cones.
    Round,
    /// Meshes of triangles.
    Mesh,
}

/// Knobs.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Knobs {
    /// Time steps as parts of the critical one.
    #[serde(default)]
    pub critical_fraction: Vec<f64>,
    /// Cells per reference length of the scene: of a grain's radius, where there are grains.
    #[serde(default)]
    pub cells: Vec<f64>,
}

/// Files that a run leaves, by their paths in the folder of the run.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// The grains at every sample.
    #[serde(default)]
    pub grains: Option<Grains>,
    /// The forces at contacts at the same steps, as a dump of LAMMPS' kind.
    #[serde(default)]
    pub contacts: Option<String>,
    /// A table of further columns of the scene's series.
    #[serde(default)]
    pub series: Option<String>,
    /// What the program says of itself.
    #[serde(default)]
    pub report: Option<String>,
}

/// The file with the grains.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grains {
    /// Its path.
    pub path: String,
    /// Its format.
    pub format: GrainFormat,
    /// What its columns are called there: `x = "position_x"`.
    #[serde(default)]
    pub map: BTreeMap<String, String>,
}

impl Grains {
    /// The names of columns.
    #[must_use]
    pub fn names(&self) -> Names {
        Names(self.map.iter().map(|(ours, theirs)| (ours.clone(), theirs.clone())).collect())
    }
}

/// Formats of grains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum GrainFormat {
    /// A dump of LAMMPS' kind, which LIGGGHTS writes too.
    #[serde(alias = "liggghts")]
    Lammps,
    /// A table with a row for each grain and sample, as text or in Parquet.
    #[serde(alias = "parquet")]
    Csv,
    /// Arrays of NumPy: `position`, `velocity` and `spin` of the shape (samples, grains, 3), and `step`.
    Npz,
    /// VTK's files, one a sample; `*` in the path stands for the step. Or one of HDF5 with all samples.
    #[serde(alias = "vtkhdf")]
    Vtk,
}

/// What a run may take.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Limits {
    /// Time of a run (s).
    pub seconds: u64,
    /// Address space of its processes each (MiB); any where none is named.
    pub memory_mib: Option<u64>,
    /// Threads.
    pub threads: u16,
}

impl Default for Limits {
    fn default() -> Self {
        Self { seconds: 600, memory_mib: None, threads: 1 }
    }
}

/// A manifest that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{file}: {place}expected {expected}, found {found}")]
pub struct ManifestError {
    /// The file.
    pub file: String,
    /// The key or the place in the text, with a colon behind it; empty where it is the file.
    pub place: String,
    /// What was expected.
    pub expected: String,
    /// What stood there.
    pub found: String,
}

impl Manifest {
    /// The command that is started, for each run or once.
    #[must_use]
    pub fn command(&self) -> &[String] {
        if self.worker.is_empty() { &self.run } else { &self.worker }
    }

    /// Reads a manifest.
    ///
    /// # Errors
    /// Names the key, what was expected and what stood there.
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

    /// What is wrong with a value: its key, what was expected, what was found.
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
            return wrong("run", "a word with `{scene}`: what is to be run", quoted(&self.run.join(" ")));
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
