//! Claims that several cases share. Each file has the claims of one kind of run.

pub(crate) mod bulk;
pub(crate) mod draws;
pub(crate) mod elastic;
pub(crate) mod elastic_backspin;
pub(crate) mod incline;
pub(crate) mod on_plane;
pub(crate) mod one_grain_cost;
pub(crate) mod programs;
pub(crate) mod rigid;
pub(crate) mod ringing;
pub(crate) mod set_down;

/// Returns the name of a variant as a label of a curve: `60°, μ = 0.3` for `60deg-mu.3`.
pub(crate) fn label(variant: &str) -> String {
    let words = [("deg-mu", "°, μ = "), ("gamma-zeta", "ζ = "), ("kappa-", "κ = "), ("_", "/"), ("= .", "= 0.")];
    words.into_iter().fold(variant.to_owned(), |name, (word, symbol)| name.replace(word, symbol))
}
