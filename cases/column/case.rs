//! An elastic column under its own weight.

use crate::rows::elastic::stiffen;
use grainbench_harness::prelude::*;

const LEVELS: &[Level] = &[cells("H/12", 12.5, 2), cells("H/25", 25.0, 2), cells("H/50", 50.0, 2)];
const SOURCE: Source = Source::Derived("u_tt = c² u_yy − g on a fixed base (derivation)");

const DISPLACEMENT: ClaimFigure = ClaimFigure {
    name: "displacement",
    title: "Displacement of the centre of mass",
    caption: "Gravity acts at once on a column at rest. The exact displacement is a sequence of parabolas with the \
              period 4H/c = 10 s. H/12 to H/50 are cell lengths.",
    axes: ["time t (s)", "displacement (m)"],
    logarithmic: false,
};

pub(crate) static CASE: Case = crate::heads::COLUMN.with(LEVELS, 1, &claims);

/// Height (m), density (kg/m³), modulus (Pa) and gravity (m/s²).
struct Column {
    height: f64,
    density: f64,
    modulus: f64,
    gravity: f64,
}

impl Column {
    fn from_scene(scene: &Scene) -> Self {
        let body = &scene.bodies[0];
        let (low, high) = body.shape.corners();
        let modulus = scene.deformable[0].map_or(f64::NAN, |material| material.longitudinal_modulus());
        Self { height: high.y - low.y, density: body.density, modulus, gravity: -scene.gravity.y }
    }

    /// Returns the displacement of the centre of mass at rest, ρgH²/3E (m).
    fn sag(&self) -> f64 {
        self.density * self.gravity * self.height * self.height / (3.0 * self.modulus)
    }

    /// Returns the displacement of the centre of mass (m) at a time (s) after release.
    fn swing(&self, time: f64) -> f64 {
        let speed = (self.modulus / self.density).sqrt();
        let mode = |n: u32| {
            let wave = (2.0 * f64::from(n) - 1.0) * PI / (2.0 * self.height);
            let amplitude = -2.0 * self.gravity / (speed * speed * self.height * wave.powi(3));
            amplitude * (1.0 - (speed * wave * time).cos()) / (self.height * wave)
        };
        (1..=200).rev().map(mode).sum()
    }
}

fn softer() -> Control {
    Control::scene("two per cent softer", |scene| stiffen(scene, 0.98))
}

fn claims() -> Vec<Claim> {
    // From 25 to 50 cells, the allowed error decreases by more than the factor 4 of a second-order method. The claim at
    // 50 cells therefore does not apply to other solvers.
    let at_rest = || Run::new("static", "mpm", LEVELS[1].resolution);
    let stress = |probe: &'static str, share: f64| {
        claim(format!("vertical stress at rest, {share} of the height"), "Pa")
            .run(at_rest())
            .equals(Source::Derived("σ = −ρ g (H − y): the weight above"), move |done| {
                let column = Column::from_scene(&done[0].scene);
                let weight = column.density * column.gravity * column.height;
                let stress = done[0].last(&format!("{probe}.sigma_yy"))?;
                Ok(Measurement::new(stress, -weight * (1.0 - share), weight))
            })
            .within(estimated(4e-5, "remaining vibration, and strain of .0005; in units of ρ g H"))
            .refuses(Control::scene("gravity × .95", |scene| scene.gravity *= 0.95))
            .solver_independent_continuum()
    };
    vec![
        swinging(LEVELS[0], 0.037).solver_independent_continuum(),
        swinging(LEVELS[1], 9e-3).solver_independent_continuum(),
        swinging(LEVELS[2], 1.7e-3),
        claim("sinking of the centre of mass at rest", "m")
            .run(at_rest())
            .equals(SOURCE, |done| {
                let y = done[0].column("column.y")?;
                let exact = Column::from_scene(&done[0].scene).sag();
                Ok(Measurement::relative(y[0] - y[y.len() - 1], exact))
            })
            .within(estimated(2e-3, "strain of .0005, and discretisation"))
            .refuses(softer()),
        stress("quarter", 0.25),
        stress("middle", 0.5),
        claim("total energy over three periods, worst", "J")
            .run(Run::new("swinging", "mpm", LEVELS[1].resolution))
            .holds("conservation of energy", |done| {
                let energy = done[0].column("all.total_energy")?;
                let kinetic = done[0].column("all.kinetic_energy")?.iter().copied().fold(0.0, f64::max);
                Ok(Measurement::drift(&done[0].series().time, energy, kinetic))
            })
            .within(
                estimated(1e-3, "half a step between velocities and stresses; in units of the largest kinetic energy")
                    .up_to(3e-3),
            )
            .refuses(Control::scene("damping of a hundredth per second", |scene| scene.global_damping = 0.01))
            .solver_independent_continuum(),
    ]
}

fn swinging(level: Level, allowed: f64) -> Claim {
    claim(format!("displacement of the centre of mass over three periods, worst, {} cells", level.name), "m")
        .run(Run::new("swinging", "mpm", level.resolution))
        .follows(
            SOURCE,
            |done| from_start(done, "column.y"),
            |done, time| Column::from_scene(&done.scene).swing(time),
            |done| 2.0 * Column::from_scene(&done.scene).sag(),
        )
        .within(
            estimated(allowed, "dispersion of the grid, and the strain of .0005; in units of the largest displacement")
                .up_to(2.0 * allowed),
        )
        .refuses(softer())
        .drawn(&DISPLACEMENT, level.name)
}
