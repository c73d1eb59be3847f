//! Cost of a step with 1, 100 and 10,000 grains, without start-up: data, table and figure.

use crate::distinct;
use crate::number;
use crate::page::captioned;
use crate::row;
use crate::table::{Column, Format, Table};
use grainbench_harness::figure::{Axis, Curve, Figure, Stroke};
use grainbench_harness::statistics::median;
use maud::{Markup, html};
use serde::{Deserialize, Serialize};

/// Cost of a step of a solver in a scene with a given number of grains.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Load {
    /// Number of grains.
    pub grains: usize,
    /// Solver and contact convention, such as `dem:lammps`.
    pub solver: String,
    /// Resolution in words, such as `dt=.1`.
    pub resolution: String,
    /// Repeated timings; empty if the solver was not measured.
    pub laps: Vec<TimingDifference>,
    /// Reason why the solver was not measured.
    pub absent: Option<String>,
}

/// Processor times from the difference between a long and a short run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TimingDifference {
    /// Time of everything except the steps (s): reading, set-up, first neighbour search, relaxation and output.
    pub start_up: f64,
    /// Time of one step (s).
    pub step: f64,
    /// Time per second of simulated time (s).
    pub second: f64,
}

/// Returns the median of a value over the timings.
fn middle(load: &Load, value: fn(&TimingDifference) -> f64) -> f64 {
    median(&load.laps.iter().map(value).collect::<Vec<_>>())
}

/// Returns the figure of processor time per simulated second against the number of grains, if there are timings.
pub(crate) fn figure(loads: &[Load]) -> Option<Figure> {
    let timed = || loads.iter().filter(|load| !load.laps.is_empty());
    let curve = |solver: &str| {
        let own = timed().filter(|load| load.solver == solver);
        let places = own.map(|load| (load.grains as f64, middle(load, |lap| lap.second)));
        Curve::new(solver, Stroke::MarkedLine, places.collect())
    };
    let solvers = distinct(timed().map(|load| load.solver.as_str()));
    let curves: Vec<Curve> = solvers.into_iter().map(curve).collect();
    (!curves.is_empty()).then(|| {
        Figure::graph(
            "cost-against-grains",
            "Discs in a box: one, a hundred, ten thousand",
            "Processor time of one thread for one simulated second, without start-up. A horizontal line means that the \
             fixed cost of a step dominates. A line of slope 1 means that the cost per grain is constant.",
            [Axis::log("grains"), Axis::log("processor time per simulated second (s)")],
            curves,
        )
    })
}

pub(crate) fn render(loads: &[Load]) -> Markup {
    const TIMES: [&str; 4] = ["Start-up", "A step", "A grain in a step", "A simulated second"];
    let columns = [Column::heading("Discs, solver")].into_iter();
    let columns =
        columns.chain(TIMES.map(|name| Column::new(name, Format::Seconds))).chain([Column::text("Not measured")]);
    let row = |load: &Load| {
        let name = html! { (number::count(load.grains as u64)) ", " (load.solver) span.title { (load.resolution) } };
        let is_timed = load.absent.is_none();
        let step = middle(load, |lap| lap.step);
        let times = [middle(load, |lap| lap.start_up), step, step / load.grains as f64, middle(load, |lap| lap.second)];
        let [start_up, step, grain, second] = times.map(|time| is_timed.then_some(time));
        row![name, start_up, step, grain, second, load.absent.as_deref().unwrap_or_default()]
    };
    let table = Table::new("Cost of a step for few and for many grains", columns, loads.iter().map(row));
    html! {
        h3 { "From one grain to ten thousand" }
        p {
            "Most quantities above need one or two grains. Here discs are stacked in a box, and each solver has a \
             usual resolution. The table shows the processor time of one thread: a long run minus a short run, so \
             start-up cancels."
        }
        @if let Some(figure) = figure(loads) { (captioned(&figure)) }
        (table.page("cases"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grain_costs_a_step_over_the_grains_and_who_is_absent_says_why() {
        let lap = TimingDifference { start_up: 2e-3, step: 4e-6, second: 0.5 };
        let load = |solver: &str, laps, absent| Load {
            grains: 100,
            solver: solver.to_owned(),
            resolution: "dt=.1".to_owned(),
            laps,
            absent,
        };
        let loads = [load("dem", vec![lap], None), load("lammps", Vec::new(), Some("not installed".to_owned()))];
        let page = render(&loads).into_string();
        for time in [2e-3, 4e-6, 4e-8, 0.5] {
            let cell = format!("<td class=\"n\">{}</td>", number::seconds(time));
            assert!(page.contains(&cell), "{cell} is not in {page}");
        }
        assert!(page.contains("not installed"), "{page}");
        assert!(figure(&loads[1..]).is_none());
    }
}
