//! The round robin of bulk processes (Dosta et al. 2024): what its published courses are read from, and what is derived of them.
//!
//! The courses are other people's and stay where the user has them. Kept here are numbers derived from them: means between codes,
//! and deviations between codes and between beds (`reference/literature/dosta-2024`).

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
pub use said::{Said, of_all, of_drum, of_drums, of_impact, table_of};
pub use spread::Spread;
pub use start::{Start, read_start, start_in};
pub use tables::{Drum, Kind, Published, Silo, read};

/// Heights of the ball over time, derived: t (s), mean between codes and deviations between codes and between beds (mm), 25
/// thousand grains.
pub const IMPACT: &str = include_str!("../../literature/dosta-2024/impact-25k.csv");

/// What the published data says of itself, as `grainbench reference import dosta-2024` told it of the copies that were read: a
/// heading and a table.
pub const SAID: &str = include_str!("../../literature/dosta-2024/said.md");

/// Grains left in the silo over time, large orifice, derived: t (s), mean of LIGGGHTS and MUSEN, half their difference.
pub const SILO: &str = include_str!("../../literature/dosta-2024/silo-large.csv");

/// M1 in zone 2 of the drum over time, derived: t (s), mean of LIGGGHTS and MUSEN, half their difference.
pub const DRUM: &str = include_str!("../../literature/dosta-2024/drum-zone-2.csv");

/// The scene that begins with the drum's shared start, beside `drum-m1.data` and `drum-m2.data`, which are made of it.
pub const DRUM_SCENE: &str = include_str!("drum.toml");

/// A table of time (s), mean and half the difference of two codes, that is kept here.
#[must_use]
pub fn course(text: &str) -> Vec<[f64; 3]> {
    let row = |line: &str| -> Option<[f64; 3]> {
        let numbers: Option<Vec<f64>> = line.split(',').map(|field| field.parse().ok()).collect();
        numbers?.try_into().ok()
    };
    text.lines().skip(1).filter_map(row).collect()
}
