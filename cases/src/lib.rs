//! Benchmark cases: scenes, ladders of resolution, gates and their negative controls.

pub mod figure;
pub mod verdict;
