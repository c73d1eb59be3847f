//! Tests of parts of the method that no case of the registry isolates: moving walls, periodic faces, cohesion, and
//! prescribed motion of grains.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use grainbench_dem::convention::Convention;
use grainbench_dem::solver::Dem;
use grainbench_solver::Solver;
use grainbench_solver::resolution::Resolution;
use support::{MATERIAL, last, run, run_as, scene};

/// A belt with velocity V drags a disc until the surface of the disc moves with the belt. The disc then has the
/// velocity v = V i/(1+i) = V/3 with i = I/(m R²).
#[test]
fn a_belt_drags_a_disc_to_a_third_of_its_speed() {
    let record = run("dimension = 2\nduration = 1.0\ngravity = [0.0, -9.8]\nmaterials.n.density = 1000.0\n\
         contacts.n = { between = ['n', 'n'], normal_stiffness = 1.0e6, tangential_stiffness = 3.0e5, friction = 0.5, \
         normal_damping = 200.0, tangential_damping = 200.0 }\n\
         [grains.g]\nmaterial = 'n'\nradius = 0.1\nposition = [0.0, 0.1]\n\
         [walls.w]\nmaterial = 'n'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n\
         motion = [{ velocity = [0.9, 0.0] }]\n[probes]\ng.grain = 'g'\n");
    assert!((last(&record, "g.vx") - 0.3).abs() < 1e-6, "{}", last(&record, "g.vx"));
    assert!((last(&record, "g.omega") - 6.0).abs() < 1e-5, "the top lags, so it turns counter-clockwise");
}

/// A collision across a periodic face gives the same result as a collision in the middle of the domain.
#[test]
fn a_periodic_face_is_not_felt() {
    let scene = |x: f64, dimension: u8| {
        let (zero, periodic) = if dimension == 2 { ("", "") } else { (", 5.0", ", true") };
        run(&format!(
            "dimension = {dimension}\nduration = 0.1\n\
             contacts.n = {{ between = ['n', 'n'], normal_stiffness = 1.0e6, tangential_stiffness = 5.0e5, friction = 0.4 }}\n\
             domain = {{ low = [0.0, 0.0{}], high = [10.0, 10.0{}], periodic = [true, true{periodic}] }}\n\
             materials.n.density = 1000.0\n\
             [grains.a]\nmaterial = 'n'\nradius = 0.5\nposition = [{}, 5.0{zero}]\nvelocity = [1.0, 0.0{}]\n\
             [grains.b]\nmaterial = 'n'\nradius = 0.5\nposition = [{}, 5.3{zero}]\nvelocity = [-1.0, 0.0{}]\n\
             [probes]\nall.system = true\na.grain = 'a'\n",
            if dimension == 2 { "" } else { ", 0.0" },
            if dimension == 2 { "" } else { ", 10.0" },
            (x - 0.49_f64).rem_euclid(10.0),
            if dimension == 2 { "" } else { ", 0.0" },
            (x + 0.49_f64).rem_euclid(10.0),
            if dimension == 2 { "" } else { ", 0.0" },
        ))
    };
    for dimension in [2, 3] {
        let (middle, face) = (scene(5.0, dimension), scene(10.0, dimension));
        for column in ["a.vx", "a.vy", if dimension == 2 { "a.omega" } else { "a.omega_z" }] {
            assert!((last(&middle, column) - last(&face, column)).abs() < 1e-9, "{column} in {dimension} dimensions");
        }
        assert!(last(&middle, "a.vx") < 0.9, "they met");
    }
}

/// With cohesion c, a disc rolls down a slope θ without slip if and only if m g sin θ/3 ≤ μ m g cos θ + c. Otherwise it
/// slips, with the acceleration g sin θ − μ g cos θ − c/m.
#[test]
fn cohesion_carries_shear_without_load() {
    let mass = 1000.0 * std::f64::consts::PI * 0.01;
    let run = |cohesion: f64| {
        let text = format!(
            "dimension = 2\nduration = 0.5\ngravity = {{ magnitude = 10.0, slope_deg = 60.0 }}\nmaterials.n.density = 1000.0\n\
             contacts.n = {{ between = ['n', 'n'], normal_stiffness = 1.0e7, tangential_stiffness = 1.0e7, friction = 0.2, \
             cohesion = {cohesion}, normal_damping = 500.0, tangential_damping = 500.0 }}\n\
             [grains.g]\nmaterial = 'n'\nradius = 0.1\nposition = [0.0, 0.1]\n\
             [walls.w]\nmaterial = 'n'\nplane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}\n[probes]\ng.grain = 'g'\n"
        );
        last(&run_as(&text, Convention::CUNDALL_STRACK), "g.vx") / 0.5
    };
    let (sine, cosine) = (60_f64.to_radians().sin(), 60_f64.to_radians().cos());
    let threshold = mass * 10.0 * (sine / 3.0 - 0.2 * cosine);
    let rolling = 10.0 * sine * 2.0 / 3.0;
    assert!((run(1.01 * threshold) / rolling - 1.0).abs() < 1e-3);
    let slipping = |cohesion: f64| 10.0 * (sine - 0.2 * cosine) - cohesion / mass;
    assert!((run(0.5 * threshold) / slipping(0.5 * threshold) - 1.0).abs() < 5e-3);
}

/// Two discs with prescribed motion shear a third disc between them, with friction. The prescribed motions are exact, and
/// the change of momentum equals the impulse. The energy budget is closed up to 0.1 % of the supplied work, and only if
/// it includes friction.
#[test]
fn driven_grains_give_what_they_say() {
    let friction = "contacts.m = { between = ['m', 'm'], normal_stiffness = 1.0e6 }";
    let rough =
        "contacts.m = { between = ['m', 'm'], normal_stiffness = 1.0e6, tangential_stiffness = 1.0e6, friction = 0.3 }";
    let text = format!(
        "{}{}",
        MATERIAL.replace('"', "'").replace(friction, rough),
        "dimension = 2\nduration = 0.5\n\
         domain = { low = [-0.1, -1.0], high = [0.3, 1.0] }\n\
         [grains.row]\nmaterial = 'm'\nradius = 0.1\nlattice = { origin = [-0.1, 0.0], spacing = [0.199, 0.2], count = [3, 1] }\n\
         [driven.left]\nface = 'x-low'\n[driven.right]\nface = 'x-high'\nvelocity = [0.0, 0.2]\n\
         [probes]\nmoved.grain = 'row.3'\nstill.grain = 'row.1'\nfree.grain = 'row.2'\n\
         budget.budget = true\nright.driven = 'right'\n"
    );
    let scene = scene(&text).unwrap();
    assert_eq!(scene.driven.iter().map(|driven| driven.grains.clone()).collect::<Vec<_>>(), [[0], [2]]);
    let record =
        Dem::new(Convention::CUNDALL_STRACK).run(&scene, &Resolution::CriticalFraction(0.02), &mut ()).unwrap();
    assert!((last(&record, "moved.y") - 0.1).abs() < 1e-12 && last(&record, "still.y") == 0.0);
    assert!(last(&record, "moved.omega") == 0.0 && last(&record, "free.omega") != 0.0);
    let budget = |entry: &str| last(&record, &format!("budget.{entry}"));
    for axis in ["x", "y"] {
        let start = record.series.column(&format!("budget.momentum_{axis}")).unwrap()[0];
        let off = budget(&format!("momentum_{axis}")) - start - budget(&format!("impulse_{axis}"));
        assert!(off.abs() < 1e-10, "{axis}: {off}");
    }
    let open = budget("unbalanced") - record.series.column("budget.unbalanced").unwrap()[0];
    assert!(budget("friction") > 0.0 && open.abs() < 1e-3 * budget("work").abs(), "{open} of {}", budget("work"));
    assert!((open - budget("friction")).abs() > 1e-2 * budget("work").abs(), "it would not close without friction");
}

/// Grains in a box are held, grains outside it are free. The effective mass of the contact of a held grain with a wall is
/// zero, so the dashpot of this contact has no effect. The grain stays at its position, and the spring of the contact
/// exerts its usual force.
#[test]
fn grains_of_a_region_are_held_against_a_wall() {
    let text = "dimension = 2\nduration = 0.01\n\
         materials.n.density = 1000.0\n\
         contacts.n = { between = ['n', 'n'], normal_stiffness = 1.0e6, tangential_stiffness = 1.0e6, friction = 0.5, \
         normal_damping = 50.0, tangential_damping = 50.0 }\n\
         [grains.row]\nmaterial = 'n'\nradius = 0.5\nlattice = { origin = [0.499, 0.0], spacing = [1.0, 1.0], count = [3, 1] }\n\
         [walls.left]\nmaterial = 'n'\nplane = { point = [0.0, 0.0], normal = [1.0, 0.0] }\n\
         [driven.held]\nregion = { low = [0.0, -1.0], high = [2.0, 1.0] }\n\
         [probes]\nall.system = true\nfirst.grain = 'row.1'\nlast.grain = 'row.3'\nc.contact = ['row.1', 'left']\n";
    let scene = |text: &str| scene(&format!("{MATERIAL}{text}"));
    assert_eq!(scene(text).unwrap().driven[0].grains, [0, 1]);
    let record = run(text);
    assert_eq!((last(&record, "first.x"), last(&record, "last.x")), (0.499, 2.499));
    assert!((last(&record, "c.normal_force") - 1e3).abs() < 1e-6 && last(&record, "all.total_energy").is_finite());
    let empty = text.replace("low = [0.0, -1.0], high = [2.0, 1.0]", "low = [0.0, 1.0], high = [2.0, -1.0]");
    assert!(scene(&empty).unwrap_err().to_string().contains("driven.held.region.high: expected a corner above `low`"));
}

/// A disc slides along a floor. In the default convention, friction stays within the Coulomb limit at every step, even
/// with a strong dashpot. In the convention of 1979, it exceeds the limit, because the dashpot is added without limit
/// while the contact sticks.
#[test]
fn friction_never_passes_coulombs_limit() {
    let text = "dimension = 2\nduration = 0.002\ngravity = [0.0, -9.81]\n\
         materials.n.density = 2000.0\n\
         contacts.n = { between = ['n', 'n'], normal_stiffness = 3.08e9, tangential_stiffness = 8.8e8, friction = 0.3, \
         normal_damping = 840.0, tangential_damping = 840.0 }\n\
         [grains.g]\nmaterial = 'n'\nradius = 0.5\nposition = [0.0, 0.499995]\nvelocity = [1.0, 0.0]\n\
         [walls.floor]\nmaterial = 'n'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n\
         [probes]\nc.contact = ['g', 'floor']\n";
    let most = |convention| {
        let record = run_as(text, convention);
        let column = |name: &str| record.series.column(name).unwrap().to_vec();
        let forces = column("c.normal_force").into_iter().zip(column("c.shear_force"));
        forces.map(|(normal, shear)| shear.abs() / (0.3 * normal.max(f64::MIN_POSITIVE))).fold(0.0, f64::max)
    };
    assert!(most(Convention::DEFAULT) <= 1.0 + 4.0 * f64::EPSILON, "{}", most(Convention::DEFAULT));
    assert!(most(Convention::CUNDALL_STRACK) > 100.0, "{}", most(Convention::CUNDALL_STRACK));
}

/// Two discs in contact across the corner of two periodic axes repel each other along their line of centres.
#[test]
fn grains_meet_across_the_corner_of_two_periodic_axes() {
    let record = run("dimension = 2\nduration_cycles = 1\n\
         [domain]\nlow = [0.0, 0.0]\nhigh = [1.0, 2.0]\nperiodic = [true, true]\n\
         [grains.a]\nmaterial = 'm'\nradius = 0.1\nposition = [0.06, 0.075]\n\
         [grains.b]\nmaterial = 'm'\nradius = 0.1\nposition = [0.94, 1.925]\n\
         [probes]\na.grain = 'a'\nb.grain = 'b'\nc.contact = ['a', 'b']\n");
    // The vector from `a` to the image of `b` is (−.12, −.15) m, with a length of .192094 m. The stiffness is k = 1e6 N/m.
    let overlap = 0.2 - (0.12_f64 * 0.12 + 0.15 * 0.15).sqrt();
    assert!((record.series.column("c.overlap").unwrap()[0] - overlap).abs() < 1e-15);
    assert!((record.series.column("c.normal_force").unwrap()[0] - 1e6 * overlap).abs() < 1e-8);
    let velocity = ["a.vx", "a.vy", "b.vx", "b.vy"].map(|column| last(&record, column));
    assert!(velocity[0] > 0.0 && velocity[1] > 0.0, "{velocity:?}");
    assert!((velocity[1] / velocity[0] - 1.25).abs() < 1e-12, "along the line of centres: {velocity:?}");
    assert!((velocity[0] + velocity[2]).abs() < 1e-15 && (velocity[1] + velocity[3]).abs() < 1e-15);
}

/// A rotating wall drags a disc like a belt: the velocity of the wall at the contact point is ω × r.
#[test]
fn a_turning_wall_drags_by_its_velocity_where_it_touches() {
    // The plane rotates about (0, 2) m at .3 rad/s, so at the origin it moves at +.6 m/s along x. In one cycle, the
    // spring is displaced by this velocity times Δt.
    let record = run("dimension = 2\nduration_cycles = 2\n\
         materials.n.density = 1000.0\n\
         contacts.n = { between = ['n', 'n'], normal_stiffness = 1.0e6, tangential_stiffness = 5.0e5, friction = 100.0 }\n\
         [grains.g]\nmaterial = 'n'\nradius = 0.1\nposition = [0.0, 0.099]\n\
         [walls.w]\nmaterial = 'n'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n\
         motion = [{ spin = 0.3, centre = [0.0, 2.0] }]\n\
         [probes]\ng.grain = 'g'\nc.contact = ['g', 'w']\n");
    let step = record.provenance.time_step;
    let force = record.series.column("c.shear_force").unwrap()[1].abs();
    assert!((force / (5.0e5 * 0.6 * step) - 1.0).abs() < 1e-2, "{force} for {}", 5.0e5 * 0.6 * step);
    assert!(last(&record, "g.vx") > 0.0, "the disc is carried along");
}
