//! Scenes made from third-party data. The user supplies the data; they are not part of the project.

use grainbench_scene::scene::Scene;
use std::path::Path;

/// A scene that is made from third-party data.
#[derive(Debug)]
pub struct Data {
    /// Name of the scene, which identifies its runs.
    pub name: &'static str,
    /// Required files, their origin and the way to supply them, in words.
    pub needs: &'static str,
    /// Makes the scene from the files in a directory.
    pub scene: fn(&Path) -> Result<Scene, SceneDataError>,
}

/// Reason why a scene cannot be made from data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SceneDataError {
    /// The directory lacks the files. The text names the expected files.
    Absent(String),
    /// The files in the directory cannot be used. The text states the reason.
    Wrong(String),
}

impl SceneDataError {
    /// Returns the text of the error.
    #[must_use]
    pub fn into_words(self) -> String {
        match self {
            Self::Absent(words) | Self::Wrong(words) => words,
        }
    }
}
