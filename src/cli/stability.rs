//! `grainbench stability`: finds the largest stable time steps and runs hard cases.

use super::exit::Fault;
use super::jobs::arguments::{Arguments as Planned, StudyOptions};
use super::own::{self, sources};
use grainbench::reports::study::Study;
use grainbench::studies::stability::assembly::Assembly;
use grainbench::studies::stability::hard::HardCase;
use grainbench::studies::stability::limit;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::ExitCode;

/// Case in which the stability limit of grid methods is measured.
pub(super) const BAR: &str = "vibrating-bar";
/// Numbers of cells along the bar, from coarse to fine.
const BAR_CELLS: [f64; 3] = [25.0, 50.0, 100.0];

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Names, or beginnings of names, of hard cases and of assemblies with a known stability limit. Or one scene of your own: a
    /// scene file, or a folder with `scene.toml`. Default: all cases.
    #[arg(value_name = "CASE|SCENE.toml|FOLDER")]
    pub(crate) cases: Vec<String>,
    /// Test only this solver, by name or manifest. Repeatable.
    #[arg(long, value_name = "NAME|SOLVER.toml")]
    pub(crate) solver: Vec<String>,
    /// Directory of the report and of the finished parts.
    #[arg(long, value_name = "DIR", default_value = "grainbench-stability")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    own: own::Options,
    #[command(flatten)]
    pub(crate) study: StudyOptions,
}

/// Work item of the study: a stability limit or a hard case, by its index, with its solver.
pub(crate) enum WorkItem {
    Assembly(usize, String),
    Bar(&'static str, f64),
    Hard(usize, String),
}

impl Arguments {
    /// Returns the arguments of the study.
    pub(crate) fn planned(&self) -> Planned {
        Planned {
            what: "stability".to_owned(),
            cases: self.cases.clone(),
            solver: self.solver.clone(),
            out: self.out.clone(),
            ..Planned::default()
        }
    }

    /// Studies the scene that the arguments name; returns `None` if they name cases.
    pub(crate) fn own_scene(&self) -> Result<Option<ExitCode>, Fault> {
        let Some(path) = own::scene(&self.cases)? else {
            self.own.refuse_for_cases(false)?;
            return Ok(None);
        };
        if self.study.plan.is_given() {
            return Err(Fault::input(format!("{path}: expected cases with `--plan`, found a scene file")));
        }
        let (words, solvers) = ([&self.cases[..], &self.solver].concat(), &self.solver);
        let input = own::Input {
            path,
            words,
            solvers,
            quantities: &[],
            window: None,
            no_cache: self.study.no_cache,
            out: &self.out,
            json: self.study.json,
        };
        own::stability(&input, &self.own).map(Some)
    }
}

/// Returns the hashes of the sources of all solvers in the study, by solver name.
pub(crate) fn sources_of(study: &Study) -> BTreeMap<String, String> {
    let limits = study.limits.iter().map(|row| row.solver.clone());
    let asked: Vec<String> = limits.chain(study.hard.iter().map(|row| row.solver.clone())).collect();
    sources(&asked)
}

/// Returns the selected work items. `cases` contains beginnings of the names of assemblies (with `-` for spaces), of
/// the bar and of hard cases. `solvers` contains the selected names, and `strangers` the names of the external solvers.
pub(crate) fn select(
    cases: &[String],
    [solvers, strangers]: [&[String]; 2],
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
    let theirs = || strangers.iter().map(String::as_str);
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
        return Err(Fault::input("expected at least one case for the selected solvers, found none"));
    }
    Ok(pieces)
}
