//! Resolution levels of a solver for any scene, from coarse to fine.

use grainbench_harness::solvers::{ExternalSolver, Solvers};
use grainbench_scene::contact_law::SpringsKind;
use grainbench_scene::method::Method;
use grainbench_scene::scene::{Duration, Scene};
use grainbench_solver::resolution::Resolution;

/// Time step of the coarsest level, as a fraction of the critical one.
const COARSEST: f64 = 0.4;
/// Number of steps of the coarsest level, for scenes without a critical time step.
const STEPS: f64 = 50.0;
/// Cells per reference length of the coarsest level.
const CELLS: f64 = 2.0;
/// Solvers of a study if the user names none.
pub const DEFAULT: [&str; 3] = ["dem", "rigid", "mpm"];

/// Resolution that a solver refines.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Refined {
    /// Time step as a fraction of the critical one.
    Fraction(f64),
    /// Time step (s).
    Step(f64),
    /// Substeps of a rigid-body engine.
    Substeps,
    /// Cells per reference length.
    Cells(f64),
}

/// Resolution levels of a solver.
#[derive(Clone, Debug, PartialEq)]
pub struct Ladder {
    refined: Refined,
    /// Finenesses to which an external solver is limited; empty if there is no limit.
    pub listed: Vec<f64>,
    dimensions: usize,
}

/// Ends of the names of columns that contain the energy of springs.
const ELASTIC: [&str; 3] = [".elastic_energy", ".elastic", ".springs"];

impl Ladder {
    /// Returns true if the method does not have the quantity of a column: the contacts of a rigid-body engine have no springs.
    pub(super) fn lacks(&self, column: &str) -> bool {
        self.is_rigid() && ELASTIC.iter().any(|end| column.ends_with(end))
    }

    /// Returns the levels of a solver for a scene. A scene without contacts has no critical time step, so that its levels
    /// have time steps in seconds.
    #[must_use]
    pub fn new(solver: &str, scene: &Scene, solvers: &dyn Solvers) -> Self {
        let external = solvers.external_solvers().into_iter().find(|external| external.name == solver);
        let method = external.as_ref().map_or_else(|| Method::from_name(solver), |_| None);
        let time_step = || match scene.duration {
            Duration::Seconds(seconds) if !scene.critical_time_step().is_finite() => Refined::Step(seconds / STEPS),
            _ => Refined::Fraction(COARSEST),
        };
        let (refined, listed) = match (&external, method) {
            (Some(ExternalSolver { deforms: true, cells, .. }), _) => listed(Refined::Cells(CELLS), cells, false),
            (Some(external), _) => listed(time_step(), &external.fractions, true),
            (None, Some(Method::Rigid)) => (Refined::Substeps, Vec::new()),
            (None, Some(Method::Grid)) => (Refined::Cells(CELLS), Vec::new()),
            (None, _) => (time_step(), Vec::new()),
        };
        Self { refined, listed, dimensions: scene.dimension.count() }
    }

    /// Returns the resolution of a fineness; 1 is the coarsest level.
    #[must_use]
    pub fn at(&self, fineness: f64) -> Resolution {
        match self.refined {
            Refined::Fraction(coarsest) => Resolution::CriticalFraction(coarsest / fineness),
            Refined::Step(coarsest) => Resolution::TimeStep(coarsest / fineness),
            Refined::Substeps => Resolution::substeps(fineness.round() as u32),
            Refined::Cells(coarsest) => Resolution::grid(coarsest * fineness, Resolution::POINTS),
        }
    }

    /// Returns the nominal exponent of the run time: time ∝ finenessⁿ. Cells change the number of points and the time step.
    #[must_use]
    pub fn exponent(&self) -> f64 {
        match self.refined {
            Refined::Cells(_) => self.dimensions as f64 + 1.0,
            _ => 1.0,
        }
    }

    /// Returns the order of the method for smooth motion.
    #[must_use]
    pub fn order(&self) -> f64 {
        if self.is_rigid() { 1.0 } else { 2.0 }
    }

    /// Returns true if the levels have cells.
    #[must_use]
    pub const fn has_cells(&self) -> bool {
        matches!(self.refined, Refined::Cells(_))
    }

    /// Returns true if the levels have substeps of a rigid-body engine.
    pub(super) const fn is_rigid(&self) -> bool {
        matches!(self.refined, Refined::Substeps)
    }

    /// Returns the size of a level: of a time step or a cell, relative to the coarsest level. The number of steps of a run
    /// gives it exactly, because the step is shortened to a whole number of steps.
    #[must_use]
    pub fn size(&self, fineness: f64, steps: u64) -> f64 {
        if !self.has_cells() && !self.is_rigid() && steps > 0 { 1.0 / steps as f64 } else { 1.0 / fineness }
    }
}

/// Returns a ladder whose values are limited to `values`, and its finenesses.
fn listed(refined: Refined, values: &[f64], are_steps: bool) -> (Refined, Vec<f64>) {
    let coarsest = values.iter().copied().reduce(if are_steps { f64::max } else { f64::min });
    let Some(coarsest) = coarsest else { return (refined, Vec::new()) };
    let mut finenesses: Vec<f64> =
        values.iter().map(|value| if are_steps { coarsest / value } else { value / coarsest }).collect();
    finenesses.sort_by(f64::total_cmp);
    finenesses.dedup();
    match refined {
        Refined::Cells(_) => (Refined::Cells(coarsest), finenesses),
        Refined::Fraction(_) => (Refined::Fraction(coarsest), finenesses),
        // A time step in seconds replaces the fractions of a critical step that does not exist.
        other => (other, finenesses),
    }
}

/// Divides the stiffness of all contacts by a factor. Dashpots that are not relative to the stiffness change so that the
/// coefficient of restitution stays.
///
/// The duration of a contact with mass m and impact speed v is proportional to √(m/k) for linear springs, and to
/// (m²/(E*² R v))^{1/5} for Hertz contacts. The damping rates c/m are divided by the factor of the duration.
pub(super) fn soften(scene: &mut Scene, factor: f64) {
    scene.change_laws(|law| {
        let longer = if law.springs.kind() == SpringsKind::Linear { factor.sqrt() } else { factor.powf(0.4) };
        law.springs = law.springs.scaled([1.0 / factor; 2]);
        law.normal_damping /= longer;
        law.tangential_damping /= longer;
        law.stiffness_damping *= longer;
    });
}
