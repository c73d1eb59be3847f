//! Resolution of a scene file into a scene. All names are looked up, all numbers are checked, and all grains are
//! placed.

use crate::body::{Settle, Start};
use crate::check::Checker;
use crate::columns::{Chosen, Columns};
use crate::dimension::Dimension;
use crate::dimension::GrainShape;
use crate::error::SceneError;
use crate::file::{DomainSpec, GravitySpec, ManufacturedSpec, PeriodicSpec, SceneFile, SettleSpec};
use crate::manufactured::Manufactured;
use crate::scene::{Domain, Duration, Sampling, Scene, Wall};
use crate::source::SceneSource;
use crate::stays::Stays;
use grains::PlacedGrains;
use indexmap::IndexMap;
use nalgebra::Vector3;
use probes::Names;
use std::ops::Range;
use std::path::Path;

mod bodies;
mod grains;
mod laws;
mod motion;
mod probes;
mod stays;
mod walls;

/// Grain in a data file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FileGrain {
    /// Atom type, from 1.
    pub type_number: u32,
    /// Radius (m).
    pub radius: f64,
    /// Mass (kg).
    pub mass: f64,
    /// Centre (m).
    pub position: Vector3<f64>,
    /// Velocity (m/s).
    pub velocity: Vector3<f64>,
    /// Angular velocity (rad/s).
    pub spin: Vector3<f64>,
}

/// Reader of grains from a data file. Its error states file, line, expected and found value.
pub type ReadGrains<'a> = &'a dyn Fn(&Path) -> Result<Vec<FileGrain>, SceneError>;

/// Refuses a data file, for scenes whose grains are all in the scene file.
///
/// # Errors
/// Always.
pub fn no_data_file(path: &Path) -> Result<Vec<FileGrain>, SceneError> {
    Err(SceneError::of_file(path.display().to_string(), "a scene without data files", "a data file".to_owned()))
}

impl SceneSource {
    /// Returns the resolved scene, with variant and overrides applied and all values checked.
    ///
    /// # Errors
    /// When the scene has an error. The message states file, line, key, expected and found value.
    pub fn scene(&self, read_grains: ReadGrains<'_>) -> Result<Scene, SceneError> {
        let file = self.scene_file()?;
        let dimension = match file.dimension {
            2 => Dimension::Two,
            3 => Dimension::Three,
            other => return Err(self.error("dimension", "2 or 3", &other.to_string(), None)),
        };
        let check = Checker { source: self, dimension };
        Resolver { check, file: &file, read_grains }.scene()
    }
}

impl Scene {
    /// Reads a scene from a text that names no other file. `name` stands for the path of the file in errors.
    ///
    /// # Errors
    /// When the scene has an error.
    pub fn from_text(name: &str, text: &str) -> Result<Self, SceneError> {
        SceneSource::from_text(name, Path::new(""), text).scene(&no_data_file)
    }
}

/// Range of grain indices for each group of the file, by name.
type Groups = IndexMap<String, Range<usize>>;

struct Resolver<'a> {
    check: Checker<'a>,
    file: &'a SceneFile,
    read_grains: ReadGrains<'a>,
}

impl Resolver<'_> {
    fn scene(&self) -> Result<Scene, SceneError> {
        let (check, file) = (&self.check, self.file);
        let grain_shape = self.grain_shape()?;
        let domain = file.domain.as_ref().map(|domain| self.domain(domain)).transpose()?;
        for (name, material) in &file.materials {
            if let Some(density) = material.density {
                check.positive(&format!("materials.{name}.density"), density, "density (kg/m³)")?;
            }
        }
        let PlacedGrains { mut grains, groups, entries, springs } = self.grains(grain_shape, domain.as_ref())?;
        let stays = Stays { entries, removal: self.removal()? };
        self.refuse_lost_pours(&stays, &grains, &groups)?;
        if let Some(domain) = &domain {
            self.refuse_outside(domain, &grains, &groups)?;
        }
        let driven = self.driven(&mut grains, &groups, domain.as_ref())?;
        let mut deformable = self.deformable()?;
        let mut bodies = self.bodies()?;
        let has_bodies = !(grains.is_empty() && bodies.is_empty());
        check.require(has_bodies, "grains", "at least one grain or body", "none")?;
        let mut walls: Vec<Wall> =
            file.walls.iter().map(|(name, wall)| self.wall(name, wall)).collect::<Result<_, _>>()?;
        let materials = self.used_materials(&mut grains, &mut bodies, &mut walls)?;
        let laws = self.laws(&materials, &grains, &bodies, &walls)?;
        let mut place = 0..;
        deformable.retain(|_| place.next().is_some_and(|place| materials.contains(&place)));
        self.refuse_deep_overlap(&grains, &stays, &walls, domain.as_ref(), &groups)?;
        self.refuse_passing(&stays, &driven, &bodies)?;
        self.refuse_other_units(&grains, &walls, domain.as_ref())?;
        let names =
            Names { groups: &groups, grains: &grains, bodies: &bodies, walls: &walls, driven: &driven, stays: &stays };
        let mut spots = Vec::new();
        let probes = file
            .probes
            .iter()
            .map(|(name, probe)| self.probe(name, probe, &names, &mut spots))
            .collect::<Result<_, _>>()?;
        let gravity = self.gravity()?;
        Ok(Scene {
            title: file.title.clone(),
            dimension: check.dimension,
            grain_shape,
            gravity,
            domain,
            global_damping: check.not_negative("global_damping", file.global_damping, "damping (1/s)")?,
            duration: self.duration()?,
            materials: materials.iter().map(|&place| self.material_name(place).to_owned()).collect(),
            laws,
            sampling: self.sampling()?,
            snapshots: file.output.snapshots,
            snapshot_times: self.snapshot_times()?,
            snapshot_contacts: file.output.contacts,
            columns: self.columns()?,
            probes,
            spots,
            deformable,
            start: self.start(gravity)?,
            reference_length: self.reference_length(&grains, &bodies)?,
            grains: grains.into(),
            springs,
            stays,
            bodies,
            walls,
            driven,
        })
    }

    fn grain_shape(&self) -> Result<GrainShape, SceneError> {
        match (self.file.grain_shape, self.check.dimension) {
            (None | Some(GrainShape::Disc), Dimension::Two) => Ok(GrainShape::Disc),
            (None, Dimension::Three) | (Some(GrainShape::Sphere), _) => Ok(GrainShape::Sphere),
            (Some(GrainShape::Disc), Dimension::Three) => {
                Err(self.check.error("grain_shape", "`sphere` in three dimensions", "`disc`"))
            }
        }
    }

    fn gravity(&self) -> Result<Vector3<f64>, SceneError> {
        self.file.gravity.as_ref().map_or(Ok(Vector3::zeros()), |gravity| self.acceleration("gravity", gravity))
    }

    fn acceleration(&self, key: &str, gravity: &GravitySpec) -> Result<Vector3<f64>, SceneError> {
        let check = &self.check;
        match gravity {
            GravitySpec::Vector(values) => check.vector(key, values),
            GravitySpec::Slope(slope) => {
                let part = |part: &str| format!("{key}.{part}");
                let magnitude = check.not_negative(&part("magnitude"), slope.magnitude, "acceleration (m/s²)")?;
                let angle = check.finite(&part("slope_deg"), slope.slope_deg, "angle (degrees)")?.to_radians();
                let (sine, cosine) = libm::sincos(angle);
                let down = match check.dimension {
                    Dimension::Two => Vector3::new(sine, -cosine, 0.0),
                    Dimension::Three => Vector3::new(sine, 0.0, -cosine),
                };
                Ok(down * magnitude)
            }
        }
    }

    fn start(&self, gravity: Vector3<f64>) -> Result<Start, SceneError> {
        let settle = self.file.settle.as_ref().map(|settle| self.settle(settle, gravity)).transpose()?;
        let manufactured = self.file.manufactured.as_ref().map(|motion| self.manufactured(motion)).transpose()?;
        Ok(Start { settle, initial_pressure: self.file.initial_pressure, manufactured })
    }

    fn manufactured(&self, motion: &ManufacturedSpec) -> Result<Manufactured, SceneError> {
        let check = &self.check;
        let given = [("axis-aligned", motion.axis_aligned.is_some()), ("vortex", motion.vortex.is_some())];
        check.exactly_one("manufactured", &given)?;
        if let Some(wave) = &motion.axis_aligned {
            let length = check.positive("manufactured.axis-aligned.length", wave.length, "length (m)")?;
            let key = "manufactured.axis-aligned.amplitude";
            let amplitude = check.not_negative(key, wave.amplitude, "amplitude (m)")?;
            let is_small = amplitude * 2.0 * std::f64::consts::PI < length;
            check.require(is_small, key, "an amplitude below 1/2π of the length", amplitude)?;
            return Ok(Manufactured::AxisAligned { amplitude, length });
        }
        let (amplitude, rate) = motion.vortex.as_ref().map_or((0.0, 0.0), |vortex| (vortex.amplitude, vortex.rate));
        Ok(Manufactured::Vortex {
            amplitude: check.finite("manufactured.vortex.amplitude", amplitude, "angle (rad)")?,
            rate: check.finite("manufactured.vortex.rate", rate, "rate (1/s)")?,
        })
    }

    fn settle(&self, settle: &SettleSpec, gravity: Vector3<f64>) -> Result<Settle, SceneError> {
        let check = &self.check;
        Ok(Settle {
            duration: check.positive("settle.duration", settle.duration, "time (s)")?,
            damping: check.not_negative("settle.damping", settle.damping, "damping (1/s)")?,
            gravity: match &settle.gravity {
                Some(gravity) => self.acceleration("settle.gravity", gravity)?,
                None => gravity,
            },
        })
    }

    fn domain(&self, spec: &DomainSpec) -> Result<Domain, SceneError> {
        let [mut low, mut high] = self.corners("domain", &spec.low, &spec.high)?;
        if self.check.dimension == Dimension::Two {
            (low.z, high.z) = (-0.5, 0.5);
        }
        Ok(Domain { low, high, periodic: self.periodic(&spec.periodic)? })
    }

    fn periodic(&self, spec: &PeriodicSpec) -> Result<[bool; 3], SceneError> {
        let dimensions = self.check.dimension.count();
        let (check, key) = (&self.check, "domain.periodic");
        let mut periodic = [false; 3];
        match spec {
            PeriodicSpec::Each(each) => {
                let is_whole = each.is_empty() || each.len() == dimensions;
                check.require(is_whole, key, format!("{dimensions} values"), format_args!("{each:?}"))?;
                periodic[..each.len()].copy_from_slice(each);
            }
            PeriodicSpec::Named(names) => {
                for &name in names {
                    check.require((name as usize) < dimensions, key, "axes of the scene, `x` or `y`", "`z`")?;
                    periodic[name as usize] = true;
                }
            }
        }
        Ok(periodic)
    }

    fn duration(&self) -> Result<Duration, SceneError> {
        let check = &self.check;
        check.exactly_one(
            "duration",
            &[("duration", self.file.duration.is_some()), ("duration_cycles", self.file.duration_cycles.is_some())],
        )?;
        match (self.file.duration, self.file.duration_cycles) {
            (Some(seconds), _) => Ok(Duration::Seconds(check.positive("duration", seconds, "time (s)")?)),
            (None, Some(0) | None) => Err(check.error("duration_cycles", "at least one cycle", "0")),
            (None, Some(cycles)) => Ok(Duration::Cycles(cycles)),
        }
    }

    fn sampling(&self) -> Result<Sampling, SceneError> {
        let (check, output) = (&self.check, &self.file.output);
        match (output.every, output.every_cycles) {
            (Some(_), Some(_)) => Err(check.error("output", "one of `every` and `every_cycles`", "both")),
            (Some(every), None) => Ok(Sampling::Seconds(check.positive("output.every", every, "time (s)")?)),
            (None, Some(0)) => Err(check.error("output.every_cycles", "at least one cycle", "0")),
            (None, Some(every)) => Ok(Sampling::Cycles(every)),
            (None, None) => Ok(Sampling::Count(200)),
        }
    }

    fn snapshot_times(&self) -> Result<Vec<f64>, SceneError> {
        let end = self.file.duration.unwrap_or(f64::INFINITY);
        let times = &self.file.output.snapshot_times;
        if let Some(outside) = times.iter().find(|&&time| !(time.is_finite() && (0.0..=end).contains(&time))) {
            let expected = format!("times (s) between 0 and the end of the run at {end}");
            return Err(self.check.error("output.snapshot_times", &expected, outside));
        }
        Ok(times.clone())
    }

    fn columns(&self) -> Result<Columns, SceneError> {
        let (check, output) = (&self.check, &self.file.output);
        let chosen = output.columns.clone().unwrap_or_else(|| Columns::USUAL.to_vec());
        if let Some(digits) = output.digits {
            check.require((1..=15).contains(&digits), "output.digits", "1 to 15 digits", digits)?;
        }
        let (key, has_mean) = ("output.mean_every_cycles", chosen.contains(&Chosen::MeanVirial));
        let is_used = output.mean_every_cycles.is_none() || has_mean;
        check.require(is_used, key, "`mean-virial` among the columns", "no column with a mean")?;
        let mean_every = output.mean_every_cycles.unwrap_or(1);
        check.require(mean_every > 0, key, "at least one cycle", "0")?;
        Ok(Columns { chosen, digits: output.digits, mean_every })
    }

    fn material(&self, key: &str, name: &str) -> Result<u16, SceneError> {
        let place = self.check.place_of(key, name, "a material of this scene", self.file.materials.keys())?;
        u16::try_from(place).map_err(|_| self.check.error(key, "at most 65535 materials", place))
    }
}
