//! Negative controls: wrong physics under which a claim must fail, by value or by error.

use crate::reading::Table;
use crate::run::{Change, Set};
use grainbench_scene::contact_law::ContactLaw;
use grainbench_scene::effect::Effect;
use grainbench_scene::scene::{Grain, Scene};
use grainbench_solver::Defect;
use grainbench_solver::resolution::Resolution;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Wrong physics of a negative control.
#[derive(Clone)]
pub enum WrongPhysics {
    /// The solver gets a wrong scene.
    Scene(Change),
    /// In a comparison with another program, only our solver gets a wrong scene. The program runs the right scene.
    Ours(Change),
    /// The solver has a defect.
    Solver(Defect),
    /// Another solver performs the run.
    OtherSolver(&'static str),
    /// Another solver performs the run, at another resolution.
    OtherRun(&'static str, Resolution),
    /// Another variant of the scene is run.
    OtherVariant(&'static str),
    /// The tables read from the snapshots are changed.
    Misread(fn(&mut [Table])),
}

/// Way in which a claim fails under wrong physics.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FailureMode {
    /// By value: the value is finite and outside the tolerance.
    Value,
    /// By error: wrong physics ends the run with an error, or the quantity cannot be measured.
    Breaking,
}

impl FailureMode {
    /// Returns the name of the failure mode in result files.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Value => "value",
            Self::Breaking => "breaking",
        }
    }
}

/// A negative control: a name and the wrong physics.
#[derive(Clone)]
#[must_use]
pub struct Control {
    /// Description of the wrong physics, such as `a sphere's inertia in a disc`.
    pub name: &'static str,
    /// Change of the scene, the solver or the tables.
    pub wrong: WrongPhysics,
    /// Way in which the claim must fail.
    pub red: FailureMode,
    /// Smallest tier in which a stored run is repeated under this control.
    pub set: Set,
    /// Resolution of the run with wrong physics; none for the resolution of the claim.
    pub resolution: Option<Resolution>,
}

impl Control {
    const fn new(name: &'static str, wrong: WrongPhysics) -> Self {
        Self { name, wrong, red: FailureMode::Value, set: Set::Main, resolution: None }
    }

    /// Repeats stored runs under this control only in the long tier.
    pub fn long(self) -> Self {
        Self { set: Set::Long, ..self }
    }

    /// Runs the wrong physics at a coarser resolution, which costs less. The tolerance of the claim still applies. At
    /// this resolution the right physics must pass, or have less than half the error of the wrong physics.
    pub fn coarser(self, resolution: Resolution) -> Self {
        Self { resolution: Some(resolution), ..self }
    }

    /// Returns a control that changes the tables read from the snapshots, such as swapped stresses or rotated angles.
    pub const fn misread(name: &'static str, change: fn(&mut [Table])) -> Self {
        Self::new(name, WrongPhysics::Misread(change))
    }

    /// Returns a control with a wrong scene.
    pub fn scene(name: &'static str, change: impl Fn(&mut Scene) + Send + Sync + 'static) -> Self {
        Self::new(name, WrongPhysics::Scene(Arc::new(change)))
    }

    /// Returns a control with wrong contact laws.
    pub fn contact_law(name: &'static str, change: impl Fn(&mut ContactLaw) + Send + Sync + 'static) -> Self {
        Self::scene(name, move |scene| scene.change_laws(&change))
    }

    /// Returns a control with wrong grains.
    pub fn grains(name: &'static str, change: impl Fn(&mut Grain) + Send + Sync + 'static) -> Self {
        Self::scene(name, move |scene| scene.grains.iter_mut().for_each(&change))
    }

    /// Returns a control that switches off an effect of the scene.
    pub fn without(effect: Effect) -> Self {
        Self::scene(effect.absence(), move |scene| effect.switch_off(scene))
    }

    /// Returns a control for a comparison with another program: only our solver gets a wrong scene.
    pub fn ours(name: &'static str, change: impl Fn(&mut Scene) + Send + Sync + 'static) -> Self {
        Self::new(name, WrongPhysics::Ours(Arc::new(change)))
    }

    /// Returns a control for a comparison with another program: only our solver gets wrong contact laws.
    pub fn our_contact_law(name: &'static str, change: impl Fn(&mut ContactLaw) + Send + Sync + 'static) -> Self {
        Self::ours(name, move |scene| scene.change_laws(&change))
    }

    /// Returns a control with a solver whose contacts lose their history.
    pub const fn forgets_history() -> Self {
        Self::new("contacts forget their history", WrongPhysics::Solver(Defect::ForgetsHistory))
    }

    /// Returns a control in which the solver with the name `solver` does the runs.
    pub const fn solver(name: &'static str, solver: &'static str) -> Self {
        Self::new(name, WrongPhysics::OtherSolver(solver))
    }

    /// Returns the control of a known error: a solver without this error, with which the claim must pass.
    pub const fn without_the_error(name: &'static str, solver: &'static str, resolution: Resolution) -> Self {
        Self::run(name, solver, resolution)
    }

    /// Returns a control that runs another variant of the scene.
    pub const fn variant(name: &'static str, variant: &'static str) -> Self {
        Self::new(name, WrongPhysics::OtherVariant(variant))
    }

    /// Returns a control in which the solver with the name `solver` does the runs at another resolution.
    pub const fn run(name: &'static str, solver: &'static str, resolution: Resolution) -> Self {
        Self::new(name, WrongPhysics::OtherRun(solver, resolution))
    }
}
