//! Outputs of a run as dumps or as one table. The files are read twice: first for their properties, then for a record.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use grainbench_scene::dimension::Dimension;
use grainbench_scene::scene::Scene;
use grainbench_solver::record::{Column, Series};
use grainbench_solver::recorder::Recorder;
use grainbench_solver::resolution::Resolution;

use crate::clock::Clock;
use crate::contacts::PairForces;
use crate::deck::{Deck, Program, logged, write_deck};
use crate::names::{GrainColumns, Names, OURS};
use crate::observer::{DumpObserver, DumpRecord};
use crate::read::digits::Digits;
use crate::read::format::{RunFile, Snapshots, format_of, in_order, shown};
use crate::read::lines::opened;
use crate::read::log::{Log, parse_log};
use crate::read::number_table::{Table, quoted_names};
use crate::read::read_error::{ReadError, one_line, quoted};
use crate::read::snapshot::{DumpKind, DumpSnapshot, Numbering};
use crate::read::table::read_table;

pub use crate::read::format::is_of_a_run;

/// Maximum number of files that are all named in reports. For more files, only the first and the last are named.
const MOST_NAMED: usize = 3;

/// Files of a run, and options with data that the files lack.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    /// Output files: consecutive dumps, files with one moment each (VTK, grain tables), a collection of such files, or
    /// one table.
    pub files: Vec<PathBuf>,
    /// Log of the run.
    pub log: Option<PathBuf>,
    /// Names of columns in the files that differ from those of LAMMPS.
    pub names: Names,
    /// Time step (s); required if no file contains the time step or times.
    pub time_step: Option<f64>,
    /// Time between frames (s); required if files are numbered by frames and contain no times.
    pub frame_interval: Option<f64>,
    /// Maximum number of rows in a snapshot; `None` for no limit.
    pub most_rows: Option<u64>,
    /// True to read the complete frames of a truncated file.
    pub partial: bool,
    /// True to count steps and times from the first sample.
    pub from_first: bool,
    /// Steps at which snapshots are requested, in ascending order. For each, the first snapshot at or after this step
    /// is kept. The first and the last snapshot of the files are always kept.
    pub snapshot_steps: Vec<u64>,
}

/// Error of reading outputs as a run.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// A file is damaged or incomplete.
    #[error(transparent)]
    Read(ReadError),
    /// A file is truncated, for example because a job was killed.
    #[error("{0} (--partial judges the complete frames before it)")]
    Cut(ReadError),
    /// The files or options are not consistent, have unsupported units, or lack grains, times or a time step.
    #[error("{0}")]
    Run(String),
}

impl OutputError {
    /// Returns the error of a file that cannot belong to the run, or of an option. `name` is the name of the file or option.
    fn run(name: &str, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self::Run(ReadError::whole(name, expected, found).to_string())
    }

    fn no_grains(name: &str) -> Self {
        Self::run(name, "a dump with grains", "a dump without grains")
    }

    fn no_time(name: &str) -> Self {
        Self::run(name, "times in the file (`ITEM: TIME`), a log with the time step, or --time-step", "none")
    }
}

impl From<ReadError> for OutputError {
    fn from(error: ReadError) -> Self {
        if error.is_cut() { Self::Cut(error) } else { Self::Read(error) }
    }
}

/// Returns the shortest and the longest time step (s) as text, or one value if they are equal.
#[must_use]
pub fn steps_in_words([shortest, longest]: [f64; 2]) -> String {
    if shortest == longest { format!("{shortest} s") } else { format!("{shortest} s to {longest} s") }
}

/// Sample that counts as time 0 if times are counted from the first sample.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Origin {
    /// Step or frame number.
    pub step: u64,
    /// Time (s), if it is known.
    pub time: Option<f64>,
}

/// Outputs of a run with their properties.
#[derive(Debug, Clone, Default)]
pub struct Outputs {
    sources: Sources,
    /// Dumps and files of one moment, sorted by step.
    files: Vec<RunFile>,
    /// Digits of the columns of each file, from all of its snapshots of grains, or of contacts if it has no grains.
    digits: Vec<Vec<Digits>>,
    /// Digits of the columns of each file, from all of its snapshots of contacts.
    contact_digits: Vec<Vec<Digits>>,
    table: Option<Table>,
    /// Names of the columns in all files.
    columns: BTreeSet<String>,
    log: Option<Log>,
    clock: Option<Clock>,
    /// First and last step.
    ends: [u64; 2],
    /// Sample that counts as time 0: the first sample with [`Sources::from_first`], otherwise step 0.
    origin: Origin,
    /// Errors at the positions where files are truncated, if [`Sources::partial`] is set. Only complete frames were read.
    pub cuts: Vec<String>,
    /// Largest number of significant digits of any number, which is the printed precision.
    pub significant_digits: u32,
    /// Ids of the grains in the first snapshot, sorted.
    ids: Vec<u64>,
}

/// Properties of all snapshots, collected over all files.
#[derive(Default)]
struct Survey {
    /// Steps and times (s) of snapshots that contain both.
    timed: Vec<(u64, f64)>,
    units: Option<String>,
    /// Step or frame number and time (s) of the first snapshot of grains.
    first: Option<Origin>,
    /// First and last step.
    ends: Option<[u64; 2]>,
}

impl Outputs {
    /// Reads the files to the end and collects their properties.
    ///
    /// # Errors
    /// If a file is damaged, or if the files are not consistent.
    pub fn survey(sources: Sources) -> Result<Self, OutputError> {
        let log = sources.log.as_ref().map(|path| parse_log(opened(path)?, &shown(path))).transpose()?;
        if let (Some(log), Some(path)) = (&log, &sources.log) {
            log.units.as_deref().map_or(Ok(()), |units| check_units(path, units, &["si", "lj"]))?;
        }
        let of_log = log.as_ref().and_then(Clock::of_log);
        let mut outputs = Self { sources, log, ..Self::default() };
        if let [file] = &outputs.sources.files[..]
            && format_of(file)?.is_none()
        {
            let table = read_table(file)?;
            outputs.significant_digits = table.digits().significant();
            outputs.columns = table.columns.iter().map(|column| column.name.clone()).collect();
            let names = &outputs.sources.names;
            let times = ends(&table, time_column(&table, names));
            let steps = ends(&table, table.column(names.in_file("step")));
            let time_step = times.zip(steps).map(|(times, steps)| (times[1] - times[0]) / (steps[1] - steps[0]));
            let from_table = time_step.filter(|step| step.is_finite() && *step > 0.0).map(Clock::constant);
            outputs.ends = steps.unwrap_or_default().map(|step| step as u64);
            if outputs.sources.from_first {
                outputs.origin = Origin { step: outputs.ends[0], time: times.map(|times| times[0]) };
            }
            outputs.table = Some(table);
            outputs.set_clock(of_log, from_table)?;
            return Ok(outputs);
        }
        for file in &outputs.sources.files {
            if format_of(file)?.is_none() {
                let name = one_line(&shown(file));
                return Err(OutputError::Run(format!("{name}: expected a single table, or only dumps")));
            }
        }
        outputs.files = in_order(&outputs.sources.files)?;
        let mut survey = Survey::default();
        for file in outputs.files.clone() {
            let digits = outputs.look(&file, &mut survey)?;
            outputs.digits.push(digits);
        }
        share(&mut outputs.digits, outputs.files.iter().all(|file| file.is_moment));
        if let (Some(of_dump), Some(log), Some(path)) = (&survey.units, &outputs.log, &outputs.sources.log)
            && let Some(of_log) = log.units.as_ref().filter(|of_log| *of_log != of_dump)
        {
            let expected = format!("the units {} of the dump", quoted(of_dump));
            return Err(OutputError::run(&shown(path), expected, quoted(of_log)));
        }
        outputs.ends = survey.ends.unwrap_or_default();
        outputs.set_clock(of_log, Clock::of_samples(&survey.timed))?;
        if let Some(first) = survey.first.filter(|_| outputs.sources.from_first) {
            let of_clock = || outputs.clock.as_ref().map(|clock| clock.between(0, first.step));
            outputs.origin = Origin { time: first.time.or_else(of_clock), ..first };
        }
        Ok(outputs)
    }

    /// Reads a file to the end. Adds the properties of its snapshots to `survey`, adds the digits of its contacts, and
    /// returns the digits of the columns of its last snapshot.
    fn look(&mut self, file: &RunFile, survey: &mut Survey) -> Result<Vec<Digits>, OutputError> {
        let mut reader = Snapshots::open(file, self.sources.most_rows.unwrap_or(u64::MAX), self.sources.partial)?;
        let (mut snapshot, mut of_contacts) = (DumpSnapshot::default(), Vec::new());
        let digits = |snapshot: &DumpSnapshot| snapshot.columns.iter().map(|column| column.digits).collect();
        while reader.read(&mut snapshot)? {
            let is_new = |name: &&String| !self.columns.contains(*name);
            let new: Vec<String> = snapshot.columns.iter().map(|column| &column.name).filter(is_new).cloned().collect();
            self.columns.extend(new);
            if snapshot.kind == DumpKind::Entries {
                of_contacts = digits(&snapshot);
            } else {
                if self.ids.is_empty() {
                    let column = snapshot.column(self.sources.names.in_file("id"));
                    let ids = column.into_iter().flat_map(|column| snapshot.values(column));
                    self.ids = ids.map(|id| id as u64).collect();
                    self.ids.sort_unstable();
                }
                survey.first.get_or_insert(Origin { step: snapshot.step, time: self.time_in_file(&snapshot) });
            }
            if snapshot.numbering != Numbering::Frames {
                let [first, _] = survey.ends.unwrap_or([snapshot.step; 2]);
                survey.ends = Some([first, snapshot.step]);
            }
            if let Some(time) = snapshot.time.filter(|_| snapshot.numbering == Numbering::Steps) {
                survey.timed.push((snapshot.step, time));
            }
            if let Some(units) = &snapshot.units
                && survey.units.as_ref() != Some(units)
            {
                // Dimensionless units are refused here, because scenes have SI units.
                check_units(&file.path, units, &["si"])?;
                survey.units = Some(units.clone());
            }
        }
        self.cuts.extend(reader.cut);
        self.significant_digits = self.significant_digits.max(snapshot.digits().significant());
        self.contact_digits.push(of_contacts);
        Ok(digits(&snapshot))
    }

    /// Checks that our names in `--map` are known and that the files have columns with the other names. For a table, our
    /// names are not checked, because they may be those of probes.
    ///
    /// # Errors
    /// If a name would have no effect.
    pub fn check_names(&self) -> Result<(), OutputError> {
        let is_ours =
            |name: &str| self.table.is_some() || name.contains('.') || OURS.split(' ').any(|ours| ours == name);
        for (ours, theirs) in &self.sources.names.0 {
            if !is_ours(ours) {
                let expected = format!("one of our names {OURS} or WALL.force_x");
                return Err(OutputError::run("--map", expected, quoted(ours)));
            }
            if !self.columns.contains(theirs) {
                let columns = self.columns.iter().map(String::as_str).collect::<Vec<_>>().join(" ");
                return Err(OutputError::run(
                    "--map",
                    format!("one of the columns {}", quoted(&columns)),
                    quoted(theirs),
                ));
            }
        }
        Ok(())
    }

    /// Sets the time step from the option, the log or the files, in this order. The option must agree with log and
    /// files, and the log with the times of the files.
    fn set_clock(&mut self, of_log: Option<Clock>, of_files: Option<Clock>) -> Result<(), OutputError> {
        let [first, last] = self.ends;
        let given = self.sources.time_step;
        for (clock, tolerance) in [(&of_log, 0.0), (&of_files, 1e-3)] {
            if let (Some(clock), Some(given)) = (clock, given)
                && !clock.is_constant(given, first, last, tolerance)
            {
                let expected = format!("the time step of the files, {}", steps_in_words(clock.range(first, last)));
                return Err(OutputError::run("--time-step", expected, format!("{given} s")));
            }
        }
        let of_both = of_log.as_ref().zip(of_files.as_ref());
        if let Some([of_log, of_files]) =
            of_both.map(|(log, files)| [log, files].map(|clock| clock.between(first, last)))
            && (of_log - of_files).abs() > 1e-3 * of_files
        {
            let log = self.sources.log.as_deref().map(shown).unwrap_or_default();
            let expected = format!("{of_files} s from step {first} to step {last}, as in the files");
            return Err(OutputError::run(&log, expected, format!("{of_log} s; the log belongs to another run")));
        }
        self.clock = given.map(Clock::constant).or(of_log).or(of_files);
        Ok(())
    }

    /// Returns the longest time step (s), if it is known.
    #[must_use]
    pub fn time_step(&self) -> Option<f64> {
        self.time_steps().map(|[_, longest]| longest)
    }

    /// Returns the shortest and the longest time step (s), if they are known.
    #[must_use]
    pub fn time_steps(&self) -> Option<[f64; 2]> {
        self.clock.as_ref().map(|clock| clock.range(self.ends[0], self.ends[1]))
    }

    /// Returns the sample that counts as time 0, or `None` if its time is 0 or, with an unknown time, its step is 0.
    #[must_use]
    pub fn origin(&self) -> Option<Origin> {
        let is_late = self.origin.time.map_or(self.origin.step > 0, |time| time.abs() > 0.0);
        is_late.then_some(self.origin)
    }

    /// Returns the name of the outputs in reports.
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

    /// Returns the quantities of a scene that follow from the files.
    ///
    /// # Errors
    /// If a required column is missing, if the number of grains differs from that of the scene, or if the time is
    /// unknown.
    pub fn observe(&self, scene: &Scene) -> Result<DumpRecord, OutputError> {
        if let Some(table) = &self.table {
            return self.observe_table(scene, table);
        }
        let decks = self.decks(scene);
        let names = decks.iter().flat_map(|deck| deck.names.0.clone()).collect();
        let mut observer = DumpObserver::new(scene, &self.sources.snapshot_steps);
        (observer.pairs, observer.names_of_decks) = (self.contacts(scene)?, Names(names));
        // Number and time (s) of the last snapshot of grains. `before` is the last snapshot of the previous file.
        let mut last: Option<u64> = None;
        let mut last_time = f64::NEG_INFINITY;
        let mut before = DumpSnapshot::default();
        for (file, digits) in self.files.iter().zip(&self.digits) {
            let name = shown(&file.path);
            let mut reader = Snapshots::open(file, u64::MAX, self.sources.partial)?;
            let mut snapshot = DumpSnapshot::default();
            let mut number = None;
            while reader.read(&mut snapshot)? {
                if snapshot.kind == DumpKind::Entries {
                    continue;
                }
                let is_first = number.is_none();
                let number = *number.insert(snapshot.step);
                // If a dump continues another dump, its first snapshot repeats the last snapshot of that dump.
                if last == Some(number) {
                    if is_first {
                        snapshot.check_repeated(&name, &before)?;
                    }
                    continue;
                }
                if let Some(before) = last.filter(|before| number < *before) {
                    let expected = format!("a step after {before}, the last step of the previous file");
                    return Err(ReadError::at(&name, snapshot.first_line, expected, number.to_string()).into());
                }
                let time = self.time(&name, &snapshot)?;
                if time <= last_time {
                    let expected = format!("a time after {last_time:?}, the time of the previous snapshot");
                    return Err(ReadError::at(&name, snapshot.first_line, expected, format!("{time:?}")).into());
                }
                last_time = time;
                snapshot.step = self.step(&snapshot, time);
                observer.take(&name, &snapshot, &self.sources.names, time, Some(digits))?;
                last = Some(number);
                snapshot.step = number;
            }
            if number.is_some() {
                before = snapshot;
            }
        }
        if last.is_none() {
            let named = self.sources.files.first().map(|file| shown(file)).unwrap_or_default();
            return Err(OutputError::no_grains(&named));
        }
        let mut observed = observer.finish();
        self.add_logged(scene, &decks, &mut observed);
        Ok(observed)
    }

    /// Returns our decks for the scene at the time step of the files. Their names of columns apply if one of them wrote
    /// the files.
    fn decks(&self, scene: &Scene) -> Vec<Deck> {
        let Some(step) = self.time_step() else { return Vec::new() };
        let deck = |program| write_deck(scene, &Resolution::TimeStep(step), program).ok();
        Program::ALL.into_iter().filter_map(deck).collect()
    }

    /// Adds the quantities that our deck writes to the log, such as forces on walls. In LIGGGHTS, the force on a mesh is
    /// missing in the first sample, so a deck with meshes is skipped.
    fn add_logged(&self, scene: &Scene, decks: &[Deck], observed: &mut DumpRecord) {
        let is_mesh = |(name, _): &(String, String)| name.ends_with(".stl");
        let Some(log) = &self.log else { return };
        let Some(deck) = decks.iter().find(|deck| !deck.files.iter().any(is_mesh)) else { return };
        let mut series = observed.series.clone();
        series.step.iter_mut().for_each(|step| *step += self.origin.step);
        for (column, values) in logged::read(&deck.logged, log, &series) {
            if values.iter().all(|value| value.is_finite()) {
                observed.add(scene, &column, values);
            }
        }
    }

    /// Returns the time of a snapshot (s), if the file contains it or it follows from the frame interval.
    fn time_in_file(&self, snapshot: &DumpSnapshot) -> Option<f64> {
        let of_frames = || {
            let interval = self.sources.frame_interval.filter(|_| snapshot.numbering != Numbering::Steps)?;
            Some(snapshot.step as f64 * interval)
        };
        snapshot.time.or_else(of_frames)
    }

    /// Returns the time of a snapshot (s), counted from the origin.
    fn time(&self, name: &str, snapshot: &DumpSnapshot) -> Result<f64, OutputError> {
        match (self.time_in_file(snapshot), &self.clock) {
            (Some(time), _) => Ok(time - self.origin.time.unwrap_or_default()),
            (None, _) if snapshot.numbering == Numbering::Frames => {
                Err(OutputError::run(name, "a column `Time` (s) or --frame-interval", "only frame numbers"))
            }
            (None, Some(clock)) => Ok(clock.between(self.origin.step, snapshot.step)),
            (None, None) => Err(OutputError::no_time(name)),
        }
    }

    /// Returns the step of a snapshot, counted from the origin. If its number may be a frame number and its time (s) is
    /// known, the step is computed from the time.
    fn step(&self, snapshot: &DumpSnapshot, time: f64) -> u64 {
        let is_told = snapshot.numbering != Numbering::Steps && self.time_in_file(snapshot).is_some();
        match self.time_step().filter(|_| is_told) {
            Some(time_step) => (time / time_step).round() as u64,
            None => snapshot.step - self.origin.step.min(snapshot.step),
        }
    }

    /// Returns the forces between the pairs of grains that probes request, from dumps of contacts.
    fn contacts(&self, scene: &Scene) -> Result<PairForces, OutputError> {
        let mut pairs = PairForces::new(scene, &self.ids);
        for (file, digits) in self.files.iter().zip(&self.contact_digits) {
            let mut reader = Snapshots::open(file, u64::MAX, self.sources.partial)?;
            let mut snapshot = DumpSnapshot::default();
            while pairs.is_asked() && reader.read(&mut snapshot)? {
                if snapshot.kind != DumpKind::Entries {
                    break;
                }
                let name = shown(&file.path);
                snapshot.step = match snapshot.numbering {
                    Numbering::Steps => snapshot.step.saturating_sub(self.origin.step),
                    _ => self.step(&snapshot, self.time(&name, &snapshot)?),
                };
                pairs.take(&name, &snapshot, &self.sources.names, Some(digits))?;
            }
        }
        Ok(pairs)
    }

    /// Reads a table with a column of times or steps, and columns named like those of the scene's probes. The name of
    /// the probe may be omitted if only one column of the scene has this ending.
    fn observe_table(&self, scene: &Scene, table: &Table) -> Result<DumpRecord, OutputError> {
        let name = shown(&self.sources.files[0]);
        let names = &self.sources.names;
        let time = time_column(table, names);
        let step = table.column(names.in_file("step"));
        let first = self.origin.step;
        let times: Vec<f64> = match (time, step, &self.clock) {
            (Some(time), _, _) => {
                let start = self.origin.time.unwrap_or_default();
                table.values(time).map(|time| time - start).collect()
            }
            (None, Some(step), Some(clock)) => {
                table.values(step).map(|step| clock.between(first, step as u64)).collect()
            }
            (None, _, _) => return Err(OutputError::no_time(&name)),
        };
        let steps = match (step, self.time_step()) {
            (Some(step), _) => table.values(step).map(|step| (step as u64).saturating_sub(first)).collect::<Vec<_>>(),
            (None, Some(length)) => times.iter().map(|time| (time / length).round() as u64).collect(),
            (None, None) => (0..times.len() as u64).collect(),
        };
        if let Some((at, pair)) = steps.windows(2).enumerate().find(|(_, pair)| step.is_some() && pair[1] <= pair[0]) {
            let expected = format!("a step after {} in row {}", pair[0] + first, at + 2);
            return Err(ReadError::at(&name, 1, expected, (pair[1] + first).to_string()).into());
        }
        if let Some(at) = times.windows(2).position(|pair| pair[1] <= pair[0]) {
            let expected = format!("a time after {:?} in row {}", times[at], at + 2);
            return Err(ReadError::at(&name, 1, expected, format!("{:?}", times[at + 1])).into());
        }
        let of_file = table.digits();
        let mut observed =
            DumpRecord { series: Series { step: steps, time: times, ..Series::default() }, ..DumpRecord::default() };
        let columns = Recorder::new(scene, 1.0, 1).finish().0.columns;
        for Column { name: full, unit } in &columns {
            let short = full.rsplit_once('.').map_or(full.as_str(), |(_, short)| short);
            let alone = columns.iter().filter(|other| other.name.ends_with(&format!(".{short}"))).count() == 1;
            let in_si = format!("{full} ({unit})");
            let found = table.column(names.in_file(full)).or_else(|| table.column(&in_si));
            let found = found.or_else(|| table.column(names.in_file(short)).filter(|_| alone));
            let Some(at) = found else { continue };
            let digits = table.columns[at].digits;
            let values: Vec<f64> = table.values(at).collect();
            observed.uncertainty.push(values.iter().map(|value| digits.uncertainty(*value, &of_file)).collect());
            observed.series.columns.push(Column { name: full.clone(), unit: unit.clone() });
            observed.series.values.push(values);
        }
        if observed.series.columns.is_empty() {
            let wanted: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
            let expected = format!("a column such as {}", quoted(&wanted.join(" ")));
            return Err(ReadError::at(&name, 1, expected, quoted_names(&table.columns)).into());
        }
        Ok(observed)
    }
}

/// Reads the first sample of a dump into a scene: radii, masses, positions, velocities and spins of the grains, and the
/// bounds of periodic axes. Quantities that the file lacks stay as in the scene. Returns the names of the quantities read.
///
/// # Errors
/// If the file is damaged, contains no grains, or has another number of grains than the scene.
pub fn read_start(file: &Path, names: &Names, scene: &mut Scene) -> Result<Vec<&'static str>, OutputError> {
    let name = shown(file);
    let none = || OutputError::no_grains(&name);
    let files = in_order(&[file.to_owned()])?;
    let mut reader = Snapshots::open(files.first().ok_or_else(none)?, u64::MAX, false)?;
    let mut snapshot = DumpSnapshot::default();
    while snapshot.kind != DumpKind::Atoms || snapshot.columns.is_empty() {
        if !reader.read(&mut snapshot)? {
            return Err(none());
        }
    }
    let columns = GrainColumns::find(&snapshot, names);
    if let Some(id) = columns.id {
        snapshot.check_ids(&name, id)?;
    }
    if snapshot.rows() != scene.grains.len() {
        let expected = format!("{} grains, the number in the scene", scene.grains.len());
        return Err(snapshot.error(&name, 0, expected, snapshot.rows().to_string()).into());
    }
    let order = snapshot.rows_by(columns.id);
    let (axes, shape) = (scene.dimension.count(), scene.grain_shape);
    let mut read = Vec::new();
    let positive = |ours: &str, at: usize, scale: f64, row: usize| {
        let value = scale * snapshot.row(row)[at];
        if value.is_finite() && value > 0.0 {
            return Ok(value);
        }
        Err(snapshot.error(&name, row, format!("a positive {ours}"), format!("{value:?}")))
    };
    if let Some((at, scale)) = columns.radius {
        read.push("radii");
        for (grain, &row) in scene.grains.iter_mut().zip(&order) {
            let density = grain.mass / shape.mass(grain.radius, 1.0);
            grain.radius = positive("radius", at, scale, row)?;
            grain.mass = shape.mass(grain.radius, density);
            grain.inertia = shape.inertia_factor() * grain.mass * grain.radius * grain.radius;
        }
    }
    if let Some(at) = columns.mass {
        read.push("masses");
        for (grain, &row) in scene.grains.iter_mut().zip(&order) {
            grain.mass = positive("mass", at, 1.0, row)?;
            grain.inertia = shape.inertia_factor() * grain.mass * grain.radius * grain.radius;
        }
    }
    let positions = &columns.position[..axes];
    if positions.iter().all(Option::is_some) {
        read.push("positions");
        for (grain, &row) in scene.grains.iter_mut().zip(&order) {
            for (axis, at) in positions.iter().enumerate() {
                grain.position[axis] = at.map_or(0.0, |at| at.value(snapshot.row(row)));
            }
        }
    }
    for (words, columns) in [("velocities", columns.velocity), ("spins", columns.spin)] {
        let range = if words == "spins" && scene.dimension == Dimension::Two { 2..3 } else { 0..axes };
        if !columns[range.clone()].iter().all(Option::is_some) {
            continue;
        }
        read.push(words);
        for (grain, &row) in scene.grains.iter_mut().zip(&order) {
            let vector = if words == "spins" { &mut grain.spin } else { &mut grain.velocity };
            for axis in range.clone() {
                vector[axis] = columns[axis].map_or(0.0, |at| snapshot.row(row)[at]);
            }
        }
    }
    let has_bounds = snapshot.bounds.0 != snapshot.bounds.1;
    if let Some(domain) = scene.domain.as_mut().filter(|domain| has_bounds && domain.periodic.contains(&true)) {
        read.push("box");
        let (low, high) = snapshot.bounds;
        for axis in (0..axes).filter(|&axis| domain.periodic[axis]) {
            (domain.low[axis], domain.high[axis]) = (low[axis], high[axis]);
        }
    }
    Ok(read)
}

/// Returns the index of the column with times, if the table has one.
fn time_column(table: &Table, names: &Names) -> Option<usize> {
    ["time", "t", "time (s)"].into_iter().find_map(|name| table.column(names.in_file(name)))
}

/// Returns the first and the last number of a column, if the table has this column and a row.
fn ends(table: &Table, column: Option<usize>) -> Option<[f64; 2]> {
    let column = column?;
    Some([table.values(column).next()?, table.values(column).last()?])
}

/// If each file has one moment, replaces the digits of all files by their combination, because their columns have the
/// same format.
fn share(digits: &mut [Vec<Digits>], are_of_a_moment: bool) {
    let Some((first, rest)) = digits.split_first().filter(|_| are_of_a_moment) else { return };
    if rest.iter().any(|of_file| of_file.len() != first.len()) {
        return;
    }
    let all = rest.iter().fold(first.clone(), |all, of_file| all.iter().zip(of_file).map(|(a, b)| a.with(b)).collect());
    digits.fill(all);
}

/// Returns an error unless `accepted` contains the units.
fn check_units(file: &Path, units: &str, accepted: &[&str]) -> Result<(), OutputError> {
    if accepted.contains(&units) {
        return Ok(());
    }
    let expected = "the units `si`, or no units if the scene is dimensionless";
    Err(OutputError::Run(format!("{}: expected {expected}; found {}", one_line(&shown(file)), quoted(units))))
}
