//! The registry of cases: one for each folder with a `scene.toml`.

include!(concat!(env!("OUT_DIR"), "/registry.rs"));

/// The case of a name.
#[must_use]
pub fn by_name(name: &str) -> Option<&'static crate::case::Case> {
    CASES.iter().copied().find(|case| case.name == name)
}
