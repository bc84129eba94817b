//! Chemistry in the step: the systems of the scene and of cells, the fields, and the links that join them to cells.
//!
//! A step of mechanics is followed by one of chemistry over the same time, eq. (coupling.1): systems, secretion, fields,
//! and then the links carry numbers both ways, as they are at the end of the step. Within a step what comes through
//! links stands still.

mod advance;
mod atoms;
mod carry;
mod census;
mod correct;
mod exchange;
mod expected;
mod field_values;
mod fields;
mod follow;
mod links;
mod measure;
mod membrane;
mod membranes;
mod model;
mod neighbours;
mod observe;
mod observed;
mod populations;
mod release;
mod release_parts;
mod released;
mod scratch;
mod stages;
mod state;
mod surface;
mod turnover;

pub use carry::set_control;
pub use census::member_cells;
pub use exchange::next_exchange;
pub use expected::missed;
pub use field_values::FieldValues;
pub use links::{
    AtAtoms, AtomControl, Control, Link, LinkObservations, NeighbourNumber, NeighbourReading, Observation,
    Observations, Owner, Source, Taken, Target, Whole, Whose,
};
pub use membrane::Membrane;
pub use membranes::begin_membranes;
pub use model::{Chemistry, FieldReactor, FieldStepping, Members, Reactor};
pub use scratch::ChemistryScratch;
pub use stages::{advance_chemistry, advance_systems_to, begin_chemistry};
pub use state::{ChemistryState, FieldState};
