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
    /// The scene, with what a folder holds; else what was expected there and what was found.
    pub scene: fn(&Path) -> Result<Scene, String>,
}
