//! Shards: ranges of consecutive tasks with about equal expected run times.

use crate::task::Task;
use std::ops::Range;
use std::str::FromStr;

/// Maximum number of shards.
pub const MOST: u32 = 1_000_000;
/// Shortest mean expected duration of the recommended shards (s). A batch system takes about a second to start a shard.
const SECONDS: f64 = 60.0;
/// Shortest assumed duration of a task (s), because each task has some overhead.
const LEAST: f64 = 1e-3;

/// One of the shards into which a plan is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Number of this shard, from 1 to `count`.
    pub index: u32,
    /// Number of all shards.
    pub count: u32,
}

impl Shard {
    /// The whole plan as one shard.
    pub const WHOLE: Self = Self { index: 1, count: 1 };
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let read = |text: &str| text.parse::<u32>().ok().filter(|number| (1..=MOST).contains(number));
        let parts = text.split_once('/').and_then(|(index, count)| Some((read(index)?, read(count)?)));
        match parts {
            Some((index, count)) if index <= count => Ok(Self { index, count }),
            _ => Err(format!("expected i/n, two whole numbers from 1 to {MOST}, the first at most the second")),
        }
    }
}

/// Returns the range of task indices of each of `count` shards, in the order of the shards.
///
/// A shard may be empty. All tasks of a group are in one shard.
#[must_use]
pub fn all(tasks: &[Task], count: u32) -> Vec<Range<usize>> {
    let total: f64 = tasks.iter().map(length).sum();
    let mut ends = vec![0; count as usize];
    let (mut before, mut to) = (0.0, 0);
    for group in tasks.chunk_by(is_one_group) {
        to += group.len();
        let long: f64 = group.iter().map(length).sum();
        // A group belongs to the shard that contains its midpoint.
        let place = ((before + 0.5 * long) / total * f64::from(count)) as usize;
        ends[place.min(count as usize - 1)] = to;
        before += long;
    }
    let mut start = 0;
    ends.into_iter()
        .map(|end| {
            let range = start..end.max(start);
            start = range.end;
            range
        })
        .collect()
}

/// Returns the recommended number of shards: the largest number whose mean expected duration is at least a minute.
/// It is at least 1 and at most the number of groups and ungrouped tasks.
#[must_use]
pub fn count(tasks: &[Task]) -> u32 {
    let total: f64 = tasks.iter().map(length).sum();
    let groups = tasks.chunk_by(is_one_group).count();
    ((total / SECONDS) as u32).clamp(1, MOST).min(u32::try_from(groups).unwrap_or(MOST).max(1))
}

/// Returns true if two tasks belong to the same group.
pub(crate) fn is_one_group(a: &Task, b: &Task) -> bool {
    a.group.is_some() && a.group == b.group
}

fn length(task: &Task) -> f64 {
    task.seconds.max(LEAST)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::task::Id;

    fn tasks(seconds: &[f64], groups: &[Option<u32>]) -> Vec<Task> {
        let task = |(seconds, group): (&f64, &Option<u32>)| Task {
            group: *group,
            ..Task::new(Id::of_words("", &[]), *seconds)
        };
        seconds.iter().zip(groups).map(task).collect()
    }

    #[test]
    fn every_task_is_in_one_shard() {
        let seconds: Vec<f64> = (0..1000).map(|at| if at % 7 == 0 { 40.0 } else { 0.01 * f64::from(at) }).collect();
        let groups: Vec<Option<u32>> = (0..1000).map(|at| (at % 11 > 4).then_some(at / 11)).collect();
        let tasks = tasks(&seconds, &groups);
        for count in [1, 2, 3, 17, 999, 1000, 5000] {
            let shards = all(&tasks, count);
            assert_eq!((shards.len(), shards[0].start, shards[shards.len() - 1].end), (count as usize, 0, 1000));
            assert!(shards.windows(2).all(|pair| pair[0].end == pair[1].start), "{count}");
            for shard in &shards {
                let inner = shard.end == 1000 || shard.end == 0 || groups[shard.end - 1].is_none();
                assert!(inner || groups[shard.end - 1] != groups[shard.end], "{count}: a group is torn");
            }
        }
    }

    #[test]
    fn shards_last_about_as_long() {
        let tasks = tasks(&[1.0; 1200], &[None; 1200]);
        assert_eq!(count(&tasks), 20);
        assert!(all(&tasks, 20).iter().all(|shard| shard.len() == 60));
        assert_eq!((count(&[]), all(&[], 3)), (1, vec![0..0, 0..0, 0..0]));
    }

    #[test]
    fn what_is_no_shard_is_refused() {
        assert_eq!("2/3".parse(), Ok(Shard { index: 2, count: 3 }));
        for text in
            ["", "1", "0/0", "0/3", "5/3", "-1/3", "1/3/5", "a/b", "1/1e9", "1/4294967297", "1 / 2", "1/2000000"]
        {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}
