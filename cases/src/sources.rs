//! Works that give expected values: one module for each reference folder with a `provenance.toml`.

#![allow(clippy::excessive_precision, reason = "numbers stand as the works give them")]

include!(concat!(env!("OUT_DIR"), "/sources.rs"));
