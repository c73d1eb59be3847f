//! Discrete element method as a solver. It selects the compiled loops over contacts before the first step, runs the
//! simulation and produces the record.

use crate::contact::normal::{Hertz, HertzDashpot, Normal, Spring, SpringDashpot};
use crate::contact::options::Options;
use crate::contact::rolling::{ElasticPlastic, FreeRolling};
use crate::contact::tangential::{Coulomb, Frictionless, Projected, Tangential, Turned};
use crate::convention::{Convention, History, VelocityNormal};
use crate::edge::Simulation;
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
use grainbench_scene::end_state::EndState;
use grainbench_scene::scene::Scene;
use grainbench_solver::brief::Brief;
use grainbench_solver::checkpoint::{Checkpoint, CheckpointError, Run};
use grainbench_solver::drive::{Course, LoopOutput, Stepper};
use grainbench_solver::failure::RunError;
use grainbench_solver::observer::{Observer, RunOptions};
use grainbench_solver::record::{Counts, Provenance, Record, StepState};
use grainbench_solver::recorder::Recorder;
use grainbench_solver::resolution::Resolution;
use grainbench_solver::space::{Plane, Solid};
use grainbench_solver::terms::{Limitation, Terms};
use grainbench_solver::{Defect, Solver};

/// Discrete element method with one contact convention.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dem {
    /// Contact convention, such as the force to which the Coulomb limit applies.
    pub convention: Convention,
    /// Defect, for negative controls only.
    pub defect: Option<Defect>,
    /// True if a run continues although its time step exceeds the critical time step of a contact.
    pub allow_unstable: bool,
}

/// Reason for limitations: velocities are decomposed along the normal at the end of a step.
const END_OF_STEP: &str = "velocities are decomposed along the normal at the end of the step, and a wall that turns has the \
                           velocity of its place there: first order in ΩΔt";

/// Limitations of the method of Cundall & Strack (1979) as published.
const OF_1979: &[Limitation] = &[
    Limitation { property: "objectivity", quantity: "place off in the end", at_most: 2e-3, because: END_OF_STEP },
    Limitation { property: "order", quantity: "order in the time step of the end", at_most: 1.0, because: END_OF_STEP },
];

/// Reason for limitations: LAMMPS and LIGGGHTS use the spin of the grain for rolling resistance at walls.
const OWN_SPIN: &str = "rolling resistance at a wall uses the spin of the grain and not the spin relative to the wall, \
                        in LAMMPS and in LIGGGHTS: a rotating wall drives the grain";

/// Limitations of the conventions of LAMMPS and LIGGGHTS.
const OF_PROGRAMS: &[Limitation] = &[
    Limitation {
        property: "objectivity",
        quantity: "place off in the end, under twist",
        at_most: 5e-3,
        because: "the tangential spring is projected on the tangent plane and does not follow a rotation of the \
                  contact about its normal",
    },
    Limitation { property: "objectivity", quantity: "place off in the end", at_most: 0.05, because: OWN_SPIN },
    Limitation { property: "objectivity", quantity: "spin × radius off in the end", at_most: 0.25, because: OWN_SPIN },
    Limitation { property: "order", quantity: "order in the time step of the end", at_most: 1.0, because: END_OF_STEP },
    Limitation {
        property: "passivity",
        quantity: "work gained",
        at_most: 0.35,
        because: "the tangential force is the present stiffness times the whole displacement: a contact that is \
                  compressed under shear gains energy as its stiffness grows, here 1 − 1/√2 of the energy of the \
                  spring",
    },
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

    /// Creates the solver with a convention, without a defect and with the check of the time step.
    #[must_use]
    pub const fn new(convention: Convention) -> Self {
        Self { convention, defect: None, allow_unstable: false }
    }

    /// Returns the solver with a defect, for negative controls.
    #[must_use]
    pub const fn with_defect(self, defect: Defect) -> Self {
        Self { defect: Some(defect), ..self }
    }

    /// Returns the solver without the check of the time step against the critical time step of contacts.
    #[must_use]
    pub const fn allowing_unstable_steps(self) -> Self {
        Self { allow_unstable: true, ..self }
    }

    /// Sets up the simulation of a scene with a time step (s), for callers that advance it themselves.
    ///
    /// # Errors
    /// When the scene is not supported or its initial state is not valid.
    pub fn start(&self, scene: &Scene, time_step: f64) -> Result<Box<dyn Simulation>, RunError> {
        self.start_on(scene, time_step, 1, u64::MAX)
    }

    /// Sets up the simulation of a scene with a time step (s) on at most `threads` threads. Individual contacts are
    /// recorded only if there are at most `most_rows` grains and contacts together.
    ///
    /// # Errors
    /// When the scene is not supported or its initial state is not valid.
    pub fn start_on(
        &self,
        scene: &Scene,
        time_step: f64,
        threads: usize,
        most_rows: u64,
    ) -> Result<Box<dyn Simulation>, RunError> {
        self.refuse(scene)?;
        let team = Team::new(threads.min(scene.grains.len() / FEWEST));
        match scene.dimension {
            Dimension::Two => self.start_with(scene, plane(scene, &self.convention), time_step, (team, most_rows)),
            Dimension::Three => self.start_with(scene, solid(scene, &self.convention), time_step, (team, most_rows)),
        }
    }

    fn start_with<S: Geometry>(
        &self,
        scene: &Scene,
        forces: Box<dyn Forces<S>>,
        time_step: f64,
        team: (Team, u64),
    ) -> Result<Box<dyn Simulation>, RunError> {
        let own = words(forces.springs());
        if let Some(springs) = scene.springs.as_ref().filter(|springs| springs.layout != own) {
            let reason = format!(
                "its contacts begin with springs of another law or convention, {} instead of {own} (`springs = false` \
                 next to the state omits them)",
                springs.layout
            );
            return Err(RunError::Unsupported { solver: self.name(), reason });
        }
        let mut simulated =
            DemSimulation::new(scene, forces, Options::from_convention(&self.convention), time_step, team)?;
        simulated.critical.follow_contacts(scene, time_step, self.allow_unstable);
        Ok(Box::new(simulated))
    }

    /// Returns the description of a run. Its identity is stored in checkpoints, so that a checkpoint of another run is
    /// rejected.
    fn run_of<'a>(&self, scene: &'a Scene, time_step: f64, steps: u64, layout: &'static str) -> Run<'a> {
        let solver = format!("{} ({})", self.name(), self.convention.words().join(", "));
        Run { solver, scene, time_step, steps, layout }
    }

    /// Rejects a scene with deformable bodies, with an energy budget that cannot be computed, or with a contact law
    /// without stiffness.
    fn refuse(&self, scene: &Scene) -> Result<(), RunError> {
        let unsupported = |reason: String| Err(RunError::Unsupported { solver: self.name(), reason });
        if let Some(what) = scene.needs_deformable() {
            return unsupported(format!("it has {what}, but the grains of this solver are rigid"));
        }
        if let Some(reason) = crate::accounts::reason(scene).filter(|_| scene.asks_for_budget()) {
            return unsupported(reason);
        }
        if scene.laws.iter().flatten().any(|law| !law.has_stiffness()) {
            return unsupported("a contact law has friction and no stiffness".to_owned());
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

    fn resolution_error(&self, reason: String) -> RunError {
        RunError::Resolution { solver: self.name(), reason }
    }

    /// Returns the time step (s) and the number of steps.
    fn steps(&self, scene: &Scene, resolution: &Resolution) -> Result<(f64, u64), RunError> {
        resolution.steps(scene).map_err(|reason| self.resolution_error(reason))
    }
}

impl Solver for Dem {
    fn name(&self) -> String {
        self.convention.name.to_owned()
    }

    fn run(&self, scene: &Scene, resolution: &Resolution, observer: &mut dyn Observer) -> Result<Record, RunError> {
        self.go(scene, resolution, None, observer)
    }

    fn restart(
        &self,
        scene: &Scene,
        resolution: &Resolution,
        from: &Checkpoint,
        observer: &mut dyn Observer,
    ) -> Result<Record, RunError> {
        self.go(scene, resolution, Some(from), observer)
    }
}

impl Dem {
    /// Runs a scene to its end, from the start or from a checkpoint.
    fn go(
        &self,
        scene: &Scene,
        resolution: &Resolution,
        from: Option<&Checkpoint>,
        observer: &mut dyn Observer,
    ) -> Result<Record, RunError> {
        self.refuse(scene)?;
        let (time_step, steps) = self.steps(scene, resolution)?;
        self.refuse_lagging_dashpots(scene, time_step)?;
        let RunOptions { threads, most_rows, allow_unstable, .. } = observer.options();
        let dem = Self { allow_unstable: self.allow_unstable || allow_unstable, ..*self };
        let mut simulation = dem.start_on(scene, time_step, threads, most_rows)?;
        let run = self.run_of(scene, time_step, steps, simulation.layout());
        let resumed = from.map(|checkpoint| simulation.recall(&run.identity(), checkpoint)).transpose()?;
        let mut running = RunningSimulation { simulation, run, defect: self.defect };
        let course = Course { scene, time_step, steps, resumed, between_progress: STEPS_BETWEEN_PROGRESS };
        let LoopOutput { series, snapshots, cost } = course.drive(&mut running, observer)?;
        Ok(Record {
            provenance: Provenance::new(scene, self.name(), resolution, time_step, self.convention.words()),
            series,
            snapshots,
            cost,
        })
    }
}

/// Returns the loops over contacts in two dimensions, for the effects of a scene and a convention.
pub(crate) fn plane(scene: &Scene, convention: &Convention) -> Box<dyn Forces<Plane>> {
    match convention.history {
        History::Turned => chain::<Plane, Coulomb<Turned>>(scene),
        History::Projected => chain::<Plane, Coulomb<Projected>>(scene),
    }
}

/// Returns the loops over contacts in three dimensions, for the effects of a scene and a convention.
pub(crate) fn solid(scene: &Scene, convention: &Convention) -> Box<dyn Forces<Solid>> {
    match convention.history {
        History::Turned => chain::<Solid, Coulomb<Turned>>(scene),
        History::Projected => chain::<Solid, Coulomb<Projected>>(scene),
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
        (false, _) => Box::new(Chain::<S, N, Frictionless, FreeRolling>::new()),
        (true, false) => Box::new(Chain::<S, N, T, FreeRolling>::new()),
        (true, true) => Box::new(Chain::<S, N, T, ElasticPlastic>::new()),
    }
}

/// Simulation as the main loop runs it, with the identity of the run.
struct RunningSimulation<'a> {
    simulation: Box<dyn Simulation>,
    run: Run<'a>,
    defect: Option<Defect>,
}

impl Stepper for RunningSimulation<'_> {
    fn step(&self) -> u64 {
        self.simulation.step()
    }

    fn advance(&mut self, steps: u64) -> Result<(), RunError> {
        match self.defect {
            None => self.simulation.advance(steps)?,
            Some(Defect::ForgetsHistory) => {
                for _ in 0..steps {
                    self.simulation.advance(1)?;
                    self.simulation.forget_history();
                }
            }
        }
        Ok(())
    }

    fn look(&mut self, snapshot: bool) -> StepState {
        if snapshot { self.simulation.look_for_snapshot() } else { self.simulation.look() }
    }

    fn rows(&self, _: &Scene) -> u64 {
        self.simulation.rows()
    }

    fn shows(&self, _: &Scene, most_rows: u64) -> bool {
        self.simulation.shows(most_rows)
    }

    fn brief(&mut self) -> Brief {
        self.simulation.brief()
    }

    fn counts(&self) -> Counts {
        self.simulation.counts()
    }

    fn end_state(&self) -> Option<EndState> {
        Some(self.simulation.end_state(&self.run.solver))
    }

    fn keep(&self, recorder: &Recorder) -> Result<Option<Checkpoint>, CheckpointError> {
        self.simulation.keep(&self.run.identity(), recorder).map(Some)
    }
}

/// Largest number of steps between two progress reports.
const STEPS_BETWEEN_PROGRESS: u64 = 20_000;
