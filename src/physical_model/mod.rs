//! Models of other programs: PML (the physical model: atoms, and the components that are made of them), LML (what is
//! done to it in the course of time) and MML (what is watched, and when to stop). No physics.
//!
//! Each language has a type for its whole document, which [`read`](pml::PhysicalModel::read) makes of the bytes of a file
//! and `write` makes a file of. A reader goes once through the text and keeps nothing but the document. What it does not
//! know (attributes, elements) it keeps and writes back as it was; where real files break the rules in ways that leave no
//! doubt it goes on and says so in a [`Warning`]; what cannot be understood is an error with line and column. Comments
//! are not kept, and numbers of things (`nrOfAtoms` and the like) are counted anew when a document is written.

mod cursor;
mod kept;
pub mod lml;
pub mod mml;
mod number;
mod page;
pub mod pml;
#[cfg(test)]
mod tests;
mod warning;
mod words;
mod writer;

pub use kept::{Attributes, Foreign};
pub use warning::{Warning, Warnings};

/// A document that was read, and what was found on the way.
#[derive(Debug, Clone, PartialEq)]
pub struct Read<T> {
    /// What it says.
    pub document: T,
    /// Where it breaks the rules, and what was made of it.
    pub warnings: Warnings,
}
