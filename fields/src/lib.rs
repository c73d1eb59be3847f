//! Fields over what a run leaves behind: the stress inside discs, pictures of it, and means over the cells of a grid.
//!
//! Material points carry fields and grains carry contact forces; here both become the same quantities at the same
//! places.

pub mod coarse;
pub mod coarse_picture;
pub mod disc;
pub mod overlap;
pub mod paint;
pub mod picture;
pub mod points;
pub mod profile;
pub mod quantity;
