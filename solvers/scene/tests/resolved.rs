//! Tests of scene keys, and of resolved scenes against values computed by hand. A formula that reads the resolved scene
//! would repeat its errors.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use grainbench_scene::contact_law::Springs;
use grainbench_scene::material::Constitutive;
use grainbench_scene::scene::Scene;
use grainbench_scene::source::SceneSource;
use std::path::Path;

fn scene(text: &str) -> Scene {
    Scene::from_text("test", text).unwrap()
}

/// Returns the error message of an invalid scene.
fn refusal(text: &str) -> String {
    Scene::from_text("test", text).unwrap_err().to_string()
}

fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-9 * expected.abs(), "{found} for {expected}");
}

/// Steel on glass: E = 210 and 70 GPa, ν = .3 and .2. 1/E* = .91/210 + .96/70 = 3.79/210 per GPa; G = 80.769230769 and
/// 29.166666667 GPa, 1/G* = 1.7/80.769230769 + 1.8/29.166666667 = .0210476190 + .0617142857 per GPa.
#[test]
fn moduli_of_two_materials() {
    let scene = scene(
        "title = 't'\ndimension = 3\nduration = 1.0\n\
         [materials]\nsteel = { density = 7800.0, young_modulus = 210e9, poisson_ratio = 0.3 }\n\
         glass = { density = 2500.0, young_modulus = 70e9, poisson_ratio = 0.2 }\n\
         [contacts.pair]\nbetween = ['steel', 'glass']\nlaw = 'hertz'\nrestitution = 0.5\n\
         [grains.a]\nmaterial = 'steel'\nradius = 0.01\nposition = [0.0, 0.0, 0.0]\n\
         [grains.b]\nmaterial = 'glass'\nradius = 0.02\nposition = [0.1, 0.0, 0.0]\n",
    );
    let law = scene.law(0, 1).unwrap();
    let Springs::Hertz { effective_modulus, effective_shear_modulus } = law.springs else { panic!("{law:?}") };
    close(effective_modulus, 210e9 / 3.79);
    close(effective_shear_modulus, 1e9 / 0.082_761_904_761_904_76);
    // ζ = ln 2/√(π² + ln² 2).
    close(law.damping_ratio, 0.215_453_761_966);
    // F_n/δ = (4/3) E* √(R* δ) with R* = 1/150 m at δ = 1e-6 m: two thirds of dF/dδ.
    let (tangent, shear) = law.springs.stiffness(1e-6, 1.0 / 150.0);
    close(law.springs.secant_stiffness(1e-6, 1.0 / 150.0), 4.0 / 3.0 * 210e9 / 3.79 * 8.164_965_809_277_26e-5);
    close(tangent, 2.0 * 210e9 / 3.79 * 8.164_965_809_277_26e-5);
    close(shear, 8.0 * 1e9 / 0.082_761_904_761_904_76 * 8.164_965_809_277_26e-5);
}

/// Gravity of 9.8 m/s² on a slope of 60°: sin 60° = .8660254037844386. A disc of 1000 kg/m³ with R = .5 m, one metre
/// deep, has m = 785.398163 kg and I = m R²/2. A sphere has m = 523.598776 kg and I = 2 m R²/5.
#[test]
fn slopes_masses_and_inertia() {
    let sloped_scene = |dimension: u8, position: &str| {
        scene(&format!(
            "title = 't'\ndimension = {dimension}\nduration = 1.0\ngravity = {{ magnitude = 9.8, slope_deg = 60.0 }}\n\
             materials.m.density = 1000.0\ncontacts.m = {{ between = ['m', 'm'], normal_stiffness = 4.0e6, \
             friction_angle_deg = 30.0, tangential_stiffness = 1.0 }}\n\
             [grains.a]\nmaterial = 'm'\nradius = 0.5\nposition = {position}\n"
        ))
    };
    let disc = sloped_scene(2, "[0.0, 0.0]");
    close(disc.gravity.x, 8.487_048_957_087_498);
    close(disc.gravity.y, -4.9);
    close(disc.grains[0].mass, 785.398_163_397_448_3);
    close(disc.grains[0].inertia, 98.174_770_424_681_03);
    close(disc.laws[0].unwrap().friction, 0.577_350_269_189_625_8);
    // 2 √(m/k) = 2 √(785.398…/4e6).
    close(disc.critical_time_step(), 2.0 * 0.014_012_478_040_994_82);
    let sphere = sloped_scene(3, "[0.0, 0.0, 0.0]");
    close(sphere.gravity.x, 8.487_048_957_087_498);
    close(sphere.gravity.z, -4.9);
    close(sphere.grains[0].mass, 523.598_775_598_298_9);
    close(sphere.grains[0].inertia, 52.359_877_559_829_89);
}

/// Grains of R = .5 m in a period of 10 m overlap across the periodic face by .7 m, which is 1.4 of the radius. The
/// overlap is found for two discs, for three discs, and for a disc that starts a period away.
#[test]
fn overlaps_are_found_across_a_period() {
    for xs in [vec![0.2, 9.9], vec![0.2, 5.0, 9.9], vec![9.9, 0.2], vec![10.2, 9.9], vec![0.2, 0.2 + 9.7]] {
        let grain = |(at, x)| format!("grains.g{at} = {{ material = 'm', radius = 0.5, position = [{x}, 1.0] }}\n");
        let grains: String = xs.iter().enumerate().map(grain).collect();
        let message = refusal(&format!(
            "title = 't'\ndimension = 2\nduration = 1.0\n\
             domain = {{ low = [0.0, 0.0], high = [10.0, 4.0], periodic = [true, false] }}\n\
             materials.m.density = 1.0\ncontacts.m = {{ between = ['m', 'm'], normal_stiffness = 1.0 }}\n{grains}"
        ));
        assert!(message.contains("1.4"), "{xs:?}: {message}");
    }
}

/// A grain with its centre on a face of the domain is accepted, at any position of the domain. A grain beyond the face
/// is rejected.
#[test]
fn a_grain_on_a_face_is_in_its_domain() {
    let text = |low: f64, x: f64| {
        format!(
            "title = 't'\ndimension = 2\nduration = 1.0\n\
             domain = {{ low = [{low}, -3.0], high = [{}, -1.0], periodic = [false, false] }}\n\
             materials.m.density = 1.0\ncontacts.m = {{ between = ['m', 'm'], normal_stiffness = 1.0 }}\n\
             [grains.a]\nmaterial = 'm'\nradius = 0.1\nposition = [{x}, -2.0]\n",
            low + 2.0
        )
    };
    for low in [-9.0, -1.0, 0.0, 5.0] {
        for x in [low, low + 2.0] {
            close(scene(&text(low, x)).grains[0].position.x, x);
        }
        for x in [low - 1e-6, low + 2.0 + 1e-6] {
            assert!(refusal(&text(low, x)).contains("within the domain"), "{low}, {x}");
        }
    }
}

/// The centre of a disc of R = .5 m is .4 m above a plane, so the overlap is .2 of the radius.
#[test]
fn overlaps_with_walls_are_parts_of_the_radius() {
    let text = |height: f64| {
        format!(
            "title = 't'\ndimension = 2\nduration = 1.0\nmaterials.m.density = 1.0\n\
             contacts.m = {{ between = ['m', 'm'], normal_stiffness = 1.0 }}\n\
             [grains.a]\nmaterial = 'm'\nradius = 0.5\nposition = [0.0, {height}]\n\
             [walls.w]\nmaterial = 'm'\nplane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}\n"
        )
    };
    let found = refusal(&text(0.4));
    assert!(found.contains("grain 1 and wall w overlapping by 0.2000 of the radius"), "{found}");
    close(scene(&text(0.46)).grains[0].position.y, 0.46);
}

#[test]
fn one_viscosity_alone_is_a_viscosity() {
    for numbers in [[1.0, 2.0], [1.0, 0.0], [0.0, 2.0]] {
        let [viscosity, bulk_viscosity] = numbers;
        assert_eq!(Constitutive::KelvinVoigt { viscosity, bulk_viscosity }.viscosities(), Some(numbers));
    }
    assert_eq!(Constitutive::KelvinVoigt { viscosity: 0.0, bulk_viscosity: 0.0 }.viscosities(), None);
}

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
fn axes_are_named_or_listed() {
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
