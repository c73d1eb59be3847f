//! Round robin of bulk processes (Dosta et al. 2024): numbers that are derived from its published time series, and
//! readers of its shared initial states.
//!
//! The time series are third-party data and are not distributed. The folder `reference/literature/dosta-2024` contains
//! only numbers that its script `derive.py` computes from them: means of codes, and standard deviations between codes
//! and beds.

mod atoms;
mod bed;
mod spread;
mod start;

pub use bed::{Bed, bed_in, bed_names, read_bed};
pub use spread::Spread;
pub use start::{Start, read_start, start_in};

/// Period of steady flow out of the silo (s).
pub const STEADY: [f64; 2] = [0.5, 3.5];
/// Period shortly after the flow has started (s).
pub const EARLY: [f64; 2] = [0.2, 0.8];

/// Height of the ball over time for 25 thousand grains. The columns are t (s), mean over the codes, standard deviation
/// between codes, and standard deviation between beds (heights in mm).
pub const IMPACT: &str = include_str!("../../literature/dosta-2024/impact-25k.csv");

/// Inconsistencies in the published data, as a heading and a table in Markdown.
pub const CONSISTENCY: &str = include_str!("../../literature/dosta-2024/consistency.md");

/// Number of grains in the silo over time, for the large orifice. The columns are t (s), mean of LIGGGHTS and MUSEN,
/// and half the difference of the two codes.
pub const SILO: &str = include_str!("../../literature/dosta-2024/silo-large.csv");

/// Number of grains of material M1 in zone 2 of the drum over time. The columns are t (s), mean of LIGGGHTS and MUSEN,
/// and half the difference of the two codes.
pub const DRUM: &str = include_str!("../../literature/dosta-2024/drum-zone-2.csv");

/// Scene that starts from the shared initial state of the drum. It reads `drum-m1.data` and `drum-m2.data`, which are
/// derived from this state.
pub const DRUM_SCENE: &str = include_str!("../../literature/dosta-2024/drum.toml");

/// Reads a table of time (s), mean, and half the difference of two codes.
#[must_use]
pub fn course(text: &str) -> Vec<[f64; 3]> {
    let row = |line: &str| -> Option<[f64; 3]> {
        let numbers: Option<Vec<f64>> = line.split(',').map(|field| field.parse().ok()).collect();
        numbers?.try_into().ok()
    };
    text.lines().skip(1).filter_map(row).collect()
}
