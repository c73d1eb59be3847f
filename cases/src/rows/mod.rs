//! Claims that several cases share. Each file has the claims of one kind of run.

pub(crate) mod bulk;
pub mod draws;
pub mod elastic;
pub(crate) mod elastic_backspin;
pub mod incline;
pub mod on_plane;
pub mod one_grain_cost;
pub mod program_forces;
pub mod programs;
pub mod rigid;
pub(crate) mod ringing;
pub mod set_down;

/// Returns the name of a variant as a label of a curve: `60°, μ = 0.3` for `60deg-mu.3`.
pub fn label(variant: &str) -> String {
    let words = [("deg-mu", "°, μ = "), ("gamma-zeta", "ζ = "), ("kappa-", "κ = "), ("_", "/"), ("= .", "= 0.")];
    words.into_iter().fold(variant.to_owned(), |name, (word, symbol)| name.replace(word, symbol))
}
