//! Tests of the solver in one program.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod absent;
mod at_rest;
mod collision;
mod conformance;
mod contact;
mod cost;
mod driven;
mod guard;
mod materials;
mod restart;
mod rolling;
mod single_body;
mod spheres;
mod spinning;
mod support;
