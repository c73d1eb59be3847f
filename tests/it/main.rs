//! Integration tests in one program: behaviour of the command line, and rules for the whole repository.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod absent_effects;
mod allocations;
mod bad_input;
mod cache;
#[cfg(unix)]
mod campaign;
mod check;
mod check_adapts;
mod check_own;
mod choosing;
mod cli;
mod common;
mod conform_claims;
mod conformance;
mod deck;
mod determinism;
mod fields;
mod given_data;
mod guide;
mod hostile_scenes;
mod in_short;
mod init;
mod kept;
#[cfg(unix)]
mod killed;
mod long_runs;
mod mesh_walls;
mod motions;
mod observer;
mod outside;
mod own_case;
mod own_scene;
mod own_solver;
mod passing_decks;
mod peers;
mod piston;
mod programs;
mod readme;
mod records;
mod references;
mod refusals;
mod restart;
mod round_walls;
mod state;
mod states;
mod stays;
mod structure;
mod studies;
mod tidy;
mod wrong_flags;
mod wrong_keys;
