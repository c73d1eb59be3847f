//! What accuracy is measured by: a quantity with an exact answer, and the scene in which each kind of solver is asked for it.
//!
//! A case's subjects are taken from its own gates, so that a new case has its diagram without another line: rows of one
//! quantity against an analytic answer, each solver in the scene that its row gives it. A folder with a `cost.rs` says
//! more, such as a sweep of stiffness.

use crate::case::Case;
use crate::gate::{Change, Gate, Measure, Standing};
use crate::registry::COSTS;
use crate::scope::Scope;
use crate::verdict::Evidence;
use grainbench_scene::solver::Resolution;

/// A kind of solver, by what its resolution is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    /// Grains on springs: a time step.
    Dem,
    /// Rigid grains: substeps and iterations.
    Rigid,
    /// Deformable grains on a grid: cells and points.
    Grid,
}

impl Method {
    /// The kind of a solver of ours, by name.
    #[must_use]
    pub fn of(solver: &str) -> Option<Self> {
        match solver.split([':', '+']).next() {
            Some("dem") => Some(Self::Dem),
            Some("rigid") => Some(Self::Rigid),
            Some("mpm") => Some(Self::Grid),
            _ => None,
        }
    }

    /// What is left of an error when the resolution is as fine as one likes.
    #[must_use]
    pub const fn floor(self) -> &'static str {
        match self {
            Self::Dem => "compliance of the contact",
            Self::Rigid => "the engine's own overlap and order of contacts",
            Self::Grid => "deformability, and contact as soft as a cell",
        }
    }
}

/// The scene in which one kind of solver is asked.
#[derive(Clone)]
pub struct Lane {
    /// The kind.
    pub method: Method,
    /// Knobs beside the resolution, in words; empty where there are none.
    pub knobs: String,
    /// What makes the case's scene that of this lane.
    pub prepare: Option<Change>,
    /// Resolution about which the solver's knobs are turned.
    pub about: Resolution,
}

/// A quantity with an exact answer.
#[derive(Clone)]
pub struct Subject {
    /// The case.
    pub case: &'static Case,
    /// Variant of its scene.
    pub variant: &'static str,
    /// Quantity, in words.
    pub quantity: String,
    /// Its unit.
    pub unit: &'static str,
    /// Where the answer comes from.
    pub source: &'static str,
    /// How it is measured.
    pub measure: Measure,
    /// Who is asked.
    pub lanes: Vec<Lane>,
}

/// What a case says itself: its name, and its subjects.
pub(crate) type Own = (&'static str, fn() -> Vec<Subject>);

/// Subjects taken from gates, of one case at most.
const MOST: usize = 2;

/// The subjects of a case.
#[must_use]
pub fn of(case: &'static Case) -> Vec<Subject> {
    match COSTS.iter().find(|(name, _)| *name == case.name) {
        Some((_, subjects)) => subjects(),
        None => from_gates(case),
    }
}

/// Subjects from the gates of a case: of those with the most kinds of solvers, the first of each variant.
#[must_use]
pub fn from_gates(case: &'static Case) -> Vec<Subject> {
    let mut subjects: Vec<Subject> = Vec::new();
    for gate in (case.gates)() {
        add(case, &gate, &mut subjects);
    }
    let kinds = |subject: &Subject| {
        let mut kinds: Vec<Method> = subject.lanes.iter().map(|lane| lane.method).collect();
        kinds.sort_unstable();
        kinds.dedup();
        kinds.len()
    };
    subjects.sort_by_key(|subject| std::cmp::Reverse(kinds(subject)));
    let mut chosen: Vec<Subject> = Vec::new();
    for subject in subjects {
        if chosen.len() < MOST && chosen.iter().all(|known| known.variant != subject.variant) {
            chosen.push(subject);
        }
    }
    chosen
}

/// Adds what a gate asks for to the subjects so far.
fn add(case: &'static Case, gate: &Gate, subjects: &mut Vec<Subject>) {
    let [run] = gate.runs.as_slice() else { return };
    let Some(method) = Method::of(run.solver) else { return };
    if gate.evidence != Evidence::Analytic || run.standing == Standing::Refused {
        return;
    }
    // Rows of one quantity, word for word, have one expectation: what follows a comma may be what is expected.
    let quantity = gate.quantity.clone();
    let lane = |method, about| Lane {
        method,
        knobs: run.adjustment.as_ref().map(|(name, _)| name.clone()).unwrap_or_default(),
        prepare: run.adjustment.as_ref().map(|(_, change)| change.clone()),
        about,
    };
    let mut lanes = vec![lane(method, run.resolution)];
    if gate.scope == Scope::AnySolver && method == Method::Dem {
        lanes.push(lane(Method::Rigid, Resolution::substeps(8)));
    }
    match subjects.iter_mut().find(|known| known.variant == run.variant && known.quantity == quantity) {
        Some(known) => {
            for lane in lanes {
                if known.lanes.iter().all(|other| other.method != lane.method || other.knobs != lane.knobs) {
                    known.lanes.push(lane);
                }
            }
        }
        None => subjects.push(Subject {
            case,
            variant: run.variant,
            quantity,
            unit: gate.unit,
            source: gate.source,
            measure: gate.measure.clone(),
            lanes,
        }),
    }
}
