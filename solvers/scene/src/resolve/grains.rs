//! Grains of a scene file.

use super::stays::along;
use super::{Groups, Resolver};
use crate::dimension::GrainShape;
use crate::end_state::{EndState, Springs};
use crate::error::SceneError;
use crate::file::{FileSpec, GrainsSpec, LatticeSpec, PackedSpec, RandomSpec, RegionSpec, SpacingSpec, StateSpec};
use crate::generate::{self, NoRoom};
use crate::memory;
use crate::overlap::{self, DeepestOverlap};
use crate::packing;
use crate::radii::Radii;
use crate::scene::{Domain, Grain, Wall};
use crate::stays::{Entry, Stays};
use nalgebra::Vector3;
use std::sync::Arc;

/// Memory per grain, summed over scene, solver and snapshot (B).
const BYTES_OF_A_GRAIN: f64 = 1e3;
/// Smallest fraction of a log-normal distribution that must lie within its range. Radii outside the range are drawn
/// again, and a smaller fraction would need many draws.
const LEAST: f64 = 0.01;

/// Grains with their initial state.
#[derive(Default)]
pub(super) struct PlacedGrains {
    pub(super) grains: Vec<Grain>,
    pub(super) groups: Groups,
    /// Grains that are inserted during the run.
    pub(super) entries: Vec<Entry>,
    /// Initial contact history.
    pub(super) springs: Option<Arc<Springs>>,
}

/// Group of grains, with the properties that all its grains have in common.
struct Group<'a> {
    name: &'a str,
    spec: &'a GrainsSpec,
    shape: GrainShape,
    material: u16,
    velocity: Vector3<f64>,
    spin: Vector3<f64>,
}

impl Group<'_> {
    /// Returns a grain of a radius (m) and a density (kg/m³).
    fn grain(&self, position: Vector3<f64>, radius: f64, density: f64, velocity: Vector3<f64>) -> Grain {
        let mass = self.shape.mass(radius, density);
        let inertia = self.shape.inertia_factor() * mass * radius * radius;
        Grain { material: self.material, radius, mass, inertia, position, velocity, spin: self.spin }
    }
}

impl Resolver<'_> {
    pub(super) fn grains(&self, shape: GrainShape, domain: Option<&Domain>) -> Result<PlacedGrains, SceneError> {
        let mut placed = PlacedGrains::default();
        for (name, spec) in &self.file.grains {
            let start = placed.grains.len();
            self.group(name, spec, shape, domain, &mut placed)?;
            self.refuse_beyond_numbers(name, &placed.grains[start..])?;
            placed.groups.insert(name.clone(), start..placed.grains.len());
        }
        placed.entries.sort_by(|a, b| a.time.total_cmp(&b.time));
        Ok(placed)
    }

    fn group(
        &self,
        name: &str,
        spec: &GrainsSpec,
        shape: GrainShape,
        domain: Option<&Domain>,
        placed: &mut PlacedGrains,
    ) -> Result<(), SceneError> {
        let (check, grains) = (&self.check, &mut placed.grains);
        let key = |part: &str| format!("grains.{name}.{part}");
        self.check_keys(name, spec)?;
        let material = self.material(&key("material"), &spec.material)?;
        let velocity = check.vector_or_zero(&key("velocity"), spec.velocity.as_ref())?;
        let spin = self.spin(&key("spin"), spec.spin.as_ref())?;
        let group = Group { name, spec, shape, material, velocity, spin };
        if let Some(position) = &spec.position {
            let position = check.vector(&key("position"), position)?;
            grains.push(group.grain(position, self.radius(&group)?, self.density(material)?, velocity));
        } else if let Some(lattice) = &spec.lattice {
            grains.extend(self.on_lattice(&group, lattice)?);
        } else if let Some(random) = &spec.random {
            grains.extend(self.at_random(&group, random, domain)?);
        } else if let Some(packed) = &spec.packed {
            let density = self.density(material)?;
            let places = self.packed(name, packed, domain)?;
            grains.extend(places.into_iter().map(|(centre, radius)| group.grain(centre, radius, density, velocity)));
        } else if let Some(poured) = &spec.poured {
            self.refuse_too_many(&key("poured.count"), u128::from(poured.count))?;
            let (radius, density) = (self.radius(&group)?, self.density(material)?);
            for (time, centre) in self.pour(name, spec, poured, radius, velocity, domain)? {
                placed.entries.push(Entry { grain: grains.len(), time });
                grains.push(group.grain(centre, radius, density, velocity));
            }
        } else if let Some(state) = &spec.state {
            self.grains_from_state(name, state, material, placed)?;
        } else if let Some(file) = &spec.file {
            self.grains_from_file(name, file, shape, material, grains)?;
        }
        Ok(())
    }

    /// Checks that a group has exactly one placement. The grains of a state or of a data file have their own size and
    /// motion.
    fn check_keys(&self, name: &str, spec: &GrainsSpec) -> Result<(), SceneError> {
        let key = format!("grains.{name}");
        self.check.exactly_one(
            &key,
            &[
                ("position", spec.position.is_some()),
                ("lattice", spec.lattice.is_some()),
                ("random", spec.random.is_some()),
                ("packed", spec.packed.is_some()),
                ("poured", spec.poured.is_some()),
                ("state", spec.state.is_some()),
                ("file", spec.file.is_some()),
            ],
        )?;
        let source = match (&spec.state, &spec.file) {
            (None, None) => return Ok(()),
            (Some(_), _) => "state",
            (None, Some(_)) => "file",
        };
        let keys =
            [("radius", spec.radius.is_some()), ("velocity", spec.velocity.is_some()), ("spin", spec.spin.is_some())];
        keys.into_iter().try_for_each(|(part, is_given)| {
            let expected = format_args!("none, because `{source}` contains it");
            self.check.require(!is_given, &format!("{key}.{part}"), expected, "one")
        })
    }

    /// Returns the radius of the grains of a group (m).
    fn radius(&self, group: &Group<'_>) -> Result<f64, SceneError> {
        match group.spec.radius {
            Some(radius) => self.check.positive(&format!("grains.{}.radius", group.name), radius, "radius (m)"),
            None => Err(self.check.error(&format!("grains.{}", group.name), "the key `radius`", "none")),
        }
    }

    fn on_lattice(&self, group: &Group<'_>, lattice: &LatticeSpec) -> Result<Vec<Grain>, SceneError> {
        let check = &self.check;
        let key = |part: &str| format!("grains.{}.lattice.{part}", group.name);
        let origin = check.vector(&key("origin"), &lattice.origin)?;
        let dimensions = check.dimension.count();
        let is_valid = lattice.count.len() == dimensions && !lattice.count.contains(&0);
        let expected = format_args!("{dimensions} counts of at least one");
        check.require(is_valid, &key("count"), expected, format_args!("{:?}", lattice.count))?;
        let total = lattice.count.iter().fold(1_u128, |total, &count| total * u128::from(count));
        self.refuse_too_many(&key("count"), total)?;
        let count = [lattice.count[0], lattice.count[1], lattice.count.get(2).copied().unwrap_or(1)];
        let (radius, density) = (self.radius(group)?, self.density(group.material)?);
        let mut centres = match (&lattice.spacing, lattice.close_packed) {
            (SpacingSpec::Along(spacing), false) => {
                generate::lattice(origin, check.vector(&key("spacing"), spacing)?, count)
            }
            (SpacingSpec::Nearest(spacing), true) => {
                generate::close_packed(origin, check.positive(&key("spacing"), *spacing, "distance (m)")?, count)
            }
            (SpacingSpec::Nearest(found), false) => {
                let expected = format_args!("{dimensions} distances, or `close_packed = true`");
                return Err(check.error(&key("spacing"), expected, found));
            }
            (SpacingSpec::Along(found), true) => {
                let expected = "one number, the distance of nearest neighbours";
                return Err(check.error(&key("spacing"), expected, format_args!("{found:?}")));
            }
        };
        let perturbation = check.not_negative(&key("perturbation"), lattice.perturbation, "length (m)")?;
        if perturbation > 0.0 {
            generate::perturb(&mut centres, perturbation, lattice.seed, check.dimension);
        }
        Ok(centres.into_iter().map(|centre| group.grain(centre, radius, density, group.velocity)).collect())
    }

    fn at_random(
        &self,
        group: &Group<'_>,
        random: &RandomSpec,
        domain: Option<&Domain>,
    ) -> Result<Vec<Grain>, SceneError> {
        let check = &self.check;
        let table = format!("grains.{}.random", group.name);
        let key = |part: &str| format!("{table}.{part}");
        self.refuse_too_many(&key("count"), u128::from(random.count))?;
        let Some(domain) = domain else {
            let (part, purpose) = match random.region {
                Some(_) => ("region", "that contains the region"),
                None => ("count", "to place grains in"),
            };
            let expected = format_args!("a `domain` with `low` and `high` {purpose}");
            return Err(check.error(&key(part), expected, "no domain"));
        };
        let radii = self.radii(&table, random, group.shape, &|| self.radius(group))?;
        let part = match &random.region {
            Some(region) => self.region_of(&key("region"), region, domain)?,
            None => *domain,
        };
        let speed = check.not_negative(&key("speed"), random.speed, "speed (m/s)")?;
        let density = self.density(group.material)?;
        let no_room = |NoRoom { share, is_costly }| {
            let place = if random.region.is_some() { "region" } else { "domain" };
            let found = format!("{} that would fill {share:.2} of it", random.count);
            if is_costly {
                let expected =
                    format!("a count and radii for which the search finds room in the {place} within a minute");
                return check.error(&key("count"), &expected, &found);
            }
            let help = "randomly placed equal discs fill at most 0.55, and spheres at most 0.38; `packed` is denser";
            let expected = format!("grains that find room in the {place}");
            check.source.error(&key("count"), &expected, &found, Some(help.to_owned()))
        };
        let placed = generate::random(random.count, random.seed, &radii, speed, &part, check.dimension);
        let grain = |place: generate::PlacedGrain| {
            group.grain(place.position, place.radius, density, group.velocity + place.velocity)
        };
        Ok(placed.map_err(no_room)?.into_iter().map(grain).collect())
    }

    /// Returns the centres and radii of a packing (m).
    fn packed(
        &self,
        name: &str,
        packed: &PackedSpec,
        domain: Option<&Domain>,
    ) -> Result<Vec<(Vector3<f64>, f64)>, SceneError> {
        let check = &self.check;
        let key = format!("grains.{name}.packed.radii");
        let Some(domain) = domain else {
            return Err(check.error(&key, "a `domain` with `low` and `high` to pack grains into", "no domain"));
        };
        let total: u64 = packed.radii.iter().map(|&(_, count)| u64::from(count)).sum();
        let is_possible = (1..=u64::from(packing::MOST)).contains(&total);
        check.require(is_possible, &key, format_args!("1 to {} grains", packing::MOST), total)?;
        let mut radii = Vec::new();
        for &(radius, count) in &packed.radii {
            let radius = check.positive(&key, radius, "radius (m)")?;
            radii.extend(std::iter::repeat_n(radius, count as usize));
        }
        let centres = packing::pack(&radii, packed.seed, domain, check.dimension, packed.cut).ok_or_else(|| {
            let asked = packing::filled(radii.iter().copied(), domain, check.dimension);
            let expected = match packing::reachable(&radii, packed.seed, domain, check.dimension, packed.cut) {
                Some(share) => {
                    format!("grains that fill at most {share:.2} of the domain, the densest packing of these grains")
                }
                None => "grains that fill at most half of the domain, because no denser packing was found".to_owned(),
            };
            check.error(&key, &expected, format!("{total} grains that would fill {asked:.2} of it"))
        })?;
        Ok(centres.into_iter().zip(radii).collect())
    }

    /// Rejects grains whose moment of inertia is not positive and finite, or whose position is not finite. Finite input
    /// can cause both, because products overflow or underflow.
    fn refuse_beyond_numbers(&self, group: &str, grains: &[Grain]) -> Result<(), SceneError> {
        let key = format!("grains.{group}");
        for grain in grains {
            let found = format_args!("mass {:e} and moment of inertia {:e}", grain.mass, grain.inertia);
            let is_valid = grain.inertia > 0.0 && grain.inertia.is_finite();
            self.check.require(is_valid, &key, "a positive, finite mass and moment of inertia", found)?;
            let is_finite = grain.position.iter().all(|value| value.is_finite());
            self.check.require(is_finite, &key, "finite positions", format_args!("{:?}", grain.position.as_slice()))?;
        }
        Ok(())
    }

    /// Rejects a grain with a diameter above the period along an axis, because it would overlap itself. Along
    /// non-periodic axes, rejects a grain whose centre lies outside the domain.
    pub(super) fn refuse_outside(&self, domain: &Domain, grains: &[Grain], groups: &Groups) -> Result<(), SceneError> {
        for (name, range) in groups {
            for (at, grain) in range.clone().zip(&grains[range.clone()]) {
                for axis in 0..self.check.dimension.count() {
                    let (low, high, centre) = (domain.low[axis], domain.high[axis], grain.position[axis]);
                    let letter = ['x', 'y', 'z'][axis];
                    if domain.periodic[axis] && 2.0 * grain.radius > high - low {
                        let expected =
                            format_args!("a period along {letter} no shorter than a grain, {} m", 2.0 * grain.radius);
                        return Err(self.check.error("domain", expected, format_args!("{} m", high - low)));
                    }
                    let slack = 1e-9 * (high - low);
                    if !domain.periodic[axis] && !(low - slack..=high + slack).contains(&centre) {
                        let key = format!("grains.{name}");
                        let expected =
                            format_args!("grain {} within the domain, {letter} from {low} to {high} m", at + 1);
                        return Err(self.check.error(&key, expected, format_args!("{letter} = {centre} m")));
                    }
                }
            }
        }
        Ok(())
    }

    /// Rejects a number of grains that exceeds 100 million or the available memory.
    fn refuse_too_many(&self, key: &str, count: u128) -> Result<(), SceneError> {
        self.check.require(count <= 100_000_000, key, "at most 100 million grains", count)?;
        let excess = memory::beyond(count as f64, "grains", BYTES_OF_A_GRAIN);
        excess.map_or(Ok(()), |found| Err(self.check.error(key, "grains that fit into memory", found)))
    }

    fn grains_from_file(
        &self,
        name: &str,
        file: &FileSpec,
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
        let read = (self.read_grains)(&path).map_err(|error| SceneError {
            place: format!("{}: {key}: {}", self.check.source.place(&key), error.place),
            ..error
        })?;
        for atom in read {
            let material = if types.is_empty() {
                material
            } else {
                let expected = format_args!("atom types 1 to {}", types.len());
                let found = types.get((atom.type_number as usize).wrapping_sub(1)).copied();
                found.ok_or_else(|| self.check.error(&key, expected, atom.type_number))?
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

    /// Adds the grains of the final state of a run.
    fn grains_from_state(
        &self,
        name: &str,
        spec: &StateSpec,
        material: u16,
        placed: &mut PlacedGrains,
    ) -> Result<(), SceneError> {
        let check = &self.check;
        let key = format!("grains.{name}.state.path");
        let path = check.source.directory.join(&spec.path);
        let refuse = |found: String| check.error(&key, "a state written by `simulate --state`", &found);
        let bytes = std::fs::read(&path).map_err(|error| refuse(error.to_string()))?;
        let state = EndState::from_bytes(&bytes).map_err(refuse)?;
        if state.dimension != check.dimension.count() {
            return Err(refuse(format!("a state in {} dimensions", state.dimension)));
        }
        // A state with a single material gets the material of the group, even if the names differ.
        let materials: Vec<u16> = match &state.materials[..] {
            [_] => vec![material],
            several => several.iter().map(|material| self.material(&key, material)).collect::<Result<_, _>>()?,
        };
        let first = placed.grains.len() as u32;
        for grain in &state.grains {
            check.positive(&key, grain.radius, "radius (m)")?;
            check.positive(&key, grain.mass, "mass (kg)")?;
            check.positive(&key, grain.inertia, "moment of inertia (kg m²)")?;
            placed.grains.push(Grain { material: materials[usize::from(grain.material)], ..*grain });
        }
        if spec.springs {
            let expected = "springs of one state (`springs = false` for further states)";
            check.require(placed.springs.is_none(), &key, expected, "two")?;
            placed.springs = Some(Arc::new(state.springs.later_by(first)));
        }
        Ok(())
    }

    /// Returns the distribution of radii. By default, all grains have the `radius` of the group.
    fn radii(
        &self,
        key: &str,
        spec: &RandomSpec,
        shape: GrainShape,
        radius: &dyn Fn() -> Result<f64, SceneError>,
    ) -> Result<Radii, SceneError> {
        let check = &self.check;
        let Some(radii) = &spec.radii else {
            let Some(range) = spec.radius_range else { return Ok(Radii::Uniform([radius()?; 2])) };
            return Ok(Radii::Uniform(self.range(&format!("{key}.radius_range"), range)?));
        };
        check.require(spec.radius_range.is_none(), key, "one of `radius_range` and `radii`", "both")?;
        let key = format!("{key}.radii");
        check.exactly_one(&key, &[("log_normal", radii.log_normal.is_some()), ("by_mass", radii.by_mass.is_some())])?;
        if let Some(spec) = &radii.log_normal {
            let key = |part: &str| format!("{key}.log_normal.{part}");
            let range = self.range(&key("range"), spec.range)?;
            let median = check.positive(&key("median"), spec.median, "radius (m)")?;
            let deviation = check.not_negative(&key("deviation"), spec.deviation, "ratio")?;
            let is_within = (range[0]..=range[1]).contains(&median);
            check.require(is_within, &key("median"), "a radius within `range`", median)?;
            let share =
                |radius: f64| 0.5 * libm::erf(libm::log(radius / median) / (deviation * std::f64::consts::SQRT_2));
            let is_wide = deviation <= 0.0 || share(range[1]) - share(range[0]) >= LEAST;
            let expected = format!("a range that contains at least {LEAST} of the distribution");
            check.require(is_wide, &key("range"), &expected, format_args!("{} to {} m", range[0], range[1]))?;
            return Ok(Radii::LogNormal { median, deviation, range });
        }
        let curve = radii.by_mass.as_deref().unwrap_or_default();
        let key = format!("{key}.by_mass");
        let rises = curve.windows(2).all(|pair| pair[0].0 <= pair[1].0 && pair[0].1 <= pair[1].1);
        let is_whole =
            curve.first().is_some_and(|first| first.1 == 0.0) && curve.last().is_some_and(|last| last.1 == 1.0);
        let is_valid = rises && is_whole && curve.iter().all(|(radius, _)| radius.is_finite() && *radius > 0.0);
        let expected = "pairs [radius (m), mass fraction of the grains up to this radius] in increasing order, with \
                        fractions from 0 to 1";
        let pairs: Vec<[f64; 2]> = curve.iter().map(|&(radius, fraction)| [radius, fraction]).collect();
        check.require(is_valid, &key, expected, format_args!("{pairs:?}"))?;
        Ok(Radii::by_mass(curve, if shape == GrainShape::Disc { 2 } else { 3 }))
    }

    /// Returns the smallest and largest radius (m), after checking that they are positive, finite and in this order.
    fn range(&self, key: &str, [small, large]: [f64; 2]) -> Result<[f64; 2], SceneError> {
        self.check.positive(key, small, "radius (m)")?;
        let found = format_args!("{small} to {large}");
        self.check.require(large.is_finite() && large >= small, key, "an increasing range", found)?;
        Ok([small, large])
    }

    /// Returns the part of the domain within a box. This part is periodic along the periodic axes that the box spans
    /// completely.
    fn region_of(&self, key: &str, spec: &RegionSpec, domain: &Domain) -> Result<Domain, SceneError> {
        let [low, high] = self.corners(key, &spec.low, &spec.high)?;
        let mut part = *domain;
        for axis in 0..self.check.dimension.count() {
            let is_within = low[axis] >= domain.low[axis] && high[axis] <= domain.high[axis];
            let expected = format!("a box within the domain, {} to {}", domain.low[axis], domain.high[axis]);
            self.check.require(is_within, key, &expected, along(low[axis], high[axis], axis))?;
            let is_whole = low[axis] == domain.low[axis] && high[axis] == domain.high[axis];
            (part.low[axis], part.high[axis]) = (low[axis], high[axis]);
            part.periodic[axis] = domain.periodic[axis] && is_whole;
        }
        Ok(part)
    }

    pub(super) fn refuse_deep_overlap(
        &self,
        grains: &[Grain],
        stays: &Stays,
        walls: &[Wall],
        domain: Option<&Domain>,
        groups: &Groups,
    ) -> Result<(), SceneError> {
        let bound = self.file.largest_initial_overlap;
        self.check.not_negative("largest_initial_overlap", bound, "ratio")?;
        // The search ends at an overlap ratio above 1, or above `bound` if `bound` is larger than 1.
        let mut later = vec![false; grains.len()];
        // Grains inserted at time zero are present from the start.
        stays.entries[stays.entered_by(0.0)..].iter().for_each(|entry| later[entry.grain] = true);
        let first: Vec<usize> = (0..grains.len()).filter(|&grain| !later[grain]).collect();
        let found = if stays.entries.is_empty() {
            overlap::deepest(grains, walls, domain, bound.max(1.0))
        } else {
            let at_first: Vec<Grain> = first.iter().map(|&grain| grains[grain]).collect();
            overlap::deepest(&at_first, walls, domain, bound.max(1.0)).map(|deepest| deepest.among(&first))
        };
        let Some(deepest) = found.filter(|deepest| deepest.ratio() > bound) else { return Ok(()) };
        let group_of =
            |grain: usize| groups.iter().find(|(_, range)| range.contains(&grain)).map_or("", |(name, _)| name);
        let (DeepestOverlap::Grains(grain, ..) | DeepestOverlap::GrainWall(grain, ..)) = deepest;
        let found = deepest.words(walls);
        let key = format!("grains.{}", group_of(grain));
        let expected = format!("initial overlaps of at most {bound} of the smaller radius");
        Err(self.check.source.error(&key, &expected, &found, Some("or a larger `largest_initial_overlap`".to_owned())))
    }
}
