//! The fingerprint of a scene: two scenes of one fingerprint are one run of a program.

use std::fmt::{self, Write as _};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use grainbench_scene::end_state::Springs;
use grainbench_scene::grains::Grains;
use grainbench_scene::scene::{Driven, Grain, Scene, Wall};

use crate::deck::Stepping;
use nalgebra::Vector3;

/// The BLAKE3 hash of all in a scene and its stepping that a run of rigid grains depends on, in lower-case hexadecimal.
///
/// Titles, names of materials, how often samples are taken, and what deformable bodies alone have are left out. Numbers
/// go in with all their digits.
#[must_use]
pub fn scene_hash(scene: &Scene, stepping: &Stepping) -> String {
    let mut text =
        format!("{:?} {:?} {:?} {}\n", scene.dimension, scene.grain_shape, scene.gravity, scene.global_damping);
    let _ = writeln!(text, "{:?} {}", stepping.time_step, stepping.steps);
    if let Some(domain) = scene.domain {
        let _ = writeln!(text, "domain {:?} {:?} {:?}", domain.low, domain.high, domain.periodic);
    }
    for law in &scene.laws {
        let _ = writeln!(text, "law {} {}", law.is_some(), law.unwrap_or_default().identity());
    }
    text.push_str(&lines_of(&scene.grains));
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
        text.push_str(&text_of(springs));
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

/// Texts of the last few large lists, by the hash of their bits, which is found a hundred times sooner than a text is written.
/// The same list is asked for by every variant and every control that begins with it.
struct Known(Mutex<Vec<(blake3::Hash, Lines)>>);

/// The text of a list, which the first who asks for it writes while others wait for this list alone.
type Lines = Arc<OnceLock<Arc<str>>>;

/// Members of a large list.
const LARGE: usize = 1000;
/// So many lists are remembered.
const FEW: usize = 6;

static GRAINS: Known = Known::new();
static SPRINGS: Known = Known::new();

impl Known {
    const fn new() -> Self {
        Self(Mutex::new(Vec::new()))
    }

    /// The text of a list of so many members and these bits, which `write` makes where it is not known.
    fn text(&self, members: usize, bits: impl FnOnce() -> Vec<u8>, write: impl FnOnce() -> String) -> Arc<str> {
        if members < LARGE {
            return write().into();
        }
        let lines = self.lines(blake3::hash(&bits()));
        Arc::clone(lines.get_or_init(|| write().into()))
    }

    /// Where the text of a list is, or will be.
    fn lines(&self, of: blake3::Hash) -> Lines {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, lines)) = known.iter().find(|(other, _)| *other == of) {
            return Arc::clone(lines);
        }
        let lines = Lines::default();
        known.truncate(FEW - 1);
        known.insert(0, (of, Arc::clone(&lines)));
        lines
    }
}

/// Bytes of the line of a grain, or more.
const LINE: usize = 256;

/// The lines of all grains.
fn lines_of(grains: &Grains) -> Arc<str> {
    let write = || {
        let mut text = String::with_capacity(grains.len() * LINE);
        for Grain { material, radius, mass, inertia, position, velocity, spin } in grains {
            let (position, velocity, spin) = (Column(position), Column(velocity), Column(spin));
            let _ =
                writeln!(text, "grain {material} {radius:?} {mass:?} {inertia:?} {position:?} {velocity:?} {spin:?}");
        }
        text
    };
    GRAINS.text(grains.len(), || grains.bits(), write)
}

/// The text of springs.
fn text_of(springs: &Springs) -> Arc<str> {
    SPRINGS.text(springs.pairs.len(), || springs.bits(), || format!("springs {springs:?}\n"))
}

/// A vector in the words of its own debug output, which takes twice as long for builders of nested lists.
struct Column<'a>(&'a Vector3<f64>);

impl fmt::Debug for Column<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(vector) = self;
        write!(out, "[[{:?}, {:?}, {:?}]]", vector.x, vector.y, vector.z)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;
    use grainbench_scene::solver::Resolution;
    use grainbench_scene::source::SceneSource;
    use std::path::Path;

    const SCENE: &str = "title = 'a'\ndimension = 2\nduration = 1.0\n[materials.rock]\ndensity = 1e3\n\
        [contacts.rock]\nbetween = ['rock', 'rock']\nnormal_stiffness = 1e6\n\
        [grains.disc]\nmaterial = 'rock'\nradius = 0.5\nposition = [0.0, 0.0]\n";

    #[test]
    fn vectors_are_written_as_their_debug_output() {
        for vector in [Vector3::new(-0.0, 1e-5, 1e16), Vector3::new(0.1 + 0.2, -1e-300, f64::MAX), Vector3::zeros()] {
            assert_eq!(format!("{:?}", Column(&vector)), format!("{vector:?}"));
        }
    }

    #[test]
    fn physics_counts_and_titles_do_not() {
        let scene = SceneSource::from_text("s", Path::new("."), SCENE).scene(&|_| Err(String::new())).unwrap();
        let hash = |change: fn(&mut Scene), step: f64| {
            let mut scene = scene.clone();
            change(&mut scene);
            scene_hash(&scene, &Stepping::of(&scene, &Resolution::TimeStep(step)).unwrap())
        };
        let own = hash(|_| {}, 1e-3);
        assert_eq!(own, hash(|scene| scene.title = "b".to_owned(), 1e-3));
        assert_ne!(own, hash(|_| {}, 2e-3));
        assert_ne!(own, hash(|scene| scene.grains[0].position.x = f64::from_bits(1), 1e-3));
        assert_ne!(own, hash(|scene| scene.change_laws(|law| law.friction = 0.1), 1e-3));
        assert_ne!(own, hash(|scene| scene.gravity.y = -9.8, 1e-3));
    }
}
