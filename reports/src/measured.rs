//! What accuracy costs and what stays stable, solver by solver, as it was measured before and is kept in the tree: what the first
//! screen of a page tells of it.

use crate::report::Provenance;
use crate::study::point::{Diagram, Standing};
use crate::study::stability::Hardness;
use crate::study::{Study, cost};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Errors that costs are told of.
pub const TARGETS: [f64; 3] = cost::TARGETS;

/// Which of the targets the first screen is about.
pub const AT: usize = 1;

/// What was measured before.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// What accuracy costs.
    pub cost: Option<Costs>,
    /// What stays stable.
    pub stability: Option<Stability>,
}

/// When and where something was measured, and which solvers are not what they were then.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stamp {
    /// By what, when and where.
    pub provenance: Provenance,
    /// Solvers whose sources have changed since, or are not known to be the same.
    pub changed: Vec<String>,
}

/// What accuracy costs over all cases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Costs {
    /// When and where.
    pub stamp: Stamp,
    /// Quantities with an exact answer that solvers were asked for.
    pub quantities: usize,
    /// A line a solver, ours first.
    pub lines: Vec<Line>,
}

/// What accuracy costs with one solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// The solver.
    pub solver: String,
    /// Quantities that it has an answer to.
    pub asked: usize,
    /// Settings that no other of its settings beats: time over that of the cheapest solver at a hundredth, and error.
    pub points: Vec<(f64, f64)>,
    /// What each of [`TARGETS`] costs.
    pub factors: [Option<Factor>; 3],
}

/// What an error costs with a solver, over the quantities in which it reaches it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Factor {
    /// Geometric mean of its time over that of the cheapest solver at the same error.
    pub times: f64,
    /// Geometric mean of its time over that of the cheapest solver at a hundredth.
    pub place: f64,
    /// Least and largest time (s).
    pub seconds: [f64; 2],
    /// In how many quantities it reaches it.
    pub reached: usize,
    /// Geometric mean of its time over that of `dem`, and in how many quantities both reach it.
    pub over_dem: Option<(f64, usize)>,
}

/// What stays stable, solver by solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stability {
    /// When and where.
    pub stamp: Stamp,
    /// A line a solver.
    pub lines: Vec<Hold>,
}

/// What stays stable with one solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hold {
    /// The solver.
    pub solver: String,
    /// Largest stable step over the exact limit: least and largest, and of how many assemblies.
    pub limit: Option<([f64; 2], usize)>,
    /// Largest stable step where there is no exact limit: least and largest, and what it is measured by.
    pub found: Option<([f64; 2], String)>,
    /// Hard cases in which what must hold does at the default step.
    pub holds: usize,
    /// Those in which it does at a smaller step.
    pub smaller: usize,
    /// Those that end in an error that says why.
    pub typed: usize,
    /// Those that end as if nothing were wrong.
    pub wrong: usize,
}

impl Hold {
    /// Hard cases that it can express.
    #[must_use]
    pub const fn asked(&self) -> usize {
        self.holds + self.smaller + self.typed + self.wrong
    }
}

impl Stamp {
    /// Of a study, where `today` gives the hash of a solver's sources as they are now.
    fn of(study: &Study, solvers: &[&str], today: &dyn Fn(&str) -> Option<String>) -> Self {
        let is_changed = |solver: &&&str| {
            let then = study.sources.get(**solver);
            then.is_none() || then != today(solver).as_ref()
        };
        let changed = solvers.iter().filter(is_changed).map(|solver| (*solver).to_owned()).collect();
        Self { provenance: study.provenance.clone(), changed }
    }

    /// Whether a solver is no longer what was measured.
    #[must_use]
    pub fn is_old(&self, solver: &str) -> bool {
        self.changed.iter().any(|changed| changed == solver)
    }

    /// The day of the measurement.
    #[must_use]
    pub fn day(&self) -> &str {
        self.provenance.date.split(' ').next().unwrap_or_default()
    }
}

fn geometric_mean(values: &[f64]) -> Option<f64> {
    let sum: f64 = values.iter().map(|value| value.ln()).sum();
    (!values.is_empty()).then(|| (sum / values.len() as f64).exp())
}

fn ends(values: &[f64]) -> [f64; 2] {
    values.iter().fold([f64::INFINITY, 0.0], |[low, high], &value| [low.min(value), high.max(value)])
}

/// Time of the cheapest setting of a line, or of the cheapest of all lines, within an error (s).
fn time(diagram: &Diagram, line: &str, target: f64) -> Option<f64> {
    cost::cheapest(diagram, line, target)?.wall_seconds
}

fn cheapest(diagram: &Diagram, lines: &[&str], target: f64) -> Option<f64> {
    lines.iter().filter_map(|line| time(diagram, line, target)).reduce(f64::min)
}

impl Costs {
    /// From the study that was kept.
    #[must_use]
    pub fn of(study: &Study, today: &dyn Fn(&str) -> Option<String>) -> Self {
        let names = cost::lines(&study.diagrams);
        let is_told = |name: &&&str| study.diagrams.iter().any(|diagram| cost::of_line(diagram, name).next().is_some());
        let names: Vec<&str> = names.iter().filter(is_told).copied().collect();
        let lines = names.iter().map(|name| Line {
            solver: (*name).to_owned(),
            asked: study.diagrams.iter().filter(|diagram| is_asked(diagram, name)).count(),
            points: study.diagrams.iter().flat_map(|diagram| places(diagram, name, &names)).collect(),
            factors: TARGETS.map(|target| factor(study, name, &names, target)),
        });
        Self { stamp: Stamp::of(study, &names, today), quantities: study.diagrams.len(), lines: lines.collect() }
    }
}

impl Costs {
    /// Adds the lines of other solvers from another session, each in units of the cheapest there.
    pub fn add(&mut self, other: Self) {
        let is_new = |line: &Line| self.lines.iter().all(|known| known.solver != line.solver);
        let new: Vec<Line> = other.lines.into_iter().filter(is_new).collect();
        let is_added = |solver: &&String| new.iter().any(|line| line.solver == **solver);
        self.stamp.changed.extend(other.stamp.changed.iter().filter(is_added).cloned());
        self.lines.extend(new);
    }
}

fn is_asked(diagram: &Diagram, line: &str) -> bool {
    cost::of_line(diagram, line).any(|point| matches!(point.standing, Standing::Measured | Standing::Failed))
}

/// The front of a line in a diagram, in units of the cheapest time at a hundredth.
fn places(diagram: &Diagram, line: &str, lines: &[&str]) -> Vec<(f64, f64)> {
    let Some(unit) = cheapest(diagram, lines, TARGETS[AT]) else { return Vec::new() };
    let front = cost::front(cost::of_line(diagram, line));
    front.iter().filter_map(|point| point.place()).map(|(error, time)| (time / unit, error)).collect()
}

fn factor(study: &Study, line: &str, lines: &[&str], target: f64) -> Option<Factor> {
    let reached = || study.diagrams.iter().filter_map(|diagram| Some((diagram, time(diagram, line, target)?)));
    let over = |target: f64| -> Vec<f64> {
        reached().filter_map(|(diagram, time)| Some(time / cheapest(diagram, lines, target)?)).collect()
    };
    let over_dem: Vec<f64> =
        reached().filter_map(|(diagram, mine)| Some(mine / time(diagram, "dem", target)?)).collect();
    let seconds: Vec<f64> = reached().map(|(_, time)| time).collect();
    Some(Factor {
        times: geometric_mean(&over(target))?,
        place: geometric_mean(&over(TARGETS[AT]))?,
        seconds: ends(&seconds),
        reached: seconds.len(),
        over_dem: geometric_mean(&over_dem).filter(|_| line != "dem").map(|mean| (mean, over_dem.len())),
    })
}

impl Stability {
    /// From the study that was kept.
    #[must_use]
    pub fn of(study: &Study, today: &dyn Fn(&str) -> Option<String>) -> Self {
        let mut names: Vec<&str> = Vec::new();
        let told = study.limits.iter().map(|row| &row.solver).chain(study.hard.iter().map(|row| &row.solver));
        for name in told {
            if !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
        let lines = names.iter().map(|name| hold(study, name)).collect();
        Self { stamp: Stamp::of(study, &names, today), lines }
    }
}

fn hold(study: &Study, solver: &str) -> Hold {
    let limits = || study.limits.iter().filter(|row| row.solver == solver);
    let over: Vec<f64> = limits().filter_map(|row| Some(row.found? / row.exact?)).collect();
    let free: Vec<(f64, &str)> =
        limits().filter(|row| row.exact.is_none()).filter_map(|row| Some((row.found?, row.unit.as_str()))).collect();
    let mut counts: BTreeMap<&'static str, usize> = BTreeMap::new();
    for row in study.hard.iter().filter(|row| row.solver == solver) {
        *counts.entry(row.standing.word()).or_default() += 1;
    }
    let count = |standing: Hardness| counts.get(standing.word()).copied().unwrap_or(0);
    Hold {
        solver: solver.to_owned(),
        limit: (!over.is_empty()).then(|| (ends(&over), over.len())),
        found: free
            .first()
            .map(|(_, unit)| (ends(&free.iter().map(|(found, _)| *found).collect::<Vec<_>>()), (*unit).to_owned())),
        holds: count(Hardness::Holds),
        smaller: count(Hardness::HoldsAtASmallerStep),
        typed: count(Hardness::TypedFailure),
        wrong: count(Hardness::QuietlyWrong),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn factors_are_over_the_cheapest_of_the_same_quantity() {
        let study = sample::costs();
        let costs = Costs::of(&study, &|_| Some("as then".to_owned()));
        let at = |name: &str| costs.lines.iter().find(|line| line.solver == name).unwrap().factors[AT];
        // dem takes 1 and 4 ms, rigid 2 ms of the first alone, mpm 100 and 400 ms.
        let (dem, mpm, rigid) = (at("dem").unwrap(), at("mpm").unwrap(), at("rigid").unwrap());
        assert!((dem.times - 1.0).abs() < 1e-12 && dem.reached == 2 && dem.over_dem.is_none());
        assert!(
            (mpm.times - 100.0).abs() < 1e-9
                && mpm.over_dem.is_some_and(|(times, count)| (times - 100.0).abs() < 1e-9 && count == 2)
        );
        assert!((rigid.times - 2.0).abs() < 1e-12 && rigid.reached == 1);
        assert_eq!(mpm.seconds, [0.1, 0.4]);
        let line = costs.lines.iter().find(|line| line.solver == "rigid").unwrap();
        assert!(line.asked == 2 && line.factors[2].is_none());
    }

    #[test]
    fn what_was_measured_of_other_sources_is_old() {
        let study = sample::costs();
        let then = |solver: &str| (solver != "mpm").then(|| "as then".to_owned());
        let costs = Costs::of(&study, &then);
        assert!(costs.stamp.is_old("mpm") && !costs.stamp.is_old("dem"));
        // A hash that was never noted is no proof that nothing changed.
        let without = Study { sources: BTreeMap::new(), ..study };
        assert!(Costs::of(&without, &then).stamp.is_old("dem"));
    }
}
