//! Tasks of a stability study: one for each stability limit or hard case, with its solver.

use super::arguments::Arguments;
use super::study::{ReportOptions, Study, outputs};
use crate::cli::exit::{Fault, Outcome, refuse};
use crate::cli::solver::NamedSolvers;
use grainbench::cases::registry;
use grainbench::harness::case::PLAIN;
use grainbench::harness::solvers::Solvers;
use grainbench::jobs::execute::{ResultSink, TaskList};
use grainbench::jobs::task::{Id, Task};
use grainbench::reports::study::stability::{HardCaseResult, Limit};
use grainbench::scene::scene::Scene;
use grainbench::store::log::State;
use grainbench::studies::stability::assembly::{self, Assembly};
use grainbench::studies::stability::hard::{self, HardCase};
use grainbench::studies::stability::limit;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Case in which the stability limit of grid methods is measured.
const BAR: &str = "vibrating-bar";
/// Numbers of cells along the bar, from coarse to fine.
const BAR_CELLS: [f64; 3] = [25.0, 50.0, 100.0];
/// Expected duration of finding a stability limit with contact springs (s).
const SPRINGS: f64 = 0.5;
/// Expected duration of finding a stability limit with a grid (s per cell).
const CELLS: f64 = 0.05;
/// Factor on the expected duration of a hard case. A failed case is repeated with smaller time steps.
const TRIES: f64 = 3.0;

pub(crate) struct StabilityStudy {
    assemblies: Vec<Assembly>,
    hard: Vec<HardCase>,
    bar: Scene,
    items: Vec<WorkItem>,
    solvers: NamedSolvers,
    arguments: Arguments,
}

/// Work item of the study: a stability limit or a hard case, by its index, with its solver.
enum WorkItem {
    Assembly(usize, String),
    Bar(&'static str, f64),
    Hard(usize, String),
}

/// Result of a task.
#[derive(Serialize, Deserialize)]
pub(crate) enum Tested {
    Limit(Limit),
    Hard(HardCaseResult),
}

impl StabilityStudy {
    pub(crate) fn new(arguments: &Arguments, is_shared: bool) -> Result<Self, Fault> {
        let (assemblies, hard) = (assembly::all()?, hard::all()?);
        let (solvers, named) = NamedSolvers::read_for(&arguments.solver, is_shared)?;
        let items = select(&arguments.cases, [&named, &solvers.names()], &assemblies, &hard)?;
        let bar = registry::by_name(BAR).ok_or_else(|| Fault::input("expected the case of a vibrating bar"))?;
        Ok(Self { assemblies, hard, bar: bar.variant(PLAIN)?, items, solvers, arguments: arguments.clone() })
    }

    fn task(&self, item: &WorkItem, program: &str) -> Task {
        let id =
            |solver: &str, words: &[&str]| Id::of_words(&(program.to_owned() + &self.solvers.edition(solver)), words);
        match item {
            WorkItem::Assembly(at, solver) => {
                let Assembly { name, kappa, scene, .. } = &self.assemblies[*at];
                let kappa = kappa.map_or_else(String::new, |kappa| format!(" {kappa}"));
                Task {
                    scene: format!("{name}{kappa}"),
                    solver: solver.clone(),
                    what: "limit".to_owned(),
                    ..Task::new(id(solver, &["limit", name, &format!("{scene:?}"), solver]), SPRINGS)
                }
            }
            WorkItem::Bar(setting, cells) => Task {
                scene: BAR.to_owned(),
                solver: (*setting).to_owned(),
                level: format!("cells={cells}"),
                what: "limit".to_owned(),
                ..Task::new(Id::of_words(program, &["bar", setting, &cells.to_string()]), CELLS * cells)
            },
            WorkItem::Hard(at, solver) => {
                let case = &self.hard[*at];
                let words = ["hard", &case.name, &format!("{:?}", case.scene), solver];
                Task {
                    scene: case.name.clone(),
                    solver: solver.clone(),
                    what: "hard case".to_owned(),
                    ..Task::new(id(solver, &words), TRIES * hard::seconds(case, solver))
                }
            }
        }
    }
}

impl TaskList for StabilityStudy {
    type Output = Tested;

    fn perform(&self, place: usize, sink: &ResultSink<'_, Tested>) -> (State, Tested) {
        let now = |name: &str, solver: &str| sink.now(&format!("{name} · {solver}"));
        let tested = match &self.items[place] {
            WorkItem::Assembly(at, solver) => {
                let assembly = &self.assemblies[*at];
                now(assembly.name, solver);
                Tested::Limit(limit::of_assembly(assembly, (&self.solvers, solver)))
            }
            WorkItem::Bar(setting, cells) => {
                now(BAR, setting);
                Tested::Limit(limit::of_bar(&self.bar, (&self.solvers, setting), *cells))
            }
            WorkItem::Hard(at, solver) => {
                now(&self.hard[*at].name, solver);
                Tested::Hard(hard::judge(&self.hard[*at], &self.solvers, solver))
            }
        };
        (State::Done, tested)
    }
}

impl Study for StabilityStudy {
    fn tasks(&self, program: &str) -> Result<Vec<Task>, Fault> {
        Ok(self.items.iter().map(|item| self.task(item, program)).collect())
    }

    fn inputs(&self) -> BTreeMap<String, String> {
        self.solvers.inputs()
    }

    fn report(&self, results: Vec<Option<Result<Tested, String>>>, how: &ReportOptions<'_>) -> Outcome {
        let (results, has_crash) = outputs(results, how);
        let mut study = how.study(self.arguments.command_words());
        for tested in results.into_iter().flatten() {
            match tested {
                Tested::Limit(limit) => study.limits.push(limit),
                Tested::Hard(row) => study.hard.push(row),
            }
        }
        how.publish(study, has_crash)
    }
}

/// Returns the selected work items. `cases` contains beginnings of the names of assemblies (with `-` for spaces), of
/// the bar and of hard cases. `solvers` contains the selected names, and `external_solvers` the names of the external solvers.
fn select(
    cases: &[String],
    [solvers, external_solvers]: [&[String]; 2],
    assemblies: &[Assembly],
    hard: &[HardCase],
) -> Result<Vec<WorkItem>, Fault> {
    let named = |name: &str| name.replace(' ', "-");
    let mut known: Vec<String> = assemblies.iter().map(|assembly| named(assembly.name)).collect();
    known.push(BAR.to_owned());
    known.extend(hard.iter().map(|case| case.name.clone()));
    if let Some(name) = cases.iter().find(|name| name.is_empty() || !known.iter().any(|known| known.starts_with(*name)))
    {
        return Err(Fault::unknown("an assembly or a hard case", name, known.iter().map(String::as_str)));
    }
    let case = |name: &str| cases.is_empty() || cases.iter().any(|wanted| name.starts_with(wanted));
    let solver = |name: &str| solvers.is_empty() || solvers.iter().any(|wanted| wanted == name);
    let theirs = || external_solvers.iter().map(String::as_str);
    let mut pieces = Vec::new();
    for (at, _) in assemblies.iter().enumerate().filter(|(_, assembly)| case(&named(assembly.name))) {
        let asked = limit::SPRINGS.into_iter().filter(|name| solver(name)).chain(theirs());
        pieces.extend(asked.map(|name| WorkItem::Assembly(at, name.to_owned())));
    }
    for setting in limit::GRIDS.into_iter().filter(|name| case(BAR) && solver(name)) {
        pieces.extend(BAR_CELLS.map(|cells| WorkItem::Bar(setting, cells)));
    }
    for (at, hard) in hard.iter().enumerate().filter(|(_, hard)| case(&hard.name)) {
        let asked = hard.asked.iter().copied().filter(|name| solver(name)).chain(theirs());
        pieces.extend(asked.map(|name| WorkItem::Hard(at, name.to_owned())));
    }
    if pieces.is_empty() {
        refuse!("expected at least one case for the selected solvers, found none");
    }
    Ok(pieces)
}
