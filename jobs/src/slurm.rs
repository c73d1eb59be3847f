//! Submission to Slurm: one job array over the shards with unfinished tasks.
//!
//! Slurm only starts workers. A task is finished when its result is stored; accounting data of Slurm are not used. If
//! `squeue` does not answer, the submission fails, because the queue is unknown.

use crate::fault::Fault;
use crate::lease;
use crate::plan::Plan;
use crate::shard::{self, MOST};
use grainbench_store::results::FinishedTasks;
use grainbench_store::{WriteError, write_file};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Directory of job scripts, job output and the list of submissions.
const FOLDER: &str = "slurm";
/// File with one submission per line.
const JOBS: &str = "jobs.jsonl";
/// Options of `sbatch` that users may not set, because they would change the job array.
const OURS: [&str; 4] = ["--array", "-a", "--wrap", "--output"];

/// A submitted job array.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Job {
    /// Job number of the array.
    pub job: u64,
    /// Number of shards into which the plan is divided. Only those in `indexes` were submitted.
    #[serde(alias = "chunks")]
    pub shards: u32,
    /// Numbers of the submitted shards as ranges, such as `1-4,7`.
    pub indexes: String,
}

/// Submits the shards with unfinished tasks; returns `None` if there are none. `program` is the path of this program on
/// the nodes, and `options` are given to `sbatch`. If `again` is true, the plan may have been submitted before.
///
/// # Errors
/// When Slurm does not answer or rejects the job, when an option would change the job array, or when the plan was
/// submitted before and `again` is not set.
pub fn submit(plan: &Plan, program: &Path, options: &[String], again: bool) -> Result<Option<Job>, Fault> {
    if let Some(option) = options.iter().find(|option| OURS.iter().any(|ours| is_option(option, ours))) {
        return Err(Fault::expected("options for sbatch", "an environment without shards", format!("`{option}`")));
    }
    let before = jobs(&plan.path)?;
    if !again && !before.is_empty() {
        let found =
            format!("earlier job {}", before.iter().map(|job| job.job.to_string()).collect::<Vec<_>>().join(", "));
        return Err(Fault::in_file(&plan.path, "a plan that was not submitted yet, or `--resubmit`", found));
    }
    let most = most_in_array()?;
    let shards = before.last().map_or(plan.head.shards.min(most), |job| job.shards);
    let queued = queued()?;
    let open = left(plan, shards, &before, &queued)?;
    if open.is_empty() {
        return Ok(None);
    }
    let folder = plan.path.join(FOLDER);
    fs::create_dir_all(&folder).map_err(|source| WriteError::new(&folder, source))?;
    let indexes = ranges(&open);
    let script = folder.join(format!("submit-{}.sh", before.len() + 1));
    write_file(&script, text(plan, program, shards, &indexes))?;
    let mut command = Command::new("sbatch");
    let output = fs::canonicalize(&folder).unwrap_or(folder.clone()).join("%A_%a.out");
    command.arg("--parsable").arg(format!("--output={}", output.display())).args(options).arg(&script);
    let answer = ask(&mut command)?;
    // The answer is `JOB` or `JOB;CLUSTER`.
    let number = answer.trim().split(';').next().and_then(|number| number.parse().ok());
    let job = number
        .ok_or_else(|| Fault::Batch(format!("sbatch: expected the number of a job, found `{}`", answer.trim())))?;
    let job = Job { job, shards, indexes };
    let path = folder.join(JOBS);
    let line = serde_json::to_string(&job).map_err(|error| Fault::Input(error.to_string()))? + "\n";
    let added =
        OpenOptions::new().create(true).append(true).open(&path).and_then(|mut file| file.write_all(line.as_bytes()));
    added.map_err(|source| WriteError::new(path, source))?;
    Ok(Some(job))
}

/// Reads the submissions of a plan.
///
/// # Errors
/// When the file of submissions cannot be read.
fn jobs(plan: &Path) -> Result<Vec<Job>, Fault> {
    let path = plan.join(FOLDER).join(JOBS);
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => return Err(Fault::in_file(&path, "a file that can be read", error)),
    };
    let read = |(at, line): (usize, &str)| {
        let job: Result<Job, _> = serde_json::from_str(line);
        let job = job.ok().filter(|job| (1..=MOST).contains(&job.shards));
        job.ok_or_else(|| Fault::in_line(&path, at, "a submission record of this program", "other text"))
    };
    text.lines().enumerate().map(read).collect()
}

/// Returns the number of array elements of a plan that are queued or running.
///
/// # Errors
/// When `squeue` does not answer, because then the number is unknown.
pub fn in_queue(plan: &Path) -> Result<usize, Fault> {
    let jobs = jobs(plan)?;
    if jobs.is_empty() {
        return Ok(0);
    }
    let queued = queued()?;
    Ok(jobs.iter().filter_map(|job| queued.get(&job.job)).map(BTreeSet::len).sum())
}

/// Returns the numbers of the shards that are not queued and have a task that is neither finished nor leased.
fn left(plan: &Plan, shards: u32, jobs: &[Job], queued: &BTreeMap<u64, BTreeSet<u32>>) -> Result<Vec<u32>, Fault> {
    let finished = FinishedTasks::read(&plan.path, false).map_err(Fault::Input)?;
    let is_queued = |index: u32| {
        jobs.iter()
            .any(|job| job.shards == shards && queued.get(&job.job).is_some_and(|of_job| of_job.contains(&index)))
    };
    // A worker whose job is not in the queue has ended, although its lease may not have expired yet.
    let is_there = |name: &str| {
        let parts = name.split_once('_').and_then(|(job, index)| Some((job.parse().ok()?, index.parse().ok()?)));
        parts.is_some_and(|(job, index): (u64, u32)| queued.get(&job).is_some_and(|of_job| of_job.contains(&index)))
    };
    let mut held = lease::held(&plan.path, plan.head.lease_seconds)?;
    held.retain(|holder| holder.job.as_deref().is_none_or(is_there));
    let mut open = Vec::new();
    for (index, range) in (1..).zip(shard::all(&plan.tasks, shards)) {
        let is_open = |place: usize| {
            !finished.entries.contains_key(&plan.tasks[place].id) && !held.iter().any(|holder| holder.has(place))
        };
        if !is_queued(index) && range.into_iter().any(is_open) {
            open.push(index);
        }
    }
    Ok(open)
}

/// Returns the script of a job array.
fn text(plan: &Plan, program: &Path, shards: u32, indexes: &str) -> String {
    let place = fs::canonicalize(&plan.path).unwrap_or_else(|_| plan.path.clone());
    let name = place.file_name().map_or_else(|| "plan".to_owned(), |name| name.to_string_lossy().into_owned());
    // An option in a job script ends at a space, so the job name must not contain one.
    let name: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '-' }).collect();
    let [program, plan_path] = [program, &place].map(quoted);
    // Timed runs need an exclusive node.
    let (alone, jobs) =
        if plan.head.timed { ("#SBATCH --exclusive\n", "1") } else { ("", "\"${SLURM_CPUS_PER_TASK:-1}\"") };
    format!(
        "#!/bin/sh\n#SBATCH --job-name=grainbench-{name}\n#SBATCH --array={indexes}\n#SBATCH --ntasks=1\n{alone}\
         exec {program} run --resume {plan_path} --shard \"$SLURM_ARRAY_TASK_ID/{shards}\" --jobs {jobs}\n"
    )
}

/// Quotes a path for the shell.
fn quoted(path: &Path) -> String {
    format!("'{}'", path.display().to_string().replace('\'', "'\\''"))
}

/// Formats increasing numbers as ranges, such as `1-4,7`.
fn ranges(numbers: &[u32]) -> String {
    let range_text = |run: &[u32]| match run {
        [one] => one.to_string(),
        [first, .., last] => format!("{first}-{last}"),
        [] => String::new(),
    };
    numbers.chunk_by(|a, b| a + 1 == *b).map(range_text).collect::<Vec<_>>().join(",")
}

/// Returns the largest index of a job array at this site, at most [`MOST`]. Indices must be below `MaxArraySize`.
fn most_in_array() -> Result<u32, Fault> {
    let answer = ask(Command::new("scontrol").args(["show", "config"]))?;
    let size = answer.lines().find_map(|line| {
        let (key, value) = line.split_once('=')?;
        if key.trim() == "MaxArraySize" { value.trim().parse::<u32>().ok() } else { None }
    });
    match size {
        Some(0 | 1) => {
            Err(Fault::Batch("scontrol: expected MaxArraySize above 1, found a site without job arrays".to_owned()))
        }
        Some(size) => Ok((size - 1).min(MOST)),
        None => Err(Fault::Batch("scontrol: expected MaxArraySize among the settings, found none".to_owned())),
    }
}

/// Returns the indices of this user's array elements that are queued or running, by job number.
fn queued() -> Result<BTreeMap<u64, BTreeSet<u32>>, Fault> {
    let answer = ask(Command::new("squeue").args(["--noheader", "--array", "--me", "--format=%F %K"]))?;
    let mut found: BTreeMap<u64, BTreeSet<u32>> = BTreeMap::new();
    for line in answer.lines() {
        let parts =
            line.trim().split_once(' ').and_then(|(job, index)| Some((job.parse().ok()?, index.trim().parse().ok()?)));
        if let Some((job, index)) = parts {
            found.entry(job).or_default().insert(index);
        }
    }
    Ok(found)
}

/// Runs a Slurm command and returns its output.
fn ask(command: &mut Command) -> Result<String, Fault> {
    let name = PathBuf::from(command.get_program()).display().to_string();
    let output = command
        .output()
        .map_err(|error| Fault::Batch(format!("{name}: expected a program of Slurm, found {error}")))?;
    if !output.status.success() {
        let message = String::from_utf8_lossy(&output.stderr).split_whitespace().collect::<Vec<_>>().join(" ");
        return Err(Fault::Batch(format!("{name} failed ({}): {message}", output.status)));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

fn is_option(given: &str, ours: &str) -> bool {
    given.strip_prefix(ours).is_some_and(|rest| rest.is_empty() || rest.starts_with('=') || !ours.starts_with("--"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_ranges() {
        assert_eq!(ranges(&[1, 2, 3, 5, 8, 9]), "1-3,5,8-9");
        assert_eq!(ranges(&[7]), "7");
    }

    #[test]
    fn options_that_change_the_array_are_known() {
        for (given, is_ours) in
            [("--array=1-3", true), ("-a1", true), ("--array", true), ("--account=x", false), ("--arrays", false)]
        {
            assert_eq!(OURS.iter().any(|ours| is_option(given, ours)), is_ours, "{given}");
        }
    }
}
