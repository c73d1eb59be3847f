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
    /// The output matches the start of several variants.
    #[error(
        "{file}: expected the name of a variant, because several variants of {case} have this start; found none of \
             {variants}"
    )]
    Ambiguous {
        /// Files of the output.
        file: String,
        /// Name of the case.
        case: String,
        /// Names of the matching variants.
        variants: String,
    },
    /// A time step of the files is at or above the critical one.
    #[error(
        "{file}: expected a time step below the critical one of the scene, 2√(m_min/k_max) = {critical:.6e} s; found {step} s, \
         {:.3} of it (--allow-unstable permits it)",
        .step / .critical
    )]
    Unstable {
        /// Files of the output.
        file: String,
        /// Critical time step (s).
        critical: f64,
        /// Longest time step of the files (s).
        step: f64,
    },
    /// The output belongs to another scene.
    #[error("{file}: expected the start of a scene of {case}, {expected}; found {found}")]
    OtherScene {
        /// Files of the output.
        file: String,
        /// Name of the case, with its variant.
        case: String,
        /// Value in the scene of the first quantity that differs.
        expected: String,
        /// Value of this quantity in the output.
        found: String,
    },
}
