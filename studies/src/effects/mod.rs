//! What each effect is worth: the ledger of a case.
//!
//! Every effect that a scene calls for is switched off in turn, and every gate of the case is asked again, as it asks
//! its negative control: the solver is given the scene without the effect, the expectation stays that of the scene.
//! Every effect that it does not call for is compiled in with a value that does nothing, and no bit may change.

pub mod idle;
pub mod ledger;
pub mod scene;
