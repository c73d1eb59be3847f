//! Deliberate defects of solvers. Most change one quantity by a fraction of about 1e-9. A larger defect is used if a
//! property cannot detect a smaller one.

use crate::wrapper::{Start, Wrapped, Wrapper};
use grainbench_scene::dimension::Dimension;
use grainbench_scene::scene::Scene;
use grainbench_solver::Solver;
use grainbench_solver::failure::RunError;
use grainbench_solver::observer::Observer;
use grainbench_solver::record::Record;
use nalgebra::Vector3;
use std::sync::atomic::{AtomicU64, Ordering};

/// Size of a flaw, as a fraction of the velocities.
const SIZE: f64 = 1e-9;
/// Size of a larger flaw, as a fraction of velocities in free fall or of positions of material points. In free fall, the
/// velocity error may be gΔt/2 if a solver claims no order.
const LARGE: f64 = 1e-2;
/// Fraction by which a flaw reduces the rotation of walls, or of grains if no wall rotates.
const SLOWER: f64 = 0.05;

/// A deliberate defect of a solver.
///
/// `Pumped` and `FirstOrder` change the record, and `Restarted` changes the record after a restart. `SlowerWalls`
/// changes the motion of walls, or spins, and the material points of the record. All other flaws change the initial
/// velocities, which any solver can represent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flaw {
    /// All grains are slower by a fraction of 1e-9, as if by drag in a medium at rest.
    Drag,
    /// All grains are slower by a fraction of 1e-2.
    StrongDrag,
    /// Left and right differ. In two dimensions velocities are rotated slightly; in three they gain a component along the spin.
    Handed,
    /// The x axis differs from the other axes.
    Anisotropic,
    /// The first grain in the list is faster by a fraction of 1e-9.
    Listed,
    /// Walls rotate slower than prescribed, or grains if no wall rotates. Material points are displaced outwards.
    SlowerWalls,
    /// Velocities are too large in the middle of a run and correct at its ends. Forces on walls grow during the run.
    Pumped,
    /// The final state has an error of first order in the time step.
    FirstOrder,
    /// Every run differs from the previous run.
    Irreproducible,
    /// A run continued from a checkpoint differs slightly from the uninterrupted run.
    Restarted,
}

impl Flaw {
    /// Returns the flaw in words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Drag => "every velocity held back by a billionth",
            Self::StrongDrag => "every velocity held back by a hundredth",
            Self::Handed => "velocities turned to one side by a billionth",
            Self::Anisotropic => "velocities along x larger by a billionth",
            Self::Listed => "the first grain in the list faster by a billionth",
            Self::SlowerWalls => {
                "walls that turn slower by a twentieth, or bodies that turn slower and swell by a hundredth"
            }
            Self::Pumped => {
                "velocities that are a hundredfold in mid-run, and forces on walls that grow a hundredfold over a run"
            }
            Self::FirstOrder => "positions and velocities off by the first order in the step",
            Self::Irreproducible => "a velocity that differs by a rounding from run to run",
            Self::Restarted => "a velocity that differs by a rounding after a restart",
        }
    }

    fn spoil(self, scene: &mut Scene, run: u64) {
        let flat = scene.dimension == Dimension::Two;
        let turns = scene.walls.iter().any(|wall| wall.motion.is_moving());
        for grain in scene.grains.iter_mut() {
            match self {
                Self::Drag => grain.velocity *= 1.0 - SIZE,
                Self::StrongDrag => grain.velocity *= 1.0 - LARGE,
                Self::Handed if flat => grain.velocity += SIZE * Vector3::z().cross(&grain.velocity),
                Self::Handed => grain.velocity += SIZE * grain.radius * grain.spin,
                Self::Anisotropic => grain.velocity.x *= 1.0 + SIZE,
                Self::SlowerWalls if !turns => grain.spin *= 1.0 - SLOWER,
                _ => {}
            }
        }
        if self == Self::SlowerWalls {
            let phases = scene.walls.iter_mut().flat_map(|wall| &mut wall.motion.phases);
            phases.for_each(|phase| phase.spin *= 1.0 - SLOWER);
        }
        if let Some(grain) = scene.grains.first_mut() {
            match self {
                Self::Listed => grain.velocity *= 1.0 + SIZE,
                Self::Irreproducible => grain.velocity *= 1.0 + run as f64 * 4.0 * f64::EPSILON,
                _ => {}
            }
        }
    }
}

/// Displaces all material points outwards by the fraction [`LARGE`] of their positions.
fn swell(record: &mut Record) {
    for point in record.snapshots.iter_mut().flat_map(|snapshot| &mut snapshot.points) {
        point.displacement += point.position * LARGE;
        point.position *= 1.0 + LARGE;
    }
}

/// Largest relative growth of velocities and forces. It is large, so that the energy gain exceeds the dissipated energy.
const GROWTH: f64 = 99.0;

/// Multiplies velocities and spins by 100 in mid-run, and forces on walls by 100 at the end.
fn pump(record: &mut Record) {
    let end = record.snapshots.last().map_or(1.0, |last| last.time);
    for snapshot in &mut record.snapshots {
        // A check of only the final state does not detect this growth.
        let part = snapshot.time / end;
        let factor = 1.0 + GROWTH * 4.0 * part * (1.0 - part);
        for grain in &mut snapshot.grains {
            grain.velocity *= factor;
            grain.spin *= factor;
        }
    }
    let series = &mut record.series;
    for (column, values) in series.columns.iter().zip(&mut series.values) {
        if column.name.contains(".force_") {
            values.iter_mut().zip(&series.time).for_each(|(value, time)| *value *= 1.0 + GROWTH * time / end);
        }
    }
}

/// Solver with a flaw that a conformance property must detect.
pub struct FlawedSolver<'a> {
    solver: &'a dyn Solver,
    flaw: Flaw,
    runs: AtomicU64,
}

impl<'a> FlawedSolver<'a> {
    /// Adds a flaw to a solver.
    #[must_use]
    pub const fn new(solver: &'a dyn Solver, flaw: Flaw) -> Wrapped<Self> {
        Wrapped(Self { solver, flaw, runs: AtomicU64::new(0) })
    }

    /// Adds a flaw to a solver and starts its count of runs at 1000.
    ///
    /// No run then has the number of a run of [`FlawedSolver::new`].
    pub(super) const fn again(solver: &'a dyn Solver, flaw: Flaw) -> Wrapped<Self> {
        Wrapped(Self { solver, flaw, runs: AtomicU64::new(1000) })
    }
}

impl Wrapper for FlawedSolver<'_> {
    fn inner(&self) -> &dyn Solver {
        self.solver
    }

    fn run(&self, start: Start<'_>, observer: &mut dyn Observer) -> Result<Record, RunError> {
        if start.from.is_some() {
            let mut record = start.run(self.solver, observer)?;
            if self.flaw == Flaw::Restarted
                && let Some(grain) = record.snapshots.last_mut().and_then(|last| last.grains.first_mut())
            {
                grain.velocity *= 1.0 + 4.0 * f64::EPSILON;
            }
            return Ok(record);
        }
        let mut scene = start.scene.clone();
        self.flaw.spoil(&mut scene, self.runs.fetch_add(1, Ordering::Relaxed));
        let mut record = self.solver.run(&scene, start.resolution, observer)?;
        if self.flaw == Flaw::FirstOrder
            && let Some(last) = record.snapshots.last_mut()
        {
            let share = record.provenance.time_step / last.time;
            // Positions are changed too, because a velocity may be zero at the end.
            last.grains.iter_mut().for_each(|grain| {
                grain.position *= 1.0 + share;
                grain.velocity *= 1.0 + share;
            });
        }
        match self.flaw {
            Flaw::Pumped => pump(&mut record),
            Flaw::SlowerWalls => swell(&mut record),
            _ => {}
        }
        Ok(record)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use grainbench_solver::resolution::Resolution;

    /// A solver that rejects every scene.
    pub(crate) struct RefusingSolver;

    impl Solver for RefusingSolver {
        fn name(&self) -> String {
            "refuses".to_owned()
        }

        fn run(&self, _: &Scene, _: &Resolution, _: &mut dyn Observer) -> Result<Record, RunError> {
            Err(RunError::Unsupported { solver: self.name(), reason: "everything".to_owned() })
        }
    }

    #[test]
    fn a_solver_that_refused_scenes_is_not_caught_up_with_by_one_that_ran_before() {
        let [first, again] = [
            FlawedSolver::new(&RefusingSolver, Flaw::Irreproducible),
            FlawedSolver::again(&RefusingSolver, Flaw::Irreproducible),
        ];
        for named in super::super::scenes::collisions().into_iter().flatten() {
            let _ = first.run(&named.scene, &Resolution::CriticalFraction(0.1), &mut ());
            assert_ne!(first.0.runs.load(Ordering::Relaxed), again.0.runs.load(Ordering::Relaxed));
        }
    }
}
