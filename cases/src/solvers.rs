//! The registry of solvers: a line each.

use crate::{kept, stored, uncertainty, varied};
use grainbench_dem::convention::Convention;
use grainbench_dem::solver::Dem;
use grainbench_harness::case::Case;
use grainbench_harness::claim::Claim;
use grainbench_harness::run::Run;
use grainbench_harness::solvers::{Kept, Solvers};
use grainbench_mpm::solver::Mpm;
use grainbench_reference::deck::Program;
use grainbench_reference::live::Live;
use grainbench_rigid::solver::Rigid;
use grainbench_scene::record::Record;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{Defect, RunError, Solver};
use grainbench_scene::terms::Terms;
use std::sync::Arc;
use std::time::Duration;

/// Every solver of ours.
#[must_use]
pub fn all() -> Vec<Box<dyn Solver>> {
    let dem = Convention::ALL.into_iter().map(|convention| Box::new(Dem::new(convention)) as Box<dyn Solver>);
    let mpm = Mpm::ALL.into_iter().map(|setting| Box::new(setting) as Box<dyn Solver>);
    dem.chain([Box::new(Rigid::new()) as Box<dyn Solver>]).chain(mpm).collect()
}

/// Other people's programs, whether or not they are installed.
#[must_use]
pub fn programs() -> Vec<Box<dyn Solver>> {
    Program::ALL.into_iter().map(|program| Box::new(Live::find(program)) as Box<dyn Solver>).collect()
}

/// The names of all of them.
#[must_use]
pub fn names() -> Vec<String> {
    all().iter().chain(&programs()).map(|solver| solver.name()).collect()
}

/// Names of earlier versions that are still accepted, and the solvers that they name now.
const EARLIER_NAMES: [(&str, &str); 1] = [("dem:no-tension", "dem")];

/// The name now of a solver that had another one in earlier versions.
#[must_use]
pub fn renamed(name: &str) -> Option<&'static str> {
    EARLIER_NAMES.into_iter().find(|(earlier, _)| *earlier == name).map(|(_, now)| now)
}

/// The solver of a name, or of an earlier one. The material point method may be given words that change its setting, such as
/// `mpm+quadratic+apic`.
#[must_use]
pub fn by_name(name: &str) -> Option<Box<dyn Solver>> {
    let name = renamed(name).unwrap_or(name);
    all().into_iter().chain(programs()).find(|solver| solver.name() == name).or_else(|| varied::by_name(name))
}

/// Every solver of ours with what it claims of itself, in scenes that take a moment.
#[must_use]
pub fn with_terms() -> Vec<(Box<dyn Solver>, Terms)> {
    let dem = Convention::ALL.into_iter().map(|convention| {
        let dem = Dem::new(convention);
        (Box::new(dem) as Box<dyn Solver>, dem.terms())
    });
    let mpm = Mpm::ALL.into_iter().map(|mpm| (Box::new(mpm) as Box<dyn Solver>, mpm.terms().in_the_plane()));
    dem.chain([(Box::new(Rigid::new()) as Box<dyn Solver>, Rigid::TERMS)]).chain(mpm).collect()
}

/// The solvers and stored runs that the harness is handed.
#[derive(Clone, Copy, Debug)]
pub struct Registry;

impl Solvers for Registry {
    fn find(&self, name: &str) -> Option<Arc<dyn Solver>> {
        by_name(name).map(Arc::from)
    }

    fn find_within(&self, name: &str, limit: Duration) -> Option<Arc<dyn Solver>> {
        match Program::by_name(name) {
            Some(program) => Some(Arc::new(Live::find(program).with_time_limit(limit))),
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

    fn stored(&self, case: &Case, run: &Run, scene: &Scene) -> Option<Result<Record, RunError>> {
        stored::record(case, run, scene)
    }

    fn kept(&self, case: &Case, run: &Run, scene: &Scene, control: Option<&str>) -> Option<Result<Kept, RunError>> {
        kept::load(case, run, scene, control)
    }

    fn uncertainty(&self, case: &Case, claim: &Claim) -> Option<f64> {
        uncertainty::find(case, claim).map(|found| found.uncertainty)
    }

    fn is_stored(&self, case: &Case, run: &Run) -> bool {
        stored::exists(case, run)
    }
}

/// Whether a name is that of another program.
#[must_use]
pub fn is_program(name: &str) -> bool {
    Program::by_name(name).is_some()
}
