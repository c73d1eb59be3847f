//! The registry of solvers.

pub use crate::stored::is_program;
use crate::{kept, stored, uncertainty, varied};
use grainbench_dem::convention::Convention;
use grainbench_dem::solver::Dem;
use grainbench_harness::prelude::*;
use grainbench_harness::solvers::{References, Solvers};
use grainbench_mpm::solver::Mpm;
use grainbench_reference::data::missing;
use grainbench_reference::deck::Program;
use grainbench_reference::live::LiveProgram;
use grainbench_rigid::solver::Rigid;
use grainbench_solver::terms::Terms;
use grainbench_solver::{Defect, Solver};
use std::time::Duration;

/// Returns all our solvers.
#[must_use]
pub fn all() -> Vec<Box<dyn Solver>> {
    with_terms().into_iter().map(|(solver, _)| solver).collect()
}

/// Returns the solvers that run LAMMPS and LIGGGHTS, whether or not these programs are installed.
#[must_use]
pub fn programs() -> Vec<Box<dyn Solver>> {
    Program::ALL.into_iter().map(|program| Box::new(LiveProgram::find(program)) as Box<dyn Solver>).collect()
}

/// Returns the names of our solvers, of LAMMPS and of LIGGGHTS.
#[must_use]
pub fn names() -> Vec<String> {
    all().iter().chain(&programs()).map(|solver| solver.name()).collect()
}

/// Former solver names that are still accepted, each with the present name.
const EARLIER_NAMES: [(&str, &str); 1] = [("dem:no-tension", "dem")];

/// Returns the present name of a renamed solver; `None` if the name is no former name.
#[must_use]
pub fn renamed(name: &str) -> Option<&'static str> {
    EARLIER_NAMES.into_iter().find(|(earlier, _)| *earlier == name).map(|(_, now)| now)
}

/// Returns the solver with a present or former name; `None` if there is none. Words after `+` change settings of the
/// material point method, as in `mpm+quadratic+apic`.
#[must_use]
pub fn by_name(name: &str) -> Option<Box<dyn Solver>> {
    let name = renamed(name).unwrap_or(name);
    all().into_iter().chain(programs()).find(|solver| solver.name() == name).or_else(|| varied::by_name(name))
}

/// Returns each of our solvers with the conformance properties that it must satisfy. MPM is checked in two dimensions
/// only, so that each scene takes less than a second.
#[must_use]
pub fn with_terms() -> Vec<(Box<dyn Solver>, Terms)> {
    let dem = Convention::ALL.into_iter().map(|convention| {
        let dem = Dem::new(convention);
        (Box::new(dem) as Box<dyn Solver>, dem.terms())
    });
    let mpm = Mpm::ALL.into_iter().map(|mpm| (Box::new(mpm) as Box<dyn Solver>, mpm.terms().in_the_plane()));
    dem.chain([(Box::new(Rigid::new()) as Box<dyn Solver>, Rigid::TERMS)]).chain(mpm).collect()
}

/// Solvers and stored runs for the harness.
#[derive(Clone, Copy, Debug)]
pub struct Registry;

impl Solvers for Registry {
    fn find(&self, name: &str) -> Option<Arc<dyn Solver>> {
        by_name(name).map(Arc::from)
    }

    fn find_within(&self, name: &str, limit: Duration) -> Option<Arc<dyn Solver>> {
        match Program::by_name(name) {
            Some(program) => Some(Arc::new(LiveProgram::find(program).with_time_limit(limit))),
            None => self.find(name),
        }
    }

    fn with_defect(&self, name: &str, defect: Defect) -> Option<Arc<dyn Solver>> {
        let convention = Convention::ALL.into_iter().find(|convention| convention.name == name)?;
        Some(Arc::new(Dem::new(convention).with_defect(defect)))
    }

    fn is_program(&self, name: &str) -> bool {
        is_program(name)
    }

    fn edition(&self, name: &str) -> String {
        Program::by_name(name).map_or_else(String::new, |program| LiveProgram::find(program).edition())
    }

    fn references(&self) -> &dyn References {
        self
    }
}

impl References for Registry {
    fn stored(&self, case: &Case, run: &Run, scene: &Scene) -> Option<Result<Record, RunError>> {
        stored::record(case, run, scene)
    }

    fn kept(
        &self,
        case: &Case,
        run: &Run,
        scene: &Arc<Scene>,
        control: Option<&str>,
    ) -> Option<Result<FinishedRun, RunError>> {
        kept::load(case, run, scene, control)
    }

    fn missing_data(&self) -> Option<String> {
        missing()
    }

    fn uncertainty(&self, case: &Case, claim: &Claim) -> Option<f64> {
        uncertainty::find(case, claim).map(|found| found.uncertainty)
    }

    fn is_stored(&self, case: &Case, run: &Run) -> bool {
        stored::exists(case, run)
    }
}

/// Returns a runner of a case with the solvers of [`Registry`].
#[must_use]
pub fn runner(case: &'static Case) -> Runner {
    Runner::new(case, Arc::new(Registry))
}
