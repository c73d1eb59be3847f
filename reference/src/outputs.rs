//! What some program left of a run, in dumps or in one table, read twice: once for what the files are, once for a
//! record.

use std::path::{Path, PathBuf};

use grainbench_scene::record::{Column, Series};
use grainbench_scene::recorder::Recorder;
use grainbench_scene::scene::Scene;

use crate::observer::{Names, Observed, Observer};
use crate::pair_forces::PairForces;
use crate::read::digits::Digits;
use crate::read::log::{Log, read_log};
use crate::read::read_error::{ReadError, one_line, quoted};
use crate::read::snapshot::{DumpKind, DumpSnapshot};
use crate::read::table::{Table, read_table};
use crate::run_files::{RunFile, Snapshots, in_order, kind, shown};

/// Most files that are named one by one.
const MOST_NAMED: usize = 3;

/// Which files, and what they do not say themselves.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    /// Dumps that follow one another, files of VTK's of a moment each or a collection of them, or one table.
    pub files: Vec<PathBuf>,
    /// The log of the run.
    pub log: Option<PathBuf>,
    /// What the columns are called there.
    pub names: Names,
    /// Time step (s), where no file says it.
    pub time_step: Option<f64>,
    /// Most rows that a snapshot of the scene can have; any number where none is said.
    pub most_rows: Option<u64>,
}

/// Why outputs cannot be taken for a run.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// A file is damaged, or lacks something.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// No file says how long a step is.
    #[error("{}: expected times in the file (`ITEM: TIME`), a log that tells the time step, or --dt, found none", one_line(.0))]
    NoTime(String),
    /// Units that scenes are not in.
    #[error("{}: expected the units `si`, or `lj` for a scene without dimensions, found {}", one_line(.0), quoted(.1))]
    Units(String, String),
    /// A dump and its log do not belong together.
    #[error("{}: expected the units {} of the dump, found {}", one_line(.log), quoted(.of_dump), quoted(.of_log))]
    MixedUnits {
        /// The log.
        log: String,
        /// The units of the dump.
        of_dump: String,
        /// Those of the log.
        of_log: String,
    },
    /// Files of different kinds together.
    #[error("{}: expected one table alone, or dumps alone", one_line(.0))]
    MixedFiles(String),
    /// Nothing of the run's grains.
    #[error("{}: expected a dump of grains, found one of other entries only", one_line(.0))]
    NoGrains(String),
}

/// What the files are.
#[derive(Debug, Clone)]
pub struct Outputs {
    sources: Sources,
    /// The dumps and files of a moment, in their order.
    files: Vec<RunFile>,
    /// Of the columns of each, to its end.
    digits: Vec<Vec<Digits>>,
    table: Option<Table>,
    log: Option<Log>,
    /// Time step (s), where it is known.
    time_step: Option<f64>,
    /// Most significant digits of any number.
    significant: u32,
    /// Ids of the grains, in their order.
    ids: Vec<u64>,
}

impl Outputs {
    /// Reads the files to their end and keeps what they show.
    ///
    /// # Errors
    /// A file is damaged, or they do not fit together.
    pub fn survey(sources: Sources) -> Result<Self, OutputError> {
        let log = sources.log.as_deref().map(read_log).transpose()?;
        let mut outputs = Self {
            files: Vec::new(),
            digits: Vec::new(),
            table: None,
            log,
            time_step: None,
            significant: 0,
            ids: Vec::new(),
            sources,
        };
        if let [file] = &outputs.sources.files[..]
            && kind(file)?.is_table()
        {
            let table = read_table(file)?;
            outputs.significant = table.digits().significant();
            outputs.table = Some(table);
            let logged = outputs.log.as_ref().and_then(logged_step);
            let told = outputs.table.as_ref().and_then(|table| table_step(table, &outputs.sources.names));
            outputs.time_step = outputs.sources.time_step.or(logged).or(told);
            return Ok(outputs);
        }
        let (mut first, mut last, mut units) = (None, None, None);
        if let Some(table) = first_table(&outputs.sources.files)? {
            return Err(OutputError::MixedFiles(shown(table)));
        }
        outputs.files = in_order(&outputs.sources.files)?;
        for file in &outputs.files {
            let mut reader = Snapshots::open(file, outputs.sources.most_rows.unwrap_or(u64::MAX))?;
            let mut snapshot = DumpSnapshot::default();
            while reader.read(&mut snapshot)? {
                if snapshot.kind == DumpKind::Atoms && outputs.ids.is_empty() {
                    outputs.ids = ids(&snapshot, &outputs.sources.names);
                }
                if let Some(time) = snapshot.time {
                    first = first.or(Some((snapshot.step, time)));
                    last = Some((snapshot.step, time));
                }
                if let Some(said) = &snapshot.units
                    && units.as_ref() != Some(said)
                {
                    check_units(&file.path, said)?;
                    units = Some(said.clone());
                }
            }
            outputs.significant = outputs.significant.max(snapshot.digits().significant());
            outputs.digits.push(snapshot.columns.iter().map(|column| column.digits).collect());
        }
        share(&mut outputs.digits, outputs.files.iter().all(RunFile::is_of_a_moment));
        if let (Some(of_dump), Some(log), Some(path)) = (&units, &outputs.log, &outputs.sources.log)
            && let Some(of_log) = log.units.as_ref().filter(|of_log| *of_log != of_dump)
        {
            let (of_dump, of_log) = (of_dump.clone(), of_log.clone());
            return Err(OutputError::MixedUnits { log: shown(path), of_dump, of_log });
        }
        let from_times = first.zip(last).and_then(|((step, time), (last_step, last_time))| {
            (last_step > step).then(|| (last_time - time) / (last_step - step) as f64)
        });
        let from_log = outputs.log.as_ref().and_then(logged_step);
        let from_times = from_times.filter(|_| outputs.files.iter().all(RunFile::tells_steps));
        outputs.time_step = outputs.sources.time_step.or(from_log).or(from_times);
        Ok(outputs)
    }

    /// Time step (s), where it is known.
    #[must_use]
    pub fn time_step(&self) -> Option<f64> {
        self.time_step
    }

    /// Most significant digits of any number: the precision that the files were printed with.
    #[must_use]
    pub fn significant_digits(&self) -> u32 {
        self.significant
    }

    /// What a page calls them.
    #[must_use]
    pub fn name(&self) -> String {
        let name = |file: &PathBuf| file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let in_order: Vec<PathBuf> = self.files.iter().map(|file| file.path.clone()).collect();
        let files = if in_order.is_empty() { &self.sources.files } else { &in_order };
        match &files[..] {
            [first, .., last] if files.len() > MOST_NAMED => {
                one_line(&format!("{} … {} ({} files)", name(first), name(last), files.len()))
            }
            files => one_line(&files.iter().map(name).collect::<Vec<_>>().join(", ")),
        }
    }

    /// What they tell of a scene.
    ///
    /// # Errors
    /// They lack a column that the scene's grains need, have another number of grains, or do not say the time.
    pub fn observe(&self, scene: &Scene) -> Result<Observed, OutputError> {
        if let Some(table) = &self.table {
            return self.observe_table(scene, table);
        }
        let mut observer = Observer::new(scene).with_pairs(self.contacts(scene)?);
        let mut last = None;
        let mut any = false;
        for (file, digits) in self.files.iter().zip(&self.digits) {
            let name = shown(&file.path);
            let mut reader = Snapshots::open(file, u64::MAX)?;
            let mut snapshot = DumpSnapshot::default();
            while reader.read(&mut snapshot)? {
                // Where one dump continues another, its first snapshot is the last of that.
                if snapshot.kind == DumpKind::Entries || last == Some(snapshot.step) {
                    continue;
                }
                if let Some(before) = last.filter(|before| snapshot.step < *before) {
                    let expected = format!("a step after {before}, where the file in front of it ends");
                    return Err(ReadError::at(&name, snapshot.first_line, expected, snapshot.step.to_string()).into());
                }
                let time = match (snapshot.time, self.time_step) {
                    (Some(time), _) => time,
                    (None, Some(step)) => snapshot.step as f64 * step,
                    (None, None) => return Err(OutputError::NoTime(name)),
                };
                observer.take(&name, &snapshot, &self.sources.names, time, Some(digits), last.is_none())?;
                last = Some(snapshot.step);
                any = true;
            }
        }
        let named = self.sources.files.first().map(|file| shown(file)).unwrap_or_default();
        if any { Ok(observer.finish()) } else { Err(OutputError::NoGrains(named)) }
    }

    /// What dumps of contacts tell of the pairs that the scene asks for.
    fn contacts(&self, scene: &Scene) -> Result<PairForces, OutputError> {
        let mut pairs = PairForces::of(scene, &self.ids);
        for (file, digits) in self.files.iter().zip(&self.digits) {
            let mut reader = Snapshots::open(file, u64::MAX)?;
            let mut snapshot = DumpSnapshot::default();
            while pairs.is_asked() && reader.read(&mut snapshot)? {
                if snapshot.kind != DumpKind::Entries {
                    break;
                }
                pairs.take(&shown(&file.path), &snapshot, &self.sources.names, Some(digits))?;
            }
        }
        Ok(pairs)
    }

    /// A table has a column `time` (or `t`), and columns called as the scene's probes are; the probe's name may be left
    /// out where only one column of the scene ends so.
    fn observe_table(&self, scene: &Scene, table: &Table) -> Result<Observed, OutputError> {
        let name = shown(&self.sources.files[0]);
        let names = &self.sources.names;
        let time = time_column(table, names);
        let step = table.column(names.of("step"));
        let times: Vec<f64> = match (time, step, self.time_step) {
            (Some(time), _, _) => table.values(time).collect(),
            (None, Some(step), Some(length)) => table.values(step).map(|step| step * length).collect(),
            (None, _, _) => return Err(OutputError::NoTime(name)),
        };
        let steps = match (step, self.time_step) {
            (Some(step), _) => table.values(step).map(|step| step as u64).collect(),
            (None, Some(length)) => times.iter().map(|time| (time / length).round() as u64).collect(),
            (None, None) => (0..times.len() as u64).collect(),
        };
        if let Some(at) = times.windows(2).position(|pair| pair[1] <= pair[0]) {
            let expected = format!("a time after {:?} in row {}", times[at], at + 2);
            return Err(ReadError::at(&name, 1, expected, format!("{:?}", times[at + 1])).into());
        }
        let of_file = table.digits();
        let mut observed = Observed {
            series: Series { step: steps, time: times, ..Series::default() },
            uncertainty: Vec::new(),
            snapshots: Vec::new(),
        };
        let columns = Recorder::new(scene, 1.0, 1).finish().0.columns;
        for Column { name: full, unit } in &columns {
            let short = full.rsplit_once('.').map_or(full.as_str(), |(_, short)| short);
            let alone = columns.iter().filter(|other| other.name.ends_with(&format!(".{short}"))).count() == 1;
            let in_si = format!("{full} ({unit})");
            let found = table.column(names.of(full)).or_else(|| table.column(&in_si));
            let found = found.or_else(|| table.column(names.of(short)).filter(|_| alone));
            let Some(at) = found else { continue };
            let digits = table.columns[at].digits;
            let values: Vec<f64> = table.values(at).collect();
            observed.uncertainty.push(values.iter().map(|value| digits.uncertainty(*value, &of_file)).collect());
            observed.series.columns.push(Column { name: full.clone(), unit: unit.clone() });
            observed.series.values.push(values);
        }
        if observed.series.columns.is_empty() {
            let wanted: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
            let have: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
            let expected = format!("a column such as {}", quoted(&wanted.join(" ")));
            return Err(ReadError::at(&name, 1, expected, quoted(&have.join(" "))).into());
        }
        Ok(observed)
    }
}

/// The column of a table with the times.
fn time_column(table: &Table, names: &Names) -> Option<usize> {
    ["time", "t", "time (s)"].into_iter().find_map(|name| table.column(names.of(name)))
}

/// The time step that a table with steps and times tells.
fn table_step(table: &Table, names: &Names) -> Option<f64> {
    let ends = |column: usize| {
        let mut values = table.values(column);
        values.next().map(|first| values.last().unwrap_or(first) - first)
    };
    let length = ends(time_column(table, names)?)? / ends(table.column(names.of("step"))?)?;
    (length.is_finite() && length > 0.0).then_some(length)
}

/// Files of one moment each show together how their columns were printed.
fn share(digits: &mut [Vec<Digits>], are_of_a_moment: bool) {
    let Some((first, rest)) = digits.split_first().filter(|_| are_of_a_moment) else { return };
    if rest.iter().any(|of_file| of_file.len() != first.len()) {
        return;
    }
    let all = rest.iter().fold(first.clone(), |all, of_file| all.iter().zip(of_file).map(|(a, b)| a.with(b)).collect());
    digits.fill(all);
}

/// The ids of a snapshot, in their order.
fn ids(snapshot: &DumpSnapshot, names: &Names) -> Vec<u64> {
    let mut ids: Vec<u64> = match snapshot.column(names.of("id")) {
        Some(column) => snapshot.values(column).map(|id| id as u64).collect(),
        None => Vec::new(),
    };
    ids.sort_unstable();
    ids
}

/// The first table among several files.
fn first_table(files: &[PathBuf]) -> Result<Option<&PathBuf>, ReadError> {
    for file in files {
        if kind(file)?.is_table() {
            return Ok(Some(file));
        }
    }
    Ok(None)
}

fn check_units(file: &Path, units: &str) -> Result<(), OutputError> {
    if ["si", "lj"].contains(&units) { Ok(()) } else { Err(OutputError::Units(shown(file), units.to_owned())) }
}

/// The time step that a log tells: of the command, of the column `Dt`, or of the columns `Time` and `Step`.
fn logged_step(log: &Log) -> Option<f64> {
    let of_columns = || {
        let thermo = &log.runs.last()?.thermo;
        let last = |name: &str| thermo.column(name).and_then(|at| thermo.values(at).last());
        last("Dt").or_else(|| {
            let all = |name: &str| -> Option<Vec<f64>> { Some(thermo.values(thermo.column(name)?).collect()) };
            let (time, step) = (all("Time")?, all("Step")?);
            let ends = |list: &[f64]| Some(list.last()? - list.first()?);
            Some(ends(&time)? / ends(&step)?)
        })
    };
    log.time_step.or_else(of_columns).filter(|step| step.is_finite() && *step > 0.0)
}
