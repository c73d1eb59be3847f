//! Progress bar on a terminal. Nothing is shown if the standard error is a file or pipe.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::io::IsTerminal;
use std::time::Duration;

/// Progress bar on the standard error; hidden if the standard error is not a terminal.
pub(crate) struct Progress(ProgressBar);

impl Progress {
    /// Creates a bar for `total` items. `what` is the name of the items in the plural.
    pub(crate) fn new(total: u64, what: &str) -> Self {
        if !std::io::stderr().is_terminal() {
            return Self(ProgressBar::hidden());
        }
        let bar = ProgressBar::with_draw_target(Some(total), ProgressDrawTarget::stderr());
        let template = format!("{{bar:30}} {{human_pos}}/{{human_len}} {what}, {{left}}  {{msg}}");
        if let Ok(style) = ProgressStyle::with_template(&template) {
            bar.set_style(style.with_key("left", |state: &ProgressState, text: &mut dyn Write| {
                let _ = text.write_str(&left(state.pos(), state.eta()));
            }));
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(bar)
    }

    /// Shows the name of the current item.
    pub(crate) fn now(&self, what: &str) {
        self.0.set_message(what.to_owned());
    }

    /// Prints a permanent line, above the bar if there is one.
    pub(crate) fn tell(&self, line: &str) {
        if self.0.is_hidden() { eprintln!("{line}") } else { self.0.println(line) }
    }

    /// Increases the number of finished items by one.
    pub(crate) fn advance(&self) {
        self.0.inc(1);
    }

    /// Sets the number of items that were finished before. The estimate of the remaining time starts here.
    pub(crate) fn from(&self, done: u64) {
        self.0.set_position(done);
        self.0.reset_eta();
    }

    /// Sets the number of finished items and the total.
    pub(crate) fn set(&self, done: u64, total: u64) {
        self.0.set_length(total);
        self.0.set_position(done);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// Returns the remaining time in words. The time of unfinished work is never shown as zero.
fn left(done: u64, estimate: Duration) -> String {
    match estimate.as_secs() {
        _ if done == 0 => "time left is not known yet".to_owned(),
        0 => "less than a second left".to_owned(),
        seconds @ 1..60 => format!("{seconds} s left"),
        seconds @ 60..3600 => format!("{} min {} s left", seconds / 60, seconds % 60),
        seconds => format!("{} h {} min left", seconds / 3600, seconds % 3600 / 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_takes_time() {
        assert_eq!(left(0, Duration::ZERO), "time left is not known yet");
        assert_eq!(left(999, Duration::from_millis(300)), "less than a second left");
        assert_eq!(left(9, Duration::from_secs(59)), "59 s left");
        assert_eq!(left(9, Duration::from_secs(61)), "1 min 1 s left");
        assert_eq!(left(9, Duration::from_secs(7260)), "2 h 1 min left");
    }
}
