//! Tests that absent effects take no memory, and that effects with a neutral value change no bit.

use crate::support::{collision, column, incline, run, scene};
use grainbench_mpm::options::Transfer;
use grainbench_mpm::solver::Mpm;
use grainbench_scene::effect::Effect;
use grainbench_scene::scene::{Duration, Scene};
use grainbench_solver::Solver;
use grainbench_solver::record::{Cost, Record};
use grainbench_solver::resolution::Resolution;

const AT: Resolution = Resolution::grid(4.0, 2);

/// Returns two rotating discs that collide off centre, with the given constitutive law and coefficient of friction.
fn discs(friction: f64, constitutive: &str) -> Scene {
    let modulus = "shear_modulus = 6.0";
    let text = collision(0.1, friction, 0.5).replace(modulus, &format!("{modulus}, {constitutive}"));
    scene(&format!("{text}[output]\nsnapshots = 3\n"))
}

const ELASTIC: &str = "constitutive = 'hypoelastic'";
const RUBBER: &str = "constitutive = 'neo-hookean'";
const YIELDING: &str = "constitutive = 'von-mises', yield_stress = 0.01";

fn ran(solver: Mpm, scene: &Scene) -> Record {
    solver.run(scene, &AT, &mut ()).unwrap()
}

/// Returns the series and snapshots of a record with all bits, without costs and names of effects.
fn bits(record: &Record) -> String {
    format!("{:?} {:?}", record.series, record.snapshots)
}

fn bytes_of(solver: Mpm, scene: &Scene) -> u64 {
    ran(solver, scene).cost.bytes.unwrap()
}

/// Each absent effect saves the memory of its data: friction four springs of 32 B per tracer, plasticity a number per
/// point, and the affine part a matrix per point. A requested energy budget takes memory too.
#[test]
fn what_is_off_takes_no_memory() {
    // The run ends before the discs collide, because both scenes must have the same nodes.
    let discs = |friction: f64, constitutive: &str| {
        let duration = Duration::Seconds(0.1);
        Scene { duration, ..discs(friction, constitutive) }
    };
    let elastic = discs(0.0, ELASTIC);
    let points = |cost: Cost| cost.particle_steps / cost.steps;
    let cost = ran(Mpm::BEST, &elastic).cost;
    let plain = cost.bytes.unwrap();
    // There are two circles with 6 tracers per cell and 4 cells per radius: 2π·24 on each, rounded up to a multiple of
    // four.
    assert_eq!(bytes_of(Mpm::BEST, &discs(0.5, ELASTIC)) - plain, 2 * 152 * 4 * 32);
    assert_eq!(bytes_of(Mpm::BEST, &discs(0.0, YIELDING)) - plain, points(cost) * 8);
    let flip = Mpm::BEST.with(|setting| setting.transfer = Transfer::Flip { pic: 0.0 });
    let apic = Mpm::BEST.with(|setting| setting.transfer = Transfer::Apic);
    let difference = bytes_of(apic, &alone()) - bytes_of(flip, &alone());
    assert_eq!(difference, points(ran(flip, &alone()).cost) * 32);
    let mut asked = elastic;
    asked.probes = scene(&format!("{}budget.budget = true\n", collision(0.1, 0.0, 0.5))).probes;
    assert!(bytes_of(Mpm::BEST, &asked) > plain);
}

/// Returns a disc at rest, for which both transfers have the same nodes.
fn alone() -> Scene {
    scene(
        "dimension = 2\nduration = 0.5\nmaterials.m = { density = 1.0, bulk_modulus = 10.0, shear_modulus = 6.0 }\n\
         [grains.g]\nmaterial = 'm'\nradius = 1.0\nposition = [0.0, 0.0]\n",
    )
}

/// With nodal contact no tracer has a spring, for any friction.
#[test]
fn contact_at_nodes_has_no_springs() {
    let gap = Mpm::named("mpm:gap").unwrap();
    assert_eq!(bytes_of(gap, &discs(0.5, ELASTIC)), bytes_of(gap, &discs(0.0, ELASTIC)));
}

/// An effect with a neutral value gives the same result as its absence. The test covers friction of a material that no
/// grain has, between discs and at a plane, a yield stress that is never reached, and a neutral viscosity.
#[test]
fn an_idle_effect_changes_no_bit() {
    let plane = || scene(&format!("{}[output]\nsnapshots = 3\n", incline(30.0, 0.0, 0.1, false)));
    let cases = [
        (Effect::Friction, Mpm::BEST, discs(0.0, ELASTIC)),
        (Effect::Friction, Mpm::BEST, plane()),
        (Effect::Friction, Mpm::named("mpm:gap").unwrap(), discs(0.0, ELASTIC)),
        (Effect::Plasticity, Mpm::BEST, discs(0.5, ELASTIC)),
        (Effect::Plasticity, Mpm::named("mpm:penalty").unwrap(), discs(0.5, ELASTIC)),
        (Effect::Viscosity, Mpm::BEST, discs(0.5, RUBBER)),
    ];
    for (effect, solver, without) in cases {
        let mut idle = without.clone();
        assert!(effect.switch_on_idly(&mut idle) && effect.is_on(&idle));
        let [without, idle] = [ran(solver, &without), ran(solver, &idle)];
        assert!(bits(&without) == bits(&idle), "{}, {effect:?} is not idle", solver.name);
        // Viscosity stores nothing between steps.
        if solver == Mpm::BEST && effect != Effect::Viscosity {
            assert!(without.cost.bytes < idle.cost.bytes, "{effect:?} takes no memory");
        }
    }
}

/// A requested budget does not change the other results.
#[test]
fn a_budget_only_looks_on() {
    for solver in Mpm::ALL {
        let [without, with] = ["", "budget.budget = true\n"]
            .map(|probe| ran(solver, &scene(&format!("{}{probe}[output]\nsnapshots = 3\n", collision(0.1, 0.5, 0.5)))));
        assert!(format!("{:?}", without.snapshots) == format!("{:?}", with.snapshots), "{}", solver.name);
    }
}

/// With FLIP the kinetic energy of a spinning disc is ½ I ω², from the velocities of its points alone.
#[test]
fn points_without_an_affine_part_have_no_energy_in_it() {
    let spin: f64 = 0.1;
    let text = format!(
        "dimension = 2\nduration = 0.1\nmaterials.m = {{ density = 1.0, bulk_modulus = 10.0, shear_modulus = 6.0 }}\n\
         [grains.g]\nmaterial = 'm'\nradius = 1.0\nposition = [0.0, 0.0]\nspin = {spin}\n[probes]\nbudget.budget = true\n"
    );
    let kinetic = column(&run("mpm:penalty", &text, 4.0, 2), "budget.kinetic")[0];
    let exact = 0.25 * std::f64::consts::PI * spin * spin;
    assert!((kinetic / exact - 1.0).abs() < 1e-12, "{kinetic} {exact}");
}
