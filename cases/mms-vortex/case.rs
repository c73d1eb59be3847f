//! A manufactured vortex: large rotation and shear.

use crate::exact::manufactured::error;
use grainbench_harness::measure::slope;
use grainbench_harness::prelude::*;
use grainbench_scene::scene::Duration;

const LEVELS: &[Level] = &[level("1/16", 16.0), level("1/32", 32.0), level("1/64", 64.0)];
const SOLVERS: [(&str, &str); 3] = [
    ("quadratic B-splines, FLIP with spin", "mpm"),
    ("uGIMP, FLIP", "mpm+gimp+flip"),
    ("hat functions, FLIP", "mpm+linear+flip"),
];
const KEEPS_NO_NOISE: &str = "mpm+apic";
const SOURCE: Source = Source::Derived("manufactured solution (derivation)");

/// Small steps: the error in time must stay below that of the grid.
const fn level(name: &'static str, cells: f64) -> Level {
    Level { name, resolution: Resolution::Grid { cells, points: 3, courant: 0.1 } }
}

pub(crate) static CASE: Case = Case {
    name: "mms-vortex",
    title: "Manufactured vortex",
    claim: "Displacements converge in a motion that turns and shears the material by far; points that are stretched \
            that far do not let go of each other.",
    scene: include_str!("scene.toml"),
    derivation: include_str!("derivation.md"),
    weakness: "One material law, no contact, and edges at which nothing happens.",
    levels: LEVELS,
    default_level: LEVELS[1],
    claims: &claims,
    figures,
    home: &crate::registry::HOME,
};

/// Up to the largest turn.
fn half(scene: &mut Scene) {
    scene.duration = Duration::Seconds(0.5);
}

fn run(solver: &'static str, level: Level) -> Run {
    Run::new(PLAIN, solver, level.resolution).adjusted("to .5 s", half)
}

fn order(done: &[Done]) -> Result<f64, Missing> {
    let points: Result<Vec<(f64, f64)>, Missing> =
        done.iter().zip([16.0, 32.0]).map(|(done, cells)| Ok((1.0 / cells, error(done)?))).collect();
    Ok(slope(&points?))
}

fn claims() -> Vec<Claim> {
    let damped = || Control::scene("a damping of .3 per second", |scene| scene.global_damping = 0.3);
    let off = |quantity: String, run: Run, tolerance, control| {
        claim(quantity, "m")
            .of(run)
            .equals(SOURCE, |done| Ok(Measured::new(error(&done[0])?, 0.0, 1.0)))
            .within(tolerance)
            .refuses(control)
    };
    let mut claims = Vec::new();
    for (solver, allowed) in [("mpm", 0.1), ("mpm+gimp+flip", 0.2)] {
        claims.push(
            claim("order in the cell at the largest turn, 16 to 32 cells", "1")
                .of_all(LEVELS[..2].iter().map(|&level| run(solver, level).slow()))
                .converges(2.0, SOURCE, order)
                .within(judged(allowed, "two levels, and a force that jumps at the edges"))
                .refuses(damped()),
        );
        for (level, allowed) in LEVELS.iter().zip([0.036, 9.5e-3]) {
            claims.push(off(
                format!("root mean square error of the displacement at the largest turn, {} cells", level.name),
                if *level == LEVELS[0] { run(solver, *level) } else { run(solver, *level).slow() },
                judged(
                    allowed,
                    "discretisation, of second order; in units of 1 m, the radius of the ring and nearly the largest \
                     way",
                ),
                damped(),
            ));
        }
    }
    let back = |run, tolerance, control| {
        let quantity = "root mean square error of the displacement when all is back, t = 1 s, 1/32 cells";
        off(quantity.to_owned(), run, tolerance, control)
    };
    let full = |solver| Run::new(PLAIN, solver, LEVELS[1].resolution).slow();
    claims.push(back(full(KEEPS_NO_NOISE), judged(7e-3, "discretisation; in units of 1 m"), damped()));
    claims.push(back(
        full("mpm").known(
            "FLIP keeps what a grid cannot see of the points' velocities: it has grown by the time all is back. A \
             transfer that drops it converges, and loses the energy of rolling grains instead",
        ),
        judged(1.2e-2, "what APIC reaches"),
        Control::without_the_error("APIC", KEEPS_NO_NOISE, LEVELS[1].resolution),
    ));
    claims
}

fn figures(runner: &Runner) -> Result<Vec<Figure>, RunError> {
    let mut curves = Vec::new();
    for (label, solver) in SOLVERS {
        let mut measured = Vec::new();
        for level in [level("1/4", 4.0), level("1/8", 8.0), LEVELS[0]] {
            let run = run(solver, level);
            if let (Resolution::Grid { cells, .. }, Ok(done)) = (level.resolution, runner.run(&run)) {
                measured.extend(error(&done).ok().map(|error| (1.0 / cells, error)));
            }
        }
        curves.push(Curve::new(label, Stroke::MarkedLine, measured));
    }
    curves.push(Curve::new("slope 2", Stroke::Dashed, vec![(1.0 / 16.0, 5e-3), (1.0 / 4.0, 8e-2)]));
    Ok(vec![Figure::graph(
        "convergence",
        "Error of the displacement against the cell",
        "Root mean square over the material points at t = .5 s, where the turn is largest.",
        [Axis::log("cell length h (m)"), Axis::log("rms error (m)")],
        curves,
    )])
}
