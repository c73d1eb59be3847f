//! Snapshots from dumps of grains without a scene. Options supply the data that the columns lack.

use std::path::Path;

use grainbench_scene::dimension::GrainShape;
use grainbench_scene::scene::Grain;
use grainbench_solver::record::{GrainState, Snapshot};
use nalgebra::Vector3;

use crate::contacts::contacts_of;
use crate::names::{AXES, GrainColumns, Names};
use crate::read::format::dump::DumpReader;
use crate::read::read_error::{ReadError, quoted};
use crate::read::snapshot::{Coordinate, DumpKind, DumpSnapshot};

/// Options for reading a dump, with data that the dump may lack.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DumpOptions {
    /// Names of columns in the files, if they differ from those of LAMMPS.
    pub names: Names,
    /// Radius of every grain (m), needed if there is neither a column `radius` nor `diameter`.
    pub radius: Option<f64>,
    /// Density of every grain (kg/m³; kg/m² for discs), needed if there is neither a column `mass` nor `density`.
    pub density: Option<f64>,
    /// Time step (s), needed if the file does not contain the time.
    pub time_step: Option<f64>,
    /// True if the grains are discs in the plane z = 0; false for spheres.
    pub plane: bool,
    /// True to read the complete frames of a truncated file.
    pub partial: bool,
}

/// Reader of a dump of grains, and optionally of a dump of their contacts.
pub struct GrainDump {
    grains: DumpReader<'static>,
    contacts: Option<(DumpReader<'static>, String)>,
    file: String,
    beside: DumpOptions,
    /// Error at the position where the dump is truncated, if truncation is allowed.
    pub cut: Option<String>,
    rows: DumpSnapshot,
    entries: DumpSnapshot,
}

impl GrainDump {
    /// Opens a dump of grains, and optionally a dump of their contacts at the same steps.
    ///
    /// # Errors
    /// If a file cannot be opened.
    pub fn open(path: &Path, contacts: Option<&Path>, beside: DumpOptions) -> Result<Self, ReadError> {
        let named = |path: &Path| Ok((DumpReader::open(path)?, path.to_string_lossy().into_owned()));
        Ok(Self {
            grains: DumpReader::open(path)?,
            contacts: contacts.map(named).transpose()?,
            file: path.to_string_lossy().into_owned(),
            beside,
            cut: None,
            rows: DumpSnapshot::default(),
            entries: DumpSnapshot::default(),
        })
    }

    /// Reads the next snapshot. Returns `None` at the end of the dump of grains.
    ///
    /// # Errors
    /// If a file is truncated, has unexpected content or lacks required data, or if contacts are for other steps or
    /// grains.
    pub fn read(&mut self) -> Result<Option<Snapshot>, ReadError> {
        match self.grains.read(&mut self.rows) {
            Ok(true) => {}
            Ok(false) => return Ok(None),
            Err(error) if error.is_cut() && self.beside.partial => {
                self.cut = Some(error.to_string());
                return Ok(None);
            }
            Err(error) => return Err(error),
        }
        if self.rows.kind != DumpKind::Atoms {
            let expected = "a dump of grains with `ITEM: ATOMS` (a dump of contacts is a separate file)";
            return Err(self.rows.error(&self.file, 0, expected, "entries"));
        }
        if let Some(other) = self.rows.units.as_deref().filter(|units| !["si", "lj"].contains(units)) {
            return Err(ReadError::at(&self.file, 1, "the units `si` or `lj`", quoted(other)));
        }
        let columns = self.columns()?;
        let mut grains: Vec<GrainState> =
            (0..self.rows.rows()).map(|row| self.grain(row, &columns)).collect::<Result<_, _>>()?;
        grains.sort_by_key(|grain| grain.id);
        let (low, high) = self.rows.bounds;
        let mut bounds = (Vector3::from(low), Vector3::from(high));
        if self.beside.plane {
            (bounds.0.z, bounds.1.z) = (-0.5, 0.5);
        }
        let time = self.rows.time.or_else(|| Some(self.rows.step as f64 * self.beside.time_step?));
        let mut snapshot = Snapshot {
            step: self.rows.step,
            time: time.unwrap_or(f64::NAN),
            bounds,
            periodic: self.periodic()?,
            grains,
            ..Snapshot::default()
        };
        if let Some((reader, file)) = &mut self.contacts {
            snapshot.contacts = Some(contacts_of(&snapshot, reader, &mut self.entries, file, &self.beside.names)?);
        }
        Ok(Some(snapshot))
    }

    /// Returns true for each periodic axis. Axes coupled by a tilt count as not periodic, because their images are not
    /// shifted by one box length along one axis.
    fn periodic(&self) -> Result<[bool; 3], ReadError> {
        let [xy, xz, yz] = self.rows.tilt.map(|tilt| tilt != 0.0);
        let tilted = [xy || xz, xy || yz, xz || yz];
        let [x, y, z] = self.rows.periodic;
        let is_crossed = [x, y, z].into_iter().zip(tilted).any(|(periodic, tilted)| periodic && tilted);
        if is_crossed && self.contacts.is_some() {
            let expected = "a box with right angles, because contacts cross periodic boundaries";
            return Err(self.rows.error(&self.file, 0, expected, "a tilted box"));
        }
        Ok([x && !tilted[0], y && !tilted[1], z && !tilted[2]])
    }

    /// Returns the columns. The ids and the positions are present.
    fn columns(&self) -> Result<GrainColumns, ReadError> {
        let Self { rows, beside, file, .. } = self;
        let found = GrainColumns::find(rows, &beside.names);
        if found.radius.is_none() && beside.radius.is_none() {
            return Err(rows.missing(file, "a column `radius` or `diameter`, or the option `--radius`"));
        }
        let id = found.id.ok_or_else(|| rows.missing(file, "a column `id`"))?;
        if let Some(axis) = found.position.iter().position(Option::is_none) {
            let name = AXES[axis];
            return Err(rows.missing(file, format!("a column `{name}`, `{name}u`, `{name}s` or `{name}su`")));
        }
        rows.check_ids(file, id)?;
        Ok(found)
    }

    fn grain(&self, row: usize, columns: &GrainColumns) -> Result<GrainState, ReadError> {
        let numbers = self.rows.row(row);
        let fault = |expected: &str, found: f64| Err(self.rows.error(&self.file, row, expected, found.to_string()));
        let GrainColumns { id, kind, radius, mass, density, position, velocity, .. } = columns;
        let id = id.map_or(f64::NAN, |at| numbers[at]);
        if !(1.0..=f64::from(u32::MAX)).contains(&id) {
            return fault("an id from 1 to 4294967295", id);
        }
        let radius = radius.map_or_else(|| self.beside.radius.unwrap_or(f64::NAN), |(at, factor)| factor * numbers[at]);
        if !(radius > 0.0 && radius.is_finite()) {
            return fault("a radius above zero", radius);
        }
        let shape = if self.beside.plane { GrainShape::Disc } else { GrainShape::Sphere };
        let density = density.map(|at| numbers[at]).or(self.beside.density);
        let mass = mass.map(|at| numbers[at]).or_else(|| density.map(|density| shape.mass(radius, density)));
        let coordinate = |at: Option<Coordinate>| at.map_or(f64::NAN, |at| at.value(numbers));
        let mut position = Vector3::from(position.map(coordinate));
        if self.beside.plane {
            position.z = 0.0;
        }
        let velocity = match velocity {
            [Some(_), Some(_), _] => Vector3::from(velocity.map(|at| at.map_or(0.0, |at| numbers[at]))),
            _ => Vector3::repeat(f64::NAN),
        };
        let grain = Grain {
            material: kind.map_or(0, |at| numbers[at].clamp(1.0, 65_535.0) as u16 - 1),
            radius,
            // Values that the file does not contain are NaN.
            mass: mass.unwrap_or(f64::NAN),
            inertia: f64::NAN,
            position,
            velocity,
            spin: Vector3::repeat(f64::NAN),
        };
        Ok(GrainState::start(id as u32, &grain))
    }
}
