//! Benchmark cases: scenes, resolution levels and claims.

use crate::claim::Claim;
use crate::figure::Figure;
use crate::runner::Runner;
use crate::subject::TargetQuantity;
use grainbench_scene::error::SceneError;
use grainbench_scene::resolve::FileGrain;
use grainbench_scene::scene::Scene;
use grainbench_scene::source::SceneSource;
use grainbench_solver::failure::RunError;
use grainbench_solver::resolution::Resolution;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// One resolution level.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Level {
    /// Name, such as `dt=.1`.
    pub name: &'static str,
    /// Time step, rigid-body substeps or grid of the level.
    pub resolution: Resolution,
}

impl Level {
    /// Returns the time step for a scene (s), or NaN if the level has no time step.
    #[must_use]
    pub fn step(&self, scene: &Scene) -> f64 {
        self.resolution.steps(scene).map_or(f64::NAN, |(step, _)| step)
    }
}

/// Returns a level whose time step is a fraction of the critical time step.
pub const fn fraction(name: &'static str, fraction: f64) -> Level {
    Level { name, resolution: Resolution::CriticalFraction(fraction) }
}

/// Returns a level with a time step (s).
pub const fn time_step(name: &'static str, step: f64) -> Level {
    Level { name, resolution: Resolution::TimeStep(step) }
}

/// Returns a level with a grid: cells per reference length, and material points per cell along each axis.
pub const fn cells(name: &'static str, cells: f64, points: u32) -> Level {
    Level { name, resolution: Resolution::grid(cells, points) }
}

/// Field of physics of a case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Physics {
    /// Contact forces and collisions.
    Contacts,
    /// Rolling, sliding and friction.
    Rolling,
    /// Waves in chains and bars.
    Waves,
    /// Moving, curved and triangulated walls; insertion and removal of grains.
    Walls,
    /// Packings at rest.
    Packings,
    /// Gases, shear flows, silos and drums.
    Flows,
    /// Elastic and plastic bodies.
    Bodies,
    /// Properties that every solver must satisfy, such as objectivity.
    Properties,
    /// Cases outside the registry.
    #[default]
    Own,
}

impl Physics {
    /// Returns the field in words, for a heading.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Contacts => "contacts, collisions",
            Self::Rolling => "rolling, sliding",
            Self::Waves => "waves",
            Self::Walls => "walls, insertion",
            Self::Packings => "packings at rest",
            Self::Flows => "gases, flows, silos",
            Self::Bodies => "deformable bodies",
            Self::Properties => "rotation, energy",
            Self::Own => "own cases",
        }
    }
}

/// A benchmark case. Its folder holds the scene, the claims and the derivation.
pub struct Case {
    /// Name of the case on the command line and of its folder.
    pub name: &'static str,
    /// Title of the case in the report.
    pub title: &'static str,
    /// Field of physics.
    pub physics: Physics,
    /// Summary of all claims, in one or two sentences.
    pub claim: &'static str,
    /// Text of `scene.toml`.
    pub scene: &'static str,
    /// Text of `derivation.md`, which derives the expected values.
    pub derivation: &'static str,
    /// Limitations of this test.
    pub weakness: &'static str,
    /// Resolution levels, coarse to fine.
    pub levels: &'static [Level],
    /// Level that most claims use.
    pub default_level: Level,
    /// Builds the claims.
    pub claims: &'static (dyn Fn() -> Vec<Claim> + Send + Sync),
    /// Builds the figures that are not part of a claim, from runs of the case.
    pub figures: fn(&Runner) -> Result<Vec<Figure>, RunError>,
    /// Returns the target quantities of the cost study.
    pub targets: fn(&'static Self) -> Vec<TargetQuantity>,
    /// Directory of the case folders, and the reader of their grain files.
    pub home: &'static Home,
}

/// Directory of the case folders, and the reader of their grain files.
///
/// The harness itself parses no file format of another program.
pub struct Home {
    /// Returns the directory that contains one folder for each case.
    pub folder: &'static (dyn Fn() -> PathBuf + Sync),
    /// Reads grains for a scene from a data file.
    pub read_grains: fn(&Path) -> Result<Vec<FileGrain>, SceneError>,
    /// Cache of scenes with many grains, shared by all runners. None if the scene files can change while the program runs.
    pub made: Option<&'static SceneCache>,
}

/// Cache of scenes by case and variant. It stores only scenes with at least 1000 grains, because parsing them takes
/// time and several runners of a case need the same scene.
pub type SceneCache = Mutex<Vec<(&'static str, String, Scene)>>;

/// Smallest number of grains of a cached scene.
const MANY: usize = 1000;

impl Case {
    /// Sets the levels, coarse to fine, the index of the level that most claims use, and the claims.
    #[must_use]
    pub const fn with(
        self,
        levels: &'static [Level],
        default: usize,
        claims: &'static (dyn Fn() -> Vec<Claim> + Send + Sync),
    ) -> Self {
        Self { levels, default_level: levels[default], claims, ..self }
    }

    /// Sets the figures that are not part of a claim.
    #[must_use]
    pub const fn drawn_by(self, figures: fn(&Runner) -> Result<Vec<Figure>, RunError>) -> Self {
        Self { figures, ..self }
    }

    /// Sets the target quantities of the cost study, which replace those of the claims.
    #[must_use]
    pub const fn priced_by(self, targets: fn(&'static Self) -> Vec<TargetQuantity>) -> Self {
        Self { targets, ..self }
    }

    /// Returns the folder of the case.
    #[must_use]
    pub fn directory(&self) -> PathBuf {
        (self.home.folder)().join(self.name)
    }

    /// Returns the source of the scene: the text of `scene.toml`, its name for messages and its folder.
    #[must_use]
    pub fn source(&self) -> SceneSource {
        SceneSource::from_text(&format!("{}/scene.toml", self.name), &self.directory(), self.scene)
    }

    /// Returns the scene of a variant.
    ///
    /// # Errors
    /// When the scene file is invalid or the variant does not exist.
    pub fn variant(&self, variant: &str) -> Result<Scene, SceneError> {
        let made = || self.home.made.map(|made| made.lock().unwrap_or_else(PoisonError::into_inner));
        let is_it = |(case, name, _): &&(&str, String, Scene)| *case == self.name && name == variant;
        if let Some((.., scene)) = made().and_then(|made| made.iter().find(is_it).cloned()) {
            return Ok(scene);
        }
        let source = self.source();
        let source = if variant == PLAIN { source } else { source.variant(variant) };
        let scene = source.scene(&self.home.read_grains)?;
        if let Some(mut made) = made().filter(|_| scene.grains.len() >= MANY) {
            made.push((self.name, variant.to_owned(), scene.clone()));
        }
        Ok(scene)
    }

    /// Returns a number computed from the scene of a variant, or NaN if there is no such scene.
    #[must_use]
    pub fn number(&self, variant: &str, value: impl FnOnce(&Scene) -> f64) -> f64 {
        self.variant(variant).map_or(f64::NAN, |scene| value(&scene))
    }

    /// Returns the names of the variants, or [`PLAIN`] alone if the scene has none.
    ///
    /// # Errors
    /// When the scene file is invalid.
    pub fn variants(&self) -> Result<Vec<String>, SceneError> {
        let names = self.source().variants()?;
        Ok(if names.is_empty() { vec![PLAIN.to_owned()] } else { names })
    }
}

/// Variant name for a scene that defines no variants.
pub const PLAIN: &str = "plain";
