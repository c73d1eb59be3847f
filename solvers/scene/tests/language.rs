//! Tests of scene keys: periodic axes, lattices, random grains and variants.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use grainbench_scene::scene::Scene;
use grainbench_scene::source::SceneSource;
use std::path::Path;

/// Scene text to which each test adds the keys of the group `g`. `tests/refusals/placed-grains.toml` contains the
/// invalid keys.
const SCENE: &str = "title = 't'\ndimension = 2\nduration = 1.0\nmaterials.m.density = 1.0\n\
    contacts.m = { between = ['m', 'm'], normal_stiffness = 1.0e3 }\n\
    domain = { low = [0.0, 0.0], high = [40.0, 40.0], periodic = PERIODIC }\n\
    [grains.g]\nmaterial = 'm'\n";

fn read(periodic: &str, group: &str) -> Result<Scene, String> {
    let text = SCENE.replace("PERIODIC", periodic) + group;
    Scene::from_text("s.toml", &text).map_err(|error| error.to_string())
}

const LATTICE: &str = "radius = 0.5\nlattice = { origin = [1.0, 1.0], spacing = [1.0, 1.0], count = [3, 3] }\n";

#[test]
fn axes_are_named_or_told_one_by_one() {
    let by_name = read("['x']", LATTICE).unwrap();
    assert_eq!(by_name, read("[true, false]", LATTICE).unwrap());
    assert_eq!(read("[]", LATTICE).unwrap().domain.unwrap().periodic, [false; 3]);
}

#[test]
fn a_lattice_is_along_the_axes_or_close_packed() {
    let lattice = |words: &str| {
        read("[]", &format!("radius = 0.5\nlattice = {{ origin = [1.0, 1.0], count = [3, 3], {words} }}\n"))
    };
    let packed = lattice("spacing = 1.0, close_packed = true").unwrap();
    assert_eq!(packed.grains.len(), 9);
    assert!((packed.grains[3].position.y - 1.0 - 0.75_f64.sqrt()).abs() < 1e-12);
    let moved = |seed: u32| lattice(&format!("spacing = [2.0, 2.0], perturbation = 0.1, seed = {seed}")).unwrap();
    assert!(moved(1) == moved(1) && moved(1) != moved(2), "a seed gives the same grains");
}

#[test]
fn grains_at_random_have_their_radii_and_their_region() {
    let random = |words: &str| read("['x']", &format!("random = {{ count = 40, seed = 1, {words} }}\n"));
    let within = "region = { low = [5.0, 5.0], high = [25.0, 20.0] }";
    let sieved = random(&format!("radii = {{ by_mass = [[0.2, 0.0], [0.4, 1.0]] }}, {within}")).unwrap();
    for grain in &sieved.grains {
        assert!((0.2..=0.4).contains(&grain.radius));
        for (axis, [low, high]) in [[5.0, 25.0], [5.0, 20.0]].into_iter().enumerate() {
            let place = grain.position[axis];
            assert!(place - grain.radius >= low && place + grain.radius <= high, "{place} of axis {axis}");
        }
    }
    let normal = "log_normal = { median = 0.3, deviation = 0.2, range = [0.2, 0.5] }";
    assert!(random(&format!("radii = {{ {normal} }}")).unwrap().grains.iter().any(|grain| grain.radius > 0.3));
}

/// An empty string removes a key, both in a variant and with `--set`.
#[test]
fn a_variant_takes_keys_away() {
    const VARIANTS: &str = "[walls.floor]\nmaterial = 'm'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n\
        [variants.open]\nwalls.floor = ''\ndomain.periodic = ''\n[variants.nothing]\nwalls.roof = ''\n";
    let text = SCENE.replace("PERIODIC", "['x']") + LATTICE + VARIANTS;
    let source = || SceneSource::from_text("s.toml", Path::new(""), &text);
    let resolve = |source: SceneSource| source.scene(&grainbench_scene::resolve::no_data_file);
    let (plain, open) = (resolve(source()).unwrap(), resolve(source().variant("open")).unwrap());
    assert_eq!((plain.walls.len(), open.walls.len()), (1, 0));
    assert_eq!((plain.domain.unwrap().periodic[0], open.domain.unwrap().periodic[0]), (true, false));
    assert_eq!(open, resolve(source().set("walls.floor", "").set("domain.periodic", "")).unwrap());
    let message = resolve(source().variant("nothing")).unwrap_err().to_string();
    assert!(message.contains("walls.roof"), "{message}");
}
