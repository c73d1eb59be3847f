//! `grainbench reference`: makes and verifies stored runs of other programs, and updates stored results and estimates.

use super::exit::{Fault, Outcome, check_writable, print, say};
use super::kept_runs::{KeepArguments, keep};
use super::progress::Progress;
use super::provenance::{self, provenance};
use super::publish::{Output, publish, write_files};
use grainbench::cases::registry::CASES;
use grainbench::cases::stored::{self, Reference};
use grainbench::cases::uncertainty::{self, StoredEstimates};
use grainbench::cases::{Case, runner};
use grainbench::harness::run::Set;
use grainbench::harness::tolerance::ToleranceOrigin;
use grainbench::reference::data::{installed, unpack};
use grainbench::reference::stored::{folder, make};
use grainbench::reports::{Report, Section, line};
use grainbench::solver::failure::RunError;
use grainbench::store::{StagedDir, temporary_in, write_file};
use grainbench::verify::verify as compare;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command as Process;
use std::time::Instant;

#[derive(clap::Subcommand)]
pub(crate) enum Command {
    /// Make stored runs with the installed programs.
    Build(Build),
    /// Repeat the runs with the installed programs and compare them with the stored runs.
    Verify(Verify),
    /// Do the long runs and store their results with the cases. `run` judges the stored results.
    Keep(KeepArguments),
    /// Install stored runs and initial states, which packages, wheels and archives of the program do not contain.
    Fetch(Fetch),
    /// Estimate discretization errors from three resolution levels, for each claim with an estimated tolerance.
    Uncertainty(Uncertainty),
}

#[derive(clap::Args)]
pub(crate) struct Uncertainty {
    /// Cases whose claims are estimated. Default: all.
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// Include claims that take minutes. Without this option, their stored estimates stay unchanged.
    #[arg(long)]
    long: bool,
}

#[derive(clap::Args)]
pub(crate) struct Build {
    /// Stored runs, by case or by folder name, with or without `lammps/` or `liggghts/`. Default: all.
    #[arg(value_name = "ID")]
    ids: Vec<String>,
    /// Directory for the stored runs. Default: the source tree.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

#[derive(clap::Args)]
pub(crate) struct Verify {
    /// Stored runs, by case or by folder name, with or without `lammps/` or `liggghts/`. Default: all.
    #[arg(value_name = "ID")]
    ids: Vec<String>,
    /// Directory of the report.
    #[arg(long, value_name = "DIR", default_value = "grainbench-out")]
    out: PathBuf,
    /// Print the results as JSON instead of a table.
    #[arg(long)]
    json: bool,
}

#[derive(clap::Args)]
pub(crate) struct Fetch {
    /// ZIP archive of the data for this version: a file, or an `https://` address that `curl` downloads.
    #[arg(value_name = "URL|FILE")]
    source: String,
    /// Directory for the data; name it in GRAINBENCH_DATA. Default: the directory of this user and version.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn reference(command: &Command) -> Outcome {
    match command {
        Command::Build(arguments) => build(arguments),
        Command::Verify(arguments) => verify(arguments),
        Command::Keep(arguments) => keep(arguments),
        Command::Fetch(arguments) => fetch(arguments),
        Command::Uncertainty(arguments) => uncertainty(arguments),
    }
}

/// Returns the stored runs with the given names.
fn named(ids: &[String]) -> Result<Vec<Reference>, Fault> {
    let all = stored::all();
    let full = |reference: &Reference| format!("{}/{}", reference.program.name(), reference.id);
    let is = |reference: &Reference, id: &str| id == reference.id || id == reference.case.name || id == full(reference);
    if let Some(unknown) = ids.iter().find(|id| !all.iter().any(|reference| is(reference, id))) {
        let mut known: Vec<String> = all.iter().map(full).collect();
        known.sort_unstable();
        return Err(Fault::unknown("a stored run", unknown, known.iter().map(String::as_str)));
    }
    Ok(all.into_iter().filter(|reference| ids.is_empty() || ids.iter().any(|id| is(reference, id))).collect())
}

fn build(arguments: &Build) -> Outcome {
    let wanted = named(&arguments.ids)?;
    arguments.out.as_deref().map(check_writable).transpose()?;
    let date = provenance::today();
    let progress = Progress::new(wanted.len() as u64, "runs");
    let mut lines = String::new();
    let mut failed = false;
    for reference in &wanted {
        progress.now(&reference.id);
        let target = match &arguments.out {
            Some(directory) => directory.join(reference.program.name()).join(&reference.id),
            None => folder(reference.program, &reference.id),
        };
        let scene = reference.scene()?;
        let made = make(reference.program, &reference.id, &reference.title(), &date, &scene, &reference.run.resolution);
        let outcome = match made {
            Ok(files) => {
                write_files(StagedDir::new(&target)?.without_manifest(), &files)?;
                let bytes: usize = files.iter().map(|(_, bytes)| bytes.len()).sum();
                format!("made           {}/{} ({bytes} bytes)\n", reference.program.name(), reference.id)
            }
            Err(error @ RunError::NotAvailable { .. }) => {
                say("warning", &error.to_string());
                format!("not-available  {}/{}\n", reference.program.name(), reference.id)
            }
            Err(error) => {
                failed = true;
                say("error", &format!("{}: {error}", reference.id));
                format!("failed         {}/{}\n", reference.program.name(), reference.id)
            }
        };
        lines.push_str(&outcome);
        progress.advance();
    }
    drop(progress);
    let printed = print(&lines)?;
    if failed { Err(Fault::Broken("not every run could be made".to_owned())) } else { Ok(printed) }
}

/// Installs the data of cases and stored runs, which only a source tree contains.
fn fetch(arguments: &Fetch) -> Outcome {
    arguments.out.as_deref().map(check_writable).transpose()?;
    let none = || Fault::Input("--out: expected a directory for the data, found no home directory".to_owned());
    let target = arguments.out.clone().or_else(installed).ok_or_else(none)?;
    let mut out = StagedDir::new(&target)?.without_manifest();
    let scratch = temporary_in(&std::env::temp_dir())?;
    let archive = if arguments.source.starts_with("https://") {
        let file = scratch.path().join("data.zip");
        download(&arguments.source, &file)?;
        file
    } else {
        PathBuf::from(&arguments.source)
    };
    let count = unpack(&archive, |name, bytes| out.write(name, bytes).map_err(io::Error::other));
    let count = count.map_err(Fault::input)?;
    out.commit()?;
    print(&format!("{count} files in {}\n", target.display()))
}

fn download(address: &str, file: &Path) -> Result<(), Fault> {
    let words = ["--fail", "--location", "--silent", "--show-error", "--output"];
    let done = Process::new("curl").args(words).arg(file).arg(address).output();
    let done =
        done.map_err(|error| Fault::Input(format!("curl: expected the program for the download, found {error}")))?;
    if done.status.success() {
        return Ok(());
    }
    let found = String::from_utf8_lossy(&done.stderr).trim().to_owned();
    Err(Fault::Input(format!("{address}: expected the archive of the data, found {found}")))
}

/// Estimates the discretization errors of claims with an estimated tolerance, and stores the estimates.
fn uncertainty(arguments: &Uncertainty) -> Outcome {
    let set = if arguments.long { Set::Long } else { Set::Tests };
    let known = || CASES.iter().map(|case| case.name);
    if let Some(unknown) = arguments.cases.iter().find(|name| !known().any(|known| known == name.as_str())) {
        return Err(Fault::unknown("a case", unknown, known()));
    }
    let wanted = |case: &&&Case| arguments.cases.is_empty() || arguments.cases.iter().any(|name| name == case.name);
    let mut lines = String::new();
    for case in CASES.iter().filter(wanted) {
        let mut claims = (case.claims)();
        claims.retain(|claim| claim.tolerance.made == ToleranceOrigin::Estimated);
        if claims.is_empty() {
            continue;
        }
        let runner = runner(case);
        let progress = Progress::new(claims.len() as u64, "estimates");
        let mut stored = StoredEstimates {
            program: format!("grainbench {}", env!("CARGO_PKG_VERSION")),
            commit: env!("GRAINBENCH_COMMIT").to_owned(),
            date: provenance::today(),
            rule: RULE.to_owned(),
            estimate: Vec::new(),
        };
        for claim in &claims {
            progress.now(&claim.quantity);
            let before = uncertainty::find(case, claim);
            let estimate =
                if claim.set() > set { before.ok_or("not requested".to_owned()) } else { runner.estimate(claim) };
            match estimate {
                Ok(estimate) => stored.estimate.push(estimate),
                Err(reason) => say("warning", &format!("{}: {}: {reason}", case.name, claim.quantity)),
            }
            progress.advance();
        }
        drop(progress);
        lines.push_str(&format!("{}: {} of {} rows\n", case.name, stored.estimate.len(), claims.len()));
        let text = toml::to_string(&stored)?;
        write_file(uncertainty::file(case.name), text.as_bytes())?;
    }
    print(&lines)
}

/// Rule of the estimates, written to the stored files so that they can be read without the program.
const RULE: &str = "three levels of resolution, each half as fine as the one before; observed order p, \
                    U = F_s |f1 - f2|/(2^p - 1) with F_s = 1.25 near the order of the method and 3 elsewhere (ASME V&V 20-2009)";

fn verify(arguments: &Verify) -> Outcome {
    let wanted = named(&arguments.ids)?;
    check_writable(&arguments.out)?;
    let start = Instant::now();
    let progress = Progress::new(wanted.len() as u64, "runs");
    let mut verdicts = Vec::new();
    for reference in &wanted {
        progress.now(&reference.id);
        verdicts.extend(compare(reference)?);
        progress.advance();
    }
    drop(progress);
    let section = Section {
        name: "reference".to_owned(),
        title: "Stored runs, repeated".to_owned(),
        claim: "The installed programs reproduce the stored results.".to_owned(),
        derivation:
            "Each program runs the deck of the current scene. The result is compared with the stored run: sample by \
             sample up to the predictability horizon, and by means over blocks after it."
                .to_owned(),
        weak: "An error is not detected if the program already had it when the run was stored.".to_owned(),
        verdicts,
        ..Section::default()
    };
    let words = [vec!["reference verify".to_owned()], arguments.ids.clone()].concat();
    let report = Report::new(provenance(words, start.elapsed().as_secs_f64()), vec![section]);
    let text = line::results(&report.verdicts().collect::<Vec<_>>());
    publish(&report, &Output { text: Some(text), ..Output::new(&arguments.out, arguments.json) })
}
