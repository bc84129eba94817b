//! How a run tells where it is: a bar with the time left on a terminal, a plain line every few seconds elsewhere.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use crate::error::say;
use crate::experiment::Settling;
use crate::run::Report;

/// Time between two plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(5);

/// Time between two updates of the bar.
const BAR_INTERVAL: Duration = Duration::from_millis(100);

/// Parts of the bar.
const BAR_PARTS: u64 = 10_000;

/// Progress on standard error.
pub struct Progress {
    bar: Option<ProgressBar>,
    began: Instant,
    told: Instant,
    start: f64,
    until: f64,
}

impl Default for Progress {
    fn default() -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(BAR_PARTS);
            let template = "{bar:40} {percent:>3} %  {msg}  time left {eta}";
            bar.set_style(ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar
        });
        Self { bar, began: Instant::now(), told: Instant::now(), start: 0.0, until: 1.0 }
    }
}

impl Progress {
    /// Whether it is time to tell something again; then that is noted.
    fn is_due(&mut self) -> bool {
        let interval = if self.bar.is_some() { BAR_INTERVAL } else { LINE_INTERVAL };
        let is_due = self.told.elapsed() >= interval;
        if is_due {
            self.told = Instant::now();
        }
        is_due
    }
}

impl Report for Progress {
    fn notice(&mut self, words: &str) {
        say(words);
    }

    fn settle(&mut self, what: Settling) {
        if !self.is_due() {
            return;
        }
        let (share, words) = match what {
            Settling::Looking(share) => (share, format!("looking whether cells overlap: {:.0} %", 100.0 * share)),
            Settling::Pushing { round, rounds, pairs } => {
                let words = format!("pushing cells apart, {pairs} pairs overlap: round {round} of {rounds} at most");
                (f64::from(round - 1) / f64::from(rounds), words)
            }
        };
        match &self.bar {
            Some(bar) => {
                bar.set_position((share * BAR_PARTS as f64) as u64);
                bar.set_message(words);
            }
            None => say(&words),
        }
    }

    fn begin(&mut self, time: f64, until: f64) {
        (self.start, self.until, self.began, self.told) = (time, until, Instant::now(), Instant::now());
    }

    fn step(&mut self, time: f64, steps: u64) {
        if !self.is_due() {
            return;
        }
        let share = (time - self.start) / (self.until - self.start);
        match &self.bar {
            Some(bar) => {
                bar.set_position((share * BAR_PARTS as f64) as u64);
                bar.set_message(format!("t = {time:.4} of {} s, {steps} steps", self.until));
            }
            None => {
                let left = self.began.elapsed().as_secs_f64() * (1.0 - share) / share.max(1e-12);
                say(&format!("t = {time:.4} of {} s, {steps} steps, about {left:.0} s left", self.until));
            }
        }
    }

    fn end(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}
