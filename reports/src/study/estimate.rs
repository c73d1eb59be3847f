//! Cost of accuracy of a scene without an exact solution. Errors are estimates from the levels of each solver.

use super::cost::TARGETS;
use super::point::PointStatus;
use super::stability::Limit;
use crate::distinct;
use crate::number;
use crate::page::{captioned, slug};
use crate::table::{Cell, Column, Columns, Format};
use grainbench_harness::evidence::Evidence;
use grainbench_harness::figure::{Axis, Curve, Figure, Stroke};
use maud::{Markup, html};
use serde::{Deserialize, Serialize};

/// Error of the sentence that summarises a study.
const TARGET: f64 = 0.01;
/// Uncertainty of a difference, as a fraction of the scale, from which two methods cannot be compared.
const COMPARABLE: f64 = 0.05;
/// Time step relative to the largest stable one above which a sentence has a remark.
const MARGIN: f64 = 0.5;
/// Unit of a time step of a solver with springs: the critical time step.
const CRITICAL_STEP: &str = "2√(m/k)";
/// Number of quantities whose figures are visible without a click.
const OPEN: usize = 3;
/// Status in words of a solver that cannot represent the scene.
const CANNOT: &str = "cannot run the scene";
/// Smallest plotted error.
const LEAST: f64 = 1e-12;

/// Value of a time series that is compared between levels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reduction {
    /// Last sample.
    End,
    /// Mean over time, for chaotic scenes.
    Mean,
    /// Mean over a time window, from its first to its last time (s).
    Window(f64, f64),
}

impl Reduction {
    pub(crate) fn word(self) -> String {
        match self {
            Self::End => "at the end".to_owned(),
            Self::Mean => "mean over time".to_owned(),
            Self::Window(from, to) => format!("mean from {} to {}", number::seconds(from), number::seconds(to)),
        }
    }

    /// Returns the definition of the scale of a quantity.
    const fn scale(self) -> &'static str {
        match self {
            Self::End => "the larger of |reference value| and the largest |value| of this quantity over the run",
            Self::Mean | Self::Window(..) => "the mean over this time of |value| of this quantity",
        }
    }
}

/// Method by which a reference value is estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Basis {
    /// Richardson's extrapolation of three levels with a visible order.
    Extrapolated,
    /// The finest level, with the spread of the last levels as uncertainty.
    Spread,
    /// Mean of the last levels of a chaotic scene.
    Ensemble,
}

impl Basis {
    pub(crate) const fn word(self) -> &'static str {
        match self {
            Self::Extrapolated => "extrapolated",
            Self::Spread => "no visible order: finest level, spread of the levels",
            Self::Ensemble => "mean of three levels",
        }
    }
}

/// Run of a solver at one level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Level {
    /// Name of the solver.
    pub solver: String,
    /// Resolution in words, with the change of the scene if there is one.
    pub setting: String,
    /// Status of the run.
    pub status: PointStatus,
    /// Median wall-clock time of the stepping loop (s). For a failed run, the time until the failure.
    pub wall_seconds: Option<f64>,
    /// Number of timed repetitions.
    pub repetitions: usize,
    /// Number of steps.
    pub steps: u64,
    /// Error message of a run that did not end.
    pub detail: Option<String>,
}

/// Reference value of a quantity by one solver.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Name of the solver.
    pub solver: String,
    /// Kind of evidence: the levels of the solver itself.
    pub evidence: Evidence,
    /// Estimate of the value at infinite resolution.
    pub value: f64,
    /// Half-width of the interval of this value.
    pub uncertainty: f64,
    /// Observed order; none if it is not visible.
    pub order: Option<f64>,
    /// Method of the estimate.
    pub basis: Basis,
}

/// Value of a quantity at one level, with its estimated error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EstimatedPoint {
    /// Name of the solver.
    pub solver: String,
    /// Resolution in words.
    pub setting: String,
    /// Median wall-clock time of the stepping loop (s).
    pub wall_seconds: f64,
    /// Value.
    pub value: f64,
    /// |value − reference of the solver|/scale.
    pub error: f64,
    /// Uncertainty of the error, divided by the scale.
    pub uncertainty: f64,
    /// True if the contacts are softer than in the scene. The error then contains the influence of the stiffness.
    pub softer: bool,
}

impl EstimatedPoint {
    /// Returns the upper end of the interval of the error.
    fn at_most(&self) -> f64 {
        self.error + self.uncertainty
    }
}

/// Difference of the reference values of two solvers.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference<'a> {
    /// Names of the solvers.
    pub solvers: [&'a str; 2],
    /// |difference|/scale.
    pub size: f64,
    /// Uncertainty of the difference, divided by the scale.
    pub uncertainty: f64,
}

/// Quantity of a scene: a column of a probe.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quantity {
    /// Column of the time series, such as `ball.vx`.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Scale of this column. Errors are fractions of it.
    pub scale: f64,
    /// One reference value for each solver with at least two levels.
    pub estimates: Vec<Estimate>,
    /// Values at all levels, for solvers with a reference value. Each solver's levels are from coarse to fine.
    pub points: Vec<EstimatedPoint>,
}

impl Quantity {
    /// Returns the fastest setting of a solver whose error is certainly at most `target`. Softer contacts are left out.
    #[must_use]
    pub fn cheapest(&self, solver: &str, target: f64) -> Option<&EstimatedPoint> {
        self.within(solver, target).min_by(|a, b| a.wall_seconds.total_cmp(&b.wall_seconds))
    }

    /// Returns the points of a solver that reach `target`: their errors and the errors of all finer levels are certainly at
    /// most `target`. A coarse level whose finer levels have larger errors is right by chance.
    fn within(&self, solver: &str, target: f64) -> impl Iterator<Item = &EstimatedPoint> {
        let points: Vec<_> = self.of_solver(solver).collect();
        points.into_iter().rev().take_while(move |point| point.at_most() <= target)
    }

    /// Returns the points of a solver with the contacts of the scene.
    fn of_solver<'a, 's>(&'a self, solver: &'s str) -> impl Iterator<Item = &'a EstimatedPoint> + use<'a, 's> {
        self.points.iter().filter(move |point| point.solver == solver && !point.softer)
    }

    /// Returns the differences between the reference values of all pairs of solvers.
    pub(crate) fn differences(&self) -> Vec<Difference<'_>> {
        let differences = self.estimates.iter().enumerate().flat_map(|(at, a)| {
            self.estimates[at + 1..].iter().map(move |b| Difference {
                solvers: [&a.solver, &b.solver],
                size: (a.value - b.value).abs() / self.scale,
                uncertainty: a.uncertainty.hypot(b.uncertainty) / self.scale,
            })
        });
        differences.collect()
    }
}

/// Cost of accuracy of a scene without an exact solution.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneCost {
    /// Path of the scene.
    pub scene: String,
    /// Time budget (s).
    pub budget: f64,
    /// Time that the study took (s), without stored levels of an earlier study.
    pub spent: f64,
    /// Compared value of the time series.
    pub reduction: Reduction,
    /// Names of all solvers.
    #[serde(default)]
    pub names: Vec<String>,
    /// All runs.
    pub levels: Vec<Level>,
    /// Target quantities.
    pub quantities: Vec<Quantity>,
    /// Remarks, such as the reason why a solver was not measured.
    pub notes: Vec<String>,
}

impl SceneCost {
    fn solvers(&self) -> Vec<&str> {
        let run = self.levels.iter().map(|level| level.solver.as_str());
        distinct(self.names.iter().map(String::as_str).chain(run))
    }

    /// Returns the reason why a solver has no reference value.
    fn reason(&self, solver: &str) -> String {
        let own = || self.levels.iter().filter(|level| level.solver == solver);
        let count = |status| own().filter(|level| level.status == status).count();
        match (count(PointStatus::Measured), count(PointStatus::Failed), own().next_back()) {
            (_, _, None) => "no run".to_owned(),
            (0, failed, Some(last)) if last.status == PointStatus::Failed => format!("{failed} levels failed"),
            (0, _, Some(last)) => last.status.word(CANNOT).to_owned(),
            (1, ..) => "only one level ended, and two are needed".to_owned(),
            _ => "no finite value".to_owned(),
        }
    }

    /// Returns the fastest setting whose errors of all quantities are certainly at most `target`, and its time (s). There is
    /// none if the solver has no value of a quantity.
    #[must_use]
    pub fn cheapest_for_all(&self, solver: &str, target: f64) -> Option<(&str, f64)> {
        let is_enough = |setting: &str| {
            let mut quantities = self.quantities.iter();
            quantities.all(|quantity| quantity.within(solver, target).any(|point| point.setting == setting))
        };
        let settings = self.quantities.first()?.of_solver(solver).filter(|point| is_enough(&point.setting));
        let best = settings.min_by(|a, b| a.wall_seconds.total_cmp(&b.wall_seconds))?;
        Some((&best.setting, best.wall_seconds))
    }

    /// Returns the sentence about the cost of an error of at most `target` in all quantities. `limits` are the largest stable
    /// steps, as far as they are known.
    #[must_use]
    pub fn sentence(&self, target: f64, limits: &[Limit]) -> String {
        let quantities: Vec<&Quantity> = self.quantities.iter().collect();
        self.words(&quantities, &|solver| self.cheapest_for_all(solver, target), target, limits)
    }

    /// Returns the sentence about the cost of an error of at most `target` in one quantity.
    pub(crate) fn sentence_of(&self, quantity: &Quantity, target: f64, limits: &[Limit]) -> String {
        let cheapest = |solver: &str| {
            let point = quantity.cheapest(solver, target)?;
            Some((point.setting.as_str(), point.wall_seconds))
        };
        self.words(&[quantity], &cheapest, target, limits)
    }

    /// Returns a sentence of the settings and times (s) at which solvers reach an error in all of some quantities, and of the
    /// errors of all other solvers. `cheapest` returns the setting and the time of a solver.
    fn words<'q>(
        &self,
        quantities: &[&'q Quantity],
        cheapest: &dyn Fn(&str) -> Option<(&'q str, f64)>,
        target: f64,
        limits: &[Limit],
    ) -> String {
        let solvers = self.solvers();
        let mut reached: Vec<_> = solvers
            .iter()
            .filter_map(|solver| cheapest(solver).map(|(setting, time)| (*solver, setting, time)))
            .collect();
        reached.sort_by(|a, b| a.2.total_cmp(&b.2));
        let fastest = reached.first().map_or(f64::NAN, |first| first.2);
        let part = |(solver, setting, seconds): &(&str, &str, f64)| {
            let times = seconds / fastest;
            let times = if times > 1.0 { format!(" (× {})", number::significant(times, 2)) } else { String::new() };
            let margin = margin_words(solver, setting, limits).unwrap_or_default();
            format!("{solver} {}{times} with {setting}{margin}", number::seconds(*seconds))
        };
        let mut parts: Vec<String> = reached.iter().map(part).collect();
        if parts.is_empty() {
            parts.push(format!("no solver reaches it within the budget of {}", number::seconds(self.budget)));
        }
        let unreached = |solver: &&str| {
            let own = || quantities.iter().filter_map(|quantity| Some((quantity, least(quantity, solver)?)));
            let Some((quantity, error)) = own().max_by(|a, b| a.1.total_cmp(&b.1)) else {
                return format!("{solver} has no value ({})", self.reason(solver));
            };
            let (within, all) = (own().filter(|(_, error)| *error <= target).count(), quantities.len());
            let at_best = format!("at best {}", number::fraction(error));
            let without = quantities.iter().find(|quantity| least(quantity, solver).is_none());
            match (all, without) {
                (1, _) => format!("{solver} does not reach it ({at_best})"),
                (_, Some(quantity)) => {
                    format!("{solver} reaches it in {within} of {all} ({}: no value)", quantity.name)
                }
                (_, None) => format!("{solver} reaches it in {within} of {all} ({} {at_best})", quantity.name),
            }
        };
        let others = solvers.iter().filter(|solver| reached.iter().all(|(name, ..)| name != *solver));
        parts.extend(others.map(unreached));
        let of_all = match quantities.len() {
            1 => String::new(),
            count => format!(" in each of {count} quantities"),
        };
        format!("{}{of_all}: {}.", number::fraction(target), parts.join("; "))
    }
}

/// Returns the smallest target that a solver reaches: the upper end of the error of its finest level.
fn least(quantity: &Quantity, solver: &str) -> Option<f64> {
    quantity.of_solver(solver).last().map(EstimatedPoint::at_most)
}

/// Returns a remark about a time step near the largest stable step of the solver: near the smallest step that failed, because
/// the largest one that passed may be a lower bound.
fn margin_words(solver: &str, setting: &str, limits: &[Limit]) -> Option<String> {
    let step: f64 = setting.strip_prefix("dt=")?.parse().ok()?;
    let limit = limits.iter().find(|limit| limit.solver == solver && limit.unit == CRITICAL_STEP)?;
    let share = step / limit.unstable?;
    (share > MARGIN).then(|| format!(", which is {} of the largest stable step", number::significant(share, 2)))
}

/// Returns one figure for each quantity: estimated error against time.
#[must_use]
pub fn figures(cost: &SceneCost) -> Vec<Figure> {
    let drawn = cost.quantities.iter().filter(|quantity| !quantity.points.is_empty());
    drawn.map(|quantity| error_figure(cost, quantity)).collect()
}

fn error_figure(cost: &SceneCost, quantity: &Quantity) -> Figure {
    let place = |point: &EstimatedPoint| (point.wall_seconds, point.error.max(0.1 * point.uncertainty).max(LEAST));
    let mut curves = Vec::new();
    for solver in cost.solvers() {
        let mut points: Vec<_> = quantity.of_solver(solver).map(place).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        curves.push(Curve::new(solver, Stroke::MarkedLine, points));
        let softer = quantity.points.iter().filter(|point| point.solver == solver && point.softer);
        curves.push(Curve::new("", Stroke::Beside, softer.map(place).collect()));
    }
    curves.retain(|curve| !curve.points.is_empty());
    let bar = |point: &EstimatedPoint| {
        let (time, error) = place(point);
        let high = point.at_most().max(error);
        [(time, (point.error - point.uncertainty).max(high / 30.0).min(error)), (time, high)]
    };
    curves.push(Curve::new("uncertainty", Stroke::Bars, quantity.points.iter().flat_map(bar).collect()));
    let times = || quantity.points.iter().map(|point| point.wall_seconds);
    let ends = [times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max)];
    curves.push(Curve::new("1 %", Stroke::Dashed, ends.map(|time| (time, TARGET)).to_vec()));
    let softer = quantity.points.iter().any(|point| point.softer);
    let softer = if softer { " Hollow markers: softer contacts." } else { "" };
    Figure::graph(
        &format!("error-{}", slug(&quantity.name)),
        &format!("{}: estimated error against time", quantity.name),
        &format!(
            "Each marker is a level of a solver. Its error is the distance from the solver's own reference value, divided by \
             {}. Grey bars are uncertainties.{softer} The figure does not show differences between the methods.",
            number::with_unit(quantity.scale, &quantity.unit)
        ),
        [Axis::log("wall-clock time of the stepping loop (s)"), Axis::log("estimated |error| / scale")],
        curves,
    )
}

pub(crate) fn render(cost: &SceneCost, limits: &[Limit]) -> Markup {
    let figures = figures(cost);
    let folded = figures.len().saturating_sub(OPEN);
    html! {
        header id="summary" {
            p.kicker { "grainbench" }
            h1 { "What accuracy costs in " (cost.scene) }
            p.lead { b { (cost.sentence(TARGET, limits)) } }
            p { @for target in TARGETS.into_iter().filter(|target| *target != TARGET) { (cost.sentence(target, limits)) " " } }
            p {
                "The scene has no exact solution. The reference value of each solver is estimated from its own levels \
                 (evidence: " (Evidence::Convergence.word()) "). Errors are estimates with an uncertainty, and nothing passes or \
                 fails. A setting reaches an error if its own error and the errors of all finer levels are at most as large, \
                 uncertainty included. Agreement of two methods does not show that they are right."
            }
            p.note {
                "Compared value of each probe: " (cost.reduction.word()) ". The scale of an error is "
                (cost.reduction.scale()) ", by the first solver. The study took " (number::seconds(cost.spent))
                " of a budget of " (number::seconds(cost.budget)) "."
            }
            @for note in &cost.notes { p.note { (note) } }
            h3 { "Which solver at 1 %" }
            (costs(cost))
            h3 { "Reference values" }
            (references(cost))
            (agreement(cost))
            div.figures.two { @for figure in figures.iter().take(OPEN) { (captioned(figure)) } }
            @if folded > 0 {
                details {
                    summary { "Figures of " (folded) " further quantities" }
                    div.figures.two { @for figure in figures.iter().skip(OPEN) { (captioned(figure)) } }
                }
            }
            (softer(cost))
            details {
                summary { "Every run" }
                (levels(&cost.levels))
            }
        }
    }
}

/// Renders the fastest setting of each solver for an error of 1 %, by quantity.
fn costs(cost: &SceneCost) -> Markup {
    let cell = |quantity: &Quantity, solver: &str| match (quantity.cheapest(solver, TARGET), least(quantity, solver)) {
        (Some(point), _) => {
            let error = html! { span.fine { (point.setting) ", error " (interval(point)) } };
            Cell::from(html! { (number::seconds(point.wall_seconds)) (error) })
        }
        (None, Some(error)) => format!("at best {}", number::fraction(error)).into(),
        (None, None) => format!("no value: {}", cost.reason(solver)).into(),
    };
    Columns::<&Quantity>::new(Column::heading("Quantity").class("name"), |quantity| breakable(&quantity.name))
        .and_each(cost.solvers(), cell)
        .table("Which solver at 1 %", &cost.quantities, |_| "")
        .page("cases")
}

/// Renders a name that breaks only after a dot.
fn breakable(name: &str) -> Markup {
    html! { @for part in name.split_inclusive('.') { (part) wbr; } }
}

/// Returns an error with its uncertainty.
fn interval(point: &EstimatedPoint) -> String {
    format!("{} ± {}", number::fraction(point.error), number::fraction(point.uncertainty))
}

fn references(cost: &SceneCost) -> Markup {
    let rows = cost.quantities.iter().flat_map(|quantity| quantity.estimates.iter().map(move |row| (quantity, row)));
    let name = Column::heading("Quantity").class("name");
    Columns::<(&Quantity, &Estimate)>::new(name, |(quantity, _)| breakable(&quantity.name))
        .and(Column::text("Solver"), |(_, row)| &row.solver)
        .and(Column::text("Reference").class("n"), |(quantity, row)| number::with_unit(row.value, &quantity.unit))
        .and(Column::text("Uncertainty").class("n"), |(_, row)| {
            format!("± {}", number::significant(row.uncertainty, 2))
        })
        .and(Column::new("of the scale", Format::Fraction), |(quantity, row)| row.uncertainty / quantity.scale)
        .and(Column::new("Order", Format::Digits(2)), |(_, row)| row.order)
        .and(Column::text("Estimate"), |(_, row)| row.basis.word())
        .and(Column::text("Evidence"), |(_, row)| row.evidence.word())
        .table("Reference values", rows, |_| "")
        .page("rows")
}

/// Returns the difference of two solvers in words. Methods agree only if the uncertainty of their difference is small.
pub(crate) fn difference_words(difference: &Difference<'_>) -> String {
    let [a, b] = difference.solvers;
    let [size, uncertainty] = [difference.size, difference.uncertainty].map(number::fraction);
    if difference.size > difference.uncertainty {
        format!("{a} and {b} differ by {size} (more than their uncertainty of ± {uncertainty})")
    } else if difference.uncertainty < COMPARABLE {
        format!("{a} and {b} agree within their uncertainties ({size} ± {uncertainty})")
    } else {
        format!("the agreement of {a} and {b} cannot be decided: the uncertainty is ± {uncertainty}")
    }
}

fn agreement(cost: &SceneCost) -> Markup {
    let rows = cost.quantities.iter().map(|quantity| (quantity, quantity.differences()));
    let rows: Vec<_> = rows.filter(|(_, differences)| !differences.is_empty()).collect();
    html! {
        @if !rows.is_empty() {
            h3 { "Agreement between the methods" }
            p.note {
                "The methods model contacts differently. Agreement is not evidence of truth, and a difference does not tell \
                 which method is wrong. It cannot be decided if the uncertainty is at least " (number::fraction(COMPARABLE))
                " of the scale."
            }
            ul {
                @for (quantity, differences) in &rows {
                    li { (quantity.name) ": " (differences.iter().map(difference_words).collect::<Vec<_>>().join("; ")) }
                }
            }
        }
    }
}

/// Returns, for each setting with softer contacts, its time relative to the same level of the scene. Also returns the quantity
/// that changes most beyond its uncertainty, with this change.
pub(crate) fn softer_words(cost: &SceneCost) -> Vec<String> {
    let points =
        || cost.quantities.iter().flat_map(|quantity| quantity.points.iter().map(move |point| (quantity, point)));
    let settings = distinct(points().filter(|(_, point)| point.softer).map(|(_, point)| point.setting.as_str()));
    let sentence = |setting: &str| {
        let own = || points().filter(move |(_, point)| point.setting == setting);
        let certain = |point: &EstimatedPoint| point.error - point.uncertainty;
        let (quantity, worst) = own().max_by(|a, b| certain(a.1).total_cmp(&certain(b.1)))?;
        let (solver, time, change) = (&worst.solver, number::seconds(worst.wall_seconds), interval(worst));
        Some(format!("{solver} {setting}: {time}, largest change {change} in {}", quantity.name))
    };
    settings.into_iter().filter_map(sentence).collect()
}

fn softer(cost: &SceneCost) -> Markup {
    let sentences = softer_words(cost);
    html! {
        @if !sentences.is_empty() {
            h3 { "Softer contacts" }
            p.note {
                "Stiffness divided by a factor, with dashpots that keep the coefficient of restitution. The time step grows with \
                 the critical one. The scene itself is not changed."
            }
            ul { @for sentence in &sentences { li { (sentence) } } }
        }
    }
}

fn levels(rows: &[Level]) -> Markup {
    Columns::<&Level>::new(Column::heading("Solver"), |level| &level.solver)
        .and(Column::text("Setting"), |level| &level.setting)
        .and(Column::text("Run"), |level| level.status.word(CANNOT))
        .and(Column::new("Wall time", Format::Seconds), |level| level.wall_seconds)
        .and(Column::new("Repetitions", Format::Count), |level| level.repetitions)
        .and(Column::new("Steps", Format::Count), |level| level.steps)
        .and(Column::text("Message").class("wide"), |level| level.detail.as_deref().unwrap_or_default())
        .table("Every run", rows, |level| if level.status == PointStatus::Measured { "" } else { "amber" })
        .page("rows")
}

#[cfg(test)]
#[path = "estimate_tests.rs"]
mod tests;
