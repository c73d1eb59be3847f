//! Conversion of a claim in a file to a claim of the harness.

use super::claims_file::{
    ClaimEntry, ControlEntry, CourseFile, DEM, Formula, Place, ResolutionParameters, SampleReduction, Tier,
};
use super::expression::Expression;
use super::numbers::{Numbers, TIME};
use super::read::{RecordExpression, follow, interpolated};
use super::{kept, wrong};
use crate::registry::read_grains;
use crate::solvers;
use crate::sources::WORKS;
use grainbench_harness::prelude::*;
use grainbench_harness::source::{Kind, Work};
use grainbench_reference::read_table;
use grainbench_scene::text::tamed;
use std::path::Path;

/// Data for the conversion of claims: the case folder and its scene file.
pub(super) struct Reader<'a> {
    /// Folder of the case.
    pub(super) folder: &'a Path,
    /// Scene file.
    pub(super) source: &'a SceneSource,
    /// True if claims that compare each sample get a figure. The registry sets it to false, because its cases have too
    /// many such claims for one page.
    pub(super) plots: bool,
}

impl Reader<'_> {
    /// Converts an entry to one claim for each of its solvers. An error names the key, the expected and the found text.
    pub(super) fn claims(&self, claimed: &ClaimEntry) -> Result<Vec<Claim>, String> {
        let names = claimed.solver.list();
        if names.is_empty() {
            return Err(wrong("solver", "at least one name", "none"));
        }
        if let Some(twice) = names.iter().enumerate().find(|(place, name)| names[..*place].contains(name)) {
            return Err(wrong("solver", "different names", format!("{} twice", quoted(twice.1))));
        }
        names.iter().map(|solver| self.claim(claimed, solver)).collect()
    }

    fn claim(&self, claimed: &ClaimEntry, solver: &str) -> Result<Claim, String> {
        let variant = claimed.variant.as_deref().unwrap_or(PLAIN);
        let source = if variant == PLAIN { self.source.clone() } else { self.source.clone().variant(variant) };
        let in_scene = |error: grainbench_scene::error::SceneError| error.to_string();
        let scene = source.scene(&read_grains).map_err(in_scene)?;
        let numbers = Arc::new(Numbers::new(source.table().map_err(in_scene)?, &scene)?);
        for (key, text) in [("quantity", &claimed.quantity), ("unit", &claimed.unit), ("because", &claimed.because)] {
            in_words(key, text)?;
        }
        let resolution = resolution(&claimed.resolution, solver, &scene)?;
        let run = Run::new(kept(variant.to_owned()), kept(solver.to_owned()), resolution);
        let run = if matches!(claimed.tier, Tier::Standard) { run.slow() } else { run };
        let course = claimed.follows.as_ref().map(|file| self.course(file, &scene)).transpose()?;
        // The claim covers only the times of the table, so its quantity states the first and the last time.
        let words = match course.as_deref() {
            Some([(first, _), .., (last, _)]) => format!("{}, {first} to {last} s", claimed.quantity),
            _ => claimed.quantity.clone(),
        };
        let quantity = claim(words, kept(claimed.unit.clone())).run(run);
        let tolerance = tolerance(claimed, &numbers)?;
        let control = control(&claimed.control, &source, &scene)?;
        let expecting = expecting(quantity, claimed, course, &numbers)?;
        let claim = expecting.within(tolerance).refuses(control);
        let claim = match (&claim.trace, claim.quantity.clone()) {
            (Some(_), words) if self.plots => {
                let plate = ClaimFigure {
                    name: kept(words.replace(|letter: char| !letter.is_alphanumeric(), "-").to_lowercase()),
                    title: kept(words),
                    caption: "",
                    axes: ["time (s)", kept(format!("value ({})", claim.unit))],
                    logarithmic: false,
                };
                let label = claim.runs.first().map_or_else(String::new, |run| run.solver.to_owned());
                claim.drawn(Box::leak(Box::new(plate)), label)
            }
            _ => claim,
        };
        // External solvers with the contact springs of the scene can also run a claim of `dem`, because the name `dem`
        // selects no contact convention of LAMMPS or LIGGGHTS.
        Ok(if solver == DEM { claim.solver_independent_springs() } else { claim })
    }

    /// Reads an expected curve from a table. The times must increase and lie within the run.
    fn course(&self, file: &CourseFile, scene: &Scene) -> Result<Points, String> {
        let table = read_table(&self.folder.join(&file.file)).map_err(|error| error.to_string())?;
        let column = |key: &'static str, name: &str| {
            let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
            let found = table.column(name).map(|at| table.values(at).collect::<Vec<_>>());
            found.ok_or_else(|| wrong(key, format!("one of the columns {}", names.join(", ")), quoted(name)))
        };
        let (time, values) = (column("follows.time", &file.time)?, column("follows.value", &file.value)?);
        if time.len() < 2 || time.windows(2).any(|pair| pair[0] >= pair[1]) {
            return Err(wrong("follows.time", "at least two times that rise", "others"));
        }
        if let Duration::Seconds(end) = scene.duration
            && (time[0] < 0.0 || time[time.len() - 1] > end)
        {
            let found = format!("{} to {} s", time[0], time[time.len() - 1]);
            return Err(wrong("follows.time", format!("times within the run, 0 to {end} s"), found));
        }
        Ok(time.into_iter().zip(values).collect())
    }
}

/// Adds expected value and source to a claim. All solvers record the columns of the scene's probes, so a name that is
/// neither a column nor a number of the scene is an error before the run.
fn expecting(
    quantity: Quantity,
    claimed: &ClaimEntry,
    course: Option<Points>,
    numbers: &Arc<Numbers>,
) -> Result<ClaimWithExpectation, String> {
    let value = expression("value", &claimed.value)?;
    let is_new = |name: &&str| numbers.is_of_record(name) && !numbers.columns.iter().any(|column| column == name);
    if let Some(unknown) = value.names().into_iter().find(is_new) {
        let columns = numbers.columns.join(", ");
        return Err(wrong("value", format!("one of the columns of the record, {columns}"), quoted(unknown)));
    }
    if !value.names().iter().any(|name| numbers.is_of_record(name)) {
        return Err(wrong("value", "a column of the record", "no column, so no result of a run affects the value"));
    }
    let source = source(claimed)?;
    let scale = claimed.scale.as_ref().map(|scale| constant("scale", scale, numbers)).transpose()?;
    if scale.is_some_and(|scale| scale <= 0.0) {
        return Err(wrong("scale", "a number above zero", "another"));
    }
    let over = claimed.over;
    if over.is_some() && claimed.at.is_some() {
        return Err(wrong("at", "only one of `at` and `over`", "both"));
    }
    let equals = claimed.equals.as_ref().map(|formula| formula_of("equals", formula)).transpose()?;
    let follows_time = equals.as_ref().is_some_and(|exact| exact.names().contains(&TIME));
    let read = RecordExpression { value, numbers: Arc::clone(numbers), at: claimed.at, over, follows_time };
    match (equals, course, &claimed.at_least, &claimed.at_most, &claimed.between) {
        (Some(exact), None, None, None, None) => {
            check_names("equals", &exact, numbers, matches!(over, None | Some(SampleReduction::Course)))?;
            let at = |t: f64| value_at(&exact, numbers, t);
            if over != Some(SampleReduction::Course) && scale.is_none() && at(1.0) == 0.0 {
                return Err(wrong("scale", "a number that scales the error, because the exact value is zero", "none"));
            }
            let of_scene = Arc::clone(numbers);
            let exact = move |t: f64| value_at(&exact, &of_scene, t);
            if over == Some(SampleReduction::Course) {
                return Ok(follow(quantity, source, read.samples([f64::NEG_INFINITY, f64::INFINITY]), exact, scale));
            }
            Ok(quantity.equals(source, move |done| {
                let (t, value) = read.one(&done[0])?;
                let expected = exact(t);
                Ok(Measurement::new(value, expected, scale.unwrap_or(expected.abs())))
            }))
        }
        (None, Some(table), None, None, None) => {
            if claimed.at.is_some() || !matches!(over, None | Some(SampleReduction::Course)) {
                return Err(wrong("follows", "every sample", "a moment or a reading `over` samples"));
            }
            let within = [table[0].0, table[table.len() - 1].0];
            let read = RecordExpression { at: None, over: Some(SampleReduction::Course), ..read };
            Ok(follow(quantity, source, read.samples(within), move |t| interpolated(&table, t), scale))
        }
        (None, None, Some(bound), None, None) => {
            let bound = constant("at_least", bound, numbers)?;
            Ok(quantity.at_least(bound, source, read.bounded()?))
        }
        (None, None, None, Some(bound), None) => {
            let bound = constant("at_most", bound, numbers)?;
            Ok(quantity.at_most(bound, source, read.bounded()?))
        }
        (None, None, None, None, Some([low, high])) => {
            let band = [constant("between", low, numbers)?, constant("between", high, numbers)?];
            if band[0] >= band[1] {
                return Err(wrong("between", "the smaller number first", format!("{} and {}", band[0], band[1])));
            }
            Ok(quantity.between(band, source, read.bounded()?))
        }
        _ => Err(wrong("equals", "one of `equals`, `follows`, `at_least`, `at_most`, `between`", "none or several")),
    }
}

fn value_at(expression: &Expression, numbers: &Numbers, t: f64) -> f64 {
    expression.value(&|name| if name == TIME { Some(t) } else { numbers.get(name) })
}

fn expression(key: &'static str, text: &str) -> Result<Expression, String> {
    Expression::read(text).map_err(|error| format!("{key}: {error}"))
}

fn formula_of(key: &'static str, formula: &Formula) -> Result<Expression, String> {
    match formula {
        Formula::Number(value) => Ok(Expression::Number(*value)),
        Formula::Text(text) => expression(key, text),
    }
}

fn check_names(key: &'static str, expression: &Expression, numbers: &Numbers, with_time: bool) -> Result<(), String> {
    let known = |name: &&str| numbers.get(name).is_some() || (with_time && *name == TIME);
    match expression.names().into_iter().find(|name| !known(name)) {
        None => Ok(()),
        Some(unknown) if unknown.starts_with("scene.steps.") => {
            let expected = "`scene.steps.critical_time_step` (other steps depend on the resolution)";
            Err(wrong(key, expected, quoted(unknown)))
        }
        Some(unknown) => {
            let expected = "a key of the scene file, or `scene.` and a key that `grainbench scene` prints";
            Err(wrong(key, expected, quoted(unknown)))
        }
    }
}

/// Evaluates a formula over numbers of the scene. The result must be finite.
fn constant(key: &'static str, formula: &Formula, numbers: &Numbers) -> Result<f64, String> {
    let expression = formula_of(key, formula)?;
    check_names(key, &expression, numbers, false)?;
    let value = value_at(&expression, numbers, f64::NAN);
    if value.is_finite() { Ok(value) } else { Err(wrong(key, "a finite number", value)) }
}

fn tolerance(claimed: &ClaimEntry, numbers: &Numbers) -> Result<Tolerance, String> {
    let allowed = constant("allowed", &claimed.allowed, numbers)?;
    if allowed < 0.0 {
        return Err(wrong("allowed", "zero or more", allowed));
    }
    // A tolerance without names is engineering judgement. A formula over numbers of the scene is computed.
    let follows = !formula_of("allowed", &claimed.allowed)?.names().is_empty();
    Ok(match &claimed.allowed {
        Formula::Text(formula) if follows => computed(allowed, format!("{formula}: {}", claimed.because)),
        _ => judged(allowed, claimed.because.clone()),
    })
}

fn source(claimed: &ClaimEntry) -> Result<Source, String> {
    let printed = |kind: Kind, place: &Place| {
        in_words("work", &place.work)?;
        in_words("place", &place.place)?;
        let known = WORKS.iter().copied().find(|known| known.cited == place.work);
        let work = known.unwrap_or_else(|| Box::leak(Box::new(Work { kind, id: "", cited: kept(place.work.clone()) })));
        Ok(Source::Printed(work, kept(place.place.clone())))
    };
    match (&claimed.derived, &claimed.printed, &claimed.measured, &claimed.prototype) {
        (Some(words), None, None, None) => {
            in_words("derived", words)?;
            Ok(Source::Derived(kept(words.clone())))
        }
        (None, Some(place), None, None) => printed(Kind::Literature, place),
        (None, None, Some(place), None) => printed(Kind::Experiment, place),
        (None, None, None, Some(place)) => printed(Kind::Prototype, place),
        _ => Err(wrong("derived", "one source: `derived`, `printed`, `measured` or `prototype`", "none or several")),
    }
}

fn control(controlled: &ControlEntry, source: &SceneSource, scene: &Scene) -> Result<Control, String> {
    in_words("control.name", &controlled.name)?;
    let set = controlled.set.iter().fold(source.clone(), |source, (key, value)| source.set(key, &value.to_string()));
    let given = set.scene(&read_grains).map_err(|error| wrong("control.set", "another scene", error))?;
    if given == *scene {
        return Err(wrong("control.set", "values that change the scene", "values that change nothing"));
    }
    if given.duration != scene.duration {
        return Err(wrong("control.set", "wrong physics in a run of the same length", "another length"));
    }
    let given = Arc::new(given);
    Ok(Control::scene(kept(controlled.name.clone()), move |scene| (*given).clone_into(scene)))
}

/// Returns the resolution of a solver from the parameters of its method.
fn resolution(knobs: &ResolutionParameters, solver: &str, scene: &Scene) -> Result<Resolution, String> {
    let Some(method) = solvers::by_name(solver).and(Method::from_name(solver)) else {
        return Err(wrong("solver", format!("one of {}", solvers::names().join(", ")), quoted(solver)));
    };
    let ResolutionParameters { time_step_fraction, time_step, cells, points, courant, substeps, iterations } = *knobs;
    let given = [
        ("time_step_fraction", time_step_fraction),
        ("time_step", time_step),
        ("cells", cells),
        ("points", points.map(f64::from)),
        ("courant", courant),
        ("substeps", substeps.map(f64::from)),
        ("iterations", iterations.map(f64::from)),
    ];
    let (own, expected): (&[&str], _) = match method {
        Method::Dem => (&["time_step_fraction", "time_step"], "`time_step_fraction` or `time_step`, above zero"),
        Method::Grid => (&["cells", "points", "courant"], "`cells`, `points` and `courant`, above zero"),
        Method::Rigid => (&["substeps", "iterations"], "`substeps` and `iterations`, above zero"),
    };
    let is_wrong = |(name, value): (&str, Option<f64>)| {
        value.is_some_and(|value| !own.contains(&name) || !value.is_finite() || value <= 0.0)
    };
    if given.into_iter().any(is_wrong) || (time_step.is_some() && time_step_fraction.is_some()) {
        return Err(wrong("resolution", expected, "others"));
    }
    let courant = courant.unwrap_or(Resolution::COURANT);
    if courant >= 1.0 {
        return Err(wrong("resolution.courant", "less than 1", courant));
    }
    match method {
        Method::Dem => {
            let critical = scene.critical_time_step();
            let fraction = time_step_fraction.unwrap_or(Resolution::FRACTION);
            let step = time_step.unwrap_or(fraction * critical);
            if step >= critical {
                return Err(wrong("resolution", format!("less than the critical step, {critical:.6e} s"), step));
            }
            Ok(time_step.map_or(Resolution::CriticalFraction(fraction), Resolution::TimeStep))
        }
        Method::Grid => Ok(Resolution::Grid {
            cells: cells.unwrap_or(Resolution::CELLS),
            points: points.unwrap_or(Resolution::POINTS),
            courant,
        }),
        Method::Rigid => Ok(Resolution::Rigid {
            step: Resolution::RIGID_STEP,
            substeps: substeps.unwrap_or(Resolution::SUBSTEPS),
            iterations: iterations.unwrap_or(Resolution::RIGID_ITERATIONS),
        }),
    }
}

/// Checks that a text fits in a table and on a page: one line, at most 500 bytes, not empty.
fn in_words(key: &'static str, text: &str) -> Result<(), String> {
    const LONGEST: usize = 500;
    let is_plain = !text.trim().is_empty() && text.len() <= LONGEST && tamed(text, |_| false) == text;
    if is_plain { Ok(()) } else { Err(wrong(key, "words on one line", quoted(text))) }
}

fn quoted(text: &str) -> String {
    format!("`{}`", tamed(&text.chars().take(60).collect::<String>(), |_| false))
}
