//! Tests of the probes `system` and `stress`, of virials and of snapshot times, with values computed by hand.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use grainbench_scene::scene::Scene;
use grainbench_solver::record::{BodyState, ContactState, GrainState, Partner, Snapshot, StepState};
use grainbench_solver::recorder::Recorder;
use grainbench_solver::virial;
use nalgebra::Vector3;

fn scene(text: &str) -> Scene {
    Scene::from_text("test", text).unwrap()
}

/// Returns a contact of the grain 1 in the plane, from the overlap (m) and the forces (N).
fn touch(partner: Partner, normal: [f64; 2], overlap: f64, normal_force: f64, shear: [f64; 2]) -> ContactState {
    ContactState {
        grain: 1,
        partner,
        normal: Vector3::new(normal[0], normal[1], 0.0),
        overlap,
        normal_force,
        shear_force: Vector3::new(shear[0], shear[1], 0.0),
        ..ContactState::default()
    }
}

/// A disc of 1000 kg and 125 kg m² is at (2, 3) m with (4, 5) m/s and 6 rad/s. A body of 20 kg and 7 kg m² is at (1,
/// −2) m with (3, −1) m/s and −2 rad/s. Gravity is (3, −10) m/s². The internal kinetic energy is 11 J, and the springs
/// hold 13 J. The inertia tensors add 3 J and −8 kg m²/s to the values with scalar moments of inertia.
///
/// - Kinetic: ½ 1000 41 + ½ 20 10 + 11. Rotational: ½ 125 36 + ½ 7 4 + 3. Gravitational, −Σ m g·x: 1000 (10·3 − 3·2) − 20
///   (10·2 + 3·1).
/// - Angular momentum about the origin: 1000 (2·5 − 3·4) + 125·6 + 20 (1·(−1) + 2·3) − 7·2 − 8.
#[test]
fn energies_and_momenta() {
    let text = "title = 't'\ndimension = 2\nduration = 1.0\ngravity = [3.0, -10.0]\n\
                materials.m.density = 1273.2395447351628\n\
                [grains.a]\nmaterial = 'm'\nradius = 0.5\nposition = [2.0, 3.0]\n[probes]\nall.system = true\n";
    let scene = scene(text);
    let disc = GrainState {
        velocity: Vector3::new(4.0, 5.0, 0.0),
        spin: Vector3::new(0.0, 0.0, 6.0),
        ..GrainState::start(1, &scene.grains[0])
    };
    let body = BodyState {
        name: "b".to_owned(),
        mass: 20.0,
        inertia: 7.0,
        position: Vector3::new(1.0, -2.0, 0.0),
        velocity: Vector3::new(3.0, -1.0, 0.0),
        spin: Vector3::new(0.0, 0.0, -2.0),
        ..BodyState::default()
    };
    let grains = Snapshot::of_grains(&scene, 0, 0.0, vec![disc]);
    let snapshot = Snapshot { bodies: vec![body], contacts: Some(Vec::new()), ..grains };
    let mut recorder = Recorder::new(&scene, 1.0, 1);
    let look = StepState {
        inner_kinetic_energy: 11.0,
        uneven_rotational_energy: 3.0,
        uneven_angular_momentum: Vector3::new(0.0, 0.0, -8.0),
        ..StepState::of_rigid(snapshot, 13.0)
    };
    recorder.take(&scene, look);
    let series = recorder.finish().0;
    for (column, expected) in [
        ("kinetic_energy", 20_611.0),
        ("rotational_energy", 2267.0),
        ("elastic_energy", 13.0),
        ("gravitational_energy", 23_540.0),
        ("total_energy", 46_431.0),
        ("momentum_x", 4060.0),
        ("momentum_y", 4980.0),
        ("angular_momentum", -1172.0),
        ("contacts", 0.0),
        ("largest_spin", 6.0),
    ] {
        let found = series.column(&format!("all.{column}")).unwrap()[0];
        assert!((found - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{column}: {found} for {expected}");
    }
}

/// Three discs of R = .5 m lie in a periodic square of 2 m. The second is .9 m beside the first, with a repulsion of 10
/// N and a friction of 3 N upwards on the first. The third is .8 m above the first, with a repulsion of 20 N and a
/// friction of 4 N to the right on the first. The contact with the wall does not count.
///
/// With the vector l between the centres and the force f on the first disc, σ_ij = Σ l_i f_j/V, where V = 4 m². The
/// first row of σ is .9 m (−10, 3) N/V, and the second row is .8 m (4, −20) N/V. Two contacts of three discs give a
/// coordination number of 4/3.
#[test]
fn mean_stress_and_coordination() {
    let text = "title = 't'\ndimension = 2\nduration = 1.0\n\
                largest_initial_overlap = 0.5\ndomain = { low = [-1.0, -1.0], high = [1.0, 1.0], periodic = [true, true] }\n\
                materials.m.density = 1.0\ncontacts.m = { between = ['m', 'm'], normal_stiffness = 1.0 }\n\
                grains.a = { material = 'm', radius = 0.5, position = [0.0, 0.0] }\n\
                grains.b = { material = 'm', radius = 0.5, position = [0.9, 0.0] }\n\
                grains.c = { material = 'm', radius = 0.5, position = [0.0, 0.8] }\n\
                [walls.w]\nmaterial = 'm'\nsegment = [[-0.1, -0.45], [0.1, -0.45]]\n[probes]\nall.stress = true\n";
    let scene = scene(text);
    let grains = scene.grains.iter().zip(1..).map(|(grain, id)| GrainState::start(id, grain)).collect();
    let contacts = vec![
        touch(Partner::Grain(2), [1.0, 0.0], 0.1, 10.0, [0.0, 3.0]),
        touch(Partner::Grain(3), [0.0, 1.0], 0.2, 20.0, [4.0, 0.0]),
        touch(Partner::Wall(0), [0.0, -1.0], 0.05, 50.0, [1.0, 0.0]),
    ];
    let snapshot = Snapshot { contacts: Some(contacts), ..Snapshot::of_grains(&scene, 0, 0.0, grains) };
    let mut recorder = Recorder::new(&scene, 1.0, 1);
    recorder.take(&scene, StepState::of_rigid(snapshot, 0.0));
    let series = recorder.finish().0;
    for (column, expected) in
        [("sigma_xx", -2.25), ("sigma_yy", -4.0), ("sigma_xy", 0.675), ("coordination", 4.0 / 3.0)]
    {
        let found = series.column(&format!("all.{column}")).unwrap()[0];
        assert!((found - expected).abs() < 1e-12, "{column}: {found} for {expected}");
    }
}

/// A contact adds the product of its force and the vector l between the centres to the sum of V σ over its grains. The
/// length of l is R₁ + R₂ − δ. Spheres of radii .5 and .3 m with an overlap of .1 m have l = .7 m along x. The product
/// is −7 J for xx (−10 N) and 2.8 J for the shear force (4 N), half of which is the symmetric component xy.
#[test]
fn both_grains_of_a_contact_share_the_vector_between_them() {
    let contact = touch(Partner::Grain(2), [1.0, 0.0], 0.1, 10.0, [0.0, 4.0]);
    let mut sum = [0.0; 6];
    [0.5, 0.3].into_iter().for_each(|radius| virial::add(&mut sum, &contact, radius));
    for (found, expected) in sum.into_iter().zip([-7.0, 0.0, 0.0, 1.4, 0.0, 0.0]) {
        assert!((found - expected).abs() < 1e-14, "{found} for {expected}");
    }
}

/// Each snapshot is taken at the step nearest to the requested time.
#[test]
fn a_snapshot_is_taken_at_the_nearest_step() {
    let text = "title = 't'\ndimension = 2\nduration = 1.0\nmaterials.m.density = 1.0\n\
                [grains.a]\nmaterial = 'm'\nradius = 0.5\nposition = [0.0, 0.0]\n\
                [output]\nevery = 0.5\nsnapshots = 0\nsnapshot_times = [0.24, 0.26, 0.5, 0.76]\n";
    let scene = scene(text);
    assert_eq!(Recorder::new(&scene, 0.1, 10).snapshot_steps(), [0, 2, 3, 5, 8, 10]);
}
