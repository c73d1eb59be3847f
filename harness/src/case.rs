//! A case: scenes, a sequence of resolution levels, claims.

use crate::claim::Claim;
use crate::figure::Figure;
use crate::runner::Runner;
use grainbench_scene::error::SceneError;
use grainbench_scene::resolve::FileGrain;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{Resolution, RunError};
use grainbench_scene::source::SceneSource;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// One resolution level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Name, such as `dt=.1`.
    pub name: &'static str,
    /// The resolution.
    pub resolution: Resolution,
}

/// A time step as a fraction of the critical one.
#[must_use]
pub const fn fraction(name: &'static str, fraction: f64) -> Level {
    Level { name, resolution: Resolution::CriticalFraction(fraction) }
}

/// Cells per reference length and material points per cell and axis, of a method with a grid.
#[must_use]
pub const fn cells(name: &'static str, cells: f64, points: u32) -> Level {
    Level { name, resolution: Resolution::grid(cells, points) }
}

/// A benchmark case. Its folder holds scene, claims and derivation.
pub struct Case {
    /// Name, as on the command line and as its folder.
    pub name: &'static str,
    /// Title.
    pub title: &'static str,
    /// What is claimed as a whole, in a sentence or two.
    pub claim: &'static str,
    /// Text of `scene.toml`.
    pub scene: &'static str,
    /// Text of `derivation.md`: where the expected values come from.
    pub derivation: &'static str,
    /// Where this test is weak.
    pub weakness: &'static str,
    /// Resolutions, coarse to fine.
    pub levels: &'static [Level],
    /// The level that most claims take.
    pub default_level: Level,
    /// The claims.
    pub claims: &'static (dyn Fn() -> Vec<Claim> + Send + Sync),
    /// The figures, from runs of the case.
    pub figures: fn(&Runner) -> Result<Vec<Figure>, RunError>,
    /// Where its files are, and who reads grains from them.
    pub home: &'static Home,
}

/// Where the folders of cases are, and who reads the data files in them: the harness reads no file of a program itself.
pub struct Home {
    /// The folder in which each case has its own.
    pub folder: &'static str,
    /// Reads grains for a scene from a data file.
    pub read_grains: fn(&Path) -> Result<Vec<FileGrain>, String>,
    /// Scenes of many grains, made once for all who ask; none where files may change meanwhile.
    pub made: Option<&'static Made>,
}

/// Scenes of many grains by case and variant: cases look at each other's, and to read one from its files takes a while.
pub type Made = Mutex<Vec<(&'static str, String, Scene)>>;

/// So many grains are worth it.
const MANY: usize = 1000;

impl Case {
    /// Folder of the case's files.
    #[must_use]
    pub fn directory(&self) -> PathBuf {
        Path::new(self.home.folder).join(self.name)
    }

    /// The scene file.
    #[must_use]
    pub fn source(&self) -> SceneSource {
        SceneSource::from_text(&format!("{}/scene.toml", self.name), &self.directory(), self.scene)
    }

    /// The scene of a variant.
    ///
    /// # Errors
    /// When the scene file is wrong or there is no such variant.
    pub fn variant(&self, variant: &str) -> Result<Scene, SceneError> {
        let made = || self.home.made.map(|made| made.lock().unwrap_or_else(PoisonError::into_inner));
        let is_it = |(case, of, _): &&(&str, String, Scene)| *case == self.name && of == variant;
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

    /// Names of the variants; [`PLAIN`] alone where the scene has none.
    ///
    /// # Errors
    /// When the scene file is wrong.
    pub fn variants(&self) -> Result<Vec<String>, SceneError> {
        let names = self.source().variants()?;
        Ok(if names.is_empty() { vec![PLAIN.to_owned()] } else { names })
    }
}

/// Name of the scene without a variant.
pub const PLAIN: &str = "plain";
