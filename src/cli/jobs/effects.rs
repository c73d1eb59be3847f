//! Tasks of an effects study: one for each effect in each scene of a case.

use super::arguments::Arguments;
use super::study::{ReportOptions, Study, outputs};
use crate::cli::exit::{Fault, Outcome};
use crate::cli::own;
use crate::cli::subject::{SelectedVariants, selected};
use grainbench::cases::solvers::Registry;
use grainbench::jobs::execute::{ResultSink, TaskList};
use grainbench::jobs::task::{Id, Task};
use grainbench::reports::study::effects::Entry;
use grainbench::store::log::State;
use grainbench::studies::effects::ledger::{Ledger, SceneEffect};
use std::sync::Arc;

/// Expected duration of a test of an effect (s).
const SECONDS: f64 = 0.5;

pub(crate) struct EffectStudy {
    /// Study of each case. Its tasks share runs.
    ledgers: Vec<Ledger>,
    /// Index of the study, and the effect, of each task.
    pieces: Vec<(usize, SceneEffect)>,
    arguments: Arguments,
}

impl EffectStudy {
    pub(crate) fn new(arguments: &Arguments) -> Result<Self, Fault> {
        let cases = match own::folder(&arguments.cases)? {
            Some(case) => vec![(case, SelectedVariants::default())],
            None => selected(&arguments.cases)?,
        };
        let (mut ledgers, mut pieces) = (Vec::new(), Vec::new());
        for (number, (case, variants)) in cases.into_iter().enumerate() {
            let ledger = Ledger::new(case, Arc::new(Registry));
            let of_case = ledger.pieces().into_iter().filter(|piece| variants.contain(piece.variant));
            pieces.extend(of_case.map(|piece| (number, piece)));
            ledgers.push(ledger);
        }
        Ok(Self { ledgers, pieces, arguments: arguments.clone() })
    }
}

impl TaskList for EffectStudy {
    type Output = Option<Entry>;

    fn perform(&self, place: usize, sink: &ResultSink<'_, Option<Entry>>) -> (State, Option<Entry>) {
        let (number, piece) = &self.pieces[place];
        sink.now(&format!("{} · {}", piece.variant, piece.effect.word()));
        (State::Done, self.ledgers[*number].entry(piece))
    }
}

impl Study for EffectStudy {
    fn is_timed(&self) -> bool {
        true
    }

    fn tasks(&self, program: &str) -> Result<Vec<Task>, Fault> {
        let task = |(number, piece): &(usize, SceneEffect)| {
            let case = self.ledgers[*number].case;
            let (program, case) = (program.to_owned() + &own::edition(case), case.name);
            Task {
                scene: format!("{case}/{}", piece.variant),
                what: piece.effect.word().to_owned(),
                // One worker tests all effects of a case, because they share runs.
                group: u32::try_from(*number).ok(),
                ..Task::new(Id::of_words(&program, &["effect", case, piece.variant, piece.effect.word()]), SECONDS)
            }
        };
        Ok(self.pieces.iter().map(task).collect())
    }

    fn report(&self, results: Vec<Option<Result<Option<Entry>, String>>>, how: &ReportOptions<'_>) -> Outcome {
        let (results, has_crash) = outputs(results, how);
        let mut study = how.study(self.arguments.command_words());
        study.ledger.extend(results.into_iter().flatten().flatten());
        how.publish(study, has_crash)
    }
}
