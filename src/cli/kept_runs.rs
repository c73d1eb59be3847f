//! `grainbench reference keep`: does the runs whose results are stored with the cases.

use super::checkpoint::read;
use super::cores::MOST_THREADS;
use super::exit::{Fault, Outcome, exit_code, print, refuse, say};
use super::interrupt::Interrupt;
use super::progress::Progress;
use super::provenance;
use super::publish::write_files;
use super::value::whole;
use grainbench::cases::kept::{self, StorableRun};
use grainbench::cases::{Case, runner, solvers};
use grainbench::harness::run::{FinishedRun, ResultOrigin, Set};
use grainbench::harness::runner::{Runner, RunnerOptions};
use grainbench::resume::{self, Place};
use grainbench::scene::scene::Scene;
use grainbench::solver::failure::RunError;
use grainbench::solver::observer::{Observer, RunOptions, RunOutline};
use grainbench::store::StagedDir;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

#[derive(clap::Args)]
pub(crate) struct KeepArguments {
    /// Cases whose runs are done. Default: all cases with stored results.
    #[arg(value_name = "CASE")]
    cases: Vec<String>,
    /// Also repeat runs that have a stored result.
    #[arg(long)]
    no_cache: bool,
    /// Include full-scale runs, which take hours.
    #[arg(long)]
    paper_size: bool,
    /// Do only runs whose name contains this text. The command prints the names.
    #[arg(long, value_name = "LETTERS")]
    run: Option<String>,
    /// Directory with your copy of third-party data. Runs whose data are missing are skipped.
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Number of threads of each run.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = whole(1, MOST_THREADS))]
    threads: u16,
    /// Directory of checkpoints. An interrupted run continues from `CASE-RUN.checkpoint`, which is deleted when the
    /// result is stored. The checkpoint may also come from `simulate --checkpoint` of the same run. Runs whose
    /// snapshots are processed during the run have no checkpoints.
    #[arg(long, value_name = "DIR", default_value = "grainbench-checkpoints")]
    checkpoints: PathBuf,
}

/// Number of steps between checkpoints.
const EVERY: u64 = 20_000;

/// Does the runs and stores their results. Each result is stored before the next run begins.
pub(crate) fn keep(arguments: &KeepArguments) -> Outcome {
    let known = kept::cases();
    let names = || known.iter().map(|case| case.name);
    if let Some(unknown) = arguments.cases.iter().find(|name| !names().any(|known| known == name.as_str())) {
        return Err(Fault::unknown("a case with stored runs", unknown, names()));
    }
    let is_named = |case: &&&Case| arguments.cases.is_empty() || arguments.cases.iter().any(|name| name == case.name);
    let largest = if arguments.paper_size { Set::Paper } else { Set::Long };
    let is_meant = |wanted: &StorableRun| {
        wanted.set() <= largest && arguments.run.as_ref().is_none_or(|letters| wanted.id.contains(letters.as_str()))
    };
    let interrupt = Interrupt::listen();
    let mut failed = false;
    if let Some(letters) = &arguments.run
        && !known.iter().filter(is_named).flat_map(|case| kept::all(case)).any(|wanted| is_meant(&wanted))
    {
        refuse!("--run: expected part of the name of a stored run, found `{letters}`");
    }
    for case in known.iter().filter(is_named) {
        let (repeated, threads) = (Some(Set::Paper), usize::from(arguments.threads));
        let options = RunnerOptions { repeated, threads, data: arguments.data.clone(), ..RunnerOptions::default() };
        let runner = runner(case).with(options);
        let wanted: Vec<StorableRun> = kept::all(case).into_iter().filter(is_meant).collect();
        for (place, one) in wanted.iter().enumerate() {
            let given = match runner.given(&one.claim, &one.run, one.wrong) {
                Err(RunError::NotAvailable { reason, .. }) if arguments.data.is_none() => {
                    say("note", &format!("{}: skipped: {reason}", one.id));
                    print(&format!("{:8} {}/{}\n", "absent", case.name, one.id))?;
                    continue;
                }
                given => given?,
            };
            let keeping = StorageTask {
                arguments,
                runner: &runner,
                wanted: one,
                given,
                words: format!("{} ({} of {} runs)", one.id, place + 1, wanted.len()),
                interrupt: &interrupt,
            };
            let stored = one.stored(&keeping.given).filter(|_| !arguments.no_cache);
            let outcome = match stored.map_or_else(|| keeping.done().map(|()| "done"), |origin| Ok(word(&origin))) {
                Ok(word) => word,
                Err(Fault::Broken(reason)) if !interrupt.is_asked() => {
                    failed = true;
                    say("error", &format!("{}: {reason}", one.id));
                    "failed"
                }
                Err(fault) => return Err(fault),
            };
            print(&format!("{outcome:8} {}/{}\n", case.name, one.id))?;
            if interrupt.is_asked() {
                return Err(Fault::Broken("interrupted: finished runs are stored".to_owned()));
            }
        }
    }
    if failed { Err(Fault::Broken("not every run could be done".to_owned())) } else { Ok(exit_code(false)) }
}

/// Returns the word for a run that has a stored result and is not repeated.
fn word(origin: &ResultOrigin) -> &'static str {
    if origin.is_current { "there" } else { "outdated" }
}

/// Run whose result is to be stored.
struct StorageTask<'a> {
    arguments: &'a KeepArguments,
    runner: &'a Runner,
    wanted: &'a StorableRun,
    given: Arc<Scene>,
    /// Name of the run in the progress bar.
    words: String,
    interrupt: &'a Interrupt,
}

impl StorageTask<'_> {
    /// Does the run, stores the result and deletes the checkpoint.
    fn done(&self) -> Result<(), Fault> {
        let Self { wanted, runner, .. } = self;
        // Checkpoints do not contain the state of a reader that processes the snapshots during the run.
        let is_resumable = wanted.run.reading.is_none() && !solvers::is_program(wanted.run.solver);
        let done = if is_resumable {
            self.resumed()?
        } else {
            let progress = Progress::new(1, "run");
            progress.now(&self.words);
            let done =
                if wanted.wrong { runner.run_wrong(&wanted.claim, &wanted.run) } else { runner.run(&wanted.run) };
            done.map_err(|error| Fault::Broken(error.to_string()))?
        };
        let date = provenance::today();
        let made = [env!("GRAINBENCH_COMMIT"), &date];
        let files = kept::files(wanted, &done, &self.given, made).map_err(Fault::input)?;
        write_files(StagedDir::new(wanted.folder())?.without_manifest(), &files)?;
        if is_resumable {
            // A short run has no checkpoint. The directory is deleted only if it is empty.
            let _ = fs::remove_file(self.checkpoint());
            let _ = fs::remove_dir(&self.arguments.checkpoints);
        }
        Ok(())
    }

    fn checkpoint(&self) -> PathBuf {
        let StorableRun { case, id, .. } = self.wanted;
        self.arguments.checkpoints.join(format!("{}-{id}.checkpoint", case.name))
    }

    /// Does the run, starting from its checkpoint if there is one.
    fn resumed(&self) -> Result<FinishedRun, Fault> {
        let run = &self.wanted.run;
        let solver = solvers::by_name(run.solver)
            .ok_or_else(|| Fault::input(format!("expected a solver, found `{}`", run.solver)))?;
        let path = self.checkpoint();
        let folder = &self.arguments.checkpoints;
        fs::create_dir_all(folder).map_err(|error| Fault::input(format!("{}: {error}", folder.display())))?;
        let from = if path.exists() { Some(read(&path)?) } else { None };
        if let Some(from) = &from {
            say("note", &format!("{}: continues from step {} of its checkpoint", self.wanted.id, from.step()));
        }
        let mut watcher = Watcher { of: self, progress: None, is_new: true };
        let place = Place { path: &path, every: EVERY };
        let record = resume::run(solver.as_ref(), &self.given, &run.resolution, from.as_ref(), place, &mut watcher);
        match record {
            Ok(record) => Ok(FinishedRun::new(Arc::clone(&self.given), Arc::new(record))),
            Err(error @ RunError::Interrupted { .. }) if path.exists() => {
                let path = path.display();
                Err(Fault::Broken(format!("{}: {error}; the same command continues from {path}", self.wanted.id)))
            }
            Err(error @ RunError::Checkpoint(_)) => Err(Fault::input(format!("{}: {error}", path.display()))),
            Err(error) => Err(Fault::Broken(error.to_string())),
        }
    }
}

/// Observer that shows the progress of a run.
struct Watcher<'a> {
    of: &'a StorageTask<'a>,
    progress: Option<Progress>,
    /// True before the first report of progress.
    is_new: bool,
}

impl Observer for Watcher<'_> {
    fn begin(&mut self, ahead: RunOutline) {
        let progress = Progress::new(ahead.steps, "steps");
        progress.now(&self.of.words);
        self.progress = Some(progress);
    }

    fn options(&self) -> RunOptions {
        RunOptions { threads: usize::from(self.of.arguments.threads), ..RunOptions::DEFAULT }
    }

    fn progress(&mut self, done: u64, total: u64) {
        let Some(progress) = &self.progress else { return };
        if std::mem::take(&mut self.is_new) {
            progress.from(done);
        }
        progress.set(done, total);
    }

    fn is_over(&self) -> bool {
        self.of.interrupt.is_asked()
    }
}
