//! Slurm: a job array over the chunks of a plan that have something left.
//!
//! Slurm starts workers, and whether a task is finished is told by its result alone: nothing hangs on accounting, and a `squeue`
//! that does not answer tells nothing, least of all that nothing is queued.

use crate::chunk::{self, MOST};
use crate::fault::Fault;
use crate::finished::Finished;
use crate::lease;
use crate::plan::Plan;
use grainbench_reports::{WriteError, write_file};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Scripts, what jobs print, and which jobs there were.
pub const FOLDER: &str = "slurm";
/// A line a submission.
const JOBS: &str = "jobs.jsonl";
/// Options that would make another array of it.
const OURS: [&str; 4] = ["--array", "-a", "--wrap", "--output"];

/// A submission.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Job {
    /// Number of the array.
    pub job: u64,
    /// Into how many chunks the plan was divided.
    pub chunks: u32,
    /// Which of them.
    pub indexes: String,
}

/// What is to be submitted.
#[derive(Clone, Debug)]
pub struct Asked<'a> {
    /// The program, as nodes see it.
    pub program: &'a Path,
    /// Whether something was submitted before, of which only the rest is wanted.
    pub again: bool,
    /// Options for `sbatch`.
    pub options: &'a [String],
}

/// Submits the chunks in which something is left; none where nothing is.
///
/// # Errors
/// When Slurm does not answer or refuses.
pub fn submit(plan: &Plan, asked: &Asked<'_>) -> Result<Option<Job>, Fault> {
    if let Some(option) = asked.options.iter().find(|option| OURS.iter().any(|ours| is_option(option, ours))) {
        return Err(Fault::expected(
            "options for sbatch",
            "none that says which chunks there are",
            format!("`{option}`"),
        ));
    }
    let before = jobs(&plan.path)?;
    if !asked.again && !before.is_empty() {
        let found =
            format!("job {} of before", before.iter().map(|job| job.job.to_string()).collect::<Vec<_>>().join(", "));
        return Err(Fault::in_file(&plan.path, "a plan that was not submitted, or `--resubmit`", found));
    }
    let most = most_in_array()?;
    let chunks = before.last().map_or(plan.head.chunks.min(most), |job| job.chunks);
    let queued = queued()?;
    let open = left(plan, chunks, &before, &queued)?;
    if open.is_empty() {
        return Ok(None);
    }
    let folder = plan.path.join(FOLDER);
    fs::create_dir_all(&folder).map_err(|source| WriteError::new(&folder, source))?;
    let indexes = ranges(&open);
    let script = folder.join(format!("submit-{}.sh", before.len() + 1));
    write_file(&script, text(plan, asked.program, chunks, &indexes))?;
    let mut command = Command::new("sbatch");
    let output = fs::canonicalize(&folder).unwrap_or(folder.clone()).join("%A_%a.out");
    command.arg("--parsable").arg(format!("--output={}", output.display())).args(asked.options).arg(&script);
    let answer = ask(&mut command)?;
    // `JOB` or `JOB;CLUSTER`.
    let number = answer.trim().split(';').next().and_then(|number| number.parse().ok());
    let job = number
        .ok_or_else(|| Fault::Batch(format!("sbatch: expected the number of a job, found `{}`", answer.trim())))?;
    let job = Job { job, chunks, indexes };
    let path = folder.join(JOBS);
    let line = serde_json::to_string(&job).map_err(|error| Fault::Input(error.to_string()))? + "\n";
    let added =
        OpenOptions::new().create(true).append(true).open(&path).and_then(|mut file| file.write_all(line.as_bytes()));
    added.map_err(|source| WriteError::new(path, source))?;
    Ok(Some(job))
}

/// The submissions of a plan.
///
/// # Errors
/// When their file cannot be read.
pub fn jobs(plan: &Path) -> Result<Vec<Job>, Fault> {
    let path = plan.join(FOLDER).join(JOBS);
    let text = match fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(error) => return Err(Fault::in_file(&path, "a file that can be read", error)),
    };
    let read = |(at, line): (usize, &str)| {
        let job: Result<Job, _> = serde_json::from_str(line);
        job.ok().filter(|job| (1..=MOST).contains(&job.chunks)).ok_or_else(|| {
            Fault::expected(
                format!("{}:{}", path.display(), at + 1),
                "a submission as this program leaves it",
                "other text",
            )
        })
    };
    text.lines().enumerate().map(read).collect()
}

/// How many elements of the submissions of a plan wait or run.
///
/// # Errors
/// When `squeue` does not answer: then it is not known.
pub fn in_queue(plan: &Path) -> Result<usize, Fault> {
    let jobs = jobs(plan)?;
    if jobs.is_empty() {
        return Ok(0);
    }
    let queued = queued()?;
    Ok(jobs.iter().filter_map(|job| queued.get(&job.job)).map(BTreeSet::len).sum())
}

/// Numbers of the chunks in which a task is neither finished, nor queued, nor somebody's.
fn left(plan: &Plan, chunks: u32, jobs: &[Job], queued: &BTreeMap<u64, BTreeSet<u32>>) -> Result<Vec<u32>, Fault> {
    let finished = Finished::read(&plan.path, false)?;
    let is_queued = |index: u32| {
        jobs.iter()
            .any(|job| job.chunks == chunks && queued.get(&job.job).is_some_and(|of_job| of_job.contains(&index)))
    };
    // A worker whose job is not in the queue is no more, though its lease may not have lapsed yet.
    let is_there = |name: &str| {
        let parts = name.split_once('_').and_then(|(job, index)| Some((job.parse().ok()?, index.parse().ok()?)));
        parts.is_some_and(|(job, index): (u64, u32)| queued.get(&job).is_some_and(|of_job| of_job.contains(&index)))
    };
    let mut held = lease::held(&plan.path, plan.head.lease_seconds)?;
    held.retain(|said| said.job.as_deref().is_none_or(is_there));
    let mut open = Vec::new();
    for (index, range) in (1..).zip(chunk::all(&plan.tasks, chunks)) {
        let is_open = |place: usize| {
            !finished.entries.contains_key(&plan.tasks[place].id) && !held.iter().any(|said| said.has(place))
        };
        if !is_queued(index) && range.into_iter().any(is_open) {
            open.push(index);
        }
    }
    Ok(open)
}

/// The script of a job array.
fn text(plan: &Plan, program: &Path, chunks: u32, indexes: &str) -> String {
    let place = fs::canonicalize(&plan.path).unwrap_or_else(|_| plan.path.clone());
    let name = place.file_name().map_or_else(|| "plan".to_owned(), |name| name.to_string_lossy().into_owned());
    // Options of a script end at a blank.
    let name: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() || "-_.".contains(c) { c } else { '-' }).collect();
    let [program, plan_path] = [program, &place].map(quoted);
    // Times want a node of their own; counts do not.
    let (alone, jobs) =
        if plan.head.timed { ("#SBATCH --exclusive\n", "1") } else { ("", "\"${SLURM_CPUS_PER_TASK:-1}\"") };
    format!(
        "#!/bin/sh\n#SBATCH --job-name=grainbench-{name}\n#SBATCH --array={indexes}\n#SBATCH --ntasks=1\n{alone}\
         exec {program} work {plan_path} --chunk \"$SLURM_ARRAY_TASK_ID/{chunks}\" --jobs {jobs}\n"
    )
}

/// A path as a shell reads it.
fn quoted(path: &Path) -> String {
    format!("'{}'", path.display().to_string().replace('\'', "'\\''"))
}

/// Numbers that rise, as ranges.
fn ranges(numbers: &[u32]) -> String {
    let of = |run: &[u32]| match run {
        [one] => one.to_string(),
        [first, .., last] => format!("{first}-{last}"),
        [] => String::new(),
    };
    numbers.chunk_by(|a, b| a + 1 == *b).map(of).collect::<Vec<_>>().join(",")
}

/// The most that an array may have here: indexes are below `MaxArraySize`.
fn most_in_array() -> Result<u32, Fault> {
    let answer = ask(Command::new("scontrol").args(["show", "config"]))?;
    let size = answer.lines().find_map(|line| {
        let (key, value) = line.split_once('=')?;
        if key.trim() == "MaxArraySize" { value.trim().parse::<u32>().ok() } else { None }
    });
    match size {
        Some(0 | 1) => {
            Err(Fault::Batch("scontrol: expected a MaxArraySize above 1: this site has no job arrays".to_owned()))
        }
        Some(size) => Ok((size - 1).min(MOST)),
        None => Err(Fault::Batch("scontrol: expected MaxArraySize among the settings, found none".to_owned())),
    }
}

/// Elements of arrays of this user that wait or run.
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

/// What a command of Slurm prints.
fn ask(command: &mut Command) -> Result<String, Fault> {
    let name = PathBuf::from(command.get_program()).display().to_string();
    let output = command
        .output()
        .map_err(|error| Fault::Batch(format!("{name}: expected a program of Slurm, found {error}")))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr).split_whitespace().collect::<Vec<_>>().join(" ");
        return Err(Fault::Batch(format!("{name} failed ({}): {said}", output.status)));
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
