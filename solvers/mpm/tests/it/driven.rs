//! Tests of driven grains and of the energy budget of their work.

use crate::support::{SPEED, change, collision, column, last, run, scene, try_run};
use grainbench_solver::resolution::Resolution;

/// Returns a collision in which the left disc is driven, so fast that the right disc cannot escape. With `yields`, the
/// discs yield.
fn pushed(friction: f64, offset: f64, yields: bool) -> String {
    let mut text = collision(0.1, friction, offset);
    if yields {
        let law = "shear_modulus = 6.0, constitutive = 'von-mises', yield_stress = 0.05, hardening_modulus = 0.1";
        text = text.replace("shear_modulus = 6.0", law);
    }
    format!("{text}budget.budget = true\nleft.driven = 'ram'\n[driven.ram]\ngrains = 'a'\nvelocity = [{SPEED}, 0.0]\n")
}

#[test]
fn a_driven_grain_keeps_its_motion_and_reports_it() {
    for name in ["mpm", "mpm:penalty", "mpm:gap", "mpm:2000", "mpm:2001", "mpm:no-slip"] {
        let record = run(name, &pushed(0.5, 0.5, true), 8.0, 2);
        let way = SPEED * record.series.time.last().unwrap();
        assert!((change(&record, "a.x") - way).abs() < 1e-12, "{name}: {}", last(&record, "a.x"));
        assert!(last(&record, "a.angle").abs() < 1e-12 && (last(&record, "a.vx") - SPEED).abs() < 1e-14, "{name}");
        // The right disc moves in the direction of the push.
        assert!(last(&record, "b.vx") > 0.0, "{name}: {}", last(&record, "b.vx"));
        let scale = last(&record, "budget.impulse_x");
        let off = change(&record, "budget.momentum_x") - scale;
        assert!(off.abs() < 1e-11 * scale.abs(), "{name}: momentum is off by {off} of {scale}");
    }
}

/// A driven grain pushes like a body of infinite mass. With nodal contact, eight times the density and moduli have no
/// effect.
#[test]
fn the_density_of_a_driven_grain_has_no_effect() {
    let light = pushed(0.5, 0.5, false);
    let heavy = light
        .replace(
            "contacts.m =",
            "materials.h = { density = 8.0, bulk_modulus = 80.0, shear_modulus = 48.0 }\ncontacts.m =",
        )
        .replace("contacts.m =", "contacts.h = { between = ['m', 'h'], law = 'coulomb', friction = 0.5 }\ncontacts.m =")
        .replacen("[grains.a]\nmaterial = 'm'", "[grains.a]\nmaterial = 'h'", 1);
    for name in ["mpm:2000", "mpm:2001"] {
        let [light, heavy] = [&light, &heavy].map(|text| run(name, text, 8.0, 2));
        for probe in ["b.vx", "b.vy", "b.omega"] {
            let [light, heavy] = [&light, &heavy].map(|record| last(record, probe));
            assert!(light != 0.0 && (heavy / light - 1.0).abs() < 1e-9, "{name}: {probe} {light} and {heavy}");
        }
    }
}

#[test]
fn the_budget_of_a_push_closes() {
    // Yielding points take the spin of the velocity field around them and lose their own spin energy.
    for (name, yields, allowed, lost) in [
        ("mpm", false, 2e-3, 0.005),
        ("mpm", true, 2e-3, 0.02),
        ("mpm:penalty", true, 5e-3, 0.005),
        ("mpm:gap", true, 5e-3, 0.05),
        ("mpm:no-slip", true, 5e-3, 0.05),
    ] {
        let record = run(name, &pushed(0.5, 0.5, yields), 8.0, 2);
        let budget = |entry: &str| last(&record, &format!("budget.{entry}"));
        let open = change(&record, "budget.unbalanced") / budget("work");
        assert!(budget("work") > 0.0 && open.abs() < allowed, "{name}: {open}");
        assert_eq!(budget("plastic") > 0.0, yields, "{name}");
        assert_eq!(budget("friction") > 0.0, name != "mpm:no-slip", "{name}");
        // Energy lost or created by the method is small compared with the work.
        let made = (budget("transfer") + budget("contact")) / budget("work");
        assert!(made.abs() < lost, "{name}: {made}");
    }
}

/// A budget without one of its entries, here friction, does not close.
#[test]
fn the_budget_misses_what_is_left_out() {
    let record = run("mpm", &pushed(0.5, 0.5, false), 8.0, 2);
    let open = change(&record, "budget.unbalanced") - last(&record, "budget.friction");
    let work = last(&record, "budget.work");
    assert!(open.abs() > 5e-3 * work, "{open} of {work}");
}

#[test]
fn a_yielding_grain_reports_its_plastic_strain() {
    let record = run("mpm", &pushed(0.5, 0.5, true), 8.0, 2);
    let grains = &record.snapshots.last().unwrap().grains;
    assert!(grains[0].plastic_strain == 0.0, "what is driven does not deform");
    let points = &record.snapshots.last().unwrap().points;
    let of_second = points.iter().filter(|point| point.owner == grainbench_solver::record::Owner::Grain(2));
    assert!(grains[1].plastic_strain > 0.0 && of_second.map(|point| point.plastic_strain).sum::<f64>() > 0.0);
    assert_eq!(scene(&pushed(0.5, 0.5, true)).driven[0].grains, [0]);
}

/// The residual of the budget is of first order in the time step. With a quarter of the step, less than two fifths of the
/// residual remain, for any contact and material.
#[test]
fn the_budget_closes_as_the_step_goes_to_zero() {
    for name in ["mpm", "mpm:gap", "mpm:2000", "mpm:no-slip"] {
        for yields in [false, true] {
            let [coarse, fine] = [0.4, 0.1].map(|courant| {
                let at = Resolution::Grid { cells: 8.0, points: 2, courant };
                let record = try_run(name, |_| (), &pushed(0.5, 0.5, yields), at).unwrap();
                change(&record, "budget.unbalanced") / last(&record, "budget.work")
            });
            assert!(fine.abs() < 1e-3 && fine.abs() < 0.4 * coarse.abs(), "{name}, {yields}: {coarse} and {fine}");
        }
    }
}

/// Positions follow the sine to rounding. A spin is rejected.
#[test]
fn a_driven_grain_follows_a_sine() {
    let scene_text = |driven: &str| format!("{}[driven.ram]\ngrains = 'a'\n{driven}\n", collision(0.1, 0.0, 0.5));
    let driven = scene_text("motion = [{ sine = { amplitude = [0.0, 0.05], frequency = 0.02 } }]");
    let record = run("mpm", &driven, 8.0, 2);
    let (y, time) = (column(&record, "a.y"), &record.series.time);
    for (y_now, t) in y.iter().zip(time) {
        let exact = 0.05 * (std::f64::consts::TAU * 0.02 * t).sin();
        assert!((y_now - y[0] - exact).abs() < 1e-12, "{t}: {}", y_now - y[0]);
    }
    assert!((last(&record, "a.y") - y[0]).abs() > 1e-3);
    let refusal = try_run("mpm", |_| (), &scene_text("spin = 1.0"), Resolution::grid(8.0, 2)).unwrap_err().to_string();
    assert!(refusal.contains("driven grains that rotate"), "{refusal}");
}

/// Returns a driven disc under a free disc, in gravity and with global damping.
fn loaded(gap: f64) -> String {
    format!(
        "dimension = 2\nduration = 20.0\ngravity = [0.0, -0.02]\nglobal_damping = 1.0\nlargest_initial_overlap = 0.1\n\
         materials.m = {{ density = 1.0, bulk_modulus = 10.0, shear_modulus = 6.0 }}\n\
         contacts.m = {{ between = ['m', 'm'], law = 'coulomb', friction = 0.5 }}\n\
         [grains.a]\nmaterial = 'm'\nradius = 1.0\nposition = [0.0, 0.0]\n\
         [grains.b]\nmaterial = 'm'\nradius = 1.0\nposition = [0.0, {}]\n\
         [driven.ram]\ngrains = 'a'\nvelocity = [0.0, 0.0]\n[probes]\nram.driven = 'ram'\nb.grain = 'b'\n",
        2.0 + gap
    )
}

/// The force on a driven disc is the weight m g of the disc that rests on it, without its own weight, and zero without
/// contact, when the disc is moved against gravity and global damping α. With α = 1/s, the oscillation of the free disc
/// decays by exp(−αt/2) = 5e-5, and the damped nodes pass on the force divided by 1 + αΔt/2. The tolerance is αΔt.
#[test]
fn the_force_on_a_driven_grain_is_that_of_its_contacts() {
    let weight = std::f64::consts::PI * 0.02;
    for name in ["mpm", "mpm:2000"] {
        let record = run(name, &loaded(0.0), 8.0, 2);
        let force = last(&record, "ram.force_y");
        assert!((force / -weight - 1.0).abs() < record.provenance.time_step, "{name}: {force} for {}", -weight);
        let motion = "motion = [{ sine = { amplitude = [0.1, 0.2], frequency = 0.1 } }]";
        let alone = run(name, &loaded(50.0).replace("velocity = [0.0, 0.0]", motion), 8.0, 2);
        let forces = [column(&alone, "ram.force_x"), column(&alone, "ram.force_y")].concat();
        let largest = forces.iter().fold(0.0, |largest: f64, force| largest.max(force.abs()));
        assert!(largest < 1e-9 * weight, "{name}: {largest}");
    }
}
