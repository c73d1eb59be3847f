//! `report --progress`: prints the progress of a plan.

use crate::cli::exit::{Outcome, print, print_json};
use grainbench::jobs::plan::Plan;
use grainbench::jobs::slurm;
use grainbench::jobs::status::Status;
use grainbench::reports::number;
use serde::Serialize;
use std::path::Path;

/// Progress of a plan, printed as JSON.
#[derive(Serialize)]
struct StatusJson<'a> {
    #[serde(flatten)]
    status: &'a Status,
    /// Number of elements of job arrays that wait or run; null if the batch system cannot be queried.
    queued: Option<usize>,
}

/// Prints how many tasks of a plan are in each state.
pub(crate) fn status(plan: &Path, json: bool) -> Outcome {
    let plan = Plan::read(plan)?;
    let status = Status::from_plan(&plan)?;
    let queued = slurm::in_queue(&plan.path);
    if json {
        return print_json(&StatusJson { status: &status, queued: queued.ok() });
    }
    let mut text = String::new();
    let lines = [
        ("done", status.done),
        ("failed", status.failed),
        ("crashed", status.crashed),
        ("running", status.running),
        ("waiting", status.waiting),
        ("twice", status.twice),
        ("damaged", status.damaged),
    ];
    for (word, count) in lines {
        // Counts that should be zero are printed only if they are not zero.
        if count > 0 || !matches!(word, "crashed" | "twice" | "damaged") {
            text.push_str(&format!("{word:<9} {}\n", number::count(count as u64)));
        }
    }
    text.push_str(&format!("{:<9} {}\n", "of", number::count(status.tasks as u64)));
    for worker in &status.workers {
        let tasks: usize = worker.tasks.iter().map(|[from, to]| to - from).sum();
        let job = worker.job.as_ref().map_or_else(String::new, |job| format!(", job {job}"));
        text.push_str(&format!("worker    {}{job}: {} of {tasks}\n", worker.worker, worker.done));
    }
    match queued {
        Ok(0) => {}
        Ok(count) => text.push_str(&format!("queued    {} shards\n", number::count(count as u64))),
        Err(fault) => text.push_str(&format!("queued    not known: {fault}\n")),
    }
    if !status.is_whole() {
        text.push_str(&format!("left      about {}\n", number::seconds(status.seconds_left)));
    }
    print(&text)
}
