//! Comparison of a run's elements with stored results of other silos. According to the paper, the elements of all flows
//! lie on one curve.

use super::ensemble::{self, STRAIN};
use crate::kept;
use crate::registry::by_name;
use grainbench_harness::prelude::*;
use std::sync::{Mutex, PoisonError};

/// Flow whose stored result is compared with a run of the same size: case, variant, and label in figures.
pub(crate) struct ComparedFlow {
    pub(crate) case: &'static str,
    pub(crate) variant: &'static str,
    pub(crate) label: &'static str,
    /// Number of bins of strain, counted upwards from |E| = 0.1, that contain tracers.
    pub(crate) strained: usize,
}

/// The flows that are compared with the tall silo at a tenth of the paper's size.
pub(crate) const TENTH: [ComparedFlow; 2] = [
    ComparedFlow { case: "silo-wide", variant: "drained", label: "wide silo, drained", strained: 5 },
    ComparedFlow { case: "silo-push", variant: "pushed", label: "wide silo, pushed", strained: 3 },
];

/// The pushed silo at the paper's size.
const DEEP: ComparedFlow = ComparedFlow { case: "silo-push", variant: "deep", label: "tall silo, pushed", strained: 3 };

/// The flows that are compared with the tall silo at the paper's size.
pub(crate) const PAPER: [ComparedFlow; 2] =
    [ComparedFlow { case: "silo-wide", variant: "paper", label: "wide silo, drained", strained: 5 }, DEEP];

/// The flows that are compared with the wide silo at the paper's size.
pub(crate) const BESIDE_WIDE: [ComparedFlow; 2] =
    [ComparedFlow { case: "silo-tall", variant: "paper", label: "tall silo, drained", strained: 5 }, DEEP];

/// Stored result of a flow with its case and variant.
type FlowResult = ([&'static str; 2], Result<FinishedRun, String>);

impl ComparedFlow {
    /// Returns the stored result. It is read once, because several claims and figures use it.
    pub(super) fn done(&self) -> Result<FinishedRun, MissingData> {
        static READ: Mutex<Vec<FlowResult>> = Mutex::new(Vec::new());
        let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
        let name = [self.case, self.variant];
        if let Some((_, left)) = read.iter().find(|(known, _)| *known == name) {
            return left.clone().map_err(MissingData);
        }
        let left = self.read().map_err(|reason| format!("kept run of {}/{}: {reason}", self.case, self.variant));
        read.push((name, left.clone()));
        left.map_err(MissingData)
    }

    fn read(&self) -> Result<FinishedRun, String> {
        let case = by_name(self.case).ok_or("there is no such case")?;
        let mut runs = (case.claims)().into_iter().flat_map(|claim| claim.runs);
        let run = runs.find(|run| run.kept && run.variant == self.variant).ok_or("none is read")?;
        let scene = Arc::new(case.variant(run.variant).map_err(|error| error.to_string())?);
        kept::load(case, &run, &scene, None).ok_or("nothing is kept")?.map_err(|error| error.to_string())
    }
}

/// Returns the claim that two silos have the same curve of packing fraction φ against inertial number |I₀|. The curve ends
/// with the run of the other silo. `which` names this silo, and `size` is a suffix of the quantity.
pub(crate) fn of_drains(run: Run, other: &'static ComparedFlow, [which, size]: [&str; 2]) -> Claim {
    claim(format!("packing fraction over |I₀| beside that of {which}, worst bin{size}"), "1")
        .run(run)
        .agrees(Source::Ourselves("stored result of the run of that silo"), move |done| {
            let other = other.done()?;
            let theirs = ensemble::over_inertia(&other, f64::INFINITY)?.into_iter().enumerate();
            let theirs = theirs.filter_map(|(bin, packing)| Some((bin, packing?)));
            let until = other.scene.duration.seconds().unwrap_or(f64::INFINITY);
            Ok(ensemble::worst(&ensemble::in_bins_of(&ensemble::over_inertia(&done[0], until)?, theirs)?))
        })
        .within(required(0.008, "required in advance: two runs of the prototype differ by .005 to .008; in units of φ"))
        .refuses(ensemble::DENSITY_OF_ONE)
}

/// Number of bins of strain below |E| = 0.1, in which flows from different deposits differ.
const FEW_STRAINS: usize = 3;

/// Returns the claim that the flow of `run` and the `others` have the same curve of φ against strain |E|.
pub(crate) fn of_strained(run: Run, others: &'static [ComparedFlow], size: &str) -> Claim {
    claim(format!("packing fraction over |E| from .1 on beside that of the other flows, worst bin{size}"), "1")
        .run(run)
        .agrees(Source::Ourselves("stored results of the runs of the other silos"), move |done| {
            let ours = ensemble::over_strain(&done[0])?;
            let mut pairs = Vec::new();
            for other in others {
                let theirs = ensemble::over_strain(&other.done()?)?;
                for bin in FEW_STRAINS..FEW_STRAINS + other.strained {
                    let lacking = || format!("tracers with |E| of {:?}; {} has none", STRAIN[bin], other.label);
                    pairs.push([ours[bin].ok_or_else(lacking)?, theirs[bin].ok_or_else(lacking)?]);
                }
            }
            Ok(ensemble::worst(&pairs))
        })
        .within(required(0.013, "required in advance: runs of the prototype agree within .013 there; in units of φ"))
        .refuses(ensemble::LARGER_RADII)
}
