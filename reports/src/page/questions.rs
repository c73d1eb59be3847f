//! Three questions on the first screen, each with a figure and a sentence, and the sections with all numbers.

use grainbench_harness::figure::{Drawing, Figure};
use grainbench_harness::verdict::Severity;
use maud::{Markup, PreEscaped, html};

use crate::measured::{AT, Costs, Effects, Hold, Line, Measurements, Stability, Stamp};
use crate::number::{self, TimeUnit};
use crate::plot::graph::{self, Form};
use crate::plot::scale::Scale;
use crate::plot::{self, FONTS, palette};
use crate::report::Report;
use crate::study::cost::TARGETS;
use crate::study::effects::{EffectResult, Entry, change, median};
use crate::study::stability::{HardCaseResult, Hardness};
use crate::study::stability_page::{self, sign};
use crate::study::{cost, effects, stability};
use crate::table::{Cell, Column, Row, Table};
use crate::{distinct, quantile};

/// Size of a graph on the first screen (drawing units).
const FORM: Form = Form { width: 480.0, height: 335.0, legend: false };
/// Smallest and largest change on the axis of the effects figure, as fractions of the scale. Changes beyond them are
/// plotted at the ends.
const CHANGES: [f64; 2] = [1e-5, 10.0];

const QUESTIONS: [(&str, &str); 3] =
    [("costs", "What accuracy costs"), ("stability", "What stays stable"), ("effects", "Which effects matter")];

/// Returns the anchor and the heading of each question for which a measurement is stored, with the stamp of the measurement.
pub(crate) fn stored(measured: &Measurements) -> impl Iterator<Item = (&'static str, &'static str, &Stamp)> {
    let Measurements { cost, stability, effects } = measured;
    let [cost, stability] =
        [cost.as_ref().map(|cost| &cost.stamp), stability.as_ref().map(|stability| &stability.stamp)];
    let stamps = [cost, stability, effects.as_ref().map(|effects| &effects.stamp)];
    QUESTIONS.into_iter().zip(stamps).filter_map(|((id, heading), stamp)| Some((id, heading, stamp?)))
}

/// Renders the three questions of the first screen. `physics` is a table below the first question.
pub(crate) fn render(report: &Report, physics: &Markup) -> Markup {
    let measured = &report.measured;
    html! {
        div.questions {
            @for (id, heading, stamp) in stored(measured) {
                div.question {
                    h2 { a href={ "#" (id) } { (heading) } }
                    @match id {
                        "costs" => { @if let Some(costs) = &measured.cost { (accuracy(report, costs)) } }
                        "stability" => { @if let Some(stability) = &measured.stability { (steps(stability)) } }
                        _ => { @if let Some(effects) = &measured.effects { (changes(effects)) } }
                    }
                    p.note { a href={ "#" (id) } { "All numbers" } " · " (age(stamp)) }
                    @if id == "costs" { (physics) }
                }
            }
        }
    }
}

/// Renders the sections with all numbers on stability and on effects. The section on costs is beside the matrix.
pub(crate) fn sections(measured: &Measurements) -> Markup {
    let stable = measured.stability.as_ref().map(stability_page::tables);
    let effects = measured.effects.as_ref().map(|effects| effects::heat(&effects.ledger));
    html! {
        @if stable.is_some() || effects.is_some() {
            section {
                @for ((id, heading), all) in QUESTIONS[1..].iter().zip([stable, effects]) {
                    // A link to an element within closed details opens them, even without a script.
                    @if let Some(all) = all { details { summary { (heading) ": all numbers" } div id=(id) { (all) } } }
                }
            }
        }
    }
}

/// Renders the date of a measurement, and the solvers that have changed since.
fn age(stamp: &Stamp) -> Markup {
    let changed: Vec<&str> = palette::SOLVERS.into_iter().filter(|solver| stamp.is_old(solver)).collect();
    html! {
        "measured " (stamp.provenance.day())
        @if !changed.is_empty() { "; " span.old { "outdated" } ": " (changed.join(", ")) " changed since" }
    }
}

/// Renders a graph with its legend.
fn drawn(figure: &Figure) -> Markup {
    let Drawing::Graph(graph) = &figure.drawing else { return html! {} };
    let is_drawn = |label: &str| graph.curves.iter().any(|curve| curve.label == label && !curve.points.is_empty());
    html! {
        div.plot { (PreEscaped(plot::markup(&graph::draw_as(&figure.title, graph, FORM)))) }
        p.key {
            @for (label, sample) in graph::keys(graph) { @if is_drawn(label) { span { (sample) " " (label) } } }
        }
    }
}

/// Renders the graph of error against computing time for the example quantity.
fn accuracy(report: &Report, costs: &Costs) -> Markup {
    let Some(diagram) = &costs.example else { return html! {} };
    let mut figure = cost::figure(diagram);
    let section = report.sections.iter().find(|section| section.name == diagram.case);
    let name = section.map_or(diagram.case.as_str(), |section| section.title.as_str());
    figure.title = format!("{name}, {}", diagram.variant);
    let time = |line: &Line| cost::time(diagram, &line.solver, TARGETS[AT]);
    let mut times: Vec<_> = costs.lines.iter().filter_map(|line| Some((&line.solver, time(line)?))).collect();
    times.sort_by(|(_, a), (_, b)| a.total_cmp(b));
    let unit = TimeUnit::of(times.iter().map(|(_, seconds)| *seconds));
    let times: Vec<String> =
        times.into_iter().map(|(solver, seconds)| format!("{solver} {}", unit.with_symbol(seconds))).collect();
    html! {
        (drawn(&figure))
        p {
            "Shortest computing time with an error of at most " (number::fraction(TARGETS[AT])) " of the " (diagram.quantity) ": "
            b { (times.join(", ")) } "."
        }
    }
}

/// Renders the largest stable time steps, and a table of the hard cases. A hard case has its own row if the required property
/// does not hold for a solver at the default time step. The last row counts all other hard cases.
fn steps(stability: &Stability) -> Markup {
    let figure = stability::figures(&stability.limits).into_iter().find(|figure| figure.name == "stable-step-springs");
    let hold = |solver: &&str| stability.lines.iter().find(|line| line.solver == **solver);
    let lines: Vec<&Hold> = palette::SOLVERS.iter().filter_map(hold).collect();
    let found = |case: &str, solver: &str| stability.hard.iter().find(|row| row.case == case && row.solver == solver);
    let severity = |case: &str, line: &Hold| found(case, &line.solver).and_then(HardCaseResult::severity);
    let is_held =
        |case: &str| !lines.iter().any(|line| severity(case, line).is_some_and(|severity| severity != Severity::Green));
    let (held, hard): (Vec<&str>, Vec<&str>) =
        distinct(stability.hard.iter().map(|row| row.case.as_str())).into_iter().partition(|case| is_held(case));
    let columns = [Column::heading("Hard case")].into_iter().chain(lines.iter().map(|line| Column::text(&line.solver)));
    let mark = |case: &str, line: &Hold| {
        let row = found(case, &line.solver);
        let standing = row.map_or(Hardness::Unsupported, |row| row.standing);
        let (symbol, class) = row.map_or(("–", ""), sign);
        Cell::from(html! { span class={ "mark " (class) } title=(standing.word()) { (symbol) } })
    };
    let row = |case: &&str| {
        let marks = lines.iter().map(|line| mark(case, line));
        [Cell::from(case.replace('-', " "))].into_iter().chain(marks).collect::<Row>()
    };
    let total = |line: &&Hold| {
        let found = || held.iter().filter_map(|case| severity(case, line));
        let (holds, asked) = (found().filter(|severity| *severity == Severity::Green).count(), found().count());
        let title = format!("{holds} of {asked} supported");
        Cell::from(html! { span.mark.pass title=(title) { "✓" (holds) @if holds < asked { "/" (asked) } } })
    };
    let totals = [Cell::from(format!("{} other cases", held.len()))].into_iter().chain(lines.iter().map(total));
    let rows = hard.iter().map(row).chain([totals.collect::<Row>()]);
    let table = Table::new("Hard cases by solver", columns, rows);
    html! {
        @if let Some(figure) = &figure { (drawn(figure)) }
        p { (limits(&lines)) }
        (table.page("marks"))
        p.note { "✓ holds · ↓ holds at a smaller time step · ! ends with an error message · ✗ wrong without an error · – \
                  unsupported" }
    }
}

fn limits(lines: &[&Hold]) -> String {
    let range = |[low, high]: [f64; 2]| format!("{}–{}", number::significant(low, 3), number::significant(high, 3));
    let exact: Vec<&&Hold> = lines.iter().filter(|line| line.limit.is_some()).collect();
    let names: Vec<&str> = exact.iter().map(|line| line.solver.as_str()).collect();
    let ends = exact.iter().filter_map(|line| line.limit).map(|(ends, _)| ends);
    let ends = ends.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
    let exact = ends.map(|ends| format!("{} {} of the exact limit", names.join(", "), range(ends)));
    let found = lines.iter().filter_map(|line| {
        let (ends, unit) = line.found.as_ref()?;
        Some(format!("{} {} {unit}, without an exact limit", line.solver, range(*ends)))
    });
    format!("Largest stable step: {}.", exact.into_iter().chain(found).collect::<Vec<_>>().join("; "))
}

/// Renders one row per effect. Each mark shows by how much the results of a scene change without the effect. The row also
/// shows the computing cost of the effect.
fn changes(effects: &Effects) -> Markup {
    const ROW: f64 = 36.0;
    const FRAME: [f64; 2] = [150.0, 400.0];
    let mut names = distinct(effects.ledger.iter().map(|entry| entry.effect.as_str()));
    let entries_of = |name: &str| effects.ledger.iter().filter(move |entry| entry.effect == name).collect::<Vec<_>>();
    let scale = Scale::fit(CHANGES.into_iter(), true, 0.03, 7);
    let across = |value: f64| FRAME[0] + (FRAME[1] - FRAME[0]) * scale.position(value);
    let bottom = 34.0 + ROW * names.len() as f64;
    let marks = |entries: &[&Entry], worth: EffectResult, y: f64| -> String {
        let fails = worth == EffectResult::Needed;
        let shifts = entries.iter().filter(|entry| entry.worth == worth).filter_map(|entry| median(entry));
        // A stored entry contains only one claim, which need not be a claim that fails.
        let places = shifts.filter(|shift| shift.red == fails).filter_map(change);
        places.map(|change| format!("M{:.1} {y}v16", across(change.clamp(CHANGES[0], CHANGES[1])))).collect()
    };
    names.sort_by_key(|name| std::cmp::Reverse(needed(&entries_of(name)).0));
    let most = names.iter().take(3).map(|name| {
        let (count, all) = needed(&entries_of(name));
        format!("without {name} in {count} of {all}")
    });
    let most = most.collect::<Vec<_>>().join(", ");
    let title = "Change of results when an effect is off, by scene";
    html! {
        div.plot {
            svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 480 {}", bottom + 50.0)) width="100%" role="img"
                aria-label=(title) font-family=(FONTS) font-size="14" {
                title { (title) }
                g fill="#222" {
                text x="480" y="17" text-anchor="end" fill="#666" { "cost of the effect" }
                @for tick in scale.ticks().iter().filter(|tick| tick.label.is_some()) {
                    path d=(format!("M{:.1} 26V{bottom}", across(tick.value))) stroke="#ddd" {}
                    text x=(format!("{:.1}", across(tick.value))) y=(bottom + 20.0) text-anchor="middle" {
                        (tick.label.as_deref().unwrap_or_default())
                    }
                }
                path d=(format!("M{} {bottom}H{}", FRAME[0], FRAME[1])) stroke="#222" {}
                @for (at, name) in names.iter().enumerate() {
                    @let (y, entries) = (34.0 + ROW * at as f64, entries_of(name));
                    text x="0" y=(y + 9.0) { (name) }
                    text x="0" y=(y + 24.0) font-size="12" fill="#666" {
                        "needed in " (needed(&entries).0) " of " (needed(&entries).1)
                    }
                    path d=(marks(&entries, EffectResult::Needed, y)) stroke="#222" stroke-width="2" stroke-opacity=".55" {}
                    path d=(marks(&entries, EffectResult::NotWorthSimulating, y + 8.0)) stroke="#d55e00" stroke-width="2" {}
                    text x="480" y=(y + 13.0) text-anchor="end" { (expense(&entries)) }
                }
                text x=(0.5 * (FRAME[0] + FRAME[1])) y=(bottom + 43.0) text-anchor="middle" font-size="15" {
                    "|change| / scale of the answer"
                }
                }
            }
        }
        p.key {
            span { "│ a claim fails without it" } span.amber { span.mark { "╷" } " every claim passes without it" }
        }
        p { "A claim fails " b { (most) } " scenes." }
        p.note {
            "Each mark is the median change in one scene, over the claims that fail, or over all claims if none \
             fails. The cost is the median of the processor time with the effect divided by the time without it, if \
             at least three scenes were measured. Changes below 10⁻⁵ or above 10 are drawn at the ends of the axis."
        }
    }
}

/// Returns the number of scenes in which an effect is needed, and the number of scenes in which it can be judged.
fn needed(entries: &[&Entry]) -> (usize, usize) {
    let count = |worth: EffectResult| entries.iter().filter(|entry| entry.worth == worth).count();
    (count(EffectResult::Needed), count(EffectResult::Needed) + count(EffectResult::NotWorthSimulating))
}

/// Returns the median ratio of processor times with and without an effect; a dash for fewer than three scenes.
fn expense(entries: &[&Entry]) -> String {
    let mut times: Vec<f64> = entries.iter().filter_map(|entry| entry.time).collect();
    let median = quantile(&mut times, 0.5).filter(|_| times.len() >= 3);
    median.map_or_else(|| "—".to_owned(), |time| format!("× {}", number::significant(time, 2)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    #[test]
    fn each_question_has_a_picture_and_a_sentence() {
        let page = render(&sample::report(), &html! {}).into_string();
        for sentence in [
            "Shortest computing time with an error of at most 1\u{202f}% of the velocity: <b>dem 1\u{202f}ms",
            "Largest stable step: dem, lammps 0.995–0.996 of the exact limit; mpm 2.1–2.1 h/c, without an exact limit.",
            "A claim fails <b>without friction in 1 of 1, without gravity in 0 of 1</b> scenes.",
            "dem (and lammps: equal)",
            "fast impact",
        ] {
            assert!(page.contains(sentence), "{sentence} is not in {page}");
        }
        assert_eq!(page.matches("role=\"img\"").count(), 3);
        // No hashes of sources are given, so the costs and the stability limits count as outdated.
        assert_eq!(page.matches("outdated").count(), 2);
    }

    #[test]
    fn what_is_stored_has_the_median_change_of_each_effect() {
        let text = crate::study::kept_text(&sample::effects()).unwrap();
        let study: crate::study::Study = serde_json::from_str(&text).unwrap();
        let changes: Vec<Option<f64>> = study.ledger.iter().map(|entry| change(median(entry)?)).collect();
        assert_eq!(changes, [Some(0.2), Some(1e-7)]);
        assert!(study.ledger.iter().all(|entry| entry.shifts.len() == 1));
    }
}
