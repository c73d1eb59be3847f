//! Ctrl-C. The first one ends external programs and stops the run after the current items. The second one ends
//! grainbench.

use grainbench::reference::end_programs_at;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Flag that is set by an interrupt.
#[derive(Clone, Debug, Default)]
pub(crate) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Starts to listen for signals. If signals cannot be caught, they end the program as by default.
    pub(crate) fn listen() -> Self {
        let asked = Self::default();
        for signal in [SIGINT, SIGTERM] {
            // This order ensures that the second signal ends the program.
            let again = flag::register_conditional_default(signal, Arc::clone(&asked.0));
            if again.is_ok() {
                let _ = flag::register(signal, Arc::clone(&asked.0));
            }
        }
        // An external program may be silent for hours, so it does not count as a current item.
        end_programs_at(Arc::clone(&asked.0));
        asked
    }

    /// Returns true if an interrupt was received.
    pub(crate) fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
