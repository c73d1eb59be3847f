//! Tests of collisions of two and three deformable discs, of conserved quantities, and of dissipation by viscosity.

use crate::support::{SPEED, change, collision, column, energy, last, run, try_run};
use grainbench_mpm::solver::Mpm;
use grainbench_solver::Solver;
use grainbench_solver::record::Record;
use grainbench_solver::resolution::Resolution;

fn momentum_drift(record: &Record) -> f64 {
    let pair = column(record, "all.momentum_x").iter().zip(column(record, "all.momentum_y"));
    pair.map(|(x, y)| x.hypot(*y)).fold(0.0, f64::max) / (std::f64::consts::PI * SPEED)
}

/// In a head-on collision without friction, energy is conserved. The coefficient of restitution is .98, the converged
/// elastic result. At four cells per radius, quadratic functions are too coarse for the vibration after the impact.
#[test]
fn springs_keep_energy_and_momentum() {
    for (cells, energy_allowed, restitution_allowed) in [(4.0, 0.025, 0.04), (8.0, 0.005, 0.015)] {
        let record = run("mpm", &collision(2.0 / cells, 0.0, 0.0), cells, 3);
        assert!((energy(&record) - 1.0).abs() < energy_allowed, "{cells}: {}", energy(&record));
        let restitution = -last(&record, "a.vx") / SPEED;
        assert!((restitution - 0.98).abs() < restitution_allowed, "{cells}: {restitution}");
        assert!(momentum_drift(&record) < 1e-12);
        assert!((last(&record, "a.omega") / SPEED).abs() < 0.01);
    }
}

/// Kinetic, elastic and contact energy refer to the same time, so their sum is nearly constant during contact. (With
/// spring energies at the beginning of the step, the error would be +.8 and −1.8 % here.)
#[test]
fn the_sum_of_energies_hardly_rings() {
    let at = Resolution::Grid { cells: 8.0, points: 3, courant: 0.2 };
    let record = try_run("mpm", |_| (), &collision(0.25, 0.0, 0.0), at).unwrap();
    let energy = column(&record, "all.total_energy");
    let (low, high) = energy.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), &at| (low.min(at), high.max(at)));
    assert!(low > 0.99 * energy[0] && high < 1.002 * energy[0], "{} {}", low / energy[0], high / energy[0]);
}

/// Damping also acts on relative motion of points that nodes do not represent. Energy falls as e^(−αt) or faster. With
/// damping of nodes alone, 2e-3 of the energy would remain. The budget reports the damping work.
#[test]
fn damping_reaches_what_nodes_do_not_show() {
    let text = collision(0.02, 0.5, 0.5) + "budget.budget = true\n";
    let text = format!("global_damping = 1.0\n{}", text.replace("duration = ", "duration = 3.0\n#"));
    let early = last(&run("mpm", &text, 8.0, 3), "budget.kinetic");
    let record = run("mpm", &text.replace("duration = 3.0", "duration = 12.0"), 8.0, 3);
    let budget = |entry: &str| last(&record, &format!("budget.{entry}"));
    let start = column(&record, "budget.kinetic")[0];
    assert!(early < 0.1 * start && budget("kinetic") < 1e-5 * start, "{early} {} of {start}", budget("kinetic"));
    assert!(budget("damping") > 0.95 * start, "{} of {start}", budget("damping"));
    assert!((budget("unbalanced") / start - 1.0).abs() < 1e-3, "{} of {start}", budget("unbalanced"));
}

/// After an off-centre collision with strong friction, ωR/v₀ = .40 at eight cells per radius.
#[test]
fn friction_turns_discs() {
    let record = run("mpm", &collision(0.25, 0.9, 0.5), 8.0, 3);
    assert!((last(&record, "a.omega") / SPEED - 0.40).abs() < 0.01, "{}", last(&record, "a.omega") / SPEED);
    assert!((last(&record, "a.omega") - last(&record, "b.omega")).abs() < 1e-9);
    assert!(momentum_drift(&record) < 1e-12);
}

/// The contact `mpm:gap` creates no energy and conserves momentum. The 2000 contact releases departing bodies and
/// creates energy, and the 2001 criterion creates less.
#[test]
fn nodal_contacts_do_what_they_are_known_for() {
    let gap = run("mpm:gap", &collision(0.5, 0.0, 0.0), 8.0, 3);
    assert!((0.97..1.002).contains(&energy(&gap)), "{}", energy(&gap));
    assert!((-last(&gap, "a.vx") / SPEED - 0.962).abs() < 0.02);
    assert!(momentum_drift(&gap) < 1e-12);
    let kinematic = run("mpm:2000", &collision(0.5, 0.0, 0.0), 8.0, 3);
    assert!(energy(&kinematic) > 1.05, "{}", energy(&kinematic));
    let traction = run("mpm:2001", &collision(0.5, 0.0, 0.0), 8.0, 3);
    assert!(energy(&traction) < energy(&kinematic));
}

/// Discs of materials without a contact law pass through each other.
#[test]
fn without_a_law_nothing_is_felt() {
    let mut scene = crate::support::scene(&collision(0.5, 0.0, 0.0));
    scene.laws = vec![None];
    for solver in ["mpm", "mpm:gap", "mpm:2000", "mpm:2001"] {
        let solver = Mpm::named(solver).unwrap();
        let record = solver.run(&scene, &Resolution::grid(4.0, 2), &mut ()).unwrap();
        assert!((last(&record, "a.vx") / SPEED - 1.0).abs() < 1e-9, "{}", last(&record, "a.vx") / SPEED);
    }
}

/// Three discs that collide at a point conserve momentum, and all rebound alike.
#[test]
fn three_discs_keep_momentum() {
    let at = |number: f64| {
        let angle = (90.0 + 120.0 * number).to_radians();
        let away = 2.0 / 3.0_f64.sqrt() + 0.05;
        (away * angle.cos(), away * angle.sin(), -SPEED * angle.cos(), -SPEED * angle.sin())
    };
    let mut text = "dimension = 2\nduration = 10.0\n\
        materials.m = { density = 1.0, bulk_modulus = 10.0, shear_modulus = 6.0 }\n\
        contacts.m = { between = ['m', 'm'], law = 'coulomb', friction = 0.3 }\n\
        probes.all.system = true\nprobes.a.grain = 'g0'\nprobes.b.grain = 'g1'\n"
        .to_owned();
    for number in 0..3 {
        let (x, y, vx, vy) = at(f64::from(number));
        text += &format!(
            "[grains.g{number}]\nmaterial = 'm'\nradius = 1.0\nposition = [{x}, {y}]\nvelocity = [{vx}, {vy}]\n"
        );
    }
    for solver in ["mpm", "mpm:gap"] {
        let record = run(solver, &text, 8.0, 2);
        assert!(momentum_drift(&record) < 1e-12);
        assert!((0.95..1.01).contains(&energy(&record)), "{solver}: {}", energy(&record));
        let back =
            |name: &str| last(&record, &format!("{name}.vx")).hypot(last(&record, &format!("{name}.vy"))) / SPEED;
        assert!((back("a") - back("b")).abs() < 0.1 && back("a") > 0.8, "{solver}: {} {}", back("a"), back("b"));
    }
}

/// A pair that collides across a periodic face behaves like a pair in the middle of the domain.
#[test]
fn a_periodic_face_is_not_felt() {
    let scene = |shift: f64| {
        format!(
            "dimension = 2\nduration = 8.0\ndomain = {{ low = [0.0, 0.0], high = [8.0, 8.0], periodic = [true, true] }}\n\
             materials.m = {{ density = 1.0, bulk_modulus = 10.0, shear_modulus = 6.0 }}\n\
             contacts.m = {{ between = ['m', 'm'], law = 'coulomb', friction = 0.3 }}\n\
             [grains.a]\nmaterial = 'm'\nradius = 1.0\nposition = [{}, 4.0]\nvelocity = [0.05, 0.0]\n\
             [grains.b]\nmaterial = 'm'\nradius = 1.0\nposition = [{}, 4.5]\nvelocity = [-0.05, 0.0]\n\
             [probes]\na.grain = 'a'\n",
            (shift - 1.0_f64).rem_euclid(8.0),
            (shift + 1.0_f64).rem_euclid(8.0)
        )
    };
    // At a node with nearly zero traction, rounding decides the 2001 criterion.
    for (solver, allowed) in [("mpm", 1e-7), ("mpm:gap", 1e-7), ("mpm:2001", 2e-3)] {
        let [middle, face] = [4.0, 8.0].map(|shift| run(solver, &scene(shift), 4.0, 2));
        for name in ["a.vx", "a.vy", "a.omega"] {
            let [one, two] = [&middle, &face].map(|record| last(record, name));
            assert!((one - two).abs() < allowed, "{solver} {name}: {one} {two}");
        }
        assert!(last(&middle, "a.vx") < 0.03, "{solver}: they met");
    }
}

/// Two viscous discs collide. Their viscous dissipation is part of the damping entry, and the budget closes to first
/// order in the time step. Without viscosity the damping entry is zero.
#[test]
fn the_budget_of_a_viscous_collision_closes() {
    let budget_error = |viscosity: &str, courant: f64| {
        let modulus = "shear_modulus = 6.0";
        let text =
            collision(0.02, 0.0, 0.5).replace(modulus, &format!("{modulus}, {viscosity}")) + "budget.budget = true\n";
        let record = try_run("mpm", |_| (), &text, Resolution::Grid { cells: 8.0, points: 3, courant }).unwrap();
        let kinetic = column(&record, "budget.kinetic")[0];
        (last(&record, "budget.damping") / kinetic, change(&record, "budget.unbalanced") / kinetic)
    };
    let viscous = "constitutive = 'kelvin-voigt', viscosity = 0.5, bulk_viscosity = 0.2";
    let (lost, coarse) = budget_error(viscous, 0.4);
    let (_, fine) = budget_error(viscous, 0.1);
    assert!(lost > 0.05, "{lost}");
    assert!(fine.abs() < 1e-3 && (fine.abs() < 0.4 * coarse.abs() || fine.abs() < 1e-5), "{coarse} and {fine}");
    let (nothing, _) = budget_error("constitutive = 'neo-hookean'", 0.4);
    assert_eq!(nothing, 0.0);
}
