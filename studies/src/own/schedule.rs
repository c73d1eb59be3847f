//! Choice of the next run of a cost study within a time budget.

/// Number of levels that each solver gets before any solver gets a further level.
const FEWEST: usize = 3;
/// Refinement of a usual level, and of the last level if a usual one would take too long.
const FACTORS: [f64; 2] = [2.0, 1.5];
/// Shortest run (s) from which the growth of the run time is measured. Start-up dominates shorter runs.
const MEASURABLE: f64 = 0.02;
/// Smallest and largest growth exponent that is believed, relative to the nominal exponent.
const BELIEVED: [f64; 2] = [0.6, 1.25];

/// Finished levels of one solver.
#[derive(Clone, Debug, Default)]
pub struct Finished {
    /// Fineness and time (s) of each level, from coarse to fine.
    pub levels: Vec<(f64, f64)>,
    /// Nominal exponent of the time: time ∝ finenessⁿ.
    pub exponent: f64,
    /// True if no further level is possible or useful.
    pub closed: bool,
    /// Finenesses to which the solver is limited, in increasing order; empty if there is no limit.
    pub listed: Vec<f64>,
}

impl Finished {
    /// Returns the time of all levels (s).
    #[must_use]
    fn spent(&self) -> f64 {
        self.levels.iter().map(|(_, seconds)| seconds).sum()
    }

    /// Returns the fineness of the level that refines the finest one by a factor; none if the solver has no such level.
    fn next(&self, factor: f64) -> Option<f64> {
        let last = self.levels.last().map(|(fineness, _)| *fineness);
        if !self.listed.is_empty() {
            return self.listed.iter().copied().find(|fineness| last.is_none_or(|last| *fineness > last));
        }
        last.map_or(Some(1.0), |last| Some(last * factor))
    }

    /// Returns the expected time of a level (s); zero if no level is finished.
    #[must_use]
    fn expected(&self, fineness: f64) -> f64 {
        let Some(&(last, seconds)) = self.levels.last() else { return 0.0 };
        let measured = match self.levels[..] {
            [.., (before, short), _] if short >= MEASURABLE => (seconds / short).ln() / (last / before).ln(),
            _ => self.exponent,
        };
        let [least, most] = BELIEVED.map(|factor| factor * self.exponent);
        seconds * (fineness / last).powf(measured.clamp(least, most))
    }
}

/// Returns the index of the solver that runs next, and the fineness of its run. Returns none if no run fits into the time
/// that remains (s).
///
/// A solver with fewer than three levels comes first, then the solver that has used the least time. A level refines by a
/// factor of 2. If no such level fits, one level per solver refines by a factor of 1.5.
#[must_use]
pub fn next(solvers: &[Finished], remaining: f64) -> Option<(usize, f64)> {
    for factor in FACTORS {
        let fits = |(at, solver): (usize, &Finished)| {
            let fineness = solver.next(factor).filter(|_| !solver.closed)?;
            (solver.expected(fineness) <= remaining).then_some((at, fineness))
        };
        let rank = |at: usize| {
            let solver = &solvers[at];
            (solver.levels.len().min(FEWEST), solver.spent())
        };
        let found = solvers.iter().enumerate().filter_map(fits).min_by(|a, b| {
            let ((levels, spent), (other_levels, other)) = (rank(a.0), rank(b.0));
            levels.cmp(&other_levels).then(spent.total_cmp(&other))
        });
        if found.is_some() {
            return found;
        }
    }
    None
}

/// Returns the index of the level to time again: the one with the fewest repetitions whose time (s) fits into the time that
/// remains (s), and among these the longest. `levels` has the time and the number of repetitions of each level.
#[must_use]
pub fn again(levels: &[(f64, usize)], remaining: f64, most: usize) -> Option<usize> {
    let fits = |at: &usize| levels[*at].0 <= remaining && levels[*at].1 < most;
    (0..levels.len())
        .filter(fits)
        .min_by(|&a, &b| levels[a].1.cmp(&levels[b].1).then(levels[b].0.total_cmp(&levels[a].0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the time (s) of a study with solvers of the given time of the first level (s) and growth exponent.
    fn study(budget: f64, solvers: &[(f64, f64)]) -> (f64, Vec<Finished>) {
        let mut finished: Vec<Finished> =
            solvers.iter().map(|&(_, exponent)| Finished { exponent, ..Finished::default() }).collect();
        let mut spent = 0.0;
        while let Some((at, fineness)) = next(&finished, budget - spent) {
            let seconds = solvers[at].0 * fineness.powf(solvers[at].1);
            spent += seconds;
            finished[at].levels.push((fineness, seconds));
            if fineness.log2().fract() != 0.0 {
                finished[at].closed = true;
            }
        }
        let mut levels: Vec<(f64, usize)> =
            finished.iter().flat_map(|solver| &solver.levels).map(|(_, seconds)| (*seconds, 1)).collect();
        while let Some(at) = again(&levels, budget - spent, 9) {
            spent += levels[at].0;
            levels[at].1 += 1;
        }
        (spent, finished)
    }

    #[test]
    fn a_study_ends_within_its_budget() {
        for budget in [1.0, 10.0, 60.0, 600.0] {
            for solvers in [&[(1e-4, 1.0)][..], &[(1e-3, 1.0), (0.02, 3.0)], &[(0.3, 1.0), (1e-3, 1.0), (0.01, 4.0)]] {
                let (spent, finished) = study(budget, solvers);
                assert!((0.8 * budget..=1.2 * budget).contains(&spent), "{spent} of {budget} s: {finished:?}");
                let fewest = if budget < 10.0 { 1 } else { 2 };
                assert!(finished.iter().all(|solver| solver.levels.len() >= fewest), "{finished:?}");
            }
        }
    }

    /// A solver that takes much longer does not take the time of the other one.
    #[test]
    fn solvers_share_the_time() {
        let (_, finished) = study(60.0, &[(1e-3, 1.0), (0.05, 3.0)]);
        let [fast, slow] = [&finished[0], &finished[1]].map(Finished::spent);
        assert!(fast / slow > 0.1 && slow / fast > 0.1, "{fast} s and {slow} s");
    }

    #[test]
    fn a_level_that_does_not_fit_is_not_chosen() {
        let solver = Finished { levels: vec![(1.0, 1.0)], exponent: 3.0, ..Finished::default() };
        assert_eq!(next(std::slice::from_ref(&solver), 100.0), Some((0, 2.0)));
        assert_eq!(next(std::slice::from_ref(&solver), 5.0), Some((0, 1.5)));
        assert_eq!(next(std::slice::from_ref(&solver), 2.0), None);
        assert_eq!(next(&[Finished { closed: true, ..solver }], 100.0), None);
        let listed = Finished { listed: vec![1.0, 3.0], exponent: 1.0, ..Finished::default() };
        assert_eq!(next(std::slice::from_ref(&listed), 1.0), Some((0, 1.0)));
        let twice = Finished { levels: vec![(1.0, 0.1), (3.0, 0.3)], ..listed };
        assert_eq!(next(&[twice], 10.0), None);
    }
}
