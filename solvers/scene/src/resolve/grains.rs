//! Grains of a scene file.

use super::{Groups, Resolver};
use crate::end_state::Springs;
use crate::error::SceneError;
use crate::file::{FileSpec, GrainShape, GrainsSpec, PackedSpec, SpacingSpec};
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
        check.exactly_one(
            &format!("grains.{name}"),
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
        // The grains of a state or of a data file have their own size and motion.
        let sources = [("state", spec.state.is_some()), ("file", spec.file.is_some())];
        let keys =
            [("radius", spec.radius.is_some()), ("velocity", spec.velocity.is_some()), ("spin", spec.spin.is_some())];
        if let (Some((source, _)), Some((part, _))) =
            (sources.into_iter().find(|(_, is_given)| *is_given), keys.into_iter().find(|(_, is_given)| *is_given))
        {
            return Err(check.error(&key(part), &format!("none, because `{source}` contains it"), "one"));
        }
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
            let dimensions = check.dimension.count();
            if lattice.count.len() != dimensions || lattice.count.contains(&0) {
                let expected = format!("{dimensions} counts of at least one");
                return Err(check.error(&key("count"), &expected, &format!("{:?}", lattice.count)));
            }
            let total = lattice.count.iter().fold(1_u128, |total, &count| total * u128::from(count));
            self.refuse_too_many(&key("count"), total)?;
            let count = [lattice.count[0], lattice.count[1], lattice.count.get(2).copied().unwrap_or(1)];
            let (radius, density) = (radius()?, density()?);
            let mut centres = match (&lattice.spacing, lattice.close_packed) {
                (SpacingSpec::Along(spacing), false) => {
                    generate::lattice(origin, check.vector(&key("spacing"), spacing)?, count)
                }
                (SpacingSpec::Nearest(spacing), true) => {
                    generate::close_packed(origin, check.positive(&key("spacing"), *spacing, "distance (m)")?, count)
                }
                (SpacingSpec::Nearest(found), false) => {
                    let expected = format!("{dimensions} distances, or `close_packed = true`");
                    return Err(check.error(&key("spacing"), &expected, &found.to_string()));
                }
                (SpacingSpec::Along(found), true) => {
                    return Err(check.error(
                        &key("spacing"),
                        "one number, the distance of nearest neighbours",
                        &format!("{found:?}"),
                    ));
                }
            };
            let perturbation = check.not_negative(&key("perturbation"), lattice.perturbation, "length (m)")?;
            if perturbation > 0.0 {
                generate::perturb(&mut centres, perturbation, lattice.seed, check.dimension);
            }
            grains.extend(centres.into_iter().map(|centre| grain(centre, radius, density, velocity)));
        }
        if let Some(random) = &spec.random {
            let key = |part: &str| format!("grains.{name}.random.{part}");
            self.refuse_too_many(&key("count"), u128::from(random.count))?;
            let Some(domain) = domain else {
                return Err(check.error(&key("count"), "a `domain` to place grains in", "none"));
            };
            let radii = self.radii(&format!("grains.{name}.random"), random, shape, &radius)?;
            let part = match &random.region {
                Some(region) => self.region_of(&key("region"), region, domain)?,
                None => *domain,
            };
            let speed = check.not_negative(&key("speed"), random.speed, "speed (m/s)")?;
            let density = density()?;
            let placed = generate::random(random.count, random.seed, &radii, speed, &part, check.dimension).map_err(
                |NoRoom { share, is_costly }| {
                    let place = if random.region.is_some() { "region" } else { "domain" };
                    let found = format!("{} that would fill {share:.2} of it", random.count);
                    if is_costly {
                        let expected =
                            format!("a count and radii for which the search finds room in the {place} within a minute");
                        return check.error(&key("count"), &expected, &found);
                    }
                    let help = "randomly placed equal discs fill at most 0.55, and spheres at most 0.38; `packed` is \
                                denser";
                    let expected = format!("grains that find room in the {place}");
                    check.source.error(&key("count"), &expected, &found, Some(help.to_owned()))
                },
            )?;
            grains.extend(
                placed.into_iter().map(|place| grain(place.position, place.radius, density, velocity + place.velocity)),
            );
        }
        if let Some(packed) = &spec.packed {
            let density = density()?;
            let places = self.packed(name, packed, domain)?;
            grains.extend(places.into_iter().map(|(centre, radius)| grain(centre, radius, density, velocity)));
        }
        if let Some(poured) = &spec.poured {
            self.refuse_too_many(&format!("grains.{name}.poured.count"), u128::from(poured.count))?;
            let (radius, density) = (radius()?, density()?);
            for (time, centre) in self.pour(name, spec, poured, radius, velocity, domain)? {
                entries.push(Entry { grain: grains.len(), time });
                grains.push(grain(centre, radius, density, velocity));
            }
        }
        if let Some(state) = &spec.state {
            self.grains_from_state(name, state, material, (grains, springs))?;
        }
        if let Some(file) = &spec.file {
            self.grains_from_file(name, file, shape, material, grains)?;
        }
        Ok(())
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
            return Err(check.error(&key, "a `domain` to pack grains into", "none"));
        };
        let total: u64 = packed.radii.iter().map(|&(_, count)| u64::from(count)).sum();
        if !(1..=u64::from(packing::MOST)).contains(&total) {
            return Err(check.error(&key, &format!("1 to {} grains", packing::MOST), &total.to_string()));
        }
        let mut radii = Vec::new();
        for &(radius, count) in &packed.radii {
            let radius = check.positive(&key, radius, "radius (m)")?;
            radii.extend(std::iter::repeat_n(radius, count as usize));
        }
        let pack = if packed.cut { packing::pack_cut } else { packing::pack };
        let centres = pack(&radii, packed.seed, domain, check.dimension).ok_or_else(|| {
            let asked = packing::filled(radii.iter().copied(), domain, check.dimension);
            let expected = match packing::reachable(&radii, packed.seed, domain, check.dimension, packed.cut) {
                Some(share) => {
                    format!("grains that fill at most {share:.2} of the domain, the densest packing of these grains")
                }
                None => "grains that fill at most half of the domain, because no denser packing was found".to_owned(),
            };
            check.error(&key, &expected, &format!("{total} grains that would fill {asked:.2} of it"))
        })?;
        Ok(centres.into_iter().zip(radii).collect())
    }

    /// Rejects grains whose moment of inertia is not positive and finite, or whose position is not finite. Finite input
    /// can cause both, because products overflow or underflow.
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
                            format!("a period along {letter} no shorter than a grain, {} m", 2.0 * grain.radius);
                        return Err(self.check.error("domain", &expected, &format!("{} m", high - low)));
                    }
                    let slack = 1e-9 * (high - low);
                    if !domain.periodic[axis] && !(low - slack..=high + slack).contains(&centre) {
                        let key = format!("grains.{name}");
                        let expected = format!("grain {} within the domain, {letter} from {low} to {high} m", at + 1);
                        return Err(self.check.error(&key, &expected, &format!("{letter} = {centre} m")));
                    }
                }
            }
        }
        Ok(())
    }

    /// Rejects a number of grains that exceeds 100 million or the available memory.
    fn refuse_too_many(&self, key: &str, count: u128) -> Result<(), SceneError> {
        if count > 100_000_000 {
            return Err(self.check.error(key, "at most 100 million grains", &count.to_string()));
        }
        match memory::beyond(count as f64, "grains", BYTES_OF_A_GRAIN) {
            Some(found) => Err(self.check.error(key, "grains that fit into memory", &found)),
            None => Ok(()),
        }
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
