//! Fits: parameters of an experiment, so that it comes nearest to data, and how well the data determine them.
//!
//! A [`FitDocument`] says what is fitted and to what; [`Prepared`] is that document tried with its experiment, and a plan in a folder;
//! [`fit`] makes the runs and gives an [`Outcome`]. Starts, plan and runs are those of studies.

#[cfg(feature = "pictures")]
pub mod charts;
#[cfg(test)]
mod coverage_tests;
mod document;
mod evaluate;
mod identifiable;
mod observed;
mod outcome;
mod petab;
mod petab_read;
mod prepared;
mod profile;
mod search;
mod solve;
mod space;
mod statistics;
mod tables;
mod uncertainty;
mod yaml;

pub use document::{Data, Errors, Fit, FitDocument, FitParameter, schema};
pub use evaluate::EvaluateOptions;
pub use identifiable::{percent, verdicts};
pub use observed::{Beside, Datum, Observed};
pub use outcome::{Compared, Estimated, Evaluation, Outcome, Started};
pub use petab::{PROBLEM, write_petab};
pub use petab_read::read_petab;
pub use prepared::Prepared;
pub use search::fit;
pub use space::{Axis, Space};
pub use tables::{facts, write_tables};
