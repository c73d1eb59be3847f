//! Solver wrapper that does each run once, because several properties use the same run.

use crate::wrapper::{Start, Wrapped, Wrapper};
use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::observer::Observer;
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;
use std::sync::{Mutex, PoisonError};

type CachedRun = (Scene, Resolution, Result<Record, RunError>);

/// Solver that stores the result of each scene at each resolution. Runs that must be repeated or observed do not use it.
pub(super) struct CachedRuns<'a> {
    solver: &'a dyn Solver,
    known: Mutex<Vec<CachedRun>>,
}

impl<'a> CachedRuns<'a> {
    pub(super) const fn new(solver: &'a dyn Solver) -> Wrapped<Self> {
        Wrapped(Self { solver, known: Mutex::new(Vec::new()) })
    }
}

impl Wrapper for CachedRuns<'_> {
    fn inner(&self) -> &dyn Solver {
        self.solver
    }

    fn run(&self, start: Start<'_>, observer: &mut dyn Observer) -> Result<Record, RunError> {
        let Start { scene, resolution, from: None } = start else { return start.run(self.solver, observer) };
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((.., record)) = known.iter().find(|(known_scene, at, _)| known_scene == scene && at == resolution) {
            return record.clone();
        }
        let record = self.solver.run(scene, resolution, observer);
        known.push((scene.clone(), *resolution, record.clone()));
        record
    }
}
