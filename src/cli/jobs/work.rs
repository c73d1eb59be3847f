//! `run --resume DIR`: runs the tasks of a plan or of a shard, on this machine or through a batch system.

use super::arguments::Arguments as Planned;
use super::watch::Follower;
use super::{enter, from_arguments};
use crate::cli::cores::cores;
use crate::cli::exit::{self, Fault, Outcome, RED, print, refuse};
use crate::cli::provenance::provenance;
use grainbench::jobs::plan::Plan;
use grainbench::jobs::shard::Shard;
use grainbench::jobs::slurm;
use grainbench::jobs::work::{Summary, WorkRequest};
use grainbench::reports::number;
use grainbench::store::log::{State, Worker};
use grainbench::store::machine;
use std::env;
use std::path::Path;
use std::process::ExitCode;
use std::time::{SystemTime, UNIX_EPOCH};

/// Options of `run` that need `--resume`.
#[derive(Default, clap::Args)]
pub(crate) struct WorkOptions {
    /// Run only shard K of N. Default: the whole plan.
    #[arg(long, value_name = "K/N", conflicts_with = "on", requires = "resume")]
    pub(crate) shard: Option<Shard>,
    /// Submit the shards to this batch system instead of running them on this machine.
    #[arg(long, value_name = "slurm", value_parser = ["slurm"], requires = "resume")]
    pub(crate) on: Option<String>,
    /// Submit only the missing shards of a plan that was submitted before.
    #[arg(long, requires = "on")]
    pub(crate) resubmit: bool,
    /// Options of `sbatch`.
    #[arg(value_name = "OPTIONS OF sbatch", last = true, requires = "on")]
    pub(crate) sbatch: Vec<String>,
    /// True to print no counts on the standard output.
    #[arg(skip)]
    pub(crate) quiet: bool,
}

/// Runs the tasks of a plan or submits them to a batch system.
pub(crate) fn work(plan: &Path, options: &WorkOptions, jobs: Option<u16>, retry_failed: bool) -> Outcome {
    let plan = enter(plan)?;
    plan.check_program()?;
    if options.on.is_some() {
        return submit(&plan, options);
    }
    let study = from_arguments(&Planned::read(&plan)?, true)?;
    study.check(&plan)?;
    let jobs = match (jobs, plan.head.timed) {
        (Some(2..), true) => {
            refuse!("--jobs: expected 1, because times are measured, found more");
        }
        (_, true) => 1,
        (Some(jobs), false) => usize::from(jobs),
        (None, false) => cores(),
    };
    let again: &[State] = if retry_failed { &[State::Failed, State::Crashed] } else { &[] };
    let asked = WorkRequest { shard: options.shard.unwrap_or(Shard::WHOLE), again, jobs };
    let summary = study.work(&plan, &asked, &worker(), &Follower::new("tasks", None))?;
    if !options.quiet {
        let Summary { tasks, before, done, failed, .. } = summary;
        let [tasks, before, done, failures] = [tasks, before, done, failed].map(|number| number::count(number as u64));
        let failed = if failed > 0 { format!(", {failures} of them failed") } else { String::new() };
        print(&format!("{tasks} tasks: {before} were finished, {done} done now{failed}\n"))?;
    }
    if summary.left > 0 {
        exit::say("warning", &format!("{} tasks remain; the same command continues the work", summary.left));
        return Ok(RED);
    }
    Ok(ExitCode::SUCCESS)
}

fn submit(plan: &Plan, options: &WorkOptions) -> Outcome {
    let program = env::current_exe().map_err(|error| Fault::input(format!("this program: {error}")))?;
    match slurm::submit(plan, &program, &options.sbatch, options.resubmit)? {
        Some(job) => print(&format!("job {}: shards {} of {}\n", job.job, job.indexes, job.shards)),
        None => print("every missing task is queued or running\n"),
    }
}

/// Returns a description of this process as a worker.
pub(super) fn worker() -> Worker {
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
