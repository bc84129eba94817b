//! Chemistry in the step: the systems of the scene and of cells, the fields, and the links that join them to cells.
//!
//! A step of mechanics is followed by one of chemistry over the same time, eq. (coupling.1): systems, secretion, fields,
//! and then the links carry numbers both ways, as they are at the end of the step. Within a step what comes through
//! links stands still.

mod carry;
mod measure;
mod model;
mod scratch;
mod stages;
mod state;

pub use carry::{missed, set_control};
pub use model::{
    Chemistry, Control, FieldReactor, FieldStepping, Link, Members, Owner, Reactor, Source, Target, Whole, Whose,
};
pub use scratch::ChemistryScratch;
pub use stages::{advance_chemistry, begin_chemistry, next_exchange};
pub use state::{ChemistryState, FieldState};
