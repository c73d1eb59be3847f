//! From a scene file to a scene: every name looked up, every number checked, every grain placed.

use crate::check::Checker;
use crate::error::SceneError;
use crate::file::{
    ContactSpec, DomainSpec, GrainShape, GrainsSpec, GravitySpec, LawKind, MotionSpec, ProbeSpec, SceneFile, WallSpec,
};
use crate::generate;
use crate::motion::{Moment, Motion, Phase};
use crate::overlap::{self, Deepest};
use crate::scene::{
    ContactLaw, Dimension, Domain, Duration, Grain, Probe, ProbeTarget, Sampling, Scene, Wall, WallShape,
};
use crate::source::SceneSource;
use indexmap::IndexMap;
use nalgebra::Vector3;
use std::f64::consts::PI;
use std::ops::Range;
use std::path::Path;

/// A grain as a data file describes it.
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

/// Reads grains from a data file; the error says file, line, expected and found.
pub type ReadGrains<'a> = &'a dyn Fn(&Path) -> Result<Vec<FileGrain>, String>;

impl SceneSource {
    /// The scene: parsed, with variant and overrides, checked and complete.
    ///
    /// # Errors
    /// When anything in the file is wrong; the error names file, line, key, what was expected and what was found.
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

/// Which grains belong to which group of the file.
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
        let (grains, groups) = self.grains(grain_shape, domain.as_ref())?;
        let walls: Vec<Wall> = file.walls.iter().map(|(name, wall)| self.wall(name, wall)).collect::<Result<_, _>>()?;
        let laws = self.laws(&grains, &walls)?;
        self.refuse_deep_overlap(&grains, &walls, domain.as_ref(), &groups)?;
        let names = Names { groups: &groups, walls: &walls };
        Ok(Scene {
            title: file.title.clone(),
            dimension: check.dimension,
            grain_shape,
            gravity: self.gravity()?,
            domain,
            global_damping: check.not_negative("global_damping", file.global_damping, "damping (1/s)")?,
            duration: self.duration()?,
            materials: file.materials.keys().cloned().collect(),
            laws,
            sampling: self.sampling()?,
            snapshots: file.output.snapshots,
            probes: file
                .probes
                .iter()
                .map(|(name, probe)| self.probe(name, probe, &names))
                .collect::<Result<_, _>>()?,
            grains,
            walls,
        })
    }

    fn grain_shape(&self) -> Result<GrainShape, SceneError> {
        match (self.file.grain_shape, self.check.dimension) {
            (None, Dimension::Two) => Ok(GrainShape::Disc),
            (None, Dimension::Three) | (Some(GrainShape::Sphere), _) => Ok(GrainShape::Sphere),
            (Some(GrainShape::Disc), Dimension::Two) => Ok(GrainShape::Disc),
            (Some(GrainShape::Disc), Dimension::Three) => {
                Err(self.check.error("grain_shape", "`sphere` in three dimensions", "`disc`"))
            }
        }
    }

    fn gravity(&self) -> Result<Vector3<f64>, SceneError> {
        match &self.file.gravity {
            None => Ok(Vector3::zeros()),
            Some(GravitySpec::Vector(values)) => self.check.vector("gravity", values),
            Some(GravitySpec::Slope(slope)) => {
                let magnitude = self.check.not_negative("gravity.magnitude", slope.magnitude, "acceleration (m/s²)")?;
                let angle = self.check.finite("gravity.slope_deg", slope.slope_deg, "angle (degrees)")?.to_radians();
                let down = match self.check.dimension {
                    Dimension::Two => Vector3::new(angle.sin(), -angle.cos(), 0.0),
                    Dimension::Three => Vector3::new(angle.sin(), 0.0, -angle.cos()),
                };
                Ok(down * magnitude)
            }
        }
    }

    fn domain(&self, spec: &DomainSpec) -> Result<Domain, SceneError> {
        let check = &self.check;
        let mut low = check.vector("domain.low", &spec.low)?;
        let mut high = check.vector("domain.high", &spec.high)?;
        for axis in 0..check.dimension.count() {
            if high[axis] <= low[axis] {
                let found = format!("{} to {} along axis {}", low[axis], high[axis], axis + 1);
                return Err(check.error("domain.high", "a corner above `low`", &found));
            }
        }
        if check.dimension == Dimension::Two {
            (low.z, high.z) = (-0.5, 0.5);
        }
        let mut periodic = [false; 3];
        if !spec.periodic.is_empty() {
            if spec.periodic.len() != check.dimension.count() {
                let expected = format!("{} values", check.dimension.count());
                return Err(check.error("domain.periodic", &expected, &format!("{:?}", spec.periodic)));
            }
            periodic[..spec.periodic.len()].copy_from_slice(&spec.periodic);
        }
        Ok(Domain { low, high, periodic })
    }

    fn duration(&self) -> Result<Duration, SceneError> {
        let check = &self.check;
        check.exactly_one(
            "duration",
            &[("duration", self.file.duration.is_some()), ("duration_cycles", self.file.duration_cycles.is_some())],
        )?;
        match (self.file.duration, self.file.duration_cycles) {
            (Some(seconds), _) => Ok(Duration::Seconds(check.positive("duration", seconds, "time (s)")?)),
            (None, Some(0) | None) => Err(check.error("duration_cycles", "one cycle or more", "0")),
            (None, Some(cycles)) => Ok(Duration::Cycles(cycles)),
        }
    }

    fn sampling(&self) -> Result<Sampling, SceneError> {
        let (check, output) = (&self.check, &self.file.output);
        match (output.every, output.every_cycles) {
            (Some(_), Some(_)) => Err(check.error("output", "one of `every` and `every_cycles`", "both")),
            (Some(every), None) => Ok(Sampling::Seconds(check.positive("output.every", every, "time (s)")?)),
            (None, Some(0)) => Err(check.error("output.every_cycles", "one cycle or more", "0")),
            (None, Some(every)) => Ok(Sampling::Cycles(every)),
            (None, None) => Ok(Sampling::Count(200)),
        }
    }

    fn material(&self, key: &str, name: &str) -> Result<u16, SceneError> {
        let place = self.check.place_of(key, name, "a material of this scene", self.file.materials.keys())?;
        u16::try_from(place).map_err(|_| self.check.error(key, "at most 65535 materials", &place.to_string()))
    }

    fn grains(&self, shape: GrainShape, domain: Option<&Domain>) -> Result<(Vec<Grain>, Groups), SceneError> {
        let mut grains = Vec::new();
        let mut groups = IndexMap::new();
        for (name, spec) in &self.file.grains {
            let start = grains.len();
            self.group(name, spec, shape, domain, &mut grains)?;
            self.refuse_beyond_numbers(name, &grains[start..])?;
            groups.insert(name.clone(), start..grains.len());
        }
        if grains.is_empty() {
            return Err(self.check.error("grains", "at least one grain", "none"));
        }
        Ok((grains, groups))
    }

    fn group(
        &self,
        name: &str,
        spec: &GrainsSpec,
        shape: GrainShape,
        domain: Option<&Domain>,
        grains: &mut Vec<Grain>,
    ) -> Result<(), SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("grains.{name}.{part}");
        check.exactly_one(
            &format!("grains.{name}"),
            &[
                ("position", spec.position.is_some()),
                ("lattice", spec.lattice.is_some()),
                ("random", spec.random.is_some()),
                ("file", spec.file.is_some()),
            ],
        )?;
        let material = self.material(&key("material"), &spec.material)?;
        let velocity = check.vector_or_zero(&key("velocity"), spec.velocity.as_ref())?;
        let spin = check.spin(&key("spin"), spec.spin.as_ref())?;
        let radius = || match spec.radius {
            Some(radius) => check.positive(&key("radius"), radius, "radius (m)"),
            None => Err(check.error(&format!("grains.{name}"), "the key `radius`", "none")),
        };
        let density = || {
            self.file.materials[usize::from(material)]
                .density
                .ok_or_else(|| check.error(&format!("materials.{}", spec.material), "the key `density`", "none"))
        };
        let grain = |position, radius: f64, density: f64, velocity| {
            let mass = shape.mass(radius, density);
            let inertia = shape.inertia_factor() * mass * radius * radius;
            Grain { material, radius, mass, inertia, position, velocity, spin }
        };
        if let Some(position) = &spec.position {
            grains.push(grain(check.vector(&key("position"), position)?, radius()?, density()?, velocity));
        }
        if let Some(lattice) = &spec.lattice {
            let key = |part: &str| format!("grains.{name}.lattice.{part}");
            let origin = check.vector(&key("origin"), &lattice.origin)?;
            let spacing = check.vector(&key("spacing"), &lattice.spacing)?;
            let dimensions = check.dimension.count();
            if lattice.count.len() != dimensions || lattice.count.contains(&0) {
                let expected = format!("{dimensions} counts of one or more");
                return Err(check.error(&key("count"), &expected, &format!("{:?}", lattice.count)));
            }
            let total = lattice.count.iter().fold(1_u128, |total, &count| total * u128::from(count));
            self.refuse_too_many(&key("count"), total)?;
            let count = [lattice.count[0], lattice.count[1], lattice.count.get(2).copied().unwrap_or(1)];
            let (radius, density) = (radius()?, density()?);
            let centres = generate::lattice(origin, spacing, count);
            grains.extend(centres.into_iter().map(|centre| grain(centre, radius, density, velocity)));
        }
        if let Some(random) = &spec.random {
            let key = |part: &str| format!("grains.{name}.random.{part}");
            self.refuse_too_many(&key("count"), u128::from(random.count))?;
            let Some(domain) = domain else {
                return Err(check.error(&key("count"), "a `domain` to place grains in", "none"));
            };
            let radii = match random.radius_range {
                Some([small, large]) => {
                    check.positive(&key("radius_range"), small, "radius (m)")?;
                    if !large.is_finite() || large < small {
                        return Err(check.error(
                            &key("radius_range"),
                            "a range upwards",
                            &format!("{small} to {large}"),
                        ));
                    }
                    [small, large]
                }
                None => [radius()?; 2],
            };
            let speed = check.not_negative(&key("speed"), random.speed, "speed (m/s)")?;
            let density = density()?;
            let placed = generate::random(random.count, random.seed, radii, speed, domain, check.dimension)
                .ok_or_else(|| {
                    check.error(&key("count"), "room for all grains in the domain", &random.count.to_string())
                })?;
            grains.extend(
                placed.into_iter().map(|place| grain(place.position, place.radius, density, velocity + place.velocity)),
            );
        }
        if let Some(file) = &spec.file {
            self.grains_from_file(name, file, shape, material, grains)?;
        }
        Ok(())
    }

    /// Radius, density and domain may each be a fine number and still give a grain without one.
    fn refuse_beyond_numbers(&self, group: &str, grains: &[Grain]) -> Result<(), SceneError> {
        let key = format!("grains.{group}");
        for grain in grains {
            if !(grain.inertia > 0.0 && grain.inertia.is_finite()) {
                let found = format!("mass {:e} and moment of inertia {:e}", grain.mass, grain.inertia);
                return Err(self.check.error(&key, "a positive, finite mass and moment of inertia", &found));
            }
            if grain.position.iter().any(|value| !value.is_finite()) {
                return Err(self.check.error(&key, "finite positions", &format!("{:?}", grain.position.as_slice())));
            }
        }
        Ok(())
    }

    /// Memory for more grains than any machine steps is asked for by mistake.
    fn refuse_too_many(&self, key: &str, count: u128) -> Result<(), SceneError> {
        if count > 100_000_000 {
            return Err(self.check.error(key, "at most 100 million grains", &count.to_string()));
        }
        Ok(())
    }

    fn grains_from_file(
        &self,
        name: &str,
        file: &crate::file::FileSpec,
        shape: GrainShape,
        material: u16,
        grains: &mut Vec<Grain>,
    ) -> Result<(), SceneError> {
        let key = format!("grains.{name}.file.path");
        let types: Vec<u16> = file
            .types
            .iter()
            .map(|material| self.material(&format!("grains.{name}.file.types"), material))
            .collect::<Result<_, _>>()?;
        let path = self.check.source.directory.join(&file.path);
        let read = (self.read_grains)(&path).map_err(|message| {
            self.check.error(&key, "a LAMMPS data file of atom style sphere", &format!("`{message}`"))
        })?;
        for atom in read {
            let material = if types.is_empty() {
                material
            } else {
                *usize::try_from(atom.type_number)
                    .ok()
                    .and_then(|number| types.get(number.wrapping_sub(1)))
                    .ok_or_else(|| {
                        self.check.error(
                            &key,
                            &format!("atom types 1 to {}", types.len()),
                            &atom.type_number.to_string(),
                        )
                    })?
            };
            grains.push(Grain {
                material,
                radius: self.check.positive(&key, atom.radius, "radius (m)")?,
                mass: self.check.positive(&key, atom.mass, "mass (kg)")?,
                inertia: shape.inertia_factor() * atom.mass * atom.radius * atom.radius,
                position: atom.position,
                velocity: atom.velocity,
                spin: atom.spin,
            });
        }
        Ok(())
    }

    fn wall(&self, name: &str, spec: &WallSpec) -> Result<Wall, SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("walls.{name}.{part}");
        check.exactly_one(
            &format!("walls.{name}"),
            &[
                ("plane", spec.plane.is_some()),
                ("segment", spec.segment.is_some()),
                ("rectangle", spec.rectangle.is_some()),
            ],
        )?;
        let shape = if let Some(plane) = &spec.plane {
            let normal = check.vector(&key("plane.normal"), &plane.normal)?;
            let length = normal.norm();
            if !(length > 0.0 && length.is_finite()) {
                let found = format!("a vector of length {length}");
                return Err(check.error(&key("plane.normal"), "a direction", &found));
            }
            WallShape::Plane { point: check.vector(&key("plane.point"), &plane.point)?, normal: normal.normalize() }
        } else if let Some([from, to]) = &spec.segment {
            if check.dimension == Dimension::Three {
                return Err(check.error(&key("segment"), "a `rectangle` or `plane` in three dimensions", "a segment"));
            }
            let ends = [check.vector(&key("segment"), from)?, check.vector(&key("segment"), to)?];
            if ends[0] == ends[1] {
                return Err(check.error(&key("segment"), "two different points", "the same point twice"));
            }
            WallShape::Segment { ends }
        } else if let Some(rectangle) = &spec.rectangle {
            if check.dimension == Dimension::Two {
                return Err(check.error(&key("rectangle"), "a `segment` or `plane` in two dimensions", "a rectangle"));
            }
            let corner = check.vector(&key("rectangle.corner"), &rectangle.corner)?;
            let edges = [
                check.vector(&key("rectangle.edges"), &rectangle.edges[0])?,
                check.vector(&key("rectangle.edges"), &rectangle.edges[1])?,
            ];
            let lengths = edges[0].norm() * edges[1].norm();
            if lengths == 0.0 || edges[0].dot(&edges[1]).abs() > 1e-9 * lengths {
                let found = format!("{:?} and {:?}", rectangle.edges[0], rectangle.edges[1]);
                return Err(check.error(&key("rectangle.edges"), "two perpendicular edges", &found));
            }
            WallShape::Rectangle { corner, edges }
        } else {
            return Err(check.error(&format!("walls.{name}"), "a shape", "none"));
        };
        let material = self.material(&key("material"), &spec.material)?;
        Ok(Wall { name: name.to_owned(), material, shape, motion: self.motion(name, &spec.motion)? })
    }

    fn motion(&self, wall: &str, specs: &[MotionSpec]) -> Result<Motion, SceneError> {
        let check = &self.check;
        let mut motion = Motion::default();
        let mut centre_of: Option<Vector3<f64>> = None;
        for (number, spec) in specs.iter().enumerate() {
            let key = |part: &str| format!("walls.{wall}.motion[{number}].{part}");
            let spin = check.spin(&key("spin"), spec.spin.as_ref())?;
            if spec.spin.is_some() {
                let Some(centre) = &spec.centre else {
                    return Err(check.error(&key("centre"), "a centre to rotate about", "none"));
                };
                let centre = check.vector(&key("centre"), centre)?;
                if centre_of.is_some_and(|other| other != centre) {
                    return Err(check.error(&key("centre"), "one centre for all phases of a wall", "another one"));
                }
                if motion.phases.iter().any(|phase: &Phase| phase.spin.cross(&spin).norm() > 0.0) {
                    return Err(check.error(&key("spin"), "one axis for all phases of a wall", "another one"));
                }
                centre_of = Some(centre);
            }
            let start = self.moment(&key("start"), spec.start, spec.start_cycle, Moment::Seconds(0.0))?;
            let stop = self.moment(&key("stop"), spec.stop, spec.stop_cycle, Moment::Never)?;
            let velocity = check.vector_or_zero(&key("velocity"), spec.velocity.as_ref())?;
            motion.phases.push(Phase { velocity, spin, start, stop });
        }
        motion.centre = centre_of.unwrap_or_default();
        Ok(motion)
    }

    fn moment(
        &self,
        key: &str,
        seconds: Option<f64>,
        cycle: Option<u64>,
        otherwise: Moment,
    ) -> Result<Moment, SceneError> {
        match (seconds, cycle) {
            (Some(_), Some(_)) => Err(self.check.error(key, "a time or a cycle", "both")),
            (Some(seconds), None) => Ok(Moment::Seconds(self.check.not_negative(key, seconds, "time (s)")?)),
            (None, Some(cycle)) => Ok(Moment::Cycle(cycle)),
            (None, None) => Ok(otherwise),
        }
    }

    fn laws(&self, grains: &[Grain], walls: &[Wall]) -> Result<Vec<Option<ContactLaw>>, SceneError> {
        let count = self.file.materials.len();
        let mut table = vec![None; count * count];
        for (name, spec) in &self.file.contacts {
            let key = format!("contacts.{name}.between");
            let a = usize::from(self.material(&key, &spec.between[0])?);
            let b = usize::from(self.material(&key, &spec.between[1])?);
            if table[a * count + b].is_some() {
                let pair = format!("a second one for {} and {}", spec.between[0], spec.between[1]);
                return Err(self.check.error(&key, "one law for each pair of materials", &pair));
            }
            let law = Some(self.law(name, spec)?);
            table[a * count + b] = law;
            table[b * count + a] = law;
        }
        let hertz = table.iter().flatten().filter(|law| ContactLaw::is_hertz(law)).count();
        if hertz > 0 && hertz < table.iter().flatten().count() {
            return Err(self.check.error("contacts", "laws of one kind, all `linear` or all `hertz`", "both"));
        }
        self.require_laws(&table, grains, walls)?;
        Ok(table)
    }

    /// Every pair of materials that can meet must have a law: silence would let grains pass through each other.
    fn require_laws(&self, table: &[Option<ContactLaw>], grains: &[Grain], walls: &[Wall]) -> Result<(), SceneError> {
        let count = self.file.materials.len();
        let mut grains_of = vec![0_usize; count];
        grains.iter().for_each(|grain| grains_of[usize::from(grain.material)] += 1);
        let has_wall = |m: usize| walls.iter().any(|wall| usize::from(wall.material) == m);
        for a in 0..count {
            for b in 0..count {
                let among_grains = if a == b { grains_of[a] > 1 } else { grains_of[a] > 0 && grains_of[b] > 0 };
                let at_wall = grains_of[a] > 0 && has_wall(b);
                if (among_grains || at_wall) && table[a * count + b].is_none() {
                    let name = |m: usize| self.file.materials.get_index(m).map_or("", |(name, _)| name.as_str());
                    let pair = format!("a law between {} and {}, which can meet", name(a), name(b));
                    return Err(self.check.error("contacts", &pair, "none"));
                }
            }
        }
        Ok(())
    }

    fn law(&self, name: &str, spec: &ContactSpec) -> Result<ContactLaw, SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("contacts.{name}.{part}");
        let friction = match (spec.friction, spec.friction_angle_deg) {
            (Some(_), Some(_)) => {
                return Err(check.error(&key("friction"), "one of `friction` and `friction_angle_deg`", "both"));
            }
            (Some(friction), None) => check.not_negative(&key("friction"), friction, "coefficient of friction")?,
            (None, Some(angle)) => {
                if !(0.0..90.0).contains(&angle) {
                    return Err(check.error(
                        &key("friction_angle_deg"),
                        "an angle from 0 to below 90°",
                        &angle.to_string(),
                    ));
                }
                angle.to_radians().tan()
            }
            (None, None) => 0.0,
        };
        let damping = |part: &str, value: f64, unit: &str| check.not_negative(&key(part), value, unit);
        let restitution = spec.restitution.unwrap_or(1.0);
        if !(restitution > 0.0 && restitution <= 1.0) {
            return Err(check.error(
                &key("restitution"),
                "a coefficient above 0 and at most 1",
                &restitution.to_string(),
            ));
        }
        let log = restitution.ln();
        let mut law = ContactLaw {
            friction,
            cohesion: check.not_negative(&key("cohesion"), spec.cohesion, "force (N)")?,
            stiffness_damping: damping("stiffness_damping", spec.stiffness_damping, "time (s)")?,
            normal_damping: damping("normal_damping", spec.normal_damping, "rate (1/s)")?,
            tangential_damping: damping("tangential_damping", spec.tangential_damping, "rate (1/s)")?,
            damping_ratio: -log / (PI * PI + log * log).sqrt(),
            rolling_friction: damping("rolling_friction", spec.rolling_friction, "coefficient")?,
            rolling_damping: damping("rolling_damping", spec.rolling_damping, "damping ratio")?,
            ..ContactLaw::default()
        };
        match spec.law {
            LawKind::Linear => self.linear(name, spec, &mut law)?,
            LawKind::Hertz => self.hertz(name, spec, &mut law)?,
        }
        Ok(law)
    }

    fn linear(&self, name: &str, spec: &ContactSpec, law: &mut ContactLaw) -> Result<(), SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("contacts.{name}.{part}");
        let Some(stiffness) = spec.normal_stiffness else {
            return Err(check.error(&format!("contacts.{name}"), "the key `normal_stiffness`", "none"));
        };
        law.normal_stiffness = check.positive(&key("normal_stiffness"), stiffness, "stiffness (N/m)")?;
        let tangential = spec.tangential_stiffness;
        law.tangential_stiffness = if law.has_friction() {
            let what = "stiffness (N/m), since there is friction";
            check.positive(&key("tangential_stiffness"), tangential, what)?
        } else {
            check.not_negative(&key("tangential_stiffness"), tangential, "stiffness (N/m)")?
        };
        Ok(())
    }

    /// 1/E* and 1/G* are sums over both materials; a rigid one adds nothing.
    fn hertz(&self, name: &str, spec: &ContactSpec, law: &mut ContactLaw) -> Result<(), SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("contacts.{name}.{part}");
        if self.grain_shape()? == GrainShape::Disc {
            return Err(check.error(&key("law"), "`linear` between discs: Hertz's law is for spheres", "`hertz`"));
        }
        if spec.normal_stiffness.is_some() || spec.tangential_stiffness != 0.0 {
            let expected = "no stiffness: a Hertz contact takes it from E and ν of the materials";
            return Err(check.error(&key("normal_stiffness"), expected, "one"));
        }
        if spec.stiffness_damping != 0.0 {
            let expected = "`normal_damping` or `restitution` in a Hertz contact, which has no one stiffness";
            return Err(check.error(&key("stiffness_damping"), expected, &spec.stiffness_damping.to_string()));
        }
        let (mut compliance, mut shear_compliance) = (0.0, 0.0);
        for material in &spec.between {
            let of = |part: &str| format!("materials.{material}.{part}");
            let properties = &self.file.materials[material.as_str()];
            if properties.rigid {
                continue;
            }
            let (Some(young), Some(poisson)) = (properties.young_modulus, properties.poisson_ratio) else {
                let expected = "`young_modulus` and `poisson_ratio` (or `rigid = true`), since it has Hertz contacts";
                return Err(check.error(&format!("materials.{material}"), expected, "not both"));
            };
            check.positive(&of("young_modulus"), young, "modulus (Pa)")?;
            if !(poisson > -1.0 && poisson <= 0.5) {
                return Err(check.error(
                    &of("poisson_ratio"),
                    "a ratio above −1 and at most 1/2",
                    &poisson.to_string(),
                ));
            }
            compliance += (1.0 - poisson * poisson) / young;
            shear_compliance += 2.0 * (2.0 - poisson) * (1.0 + poisson) / young;
        }
        if compliance == 0.0 {
            return Err(check.error(&key("between"), "at least one material that is not rigid", "two rigid ones"));
        }
        law.effective_modulus = 1.0 / compliance;
        law.effective_shear_modulus = 1.0 / shear_compliance;
        Ok(())
    }

    fn refuse_deep_overlap(
        &self,
        grains: &[Grain],
        walls: &[Wall],
        domain: Option<&Domain>,
        groups: &Groups,
    ) -> Result<(), SceneError> {
        let bound = self.file.largest_initial_overlap;
        self.check.not_negative("largest_initial_overlap", bound, "ratio")?;
        let Some(deepest) = overlap::deepest(grains, walls, domain).filter(|deepest| deepest.ratio() > bound) else {
            return Ok(());
        };
        let group_of =
            |grain: usize| groups.iter().find(|(_, range)| range.contains(&grain)).map_or("", |(name, _)| name);
        let (grain, pair) = match deepest {
            Deepest::Grains(a, b, _) => (a, format!("grains {} and {}", a + 1, b + 1)),
            Deepest::GrainWall(grain, wall, _) => (grain, format!("grain {} and wall {}", grain + 1, walls[wall].name)),
        };
        let found = format!("{pair} overlapping by {:.4} of the radius", deepest.ratio());
        let key = format!("grains.{}", group_of(grain));
        let expected = format!("initial overlaps of at most {bound} of the smaller radius");
        Err(self.check.source.error(&key, &expected, &found, Some("or a larger `largest_initial_overlap`".to_owned())))
    }

    fn probe(&self, name: &str, spec: &ProbeSpec, names: &Names<'_>) -> Result<Probe, SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("probes.{name}.{part}");
        check.exactly_one(
            &format!("probes.{name}"),
            &[
                ("grain", spec.grain.is_some()),
                ("contact", spec.contact.is_some()),
                ("wall", spec.wall.is_some()),
                ("system", spec.system == Some(true)),
            ],
        )?;
        let target = if let Some(grain) = &spec.grain {
            ProbeTarget::Grain(names.grain(check, &key("grain"), grain)?)
        } else if let Some([first, second]) = &spec.contact {
            let grain = names.grain(check, &key("contact"), first)?;
            match names.walls.iter().position(|wall| &wall.name == second) {
                Some(wall) => ProbeTarget::GrainWall(grain, wall),
                None => ProbeTarget::Pair(grain, names.grain(check, &key("contact"), second)?),
            }
        } else if let Some(wall) = &spec.wall {
            let known = names.walls.iter().map(|wall| &wall.name);
            ProbeTarget::Wall(check.place_of(&key("wall"), wall, "a wall of this scene", known)?)
        } else {
            ProbeTarget::System
        };
        Ok(Probe { name: name.to_owned(), target })
    }
}

/// What probes can refer to.
struct Names<'a> {
    groups: &'a Groups,
    walls: &'a [Wall],
}

impl Names<'_> {
    /// The grain called `group` (when the group has one) or `group.k`.
    fn grain(&self, check: &Checker<'_>, key: &str, name: &str) -> Result<usize, SceneError> {
        let (group, number) = match name.rsplit_once('.').and_then(|(group, k)| Some((group, k.parse::<usize>().ok()?)))
        {
            Some((group, number)) if self.groups.contains_key(group) => (group, Some(number)),
            _ => (name, None),
        };
        let place = check.place_of(key, group, "a group of grains", self.groups.keys())?;
        let range = &self.groups[place];
        match number {
            Some(number) if (1..=range.len()).contains(&number) => Ok(range.start + number - 1),
            Some(_) => Err(check.error(key, &format!("{group}.1 to {group}.{}", range.len()), &format!("`{name}`"))),
            None if range.len() == 1 => Ok(range.start),
            None => {
                Err(check.error(key, &format!("{group}.k, with k from 1 to {}", range.len()), &format!("`{name}`")))
            }
        }
    }
}
