//! Effects study: the influence of each physical effect on the claims of a case.
//!
//! Each effect that a scene uses is switched off in turn, and every claim of the case is evaluated again. As in a
//! negative control, the solver gets the scene without the effect. The expectation is still computed from the scene
//! with the effect. Each effect that the scene does not use is compiled in with a neutral value, and no bit may change.

pub mod idle;
pub mod ledger;
pub mod scene;
