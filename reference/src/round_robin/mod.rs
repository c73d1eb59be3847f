//! Round robin of bulk processes (Dosta et al. 2024): readers for its published time series, and quantities derived
//! from them.
//!
//! The time series are third-party data and stay on the user's machine. This crate stores only derived numbers: means
//! of codes, and standard deviations between codes and between beds (`reference/literature/dosta-2024`).

mod again;
mod atoms;
mod bed;
mod impact;
mod said;
mod spread;
mod start;
mod tables;

pub use again::{EARLY, Pair, Quantity, STEADY, STEADY_SMALL, pairs};
pub use bed::{Bed, bed_in, bed_names, read_bed};
pub use impact::{Course, Impact};
pub use said::{DataFinding, of_all, of_drum, of_drums, of_impact, table_of};
pub use spread::Spread;
pub use start::{Start, read_start, start_in};
pub use tables::{Drum, Kind, PublishedTable, Silo, read};

/// Derived heights of the ball over time for 25 thousand grains. The columns are t (s), mean of the codes, and
/// standard deviations between codes and between beds (mm).
pub const IMPACT: &str = include_str!("../../literature/dosta-2024/impact-25k.csv");

/// Observations in the published data as a heading and a table. They were computed by `grainbench reference import
/// dosta-2024` from copies of the data.
pub const SAID: &str = include_str!("../../literature/dosta-2024/said.md");

/// Derived number of grains left in the silo over time, for the large orifice. The columns are t (s), mean of
/// LIGGGHTS and MUSEN, and half their difference.
pub const SILO: &str = include_str!("../../literature/dosta-2024/silo-large.csv");

/// Derived number of grains M1 in zone 2 of the drum over time. The columns are t (s), mean of LIGGGHTS and MUSEN,
/// and half their difference.
pub const DRUM: &str = include_str!("../../literature/dosta-2024/drum-zone-2.csv");

/// Scene that begins with the shared initial state of the drum. It needs `drum-m1.data` and `drum-m2.data`, which are
/// derived from this state.
pub const DRUM_SCENE: &str = include_str!("drum.toml");

/// Reads a stored table of time (s), mean and half the difference of two codes.
#[must_use]
pub fn course(text: &str) -> Vec<[f64; 3]> {
    let row = |line: &str| -> Option<[f64; 3]> {
        let numbers: Option<Vec<f64>> = line.split(',').map(|field| field.parse().ok()).collect();
        numbers?.try_into().ok()
    };
    text.lines().skip(1).filter_map(row).collect()
}
