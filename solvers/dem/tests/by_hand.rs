//! Comparison of forces, moments and energies with values computed by hand. Most grains are so heavy that forces do not
//! move them. The response of a contact to a prescribed motion is then exact to rounding, including the effect of the
//! time step.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use grainbench_dem::convention::Convention;
use grainbench_dem::stability::damped_step;
use grainbench_solver::record::{Record, Snapshot};
use grainbench_solver::resolution::Resolution;
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, PI};
use support::{column, last, run, run_at, scene};

/// Relative tolerance. A number has sixteen significant digits. Sums over some thousand steps lose at most three digits.
/// The difference of two lengths that are ten times as large as the resulting overlap loses one digit.
const ROUNDING: f64 = 1e-10;

/// Material 10¹⁷ times as dense as water, with springs of 1e6 N/m (normal) and 5e5 N/m (tangential) and
/// stiffness-proportional damping of 0.02 s. The coefficient of friction is so large that contacts do not slip.
const HEAVY: &str = "materials.h.density = 1.0e20\n\
    contacts.h = { between = ['h', 'h'], normal_stiffness = 1.0e6, tangential_stiffness = 5.0e5, friction = 1.0e3, \
    stiffness_damping = 0.02 }\n";

fn heavy(text: &str, time_step: f64) -> Record {
    run_at(&format!("{HEAVY}{text}"), Convention::CUNDALL_STRACK, &Resolution::TimeStep(time_step))
}

fn end(record: &Record) -> &Snapshot {
    record.snapshots.last().unwrap()
}

fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() <= ROUNDING * expected.abs(), "{found} for {expected}");
}

fn closely(found: Vector3<f64>, expected: Vector3<f64>) {
    assert!((found - expected).norm() <= ROUNDING * expected.norm(), "{found:?} for {expected:?}");
}

/// A displaced tangential spring rotates by a quarter turn with its contact. A wall rotates about the centre of a
/// sphere, and the sphere rotates so that it does not slip. The tangential force F_s keeps its length and stays
/// perpendicular to the normal.
///
/// The wall is d = .45 m from the centre, and the radius R is .5 m. The surfaces move together if the sphere rotates at
/// d/R = .9 of the wall's rate. An additional .1 rad/s of the wall during .01 s displaces the spring by s = .1 · .45 ·
/// .01 m, less the fraction (3/24) (ω Δt)² by which a chord is shorter than its arc. A spring that rotates keeps this
/// displacement. If each of N steps removes the normal part instead, a fraction cos^N(π/2N) ≈ 1 − π²/(8N) remains, and
/// more of the displacement that was added later.
#[test]
fn a_stretched_spring_swings_with_its_contact() {
    let steps = 1000;
    let law = HEAVY.replace(", stiffness_damping = 0.02", "");
    let spin = FRAC_PI_2 - 0.001;
    let text = format!(
        "{law}dimension = 3\nduration_cycles = {steps}\n\
         [grains.g]\nmaterial = 'h'\nradius = 0.5\nposition = [0.0, 0.0, 0.0]\nspin = [0.0, 0.0, {}]\n\
         [walls.w]\nmaterial = 'h'\nplane = {{ point = [0.3, -0.45, 0.2], normal = [0.0, 1.0, 0.0] }}\n\
         motion = [{{ spin = [0.0, 0.0, {spin}], centre = [0.0, 0.0, 0.0] }}, \
         {{ spin = [0.0, 0.0, 0.1], centre = [0.0, 0.0, 0.0], stop_cycle = 10 }}]\n",
        0.9 * spin
    );
    for convention in [Convention::DEFAULT, Convention::CUNDALL_STRACK, Convention::LAMMPS] {
        let record = run_at(&text, convention, &Resolution::TimeStep(1e-3));
        let contact = end(&record).told_contacts()[0];
        // The normal points from the sphere to the wall: along −y at the start, along +x after the quarter turn. The
        // wall first moved along +x and drags the sphere with it. After the quarter turn, this direction is +y.
        assert!((contact.normal - Vector3::x()).norm() < ROUNDING, "{}: {:?}", convention.name, contact.normal);
        let force = 5.0e5 * 0.1 * 0.45 * 0.01;
        assert!(contact.shear_force.dot(&contact.normal).abs() < ROUNDING * force, "{:?}", contact.shear_force);
        let kept = contact.shear_force.y / force;
        let lost = if convention == Convention::LAMMPS { PI * PI / (8.0 * f64::from(steps)) } else { 5e-7 };
        assert!(kept <= 1.0 + ROUNDING && 1.0 - kept <= lost, "{}: {kept}", convention.name);
    }
}

/// A paddle rotates about its end and is in contact with a disc at rest. The force is F_n = k δ + β k v with v = ω l,
/// where l is the distance along the paddle from its end to the contact point. If the paddle rotates away from the
/// disc, its dashpot pulls.
#[test]
fn a_paddle_feels_its_dashpot_by_its_velocity_where_it_touches() {
    for spin in [0.5, -0.5] {
        let text = format!(
            "dimension = 2\nduration_cycles = 3\n\
             [grains.g]\nmaterial = 'h'\nradius = 0.1\nposition = [1.0, 0.095]\n\
             [walls.w]\nmaterial = 'h'\nsegment = [[0.0, 0.0], [2.0, 0.0]]\n\
             motion = [{{ spin = {spin}, centre = [0.0, 0.0] }}]\n[probes]\nc.contact = ['g', 'w']\nw.wall = 'w'\n"
        );
        let record = heavy(&text, 1e-4);
        let (sine, cosine) = (spin * 3e-4_f64).sin_cos();
        let (overlap, along) = (0.1 - (0.095 * cosine - sine), cosine + 0.095 * sine);
        close(last(&record, "c.normal_force"), 1.0e6 * overlap + 0.02 * 1.0e6 * spin * along);
    }
}

/// A distant paddle rotates until it touches a disc at rest. The neighbour list must be rebuilt before the paddle can
/// reach the disc, for discs at 0.05 m and at 3 m from the axis of rotation.
///
/// In the first case, the near end of the paddle touches the disc, in the other cases its side. The force is F_n = k δ +
/// β k u·n. Here n is the unit vector from the nearest point P of the paddle to the disc, and u = ω e_z × P is the
/// velocity of P.
#[test]
fn a_paddle_that_comes_from_afar_is_felt() {
    for (grain, ends, angle) in
        [(0.05, [0.12, 0.5], PI - 0.3), (3.0, [2.0, 4.0], FRAC_PI_2), (3.0, [2.0, 4.0], -FRAC_PI_2)]
    {
        let start = if angle > PI / 2.0 { -1.0 } else { 0.0 };
        let side = if start == 0.0 { -(angle + 0.02 * angle.signum()) } else { PI };
        let place = |at: f64, turned: f64| Vector3::new(at * turned.cos(), at * turned.sin(), 0.0);
        let [one, two] = ends.map(|at| place(at, side));
        let record = heavy(
            &format!(
                "dimension = 2\nduration_cycles = 1000\n\
                 [grains.g]\nmaterial = 'h'\nradius = 0.1\nposition = [{grain}, 0.0]\n\
                 [walls.w]\nmaterial = 'h'\nsegment = [[{}, {}], [{}, {}]]\n\
                 motion = [{{ spin = {angle}, centre = [0.0, 0.0] }}]\n[probes]\nc.contact = ['g', 'w']\n",
                one.x, one.y, two.x, two.y
            ),
            1e-3,
        );
        let centre = Vector3::new(grain, 0.0, 0.0);
        let along = place(1.0, side + angle);
        let point = along * along.dot(&centre).clamp(ends[0], ends[1]);
        let velocity = Vector3::new(-point.y, point.x, 0.0) * angle;
        let (distance, normal) = ((centre - point).norm(), (centre - point).normalize());
        assert!(distance < 0.1, "they touch: {distance}");
        assert_eq!(column(&record, "c.normal_force")[500], 0.0, "half-way they do not");
        close(last(&record, "c.normal_force"), 1.0e6 * (0.1 - distance) + 0.02 * 1.0e6 * velocity.dot(&normal));
    }
}

/// A turntable rotates at .3 rad/s under a sphere at rest, 1 m from the axis, where the turntable moves by ω × r = .3
/// m/s along y. In n steps, it drags the sphere along +y by the dashpot force β k_s ω r and the spring force k_s ω r n
/// Δt. The opposite force acts on the turntable. The spring rotates with the mean spin of both bodies, ω/2: a
/// displacement of j steps ago has rotated by j ω Δt/2.
#[test]
fn a_turntable_drags_by_its_velocity_where_it_touches() {
    let record = heavy(
        "dimension = 3\nduration_cycles = 50\n\
         [grains.g]\nmaterial = 'h'\nradius = 0.1\nposition = [1.0, 0.0, 0.095]\n\
         [walls.w]\nmaterial = 'h'\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n\
         motion = [{ spin = [0.0, 0.0, 0.3], centre = [0.0, 0.0, 0.0] }]\n",
        1e-4,
    );
    let turned = (0..50).map(|steps| (f64::from(steps) * 0.15 * 1e-4).sin_cos());
    let [back, along] = turned.fold([0.0, 0.0], |[back, along], (sine, cosine)| [back + sine, along + cosine]);
    let drag = 5.0e5 * 0.3;
    let expected = Vector3::new(-drag * back * 1e-4, drag * (0.02 + along * 1e-4), 1.0e6 * 0.005);
    closely(end(&record).grains[0].force.unwrap(), expected);
    closely(end(&record).walls[0].force.unwrap(), -expected);
    // The torque is R e × F_s with e = −z and R = .1 m. It starts a rotation of the sphere about +x.
    closely(end(&record).grains[0].torque.unwrap(), Vector3::new(0.1 * expected.y, -0.1 * expected.x, 0.0));
}

/// A belt with velocity V under a disc at rest displaces the tangential spring by V t: F_s = k_s V (β + t). The test
/// distinguishes a belt that is faster by a hundredth.
#[test]
fn a_belt_stretches_its_spring_by_its_way() {
    let force = |speed: f64| {
        let record = heavy(
            &format!(
                "dimension = 2\nduration_cycles = 40\n\
                 [grains.g]\nmaterial = 'h'\nradius = 0.1\nposition = [0.0, 0.095]\n\
                 [walls.w]\nmaterial = 'h'\nplane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}\n\
                 motion = [{{ velocity = [{speed}, 0.0] }}]\n"
            ),
            1e-4,
        );
        end(&record).grains[0].force.unwrap().x
    };
    let expected = 5.0e5 * 0.25 * (0.02 + 40.0 * 1e-4);
    close(force(0.25), expected);
    close(force(1.01 * 0.25), 1.01 * expected);
}

/// Snapshots of a rolling grain satisfy Newton's law. Between two snapshots, v and ω change by the mean of the forces
/// and moments: m (v' − v) = ½ (F + F') Δt + m g Δt and I (ω' − ω) = ½ (M + M') Δt. This is exact if velocities are
/// half a step apart from positions. At the contact with a plane below, M = R F_x about z.
#[test]
fn grains_turn_by_the_moments_that_snapshots_show() {
    // Discs have I = ½ m R² and m = π R² ρ, spheres I = ⅖ m R² and m = 4/3 π R³ ρ, with R = .1 m and ρ = 1000 kg/m³.
    let (disc, sphere) = (31.415_926_535_897_93, 4.188_790_204_786_391);
    let kinds = [
        (2, "disc", disc, 0.157_079_632_679_489_66),
        (2, "sphere", sphere, 0.016_755_160_819_145_566),
        (3, "sphere", sphere, 0.016_755_160_819_145_566),
    ];
    for (dimension, shape, mass, inertia) in kinds {
        let (position, point, normal, pull) = if dimension == 2 {
            ("0.0, 0.09999", "0.0, 0.0", "0.0, 1.0", "6.0, -8.0")
        } else {
            ("0.0, 0.0, 0.09999", "0.0, 0.0, 0.0", "0.0, 0.0, 1.0", "6.0, 0.0, -8.0")
        };
        let kind = if dimension == 2 { format!("grain_shape = '{shape}'\n") } else { String::new() };
        let record = run(&format!(
            "{kind}dimension = {dimension}\nduration_cycles = 60\noutput.snapshots = 59\ngravity = [{pull}]\n\
             materials.n.density = 1000.0\n\
             contacts.n = {{ between = ['n', 'n'], normal_stiffness = 1.0e6, tangential_stiffness = 5.0e5, friction = 0.3, \
             normal_damping = 30.0, tangential_damping = 20.0 }}\n\
             [grains.g]\nmaterial = 'n'\nradius = 0.1\nposition = [{position}]\n\
             [walls.w]\nmaterial = 'n'\nplane = {{ point = [{point}], normal = [{normal}] }}\n"
        ));
        let gravity = if dimension == 2 { Vector3::new(6.0, -8.0, 0.0) } else { Vector3::new(6.0, 0.0, -8.0) };
        assert_eq!(record.snapshots.len(), 61);
        let step = record.provenance.time_step;
        let speeds = &end(&record).grains[0];
        for pair in record.snapshots.windows(2) {
            let [one, two] = [&pair[0].grains[0], &pair[1].grains[0]];
            let turned = (two.spin - one.spin) * inertia - (one.torque.unwrap() + two.torque.unwrap()) * (0.5 * step);
            let sped = (two.velocity - one.velocity - gravity * step) * mass
                - (one.force.unwrap() + two.force.unwrap()) * (0.5 * step);
            assert!(turned.norm() < ROUNDING * inertia * speeds.spin.norm(), "{shape}: {turned:?}");
            assert!(sped.norm() < ROUNDING * mass * speeds.velocity.norm(), "{shape}: {sped:?}");
            let moment = if dimension == 2 { two.torque.unwrap().z } else { -two.torque.unwrap().y };
            assert!(
                (moment - 0.1 * two.force.unwrap().x).abs() < ROUNDING * two.force.unwrap().norm(),
                "{shape}: {two:?}"
            );
        }
        assert!(speeds.velocity.x > 0.0 && end(&record).grains[0].force.unwrap().x < 0.0, "it is held back going down");
    }
}

/// A freely spinning grain has the energy ½ I ω² in the system energies and in the budget. A disc of .1 m and 1000
/// kg/m³ at 3 rad/s has ½ · .15708 · 9 = .70686 J. A sphere of the same radius and density at (1, −2, 2) rad/s has ½ ·
/// .0167552 · 9 = .0753982 J.
#[test]
fn spinning_grains_have_their_energy() {
    for (dimension, position, spin, energy) in [
        (2, "[0.0, 0.0]", "3.0", 0.706_858_347_057_703_5),
        (3, "[0.0, 0.0, 0.0]", "[1.0, -2.0, 2.0]", 0.075_398_223_686_155_05),
    ] {
        for friction in ["", ", tangential_stiffness = 5.0e5, friction = 0.5"] {
            let record = run(&format!(
                "dimension = {dimension}\nduration_cycles = 5\nmaterials.n.density = 1000.0\n\
                 contacts.n = {{ between = ['n', 'n'], normal_stiffness = 1.0e6{friction} }}\n\
                 [grains.g]\nmaterial = 'n'\nradius = 0.1\nposition = {position}\nspin = {spin}\n\
                 [probes]\nall.system = true\nbudget.budget = true\n"
            ));
            close(last(&record, "all.rotational_energy"), energy);
            close(last(&record, "all.total_energy"), energy);
            close(last(&record, "budget.kinetic"), energy);
        }
    }
}

/// Global damping reduces a spin by the same factor as a velocity, (1 − αΔt/2)/(1 + αΔt/2) in each step. In a scene with
/// friction, the spins are integrated. In a scene without friction, they are computed from the number of steps.
#[test]
fn spins_are_damped_as_velocities_are() {
    for (dimension, vector, spin, omega) in
        [(2, "[3.0, 0.0]", "3.0", "g.omega"), (3, "[3.0, 0.0, 0.0]", "[3.0, 0.0, 0.0]", "g.omega_x")]
    {
        for friction in ["", ", tangential_stiffness = 5.0e5, friction = 0.5"] {
            let text = format!(
                "dimension = {dimension}\nduration_cycles = 40\nglobal_damping = 2.0\nmaterials.n.density = 1000.0\n\
                 contacts.n = {{ between = ['n', 'n'], normal_stiffness = 1.0e6{friction} }}\n\
                 [grains.g]\nmaterial = 'n'\nradius = 0.1\nposition = {}\nvelocity = {vector}\nspin = {spin}\n\
                 [probes]\ng.grain = 'g'\n",
                vector.replace("3.0", "0.0")
            );
            let record = run_at(&text, Convention::DEFAULT, &Resolution::TimeStep(0.01));
            let expected = 3.0 * (0.99_f64 / 1.01).powi(40);
            // The reported value is the mean of the values half a step before and after, with a relative error of (αΔt/2)².
            for column in ["g.vx", omega] {
                assert!((last(&record, column) / expected - 1.0).abs() < 1.1e-4, "{dimension}, {column}");
            }
        }
    }
}

/// On the faces of a segment and of a rectangle, the force acts along the normal. At the ends of a segment and at the edges
/// and corners of a rectangle, it acts along the line from the nearest point to the centre of the grain. With δ = .01 m, it
/// is k δ, k δ (3, 4)/5 or k δ (2, 3, 6)/7. A grain beside a wall feels no force.
#[test]
fn faces_ends_edges_and_corners_push_along_the_line_to_the_centre() {
    let force = |dimension: u8, wall: &str, position: &str, radius: f64| {
        let record = run(&format!(
            "dimension = {dimension}\nduration_cycles = 1\n\
             [grains.g]\nmaterial = 'm'\nradius = {radius}\nposition = {position}\n[walls.w]\nmaterial = 'm'\n{wall}\n"
        ));
        record.snapshots[0].grains[0].force.unwrap()
    };
    let segment = "segment = [[0.0, 0.0], [1.0, 0.0]]";
    closely(force(2, segment, "[-0.3, 0.4]", 0.51), Vector3::new(-6e3, 8e3, 0.0));
    closely(force(2, segment, "[1.3, -0.4]", 0.51), Vector3::new(6e3, -8e3, 0.0));
    closely(force(2, segment, "[0.7, 0.5]", 0.51), Vector3::y() * 1e4);
    closely(force(2, segment, "[0.3, -0.5]", 0.51), Vector3::y() * -1e4);
    closely(force(2, segment, "[1.6, 0.0]", 0.51), Vector3::zeros());
    let rectangle = "rectangle = { corner = [0.0, 0.0, 0.0], edges = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0]] }";
    closely(force(3, rectangle, "[-0.2, -0.3, 0.6]", 0.71), Vector3::new(-2.0, -3.0, 6.0) * (1e4 / 7.0));
    closely(force(3, rectangle, "[1.2, 2.3, -0.6]", 0.71), Vector3::new(2.0, 3.0, -6.0) * (1e4 / 7.0));
    closely(force(3, rectangle, "[1.3, 0.7, 0.4]", 0.51), Vector3::new(6e3, 0.0, 8e3));
    closely(force(3, rectangle, "[0.4, 2.3, -0.4]", 0.51), Vector3::new(0.0, 6e3, -8e3));
    closely(force(3, rectangle, "[0.4, 1.2, 0.5]", 0.51), Vector3::z() * 1e4);
    closely(force(3, rectangle, "[0.9, 0.7, -0.5]", 0.51), Vector3::z() * -1e4);
    closely(force(3, rectangle, "[1.6, 0.7, 0.3]", 0.51), Vector3::zeros());
}

/// The three dashpots of a linear contact add up, between grains and at a wall: F_n = k δ + (β k + γ m* + 2ζ √(k m*))
/// δ̇. For discs of .1 m with 1000 and 3000 kg/m³, m* = 7.5 π kg; at a wall, m* = 10 π kg. For e = .5, ζ = ln 2/√(π² +
/// ln² 2).
#[test]
fn dashpots_add_up() {
    let ratio = 2.0_f64.ln() / (PI * PI + 2.0_f64.ln().powi(2)).sqrt();
    let partners = [
        ("grains.b = { material = 'o', radius = 0.1, position = [0.0, -0.199] }", 0.199, 7.5 * PI),
        ("walls.b = { material = 'o', plane = { point = [0.0, -0.099], normal = [0.0, 1.0] } }", 0.099, 10.0 * PI),
    ];
    for (partner, reach, mass) in partners {
        let record = run(&format!(
            "dimension = 2\nduration_cycles = 3\nmaterials.n.density = 1000.0\nmaterials.o.density = 3000.0\n\
             contacts.n = {{ between = ['n', 'o'], normal_stiffness = 1.0e6, stiffness_damping = 1.0e-4, \
             normal_damping = 30.0, restitution = 0.5 }}\n\
             grains.a = {{ material = 'n', radius = 0.1, position = [0.0, 0.0], velocity = [0.0, -1.0] }}\n{partner}\n\
             [probes]\na.grain = 'a'\nc.contact = ['a', 'b']\n"
        ));
        let overlap = column(&record, "c.overlap");
        close(overlap[0], if reach < 0.1 { 0.1 - reach } else { 0.2 - reach });
        let (force, step) = (column(&record, "c.normal_force"), record.provenance.time_step);
        let dashpot = 1.0e-4 * 1.0e6 + 30.0 * mass + 2.0 * ratio * (1.0e6 * mass).sqrt();
        let expected = 1.0e6 * overlap[2] + dashpot * (overlap[2] - overlap[1]) / step;
        // The overlap rate is the difference of two overlaps of 1 mm, which differ by about 1e-4 m per step. This
        // difference loses five digits.
        assert!((force[2] / expected - 1.0).abs() < 1e-9, "{} for {expected}", force[2]);
    }
}

/// Rolling resistance between two discs with opposite spins, whose surfaces do not slip. The moment is k_r θ + 2η √(I
/// k_r) Ω with k_r = 2.25 k μ² R_eff², R_eff = R/2, and the rolling angle θ and angular velocity Ω of one disc relative
/// to the other. Each disc has the moment of inertia 3/2 m R² about the contact; I is half of that for two equal discs.
/// The spring energy is ½ k_r θ².
#[test]
fn a_rolling_spring_between_grains_has_its_moment_and_energy() {
    // Spins of .5 and −.5 rad/s, R = .1 m, δ = 1 mm, μ = .1: the spring yields at k_r θ = μ R_eff k δ = 5 N m.
    let stiffness = 2.25 * 1.0e6 * 0.1 * 0.1 * 0.05 * 0.05;
    for (density, damping) in [(1.0e20, 0.0), (1.0e20, 1.0e-9)] {
        let record = run_at(
            &format!(
                "dimension = 2\nduration_cycles = 20\nmaterials.n.density = {density:?}\n\
                 contacts.n = {{ between = ['n', 'n'], normal_stiffness = 1.0e6, tangential_stiffness = 5.0e5, friction = 0.5, \
                 rolling_friction = 0.1, rolling_damping = {damping} }}\n\
                 grains.a = {{ material = 'n', radius = 0.1, position = [0.0, 0.0], spin = 0.5 }}\n\
                 grains.b = {{ material = 'n', radius = 0.1, position = [0.199, 0.0], spin = -0.5 }}\n\
                 [probes]\nall.system = true\n"
            ),
            Convention::DEFAULT,
            &Resolution::TimeStep(1e-3),
        );
        let inertia = 0.75 * density * PI * 0.01 * 0.01;
        let moment = stiffness * 0.02 + 2.0 * damping * (inertia * stiffness).sqrt();
        let [a, b] = [0, 1].map(|at| end(&record).grains[at].torque.unwrap().z);
        close(a, -moment);
        close(b, moment);
        close(last(&record, "all.elastic_energy"), 0.5 * 1.0e6 * 1e-6 + 0.5 * stiffness * 0.02 * 0.02);
    }
}

/// A sphere and the turntable below it rotate about their common normal at Ω = 200 rad/s. The sphere also rolls at ω =
/// 1 rad/s about a fixed axis along x. In each step, the rolling angle grows by ω Δt along x and rotates with the
/// contact. The part that was added j steps ago has rotated by jφ, with tan φ/2 = Ω Δt/2 for one step. The moment is M
/// = −k_r θ with k_r = 2.25 k μ_r² R². Friction adds the torque R e × F.
#[test]
fn a_rolling_spring_turns_with_its_contact() {
    let law = HEAVY.replace("stiffness_damping = 0.02", "rolling_friction = 0.5");
    let text = "dimension = 3\nduration_cycles = 50\n\
        [grains.g]\nmaterial = 'h'\nradius = 0.1\nposition = [0.0, 0.0, 0.095]\nspin = [1.0, 0.0, 200.0]\n\
        [walls.w]\nmaterial = 'h'\nplane = { point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0] }\n\
        motion = [{ spin = [0.0, 0.0, 200.0], centre = [0.0, 0.0, 0.0] }]\n";
    let record = run_at(&(law + text), Convention::DEFAULT, &Resolution::TimeStep(1e-4));
    let turn = 2.0 * (0.5 * 200.0 * 1e-4_f64).atan();
    let turned = (0..50).map(|steps| (f64::from(steps) * turn).sin_cos());
    let [along, beside] = turned.fold([0.0, 0.0], |[along, beside], (sine, cosine)| [along + cosine, beside + sine]);
    let grain = &end(&record).grains[0];
    let (force, torque) = (grain.force.unwrap(), grain.torque.unwrap());
    let stiffness = 2.25 * 1.0e6 * 0.5 * 0.5 * 0.1 * 0.1;
    closely(
        torque - Vector3::new(0.1 * force.y, -0.1 * force.x, 0.0),
        Vector3::new(along, beside, 0.0) * (-stiffness * 1e-4),
    );
}

/// A sphere presses on another sphere for 10 steps and withdraws for 10 steps, at 1 m/s. The other sphere spins at ω = 1
/// rad/s, so each step adds k_r ω Δt to the moment. The stiffness follows Hertz's law: k_r = 2.25 k_n μ_r² R_eff² with k_n
/// = (4/3) E* √(R_eff δ), E* = 1e8/1.5 Pa and R_eff = R/2 = .1 m. While it grows, the spring keeps its moment. While it
/// decreases, `dem` keeps the angle, and LIGGGHTS keeps the moment.
#[test]
fn a_rolling_spring_follows_the_stiffness_of_its_contact() {
    let text = "dimension = 3\nduration_cycles = 20\n\
        materials.h = { density = 1.0e20, young_modulus = 1.0e8, poisson_ratio = 0.5 }\n\
        contacts.h = { between = ['h', 'h'], law = 'hertz', friction = 1.0e-14, rolling_friction = 0.5 }\n\
        [grains.a]\nmaterial = 'h'\nradius = 0.2\nposition = [0.0, 0.0, 0.395]\nspin = [1.0, 0.0, 0.0]\n\
        [grains.b]\nmaterial = 'h'\nradius = 0.2\nposition = [0.0, 0.0, 0.0]\n[driven.b]\ngrains = 'b'\n\
        motion = [{ velocity = [0.0, 0.0, 1.0], stop = 0.00125 }, { velocity = [0.0, 0.0, -1.0], start = 0.00125 }]\n";
    let stiffness = |overlap: f64| 2.25 * (4.0 / 3.0 * 0.5e8 / 0.75) * (0.1 * overlap).sqrt() * 0.5 * 0.5 * 0.1 * 0.1;
    let overlap = |steps: u32| 0.005 + 1.25e-4 * f64::from(steps);
    let pressed: f64 = (1..=10).map(|step| stiffness(overlap(step)) * 1.25e-4).sum();
    let withdrawn: f64 = (0..10).map(|step| stiffness(overlap(step)) * 1.25e-4).sum();
    let angle = pressed / stiffness(overlap(10)) + 0.00125;
    for (convention, expected) in
        [(Convention::DEFAULT, stiffness(overlap(0)) * angle), (Convention::LIGGGHTS, pressed + withdrawn)]
    {
        let record = run_at(text, convention, &Resolution::TimeStep(1.25e-4));
        close(end(&record).grains[0].torque.unwrap().x, -expected);
    }
}

/// A spinning disc approaches a floor. The rolling spring yields at the moment μ_r R F_n, with F_n as in the Coulomb
/// limit of the convention. In the convention of 1979, F_n is the spring force k δ. By default, it is the force of
/// spring and dashpot, k δ + β k v.
#[test]
fn a_rolling_spring_yields_at_the_normal_force_of_the_convention() {
    let law = HEAVY.replace("friction = 1.0e3", "friction = 0.2, rolling_friction = 0.1");
    for (convention, dashpot) in [(Convention::CUNDALL_STRACK, 0.0), (Convention::DEFAULT, 1.0)] {
        let text = "dimension = 2\nduration_cycles = 9\n\
            [grains.g]\nmaterial = 'h'\nradius = 0.1\nposition = [0.0, 0.095]\nvelocity = [0.0, -0.5]\nspin = 1.0e3\n\
            [walls.w]\nmaterial = 'h'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n";
        let record = run_at(&format!("{law}{text}"), convention, &Resolution::TimeStep(1e-4));
        let grain = &end(&record).grains[0];
        let moment = grain.torque.unwrap().z - 0.1 * grain.force.unwrap().x;
        close(moment, -0.1 * 0.1 * 1.0e6 * (0.005 + 9.0 * 0.5e-4 + dashpot * 0.02 * 0.5));
    }
}

/// A dashpot that uses the velocity half a step earlier reduces the largest stable step to 2/ω (√(1 + ζ²) − ζ). For two
/// discs of m = 10 π kg (m* = 5 π kg) with k = 1e6 N/m, ω = √(k/m*) = 252.313 /s. With e = .5, ζ = .215454, and the step
/// is 6.4007 ms. Without the dashpot, it is 2/ω = 7.9266 ms. At a wall, m* = m, and both steps are longer.
#[test]
fn a_dashpot_shortens_the_stable_step() {
    let step = |partner: &str| {
        let text = format!(
            "title = 't'\ndimension = 2\nduration_cycles = 1\nmaterials.n.density = 1000.0\n\
             contacts.n = {{ between = ['n', 'n'], normal_stiffness = 1.0e6, restitution = 0.5 }}\n\
             grains.a = {{ material = 'n', radius = 0.1, position = [0.0, 0.0] }}\n{partner}\n"
        );
        damped_step(&scene(&text).unwrap(), &Convention::LAMMPS)
    };
    let (mass, ratio) = (10.0 * PI, 2.0_f64.ln() / (PI * PI + 2.0_f64.ln().powi(2)).sqrt());
    for (partner, mass) in [
        ("grains.b = { material = 'n', radius = 0.1, position = [0.3, 0.0] }", 0.5 * mass),
        ("walls.b = { material = 'n', plane = { point = [0.0, -1.0], normal = [0.0, 1.0] } }", mass),
        // Another material with three times the density: 1/m* = 1/m + 1/(3m).
        (
            "materials.heavy.density = 3000.0\n\
             contacts.b = { between = ['n', 'heavy'], normal_stiffness = 1.0e6, restitution = 0.5 }\n\
             contacts.c = { between = ['heavy', 'heavy'], normal_stiffness = 1.0e6 }\n\
             grains.b = { material = 'heavy', radius = 0.1, position = [0.3, 0.0] }",
            0.75 * mass,
        ),
    ] {
        let (damped, undamped) = step(partner);
        let free = 2.0 * (mass / 1.0e6).sqrt();
        close(undamped, free);
        close(damped, free * ((1.0 + ratio * ratio).sqrt() - ratio));
    }
}

/// A disc with friction moves over the joint of two segments as over one segment. At the joint it has one contact, and
/// its tangential spring continues. With two contacts, the normal force would double. With a new spring, the shear
/// force would start again at zero.
#[test]
fn a_joint_of_two_segments_is_one_wall() {
    let text = |walls: &str| {
        format!(
            "materials.f.density = 1000.0\ncontacts.f = {{ between = ['f', 'f'], normal_stiffness = 1.0e6, \
             tangential_stiffness = 5.0e5, friction = 0.5 }}\n\
             dimension = 2\nduration_cycles = 400\n\
             [grains.g]\nmaterial = 'f'\nradius = 0.5\nposition = [0.0, 0.49]\nvelocity = [0.5, 0.0]\n\
             {walls}[probes]\ng = {{ grain = 'g' }}\nall = {{ system = true }}\n"
        )
    };
    let wall = |name: &str, from: f64, to: f64| {
        format!("[walls.{name}]\nmaterial = 'f'\nsegment = [[{from}, 0.0], [{to}, 0.0]]\n")
    };
    let step = Resolution::TimeStep(1e-3);
    let whole = run_at(&text(&wall("a", -2.0, 2.0)), Convention::DEFAULT, &step);
    assert!(last(&whole, "g.x") > 0.05 && last(&whole, "g.omega").abs() > 0.01);
    for order in [["a", "b"], ["b", "a"]] {
        let walls = wall(order[0], -2.0, 0.02) + &wall(order[1], 0.02, 2.0);
        let joined = run_at(&text(&walls), Convention::DEFAULT, &step);
        for name in ["g.x", "g.y", "g.omega", "all.elastic_energy"] {
            let scale = column(&whole, name).iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            let pairs = column(&whole, name).iter().zip(column(&joined, name));
            pairs.for_each(|(one, two)| assert!((one - two).abs() <= 1e-10 * scale, "{name}: {two} for {one}"));
        }
    }
}

/// A small sphere (mass m, velocity v) hits a large sphere with ten times its radius (mass M = 1000 m), along each axis
/// and from both sides. It rebounds with v′ = v (m − M)/(m + M). Other small spheres shift the cells of the search
/// grid, so that the large sphere reaches beyond the cells within its own radius. A contact that is found late begins
/// with an overlap whose energy is many times the initial energy.
#[test]
fn a_large_grain_finds_small_ones_at_its_poles() {
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let (mut place, mut speed) = ([0.0; 3], [0.0; 3]);
            (place[axis], speed[axis]) = (1.18 * side, -0.5 * side);
            let mut text = format!(
                "dimension = 3\nduration = 0.4\n[grains.large]\nmaterial = 'm'\nradius = 1.0\nposition = [0.0, 0.0, 0.0]\n\
                 [grains.small]\nmaterial = 'm'\nradius = 0.1\nposition = {place:?}\nvelocity = {speed:?}\n\
                 [probes]\nsmall = {{ grain = 'small' }}\n"
            );
            for other in 0..20 {
                let at = -3.0 + 0.3 * f64::from(other);
                text += &format!("[grains.n{other}]\nmaterial = 'm'\nradius = 0.1\nposition = [{at}, -3.0, -3.0]\n");
            }
            let found = side * last(&run(&text), ["small.vx", "small.vy", "small.vz"][axis]);
            // The contact begins and ends between two evaluations, with overlaps of up to v Δt. The start and the end
            // each change the energy by up to (ω Δt)² of its value, with ω Δt = .04.
            assert!((found / (0.5 * 999.0 / 1001.0) - 1.0).abs() < 3.2e-3, "axis {axis}, side {side}: {found} m/s");
        }
    }
}

/// One contact: a disc at the ridge of two segments, a disc on a plane above the end of a segment, and a sphere at the
/// common edge of two rectangles. Two contacts: a disc in a valley and a disc above a gap.
#[test]
fn joined_edges_have_one_contact() {
    let force = |text: &str, dimension: u32| {
        let record = heavy(
            &format!("dimension = {dimension}\nduration_cycles = 1\n{text}[probes]\nall = {{ system = true }}\n"),
            1e-3,
        );
        column(&record, "all.contacts")[0]
    };
    let disc = |x: f64, y: f64| format!("[grains.g]\nmaterial = 'h'\nradius = 0.5\nposition = [{x}, {y}]\n");
    let segment = |name: &str, ends: [f64; 4]| {
        let [a, b, c, d] = ends;
        format!("[walls.{name}]\nmaterial = 'h'\nsegment = [[{a}, {b}], [{c}, {d}]]\n")
    };
    let roof = segment("left", [-1.0, -1.0, 0.0, 0.0]) + &segment("right", [0.0, 0.0, 1.0, -1.0]);
    assert_eq!(force(&(disc(0.0, 0.49) + &roof), 2), 1.0);
    let valley = segment("left", [-1.0, 1.0, 0.0, 0.0]) + &segment("right", [0.0, 0.0, 1.0, 1.0]);
    assert_eq!(force(&(disc(0.0, 0.7) + &valley), 2), 2.0);
    let floor = "[walls.floor]\nmaterial = 'h'\nplane = { point = [0.0, 0.0], normal = [0.0, 1.0] }\n".to_owned();
    assert_eq!(force(&(disc(0.0, 0.49) + &floor + &segment("post", [0.0, 0.0, 0.0, -1.0])), 2), 1.0);
    let apart = segment("left", [-1.0, 0.0, -0.01, 0.0]) + &segment("right", [0.01, 0.0, 1.0, 0.0]);
    assert_eq!(force(&(disc(0.0, 0.49) + &apart), 2), 2.0);
    let sphere = "[grains.g]\nmaterial = 'h'\nradius = 0.5\nposition = [0.0, 0.0, 0.49]\n".to_owned();
    let plate = |name: &str, x: f64| {
        format!(
            "[walls.{name}]\nmaterial = 'h'\n\
             rectangle = {{ corner = [{x}, -1.0, 0.0], edges = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0]] }}\n"
        )
    };
    assert_eq!(force(&(sphere + &plate("left", -1.0) + &plate("right", 0.0)), 3), 1.0);
}

/// Two grains that stick together rotate as one body, by θ in a step. Their tangential spring must stay unloaded. Surface
/// points move along arcs and centres along chords, which are shorter. If surface velocities were not multiplied by
/// chord/arc = 1 − θ²/24, each step would add a slip of θ²/24 of the arc.
#[test]
fn rigid_rotation_causes_no_slip() {
    let (rate, step, distance) = (10.0, 1e-2, 1.0 - 1e-8);
    let chord = 2.0 * (0.5_f64 * rate * step).sin() / step;
    // The velocity is that of the middle of the first step, along the chord. Heavy grains keep it for one step.
    let angle = 0.5 * rate * step;
    let velocity = [0.5 * distance * chord * angle.sin(), -0.5 * distance * chord * angle.cos()];
    for dimension in [2, 3] {
        let [z, spin] = if dimension == 3 { [", 0.0", "[0.0, 0.0, 10.0]"] } else { ["", "10.0"] };
        let grain = |name: &str, x: f64, [u, v]: [f64; 2]| {
            format!(
                "[grains.{name}]\nmaterial = 'h'\nradius = 0.5\nposition = [{x}, 0.0{z}]\nvelocity = [{u}, {v}{z}]\n\
                 spin = {spin}\n"
            )
        };
        let text = format!(
            "dimension = {dimension}\nduration_cycles = 1\n{}{}\
             [probes]\nc = {{ contact = ['a', 'b'] }}\n",
            grain("a", -0.5 * distance, velocity),
            grain("b", 0.5 * distance, velocity.map(|v| -v))
        );
        let law = HEAVY.replace(", stiffness_damping = 0.02", "");
        let record = run_at(&format!("{law}{text}"), Convention::DEFAULT, &Resolution::TimeStep(step));
        let slip = last(&record, "c.shear_force") / 5.0e5;
        let arc = rate * step * distance;
        assert!(slip.abs() < 1e-3 * arc * (rate * step).powi(2) / 24.0, "{dimension}D: {slip} of {arc}");
    }
}
