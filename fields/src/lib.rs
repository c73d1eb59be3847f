//! Fields from the results of runs: stress inside discs, figures of this stress, and means over the cells of a grid.
//!
//! Solvers with material points report the stress at each point, and solvers with grains report contact forces. This
//! crate converts both to the same quantities at the same positions.

pub mod column;
pub mod contact_stress;
pub mod course;
pub mod disc;
pub mod element;
pub mod element_picture;
pub mod grid;
pub mod mask;
pub mod motion;
pub mod overlap;
pub mod packing;
pub mod paint;
pub mod picture;
pub mod profile;
pub mod quantity;
pub mod tensor;
pub mod trails;
