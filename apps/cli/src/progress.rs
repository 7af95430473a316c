//! A progress bar on a terminal, for work that takes longer than a moment.

use std::io::{IsTerminal, stderr};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

/// Work shorter than this shows nothing.
const PATIENCE: Duration = Duration::from_millis(300);
const STEPS: u64 = 1000;

/// Shows how far a piece of work is.
pub(crate) struct Progress {
    started: Instant,
    what: &'static str,
    /// Pieces of work, where they are counted.
    pieces: Option<u64>,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// Progress of a piece of work that starts now.
    pub(crate) fn new(what: &'static str) -> Self {
        Self { started: Instant::now(), what, pieces: None, bar: None }
    }

    /// Progress of so many pieces of work, with their rate.
    pub(crate) fn counted(what: &'static str, pieces: u64) -> Self {
        Self { pieces: Some(pieces), ..Self::new(what) }
    }

    /// Shows a finished fraction.
    pub(crate) fn show(&mut self, fraction: f64) {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "between 0 and STEPS")]
        self.count((fraction.clamp(0.0, 1.0) * STEPS as f64) as u64);
    }

    /// Shows so many finished pieces.
    pub(crate) fn count(&mut self, finished: u64) {
        if self.bar.is_none() && self.started.elapsed() >= PATIENCE && stderr().is_terminal() {
            let bar = ProgressBar::new(self.pieces.unwrap_or(STEPS));
            let template = match self.pieces {
                Some(_) => "{msg} {wide_bar} {pos}/{len} {per_sec} {eta} left",
                None => "{msg} {wide_bar} {percent} % {eta} left",
            };
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style);
            }
            bar.set_message(self.what);
            self.bar = Some(bar);
        }
        if let Some(bar) = &self.bar {
            bar.set_position(finished);
        }
    }

    /// Takes the bar away.
    pub(crate) fn done(self) {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
    }
}
