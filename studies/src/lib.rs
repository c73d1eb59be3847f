//! The three studies: what accuracy costs ([`cost`]), what stays stable ([`stability`]), what each effect is worth
//! ([`effects`]).
//!
//! Each goes through its pieces one by one, keeps every finished piece in a [`result_cache`], and takes from there what was
//! finished before: a study that was ended goes on where it stopped. Beside them stands the [`race`] with other programs, whose
//! pieces are only worth something next to each other.

pub mod clock;
pub mod cost;
pub mod effects;
pub mod identity;
pub mod kept;
pub mod race;
pub mod result_cache;
pub mod run_cache;
pub mod stability;

/// Someone who wants to know how far a study is.
pub trait Follow {
    /// A piece is taken up.
    fn now(&mut self, _piece: &str) {}
    /// A piece is finished: taken from the result cache, or done.
    fn done(&mut self, _reused: bool) {}
}

/// Nobody follows.
impl Follow for () {}
