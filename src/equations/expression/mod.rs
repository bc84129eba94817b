//! Expressions as people write them, "k*x^n/(K^n + x^n)": read, checked and written.
//!
//! [`parse`] turns a text into a [`Node`] whose parts know their locations and goes on after a fault; [`Scope::resolve`]
//! looks the names up and expands the document's functions into an [`Expr`](super::tree::Expr); [`write()`] goes back
//! to a text that is read as the same expression.

mod functions;
mod parse;
mod resolve;
mod syntax;
mod token;
mod unit;
mod units;
mod write;

pub use functions::{function_names, functions_in_words, is_identifier, is_reserved};
pub use parse::parse;
pub use resolve::{Function, LARGEST, Scope, Spent};
pub use syntax::{DEEPEST, LONGEST, Node, NodeKind, is_constant};
pub use unit::Unit;
pub use units::{Measure, UnitScope};
pub use write::write;

use std::ops::Range;

/// A fault in the text of an expression.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Trouble {
    /// What was found, in one sentence.
    pub message: String,
    /// A few words beside the location.
    pub label: String,
    /// What was expected and what to do.
    pub help: String,
    /// The bytes of the text at fault.
    pub at: Range<usize>,
}

impl Trouble {
    /// A trouble at a location.
    pub fn new(message: impl Into<String>, at: Range<usize>) -> Self {
        Self { message: message.into(), label: String::new(), help: String::new(), at }
    }

    /// Adds a few words beside the location.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Adds what to do.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = help.into();
        self
    }
}

#[cfg(test)]
mod tests;
