//! Whether experiments and results keep what is claimed of them: which claims are about what, and what became of each.
//!
//! The claims of an experiment stand in a file of its folder, [`CLAIMS`], which [`crate::analysis::claims`] reads.

mod beside;
mod subjects;
mod table;

pub use beside::{claims_beside, claims_of_run};
pub use subjects::{Of, Subject, subjects};
pub use table::{in_a_line, table};

/// The name of the file that holds the claims about the documents of its folder.
pub const CLAIMS: &str = "expected.toml";
