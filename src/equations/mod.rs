//! Equations: systems of differential equations, described in EML or SBML, checked and compiled.
//!
//! A text becomes a [`tree::System`] (checked, with its units and locations), and the tree becomes a [`program`] over lanes of
//! cells. Nothing here knows time steps: the engine advances programs for cells, fields advance them in space.

mod determine;
pub mod eml;
pub mod expression;
mod fault;
mod files;
mod linear;
mod pieces;
pub mod program;
mod range;
pub mod reactions;
mod read;
pub mod sbml;
pub mod tree;
pub use files::{Files, NamedFile};
pub use range::Range;
pub use read::{Read, named_files, read, read_in};
