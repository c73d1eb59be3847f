//! Walls that are cylinders and cones, compared with exact motions of grains in them.

use crate::common::{self, simulated};
use grainbench::cases::solvers;
use grainbench::scene::scene::Scene;
use grainbench::solver::record::Record;
use grainbench::solver::resolution::Resolution;
use std::f64::consts::TAU;

/// Contact stiffness (N/m).
const STIFFNESS: f64 = 1e6;
const GRAVITY: f64 = 10.0; // (m/s²)
const RADIUS: f64 = 0.25; // radius of the sphere (m), whose mass is 1 kg

fn scene(duration: f64, friction: f64, grain: &str, wall: &str) -> Scene {
    let density = 1.0 / (4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3));
    let text = format!(
        "title = 'round'\ndimension = 3\nduration = {duration:?}\ngravity = [0.0, 0.0, -{GRAVITY:?}]\n\
         materials.m.density = {density:?}\n\
         contacts.all = {{ between = ['m', 'm'], normal_stiffness = {STIFFNESS:?}, tangential_stiffness = {:?}, \
         friction = {friction:?}, normal_damping = 10.0 }}\n\
         output = {{ every_cycles = 100, snapshots = 0 }}\nprobes.ball = {{ grain = 'ball' }}\n\
         [grains.ball]\nmaterial = 'm'\nradius = {RADIUS:?}\n{grain}\n[walls.round]\nmaterial = 'm'\n{wall}\n",
        if friction > 0.0 { 2.0 / 7.0 * STIFFNESS } else { 0.0 },
    );
    common::scene(&text)
}

fn run(scene: &Scene) -> Record {
    simulated("dem", scene, &Resolution::CriticalFraction(0.02))
}

/// Returns the times at which a column changes its sign (s).
fn crossings(record: &Record, name: &str) -> Vec<f64> {
    let (values, time) = (record.series.column(name).unwrap(), &record.series.time);
    let between = |at: usize| {
        let (a, b) = (values[at], values[at + 1]);
        (a * b < 0.0).then(|| time[at] + (time[at + 1] - time[at]) * a / (a - b))
    };
    (0..values.len() - 1).filter_map(between).collect()
}

/// A sphere of radius r rolls to and fro at the bottom of a fixed cylinder of radius R. The angle of its centre obeys
/// (7/5)(R − r) θ″ = −g sin θ, so the period is 2π √(7(R − r)/5g) (1 + θ₀²/16) at the amplitude θ₀.
#[test]
fn a_sphere_rolls_in_a_trough_at_its_period() {
    const TROUGH: f64 = 2.0;
    let (angle, overlap) = (0.05_f64, GRAVITY / STIFFNESS);
    let (x, z) = (angle.sin() * (TROUGH - RADIUS + overlap), -angle.cos() * (TROUGH - RADIUS + overlap));
    let grain = format!("position = [{x:?}, 0.1, {z:?}]");
    let wall = format!("cylinder = {{ axis = [[0.0, -5.0, 0.0], [0.0, 5.0, 0.0]], radius = {TROUGH:?} }}");
    let period = |friction: f64| {
        let crossings = crossings(&run(&scene(7.0, friction, &grain, &wall)), "ball.x");
        crossings[2] - crossings[0]
    };
    let exact = |factor: f64| TAU * (factor * (TROUGH - RADIUS) / GRAVITY).sqrt() * (1.0 + angle * angle / 16.0);
    let (rolling, sliding) = (period(1.0), period(0.0));
    assert!((rolling / exact(7.0 / 5.0) - 1.0).abs() < 1e-4, "{rolling} for {}", exact(7.0 / 5.0));
    // Control: without friction, the sphere slides like a pendulum, with another period.
    assert!((sliding / exact(1.0) - 1.0).abs() < 1e-4, "{sliding} for {}", exact(1.0));
}

/// A sphere (radius r, angular velocity ω) stays at the bottom of a rotating drum (R, Ω) if both have the same surface
/// velocity, ω r = Ω R.
#[test]
fn a_sphere_that_turns_with_its_drum_stays_at_the_bottom() {
    const DRUM: f64 = 2.0;
    let overlap = GRAVITY / STIFFNESS;
    let farthest = |part: f64| {
        let spin = part * 3.0 * DRUM / RADIUS;
        let grain = format!("position = [0.0, 0.0, {:?}]\nspin = [0.0, {spin:?}, 0.0]", -(DRUM - RADIUS + overlap));
        let wall = format!(
            "cylinder = {{ axis = [[0.0, -5.0, 0.0], [0.0, 5.0, 0.0]], radius = {DRUM:?} }}\n\
             motion = [{{ spin = [0.0, 3.0, 0.0], centre = [0.0, 0.0, 0.0] }}]"
        );
        let record = run(&scene(3.0, 0.5, &grain, &wall));
        record.series.column("ball.x").unwrap().iter().fold(0.0_f64, |far, x| far.max(x.abs()))
    };
    // A lever arm that is wrong by half an overlap changes the spin by 2e-5.
    assert!(farthest(1.0) < 1e-4, "{}", farthest(1.0));
    // After a slip of 0.01 ΩR, the sphere rolls at 2/7 of this velocity. The amplitude is v/ω with ω² = 5g/7(R − r).
    let swing = 2.0 / 7.0 * 0.01 * 3.0 * DRUM / (5.0 / 7.0 * GRAVITY / (DRUM - RADIUS)).sqrt();
    assert!((farthest(0.99) / swing - 1.0).abs() < 0.01, "{} for {swing}", farthest(0.99));
}

/// In a cone of 45°, a sphere moves on a circle of radius ρ at v² = g ρ. The wall force then balances weight and
/// centrifugal force.
#[test]
fn a_sphere_goes_round_in_a_cone() {
    let (orbit, overlap) = (1.5_f64, GRAVITY * 2.0_f64.sqrt() / STIFFNESS);
    let height = orbit + 2.0_f64.sqrt() * (RADIUS - overlap);
    let spread = |part: f64| {
        let speed = part * (GRAVITY * orbit).sqrt();
        let grain = format!("position = [{orbit:?}, 0.0, {height:?}]\nvelocity = [0.0, {speed:?}, 0.0]");
        let wall = "cone = { axis = [[0.0, 0.0, 0.0], [0.0, 0.0, 4.0]], radii = [0.0, 4.0] }";
        let record = run(&scene(5.0, 0.0, &grain, wall));
        let column = |name: &str| record.series.column(name).unwrap();
        let away = column("ball.x").iter().zip(column("ball.y")).map(|(x, y)| (x.hypot(*y) / orbit - 1.0).abs());
        away.fold(0.0, f64::max)
    };
    assert!(spread(1.0) < 1e-4, "{}", spread(1.0));
    assert!(spread(1.02) > 1e-2, "{}", spread(1.02));
}

/// Grains between the ends of a rotating drum, and in a funnel above the drum.
const DRUM_AND_FUNNEL: &str = include_str!("../scenes/drum-and-funnel.toml");

/// LAMMPS with the deck of the scene has the same energy and the same wall forces, until chaos amplifies rounding.
/// Without LAMMPS, nothing is compared, which is an error in CI.
#[test]
fn lammps_has_the_same_round_walls() {
    let lammps = solvers::by_name("lammps").unwrap();
    if let Err(reason) = lammps.available() {
        assert!(std::env::var_os("CI").is_none(), "{reason}");
        return;
    }
    let scene = common::scene(DRUM_AND_FUNNEL);
    let [ours, theirs] = ["dem:lammps", "lammps"].map(|name| simulated(name, &scene, &Resolution::TimeStep(2e-4)));
    for name in ["all.kinetic_energy", "all.rotational_energy", "drum.force_z", "funnel.force_z"] {
        let [ours, theirs] = [&ours, &theirs].map(|record| record.series.column(name).unwrap());
        let largest = ours.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        assert!(largest > 1.0 && ours.len() == theirs.len(), "{name}");
        for (ours, theirs) in ours.iter().zip(theirs) {
            assert!((ours - theirs).abs() < 1e-8 * largest, "{name}: {ours} for {theirs}");
        }
    }
}
