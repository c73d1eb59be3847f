//! Ctrl-C: the first ends what is going on after the pieces that are at work, the second ends the program.

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether somebody wants the work to end.
#[derive(Clone, Debug, Default)]
pub(crate) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Listens from now on. Where signals cannot be caught they end the program as they always did.
    pub(crate) fn listen() -> Self {
        let asked = Self::default();
        for signal in [SIGINT, SIGTERM] {
            // In this order: what was asked for once before ends the program.
            let again = flag::register_conditional_default(signal, Arc::clone(&asked.0));
            if again.is_ok() {
                let _ = flag::register(signal, Arc::clone(&asked.0));
            }
        }
        asked
    }

    /// Whether it was asked for.
    pub(crate) fn is_asked(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
