//! Power of a check: the changes of the scene that the given output reveals. Our solver runs the scene with one effect
//! changed, and the result is checked in place of the output.

use super::covered::CheckedOutput;
use super::horizon::{OwnRuns, is_only_mean};
use super::judgement::is_outside;
use super::ours::{convention, is_compared};
use grainbench_harness::compare::peers::together;
use grainbench_harness::evidence::Evidence;
use grainbench_harness::expect::{Bound, ExpectedValue, Measurement};
use grainbench_harness::verdict::{Outcome, Verdict};
use grainbench_reference::observer::DumpRecord;
use grainbench_reports::number;
use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::effect::Effect;
use grainbench_scene::scene::Scene;
use grainbench_solver::record::Series;
use grainbench_solver::recorder::Recorder;

/// Extent of the search for the power of a check.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Power {
    /// No search.
    Off,
    /// The search takes at most three times the work of the comparison with our solvers.
    #[default]
    Limited,
    /// The search tries every effect with every size of change.
    Full,
}

/// Source text that identifies results about power.
pub(super) const SOURCE: &str = "our solver on the scene with one effect changed";
/// Largest work of a limited search, in units of the comparison with our solvers.
const MOST_WORK: u64 = 3;
/// Relative changes of coefficients, from the smallest to the largest.
const SIZES: [f64; 2] = [0.1, 0.25];
/// Largest number of column names in a result.
const MOST_NAMES: usize = 8;

/// Returns true if a result describes the power of a check instead of the output.
#[must_use]
pub fn is_of_power(row: &Verdict) -> bool {
    row.source == SOURCE
}

/// Last words of the detail of a result whose change cannot be detected.
pub(super) const HIDDEN: &str = " cannot be detected in this output";

/// Last words of the detail of a result whose change is detected.
const SEEN: &str = " would be detected in this output";

/// Returns a result about the power of a check as a sentence, without numbers that only a program needs.
#[must_use]
pub fn power_words(row: &Verdict) -> String {
    let detail = row.detail.clone().unwrap_or_default();
    let is_sentence = detail.ends_with(SEEN) || detail.ends_with(HIDDEN);
    if is_sentence { detail } else { format!("{}: {detail}", row.quantity) }
}

/// Effect with changes of increasing size.
struct Family {
    name: String,
    sizes: Vec<Size>,
}

/// Changes of one size. The size is revealed only if each of the changes is revealed.
struct Size {
    /// Relative change.
    amount: f64,
    words: String,
    scenes: Vec<Scene>,
}

/// Search for the changes of the scene that the output reveals.
struct Search<'c> {
    runs: &'c OwnRuns,
    output: &'c CheckedOutput<'c>,
    /// Number of further runs that the work limit permits.
    left: u64,
}

/// Returns one result for each effect that was tried, one for all other effects, and one for all columns that are not
/// compared.
pub(super) fn rows(runs: &OwnRuns, output: &CheckedOutput<'_>, power: Power) -> Vec<Verdict> {
    let left = match power {
        Power::Off => return Vec::new(),
        Power::Limited => MOST_WORK * runs.plan.work(),
        Power::Full => u64::MAX,
    };
    let row = |quantity: &str, because: String| Verdict {
        evidence: Evidence::Invariant,
        source: SOURCE.to_owned(),
        because,
        ..output.row(quantity, "1")
    };
    let mut search = Search { runs, output, left };
    let (mut rows, mut not_tried) = (Vec::new(), Vec::new());
    for family in families(&output.candidate.scene) {
        let name = &family.name;
        let size = match search.smallest(&family) {
            Ok(size) => size,
            Err(why) => {
                not_tried.push(format!("{name} ({why})"));
                continue;
            }
        };
        let sizes: Vec<&str> = family.sizes.iter().map(|size| size.words.as_str()).collect();
        let because =
            format!("our solver ran the scene with this mistake, and was judged as your output: {}", sizes.join(", "));
        let row = row(&format!("{name}: smallest mistake that this output would reveal"), because);
        let largest = family.sizes.last();
        rows.push(match size {
            Some(size) => {
                let most = ExpectedValue::Bound(Bound::AtMost(largest.unwrap_or(size).amount));
                let detail = Some(format!("{name}: {}{SEEN}", size.words));
                Verdict { detail, ..row.judged(&Measurement::new(size.amount, most, 1.0)) }
            }
            None => {
                let words = largest.map_or("any change", |largest| &largest.words);
                row.left(Outcome::NoReference, format!("{name}: {words}{HIDDEN}"))
            }
        });
    }
    if !not_tried.is_empty() {
        let row = row("mistakes not tried", "no comparison was made".to_owned());
        rows.push(row.left(Outcome::NoReference, not_tried.join("; ")));
    }
    rows.extend(unjudged(runs, output).map(|names| {
        let because = "a wrong value in these columns is not detected".to_owned();
        row("columns of probes not judged", because).left(Outcome::NoReference, names)
    }));
    rows
}

/// Returns the names of the columns of the scene's probes that are not compared; `None` if all are compared.
fn unjudged(runs: &OwnRuns, output: &CheckedOutput<'_>) -> Option<String> {
    let columns = Recorder::new(&output.candidate.scene, 1.0, 1).finish().0.columns;
    let is_compared = |name: &str| is_compared(name) || runs.horizon.is_some() && is_only_mean(name);
    let is_judged = |name: &str| is_compared(name) && output.observed.series.column(name).is_some();
    let names: Vec<String> = columns.into_iter().map(|column| column.name).filter(|name| !is_judged(name)).collect();
    let more = names.len().saturating_sub(MOST_NAMES);
    let first = names.iter().take(MOST_NAMES).cloned().collect::<Vec<_>>().join(", ");
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    (!names.is_empty()).then(|| first + &more)
}

impl Search<'_> {
    /// Returns the smallest revealed change, and `None` if even the largest change is hidden. The search begins with the
    /// largest change, because output that hides it also hides smaller ones.
    ///
    /// # Errors
    /// The reason why nothing was tried.
    fn smallest<'f>(&mut self, family: &'f Family) -> Result<Option<&'f Size>, String> {
        let mut smallest = None;
        for size in family.sizes.iter().rev() {
            match self.is_revealed(size) {
                Ok(true) => smallest = Some(size),
                Err(why) if smallest.is_none() => return Err(why),
                Ok(false) | Err(_) => break,
            }
        }
        Ok(smallest)
    }

    fn is_revealed(&mut self, size: &Size) -> Result<bool, String> {
        let OwnRuns { plan, peers, .. } = self.runs;
        for scene in &size.scenes {
            if scene.is_unstable_at(plan.step) {
                return Err("the time step would be at or above the critical one".to_owned());
            }
            let left = self.left.checked_sub(1);
            self.left = left.ok_or_else(|| "the work limit is reached; --power full has no limit".to_owned())?;
            let record = plan.run(scene, convention(&peers[0]), 1)?;
            if !self.is_detected(&record.series) {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Returns true if a run gives a result outside the tolerance in place of the output. The run is compared at the
    /// sample times of the output, for the columns of the output, and with the uncertainty of its printed digits.
    fn is_detected(&self, series: &Series) -> bool {
        let observed = self.output.observed;
        let mut seen = DumpRecord::default();
        (seen.series.step, seen.series.time) = (observed.series.step.clone(), observed.series.time.clone());
        let columns = observed.series.columns.iter().zip(&observed.series.values);
        for ((column, values), open) in columns.zip(&observed.uncertainty) {
            let theirs = together(&observed.series, values, series, &column.name).map(|(_, _, theirs)| theirs);
            if let Some(theirs) = theirs.filter(|theirs| theirs.len() == values.len()) {
                seen.series.columns.push(column.clone());
                seen.series.values.push(theirs);
                seen.uncertainty.push(open.clone());
            }
        }
        let rows = self.runs.compare(&self.output.with(&seen));
        rows.iter().any(|row| row.outcome == Outcome::Fail || is_outside(row))
    }
}

/// Returns the effects of a scene: those whose coefficient can be scaled, and those that can only be removed.
fn families(scene: &Scene) -> Vec<Family> {
    let has = |is_on: &dyn Fn(&ContactLaw) -> bool| scene.laws.iter().flatten().any(is_on);
    let mut families = Vec::new();
    let mut scaled = |name: &str, change: &dyn Fn(&mut ContactLaw, f64)| {
        let with = |factor: f64| changed(scene, |law| change(law, factor));
        let both = |amount: f64| {
            let scenes = vec![with(1.0 - amount), with(1.0 + amount)];
            Size { amount, words: format!("±{}", number::fraction(amount)), scenes }
        };
        families.push(Family { name: name.to_owned(), sizes: SIZES.map(both).into() });
    };
    if has(&|law| law.friction > 0.0) {
        scaled("friction", &|law, factor| law.friction *= factor);
    }
    if has(&|law| law.damping_ratio > 0.0) {
        scaled("restitution", &|law, factor| law.set_restitution((law.restitution() * factor).min(1.0)));
    }
    if has(&|law| law.normal_damping > 0.0 || law.stiffness_damping > 0.0 || law.tangential_damping > 0.0) {
        scaled("contact damping", &|law, factor| {
            (law.normal_damping, law.stiffness_damping) = (law.normal_damping * factor, law.stiffness_damping * factor);
            law.tangential_damping *= factor;
        });
    }
    if has(&|law| law.springs.constants()[0] > 0.0) {
        let with = |factor: f64| changed(scene, |law| law.springs = law.springs.scaled([factor; 2]));
        let words = "stiffness × 2 and ÷ 2".to_owned();
        let size = Size { amount: 1.0, words, scenes: vec![with(0.5), with(2.0)] };
        families.push(Family { name: "stiffness".to_owned(), sizes: vec![size] });
    }
    let is_scaled = |effect: &Effect| matches!(effect, Effect::Friction | Effect::ContactDamping);
    for effect in Effect::switches().filter(|effect| !is_scaled(effect) && effect.is_on(scene)) {
        let mut without = scene.clone();
        effect.switch_off(&mut without);
        let size = Size { amount: 1.0, words: effect.absence().to_owned(), scenes: vec![without] };
        families.push(Family { name: effect.word().to_owned(), sizes: vec![size] });
    }
    families
}

fn changed(scene: &Scene, change: impl Fn(&mut ContactLaw)) -> Scene {
    let mut scene = scene.clone();
    scene.change_laws(change);
    scene
}
