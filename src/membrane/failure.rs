//! What goes wrong on membranes.

use crate::ode::Reason;

/// What went wrong in a block.
#[derive(Debug, Clone, Copy)]
pub struct Failure {
    pub lane: usize,
    pub time: f64,
    pub reason: Reason,
}

/// What went wrong on a membrane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MembraneTrouble {
    /// The cell, by its number within its kind.
    pub cell: usize,
    /// When, in the document's unit of time.
    pub time: f64,
    /// What is wrong.
    pub reason: Reason,
}
