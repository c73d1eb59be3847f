//! Study of effects: the effects that each scene contains, and the error and cost if an effect is left out.

use crate::line::scene_name;
use crate::number;
use crate::row;
use crate::table::{Cell, Column, Columns, Table};
use crate::{class, distinct};
use grainbench_harness::verdict::Severity;
use maud::{Markup, html};
use serde::{Deserialize, Serialize};

/// Result for an effect in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EffectResult {
    /// The effect is on, and a claim fails without it.
    Needed,
    /// The effect is on, and no claim fails without it.
    NotWorthSimulating,
    /// The effect is on, but no claim or probe shows its influence.
    Untold,
    /// The effect is off. Compiled in with a neutral value, it changes no bit of the result.
    Inert,
    /// The effect is off. Compiled in with a neutral value, it changes the result.
    NotInert,
}

impl EffectResult {
    const fn word(self) -> &'static str {
        match self {
            Self::Needed => "needed",
            Self::NotWorthSimulating => "does not matter",
            Self::Untold => "not shown",
            Self::Inert => "inert",
            Self::NotInert => "not inert",
        }
    }

    pub(crate) const fn severity(self) -> Severity {
        match self {
            Self::Needed | Self::Inert => Severity::Green,
            Self::NotWorthSimulating | Self::Untold => Severity::Amber,
            Self::NotInert => Severity::Red,
        }
    }
}

/// Errors of a claimed quantity with an effect and without it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shift {
    /// Claimed quantity, in words.
    pub quantity: String,
    /// Name of the solver of the claim.
    pub solver: String,
    /// Signed error with the effect, as a fraction of the scale.
    pub with: Option<f64>,
    /// Signed error without the effect, as a fraction of the scale; none if the run crashed or the value is not finite.
    pub without: Option<f64>,
    /// Largest |error| that passes.
    pub allowed: f64,
    /// True if the claim fails without the effect.
    pub red: bool,
}

/// An effect in a scene of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Entry {
    /// Name of the case.
    pub case: String,
    /// Variant of the scene.
    pub variant: String,
    /// Effect, in words.
    pub effect: String,
    /// True if the scene has the effect.
    pub on: bool,
    /// Key of the scene file that switches the effect on.
    pub key: String,
    /// Conclusion about the effect in this scene.
    pub worth: EffectResult,
    /// Changes of all claimed quantities without the effect.
    pub shifts: Vec<Shift>,
    /// Number of particle-steps and contact evaluations with the effect, divided by their number without it.
    pub counts: Option<f64>,
    /// Processor time with the effect, divided by the processor time without it.
    pub time: Option<f64>,
    /// Solvers that ran the scene with a neutral value of an effect that is off.
    #[serde(default)]
    pub tried: Vec<String>,
    /// Error of the run without the effect, if it ended with one. Such a run shows no influence of the effect.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub detail: Option<String>,
}

pub(crate) fn render(ledger: &[Entry]) -> Markup {
    let count = |worth: EffectResult| ledger.iter().filter(|entry| entry.worth == worth).count();
    html! {
        header id="summary" {
            p.kicker { "grainbench" }
            h1 { "Influence of each effect" }
            p.lead {
                "The page lists the effects of each scene and the key that enables each effect. Each enabled effect is \
                 switched off, and the page shows the change in every claimed quantity and in the cost. Each disabled \
                 effect is compiled in with a neutral value and must change no bit."
            }
            p {
                (count(EffectResult::Needed)) " needed, "
                (count(EffectResult::NotWorthSimulating)) " do not matter in scenes that enable them, "
                (count(EffectResult::Inert)) " inert, " (count(EffectResult::NotInert)) " not inert."
            }
            h3 { "Scenes by effects" }
            (heat(ledger))
            h3 { "All effects" }
            (table(ledger))
        }
    }
}

/// Renders the table of the effects of one scene.
pub(crate) fn important(ledger: &[Entry]) -> Markup {
    html! {
        section {
            h3 { "Which effects matter" }
            p.note { "Each effect is switched off. It is needed if a probe then changes by more than the stated limit." }
            (table(ledger))
        }
    }
}

/// Returns the change of the error without the effect, divided by the tolerance; infinity if an error is missing.
fn moved(shift: &Shift) -> f64 {
    match (shift.with, shift.without) {
        (Some(with), Some(without)) => (without - with).abs() / shift.allowed.max(f64::MIN_POSITIVE),
        _ => f64::INFINITY,
    }
}

/// Returns the change of the error without the effect, as a fraction of the scale; none if an error is missing.
pub(crate) fn change(shift: &Shift) -> Option<f64> {
    Some((shift.without? - shift.with?).abs()).filter(|change| change.is_finite())
}

/// Returns the quantity with the median change or, if no change is known, the first quantity. If claims fail without
/// the effect, only their quantities count.
pub(crate) fn median(entry: &Entry) -> Option<&Shift> {
    let fails = entry.shifts.iter().any(|shift| shift.red && change(shift).is_some());
    let mut shifts: Vec<&Shift> =
        entry.shifts.iter().filter(|shift| change(shift).is_some() && (shift.red || !fails)).collect();
    shifts.sort_by(|a, b| change(a).unwrap_or_default().total_cmp(&change(b).unwrap_or_default()));
    shifts.get(shifts.len() / 2).copied().or_else(|| entry.shifts.first())
}

/// Renders the matrix of scenes and effects. Colour and number of a cell show the change without the effect.
pub(crate) fn heat(ledger: &[Entry]) -> Markup {
    let effects = distinct(ledger.iter().map(|entry| entry.effect.as_str()));
    let scenes = distinct(ledger.iter().map(|entry| (entry.case.as_str(), entry.variant.as_str())));
    let mark = |(case, variant): (&str, &str), effect: &str| {
        let found = ledger.iter().find(|entry| [&entry.case, &entry.variant, &entry.effect] == [case, variant, effect]);
        found.map_or_else(|| Cell::from(""), |entry| warmth(entry).into())
    };
    let columns = Columns::new(Column::heading("Scene"), |(case, variant)| scene_name(case, variant));
    let table = columns.and_each(effects, mark).table("Scenes by effects", scenes, |_| "");
    html! {
        p.note {
            "For an enabled effect: the change of the result without it (median over the claims or probes), and its cost \
             (particle steps and contact evaluations, with it / without it). Green means that every claim passes, or every \
             probe stays, without it. For a disabled effect: = if it changes no bit, ≠ if it does."
        }
        (table.page("heat"))
    }
}

fn warmth(entry: &Entry) -> Markup {
    if !entry.on {
        return html! { @if entry.worth == EffectResult::NotInert { b.f0 { "≠" } } @else { "=" } };
    }
    let change = median(entry).and_then(change);
    let class = match (entry.worth, change) {
        (EffectResult::NotWorthSimulating, _) => "c0",
        (EffectResult::Needed, Some(change)) if change <= 0.01 => "k0",
        (EffectResult::Needed, Some(change)) if change <= 0.5 => "k1",
        (EffectResult::Needed, _) => "k2",
        _ => "cannot",
    };
    html! {
        div class=(class) {
            b { (change.map_or_else(|| "no value".to_owned(), number::fraction)) }
            @if let Some(counts) = entry.counts { span.fine { "× " (number::significant(counts, 3)) } }
        }
    }
}

/// Returns a table of the results, with the key or the solvers of each effect.
pub(super) fn results_table(ledger: &[Entry]) -> Table<'_> {
    let row = |entry: &Entry| {
        let key = if entry.on { entry.key.clone() } else { entry.tried.join(", ") };
        row![scene_name(&entry.case, &entry.variant), &entry.effect, entry.worth.word(), key]
    };
    let columns = ["Scene", "Effect", "Result", "Enabled by, or tried with"].map(Column::text);
    Table::new("", columns, ledger.iter().map(row))
}

fn table(ledger: &[Entry]) -> Markup {
    let columns = [
        Column::heading("Scene"),
        Column::text("Effect"),
        Column::text("Enabled by"),
        Column::text("Result").class("verdict"),
        Column::text("Largest change without it").class("wide"),
        Column::number("Changed results"),
        Column::number("Counts, with / without"),
        Column::number("CPU time, with / without"),
    ];
    let row = |entry: &Entry| {
        let key = if entry.on { entry.key.clone() } else { format!("disabled; tried with {}", entry.tried.join(", ")) };
        let class = class(entry.worth.severity());
        let result = html! { span class={ "mark " (class) } { (entry.worth.word()) } };
        // The quantity whose error changes most, relative to its tolerance.
        let farthest = entry.shifts.iter().max_by(|a, b| moved(a).total_cmp(&moved(b)));
        let change = farthest.map(|shift| {
            let [with, without] = [shift.with, shift.without].map(number::error);
            let allowed = number::fraction(shift.allowed);
            format!("{}, {}: {with} → {without} (allowed {allowed})", shift.quantity, shift.solver)
        });
        let red = entry.shifts.iter().filter(|shift| shift.red).count();
        let red = entry.on.then(|| format!("{red} of {}", entry.shifts.len()));
        let change = change.or_else(|| entry.detail.clone()).unwrap_or_default();
        let scene = scene_name(&entry.case, &entry.variant);
        row![scene, &entry.effect, key, result, change, red, entry.counts, entry.time].class(class)
    };
    Table::new("All effects", columns, ledger.iter().map(row)).page("rows")
}
