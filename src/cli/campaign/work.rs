//! `grainbench work`: runs the tasks of a plan or of a chunk, here or through a batch system.

use super::plan::Arguments as Planned;
use super::{enter, study};
use crate::cli::cores::{MOST_THREADS, cores};
use crate::cli::exit::{self, Fault, Outcome, RED, print};
use crate::cli::interrupt::Interrupt;
use crate::cli::progress::Progress;
use crate::cli::provenance::provenance;
use crate::cli::value::whole;
use grainbench::campaign::chunk::Chunk;
use grainbench::campaign::lease::LeaseContents;
use grainbench::campaign::log::Worker;
use grainbench::campaign::plan::Plan;
use grainbench::campaign::work::{Summary, Watch, WorkRequest, work as do_chunk};
use grainbench::campaign::{machine, slurm};
use grainbench::reference::has_ended_programs;
use grainbench::reports::number;
use std::env;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{SystemTime, UNIX_EPOCH};

/// Arguments of the command.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Directory of the plan.
    #[arg(value_name = "PLAN")]
    plan: PathBuf,
    /// Chunk and number of chunks; by default the whole plan.
    #[arg(long, value_name = "i/n", conflicts_with = "on")]
    chunk: Option<Chunk>,
    /// Number of simultaneous tasks; by default one for each core, and one if times are measured.
    #[arg(short, long, value_name = "N", value_parser = whole(1, MOST_THREADS), conflicts_with = "on")]
    jobs: Option<u16>,
    /// Repeat failed tasks.
    #[arg(long, conflicts_with = "on")]
    retry_failed: bool,
    /// Submit the chunks to a batch system instead of working here.
    #[arg(long, value_name = "slurm", value_parser = ["slurm"])]
    on: Option<String>,
    /// Submit the missing chunks of a submitted plan.
    #[arg(long, requires = "on")]
    resubmit: bool,
    /// Options for `sbatch`, after `--`.
    #[arg(value_name = "OPTIONS OF sbatch", last = true, requires = "on")]
    sbatch: Vec<String>,
}

/// Runs the tasks, or submits them.
pub(crate) fn work(arguments: &Arguments) -> Outcome {
    let plan = enter(&arguments.plan)?;
    plan.check_program()?;
    if arguments.on.is_some() {
        return submit(&plan, arguments);
    }
    let study = study::from_arguments(&Planned::read(&plan)?)?;
    let jobs = match (arguments.jobs, plan.head.timed) {
        (Some(2..), true) => {
            return Err(Fault::input("--jobs: expected 1, for times are measured, found more"));
        }
        (_, true) => 1,
        (Some(jobs), false) => usize::from(jobs),
        (None, false) => cores(),
    };
    let observer = Arc::new(WorkObserver { interrupt: Interrupt::listen(), progress: Mutex::new(None) });
    let asked = WorkRequest { chunk: arguments.chunk.unwrap_or(Chunk::WHOLE), again: arguments.retry_failed };
    let worker = worker();
    let watch = Arc::<WorkObserver>::clone(&observer);
    let done = do_chunk(&plan, &asked, &worker, watch, &|tasks, desk| {
        study.work(&plan, tasks, jobs, desk).map_err(|fault| grainbench::campaign::Fault::Input(fault.to_string()))
    });
    *observer.progress.lock().unwrap_or_else(PoisonError::into_inner) = None;
    let summary = done?;
    print(&words(&summary))?;
    if summary.left > 0 {
        exit::say("warning", &format!("{} tasks are left: the same command goes on with them", summary.left));
        return Ok(ExitCode::from(RED));
    }
    Ok(ExitCode::SUCCESS)
}

fn submit(plan: &Plan, arguments: &Arguments) -> Outcome {
    let program = env::current_exe().map_err(|error| Fault::input(format!("this program: {error}")))?;
    let asked = slurm::SubmitRequest { program: &program, again: arguments.resubmit, options: &arguments.sbatch };
    match slurm::submit(plan, &asked)? {
        Some(job) => print(&format!("job {}: chunks {} of {}\n", job.job, job.indexes, job.chunks))?,
        None => print("nothing is missing that is not queued or somebody's\n")?,
    }
    Ok(ExitCode::SUCCESS)
}

fn words(summary: &Summary) -> String {
    let &Summary { tasks, before, done, failed, .. } = summary;
    let count = |number: usize| number::count(number as u64);
    let failed = if failed > 0 { format!(", {} of them failed", count(failed)) } else { String::new() };
    format!("{} tasks: {} were finished, {} done now{failed}\n", count(tasks), count(before), count(done))
}

/// Describes this process as a worker.
fn worker() -> Worker {
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let (host, process) = (machine::name(), std::process::id());
    let about = provenance(Vec::new(), 0.0);
    let variable = |name: &str| env::var(name).ok().filter(|value| !value.is_empty());
    let array = variable("SLURM_ARRAY_JOB_ID")
        .zip(variable("SLURM_ARRAY_TASK_ID"))
        .map(|(job, index)| format!("{job}_{index}"));
    let job = array.or_else(|| variable("SLURM_JOB_ID")).or_else(|| variable("HQ_JOB_ID"));
    Worker {
        name: format!("{:013}-{host}-{process}", now.as_millis()),
        host,
        process,
        machine: about.machine,
        cores: cores(),
        job,
        granted: variable("SLURM_CPUS_ON_NODE").and_then(|cores| cores.parse().ok()),
        began: about.date,
    }
}

/// Observer that shows the progress and stops the work on an interrupt.
struct WorkObserver {
    interrupt: Interrupt,
    progress: Mutex<Option<Progress>>,
}

impl Watch for WorkObserver {
    fn goes_on(&self) -> bool {
        !self.interrupt.is_asked()
    }

    fn are_results_valid(&self) -> bool {
        !has_ended_programs()
    }

    fn begins(&self, tasks: usize) {
        let mut progress = self.progress.lock().unwrap_or_else(PoisonError::into_inner);
        *progress = Some(Progress::new(tasks as u64, "tasks"));
    }

    fn finished(&self) {
        if let Some(progress) = &*self.progress.lock().unwrap_or_else(PoisonError::into_inner) {
            progress.advance();
        }
    }

    fn waits(&self, others: &[LeaseContents]) {
        let mut progress = self.progress.lock().unwrap_or_else(PoisonError::into_inner);
        let progress = progress.get_or_insert_with(|| Progress::new(0, "tasks"));
        let names: Vec<&str> = others.iter().map(|other| other.worker.as_str()).collect();
        progress.now(&format!("the rest is at {}", names.join(", ")));
    }
}
