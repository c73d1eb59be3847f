//! Record of a run of an external program, with the probes of the scene that follow from a dump of grains.

use grainbench_scene::dimension::Dimension;
use grainbench_scene::scene::{ProbeTarget, Sampling, Scene};
use grainbench_solver::record::{GrainState, Series, Snapshot, StepState};
use grainbench_solver::recorder::Recorder;
use nalgebra::Vector3;
use std::collections::BTreeMap;

use crate::contacts::{PairForce, PairForces, contacts};
use crate::deck::Stepping;
pub use crate::names::Names;
use crate::names::{AXES, GrainColumns};
use crate::read::digits::Digits;
use crate::read::read_error::ReadError;
use crate::read::snapshot::{Coordinate, DumpSnapshot};

/// Quantities of a scene that follow from a dump.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DumpRecord {
    /// Columns of the probes that follow from the dump.
    pub series: Series,
    /// Uncertainty due to printed digits, for each column and sample.
    pub uncertainty: Vec<Vec<f64>>,
    /// First snapshot with each number increased by the uncertainty of its printed digits; `None` if the digits are
    /// unknown or there are no grains.
    pub shifted_start: Option<Snapshot>,
    /// Requested snapshots, and the first and the last snapshot.
    pub snapshots: Vec<Snapshot>,
}

/// Builder of a record from the snapshots of a dump, added one after the other.
pub struct DumpObserver<'s> {
    scene: &'s Scene,
    /// Scene with a sample at every step, for the recorders.
    sampled: Scene,
    /// Recorders of three variants of the numbers: as printed, increased by their uncertainty, and shifted away from
    /// zero by their uncertainty.
    recorders: [Recorder; 3],
    known: KnownQuantities,
    /// Forces between grains, from a dump of contacts if there is one.
    pub(crate) pairs: PairForces,
    /// Names of columns in dumps of our decks. They apply to wall forces without a name of the user.
    pub(crate) names_of_decks: Names,
    /// Remaining steps at which snapshots are requested, in order.
    due: &'s [u64],
    snapshots: Vec<Snapshot>,
    shifted_start: Option<Snapshot>,
    /// Coordinate z of each grain in its first snapshot (m), for a two-dimensional scene.
    heights: BTreeMap<usize, f64>,
    last: Option<Snapshot>,
}

/// Quantities that are in all snapshots so far.
#[derive(Debug, Clone)]
struct KnownQuantities {
    velocity: bool,
    spin: bool,
    angle: bool,
    /// True for each wall whose forces on the grains are known.
    walls: Vec<bool>,
}

/// Snapshot of a file, with its columns and digits.
struct Frame<'f> {
    file: &'f str,
    snapshot: &'f DumpSnapshot,
    columns: GrainColumns,
    /// Indices of the columns of each wall's force on the grains.
    walls: Vec<[Option<usize>; 3]>,
    /// Printed digits of each column in the whole file. Without them, printed numbers count as exact.
    digits: Option<&'f [Digits]>,
    /// Combined digits of all columns.
    of_file: Digits,
}

impl Frame<'_> {
    /// Returns the uncertainty of a printed number in a column.
    fn uncertainty(&self, column: usize, printed: f64) -> f64 {
        let digits = self.digits.and_then(|digits| digits.get(column));
        digits.map_or(0.0, |digits| digits.uncertainty(printed, &self.of_file))
    }

    fn error(&self, row: usize, expected: String, found: String) -> ReadError {
        self.snapshot.error(self.file, row, expected, found)
    }
}

/// Relative rounding error of a radius or mass that a program computes from another quantity.
const COMPUTED: f64 = 1e-9;

/// Direction in which numbers are shifted by the uncertainty of their printed digits: none, upwards, or away from zero.
#[derive(Clone, Copy)]
enum Shift {
    None,
    Along,
    Outwards,
}

impl<'s> DumpObserver<'s> {
    /// Returns an observer of a scene. For each of the given steps, in order, it keeps the first snapshot at or after
    /// this step. It always keeps the first and the last snapshot.
    #[must_use]
    pub fn new(scene: &'s Scene, snapshot_steps: &'s [u64]) -> Self {
        let sampled =
            Scene { sampling: Sampling::Cycles(1), snapshots: 0, snapshot_times: Vec::new(), ..scene.clone() };
        let recorder = || Recorder::new(&sampled, 1.0, u64::MAX);
        let recorders = [recorder(), recorder(), recorder()];
        let known = KnownQuantities { velocity: true, spin: true, angle: true, walls: vec![true; scene.walls.len()] };
        let (pairs, due, heights) = (PairForces::default(), snapshot_steps, BTreeMap::new());
        let (snapshots, shifted_start, last) = (Vec::new(), None, None);
        let names_of_decks = Names::default();
        Self { scene, sampled, recorders, known, pairs, names_of_decks, due, snapshots, shifted_start, heights, last }
    }

    /// Adds a snapshot of the file `file` at a time (s). `digits` are the printed digits of each column in the whole
    /// file. Without them, printed numbers count as exact.
    ///
    /// # Errors
    /// If the id or the position of a grain is missing, a grain leaves the plane of a two-dimensional scene, or a
    /// radius or mass differs from the scene. If the number of grains is larger than in the scene, or smaller although
    /// the scene removes no grains. If dumps of contacts lack this step.
    pub fn take(
        &mut self,
        file: &str,
        snapshot: &DumpSnapshot,
        names: &Names,
        time: f64,
        digits: Option<&[Digits]>,
    ) -> Result<(), ReadError> {
        let frame = self.frame(file, snapshot, names, digits)?;
        let (columns, axes) = (&frame.columns, self.scene.dimension.count());
        let flat = self.scene.dimension == Dimension::Two;
        let all = |axes: &[Option<usize>]| axes.iter().all(Option::is_some);
        self.known.velocity &= all(&columns.velocity[..axes]);
        self.known.spin &= if flat { columns.spin[2].is_some() } else { all(&columns.spin) };
        self.known.angle &= columns.angle.is_some();
        for (known, wall) in self.known.walls.iter_mut().zip(&frame.walls) {
            *known &= all(&wall[..axes]);
        }
        let order = self.order(&frame)?;
        if !self.pairs.is_empty() && !self.pairs.has(snapshot.step) {
            let expected = format!("a dump with the contacts of step {}", snapshot.step);
            return Err(frame.error(0, expected, "only grains".to_owned()));
        }
        if flat {
            self.check_plane(&frame, &order)?;
        }
        if digits.is_some() {
            self.check_grains(&frame, &order)?;
        }
        let past = self.due.partition_point(|&due| due <= snapshot.step);
        let keep = past > 0 || self.last.is_none();
        self.due = &self.due[past..];
        let shifts = if digits.is_some() { &[Shift::None, Shift::Along, Shift::Outwards][..] } else { &[Shift::None] };
        for (&shift, recorder) in shifts.iter().zip(&mut self.recorders) {
            let value = |row: &[f64], column: Option<usize>, scale: f64| -> f64 {
                let Some((column, value)) = column.and_then(|column| Some((column, *row.get(column)?))) else {
                    return 0.0;
                };
                let unknown = frame.uncertainty(column, value) * scale;
                match shift {
                    Shift::None => 0.0,
                    Shift::Along => unknown,
                    Shift::Outwards => unknown.copysign(value),
                }
            };
            let grains = order.iter().map(|&(place, row)| {
                let (id, grain) = (place as u32 + 1, &self.scene.grains[place]);
                let row = snapshot.row(row);
                let shifted_number = |column: Option<usize>| Some(*row.get(column?)? + value(row, column, 1.0));
                // Values that the file does not contain are NaN, or zero along an axis that the scene lacks.
                let vector = |columns: &[Option<usize>; 3], axes: [bool; 3]| {
                    Vector3::from_fn(|axis, _| {
                        shifted_number(columns[axis]).unwrap_or(if axes[axis] { f64::NAN } else { 0.0 })
                    })
                };
                let position = columns.position.map(|coordinate| {
                    let open = |at: &Coordinate| -> f64 {
                        at.parts().map(|(column, scale)| value(row, Some(column), scale)).sum()
                    };
                    coordinate.map_or(0.0, |at| at.value(row) + open(&at))
                });
                GrainState {
                    position: Vector3::from(position),
                    velocity: vector(&columns.velocity, [true, true, !flat]),
                    spin: vector(&columns.spin, [!flat, !flat, true]),
                    angle: shifted_number(columns.angle),
                    ..GrainState::start(id, grain)
                }
            });
            let mut seen = Snapshot::of_grains(self.scene, snapshot.step, time, grains.collect());
            let id = |grain: usize| columns.id.map_or(1, |id| snapshot.row(order[grain].1)[id] as u64);
            let of_wall = |wall: usize, grain: usize| {
                let row = snapshot.row(order[grain].1);
                let at = frame.walls[wall];
                all(&at[..axes]).then(|| PairForce {
                    force: Vector3::from(at.map(|at| at.and_then(|at| row.get(at)).copied().unwrap_or(0.0))),
                    open: at.iter().map(|&at| value(row, at, 1.0).abs()).sum(),
                })
            };
            let force = |target: ProbeTarget| match target {
                ProbeTarget::Pair(a, b) => self.pairs.on(snapshot.step, id(a), id(b)),
                ProbeTarget::GrainWall(grain, wall) => of_wall(wall, grain),
                _ => None,
            };
            let times = if matches!(shift, Shift::None) { 0.0 } else { 1.0 };
            let contacts_seen = contacts(self.scene, time, snapshot.step, &seen.grains, force, times);
            for (number, wall) in seen.walls.iter_mut().enumerate() {
                let on_grains = (0..order.len()).map(|grain| of_wall(number, grain));
                // The uncertainties of all digits are added to each component.
                let open = |pair_force: PairForce| pair_force.force.add_scalar(times * pair_force.open);
                let sum: Option<Vector3<f64>> = on_grains.map(|pair_force| pair_force.map(open)).sum();
                wall.force = sum.map(|sum| -sum);
            }
            if matches!(shift, Shift::None) {
                self.last = Some(seen.clone());
                if keep {
                    self.snapshots.push(seen.clone());
                }
            }
            if matches!(shift, Shift::Along) && self.shifted_start.is_none() {
                self.shifted_start = Some(seen.clone());
            }
            // Only contacts that probes request are known, so the stored snapshots contain no contacts.
            seen.contacts = Some(contacts_seen);
            recorder.take(&self.sampled, StepState::of_rigid(seen, 0.0));
        }
        Ok(())
    }

    /// Finds the columns of a snapshot. The id and the positions are required.
    fn frame<'f>(
        &self,
        file: &'f str,
        snapshot: &'f DumpSnapshot,
        names: &Names,
        digits: Option<&'f [Digits]>,
    ) -> Result<Frame<'f>, ReadError> {
        let missing = |what: &str| snapshot.missing(file, format!("a column {what}"));
        let columns = GrainColumns::find(snapshot, names);
        if columns.id.is_none() && self.scene.grains.len() > 1 {
            return Err(missing("`id`, because there are several grains"));
        }
        let needed = &columns.position[..self.scene.dimension.count()];
        if let Some(axis) = needed.iter().position(Option::is_none) {
            let name = AXES[axis];
            return Err(missing(&format!("`{}`, `{name}u`, `{name}s` or `{name}su`", names.in_file(name))));
        }
        let of_deck = |name: &str| {
            let mut theirs = self.names_of_decks.0.iter().filter(|(ours, _)| ours == name);
            theirs.find_map(|(_, theirs)| snapshot.column(theirs))
        };
        let force = |name: String| {
            let theirs = names.in_file(&name);
            snapshot.column(theirs).or_else(|| of_deck(&name).filter(|_| theirs == name))
        };
        let of_wall = |name: &str| AXES.map(|axis| force(format!("{name}.force_{axis}")));
        let walls = self.scene.walls.iter().map(|wall| of_wall(&wall.name)).collect();
        let of_file = Digits::all(digits.unwrap_or_default());
        Ok(Frame { file, snapshot, columns, walls, digits, of_file })
    }

    /// Checks that the grains of a two-dimensional scene stay in its plane: the coordinate z is constant, and the
    /// velocity along z and the spins about x and y are zero.
    fn check_plane(&mut self, frame: &Frame<'_>, order: &[(usize, usize)]) -> Result<(), ReadError> {
        let GrainColumns { position, velocity, spin, .. } = &frame.columns;
        let period = self.scene.critical_time_step();
        for &(place, row) in order {
            let (numbers, radius) = (frame.snapshot.row(row), self.scene.grains[place].radius);
            let wrong = |column: usize, expected: f64, found: f64| {
                let name = &frame.snapshot.columns[column].name;
                let expected = format!("grain {} in the plane of the scene, with `{name}` = {expected:?}", place + 1);
                Err(frame.error(row, expected, format!("{found:?}")))
            };
            if let Some(at) = position[2] {
                let height = *self.heights.entry(place).or_insert(at.value(numbers));
                let open = |(column, scale): (usize, f64)| frame.uncertainty(column, numbers[column]) * scale.abs();
                let printed: f64 = at.parts().map(open).sum();
                if (at.value(numbers) - height).abs() > 2.0 * printed + COMPUTED * radius {
                    return wrong(at.column, height, at.value(numbers));
                }
            }
            let speed = velocity.iter().flatten().map(|&at| numbers[at].abs()).fold(radius / period, f64::max);
            for (column, scale) in [(velocity[2], speed), (spin[0], speed / radius), (spin[1], speed / radius)] {
                let Some(at) = column else { continue };
                if numbers[at].abs() > frame.uncertainty(at, numbers[at]) + COMPUTED * scale {
                    return wrong(at, 0.0, numbers[at]);
                }
            }
        }
        Ok(())
    }

    /// Checks that radii and masses of the grains equal those of the scene within the uncertainty of their digits.
    fn check_grains(&self, frame: &Frame<'_>, order: &[(usize, usize)]) -> Result<(), ReadError> {
        let GrainColumns { radius, mass, .. } = frame.columns;
        for &(place, row) in order {
            let grain = &self.scene.grains[place];
            let known = [("radius", "m", radius, grain.radius), ("mass", "kg", mass.map(|at| (at, 1.0)), grain.mass)];
            for (name, unit, column, expected) in known {
                let Some((at, factor)) = column else { continue };
                let Some(&printed) = frame.snapshot.row(row).get(at) else { continue };
                let open = frame.uncertainty(at, printed);
                if (factor * printed - expected).abs() <= factor * open + COMPUTED * expected {
                    continue;
                }
                let column = &frame.snapshot.columns[at].name;
                let expected = format!("the {name} of grain {} as in the scene, {expected:?} {unit}", place + 1);
                return Err(frame.error(row, expected, format!("{:?} {unit} in `{column}`", factor * printed)));
            }
        }
        Ok(())
    }

    /// Returns the index in the scene and the row of each grain in a snapshot. Rows sorted by id are in the order of
    /// the scene. If grains were removed, the id is the index in the scene, counted from 1.
    fn order(&self, frame: &Frame<'_>) -> Result<Vec<(usize, usize)>, ReadError> {
        let Frame { file, snapshot, columns: GrainColumns { id, .. }, .. } = *frame;
        let (rows, grains) = (snapshot.rows(), self.scene.grains.len());
        let may_leave = self.scene.stays.removal.is_some() && rows < grains;
        if rows != grains && !may_leave {
            let expected = format!("{grains} grains, the number in the scene, at step {}", snapshot.step);
            let hint = if rows < grains { " (a scene that grains may leave has `removal`)" } else { "" };
            return Err(frame.error(0, expected, format!("{rows}{hint}")));
        }
        if let Some(id) = id {
            snapshot.check_ids(file, id)?;
        }
        let order = snapshot.rows_by(id).into_iter();
        let Some(id) = id.filter(|_| may_leave) else { return Ok(order.enumerate().collect()) };
        let id = |row: usize| snapshot.row(row)[id];
        let mut there: Vec<(usize, usize)> = Vec::with_capacity(rows);
        for row in order {
            let place = (1..=grains).contains(&(id(row) as usize)).then(|| id(row) as usize - 1);
            match place.filter(|&place| there.last().is_none_or(|&(before, _)| before < place)) {
                Some(place) => there.push((place, row)),
                None => {
                    let expected = format!("each id from 1 to {grains} at most once at step {}", snapshot.step);
                    return Err(frame.error(0, expected, format!("{}", id(row))));
                }
            }
        }
        Ok(there)
    }

    /// Returns the finished record.
    #[must_use]
    pub fn finish(mut self) -> DumpRecord {
        let last = self.last.take().filter(|last| self.snapshots.last().is_none_or(|kept| kept.step != last.step));
        self.snapshots.extend(last);
        let [printed, along, outwards] = self.recorders.map(|recorder| recorder.finish().0);
        let mut observed = DumpRecord {
            series: Series { step: printed.step, time: printed.time, ..Series::default() },
            uncertainty: Vec::new(),
            shifted_start: self.shifted_start,
            snapshots: self.snapshots,
        };
        let shifted = |series: &Series, at: usize, values: &[f64]| -> Vec<f64> {
            let other = series.values[at].iter().copied().chain(std::iter::repeat(f64::NAN));
            values.iter().zip(other).map(|(value, other)| (other - value).abs()).collect()
        };
        for (at, (column, values)) in printed.columns.into_iter().zip(printed.values).enumerate() {
            if !is_known(self.scene, &column.name, &self.known, !self.pairs.is_empty()) {
                continue;
            }
            let (along, outwards) = (shifted(&along, at, &values), shifted(&outwards, at, &values));
            // Without digits, numbers were not shifted, and the uncertainty is zero.
            observed.uncertainty.push(along.iter().zip(&outwards).map(|(a, b)| a.max(*b).max(0.0)).collect());
            observed.series.columns.push(column);
            observed.series.values.push(values);
        }
        observed
    }
}

impl DumpRecord {
    /// Returns a record with the steps and times of all samples, but without columns, for a scene without grains.
    pub(crate) fn without_grains(stepping: &Stepping) -> Self {
        let step: Vec<u64> = stepping.samples().collect();
        let time = step.iter().map(|step| *step as f64 * stepping.time_step).collect();
        let series = Series { step, time, ..Series::default() };
        Self { series, ..Self::default() }
    }

    /// Truncates the record to the first `samples` samples and the snapshots up to the last of them.
    pub fn keep(&mut self, samples: usize) {
        let series = &mut self.series;
        if samples >= series.step.len() {
            return;
        }
        series.step.truncate(samples);
        series.time.truncate(samples);
        series.values.iter_mut().chain(&mut self.uncertainty).for_each(|values| values.truncate(samples));
        let last = series.step.last().copied().unwrap_or_default();
        self.snapshots.retain(|snapshot| snapshot.step <= last);
    }

    /// Adds a column of the scene's series with values from another source, which count as exact. A column that the
    /// scene does not have, or that the record already contains, is ignored.
    pub(crate) fn add(&mut self, scene: &Scene, name: &str, values: Vec<f64>) {
        let columns = Recorder::new(scene, 1.0, 1).finish().0.columns;
        let known = columns.into_iter().find(|column| column.name == name);
        if let Some(column) = known.filter(|_| self.series.column(name).is_none()) {
            self.uncertainty.push(vec![0.0; values.len()]);
            self.series.columns.push(column);
            self.series.values.push(values);
        }
    }
}

/// Returns true if a column of the series follows from the known quantities. `pairs` is true if the forces between grains
/// are known.
fn is_known(scene: &Scene, name: &str, known: &KnownQuantities, pairs: bool) -> bool {
    let Some((probe, quantity)) = name.rsplit_once('.') else { return false };
    match scene.probes.iter().find(|other| other.name == probe).map(|probe| probe.target) {
        Some(ProbeTarget::Grain(_)) => match quantity {
            "x" | "y" | "z" => true,
            "vx" | "vy" | "vz" => known.velocity,
            "angle" => known.angle,
            _ => known.spin && quantity.starts_with("omega"),
        },
        Some(ProbeTarget::Pair(..)) => is_known_of_contact(quantity, pairs),
        Some(ProbeTarget::GrainWall(_, wall)) => is_known_of_contact(quantity, known.walls[wall]),
        Some(ProbeTarget::Wall(wall)) => known.walls[wall],
        Some(ProbeTarget::System) => match quantity {
            "gravitational_energy" => true,
            "kinetic_energy" | "momentum_x" | "momentum_y" | "momentum_z" => known.velocity,
            "rotational_energy" | "largest_spin" => known.spin,
            _ => quantity.starts_with("angular_momentum") && known.velocity && known.spin,
        },
        Some(ProbeTarget::Count) => true,
        _ => false,
    }
}

/// Returns true if a quantity of a contact is known. Overlaps follow from positions. Forces are known if `forces` is
/// true. Slip is never known, because programs do not print it.
fn is_known_of_contact(quantity: &str, forces: bool) -> bool {
    quantity == "overlap" || forces && quantity.ends_with("_force")
}
