//! Reasons why output cannot be checked.

use grainbench_reference::outputs::OutputError;
use grainbench_scene::error::SceneError;
use thiserror::Error;

/// Reasons why output cannot be checked.
#[derive(Debug, Error)]
pub enum CheckError {
    /// The files are damaged or incomplete.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The scene of the case is invalid.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The output belongs to another scene or to several variants, or its time step is at or above the critical one. The
    /// message names the files.
    #[error("{0}")]
    Other(String),
}
