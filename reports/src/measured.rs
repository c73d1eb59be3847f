//! Summaries of stored studies of cost, stability and effects, for the first screen of a page.

use crate::distinct;
use crate::section::Provenance;
use crate::study::Study;
use crate::study::cost::{self, TARGETS, time};
use crate::study::effects::Entry;
use crate::study::point::{Diagram, Point, PointStatus};
use crate::study::stability::{HardCaseResult, Hardness, Limit};
use grainbench_harness::statistics::range;
use serde::{Deserialize, Serialize};

/// Index in [`TARGETS`] of the error for which the first screen shows costs.
pub const AT: usize = 1;

/// Stored measurements.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measurements {
    /// Computing cost of accuracy.
    pub cost: Option<Costs>,
    /// Largest stable time steps and hard cases of each solver.
    pub stability: Option<Stability>,
    /// Influence of physical effects on the results.
    pub effects: Option<Effects>,
}

/// Provenance of a measurement, and the solvers that have changed since.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stamp {
    /// Version, date and machine.
    pub provenance: Provenance,
    /// Solvers whose sources have changed since the measurement, or are not known to be unchanged.
    pub changed: Vec<String>,
}

/// Computing cost of accuracy over all cases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Costs {
    /// Provenance of the measurement.
    pub stamp: Stamp,
    /// Number of target quantities with an exact solution.
    pub quantities: usize,
    /// One entry per solver, our solvers first.
    pub lines: Vec<Line>,
    /// Example for the first screen: the first quantity among those for which the most solvers reach an error of 1 %.
    pub example: Option<Diagram>,
}

/// Computing cost of accuracy of one solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Name of the solver, such as `dem`.
    pub solver: String,
    /// Number of quantities that were run with the solver.
    pub asked: usize,
    /// Pareto fronts of all quantities: time divided by the time of the cheapest solver at an error of 1 %, and error.
    pub points: Vec<(f64, f64)>,
    /// Cost for each error in [`TARGETS`]; none if the solver reaches it for no quantity.
    pub factors: [Option<Factor>; 3],
}

/// Cost of an error with one solver, over the quantities for which the solver reaches the error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Factor {
    /// Geometric mean of the solver's time divided by the time of the cheapest solver at the same error. It covers the
    /// quantities for which another solver also reaches the error; 1 if there are none.
    pub times: f64,
    /// Number of quantities in the mean `times`.
    #[serde(default)]
    pub compared: usize,
    /// Geometric mean of the solver's time divided by the time of the cheapest solver at an error of 1 %. It covers the
    /// quantities for which another solver also reaches 1 %; none if there are none.
    pub place: Option<f64>,
    /// Shortest and longest time over the quantities (s).
    pub seconds: [f64; 2],
    /// Number of quantities for which the solver reaches the error.
    pub reached: usize,
    /// Geometric mean of the solver's time divided by the time of `dem`, and number of quantities that both reach.
    pub over_dem: Option<(f64, usize)>,
}

/// Stability by solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stability {
    /// Provenance of the measurement.
    pub stamp: Stamp,
    /// One entry per solver.
    pub lines: Vec<Hold>,
    /// Largest stable time steps.
    #[serde(default)]
    pub limits: Vec<Limit>,
    /// Results of the hard cases.
    #[serde(default)]
    pub hard: Vec<HardCaseResult>,
}

/// Effects that the scenes of the cases contain.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Effects {
    /// Provenance of the measurement.
    pub stamp: Stamp,
    /// One entry per scene and per effect that the scene contains.
    pub ledger: Vec<Entry>,
}

/// Stability of one solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hold {
    /// Name of the solver, such as `dem`.
    pub solver: String,
    /// Smallest and largest ratio of the largest stable time step to the exact limit, and number of assemblies.
    pub limit: Option<([f64; 2], usize)>,
    /// Smallest and largest value of the largest stable time step of assemblies without exact limit, and its unit.
    pub found: Option<([f64; 2], String)>,
    /// Number of hard cases in which the required property holds at the default time step.
    pub holds: usize,
    /// Number of hard cases in which the required property holds only at a smaller time step.
    pub smaller: usize,
    /// Number of hard cases that end with an error message.
    pub typed: usize,
    /// Number of hard cases that end with a wrong result and no error.
    pub wrong: usize,
}

impl Hold {
    /// Returns the number of hard cases that the solver can represent.
    pub(crate) const fn asked(&self) -> usize {
        self.holds + self.smaller + self.typed + self.wrong
    }
}

impl Stamp {
    /// Returns the provenance of a study. `today` returns the hash of the present sources of a solver.
    fn new(study: &Study, solvers: &[&str], today: &dyn Fn(&str) -> Option<String>) -> Self {
        let is_changed = |solver: &&&str| {
            let then = study.sources.get(**solver);
            then.is_none() || then != today(solver).as_ref()
        };
        let changed = solvers.iter().filter(is_changed).map(|solver| (*solver).to_owned()).collect();
        Self { provenance: study.provenance.clone(), changed }
    }

    /// Returns true if a solver has changed since the measurement, or is not known to be unchanged.
    #[must_use]
    pub fn is_old(&self, solver: &str) -> bool {
        self.changed.iter().any(|changed| changed == solver)
    }
}

fn geometric_mean(values: &[f64]) -> Option<f64> {
    let sum: f64 = values.iter().map(|value| value.ln()).sum();
    (!values.is_empty()).then(|| (sum / values.len() as f64).exp())
}

/// Returns the smallest and the largest value; none for an empty list.
fn ends(values: &[f64]) -> Option<[f64; 2]> {
    range(values).map(|[low, _, high]| [low, high])
}

fn cheapest(diagram: &Diagram, lines: &[&str], target: f64) -> Option<f64> {
    lines.iter().filter_map(|line| time(diagram, line, target)).reduce(f64::min)
}

impl Costs {
    /// Summarises a stored study. `today` returns the hash of the present sources of a solver.
    #[must_use]
    pub fn from_study(study: &Study, today: &dyn Fn(&str) -> Option<String>) -> Self {
        let mut names = cost::lines(&study.diagrams);
        names.retain(|name| study.diagrams.iter().any(|diagram| cost::of_line(diagram, name).next().is_some()));
        let is_run = |point: &Point| matches!(point.standing, PointStatus::Measured | PointStatus::Failed);
        let lines = names.iter().map(|name| Line {
            solver: (*name).to_owned(),
            asked: study.diagrams.iter().filter(|diagram| cost::of_line(diagram, name).any(is_run)).count(),
            points: study.diagrams.iter().flat_map(|diagram| places(diagram, name, &names)).collect(),
            factors: TARGETS.map(|target| factor(study, name, &names, target)),
        });
        let count = |diagram: &&Diagram| names.iter().filter(|name| time(diagram, name, TARGETS[AT]).is_some()).count();
        // The last maximum of the reversed list is the first maximum of the list.
        let example = study.diagrams.iter().rev().max_by_key(count).cloned();
        let stamp = Stamp::new(study, &names, today);
        Self { stamp, quantities: study.diagrams.len(), lines: lines.collect(), example }
    }

    /// Adds further solvers of another study. Their costs are relative to the cheapest solver of their own study.
    pub fn add(&mut self, other: Self) {
        let is_new = |line: &Line| self.lines.iter().all(|known| known.solver != line.solver);
        let new: Vec<Line> = other.lines.into_iter().filter(is_new).collect();
        let is_added = |solver: &&String| new.iter().any(|line| line.solver == **solver);
        self.stamp.changed.extend(other.stamp.changed.iter().filter(is_added).cloned());
        self.lines.extend(new);
    }
}

/// Returns the Pareto front of a solver. Times are divided by the time of the cheapest solver at 1 %.
fn places(diagram: &Diagram, line: &str, lines: &[&str]) -> Vec<(f64, f64)> {
    let Some(unit) = cheapest(diagram, lines, TARGETS[AT]) else { return Vec::new() };
    let front = cost::front(cost::of_line(diagram, line));
    front.iter().filter_map(|point| point.place()).map(|(error, time)| (time / unit, error)).collect()
}

fn factor(study: &Study, line: &str, lines: &[&str], target: f64) -> Option<Factor> {
    let reached = || study.diagrams.iter().filter_map(|diagram| Some((diagram, time(diagram, line, target)?)));
    // A solver without a competitor is always the cheapest, so its ratio would say nothing about its cost.
    let competes = |diagram: &Diagram, target: f64| {
        lines.iter().any(|other| *other != line && time(diagram, other, target).is_some())
    };
    let over = |target: f64| -> Vec<f64> {
        let compared = reached().filter(|(diagram, _)| competes(diagram, target));
        compared.filter_map(|(diagram, time)| Some(time / cheapest(diagram, lines, target)?)).collect()
    };
    let over_dem: Vec<f64> =
        reached().filter_map(|(diagram, mine)| Some(mine / time(diagram, "dem", target)?)).collect();
    let seconds: Vec<f64> = reached().map(|(_, time)| time).collect();
    let times = over(target);
    Some(Factor {
        times: geometric_mean(&times).unwrap_or(1.0),
        compared: times.len(),
        place: geometric_mean(&over(TARGETS[AT])),
        seconds: ends(&seconds)?,
        reached: seconds.len(),
        over_dem: geometric_mean(&over_dem).filter(|_| line != "dem").map(|mean| (mean, over_dem.len())),
    })
}

impl Stability {
    /// Summarises a stored study. `today` returns the hash of the present sources of a solver.
    #[must_use]
    pub fn from_study(study: &Study, today: &dyn Fn(&str) -> Option<String>) -> Self {
        let limits = study.limits.iter().map(|row| row.solver.as_str());
        let names = distinct(limits.chain(study.hard.iter().map(|row| row.solver.as_str())));
        let lines = names.iter().map(|name| hold(study, name)).collect();
        let stamp = Stamp::new(study, &names, today);
        Self { stamp, lines, limits: study.limits.clone(), hard: study.hard.clone() }
    }
}

impl Effects {
    /// Summarises a stored study. `today` returns the hash of the present sources of a solver.
    #[must_use]
    pub fn from_study(study: &Study, today: &dyn Fn(&str) -> Option<String>) -> Self {
        let names: Vec<&str> = study.sources.keys().map(String::as_str).collect();
        let ledger = study.ledger.iter().filter(|entry| entry.on).cloned().collect();
        Self { stamp: Stamp::new(study, &names, today), ledger }
    }
}

fn hold(study: &Study, solver: &str) -> Hold {
    let limits = || study.limits.iter().filter(|row| row.solver == solver);
    let over: Vec<f64> = limits().filter_map(|row| Some(row.found? / row.exact?)).collect();
    let free = || limits().filter(|row| row.exact.is_none() && row.found.is_some());
    let found: Vec<f64> = free().filter_map(|row| row.found).collect();
    let hard = || study.hard.iter().filter(|row| row.solver == solver);
    let count = |standing: Hardness| hard().filter(|row| row.standing == standing).count();
    Hold {
        solver: solver.to_owned(),
        limit: ends(&over).map(|ends| (ends, over.len())),
        found: ends(&found).zip(free().next().map(|row| row.unit.clone())),
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
    use std::collections::BTreeMap;

    #[test]
    fn factors_are_over_the_cheapest_of_the_same_quantity() {
        let study = sample::costs();
        let costs = Costs::from_study(&study, &|_| Some("as then".to_owned()));
        let at = |name: &str| costs.lines.iter().find(|line| line.solver == name).unwrap().factors[AT];
        // `dem` takes 1 ms and 4 ms, `mpm` takes 100 ms and 400 ms, and `rigid` takes 2 ms for the first quantity only.
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

    /// The example of the first screen is the quantity for which the most solvers reach 1 %, here not the last one.
    #[test]
    fn the_example_is_what_most_solvers_reach() {
        let example = Costs::from_study(&sample::costs(), &|_| None).example.unwrap();
        assert_eq!(example.quantity, "velocity");
    }

    #[test]
    fn what_was_measured_of_other_sources_is_old() {
        let study = sample::costs();
        let then = |solver: &str| (solver != "mpm").then(|| "as then".to_owned());
        let costs = Costs::from_study(&study, &then);
        assert!(costs.stamp.is_old("mpm") && !costs.stamp.is_old("dem"));
        // Without a stored hash, the sources count as changed.
        let without = Study { sources: BTreeMap::new(), ..study };
        assert!(Costs::from_study(&without, &then).stamp.is_old("dem"));
    }
}
