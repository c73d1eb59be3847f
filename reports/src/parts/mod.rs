//! Snapshots in bulk, in bounded memory: parts, each a folder with a Parquet file a kind of row (`snapshots`, `grains`,
//! `contacts`, `walls`, `bodies`, `points`), read by pandas, polars, DuckDB and others with one pattern such as
//! `snapshots/*/grains.parquet`. Every row has the number, the step and the time of its snapshot; numbers keep every bit,
//! and what was not told is null.

mod columns;
mod folder;
mod part;
mod rows;
mod store;
mod table;

pub(crate) use columns::Values;
pub use folder::each_snapshot;
pub use store::{READABLE, SnapshotStore, StoreError};
pub(crate) use table::{Grouped, whole};
