//! Grains of a scene file.

use super::{Groups, Resolver};
use crate::dimension::GrainShape;
use crate::end_state::Springs;
use crate::error::SceneError;
use crate::file::{FileSpec, GrainsSpec, LatticeSpec, PackedSpec, RandomSpec, SpacingSpec};
use crate::generate::{self, NoRoom};
use crate::memory;
use crate::overlap::{self, DeepestOverlap};
use crate::packing;
use crate::scene::{Domain, Grain, Wall};
use crate::stays::{Entry, Stays};
use indexmap::IndexMap;
use nalgebra::Vector3;
use std::sync::Arc;

/// Memory per grain, summed over scene, solver and snapshot (B).
const BYTES_OF_A_GRAIN: f64 = 1e3;

/// Grains with their initial state.
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
        let mut grains = Vec::new();
        let (mut entries, mut springs) = (Vec::new(), None);
        let mut groups = IndexMap::new();
        for (name, spec) in &self.file.grains {
            let start = grains.len();
            self.group(name, spec, shape, domain, (&mut grains, &mut entries, &mut springs))?;
            self.refuse_beyond_numbers(name, &grains[start..])?;
            groups.insert(name.clone(), start..grains.len());
        }
        entries.sort_by(|a: &Entry, b: &Entry| a.time.total_cmp(&b.time));
        Ok(PlacedGrains { grains, groups, entries, springs: springs.map(Arc::new) })
    }

    fn group(
        &self,
        name: &str,
        spec: &GrainsSpec,
        shape: GrainShape,
        domain: Option<&Domain>,
        (grains, entries, springs): (&mut Vec<Grain>, &mut Vec<Entry>, &mut Option<Springs>),
    ) -> Result<(), SceneError> {
        let check = &self.check;
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
                entries.push(Entry { grain: grains.len(), time });
                grains.push(group.grain(centre, radius, density, velocity));
            }
        } else if let Some(state) = &spec.state {
            self.grains_from_state(name, state, material, (grains, springs))?;
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
