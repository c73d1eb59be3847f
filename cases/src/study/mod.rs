//! Rows of the studies, as data: what accuracy costs, what stays stable. Reports print and draw them without knowing any
//! solver.

pub mod point;
