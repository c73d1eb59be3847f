//! Works that expected values come from: one handle for each folder of references with a provenance.

#![allow(clippy::excessive_precision, reason = "numbers stand as the works give them")]

include!(concat!(env!("OUT_DIR"), "/sources.rs"));
