//! Studies: one experiment, run with many values of its parameters, and what came out of it in one table.
//!
//! A [`StudyDocument`] says what is varied; [`points()`] works out the points of its design; [`look_over`] tries the experiment with them;
//! a [`Plan`] lists the runs in a folder, with a seed for each; [`run_one`] makes one of them, whoever calls it; [`collect()`] makes a table
//! of what they measured. Who runs them, and how many at a time, is not decided here.

#[cfg(feature = "pictures")]
mod bars;
#[cfg(feature = "pictures")]
pub mod charts;
mod check;
mod collect;
mod design;
mod document;
mod facts;
pub mod fit;
mod one;
mod paths;
mod plan;
mod probe;
mod range;
#[cfg(feature = "pictures")]
mod ranks;
mod runs_table;
mod saltelli;
mod sensitivity;
pub mod snakemake;
mod sobol;
pub mod table;
mod value;
mod variation;

pub use check::{Looked, look_over};
pub use collect::{Collected, Row, Status, collect};
pub use design::{MOST_RUNS, Points, points, run_seed};
pub use document::{Anything, Design, Parameter, Spacing, Study, StudyDocument, schema};
pub use facts::{Facts, Measured, Run};
pub use one::{Complete, Done, Files, OneOptions, run_one};
pub use paths::{absolute, refused, relative, write_all};
pub use plan::{PLAN_FILE, Plan, RUNS_FILE, Replaces};
pub use probe::{Probe, probe, told};
pub use sensitivity::{Sensitivity, sensitivities, sensitivity, sensitivity_columns};
pub use value::Kind;
pub use variation::Column;
