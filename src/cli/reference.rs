//! `grainbench reference`: makes the stored runs of other programs, and sees whether these still give them.

use super::check::rows;
use super::exit::{Fault, Outcome, check_writable, print, say};
use super::progress::Progress;
use super::provenance::provenance;
use super::run::exit_code;
use grainbench::cases::stored::{self, Reference};
use grainbench::reference::stored::{folder, make};
use grainbench::reports::results::results_json;
use grainbench::reports::{Report, Section, StagedDir, write_report};
use grainbench::scene::solver::RunError;
use grainbench::verify::verify as compare;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// What the command takes.
#[derive(clap::Subcommand)]
pub(crate) enum Command {
    /// Make stored runs with the programs that are installed.
    Build(Build),
    /// Run the programs again and compare with what is stored.
    Verify(Verify),
}

/// What `build` takes.
#[derive(clap::Args)]
pub(crate) struct Build {
    /// Which: names of their folders, with or without `lammps/` or `liggghts/` in front, or cases; all when none is named.
    #[arg(value_name = "ID")]
    ids: Vec<String>,
    /// Directory for the folders of both programs, in place of that among the sources.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// What `verify` takes.
#[derive(clap::Args)]
pub(crate) struct Verify {
    /// Which: names of their folders, with or without `lammps/` or `liggghts/` in front, or cases; all when none is named.
    #[arg(value_name = "ID")]
    ids: Vec<String>,
    /// Directory for the report.
    #[arg(long, value_name = "DIR", default_value = "grainbench-out")]
    out: PathBuf,
    /// Print the results as JSON instead of a table.
    #[arg(long)]
    json: bool,
}

/// Does what is asked for.
pub(crate) fn reference(command: &Command) -> Outcome {
    match command {
        Command::Build(arguments) => build(arguments),
        Command::Verify(arguments) => verify(arguments),
    }
}

/// The runs of some names.
fn named(ids: &[String]) -> Result<Vec<Reference>, Fault> {
    let all = stored::all();
    let full = |of: &Reference| format!("{}/{}", of.program.name(), of.id);
    let is = |of: &Reference, id: &str| id == of.id || id == of.case.name || id == full(of);
    if let Some(unknown) = ids.iter().find(|id| !all.iter().any(|of| is(of, id))) {
        let mut known: Vec<String> = all.iter().map(full).collect();
        known.sort_unstable();
        return Err(Fault::unknown("a stored run", unknown, known.iter().map(String::as_str)));
    }
    Ok(all.into_iter().filter(|of| ids.is_empty() || ids.iter().any(|id| is(of, id))).collect())
}

fn build(arguments: &Build) -> Outcome {
    let wanted = named(&arguments.ids)?;
    let date = jiff::Timestamp::now().strftime("%Y-%m-%d").to_string();
    let progress = Progress::new(wanted.len() as u64, "runs");
    let mut lines = String::new();
    let mut failed = false;
    for of in &wanted {
        progress.now(&of.id);
        let target = match &arguments.out {
            Some(directory) => directory.join(of.program.name()).join(&of.id),
            None => folder(of.program, &of.id),
        };
        let scene = of.scene()?;
        let made = make(of.program, &of.id, &of.title(), &date, &scene, &of.run.resolution);
        let said = match made {
            Ok(made) => {
                let mut out = StagedDir::new(&target).map_err(Fault::input)?;
                let bytes: usize = made.files.iter().map(|(_, bytes)| bytes.len()).sum();
                for (name, bytes) in &made.files {
                    out.write(name, bytes).map_err(Fault::input)?;
                }
                out.commit().map_err(Fault::input)?;
                format!("made           {}/{} ({bytes} bytes)\n", of.program.name(), of.id)
            }
            Err(error @ RunError::NotAvailable { .. }) => {
                say("warning", &error.to_string());
                format!("not-available  {}/{}\n", of.program.name(), of.id)
            }
            Err(error) => {
                failed = true;
                say("error", &format!("{}: {error}", of.id));
                format!("failed         {}/{}\n", of.program.name(), of.id)
            }
        };
        lines.push_str(&said);
        progress.advance();
    }
    drop(progress);
    print(&lines)?;
    if failed { Err(Fault::Broken("not every run could be made".to_owned())) } else { Ok(ExitCode::SUCCESS) }
}

fn verify(arguments: &Verify) -> Outcome {
    let wanted = named(&arguments.ids)?;
    check_writable(&arguments.out)?;
    let start = Instant::now();
    let progress = Progress::new(wanted.len() as u64, "runs");
    let mut verdicts = Vec::new();
    for of in &wanted {
        progress.now(&of.id);
        verdicts.extend(compare(of)?);
        progress.advance();
    }
    drop(progress);
    let section = Section {
        name: "reference".to_owned(),
        title: "Stored runs, run again".to_owned(),
        claim: "The programs that are installed give what is stored.".to_owned(),
        derivation:
            "Each program is run on the deck of the scene as it is now, and compared with the stored samples: one \
                     by one up to the step to which the run can be predicted, and by means over blocks after it."
                .to_owned(),
        weak: "A program that was wrong when the run was stored, and still is, is not seen.".to_owned(),
        figures: Vec::new(),
        verdicts,
        controls: Vec::new(),
        runs: Vec::new(),
    };
    let words = [vec!["reference verify".to_owned()], arguments.ids.clone()].concat();
    let report = Report { provenance: provenance(words, start.elapsed().as_secs_f64()), sections: vec![section] };
    write_report(&arguments.out, &report).map_err(Fault::input)?;
    if arguments.json {
        print(&results_json(&report).map_err(Fault::input)?)?;
    } else {
        print(&format!("{}{}\n", rows(&report), arguments.out.join("index.html").display()))?;
    }
    Ok(exit_code(&report))
}
