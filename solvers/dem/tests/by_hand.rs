//! Forces, moments and energies worked out by hand. Most are of grains so heavy that nothing moves them: what a contact
//! answers to a prescribed motion is then exact to rounding, of the time step too.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod support;

use grainbench_dem::convention::Convention;
use grainbench_dem::stability::damped_step;
use grainbench_scene::record::{Record, Snapshot};
use grainbench_scene::solver::Resolution;
use grainbench_scene::source::SceneSource;
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;
use support::{column, last, run, run_at};

/// Ten significant digits: sums of some thousand steps lose no more than three of sixteen, differences of lengths with
/// an overlap of a tenth one.
const ROUNDING: f64 = 1e-10;

/// A grain of a material that is 1e17 times as heavy as water, on stiff springs (N/m) with a dashpot (s), that hold
/// whatever shear there is.
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

/// A stretched spring is swung by a quarter turn with the contact that it belongs to: a wall turns about the centre of a
/// sphere that turns along with it, so that nothing slips. F_s keeps its length and stays perpendicular to the normal.
///
/// The wall is d = .45 m from the centre and the radius R is .5 m: surfaces move alike when the sphere turns at d/R = .9
/// of the wall's rate. A hundredth of a second of .1 rad/s more stretches the spring by s = .1 · .45 · .01 m, less the part
/// (3/24) (ω Δt)² of it by which a chord is shorter than its arc. A spring that turns keeps it; where its normal part is taken
/// off in every of N steps cos^N(π/2N) of it stays: 1 − π²/(8N), and less for what came later.
#[test]
fn a_stretched_spring_swings_with_its_contact() {
    let steps = 1000;
    let law = "materials.h.density = 1.0e20\n\
        contacts.h = { between = ['h', 'h'], normal_stiffness = 1.0e6, tangential_stiffness = 5.0e5, friction = 1.0e3 }\n";
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
        // From the sphere to the wall: −y at the start, +x after the quarter turn. The wall went along +x first and
        // drags the sphere with it; that has become +y.
        assert!((contact.normal - Vector3::x()).norm() < ROUNDING, "{convention}: {:?}", contact.normal);
        let force = 5.0e5 * 0.1 * 0.45 * 0.01;
        assert!(contact.shear_force.dot(&contact.normal).abs() < ROUNDING * force, "{:?}", contact.shear_force);
        let kept = contact.shear_force.y / force;
        let lost = if convention == Convention::LAMMPS { PI * PI / (8.0 * f64::from(steps)) } else { 5e-7 };
        assert!(kept <= 1.0 + ROUNDING && 1.0 - kept <= lost, "{convention}: {kept}");
    }
}

/// A paddle that turns about its end meets a disc at rest: F_n = k δ + β k v with v = ω l, l the distance along the paddle
/// from its end to the disc. Turned away from it, it pulls on its dashpot.
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

/// A paddle that comes from afar is felt when it comes, though nothing else moves: what is near it is looked for anew when it
/// may have turned so far, whether the grain is .05 m from the axis about which it turns or 3 m.
///
/// The near end P of the paddle passes the disc at an angle of .3 rad before the end of its turn, or its side does: F_n = k δ +
/// β k u·n with n from the nearest point P to the disc and u = ω e_z × P its velocity.
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

/// A turntable of .3 rad/s under a sphere at rest, 1 m beside its axis: it moves by ω × r = .3 m/s along y there, drags the
/// sphere along +y by the dashpot β k_s ω r and the spring k_s ω r n Δt, and feels the same backwards. The spring turns with the
/// mean spin of both, ω/2: what it was stretched by j steps ago has turned by j ω Δt/2.
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
    // R e × F_s with e = −z, R = .1 m: the sphere is made to turn about +x.
    closely(end(&record).grains[0].torque.unwrap(), Vector3::new(0.1 * expected.y, -0.1 * expected.x, 0.0));
}

/// A belt under a disc that does not move stretches the spring by V t: F_s = k_s V (β + t). One that is a hundredth faster
/// is told from it.
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

/// Newton's law for a rolling grain, from snapshots alone: between two of them v and ω change by the mean of the forces and
/// of the moments, m (v' − v) = ½ (F + F') Δt + m g Δt and I (ω' − ω) = ½ (M + M') Δt, exactly so where velocities stand
/// half a step between positions. At the contact with a plane below, M = R F_x about z.
#[test]
fn grains_turn_by_the_moments_that_snapshots_show() {
    // Discs have ½ m R² and π R² ρ, spheres ⅖ m R² and 4/3 π R³ ρ: R = .1 m, ρ = 1000 kg/m³.
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

/// ½ I ω² of a grain that spins freely, in the energies of the system and in the budget: of a disc of .1 m and 1000 kg/m³
/// at 3 rad/s, ½ · .15708 · 9 = .70686 J; of a sphere at (1, −2, 2) rad/s ½ · .0167552 · 9 = .0753982 J.
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

/// At an end of a segment, and at the edges and corners of a rectangle, a grain is pushed along the line from the nearest
/// point to its centre: (3, 4)/5 of k δ, and (2, 3, 6)/7 of it; δ = .01 m.
#[test]
fn ends_edges_and_corners_push_along_the_line_to_the_centre() {
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
    let rectangle = "rectangle = { corner = [0.0, 0.0, 0.0], edges = [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0]] }";
    closely(force(3, rectangle, "[-0.2, -0.3, 0.6]", 0.71), Vector3::new(-2.0, -3.0, 6.0) * (1e4 / 7.0));
    closely(force(3, rectangle, "[1.2, 2.3, -0.6]", 0.71), Vector3::new(2.0, 3.0, -6.0) * (1e4 / 7.0));
    closely(force(3, rectangle, "[1.3, 0.7, 0.4]", 0.51), Vector3::new(6e3, 0.0, 8e3));
    closely(force(3, rectangle, "[0.4, 2.3, -0.4]", 0.51), Vector3::new(0.0, 6e3, -8e3));
}

/// The three dashpots of a linear contact add up, F_n = k δ + (β k + γ m* + 2ζ √(k m*)) δ̇, between grains and at a wall: m* of
/// discs of .1 m and 1000 and 3000 kg/m³ is 7.5 π kg, that of one at a wall 10 π kg; e = .5 has ζ = ln 2/√(π² + ln² 2).
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
        // Of the difference of two overlaps of a millimetre, a step of some 1e-4 m apart, five digits less are left.
        assert!((force[2] / expected - 1.0).abs() < 1e-9, "{} for {expected}", force[2]);
    }
}

/// Rolling resistance between two discs that spin against each other, so that their surfaces do not slip: a moment
/// k_r θ + 2η √(I k_r) Ω with the spring's k_r = 2.25 k μ² R_eff², R_eff = R/2, the angle θ by which one has turned against
/// the other, and I the moment of inertia about the contact, of both together: 3/2 m R² of each disc, half as much for two
/// alike. The spring holds ½ k_r θ².
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

/// The largest stable step of a spring with a dashpot that feels the velocity of half a step before: 2/ω (√(1 + ζ²) − ζ),
/// of two discs of m = 10 π kg (m* = 5 π kg) and k = 1e6 N/m, ω = √(k/m*) = 252.313 /s and the ζ of e = .5, .215454: 6.4007 ms.
/// Beside it that without the dashpot, 2/ω = 7.9266 ms. A wall has m* = m and the longer one.
#[test]
fn a_dashpot_shortens_the_stable_step() {
    let step = |partner: &str| {
        let text = format!(
            "title = 't'\ndimension = 2\nduration_cycles = 1\nmaterials.n.density = 1000.0\n\
             contacts.n = {{ between = ['n', 'n'], normal_stiffness = 1.0e6, restitution = 0.5 }}\n\
             grains.a = {{ material = 'n', radius = 0.1, position = [0.0, 0.0] }}\n{partner}\n"
        );
        let source = SceneSource::from_text("test", Path::new(""), &text);
        damped_step(&source.scene(&|_| Err("no files".to_owned())).unwrap(), &Convention::LAMMPS)
    };
    let (mass, ratio) = (10.0 * PI, 2.0_f64.ln() / (PI * PI + 2.0_f64.ln().powi(2)).sqrt());
    for (partner, mass) in [
        ("grains.b = { material = 'n', radius = 0.1, position = [0.3, 0.0] }", 0.5 * mass),
        ("walls.b = { material = 'n', plane = { point = [0.0, -1.0], normal = [0.0, 1.0] } }", mass),
    ] {
        let (damped, undamped) = step(partner);
        let free = 2.0 * (mass / 1.0e6).sqrt();
        close(undamped, free);
        close(damped, free * ((1.0 + ratio * ratio).sqrt() - ratio));
    }
}
