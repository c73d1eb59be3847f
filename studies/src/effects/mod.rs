//! Effects study: the influence of each physical effect on the claims of a case.
//!
//! Each effect that a scene uses is switched off in turn, and the claims of the case are evaluated again. As in a
//! negative control, the solver gets the scene without the effect. The expected value is still computed from the scene
//! with the effect. Each effect that the scene does not use is turned on with a neutral value, which must not change
//! the result.

pub mod idle;
pub mod ledger;
pub mod scene;
