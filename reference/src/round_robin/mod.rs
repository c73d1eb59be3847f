//! The round robin of bulk processes (Dosta et al. 2024): what its published courses are read from, and what is derived of them.
//!
//! The courses are other people's and stay where the user has them. Kept here are numbers derived from them: means between codes,
//! and deviations between codes and between beds (`reference/literature/dosta-2024`).

mod impact;
mod said;
mod spread;
mod start;
mod tables;

pub use impact::{Course, Impact};
pub use said::{Said, of_all, of_drum, of_drums, of_impact, table_of};
pub use spread::Spread;
pub use start::{Start, read_start};
pub use tables::{Drum, Kind, Published, Silo, read};

/// Heights of the ball over time, derived: t (s), mean between codes and deviations between codes and between beds (mm), 25
/// thousand grains.
pub const IMPACT: &str = include_str!("../../literature/dosta-2024/impact-25k.csv");

/// What the published data says of itself, as `grainbench reference import dosta-2024` told it of the copies that were read: a
/// heading and a table.
pub const SAID: &str = include_str!("../../literature/dosta-2024/said.md");
