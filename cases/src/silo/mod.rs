//! Flow of spheres out of a silo, and through a silo that is pushed from below, read as granular elements: common parts
//! of these cases. Lengths are in diameters d, times in τ = √(d/g); the mass of a grain is 1.
//!
//! Source: C. H. Rycroft, K. Kamrin and M. Z. Bazant, *Assessing continuum postulates in simulations of granular flow* (2009).

mod axes;
pub(crate) mod claims;
pub(crate) mod collapse;
pub(crate) mod ensemble;
pub(crate) mod figures;
pub(crate) mod flows;
mod instant;
pub(crate) mod paper;
mod reader;

pub(crate) use reader::ELEMENTS;
