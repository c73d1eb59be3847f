//! Storage of any number of snapshots in bounded memory.
//!
//! A part is a folder with one Parquet file per kind of row: `snapshots`, `grains`, `contacts`, `walls`, `bodies` and
//! `points`. Programs such as pandas, polars and DuckDB read all parts with one pattern, such as
//! `snapshots/*/grains.parquet`. Every row has the number, the step and the time of its snapshot. Numbers are stored
//! without rounding, and an unreported value is null.

mod columns;
mod part;
mod rows;
mod store;
mod table;

pub(crate) use columns::Values;
pub(crate) use part::snapshots;
pub use store::{READABLE, SnapshotStore, StoreError};
pub(crate) use table::GroupedTable;
