//! Discrete element method as a solver. It selects the compiled loops over contacts before the first step, runs the
//! simulation and produces the record.

use crate::contact::normal::{Hertz, HertzDashpot, Normal, Spring, SpringDashpot};
use crate::contact::options::Options;
use crate::contact::rolling::{ElasticPlastic, FreeRolling};
use crate::contact::tangential::{Coulomb, Frictionless, Projected, Tangential, Turned};
use crate::convention::{Convention, History, VelocityNormal};
use crate::end_state::words;
use crate::forces::{Chain, Forces};
use crate::geometry::Geometry;
use crate::share::FEWEST;
use crate::simulation::DemSimulation;
use crate::stability::damped_step;
use grainbench_lanes::Team;
use grainbench_scene::contact_law::SpringsKind;
use grainbench_scene::dimension::Dimension;
use grainbench_scene::effects::Effects;
use grainbench_scene::scene::Scene;
use grainbench_solver::checkpoint::Checkpoint;
use grainbench_solver::drive::{Course, Stepper};
use grainbench_solver::failure::RunError;
use grainbench_solver::observer::{Observer, RunOptions};
use grainbench_solver::record::{Provenance, Record};
use grainbench_solver::resolution::Resolution;
use grainbench_solver::space::{Plane, Solid};
use grainbench_solver::terms::{Limitation, Terms};
use grainbench_solver::{Defect, Solver};
use std::marker::PhantomData;

/// Discrete element method with one contact convention.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dem {
    /// Contact convention, such as the force to which the Coulomb limit applies.
    pub convention: Convention,
    /// Defect, for negative controls only.
    pub defect: Option<Defect>,
}

/// Reason for limitations: velocities are decomposed along the normal at the end of a step.
const END_OF_STEP: &str = "velocities are decomposed along the normal at the end of the step, and a wall that turns has the \
                           velocity of its place there: first order in ΩΔt";

/// Limitations of the method of Cundall & Strack (1979) as published.
const OF_1979: &[Limitation] = &[
    Limitation::new("objectivity", "place off in the end", 2e-3, END_OF_STEP),
    Limitation::new("order", "order in the time step of the end", 1.0, END_OF_STEP),
];

/// Reason for limitations: LAMMPS and LIGGGHTS use the spin of the grain for rolling resistance at walls.
const OWN_SPIN: &str = "rolling resistance at a wall uses the spin of the grain and not the spin relative to the wall, \
                        in LAMMPS and in LIGGGHTS: a rotating wall drives the grain";

/// Limitations of the conventions of LAMMPS and LIGGGHTS.
const OF_PROGRAMS: &[Limitation] = &[
    Limitation::new(
        "objectivity",
        "place off in the end, under twist",
        5e-3,
        "the tangential spring is projected on the tangent plane and does not follow a rotation of the contact about its \
         normal",
    ),
    Limitation::new("objectivity", "place off in the end", 0.05, OWN_SPIN),
    Limitation::new("objectivity", "spin × radius off in the end", 0.25, OWN_SPIN),
    Limitation::new("order", "order in the time step of the end", 1.0, END_OF_STEP),
    Limitation::new(
        "passivity",
        "work gained",
        0.35,
        "the tangential force is the present stiffness times the whole displacement: a contact that is compressed under \
         shear gains energy as its stiffness grows, here 1 − 1/√2 of the energy of the spring",
    ),
];

impl Dem {
    /// Conformance properties of the default convention.
    pub const TERMS: Terms = Terms::SECOND_ORDER;

    /// Returns the conformance properties of the convention.
    #[must_use]
    pub const fn terms(&self) -> Terms {
        match (self.convention.history, self.convention.velocity_normal) {
            (History::Turned, VelocityNormal::MidStep) => Self::TERMS,
            (History::Turned, VelocityNormal::EndOfStep) => Self::TERMS.owing_less(OF_1979),
            (History::Projected, _) => Self::TERMS.owing_less(OF_PROGRAMS),
        }
    }

    /// Creates the solver with a convention, without a defect.
    #[must_use]
    pub const fn new(convention: Convention) -> Self {
        Self { convention, defect: None }
    }

    /// Returns the solver with a defect, for negative controls.
    #[must_use]
    pub const fn with_defect(self, defect: Defect) -> Self {
        Self { defect: Some(defect), ..self }
    }

    /// Sets up the simulation of a scene with a time step (s), for callers that advance it themselves.
    ///
    /// # Errors
    /// When the scene is not supported or its initial state is not valid.
    pub fn start(&self, scene: &Scene, time_step: f64) -> Result<Box<dyn Stepper>, RunError> {
        self.start_on(scene, time_step, RunOptions::DEFAULT)
    }

    /// Sets up the simulation of a scene with a time step (s) and the options of its run. Individual contacts are recorded
    /// only if there are at most `most_rows` grains and contacts together.
    fn start_on(&self, scene: &Scene, time_step: f64, options: RunOptions) -> Result<Box<dyn Stepper>, RunError> {
        self.refuse(scene)?;
        match scene.dimension {
            Dimension::Two => self.start_with::<Plane>(scene, time_step, options),
            Dimension::Three => self.start_with::<Solid>(scene, time_step, options),
        }
    }

    fn start_with<S: Geometry>(
        &self,
        scene: &Scene,
        time_step: f64,
        RunOptions { threads, most_rows, allow_unstable, .. }: RunOptions,
    ) -> Result<Box<dyn Stepper>, RunError> {
        let forces = loops::<S>(scene, &self.convention);
        let own = words(forces.springs());
        if let Some(springs) = scene.springs.as_ref().filter(|springs| springs.layout != own) {
            let reason = format!(
                "its contacts begin with springs of another law or convention, {} instead of {own} (`springs = false` \
                 next to the state omits them)",
                springs.layout
            );
            return Err(self.unsupported(reason));
        }
        let team = (Team::new(threads.min(scene.grains.len() / FEWEST)), most_rows);
        let mut simulated =
            DemSimulation::new(scene, forces, Options::from_convention(&self.convention), time_step, team)?;
        simulated.critical.follow_contacts(scene, time_step, allow_unstable);
        simulated.defect = self.defect;
        Ok(Box::new(simulated))
    }

    /// Rejects a scene with deformable bodies, with an energy budget that cannot be computed, or with a contact law
    /// without stiffness.
    fn refuse(&self, scene: &Scene) -> Result<(), RunError> {
        if let Some(what) = scene.needs_deformable() {
            return Err(self.unsupported(format!("it has {what}, but the grains of this solver are rigid")));
        }
        if let Some(reason) = crate::accounts::reason(scene).filter(|_| scene.asks_for_budget()) {
            return Err(self.unsupported(reason));
        }
        if scene.laws.iter().flatten().any(|law| !law.has_stiffness()) {
            return Err(self.unsupported("a contact law has friction and no stiffness".to_owned()));
        }
        Ok(())
    }

    /// Rejects a time step (s) at which springs are stable but dashpots are not. In this case, a dashpot near or above
    /// critical damping supplies energy, and the run shows no other sign of failure.
    fn refuse_lagging_dashpots(&self, scene: &Scene, time_step: f64) -> Result<(), RunError> {
        let (damped, undamped) = damped_step(scene, &self.convention);
        if time_step > damped && time_step <= undamped {
            return Err(self.resolution_error(format!(
                "expected a time step of at most {damped:.4e} s, at which the dashpot of a contact is stable, found \
                 {time_step:.4e} s"
            )));
        }
        Ok(())
    }
}

impl Solver for Dem {
    fn name(&self) -> String {
        self.convention.name.to_owned()
    }

    fn run(&self, scene: &Scene, resolution: &Resolution, observer: &mut dyn Observer) -> Result<Record, RunError> {
        self.run_from(scene, resolution, None, observer)
    }

    fn run_from(
        &self,
        scene: &Scene,
        resolution: &Resolution,
        from: Option<&Checkpoint>,
        observer: &mut dyn Observer,
    ) -> Result<Record, RunError> {
        self.refuse(scene)?;
        let (time_step, steps) = resolution.steps(scene).map_err(|reason| self.resolution_error(reason))?;
        self.refuse_lagging_dashpots(scene, time_step)?;
        let mut simulation = self.start_on(scene, time_step, observer.options())?;
        let provenance = Provenance::new(scene, self.name(), resolution, time_step, self.convention.words());
        let solver = format!("{} ({})", self.name(), self.convention.words().join(", "));
        let course = Course { solver, scene, steps, from, between_progress: STEPS_BETWEEN_PROGRESS, provenance };
        course.drive(&mut *simulation, observer)
    }
}

/// Returns the loops over contacts for the effects of a scene and a convention.
pub(crate) fn loops<S: Geometry>(scene: &Scene, convention: &Convention) -> Box<dyn Forces<S>> {
    match convention.history {
        History::Turned => chain::<S, Coulomb<Turned>>(scene),
        History::Projected => chain::<S, Coulomb<Projected>>(scene),
    }
}

/// Returns the loops over contacts for the effects of a scene. `T` is the tangential stage if the scene has friction.
fn chain<S: Geometry, T: Tangential<S>>(scene: &Scene) -> Box<dyn Forces<S>> {
    let effects = Effects::from_scene(scene);
    // All laws of a scene that have springs are of one kind.
    let kinds = scene.laws.iter().flatten().map(|law| law.springs.kind());
    let kind = kinds.fold(SpringsKind::Coulomb, |found, kind| if found == SpringsKind::Coulomb { kind } else { found });
    match (kind, effects.contact_damping) {
        (SpringsKind::Coulomb | SpringsKind::Linear, false) => after::<S, Spring, T>(effects),
        (SpringsKind::Coulomb | SpringsKind::Linear, true) => after::<S, SpringDashpot, T>(effects),
        (SpringsKind::HertzMindlin, false) => after::<S, Hertz, T>(effects),
        (SpringsKind::HertzMindlin, true) => after::<S, HertzDashpot, T>(effects),
    }
}

/// Returns the loops over contacts with normal stage `N` and the tangential and rolling stages that the effects need.
fn after<S: Geometry, N: Normal, T: Tangential<S>>(effects: Effects) -> Box<dyn Forces<S>> {
    match (effects.friction, effects.rolling_resistance) {
        (false, _) => Box::new(Chain::<S, N, Frictionless, FreeRolling>(PhantomData)),
        (true, false) => Box::new(Chain::<S, N, T, FreeRolling>(PhantomData)),
        (true, true) => Box::new(Chain::<S, N, T, ElasticPlastic>(PhantomData)),
    }
}

/// Largest number of steps between two progress reports.
const STEPS_BETWEEN_PROGRESS: u64 = 20_000;
