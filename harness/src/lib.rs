//! The harness: what a claim is, and how it is judged.
//!
//! A [`claim::Claim`] says of which runs a quantity is read, what is expected of it and from which source, how far it
//! may be off and why, and which wrong physics it must refuse. A [`runner::Runner`] does the runs, each once, with
//! solvers that are handed in, and ends in a [`verdict::Verdict`]. Nothing here knows a solver: whatever left a record
//! is judged alike.

pub mod case;
pub mod claim;
pub mod compare;
pub mod conformance;
pub mod control;
pub mod course;
pub mod data;
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
