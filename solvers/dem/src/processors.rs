//! Tests of the loops over pairs. They are compiled for every instruction set and run on one or more threads. All
//! variants must give the same results.

use crate::contact::options::Options;
use crate::convention::Convention;
use crate::geometry::Geometry;
use crate::simulation::DemSimulation;
use crate::solver::loops;
use grainbench_lanes::{Processor, Team};
use grainbench_scene::contact_law::{ContactLaw, Springs};
use grainbench_scene::scene::Scene;
use grainbench_solver::space::{Plane, Solid, Space};
use std::fmt::Write as _;

/// Returns a scene with grains of two materials in a box with periodic faces and a floor. Some grains are in contact at
/// the start, others collide later.
fn scene(dimension: usize) -> Scene {
    let vector = |x: f64, y: f64, z: f64| {
        let all = [x, y, z];
        format!("[{}]", all[..dimension].iter().map(|value| format!("{value:?}")).collect::<Vec<_>>().join(", "))
    };
    let normal = if dimension == 2 { vector(0.0, 1.0, 0.0) } else { vector(0.0, 0.0, 1.0) };
    let periodic = if dimension == 2 { "[true, false]" } else { "[true, true, false]" };
    let mut text = format!(
        "title = 'grains'\ndimension = {dimension}\nduration = 1.0\ngravity = {}\nlargest_initial_overlap = 0.5\n\
         domain = {{ low = {}, high = {}, periodic = {periodic} }}\n\
         materials.m.density = 1000.0\nmaterials.n.density = 700.0\n\
         [walls.w]\nmaterial = 'm'\nplane = {{ point = {}, normal = {normal} }}\n",
        vector(1.0, -2.0, -3.0),
        vector(0.0, 0.0, 0.0),
        vector(6.0, 6.0, 6.0),
        vector(0.0, 0.0, 0.0),
    );
    for pair in [["m", "m"], ["m", "n"], ["n", "n"]] {
        let _ = writeln!(text, "[contacts.{}{}]\nbetween = {pair:?}\nnormal_stiffness = 1.0e6", pair[0], pair[1]);
    }
    for number in 0..if dimension == 2 { 36_i32 } else { 72 } {
        let [i, j, k] = [number % 6, number / 6 % 6, number / 36].map(f64::from);
        let odd = f64::from(number * 7 % 11) / 11.0;
        let _ = writeln!(
            text,
            "[grains.g{number}]\nmaterial = '{}'\nradius = {}\nposition = {}\nvelocity = {}\nspin = {}",
            if number % 3 == 0 { 'n' } else { 'm' },
            0.45 + 0.1 * odd,
            vector(0.5 + i + 0.02 * odd, 0.48 + 0.97 * j, 0.5 + k),
            vector(2.0 * odd - 1.0, 1.0 - 3.0 * odd, odd),
            if dimension == 2 { format!("{odd:?}") } else { vector(odd, -odd, 0.5) },
        );
    }
    Scene::from_text("grains", &text).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns the state after 300 steps and the recorded contacts, as text.
fn state<S: Geometry>(mut simulation: DemSimulation<S>, path: Processor) -> String {
    simulation.model.processor = path;
    simulation.threads.fewest = 5;
    simulation.take_cycles(300).unwrap_or_else(|error| panic!("{error:?}"));
    let partitions = simulation.threads.partitions(simulation.grains.len());
    assert_eq!(simulation.neighbours.list.shares.len(), partitions, "lists were made anew on the way");
    let listed = simulation.neighbours.list.in_shares(1);
    let touched: u32 = listed.shares[0].near.pairs.touches.iter().map(|bits| bits.count_ones()).sum();
    let across: u32 = listed.shares[0].across.pairs.touches.iter().map(|bits| bits.count_ones()).sum();
    assert!(touched == 0 || (touched > 10 && across > 0), "{touched} pairs touch, {across} across a face");
    let DemSimulation { grains, recording, neighbours, step, cost, .. } = &mut simulation;
    let contacts = recording.take_contacts(*step, &mut neighbours.list.shares);
    let energies: Vec<_> = recording.energies(&neighbours.list.shares).collect();
    assert!(contacts.as_ref().is_some_and(|contacts| contacts.len() == energies.len()));
    format!("{grains:?} {listed:?} {contacts:?} {energies:?} {cost:?}")
}

/// Returns the name and two contact laws for every combination of effects. The second law has neither rolling
/// resistance nor damping.
fn laws() -> Vec<(String, ContactLaw, ContactLaw)> {
    let mut laws = Vec::new();
    for effects in 0..16_u32 {
        let [friction, rolling, damping, hertz] = [0, 1, 2, 3].map(|bit| effects >> bit & 1 == 1);
        let on = |yes: bool, value: f64| if yes { value } else { 0.0 };
        let law = |friction: bool, rolling: bool, damping: bool| ContactLaw {
            springs: if hertz {
                Springs::Hertz { effective_modulus: 1e7, effective_shear_modulus: 6e6 }
            } else {
                Springs::Linear { normal: 1e6, tangential: 6e5 }
            },
            friction: on(friction, 0.3),
            cohesion: on(friction, 20.0),
            normal_damping: on(damping, 3.0),
            tangential_damping: on(damping && friction, 2.0),
            damping_ratio: on(damping, 0.1),
            rolling_friction: on(rolling && friction, 0.1),
            rolling_damping: on(rolling && friction, 0.2),
            ..ContactLaw::default()
        };
        let name = format!("friction {friction}, rolling {rolling}, damping {damping}, Hertz {hertz}");
        laws.push((name, law(friction, rolling, damping), law(friction, false, false)));
    }
    laws
}

fn same_on_all<S: Geometry>() {
    let mut scene = scene(<S as Space>::DIMENSION);
    let teams = [2, 3, 7].map(Team::new);
    for (name, law, other) in laws() {
        for (number, each) in scene.laws.iter_mut().flatten().enumerate() {
            *each = if number % 2 == 0 { law } else { other };
        }
        for convention in Convention::ALL {
            let state_on = |path, team: &Team| state(simulated::<S>(&scene, &convention, team.clone()), path);
            let expected = state_on(Processor::Portable, &Team::default());
            for path in Processor::all() {
                assert!(state_on(path, &Team::default()) == expected, "{}, {name}: {}", convention.name, path.name());
            }
            for team in &teams {
                let threads = team.members();
                assert!(
                    state_on(Processor::best(), team) == expected,
                    "{}, {name}: {threads} threads",
                    convention.name
                );
            }
        }
    }
}

fn simulated<S: Geometry>(scene: &Scene, convention: &Convention, team: Team) -> DemSimulation<S> {
    let (forces, options) = (loops(scene, convention), Options::from_convention(convention));
    DemSimulation::new(scene, forces, options, 2e-4, (team, u64::MAX)).unwrap_or_else(|error| panic!("{error:?}"))
}

#[test]
fn runs_leave_the_same_bits_on_all_paths_and_threads_in_the_plane() {
    same_on_all::<Plane>();
}

#[test]
fn runs_leave_the_same_bits_on_all_paths_and_threads_in_space() {
    same_on_all::<Solid>();
}

/// A call with many cycles moves grains directly after their forces are computed. It gives the same bits as one call per
/// cycle.
#[test]
fn cycles_taken_together_leave_the_bits_of_cycles_taken_alone() {
    let mut scene = scene(3);
    for (name, law, _) in laws() {
        scene.change_laws(|each| *each = law);
        let end = |at_once: u64| {
            let mut simulation = simulated::<Solid>(&scene, &Convention::DEFAULT, Team::default());
            (0..60 / at_once).for_each(|_| simulation.take_cycles(at_once).expect("it goes on"));
            format!("{:?} {:?}", simulation.grains, simulation.neighbours.list.shares[0].near.pairs.memory)
        };
        assert!(end(60) == end(1), "{name}");
    }
}

/// Returns a scene in which a ball approaches beads from below. The ball is so much larger than the beads that it has
/// no cell in the search grid. Its pairs fill more than one block, and its contacts are in the first block.
fn ball_under_beads() -> Scene {
    let text = "title = 'ball'\ndimension = 3\nduration = 1.0\nlargest_initial_overlap = 0.5\nmaterials.m.density = 1000.0\n\
         [contacts.all]\nbetween = ['m', 'm']\nnormal_stiffness = 1.0e6\ntangential_stiffness = 6.0e5\nfriction = 0.3\n\
         [grains.ball]\nmaterial = 'm'\nradius = 3.0\nposition = [6.4, 6.4, -3.4]\nvelocity = [0.0, 0.0, 2.0]\n\
         [grains.beads]\nmaterial = 'm'\nradius = 0.5\n\
         lattice = { origin = [0.0, 0.0, 0.0], spacing = [0.99, 0.99, 0.99], count = [14, 14, 8] }\n";
    Scene::from_text("ball", text).unwrap_or_else(|error| panic!("{error}"))
}

/// In a call with many cycles, the beads must not move before the forces in the row of the ball are computed. The final
/// state must not depend on the number of cycles per call or on the number of threads.
#[test]
fn beads_over_a_ball_end_where_they_do_cycle_by_cycle() {
    let scene = ball_under_beads();
    let end = |at_once: u64, team: Team| {
        let mut simulation = simulated::<Solid>(&scene, &Convention::DEFAULT, team);
        simulation.threads.fewest = 5;
        (0..60 / at_once).for_each(|_| simulation.take_cycles(at_once).expect("it goes on"));
        let ball = simulation.grains.slot[0] as usize;
        assert!(simulation.grains.force(ball).z < -1e3, "the ball is held back");
        format!("{:?}", simulation.grains)
    };
    let alone = end(1, Team::default());
    assert!(end(60, Team::default()) == alone, "sixty cycles together");
    assert!(end(60, Team::new(3)) == alone, "three threads");
}

/// All contacts are in the neighbour list, even after the skin has grown.
#[test]
fn whatever_touches_is_listed_while_the_skin_widens() {
    let scene = ball_under_beads();
    let mut simulation = simulated::<Solid>(&scene, &Convention::DEFAULT, Team::default());
    let first = simulation.neighbours.list.skin;
    for _ in 0..8 {
        simulation.take_cycles(100).expect("it goes on");
        let (grains, near) = (&simulation.grains, &simulation.neighbours.list.shares[0].near.pairs);
        let listed: std::collections::BTreeSet<(u32, u32)> =
            near.own().map(|at| (near.row[at].min(near.partner[at]), near.row[at].max(near.partner[at]))).collect();
        for a in 0..grains.len() {
            for b in a + 1..grains.len() {
                let touch = (grains.position(b) - grains.position(a)).norm() < grains.radius(a) + grains.radius(b);
                assert!(!touch || listed.contains(&(a as u32, b as u32)), "{a} and {b} touch");
            }
        }
    }
    assert!(simulation.neighbours.list.skin > first, "the skin has widened");
}

/// A checkpoint is rejected if the radius stored beside a spin differs from the radius of the grain. The stored radius is
/// the lever arm of tangential forces.
#[test]
fn a_radius_beside_a_spin_is_that_of_its_grain() {
    use crate::grains::Grains;
    let scene = scene(3);
    let mut grains = Grains::<Solid>::new(&scene, true);
    assert!(grains.is_of(&scene, true));
    grains.movement[1].0[3] *= 1.1;
    assert!(!grains.is_of(&scene, true));
}
