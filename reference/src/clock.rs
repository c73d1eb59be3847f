//! Times of the steps of a run. The time step may differ between the `run` commands of a log.

use crate::read::log::{Log, LoggedRun};

/// Relative difference below which two time steps are equal.
const ONE_STEP: f64 = 1e-6;

/// Time step (s), and the number of the first step at which it applies.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Part {
    from: u64,
    time_step: f64,
}

/// Time steps of a run (s), in the order of the steps.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Clock(Vec<Part>);

impl Clock {
    /// Returns the clock of a run with one time step (s).
    pub(crate) fn constant(time_step: f64) -> Self {
        Self(vec![Part { from: 0, time_step }])
    }

    /// Reads the time steps of all runs in a log. Returns `None` if the time step of a run is unknown.
    pub(crate) fn of_log(log: &Log) -> Option<Self> {
        let mut parts: Vec<Part> = Vec::new();
        for run in &log.runs {
            let first = run.thermo.column("Step").and_then(|step| run.thermo.values(step).next());
            let Some(from) = first.filter(|first| *first >= 0.0).map(|first| first as u64) else { continue };
            let next = of_run(run, from)?;
            // A run that begins at an earlier step has reset the step counter. Its steps replace the steps with the
            // same numbers.
            parts.retain(|part| part.from < from);
            parts.extend(next);
        }
        parts.dedup_by(|next, before| next.time_step.total_cmp(&before.time_step).is_eq());
        (!parts.is_empty()).then_some(Self(parts))
    }

    /// Returns the time steps of a run from the steps and times (s) of its samples, in their order. Returns `None` if
    /// the steps do not increase, or if the time decreases or stays the same between two steps.
    pub(crate) fn of_samples(samples: &[(u64, f64)]) -> Option<Self> {
        let ends = samples.first().zip(samples.last()).filter(|(first, last)| last.0 > first.0)?;
        let mean = (ends.1.1 - ends.0.1) / (ends.1.0 - ends.0.0) as f64;
        let mut parts = Vec::new();
        for pair in samples.windows(2).filter(|pair| pair[1].0 > pair[0].0) {
            let time_step = rounded((pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0) as f64);
            parts.push(Part { from: pair[0].0, time_step });
        }
        // Times are printed with few digits. Time steps that agree within a thousandth of their mean count as equal.
        parts.dedup_by(|next, before| next.time_step.total_cmp(&before.time_step).is_eq());
        if parts.iter().all(|part| (part.time_step - mean).abs() <= 1e-3 * mean) {
            parts = vec![Part { from: 0, time_step: mean }];
        }
        parts.iter().all(|part| part.time_step > 0.0).then_some(Self(parts))
    }

    /// Returns the time between the steps `first` and `last` (s).
    pub(crate) fn between(&self, first: u64, last: u64) -> f64 {
        let parts = self.parts(first, last);
        parts.map(|(steps, time_step)| steps as f64 * time_step).sum()
    }

    /// Returns the shortest and the longest time step that occur between the steps `first` and `last` (s).
    pub(crate) fn range(&self, first: u64, last: u64) -> [f64; 2] {
        let steps = self.parts(first, last).filter(|(steps, _)| *steps > 0).map(|(_, time_step)| time_step);
        let [shortest, longest] =
            steps.fold([f64::INFINITY, 0.0], |[low, high]: [f64; 2], step| [low.min(step), high.max(step)]);
        let first = self.0.first().map_or(f64::NAN, |part| part.time_step);
        if longest > 0.0 { [shortest, longest] } else { [first; 2] }
    }

    /// Returns true if all time steps between the steps `first` and `last` equal `time_step` (s) within the relative
    /// `tolerance`.
    pub(crate) fn is_constant(&self, time_step: f64, first: u64, last: u64, tolerance: f64) -> bool {
        let tolerance = tolerance.max(ONE_STEP) * time_step;
        self.range(first, last).into_iter().all(|step| (step - time_step).abs() <= tolerance)
    }

    /// Returns, for each interval of constant time step, the number of its steps between `first` and `last`, and the
    /// time step (s). The first interval extends back to step 0.
    fn parts(&self, first: u64, last: u64) -> impl Iterator<Item = (u64, f64)> {
        self.0.iter().enumerate().map(move |(at, part)| {
            let from = if at == 0 { 0 } else { part.from };
            let until = self.0.get(at + 1).map_or(u64::MAX, |next| next.from);
            (last.min(until).saturating_sub(first.max(from)), part.time_step)
        })
    }
}

/// Rounds a time step to ten digits. It is a difference of printed times, so its other digits are rounding errors.
fn rounded(time_step: f64) -> f64 {
    format!("{time_step:.9e}").parse().unwrap_or(time_step)
}

/// Returns the time steps of one `run` command: from the column `Time` if it shows changes, otherwise from the
/// preceding `timestep` command, the column `Dt`, or the column `Time`, in this order. `from` is the first step of the
/// run.
fn of_run(run: &LoggedRun, from: u64) -> Option<Vec<Part>> {
    let thermo = &run.thermo;
    let column = |name: &str| -> Option<Vec<f64>> { Some(thermo.values(thermo.column(name)?).collect()) };
    let is_step = |step: &f64| step.is_finite() && *step > 0.0;
    let samples: Option<Vec<(u64, f64)>> = column("Step")
        .zip(column("Time"))
        .map(|(steps, times)| steps.into_iter().zip(times).map(|(step, time)| (step as u64, time)).collect());
    let timed = samples.as_deref().and_then(Clock::of_samples).map(|clock| clock.0);
    let last_dt = || column("Dt").and_then(|steps| steps.last().copied()).filter(is_step);
    match timed {
        // Only the column `Time` shows changes of the time step during a run.
        Some(timed) if timed.len() > 1 => Some(timed),
        timed => {
            let of_times = || Some(timed?.first()?.time_step);
            let time_step = run.time_step.filter(is_step).or_else(last_dt).or_else(of_times)?;
            Some(vec![Part { from, time_step }])
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::log::parse_log;

    fn clock(text: &str) -> Clock {
        Clock::of_log(&parse_log(text.as_bytes(), "log").unwrap()).unwrap()
    }

    #[test]
    fn each_run_has_its_own_time_step() {
        let two = "timestep 1e-5\nStep KinEng\n0 0\n4000 0\nLoop time of 1 on 1 procs for 4000 steps with 1 atoms\n\
                   timestep 2e-5\nStep KinEng\n4000 0\n7000 0\nLoop time of 1 on 1 procs for 3000 steps with 1 atoms\n";
        let clock = clock(two);
        assert!((clock.between(0, 4000) - 0.04).abs() < 1e-15);
        assert!((clock.between(0, 7000) - 0.1).abs() < 1e-15);
        assert!((clock.between(3000, 5000) - 0.03).abs() < 1e-15);
        assert_eq!(clock.range(0, 7000), [1e-5, 2e-5]);
        assert_eq!(clock.range(4000, 7000), [2e-5, 2e-5]);
    }

    /// The column `Time` is enough to determine the time step and its changes.
    #[test]
    fn times_of_the_log_tell_the_time_step() {
        let changing = clock("Step Time\n0 0\n100 0.1\n200 0.3\n");
        assert_eq!(changing.range(0, 200), [0.001, 0.2 / 100.0]);
        // The second run resets the step counter, so the first run does not count.
        let set_back = clock(
            "timestep 1\nStep KinEng\n0 0\n900 0\nLoop time of 1 on 1 procs for 9 steps with 1 atoms\n\
                              timestep 2\nStep KinEng\n0 0\n100 0\n",
        );
        assert_eq!(set_back.range(0, 900), [2.0, 2.0]);
    }
}
