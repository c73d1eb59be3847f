//! Parts shared by the silo cases, which evaluate the flow in granular elements. Spheres flow out of a silo, or are
//! pushed through it from below. Lengths are in diameters d, times in τ = √(d/g); the mass of a grain is 1.
//!
//! Source: C. H. Rycroft, K. Kamrin and M. Z. Bazant, *Assessing continuum postulates in simulations of granular flow* (2009).

mod axes;
pub(crate) mod claims;
pub(crate) mod collapse;
pub(crate) mod ensemble;
mod figures;
mod flow;
mod flows;
mod instant;
mod paper;
mod reader;

pub(crate) use reader::ELEMENTS;
