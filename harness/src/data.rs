//! Data of others that a scene is made from: the user has it, the project does not.

use grainbench_scene::scene::Scene;
use std::path::Path;

/// A scene that begins with data of others.
#[derive(Debug)]
pub struct Data {
    /// Name of the scene, which tells runs apart.
    pub name: &'static str,
    /// What it needs, where that is to be had, and how it is given, in words.
    pub needs: &'static str,
    /// The scene, with what a folder holds.
    pub scene: fn(&Path) -> Result<Scene, NotMade>,
}

/// Why a scene cannot be made of what a folder holds: what was expected there and what was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NotMade {
    /// The folder does not hold it.
    Absent(String),
    /// What the folder holds in its place cannot be used.
    Wrong(String),
}

impl NotMade {
    /// In words.
    #[must_use]
    pub fn into_words(self) -> String {
        match self {
            Self::Absent(words) | Self::Wrong(words) => words,
        }
    }
}
