//! An effect that is absent costs next to nothing: instructions of the kernel for undamped, frictionless discs against a loop written
//! by hand that knows nothing else, counted by valgrind where it is installed. Counts do not depend on what else the machine does.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "../benches/minimal/mod.rs"]
mod minimal;

use grainbench::cases::effect::Effect;
use grainbench::cases::registry;
use grainbench::dem::convention::Convention;
use grainbench::dem::solver::Dem;
use grainbench::scene::scene::Scene;
use grainbench::scene::source::SceneSource;
use minimal::Minimal;
use std::path::Path;
use std::process::Command;
use std::sync::Mutex;
use std::time::Duration;

/// Held by what counts and by what is timed, which would feel the counting beside it.
static ALONE: Mutex<()> = Mutex::new(());

/// Says which loop a process under valgrind runs, and for how many steps.
const TASK: &str = "GRAINBENCH_COUNTED_LOOP";
const SIDE: u32 = 24;
const STEP: f64 = 0.05;
/// Instructions of the kernel over those of the loop by hand.
const ALLOWED: f64 = 1.02;

/// A square lattice of overlapping discs that starts to come apart at its rim: the list is never built anew.
fn lattice() -> Scene {
    let text = format!(
        "title = 'lattice'\ndimension = 2\nduration = 1.0\nmaterials.disc.density = 0.3183098861837907\n\
         contacts.all = {{ between = ['disc', 'disc'], normal_stiffness = 1.0 }}\n\
         grains.disc = {{ material = 'disc', radius = 1.0, lattice = {{ origin = [0.0, 0.0], spacing = [1.999, 1.999], \
         count = [{SIDE}, {SIDE}] }} }}\n"
    );
    let source = SceneSource::from_text("lattice", Path::new(""), &text);
    source.scene(&|_| Err("no data files here".to_owned())).unwrap()
}

/// What runs under valgrind; nothing when the test is run as a test.
#[test]
fn counted_loop() {
    let Ok(task) = std::env::var(TASK) else { return };
    let (name, steps) = task.split_once(' ').unwrap();
    let steps: u64 = steps.parse().unwrap();
    let mut scene = lattice();
    match name {
        "by-hand" => {
            let place = |grain: &grainbench::scene::scene::Grain| {
                ([grain.position.x, grain.position.y], grain.radius, grain.mass)
            };
            let discs: Vec<_> = scene.grains.iter().map(place).collect();
            let mut minimal = Minimal::new(&discs, 1.0, 0.2);
            (0..steps).for_each(|_| minimal.step(STEP));
            assert!(minimal.touching >= steps * u64::from(SIDE * SIDE) && minimal.farthest < 0.01);
        }
        _ => {
            if name == "with-idle-friction" {
                assert!(Effect::Friction.switch_on_idly(&mut scene));
            }
            let mut simulation = Dem::new(Convention::CUNDALL_STRACK).start(&scene, STEP).unwrap();
            simulation.advance(steps).unwrap();
            assert_eq!(simulation.cost().neighbour_builds, 1);
        }
    }
}

/// Instructions of so many steps.
fn instructions(name: &str, steps: u64) -> Option<f64> {
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(std::env::current_exe().unwrap())
        .args(["--exact", "counted_loop", "--test-threads=1"])
        .env(TASK, format!("{name} {steps}"))
        .output()
        .ok()?;
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{text}\n{}", String::from_utf8_lossy(&output.stdout));
    let line = text.lines().find(|line| line.contains("Collected :")).expect("callgrind says how many it counted");
    line.split(':').nth(1)?.trim().parse().ok()
}

/// Instructions a step: of many steps less those of few, so that setting up cancels.
fn a_step(name: &str) -> Option<f64> {
    Some((instructions(name, 60)? - instructions(name, 10)?) / 50.0)
}

#[test]
fn what_is_absent_costs_next_to_nothing() {
    let _alone = ALONE.lock();
    let (Some(by_hand), Some(kernel)) = (a_step("by-hand"), a_step("kernel")) else {
        eprintln!("valgrind is not installed: nothing was counted");
        return;
    };
    let idle = a_step("with-idle-friction").unwrap();
    println!("instructions a step: by hand {by_hand}, kernel {kernel}, friction that does nothing {idle}");
    assert!(kernel <= ALLOWED * by_hand, "the kernel takes {kernel} instructions a step, a loop by hand {by_hand}");
    // The control: where an effect is compiled in, the count shows it.
    assert!(idle > 1.1 * kernel, "friction that does nothing takes {idle} instructions, none {kernel}");
}

/// With friction taken out of dense shear a step is at least 1.3 times as fast as with friction at μ = 0: 1.4 to 1.5 where nothing
/// else runs. While the core is shared memory is waited for, and the ratio is 1.2; then it is asked again, for a while.
#[test]
fn no_friction_is_faster_than_friction_that_does_nothing() {
    use grainbench::scene::scene::Duration::Cycles;
    use grainbench::scene::solver::Resolution;
    use grainbench::studies::effects::idle::try_idly;
    const TRIES: usize = 5;
    let _alone = ALONE.lock();
    let mut scene = registry::by_name("plane-shear").unwrap().variant("plain").unwrap();
    scene.change_laws(|law| (law.friction, law.tangential_damping) = (0.0, 0.0));
    scene.duration = Cycles(100);
    let mut seen = Vec::new();
    while seen.len() < TRIES && seen.last().is_none_or(|time| *time < 1.3) {
        let resolution = Resolution::TimeStep(1e-4);
        let idle = try_idly("dem", &scene, &resolution, Effect::Friction, Duration::from_secs(4)).unwrap().unwrap();
        assert!(idle.same && idle.counts == 1.0, "{idle:?}");
        seen.push(idle.time);
    }
    assert!(seen.last().is_some_and(|time| *time >= 1.3), "{seen:?}");
}
