//! How a study tells where it is: a bar on a terminal, a plain line now and then elsewhere.

use crate::error::say;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Time between two plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(10);

/// Progress of a study on standard error.
pub struct RunsTold {
    bar: Option<ProgressBar>,
    told: Instant,
    began: Instant,
    all: usize,
    said: usize,
}

impl RunsTold {
    /// For so many runs. A quiet one says nothing.
    pub fn new(all: usize, quiet: bool) -> Self {
        let bar = (!quiet && std::io::stderr().is_terminal()).then(|| {
            let bar = ProgressBar::new(all as u64);
            let template = "{bar:40} {pos} of {len} runs  {msg}  time left {eta}";
            bar.set_style(ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar
        });
        // Quiet is said by a number that is never reached.
        let said = if quiet { usize::MAX } else { 0 };
        Self { bar, told: Instant::now(), began: Instant::now(), all, said }
    }

    /// So many ended, so many of them badly, so many go on.
    pub fn tell(&mut self, ended: usize, failed: usize, running: usize) {
        let words = match failed {
            0 => format!("{running} at a time"),
            _ => format!("{failed} failed, {running} at a time"),
        };
        if let Some(bar) = &self.bar {
            bar.set_position(ended as u64);
            bar.set_message(words);
            return;
        }
        if ended <= self.said || ended == self.all || self.told.elapsed() < LINE_INTERVAL {
            return;
        }
        (self.told, self.said) = (Instant::now(), ended);
        let left = self.began.elapsed().as_secs_f64() / ended as f64 * (self.all - ended) as f64;
        say(&format!("{ended} of {} runs, {words}, about {} left", self.all, crate::study::told(left)));
    }

    /// A line that stays, above the bar.
    pub fn line(&self, words: &str) {
        match &self.bar {
            Some(bar) => bar.println(words),
            None => say(words),
        }
    }

    /// No more is told.
    pub fn end(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
