//! Hash of a scene. For two scenes with equal hashes, a program computes the same run.

use std::fmt::Write as _;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use grainbench_scene::end_state::Springs;
use grainbench_scene::scene::Grains;
use grainbench_scene::scene::{Driven, Grain, Scene, Wall};

use crate::deck::Stepping;

/// Returns the BLAKE3 hash, in lower-case hexadecimal, of the time steps and of all data of a scene that affect a run of
/// rigid grains.
///
/// Titles, names of materials, the sampling interval and data of deformable bodies are excluded. Numbers are hashed
/// with all their digits.
#[must_use]
pub fn scene_hash(scene: &Scene, stepping: &Stepping) -> String {
    hash_of(scene, stepping, &lines_of(&scene.grains), text_of)
}

/// Returns a hash like [`scene_hash`], but of the bits of grains and springs instead of their digits: `2:` followed by
/// the hash. Writing the digits takes a hundred times as long.
#[must_use]
pub fn scene_hash_by_bits(scene: &Scene, stepping: &Stepping) -> String {
    let hash_of_bits = |bits: &[u8]| blake3::hash(bits).to_hex().to_string();
    let grains = format!("grains {}\n", hash_of_bits(&scene.grains.bits()));
    let springs = |springs: &Springs| format!("springs {}\n", hash_of_bits(&springs.bits())).into();
    format!("{BY_BITS}{}", hash_of(scene, stepping, &grains, springs))
}

/// Returns true if a scene and its time steps have the hash `stored_hash`, by digits or by bits.
#[must_use]
pub fn is_scene_of(stored_hash: &str, scene: &Scene, stepping: &Stepping) -> bool {
    let found = if stored_hash.starts_with(BY_BITS) { scene_hash_by_bits } else { scene_hash };
    found(scene, stepping) == stored_hash
}

const BY_BITS: &str = "2:";

/// Returns the hash of a scene. `grains` is the text of its grains, and `of_springs` returns the text of its springs.
fn hash_of(scene: &Scene, stepping: &Stepping, grains: &str, of_springs: impl Fn(&Springs) -> Arc<str>) -> String {
    let mut text =
        format!("{:?} {:?} {:?} {}\n", scene.dimension, scene.grain_shape, scene.gravity, scene.global_damping);
    let _ = writeln!(text, "{:?} {}", stepping.time_step, stepping.steps);
    if let Some(domain) = scene.domain {
        let _ = writeln!(text, "domain {:?} {:?} {:?}", domain.low, domain.high, domain.periodic);
    }
    for law in &scene.laws {
        let _ = writeln!(text, "law {} {}", law.is_some(), law.unwrap_or_default().identity());
    }
    text.push_str(grains);
    for Wall { material, shape, motion, piston, until, .. } in &scene.walls {
        let _ = writeln!(text, "wall {material} {shape:?} {motion:?}");
        if let Some(piston) = piston {
            let _ = writeln!(text, "piston {piston:?}");
        }
        if let Some(until) = until {
            let _ = writeln!(text, "until {until:?}");
        }
    }
    if let Some(springs) = &scene.springs {
        text.push_str(&of_springs(springs));
    }
    if !scene.stays.is_always() {
        let _ = writeln!(text, "stays {:?}", scene.stays);
    }
    for driven in &scene.driven {
        let Driven { grains, velocity, span, spin, motion, .. } = driven;
        let _ = writeln!(text, "driven {grains:?} {velocity:?}");
        if driven.is_for_a_while() {
            let _ = writeln!(text, "from {span:?}");
        }
        if !(motion.is_empty() && *spin == nalgebra::Vector3::zeros()) {
            let _ = writeln!(text, "along {spin:?} {motion:?}");
        }
    }
    for probe in &scene.probes {
        let _ = writeln!(text, "probe {} {:?}", probe.name, probe.target);
    }
    blake3::hash(text.as_bytes()).to_hex().to_string()
}

/// Cache of the texts of the last few long lists of grains or springs, by the hash of their bits. Computing the hash
/// takes a hundredth of the time of writing the text.
///
/// All variants and negative controls that start from the same list share its text.
type ListCache = Mutex<Vec<(blake3::Hash, Lines)>>;

/// Text of a list. The first thread that needs the text writes it, and other threads wait.
type Lines = Arc<OnceLock<Arc<str>>>;

/// Minimum number of entries of a list that is cached.
const LARGE: usize = 1000;
/// Maximum number of cached lists.
const FEW: usize = 6;

static GRAINS: ListCache = Mutex::new(Vec::new());
static SPRINGS: ListCache = Mutex::new(Vec::new());

/// Returns the text of a list with `members` entries and the given bits. If the text is not in the cache, `write` creates
/// it.
fn cached(
    cache: &ListCache,
    members: usize,
    bits: impl FnOnce() -> Vec<u8>,
    write: impl FnOnce() -> String,
) -> Arc<str> {
    if members < LARGE {
        return write().into();
    }
    let key = blake3::hash(&bits());
    let mut known = cache.lock().unwrap_or_else(PoisonError::into_inner);
    let place = known.iter().position(|(other, _)| *other == key).unwrap_or_else(|| {
        known.truncate(FEW - 1);
        known.insert(0, (key, Lines::default()));
        0
    });
    let lines = Arc::clone(&known[place].1);
    // Other lists can be written meanwhile.
    drop(known);
    Arc::clone(lines.get_or_init(|| write().into()))
}

/// Estimated maximum length of the line of a grain (B).
const LINE: usize = 256;

/// Returns the text of all grains, one per line.
fn lines_of(grains: &Grains) -> Arc<str> {
    let write = || {
        let mut text = Numbers(String::with_capacity(grains.len() * LINE));
        // Material, radius, mass and inertia are often equal to those of the previous grain, so their text is reused.
        let (mut sizes, mut before) = (String::new(), None);
        for Grain { material, radius, mass, inertia, position, velocity, spin } in grains {
            let now = (material, [radius, mass, inertia].map(|size| size.to_bits()));
            if before != Some(now) {
                before = Some(now);
                sizes = format!("grain {material} {radius:?} {mass:?} {inertia:?}");
            }
            text.0.push_str(&sizes);
            for vector in [position, velocity, spin] {
                text.list(" [", vector.as_slice());
                text.0.push(']');
            }
            text.0.push('\n');
        }
        text.0
    };
    cached(&GRAINS, grains.len(), || grains.bits(), write)
}

fn text_of(springs: &Springs) -> Arc<str> {
    let write = || {
        let Springs { layout, pairs, walls } = springs;
        let mut text = Numbers(format!("springs Springs {{ layout: {layout:?}, pairs: ["));
        for (place, (first, second, numbers)) in pairs.iter().enumerate() {
            let _ = write!(text.0, "{}({first}, {second}", if place == 0 { "" } else { ", " });
            text.list(", ", numbers);
            text.0.push(')');
        }
        let _ = writeln!(text.0, "], walls: {walls:?} }}");
        text.0
    };
    cached(&SPRINGS, springs.pairs.len(), || springs.bits(), write)
}

/// Text of numbers in the format of their debug output. The standard builders of nested lists take twice as long.
struct Numbers(String);

impl Numbers {
    fn list(&mut self, before: &str, numbers: &[f64]) {
        self.0.push_str(before);
        self.0.push('[');
        for (place, number) in numbers.iter().enumerate() {
            self.0.push_str(if place == 0 { "" } else { ", " });
            let _ = write!(self.0, "{number:?}");
        }
        self.0.push(']');
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use grainbench_solver::resolution::Resolution;
    use nalgebra::Vector3;
    use proptest::prelude::*;

    const SCENE: &str = include_str!("../../../tests/scenes/flight.toml");

    proptest! {
        #[test]
        fn numbers_are_written_as_their_debug_output(bits: Vec<u64>) {
            let mut numbers = vec![0.0, -0.0, 1e-5, 1e-4, 9.999_999_999_999_999e-6, 1e16, 9_999_999_999_999_998.0, 5e-324];
            numbers.push(f64::NAN);
            numbers.extend(bits.iter().copied().map(f64::from_bits));
            numbers.extend(bits.iter().map(|&bits| bits as f64 / 1e23));
            numbers.extend(bits.iter().map(|&bits| bits as f64 / 1e18));
            let mut text = Numbers(String::new());
            text.list("", &numbers);
            prop_assert_eq!(text.0, format!("{numbers:?}"));
        }

        #[test]
        fn lists_are_written_as_their_debug_output(numbers: Vec<(u32, u32, Vec<f64>)>) {
            let springs = Springs {
                layout: "tangential \"spring\"".to_owned(),
                walls: numbers.iter().map(|(grain, _, values)| (*grain, "floor".to_owned(), values.clone())).collect(),
                pairs: numbers.clone(),
            };
            prop_assert_eq!(&*text_of(&springs), format!("springs {springs:?}\n"));
            let grain = |(_, _, values): &(u32, u32, Vec<f64>)| {
                let vector = |at: usize| Vector3::from_fn(|axis, _| values.get(at + axis).copied().unwrap_or(0.5));
                let (position, velocity, spin) = (vector(0), vector(1), vector(2));
                Grain { material: 3, radius: 0.1, mass: 2.5e-7, inertia: 1e-17, position, velocity, spin }
            };
            let grains = Grains::from(numbers.iter().map(grain).collect::<Vec<_>>());
            let line = |Grain { material, radius, mass, inertia, position, velocity, spin }: &Grain| {
                format!("grain {material} {radius:?} {mass:?} {inertia:?} {position:?} {velocity:?} {spin:?}\n")
            };
            prop_assert_eq!(&*lines_of(&grains), grains.iter().map(line).collect::<String>());
        }
    }

    #[test]
    fn physics_counts_and_titles_do_not() {
        let scene = Scene::from_text("s", SCENE).unwrap();
        let hash = |change: fn(&mut Scene), step: f64| {
            let mut scene = scene.clone();
            change(&mut scene);
            scene_hash(&scene, &Stepping::new(&scene, &Resolution::TimeStep(step)).unwrap())
        };
        let own = hash(|_| {}, 1e-3);
        assert_eq!(own, hash(|scene| scene.title = "b".to_owned(), 1e-3));
        assert_ne!(own, hash(|_| {}, 2e-3));
        assert_ne!(own, hash(|scene| scene.grains[0].position.x = f64::from_bits(1), 1e-3));
        assert_ne!(own, hash(|scene| scene.change_laws(|law| law.friction = 0.1), 1e-3));
        assert_ne!(own, hash(|scene| scene.gravity.y = -9.8, 1e-3));
        let stepping = Stepping::new(&scene, &Resolution::TimeStep(1e-3)).unwrap();
        let by_bits = scene_hash_by_bits(&scene, &stepping);
        assert!(is_scene_of(&own, &scene, &stepping) && is_scene_of(&by_bits, &scene, &stepping) && own != by_bits);
        for change in
            [|scene: &mut Scene| scene.grains[0].position.x = -0.0, |scene: &mut Scene| scene.gravity.y = -9.8]
        {
            let mut other = scene.clone();
            change(&mut other);
            assert!(!is_scene_of(&own, &other, &stepping) && !is_scene_of(&by_bits, &other, &stepping));
        }
    }
}
