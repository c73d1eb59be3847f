//! Study of stability: largest stable time steps and hard cases, with figures and tables.

use super::Study;
use super::page::figure;
use crate::measured::{Hold, Stability};
use crate::number;
use crate::plot::DrawError;
use crate::row;
use crate::table::{Cell, Column, Format, Row, Table};
use grainbench_harness::figure::{Axis, Curve, Figure, Stroke};
use maud::{Markup, html};
use serde::{Deserialize, Serialize};

/// Largest stable time step of an assembly with one solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Assembly, such as `square lattice of discs`.
    pub scene: String,
    /// Name of a parameter other than the time step, such as `k_s/k_n`; empty if there is none.
    pub knob: String,
    /// Value of the parameter.
    pub at: Option<f64>,
    /// Name of the solver, such as `dem`.
    pub solver: String,
    /// Unit of the time steps, such as `√(m/k)`.
    pub unit: String,
    /// Largest time step that was stable.
    pub found: Option<f64>,
    /// Smallest time step that was unstable.
    pub unstable: Option<f64>,
    /// Exact stability limit, in the same unit; none if it is unknown.
    pub exact: Option<f64>,
    /// (found − exact)/exact.
    pub error: Option<f64>,
    /// Default time step of the solver.
    pub default: Option<f64>,
    /// `found` divided by `default`.
    pub margin: Option<f64>,
    /// Description of the failure above the limit, or the reason why no limit was found.
    pub detail: String,
}

/// Outcome of a hard case with one solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hardness {
    /// The required property holds at the default time step.
    Holds,
    /// The required property holds only at a smaller time step.
    HoldsAtASmallerStep,
    /// The run at the default time step ends with an error that states time, place and reason. The required property does
    /// not hold at smaller time steps either.
    TypedFailure,
    /// The run at the default time step ends without an error, but the required property does not hold. It does not hold
    /// at smaller time steps either.
    QuietlyWrong,
    /// The solver cannot represent the scene.
    Unsupported,
    /// The program is not installed.
    NotAvailable,
}

impl Hardness {
    /// Returns the name used in tables.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::HoldsAtASmallerStep => "holds at a smaller step",
            Self::TypedFailure => "typed failure",
            Self::QuietlyWrong => "wrong without an error",
            Self::Unsupported => "cannot express it",
            Self::NotAvailable => "not installed",
        }
    }
}

/// Result of one solver in a hard case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HardCaseResult {
    /// Name of the case, such as `mass-ratio-1e6`.
    pub case: String,
    /// Required property.
    pub must: String,
    /// Name of the solver, such as `dem`.
    pub solver: String,
    /// Outcome at the default time step and at smaller ones.
    pub standing: Hardness,
    /// Resolution at which the property holds, or the default resolution.
    pub resolution: String,
    /// Failure at the default time step, or the reason why the solver cannot run the case; empty if the property holds.
    pub detail: String,
}

/// Returns the values in the order of their first occurrence, each once.
pub(crate) fn distinct<'a>(values: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut seen: Vec<&str> = Vec::new();
    for value in values {
        if !seen.contains(&value) {
            seen.push(value);
        }
    }
    seen
}

/// Returns figures of the largest stable time step: one against the exact limit, and one for each unit against the
/// parameter.
#[must_use]
pub fn figures(limits: &[Limit]) -> Vec<Figure> {
    let units = distinct(limits.iter().map(|limit| limit.unit.as_str()));
    let of_unit =
        |unit: &str| limits.iter().filter(|limit| limit.unit == unit && limit.at.is_some()).collect::<Vec<_>>();
    let maps = units.into_iter().filter_map(|unit| map(&of_unit(unit), unit));
    against_exact(limits).into_iter().chain(maps).collect()
}

/// Points of a curve: parameter and largest stable time step.
type Points = Vec<(f64, f64)>;

fn map(rows: &[&Limit], unit: &str) -> Option<Figure> {
    let mut curves = Vec::new();
    let knob = rows.first()?.knob.clone();
    let exact = rows.iter().any(|row| row.exact.is_some());
    let points = |curve: &dyn Fn(&Limit) -> Option<f64>| -> Points {
        let mut points: Points = rows.iter().filter_map(|row| Some((row.at?, curve(row)?))).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    };
    // Solvers with equal curves share one curve, because equal curves would hide each other.
    let mut groups = Vec::<(Vec<&str>, Points)>::new();
    for solver in distinct(rows.iter().map(|row| row.solver.as_str())) {
        let found = points(&|row| row.found.filter(|_| row.solver == solver));
        match groups.iter_mut().find(|(_, points)| *points == found) {
            Some((solvers, _)) => solvers.push(solver),
            None => groups.push((vec![solver], found)),
        }
    }
    let stroke = if exact { Stroke::Markers } else { Stroke::MarkedLine };
    for (solvers, found) in groups.into_iter().filter(|(_, found)| !found.is_empty()) {
        let label = match solvers.split_first() {
            Some((first, [])) => (*first).to_owned(),
            Some((first, others)) => format!("{first} (and {}: equal)", others.join(", ")),
            None => continue,
        };
        curves.push(Curve::new(label, stroke, found));
    }
    for scene in distinct(rows.iter().map(|row| row.scene.as_str())) {
        let first = rows.iter().find(|row| row.scene == scene).map_or("", |row| row.solver.as_str());
        let line = points(&|row| row.exact.filter(|_| row.scene == scene && row.solver == first));
        let stroke = if line.len() > 1 { Stroke::Dashed } else { Stroke::Markers };
        if !line.is_empty() {
            curves.push(Curve::new(format!("{scene}, exact"), stroke, line));
        }
    }
    let name = if exact { "stable-step-springs" } else { "stable-step-grid" };
    let scenes = if exact { "assemblies on springs" } else { "the material point method" };
    let caption = if exact {
        "The largest stable step is found by bisection on the growth of a random perturbation of all degrees of \
         freedom. Dashed lines join the exact limits. The parameter is the ratio of tangential and \
         normal stiffness, and m is the mass of a grain."
    } else {
        "Largest Courant number for which the energy of a vibrating bar changes by less than a tenth over two periods."
    };
    let x = if exact { Axis::linear(&knob) } else { Axis::log(&knob) };
    let y = if unit.starts_with('√') { format!("Δt / {unit}") } else { format!("Δt / ({unit})") };
    (!curves.is_empty()).then(|| {
        Figure::graph(name, &format!("Largest stable step of {scenes}"), caption, [x, Axis::linear(&y)], curves)
    })
}

/// Returns the figure of the largest stable time step against the exact limit.
fn against_exact(limits: &[Limit]) -> Option<Figure> {
    let mut curves = Vec::new();
    let mut ends = (f64::INFINITY, 0.0_f64);
    for solver in distinct(limits.iter().map(|row| row.solver.as_str())) {
        let mine = limits.iter().filter(|row| row.solver == solver);
        let points: Vec<(f64, f64)> = mine.filter_map(|row| Some((row.exact?, row.found?))).collect();
        for (exact, _) in &points {
            ends = (ends.0.min(*exact), ends.1.max(*exact));
        }
        if !points.is_empty() {
            curves.push(Curve::new(solver, Stroke::Markers, points));
        }
    }
    curves.push(Curve::new("exact", Stroke::Dashed, vec![(ends.0, ends.0), (ends.1, ends.1)]));
    (curves.len() > 1).then(|| {
        Figure::graph(
            "found-exact",
            "Largest stable steps against the exact limits",
            "Largest stable time step of each solver over the exact limit of central differences, for all assemblies \
             with such a limit. A solver below the line becomes unstable earlier than central differences.",
            [Axis::linear("exact limit / √(m/k)"), Axis::linear("largest stable step / √(m/k)")],
            curves,
        )
    })
}

/// Renders a table with one row per solver: its largest stable time steps, and its outcomes in hard cases.
fn totals(lines: &[Hold]) -> Markup {
    let numbers = ["Hard cases that hold", "at a smaller step", "end in an error", "wrong without an error"];
    let columns = [Column::heading("Solver"), Column::text("Largest stable step over the exact limit")].into_iter();
    let columns = columns.chain(numbers.map(|name| Column::new(name, Format::Count)));
    let row = |line: &Hold| {
        let limit = line.limit.map(|([low, high], count)| {
            let [low, high] = [low, high].map(|end| number::significant(end, 4));
            format!("{low} … {high} in {count} assemblies")
        });
        let holds = format!("{} of {}", line.holds, line.asked());
        row![&line.solver, limit, holds, line.smaller, line.typed, line.wrong]
    };
    Table::new("Totals", columns, lines.iter().map(row)).page("")
}

/// Renders the section of the page.
pub(crate) fn render(study: &Study) -> Result<Markup, DrawError> {
    let tables = tables(&Stability::from_study(study, &|_| None))?;
    Ok(html! {
        header id="summary" {
            p.kicker { "grainbench" }
            h1 { "What stays stable" }
            (tables)
        }
    })
}

/// Renders the figures and tables.
pub(crate) fn tables(stability: &Stability) -> Result<Markup, DrawError> {
    let pictures: Vec<Markup> = figures(&stability.limits).iter().map(figure).collect::<Result<_, _>>()?;
    Ok(html! {
        p.lead {
            "The largest stable step of each solver, found by bisection between stable and failed runs, with the exact \
             limit if "
            "there is one. Hard cases follow, each with its requirement."
        }
        h3 { "Totals" }
        (totals(&stability.lines))
        @if !stability.hard.is_empty() {
            h3 { "Hard cases" }
            (matrix(&stability.hard))
            (details_of(&stability.hard))
        }
        @if !stability.limits.is_empty() {
            h3 { "Largest stable steps" }
            div.figures { @for picture in &pictures { (picture) } }
            (limits(&stability.limits))
        }
    })
}

/// Returns the symbol and the CSS class of an outcome.
pub(crate) const fn sign(standing: Hardness) -> (&'static str, &'static str) {
    match standing {
        Hardness::Holds => ("✓", "pass"),
        Hardness::HoldsAtASmallerStep => ("↓", "amber"),
        Hardness::TypedFailure => ("!", "amber"),
        Hardness::QuietlyWrong => ("✗", "fail"),
        Hardness::Unsupported | Hardness::NotAvailable => ("–", ""),
    }
}

fn matrix(rows: &[HardCaseResult]) -> Markup {
    let solvers = distinct(rows.iter().map(|row| row.solver.as_str()));
    let columns =
        [Column::heading("Case and requirement")].into_iter().chain(solvers.iter().copied().map(Column::text));
    let row = |case: &str| {
        let result = |solver: &&str| {
            let Some(row) = rows.iter().find(|row| row.case == case && row.solver == *solver) else { return "".into() };
            let (symbol, class) = sign(row.standing);
            Cell::from(html! {
                span class={ "mark " (class) } { (symbol) " " (row.standing.word()) }
                @if row.standing == Hardness::HoldsAtASmallerStep { span.fine { (row.resolution) } }
            })
        };
        let must = rows.iter().find(|row| row.case == case).map_or("", |row| row.must.as_str());
        let name = html! { (case) span.title { (must) } };
        Row::from([Cell::from(name)].into_iter().chain(solvers.iter().map(result)).collect::<Vec<_>>())
    };
    let cases = distinct(rows.iter().map(|row| row.case.as_str()));
    Table::new("Hard cases", columns, cases.into_iter().map(row)).page("cases")
}

fn details_of(rows: &[HardCaseResult]) -> Markup {
    let telling = |row: &&HardCaseResult| !row.detail.is_empty() && !matches!(row.standing, Hardness::NotAvailable);
    html! {
        details {
            summary { "Observations" }
            ul {
                @for row in rows.iter().filter(telling) {
                    li { (row.case) " · " (row.solver) " · " (row.standing.word()) ": " (row.detail) }
                }
            }
        }
    }
}

fn limits(rows: &[Limit]) -> Markup {
    let number = |name| Column::new(name, Format::Digits(4));
    let columns = [
        Column::heading("Assembly"),
        Column::text("Solver"),
        number("Found"),
        number("Exact"),
        Column::new("Error", Format::Error),
        Column::text("Unit"),
        number("Default"),
        number("Margin"),
        Column::text("How it fails above").class("wide"),
    ];
    let row = |row: &Limit| {
        let at = row.at.map(|at| format!("{} = {}", row.knob, number::significant(at, 4)));
        let scene = html! { (row.scene) @if let Some(at) = at { span.fine { (at) } } };
        let Limit { solver, found, exact, error, unit, default, margin, detail, .. } = row;
        row![scene, solver, *found, *exact, *error, unit, *default, *margin, detail]
    };
    Table::new("Largest stable steps", columns, rows.iter().map(row)).page("rows")
}
