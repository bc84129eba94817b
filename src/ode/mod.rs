//! Solving the equations, eq. (ode.1): for all cells of a population side by side, each cell with a step of its own, or for one
//! system alone with events and values at any time.

mod adaptive;
mod advance;
pub(crate) mod block;
mod buffers;
pub(crate) mod cells;
mod clocked;
mod control;
mod course;
mod digits;
mod eventful;
mod events;
mod explicit;
mod fixed;
mod history;
mod jump;
mod linear;
mod lookback;
mod lu;
mod marks;
mod mask;
mod members;
mod memory;
#[cfg(feature = "diffsol")]
mod multistep;
mod narrow;
mod noise;
mod pieces;
mod population;
mod retrace;
mod rosenbrock;
mod scheme;
pub(crate) mod scratch;
mod solve;
mod starts;
mod stepper;
mod stops;
mod substeps;
mod switches;
pub mod tableau;
mod wide;

pub use buffers::PopulationScratch;
pub use clocked::clocked;
pub use control::Tolerances;
pub use eventful::Eventful;
pub use events::{EventPlan, assigned_parameters};
pub use memory::EventMemory;
pub use noise::{Noise, Numbers};
pub use pieces::Piece;
pub use population::{BlockView, LANES, Population};
pub use scheme::Scheme;
pub use solve::{Solution, SolveOptions, solve, solve_each, too_many_times};
pub use starts::{Starts, drawn};
pub use substeps::{Kick, Pace, Substep, Substeps};

use serde::{Deserialize, Serialize};

use crate::equations::program::Program;
use crate::equations::tree::{QuantityId, Schedule};
use crate::error::{Error, Fault};

/// A one-step method.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Method {
    /// Explicit, order 5(4), steps chosen by the error: for systems that are not stiff.
    Rk45,
    /// L-stable Rosenbrock method, order 4(3), steps chosen by the error: for stiff systems.
    Rosenbrock,
    /// The classical method of order 4 with inner steps no longer than this.
    Rk4 {
        /// Longest inner step, in the system's time.
        step: f64,
    },
    /// Euler's method with inner steps no longer than this.
    Euler {
        /// Longest inner step, in the system's time.
        step: f64,
    },
    /// Explicit, order 6(5), steps chosen by the error: for systems that are not stiff and tight tolerances.
    Rk65,
}

/// Most variables of a system that an implicit method takes. Its matrices may have to be dense: those of eight cells take 1.6 GB then, and
/// the time to factor them grows with the third power.
pub const MOST_IMPLICIT: usize = 5000;

/// The fault of a system that is too large for an implicit scheme; `explicit` says how to choose another.
pub fn too_large(name: &str, variables: usize, scheme: &str, explicit: &str) -> Fault {
    let message = format!("{name} has {variables} variables; the scheme {scheme} takes up to {MOST_IMPLICIT}");
    Fault::new(message).help(format!("{explicit} if the system is not stiff; write what spreads in space as a field"))
}

impl Method {
    /// Whether matrices are factored.
    pub fn is_implicit(self) -> bool {
        self == Self::Rosenbrock
    }

    /// Whether steps are chosen by an estimate of their error.
    pub fn has_error(self) -> bool {
        matches!(self, Self::Rk45 | Self::Rk65 | Self::Rosenbrock)
    }

    /// Whether the rates at the end of a step are those with which the next begins.
    fn keeps_rates(self) -> bool {
        matches!(self, Self::Rk45 | Self::Rk65)
    }
}

/// How much work was done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Work {
    /// Steps taken.
    pub steps: u64,
    /// Steps refused for their error.
    pub rejected: u64,
    /// Evaluations of the rates.
    pub rates: u64,
    /// Evaluations of the Jacobian, each with a factorisation.
    pub jacobians: u64,
    /// Events executed.
    pub events: u64,
}

impl Work {
    /// Adds the work of another.
    pub fn add(&mut self, other: Self) {
        self.steps += other.steps;
        self.rejected += other.rejected;
        self.rates += other.rates;
        self.jacobians += other.jacobians;
        self.events += other.events;
    }
}

/// Why a system could not be advanced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reason {
    /// A value or a rate is not a finite number.
    NotFinite,
    /// The error asks for steps too short for the clock.
    StepUnderflow,
    /// More steps than allowed.
    TooManySteps,
    /// Events follow each other without end at one time.
    EndlessEvents,
    /// A schedule has more times than a course can have.
    TooManyTimes,
    /// A value has become so small that round-off is all that is left of it.
    RoundOff,
    /// The solver gave up for a reason of its own.
    Solver,
    /// A delay is below 0.
    LooksAhead,
}

/// What went wrong, in which cell, when and in which variable.
#[derive(Debug, Clone, PartialEq)]
pub struct OdeTrouble {
    /// Name of the system.
    pub system: String,
    /// The cell, in populations.
    pub cell: Option<usize>,
    /// Time of the last good state.
    pub time: f64,
    /// The variable that is worst, where one can be named.
    pub variable: Option<String>,
    /// What is wrong.
    pub reason: Reason,
    /// More words, or none.
    pub detail: String,
}

/// That the equations of an unknown have no solution, in words; nothing where they have.
fn lost(program: &Program, unknown: Option<QuantityId>) -> String {
    unknown.map_or(String::new(), |unknown| {
        format!(
            "the algebraic equation of '{}' has no solution there that is found from its start",
            program.names[unknown as usize]
        )
    })
}

impl std::fmt::Display for OdeTrouble {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the system '{}'", self.system)?;
        if let Some(cell) = self.cell {
            write!(f, " of cell {cell}")?;
        }
        match self.reason {
            Reason::NotFinite => write!(f, " has a value or rate that is not finite")?,
            Reason::StepUnderflow => write!(f, " needs steps shorter than the clock can tell apart")?,
            Reason::TooManySteps => write!(f, " needs more steps than allowed")?,
            Reason::EndlessEvents => write!(f, " has events that follow each other without end")?,
            Reason::TooManyTimes => write!(f, " has an event that would fire more than {} times", Schedule::MOST)?,
            Reason::RoundOff => write!(f, " has a value of which round-off has left no digit")?,
            Reason::LooksAhead => write!(f, " looks ahead")?,
            Reason::Solver => write!(f, " could not be solved")?,
        }
        write!(f, " at t = {}", self.time)?;
        if let Some(variable) = &self.variable {
            write!(f, ", variable '{variable}'")?;
        }
        if self.detail.is_empty() { Ok(()) } else { write!(f, " ({})", self.detail) }
    }
}

impl std::error::Error for OdeTrouble {}

impl From<OdeTrouble> for Error {
    fn from(trouble: OdeTrouble) -> Self {
        let help = match trouble.reason {
            Reason::NotFinite => {
                "look for a division by zero, a root or logarithm of a negative number, or growth without bound"
            }
            Reason::StepUnderflow => {
                "the solution grows without bound or jumps there; check the rates, or use the stiff method"
            }
            Reason::TooManySteps => "use the stiff method, loosen the tolerances, or allow more steps",
            Reason::EndlessEvents => "let the events change what triggers them",
            Reason::TooManyTimes => "let `every` be longer, or write what goes on all the time as a rate",
            Reason::RoundOff => {
                "let atol be above what is left of it; or where the equations keep a sum, let one of its variables follow from \
                 the others in place of having a rate"
            }
            Reason::LooksAhead => "let the delay be a time of 0 or more, such as max(tau, 0)",
            Reason::Solver => "try the Rosenbrock method",
        };
        Self::Numbers { message: trouble.to_string(), help: help.into(), kept: None }
    }
}
