//! What can go wrong, told so that the reader knows where, what was found, what was expected and what to do.

#[cfg(feature = "cli")]
mod excerpt;
#[cfg(feature = "cli")]
mod render;
pub mod words;

#[cfg(feature = "cli")]
pub use render::{Paint, render};

use std::path::PathBuf;
use std::sync::Arc;

/// The result of everything here that can fail.
pub type Result<T> = std::result::Result<T, Error>;

/// A text that faults point into: an experiment document, a mesh file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// The name shown before line and column, usually the path as the user gave it.
    pub name: String,
    /// The whole text.
    pub text: String,
}

/// Where in a text a fault lies: a byte range.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Location {
    /// The text.
    pub source: Arc<Source>,
    /// First byte.
    pub start: usize,
    /// Number of bytes marked; 0 marks a position.
    pub length: usize,
    /// A few words set beside the caret ("expected a length").
    pub label: String,
}

/// One fault in what the user gave.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// What was found, in one sentence.
    pub message: String,
    /// Where, if the fault lies in a text.
    pub location: Option<Location>,
    /// What was expected and what to do.
    pub help: Option<String>,
}

impl Fault {
    /// A fault without a location.
    pub fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), location: None, help: None }
    }
    /// Adds what was expected and what to do.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
    /// Adds where the fault lies.
    pub fn at(mut self, location: Location) -> Self {
        self.location = Some(location);
        self
    }
}

/// Why something failed. [`Error::exit_code`] is the exit status of the program.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Bad input: all faults found, in the order of the text.
    #[error("{}", crate::error::summary(.0))]
    Input(Vec<Fault>),
    /// The numbers failed: not finite, no convergence, an unstable step.
    #[error("{message}")]
    Numbers {
        /// What failed, where and when (cell, time, step).
        message: String,
        /// What to do.
        help: String,
        /// The result file that keeps the last good state, once it is known.
        kept: Option<PathBuf>,
    },
    /// The user or the system asked the run to stop; the result file can be resumed.
    #[error("interrupted at t = {} s", crate::error::short(*.time))]
    Interrupted {
        /// Simulated time reached, s.
        time: f64,
        /// The result file to resume.
        result: PathBuf,
    },
    /// The user or the system asked for a stop; doing the same again goes on from there.
    #[error("{message}")]
    Stopped {
        /// What was stopped where.
        message: String,
        /// How to go on.
        help: String,
    },
    /// The machine failed us: disk full, a file that vanished, a library that reports trouble.
    #[error("{message}")]
    Machine {
        /// What happened to which file.
        message: String,
        /// What to do.
        help: String,
    },
}

impl Error {
    /// Bad input with a single fault.
    pub fn input(fault: Fault) -> Self {
        Self::Input(vec![fault])
    }

    /// The exit status that the program ends with: 2 bad input, 3 the numbers failed, 130 interrupted, 1 the machine.
    pub fn exit_code(&self) -> i32 {
        match self {
            Self::Input(_) => 2,
            Self::Numbers { .. } => 3,
            Self::Interrupted { .. } | Self::Stopped { .. } => 130,
            Self::Machine { .. } => 1,
        }
    }
}

/// Tells a person a line on standard error. Where nobody listens any more (a closed pipe, a full disk) nothing stops for it.
pub fn say(words: &str) {
    use std::io::Write as _;
    let _ = writeln!(std::io::stderr(), "{words}");
}

/// A number as messages show it: at most six digits, without zeros at the end.
pub fn short(value: f64) -> String {
    format!("{value:.5e}").parse::<f64>().unwrap_or(value).to_string()
}

/// One line that names the faults, for logs and `Display`.
fn summary(faults: &[Fault]) -> String {
    faults.iter().map(|fault| fault.message.as_str()).collect::<Vec<_>>().join("; ")
}
