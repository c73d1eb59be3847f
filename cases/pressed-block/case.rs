//! Compression of a plastic block between smooth sides.

use grainbench_harness::prelude::*;

/// Resolution of the negative controls.
const COARSE: Resolution = Resolution::grid(4.0, 2);
const LEVELS: &[Level] = &[cells("L/8", 8.0, 2), cells("L/16", 16.0, 2)];

/// Bulk modulus of the scene (Pa). The tolerances need this and the next values before a scene exists.
const BULK: f64 = 80.0;
/// Shear modulus (Pa).
const SHEAR: f64 = 40.0;
/// Yield stress (Pa).
const YIELD: f64 = 0.4;
/// Hardening modulus (Pa).
const HARDENING: f64 = 8.0;
/// Density (kg/m³).
const DENSITY: f64 = 1.0;
/// Speed of the ram (m/s).
const SPEED: f64 = 0.001;
/// Duration of the run (s).
const TIME: f64 = 20.0;

pub(crate) static CASE: Case = crate::heads::PRESSED_BLOCK.with(LEVELS, 0, &claims);

/// Means over the points in the middle half of the block at the end. All points have the same mass.
#[derive(Default)]
struct MiddleMeans {
    /// True strain e = −ln(V/V₀).
    strain: f64,
    /// Equivalent plastic strain.
    plastic: f64,
    /// Stresses along x, y and z (Pa).
    stress: [f64; 3],
}

impl MiddleMeans {
    fn from_run(done: &FinishedRun) -> Result<Self, MissingData> {
        let missing = || MissingData("points in the middle of the block in the end".to_owned());
        let snapshot = done.record.snapshots.last().ok_or_else(missing)?;
        // All points of the block, 1 m², have the same initial volume.
        let start = 1.0 / snapshot.points.len() as f64;
        let is_inner = |x: f64| (x - 0.5).abs() < 0.25;
        let inner = snapshot.points.iter().filter(|point| is_inner(point.position.x) && is_inner(point.position.y));
        let (mut sum, mut count) = (Self::default(), 0.0);
        for point in inner {
            count += 1.0;
            sum.strain -= (point.volume / start).ln();
            sum.plastic += point.plastic_strain;
            (0..3).for_each(|axis| sum.stress[axis] += point.stress[axis]);
        }
        if count == 0.0 {
            return Err(missing());
        }
        Ok(Self { strain: sum.strain / count, plastic: sum.plastic / count, stress: sum.stress.map(|sum| sum / count) })
    }

    /// Returns the exact plastic strain ε_p = (2G e − Y)/(3G + H).
    fn flowed(&self) -> f64 {
        (2.0 * SHEAR * self.strain - YIELD) / (3.0 * SHEAR + HARDENING)
    }

    /// Returns the flow stress Y + H ε_p for the measured plastic strain (Pa).
    fn yielded(&self) -> f64 {
        YIELD + HARDENING * self.plastic
    }
}

/// Returns a change of the block's material.
fn material(change: impl Fn(&mut Deformable) + Send + Sync + 'static) -> impl Fn(&mut Scene) + Send + Sync + 'static {
    move |scene| scene.deformable.iter_mut().flatten().for_each(&change)
}

/// Returns a change of yield stress and hardening modulus (Pa).
fn metal(yield_stress: f64, hardening_modulus: f64) -> impl Fn(&mut Scene) + Send + Sync + 'static {
    material(move |deformable| deformable.constitutive = Constitutive::VonMises { yield_stress, hardening_modulus })
}

fn claims() -> Vec<Claim> {
    let sound = ((BULK + 4.0 / 3.0 * SHEAR) / DENSITY).sqrt();
    let front = SPEED / sound;
    let run = || Run::new(PLAIN, "mpm", LEVELS[0].resolution);
    let mut claims = LEVELS.iter().map(follows_the_ram).collect::<Vec<_>>();
    claims.extend([
        claim("equivalent plastic strain of the middle", "1")
            .run(run())
            .equals(
                Source::Derived("ε_p = (2G e − Y)/(3G + H), e from the volumes of the block (derivation)"),
                |done| {
                    let middle = MiddleMeans::from_run(&done[0])?;
                    Ok(Measurement::relative(middle.plastic, middle.flowed()))
                },
            )
            .within(computed(
                front * 2.0 * SHEAR / (3.0 * SHEAR + HARDENING) / 0.0095,
                "front of the strain V/c relative to the strain of the flow: V/c · 2G/(3G + H) of .0095",
            ))
            .refuses(
                Control::scene("a yield stress a twentieth higher", metal(1.05 * YIELD, HARDENING)).coarser(COARSE),
            ),
        claim("yield stress of the middle", "Pa")
            .run(run())
            .equals(Source::Derived("σ_xx − σ_yy = Y + H ε_p (derivation)"), |done| {
                let middle = MiddleMeans::from_run(&done[0])?;
                let [across, along, _] = middle.stress;
                Ok(Measurement::relative(across - along, middle.yielded()))
            })
            .within(computed(
                2.0 * SHEAR * front / 0.476,
                "front of the strain V/c relative to the strain of the flow: 2G V/c of .476 Pa",
            ))
            .refuses(Control::scene("no hardening", metal(YIELD, 0.0)).coarser(COARSE)),
        claim("pressure of the middle", "Pa")
            .run(run())
            .equals(
                Source::Derived(
                    "(σ_xx + σ_yy + σ_zz)/3 = −K e, e from the volumes of the block, which flow conserves (derivation)",
                ),
                |done| {
                    let middle = MiddleMeans::from_run(&done[0])?;
                    let expected = BULK * middle.strain;
                    Ok(Measurement::relative(-middle.stress.iter().sum::<f64>() / 3.0, expected))
                },
            )
            .within(rounding(
                1.0 / 0.0202,
                "each step rounds the volume, in units of the strain .0202; the midpoint rule has the error (e/N)²/12 \
                 in N steps, at most a thirtieth of the rounding error (derivation)",
            ))
            .refuses(
                Control::scene(
                    "a thousandth stiffer in volume",
                    material(|deformable| deformable.bulk_modulus *= 1.001),
                )
                .coarser(COARSE),
            ),
        claim("force on the ram", "N")
            .run(run())
            .equals(
                Source::Derived(
                    "F = K e + ⅔ (Y + H ε_p), ε_p = (2G e − Y)/(3G + H), e from the volumes of the block (derivation)",
                ),
                |done| {
                    let middle = MiddleMeans::from_run(&done[0])?;
                    let yielded = YIELD + HARDENING * middle.flowed();
                    let expected = BULK * middle.strain + 2.0 / 3.0 * yielded;
                    Ok(Measurement::relative(done[0].last("ram.force_y")?, expected))
                },
            )
            .within(computed(DENSITY * sound * SPEED / 1.934, "stress ρcV of a front, relative to 1.934 Pa on 1 m"))
            .refuses(
                Control::scene(
                    "two per cent stiffer in volume",
                    material(|deformable| deformable.bulk_modulus *= 1.02),
                )
                .coarser(COARSE),
            ),
    ]);
    claims
}

fn follows_the_ram(level: &Level) -> Claim {
    const LAG: &str = "the contact springs at the face are compressed, and its tracers sink into the block when the \
                       face has moved a quarter of a cell from its initial nodes: by 0.008 of a cell with eight cells, \
                       and by 0.05 with sixteen";
    let run = Run::new(PLAIN, "mpm", level.resolution).known(LAG).up_to(0.2);
    claim(format!("strain of the middle over the way of the ram, {} cells", level.name), "1")
        .run(if *level == LEVELS[0] { run } else { run.slow() })
        .equals(
            Source::Derived("e = −ln(1 − V t/L): the height of the block is the position of the ram (derivation)"),
            |done| Ok(Measurement::relative(MiddleMeans::from_run(&done[0])?.strain, -(1.0 - SPEED * TIME).ln())),
        )
        .within(judged(
            0.03,
            "springs with a quarter of our compliance shorten by F/κ, 2e-4 of 2e-2, and tracers penetrate by the same \
             amount",
        ))
        .refuses(Control::without_the_error("springs four times as stiff", STIFF, LEVELS[0].resolution))
}

/// Solver with springs between surfaces that are four times as stiff.
const STIFF: &str = "mpm+penalty=10.4";
