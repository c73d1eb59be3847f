//! Rows of the three studies, as data: what accuracy costs, what stays stable, what each effect is worth. Reports print
//! and draw them without knowing any solver.

pub mod ledger;
pub mod load;
pub mod point;
pub mod stability;
pub mod step;
