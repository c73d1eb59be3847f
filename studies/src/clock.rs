//! Processor time. Other running programs disturb it less than wall-clock time.

use std::hint::black_box;
use std::time::Instant;

/// Returns the processor time (s) of this process and of its child processes that have ended.
///
/// If the system does not report processor times, returns the wall-clock time since the first call.
#[must_use]
pub fn cpu_seconds() -> f64 {
    #[cfg(unix)]
    {
        use nix::sys::resource::{UsageWho, getrusage};
        let usage_seconds = |who| {
            getrusage(who).map(|usage| {
                let seconds = |time: nix::sys::time::TimeVal| time.tv_sec() as f64 + 1e-6 * time.tv_usec() as f64;
                seconds(usage.user_time()) + seconds(usage.system_time())
            })
        };
        if let (Ok(own), Ok(children)) =
            (usage_seconds(UsageWho::RUSAGE_SELF), usage_seconds(UsageWho::RUSAGE_CHILDREN))
        {
            return own + children;
        }
    }
    static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// Measures the mean processor time of a fixed reference task (s). The task is repeated for `lasting` seconds, at least
/// once.
///
/// The reference task does not depend on the solvers. Times of two sessions are divided by the reference time before
/// they are compared, so that a slow machine is not mistaken for a slow program.
///
/// The task searches and branches, because other programs slow down such code as much as solvers. If a program runs on the
/// second thread of the core, the code is slowed down by half for some milliseconds. Dependent arithmetic is slowed down by
/// only a tenth. For a thousand pairs of alternating runs of solver and reference task, a line through the logarithms of
/// both times had a slope of 0.99. The ratio of the times varied by 7 %, the times alone by 20 to 30 %.
#[must_use]
fn reference_seconds(lasting: f64) -> f64 {
    let start = cpu_seconds();
    let mut pieces = 0.0;
    loop {
        black_box(searches(black_box(1.0)));
        pieces += 1.0;
        let spent = cpu_seconds() - start;
        if spent >= lasting {
            return spent / pieces;
        }
    }
}

/// Result of a timed task.
#[derive(Clone, Copy, Debug)]
pub struct TimedResult<T> {
    /// Return value of the task.
    pub done: T,
    /// Processor time (s).
    pub cpu: f64,
    /// Wall-clock time (s).
    pub wall: f64,
    /// Mean of the times of the reference task before and after the timed task (s).
    pub reference: f64,
}

/// Times a task between two timings of the reference task, each of `lasting` seconds.
pub fn clocked<T>(lasting: f64, work: impl FnOnce() -> T) -> TimedResult<T> {
    let before = reference_seconds(lasting);
    let (cpu, start) = (cpu_seconds(), Instant::now());
    let done = work();
    let (wall, cpu) = (start.elapsed().as_secs_f64(), cpu_seconds() - cpu);
    TimedResult { done, cpu, wall, reference: 0.5 * (before + reference_seconds(lasting)) }
}

/// Looks up keys in a hash table that is two thirds full and branches on the result, as a solver does for contacts.
///
/// This takes about a tenth of a millisecond.
fn searches(scale: f64) -> f64 {
    const PLACES: usize = 1024;
    const KEYS: usize = 700;
    const PASSES: usize = 40;
    let keys =
        || std::iter::successors(Some(12345_u32), |key| Some(key.wrapping_mul(1_664_525).wrapping_add(1_013_904_223)));
    let home = |key: u32| (key >> 22) as usize;
    let mut table = [None; PLACES];
    for key in keys().take(KEYS) {
        let mut place = home(key);
        while table[place].is_some() {
            place = (place + 1) % PLACES;
        }
        table[place] = Some(key);
    }
    let mut sum = 0.0;
    for key in (0..PASSES).flat_map(|_| keys().take(KEYS)) {
        let mut place = home(key);
        while table[place] != Some(key) {
            place = (place + 1) % PLACES;
        }
        let value = scale * (place % 256) as f64;
        sum += if value > 100.0 { value } else { -0.5 * value };
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_passes_while_the_processor_works() {
        let (before, start) = (cpu_seconds(), Instant::now());
        while start.elapsed().as_secs_f64() < 0.05 {
            black_box(searches(1.0));
        }
        let (after, wall) = (cpu_seconds(), start.elapsed().as_secs_f64());
        assert!(after > before && after - before < 3.0 * wall, "{before} {after}");
        assert!(reference_seconds(0.0) > 1e-6);
    }
}
