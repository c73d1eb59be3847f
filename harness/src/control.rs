//! Negative controls: wrong physics that a claim must refuse, and how it must turn red.

use crate::reading::Table;
use crate::run::{Change, Set};
use grainbench_scene::effect::Effect;
use grainbench_scene::scene::Scene;
use grainbench_scene::solver::{Defect, Resolution};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Wrong physics for a negative control.
#[derive(Clone)]
pub enum Wrong {
    /// The solver is given a wrong scene.
    Scene(Change),
    /// In a comparison with another program, our own solver is given a wrong scene.
    Ours(Change),
    /// The solver has a defect.
    Solver(Defect),
    /// Another solver takes its place.
    OtherSolver(&'static str),
    /// Another solver takes its place, at a resolution of its own.
    OtherRun(&'static str, Resolution),
    /// Another variant of the scene takes its place, whose run other claims read.
    OtherVariant(&'static str),
    /// What was read of snapshots is made wrong.
    Misread(fn(&mut [Table])),
}

/// How a row turns red under wrong physics.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Red {
    /// By its value, which is finite and outside what is allowed.
    Value,
    /// By breaking: wrong physics ends the run, or leaves nothing to read.
    Breaking,
}

impl Red {
    /// In a word.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Value => "value",
            Self::Breaking => "breaking",
        }
    }
}

/// A negative control: what is made wrong, in words and in deed.
#[derive(Clone)]
pub struct Control {
    /// What is wrong, such as `a sphere's inertia in a disc`.
    pub name: &'static str,
    /// How.
    pub wrong: Wrong,
    /// How the row must turn red.
    pub red: Red,
    /// The smallest set in which a run that is kept is done under it.
    pub set: Set,
}

impl Control {
    const fn new(name: &'static str, wrong: Wrong) -> Self {
        Self { name, wrong, red: Red::Value, set: Set::Main }
    }

    /// The control as one of which a run that is kept is done in the long set only.
    #[must_use]
    pub fn long(self) -> Self {
        Self { set: Set::Long, ..self }
    }

    /// What was read of the snapshots of a run is made wrong: elements given the stress of others, angles turned.
    #[must_use]
    pub const fn misread(name: &'static str, change: fn(&mut [Table])) -> Self {
        Self::new(name, Wrong::Misread(change))
    }

    /// A wrong scene.
    #[must_use]
    pub fn scene(name: &'static str, change: impl Fn(&mut Scene) + Send + Sync + 'static) -> Self {
        Self::new(name, Wrong::Scene(Arc::new(change)))
    }

    /// A scene without an effect that it calls for.
    #[must_use]
    pub fn without(effect: Effect) -> Self {
        Self::scene(effect.absence(), move |scene| effect.switch_off(scene))
    }

    /// A wrong scene for our own side of a comparison with another program.
    #[must_use]
    pub fn ours(name: &'static str, change: impl Fn(&mut Scene) + Send + Sync + 'static) -> Self {
        Self::new(name, Wrong::Ours(Arc::new(change)))
    }

    /// A solver whose contacts forget.
    #[must_use]
    pub const fn forgets_history() -> Self {
        Self::new("contacts forget their history", Wrong::Solver(Defect::ForgetsHistory))
    }

    /// Another solver.
    #[must_use]
    pub const fn solver(name: &'static str, solver: &'static str) -> Self {
        Self::new(name, Wrong::OtherSolver(solver))
    }

    /// Of a known error: a solver that does not have it, at a resolution of its own. The row must then pass.
    #[must_use]
    pub const fn without_the_error(name: &'static str, solver: &'static str, resolution: Resolution) -> Self {
        Self::run(name, solver, resolution)
    }

    /// Another variant of the scene.
    #[must_use]
    pub const fn variant(name: &'static str, variant: &'static str) -> Self {
        Self::new(name, Wrong::OtherVariant(variant))
    }

    /// Another solver, at a resolution of its own.
    #[must_use]
    pub const fn run(name: &'static str, solver: &'static str, resolution: Resolution) -> Self {
        Self::new(name, Wrong::OtherRun(solver, resolution))
    }
}
