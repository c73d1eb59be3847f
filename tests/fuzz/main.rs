//! Scenes and files with random mistakes. Each item must give valid results, or an error with its position. It must not
//! panic, end the process, hang, or exceed the memory limit. A few items run by default. `GRAINBENCH_LONG=1` runs a
//! hundred thousand scenes and a million files. `GRAINBENCH_FUZZ=scenes:SEED:FROM:COUNT` (or `files:…`) runs a given
//! range, and `--nocapture` shows the progress. An item depends only on the seed and on its number, which are at the
//! beginning of each finding. A range of one item always prints the description of the item.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stderr, reason = "a test fails by panicking")]

#[path = "../../reference/tests/common/damage.rs"]
mod damage;
mod driver;
mod files;
#[path = "../mistakes/mod.rs"]
mod mistakes;
#[path = "../it/observer.rs"]
mod observer;
mod scenes;

use driver::{Kind, go};
use grainbench::dem::convention::Convention;
use grainbench::dem::solver::Dem;
use grainbench::scene::scene::Duration;
use grainbench::scene::source::SceneSource;
use grainbench::solver::Solver;
use grainbench::solver::resolution::Resolution;
use mistakes::{Mistake, PLANE, SPACE, STRANGE, make, two_grains};
use std::path::Path;

#[test]
fn scenes() {
    go(&Kind { name: "scenes", few: 600, many: 100_000, try_out: scenes::try_out });
}

#[test]
fn files() {
    go(&Kind { name: "files", few: 5_000, many: 1_000_000, try_out: files::try_out });
}

#[test]
fn the_scenes_themselves_are_fine() {
    for (text, variant) in [(PLANE, None), (PLANE, Some("steep")), (SPACE, None)] {
        let source = SceneSource::from_text("scene.toml", Path::new(""), text);
        let source = variant.map_or(source.clone(), |name| source.variant(name));
        let scene = source.scene(&two_grains).unwrap();
        let resolution = Resolution::CriticalFraction(0.1);
        Dem::new(Convention::LAMMPS).run(&scene, &resolution, &mut ()).unwrap();
    }
}

#[test]
fn every_strange_value_in_every_place() {
    for (text, place) in [PLANE, SPACE].into_iter().flat_map(|text| (0..60).map(move |place| (text, place))) {
        for value in 0..STRANGE.len() {
            let text = make(text, &Mistake::StrangeValue(place, value));
            match SceneSource::from_text("scene.toml", Path::new(""), &text).scene(&two_grains) {
                Err(error) => scenes::names_place(&error.to_string()).unwrap(),
                Ok(mut scene) => {
                    scene.duration = Duration::Cycles(4);
                    // Any result is accepted. The test only requires that there is one.
                    let _ = Dem::new(Convention::LAMMPS).run(&scene, &Resolution::CriticalFraction(0.1), &mut ());
                }
            }
        }
    }
}
