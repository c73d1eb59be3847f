//! The harness: definition and evaluation of claims.
//!
//! A [`claim::Claim`] states the runs from which a quantity is read, the expectation with its source, and the tolerance
//! with its reason. It also states wrong physics under which it must fail. A [`runner::Runner`] does each run once,
//! with solvers that the caller supplies, and returns a [`verdict::Verdict`]. The harness contains no solver, and
//! evaluates all records in the same way.

pub mod case;
pub mod claim;
pub mod compare;
pub mod conformance;
pub mod control;
pub mod course;
pub mod evidence;
pub mod expect;
pub mod figure;
pub mod force_plot;
pub mod measure;
pub mod mistake;
pub mod prelude;
pub mod raster;
pub mod reading;
pub mod run;
pub mod runner;
pub mod scope;
pub mod solvers;
pub mod source;
pub mod statistics;
pub mod subject;
pub mod tolerance;
pub mod uncertainty;
pub mod verdict;
pub mod wrapper;
