//! Interrupt by Ctrl-C. The first one stops external programs, and ends the run after the current items. The second one
//! ends grainbench.

use grainbench::reference::end_programs_at;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Flag that is set by an interrupt.
#[derive(Clone, Debug, Default)]
pub(crate) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Starts to listen for the signals SIGINT and SIGTERM. Signals that cannot be caught end the program.
    pub(crate) fn listen() -> Self {
        let asked = Self::default();
        for signal in [SIGINT, SIGTERM] {
            // The handlers are called in the order of their registration, so that only the second signal ends the program.
            let again = flag::register_conditional_default(signal, Arc::clone(&asked.0));
            if again.is_ok() {
                let _ = flag::register(signal, Arc::clone(&asked.0));
            }
        }
        // A run of an external program may take hours, so it is stopped immediately.
        end_programs_at(Arc::clone(&asked.0));
        asked
    }

    /// Returns true if an interrupt was received.
    pub(crate) fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
