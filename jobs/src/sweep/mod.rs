//! Parameter sweeps over keys of a scene, for several solvers and levels.

mod design;
mod file;
pub mod level;
mod look;

use crate::fault::Fault;
use crate::task::{Id, Task};
use file::{File, SolverEntry};
use grainbench_cases::folder::Expression;
use grainbench_cases::registry::{CASES, read_grains};
use grainbench_harness::case::{Case, PLAIN};
use grainbench_harness::run::FinishedRun;
use grainbench_harness::solvers::Solvers;
use grainbench_harness::verdict::Outcome;
use grainbench_reports::study::point::Timing;
use grainbench_reports::sweep::{Factor, PointOutput, Quantity, RunCounts};
use grainbench_scene::error::did_you_mean;
use grainbench_scene::scene::Scene;
use grainbench_scene::source::SceneSource;
use grainbench_scene::text::written;
use grainbench_scene::toml_error::TomlError;
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;
use grainbench_store::key;
use grainbench_store::log::State;
use grainbench_studies::clock;
use grainbench_studies::cost::knobs::nominal_seconds;
use look::{EvaluatedQuantity, EvaluatedRun};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

pub use design::MOST;

/// Time budget (s) for building scenes to estimate run times. When it is spent, further points reuse the last estimate
/// for their solver and level.
const LOOKING: f64 = 6.0;
/// Assumed start-up time of an external program (s).
const START: f64 = 0.3;
/// Assumed ratio of the run time of an external program, without start-up, to that of our solver.
const PROGRAM: f64 = 4.0;
/// Duration of each timing of the reference task, before and after each timed run (s).
const REFERENCE: f64 = 2e-3;

/// Sweep with its scene and design points.
pub struct Sweep {
    /// Path of the sweep file, for error messages.
    name: String,
    file: File,
    points: Vec<Vec<Value>>,
    source: SceneSource,
    /// Path of the scene file; `None` if the scene belongs to a case.
    pub scene_file: Option<PathBuf>,
    looks: Vec<EvaluatedQuantity>,
    levels: Vec<Level>,
    /// Curve on the map.
    line: Option<Expression>,
}

/// One resolution level of a solver, with the scene keys that are changed for it.
struct Level {
    asked: usize,
    resolution: Resolution,
    /// Scene keys whose values are computed from the factors.
    formulas: Vec<(String, Formula)>,
    /// Scene keys with changed values.
    set: Vec<(String, Value)>,
}

/// Formula for the value of a scene key, or a list of formulas for an array.
#[derive(Clone)]
enum Formula {
    One(Expression),
    List(Vec<Self>),
}

impl Formula {
    fn read(value: &toml::Value) -> Result<Self, String> {
        let text = match value {
            toml::Value::Array(list) => return list.iter().map(Self::read).collect::<Result<_, _>>().map(Self::List),
            toml::Value::String(text) => text.clone(),
            other => other.to_string(),
        };
        Expression::read(&text).map(Self::One).map_err(|error| format!("`{text}`: {error}"))
    }

    fn names(&self) -> Vec<&str> {
        match self {
            Self::One(expression) => expression.names(),
            Self::List(list) => list.iter().flat_map(Self::names).collect(),
        }
    }

    fn value(&self, factor_value: &dyn Fn(&str) -> Option<f64>) -> Value {
        match self {
            Self::One(expression) => Value::from(expression.value(factor_value)),
            Self::List(list) => list.iter().map(|formula| formula.value(factor_value)).collect(),
        }
    }
}

impl Sweep {
    /// Returns true if a file is a sweep file, which has a table `factors`.
    #[must_use]
    pub fn is_in(path: &Path) -> bool {
        let table = written(path).ok().and_then(|text| text.parse::<toml::Table>().ok());
        table.is_some_and(|table| table.contains_key("factors"))
    }

    /// Reads a sweep.
    ///
    /// # Errors
    /// The error names the file, the key, what was expected and what was found.
    pub fn read(path: &Path) -> Result<Self, Fault> {
        let input_fault = |(expected, found): (&'static str, String)| Fault::in_file(path, expected, found);
        let text = written(path).map_err(input_fault)?;
        let file: File = toml::from_str(&text).map_err(|error| {
            let TomlError { line, expected, found, .. } = TomlError::new(&text, &error);
            Fault::expected(format!("{}:{line}", path.display()), &expected, found)
        })?;
        let (source, case, scene_file) = scene(path, &file)?;
        let points = design::points(path, &file)?;
        if file.solvers.is_empty() {
            return Err(Fault::at_key(path, "solvers", "at least one solver with its levels", "none"));
        }
        if !(1..=1000).contains(&file.repetitions) {
            return Err(Fault::at_key(path, "repetitions", "a whole number from 1 to 1000", file.repetitions));
        }
        if file.repetitions > 1 && !file.timed {
            return Err(Fault::at_key(path, "repetitions", "1, unless `timed = true`", file.repetitions));
        }
        if let Some(name) = file.map.iter().flatten().find(|name| !file.factors.contains_key(*name)) {
            return Err(Fault::at_key(path, "map", "a factor", format_args!("`{name}`")));
        }
        let mut levels = Vec::new();
        for (place, asked) in file.solvers.iter().enumerate() {
            levels.extend(read_levels(path, &file, (place, asked))?);
        }
        if points.len().checked_mul(levels.len()).is_none_or(|count| count > MOST) {
            return Err(Fault::in_file(path, format!("at most {MOST} points over all levels"), "more"));
        }
        let variant = file.scene.split_once('/').map_or(PLAIN, |(_, variant)| variant).to_owned();
        let gates = file.gates.iter().map(|gate| EvaluatedQuantity::gate(path, gate, (case, &variant)));
        let own = file.record.iter().map(|recorded| EvaluatedQuantity::own(path, recorded));
        let looks = gates.chain(own).collect::<Result<Vec<_>, _>>()?;
        if looks.is_empty() {
            return Err(Fault::at_key(path, "gates, record", "at least one entry of `gates` or `record`", "neither"));
        }
        let name = path.display().to_string();
        let line = read_line(path, &file)?;
        Ok(Self { name, file, points, source, scene_file, looks, levels, line })
    }

    /// Returns true if the sweep measures times.
    #[must_use]
    pub const fn is_timed(&self) -> bool {
        self.file.timed
    }

    /// Returns the solvers of the sweep: names, or paths of manifests of external programs.
    #[must_use]
    pub fn solvers(&self) -> Vec<String> {
        self.file.solvers.iter().map(|asked| asked.solver.clone()).collect()
    }

    /// Returns the files that the scenes of the points refer to: meshes, states and tables of grains.
    ///
    /// # Errors
    /// When the scene file is invalid.
    pub fn files(&self) -> Result<BTreeSet<PathBuf>, Fault> {
        let files = |source: &SceneSource| source.files().map_err(|error| Fault::Input(error.to_string()));
        let mut found: BTreeSet<PathBuf> = files(&self.source)?.into_iter().collect();
        for level in &self.levels {
            for point in &self.points {
                let set = self.set(level, point);
                if set.values().any(|value| !value.is_number()) {
                    found.extend(files(&self.source(&set))?);
                }
            }
        }
        Ok(found)
    }

    /// Returns the hash of the inputs that are common to all points.
    fn common(&self) -> Result<String, Fault> {
        let looks: Vec<String> = self.looks.iter().map(EvaluatedQuantity::identity).collect();
        let files: Vec<String> = self.files()?.iter().map(|path| key::of_file(path)).collect();
        let File { scene, timed, repetitions, .. } = &self.file;
        let text = self.source.text();
        let common = format!("{text}|{scene}|{:?}|{looks:?}|{files:?}|{timed}|{repetitions}", self.source.directory);
        Ok(blake3::hash(common.as_bytes()).to_hex().to_string())
    }

    /// Returns a task for every point, solver and level, with its expected run time.
    ///
    /// # Errors
    /// When the scene of a point is invalid or a quantity contains an unknown name. Scenes are checked until the time
    /// budget is spent.
    pub fn tasks(&self, program: &str, solvers: &dyn Solvers, names: &[String]) -> Result<Vec<Task>, Fault> {
        let common = self.common()?;
        let mut tasks = Vec::with_capacity(self.points.len() * self.levels.len());
        let mut patience = LOOKING;
        for level in &self.levels {
            let name = &names[level.asked];
            let (edition, is_program) = (solvers.edition(name), solvers.is_program(name));
            let step = format!("{:?}", level.resolution);
            let mut seconds = 0.0;
            for (place, point) in self.points.iter().enumerate() {
                let set = self.set(level, point);
                // Scenes are built in the order of the points until the time budget is spent, but at least one for each
                // level. Later points reuse the last estimate.
                if patience > 0.0 || place == 0 {
                    let start = Instant::now();
                    let scene = self.scene(&set)?;
                    if tasks.is_empty() {
                        let (source, is_factor) =
                            (self.source(&set), |name: &str| self.file.factors.contains_key(name));
                        let check =
                            |look: &EvaluatedQuantity| look.check_names(&self.name, (&source, &scene), &is_factor);
                        self.looks.iter().try_for_each(check)?;
                    }
                    let once = nominal_seconds(&scene, &level.resolution);
                    let once = if is_program { START + PROGRAM * once } else { once };
                    seconds = once * f64::from(self.file.repetitions);
                    patience -= start.elapsed().as_secs_f64();
                }
                // Points may differ only in a factor that no key of the scene depends on. An expected value may contain it.
                let key = serde_json::to_string(&(&set, point)).map_err(|error| Fault::Input(error.to_string()))?;
                let id = Id::of_words(program, &["sweep", &common, &key, name, &edition, &step]);
                tasks.push(Task {
                    scene: self.file.scene.clone(),
                    set,
                    solver: self.file.solvers[level.asked].solver.clone(),
                    level: level.resolution.to_string(),
                    repetitions: self.file.repetitions,
                    ..Task::new(id, seconds)
                });
            }
        }
        Ok(tasks)
    }

    /// Returns the changed scene keys and their values for a point and a level.
    fn set(&self, level: &Level, point: &[Value]) -> BTreeMap<String, Value> {
        let mut set = BTreeMap::new();
        for (factor, value) in self.file.factors.values().zip(point) {
            if let Some(key) = &factor.key {
                set.insert(key.clone(), value.clone());
            }
        }
        set.extend(level.set.iter().cloned());
        for (key, formula) in &level.formulas {
            set.insert(key.clone(), formula.value(&|name| self.factor(point, name)));
        }
        set
    }

    /// Returns the value of a factor at a point, or `None` if it is not a number.
    fn factor(&self, point: &[Value], name: &str) -> Option<f64> {
        point.get(self.file.factors.get_index_of(name)?)?.as_f64()
    }

    fn source(&self, set: &BTreeMap<String, Value>) -> SceneSource {
        set.iter().fold(self.source.clone(), |source, (key, value)| source.set(key, &words(value)))
    }

    fn scene(&self, set: &BTreeMap<String, Value>) -> Result<Scene, Fault> {
        let scene = self.source(set).scene(&read_grains);
        scene.map_err(|error| Fault::Input(format!("{}: at one point: {error}", self.name)))
    }

    /// Returns the point and the level of the task with an index, or `None` if there is no such task.
    fn place(&self, place: usize) -> Option<(&[Value], &Level)> {
        let count = self.points.len();
        Some((self.points.get(place % count.max(1))?, self.levels.get(place / count.max(1))?))
    }

    /// Runs the task with the given index.
    #[must_use]
    pub fn run(&self, place: usize, solvers: &dyn Solvers, names: &[String]) -> (State, PointOutput) {
        let broken = |why: String| failed(why, Outcome::Broken, self.looks.len());
        let Some((point, level)) = self.place(place) else { return broken("the sweep has no such point".to_owned()) };
        let Some(solver) = solvers.find(&names[level.asked]) else {
            return broken("there is no such solver".to_owned());
        };
        let source = self.source(&self.set(level, point));
        let scene = match source.scene(&read_grains) {
            Ok(scene) => Arc::new(scene),
            Err(error) => return broken(error.to_string()),
        };
        match self.ran(&scene, &level.resolution, &*solver) {
            Err(error) => failed(error.to_string(), Outcome::from(&error), self.looks.len()),
            Ok((record, timings)) => {
                let ran = ran(&record);
                let done = FinishedRun::new(scene, Arc::new(record));
                let seen = EvaluatedRun { source: &source, done: &done, factor: &|name| self.factor(point, name) };
                let looked = self.looks.iter().map(|look| look.at(&seen)).collect();
                (State::Done, PointOutput { ran: Some(ran), looked, timings, detail: None })
            }
        }
    }

    fn ran(&self, scene: &Scene, level: &Resolution, solver: &dyn Solver) -> Result<(Record, Vec<Timing>), RunError> {
        if !self.file.timed {
            return Ok((solver.run(scene, level, &mut ())?, Vec::new()));
        }
        let mut timings = Vec::new();
        loop {
            let clocked = clock::clocked(REFERENCE, || solver.run(scene, level, &mut ()));
            let record = clocked.done?;
            let wall = record.cost.wall_seconds;
            let start_up = (clocked.wall - wall).max(0.0);
            timings.push(Timing { wall, cpu: clocked.cpu, start_up, reference: clocked.reference });
            if timings.len() >= self.file.repetitions as usize {
                return Ok((record, timings));
            }
        }
    }

    /// Returns the report of the finished tasks. `outputs` has the result of each task, or `None`
    /// if the task is not finished.
    #[must_use]
    pub fn report(
        &self,
        names: &[String],
        provenance: grainbench_reports::Provenance,
        outputs: Vec<Option<PointOutput>>,
    ) -> grainbench_reports::sweep::Sweep {
        let mut points = Vec::new();
        let mut missing = 0;
        for (place, output) in outputs.into_iter().enumerate() {
            let (Some(left), Some((point, level))) = (output, self.place(place)) else {
                missing += 1;
                continue;
            };
            points.push(grainbench_reports::sweep::Point {
                factors: point.to_vec(),
                solver: names[level.asked].clone(),
                resolution: level.resolution.to_string(),
                left,
            });
        }
        let label = |(name, factor): (&String, &file::Factor)| Factor {
            name: name.clone(),
            label: factor.label.clone().unwrap_or_else(|| name.clone()),
        };
        let place = |name: &String| self.file.factors.get_index_of(name).unwrap_or_default();
        grainbench_reports::sweep::Sweep {
            provenance,
            title: self.file.title.clone(),
            about: self.file.about.clone(),
            scene: self.file.scene.clone(),
            factors: self.file.factors.iter().map(label).collect(),
            quantities: self.looks.iter().map(EvaluatedQuantity::quantity).collect::<Vec<Quantity>>(),
            points,
            missing,
            map: self.file.map.as_ref().map(|axes| [place(&axes[0]), place(&axes[1])]),
            line: self.line(),
        }
    }

    /// Returns the curve on the map, sampled between the smallest and the largest value of the first factor.
    fn line(&self) -> Option<grainbench_reports::sweep::Line> {
        const PIECES: u32 = 200;
        let (formula, file, axes) = (self.line.as_ref()?, self.file.line.as_ref()?, self.file.map.as_ref()?);
        let values = self.points.iter().filter_map(|point| self.factor(point, &axes[0]));
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        let at = |piece: u32| low + (high - low) * f64::from(piece) / f64::from(PIECES);
        let points = (0..=PIECES).map(at).map(|x| (x, formula.value(&|name| (name == axes[0]).then_some(x))));
        Some(grainbench_reports::sweep::Line { label: file.label.clone(), points: points.collect() })
    }
}

/// Reads the curve on the map.
fn read_line(path: &Path, file: &File) -> Result<Option<Expression>, Fault> {
    let Some(line) = &file.line else { return Ok(None) };
    let Some(axes) = &file.map else {
        return Err(Fault::at_key(path, "line", "`map`, because the figure needs it", "none"));
    };
    let wrong = |expected: &str, found: String| Fault::at_key(path, "line.formula", expected, found);
    let formula =
        Expression::read(&line.formula).map_err(|error| wrong("arithmetic", format!("`{}`: {error}", line.formula)))?;
    match formula.names().into_iter().find(|name| *name != axes[0]) {
        Some(unknown) => {
            let expected = format!("arithmetic over `{}`, the first factor of the map", axes[0]);
            Err(wrong(&expected, format!("`{unknown}`")))
        }
        None => Ok(Some(formula)),
    }
}

/// Returns the result of a failed task, which has no record.
fn failed(detail: String, outcome: Outcome, looks: usize) -> (State, PointOutput) {
    let looked = grainbench_reports::sweep::QuantityResult::without_value(outcome, None);
    (State::Failed, PointOutput { ran: None, looked: vec![looked; looks], timings: Vec::new(), detail: Some(detail) })
}

fn ran(record: &Record) -> RunCounts {
    let (cost, about) = (&record.cost, &record.provenance);
    RunCounts {
        steps: cost.steps,
        particle_steps: cost.particle_steps,
        contact_evaluations: cost.contact_evaluations,
        node_updates: cost.node_updates,
        time_step: about.time_step,
        wall_seconds: cost.wall_seconds,
    }
}

/// Formats a value as text for a scene key.
fn words(value: &Value) -> String {
    match value {
        Value::Number(number) => number.to_string(),
        other => toml::Value::try_from(other).map_or_else(|_| other.to_string(), |value| value.to_string()),
    }
}

/// Reads the resolution levels of a solver.
fn read_levels(path: &Path, file: &File, (place, asked): (usize, &SolverEntry)) -> Result<Vec<Level>, Fault> {
    let wrong = |key: &str, expected: &str, found: &str| {
        Fault::at_key(path, format_args!("solvers ({}): {key}", asked.solver), expected, found)
    };
    if asked.levels.is_empty() {
        return Err(wrong("levels", "at least one", "none"));
    }
    let mut formulas = Vec::new();
    for (name, value) in flat(&file.formulas).into_iter().chain(flat(&asked.formulas)) {
        let key = format!("formulas.{name}");
        let formula = Formula::read(&value).map_err(|found| wrong(&key, "arithmetic", &found))?;
        if let Some(unknown) = formula.names().into_iter().find(|name| !file.factors.contains_key(*name)) {
            let known: Vec<&str> = file.factors.keys().map(String::as_str).collect();
            let expected = format!("arithmetic over the factors {}", known.join(", "));
            return Err(wrong(&key, &expected, &format!("`{unknown}`")));
        }
        formulas.push((name, formula));
    }
    let set: Vec<(String, Value)> =
        flat(&file.set).into_iter().chain(flat(&asked.set)).map(|(key, value)| (key, design::json(&value))).collect();
    let mut levels: Vec<Level> = Vec::new();
    for words in &asked.levels {
        let resolution = level::read(words).map_err(|expected| wrong("levels", &expected, &format!("`{words}`")))?;
        if !level::fits(&asked.solver, &resolution) {
            let expected = format!("a level of the kind that {} has", asked.solver);
            return Err(wrong("levels", &expected, &format!("`{words}`")));
        }
        let words = resolution.to_string();
        if levels.iter().any(|known| known.resolution.to_string() == words) {
            return Err(wrong("levels", "each level once", &format!("`{words}` again")));
        }
        levels.push(Level { asked: place, resolution, formulas: formulas.clone(), set: set.clone() });
    }
    Ok(levels)
}

/// Flattens nested tables to dotted keys with their values.
fn flat(table: &toml::Table) -> Vec<(String, toml::Value)> {
    let mut found = Vec::new();
    for (key, value) in table {
        match value {
            toml::Value::Table(inner) => {
                found.extend(flat(inner).into_iter().map(|(below, value)| (format!("{key}.{below}"), value)));
            }
            value => found.push((key.clone(), value.clone())),
        }
    }
    found
}

/// Returns the scene text, the case that contains it (`None` for a scene file), and the path of the scene file (`None`
/// for a case).
fn scene(path: &Path, file: &File) -> Result<(SceneSource, Option<&'static Case>, Option<PathBuf>), Fault> {
    let is_file = Path::new(&file.scene).extension().is_some_and(|end| end.eq_ignore_ascii_case("toml"));
    let input_fault = |error: grainbench_scene::error::SceneError| Fault::Input(error.to_string());
    if is_file {
        let place = path.parent().unwrap_or(Path::new("")).join(&file.scene);
        return Ok((SceneSource::read(&place).map_err(input_fault)?, None, Some(place)));
    }
    let (name, variant) = file.scene.split_once('/').map_or((file.scene.as_str(), None), |(a, b)| (a, Some(b)));
    let Some(case) = CASES.iter().copied().find(|case| case.name == name) else {
        let help = did_you_mean(name, CASES.iter().map(|case| case.name)).map(|help| format!(" ({help})"));
        let found = format!("`{name}`{}", help.unwrap_or_default());
        let expected = "a case (`grainbench list`), or a scene file relative to this file";
        return Err(Fault::at_key(path, "scene", expected, found));
    };
    let source = case.source();
    let source = match variant {
        None | Some(PLAIN) => source,
        Some(variant) => source.variant(variant),
    };
    // An unknown variant is reported here, before tasks are made.
    source.scene_file().map_err(input_fault)?;
    Ok((source, Some(case), None))
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_cases::solvers::Registry;
    use std::fs;

    const SCENE: &str = "title = 'drop'
dimension = 3
duration = 0.1
materials.m = { density = 1000.0 }
contacts.c = { between = ['m', 'm'], normal_stiffness = 1e6, normal_damping = 200.0 }
grains.ball = { material = 'm', radius = 0.1, position = [0.3, 0.2, 0.2] }
walls.floor = { material = 'm', mesh = { file = 'f.stl', open = true, unit = 'm' } }
probes.ball = { grain = 'ball' }
";
    const FLOOR: &str = "solid s\nfacet normal 0 0 1\nouter loop\nvertex -5 -5 0\nvertex 5 -5 0\nvertex 0 5 0\nendloop\n\
                         endfacet\nendsolid s\n";
    const SWEEP: &str = "title = 's'
scene = 'scene.toml'
factors.d = { key = 'contacts.c.normal_damping', values = [200.0] }
[[record]]
quantity = 'z'
unit = 'm'
value = 'ball.z'
equals = '0.1*t'
scale = 0.7
at = 0.1
allowed = 0.01
[[solvers]]
solver = 'dem'
levels = ['dt=.1']
";

    /// Returns the id of the only task of the sweep in a folder.
    fn id(folder: &Path) -> Id {
        let sweep = Sweep::read(&folder.join("s.toml")).unwrap();
        sweep.tasks("program", &Registry, &["dem".to_owned()]).unwrap()[0].id
    }

    /// The task id depends on every number that affects the result. A sweep is therefore run again after an edit.
    #[test]
    fn an_edit_of_the_sweep_or_of_a_file_of_the_scene_is_another_task() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
        write("scene.toml", SCENE);
        write("f.stl", FLOOR);
        write("s.toml", SWEEP);
        let whole = id(folder.path());
        assert_eq!(whole, id(folder.path()));
        for (from, to) in [
            ("value = 'ball.z'", "value = '2*ball.z'"),
            ("equals = '0.1*t'", "equals = '0.2*t'"),
            ("equals = '0.1*t'", "equals = 'min(0.1, t)'"),
            ("scale = 0.7", "scale = 7"),
            ("at = 0.1", "at = 0.05"),
            ("at = 0.1", "over = 'max'"),
            ("allowed = 0.01", "allowed = 0.02"),
            ("title = 's'", "title = 's'\ntimed = true"),
        ] {
            assert!(SWEEP.contains(from), "{from}");
            write("s.toml", &SWEEP.replace(from, to));
            assert_ne!(whole, id(folder.path()), "{to}");
        }
        write("s.toml", SWEEP);
        assert_eq!(whole, id(folder.path()));
        // An expected value may contain a factor that does not change the scene.
        write("s.toml", &SWEEP.replace("[[record]]", "factors.e = { values = [1.0, 2.0] }\n[[record]]"));
        let tasks =
            Sweep::read(&folder.path().join("s.toml")).unwrap().tasks("", &Registry, &["dem".to_owned()]).unwrap();
        assert!(tasks.len() == 2 && tasks[0].set == tasks[1].set && tasks[0].id != tasks[1].id);
        write("s.toml", SWEEP);
        write("f.stl", &FLOOR.replace("5 0\n", "5 -0.05\n"));
        assert_ne!(whole, id(folder.path()), "the mesh is another");
        let files = Sweep::read(&folder.path().join("s.toml")).unwrap().files().unwrap();
        assert_eq!(files.into_iter().collect::<Vec<_>>(), [folder.path().join("f.stl")]);
    }
}
