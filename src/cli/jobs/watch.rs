//! Progress of tasks on a terminal, and interrupts.

use crate::cli::interrupt::Interrupt;
use crate::cli::progress::Progress;
use grainbench::jobs::execute::Watch;
use grainbench::reference::has_ended_programs;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Observer that shows the progress and starts no new task after an interrupt.
pub(crate) struct Follower<'a> {
    interrupt: Interrupt,
    progress: Mutex<Option<Progress>>,
    /// Name of the tasks in the plural.
    what: &'static str,
    /// Function that is called after each finished task, if any.
    after: Option<&'a (dyn Fn() + Sync)>,
}

impl<'a> Follower<'a> {
    pub(crate) fn new(what: &'static str, after: Option<&'a (dyn Fn() + Sync)>) -> Self {
        Self { interrupt: Interrupt::listen(), progress: Mutex::new(None), what, after }
    }

    fn progress(&self) -> MutexGuard<'_, Option<Progress>> {
        self.progress.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Prints a permanent line.
    pub(crate) fn tell(&self, line: &str) {
        if let Some(progress) = &*self.progress() {
            progress.tell(line);
        }
    }
}

impl Watch for Follower<'_> {
    fn goes_on(&self) -> bool {
        !self.interrupt.is_asked()
    }

    fn are_results_valid(&self) -> bool {
        // An error may be due to the interrupt. It would count as a control that failed as required.
        !has_ended_programs()
    }

    fn begins(&self, tasks: usize) {
        *self.progress() = Some(Progress::new(tasks as u64, self.what));
    }

    fn now(&self, name: &str) {
        if let Some(progress) = &*self.progress() {
            progress.now(name);
        }
    }

    fn finished(&self) {
        if let Some(progress) = &*self.progress() {
            progress.advance();
        }
        if let Some(after) = self.after {
            after();
        }
    }

    fn waits(&self, others: &[String]) {
        self.progress()
            .get_or_insert_with(|| Progress::new(0, self.what))
            .now(&format!("other workers have the remaining tasks: {}", others.join(", ")));
    }
}
