//! Three studies: cost against accuracy ([`cost`]), stability ([`stability`]) and the influence of each effect
//! ([`effects`]). For scenes without claims and exact solutions, [`own`] estimates errors from the levels of each solver.
//!
//! The items of a study are independent tasks, which a list of tasks executes and stores. The throughput benchmark
//! ([`race`]) compares solvers. Its timings are comparable only within one run.

pub mod chaos;
pub mod clock;
pub mod cost;
pub mod effects;
pub mod kept;
pub mod own;
pub mod race;
pub mod run_cache;
pub mod stability;
