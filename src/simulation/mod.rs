//! The door of the library: a simulation that a program steps, looks at, drives and saves.
//!
//! A [`Simulation`] is made from a document (a file, a text, an [`Experiment`](crate::experiment::Experiment) built in Rust)
//! or from a model and a state. It needs no file and writes none; [`crate::run`], which records results, stands on it
//! like any other program.
//!
//! ```
//! use pseudopod::simulation::{Simulation, SimulationError};
//!
//! let mut simulation = Simulation::from_text("pulled.toml", r#"
//!     title = "A pulled cell"
//!     [run]
//!     until = "10 s"
//!     [cells.white]
//!     mesh = { shape = "icosphere", radius = "5 um", level = 1 }
//!     mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "10 pN/um" } }
//!     loads = [{ name = "pull", cap = { direction = [1, 0, 0], number = 3 }, direction = [1, 0, 0], force = "5 pN" }]
//! "#)?;
//! let mut positions = vec![[0.0; 3]; simulation.atom_count()];
//! simulation.run_until(2.5)?;
//! simulation.positions_into(&mut positions)?;
//! assert_eq!(simulation.time(), 2.5);
//! assert!(simulation.series("position_x")?[0] > 0.0, "the cell follows the pull");
//! # Ok::<(), SimulationError>(())
//! ```

mod balance;
mod builder;
mod cancel;
mod cells;
mod checkpoint;
mod control;
mod error;
mod fibre_fault;
mod fibres;
mod fields;
mod fingerprint;
mod fits;
mod forces;
mod history;
mod id;
mod moved;
mod population;
mod record;
mod series;
mod snapshot;
mod stepping;
mod tools;
mod touch;

pub use crate::output::{SeriesInfo, SeriesScope};
pub use crate::sim::{PopulationTrouble, StepReport, Trouble};
pub use builder::Builder;
pub(crate) use builder::Ready;
pub use cancel::CancelToken;
pub use cells::TypeView;
pub use error::{CheckpointFault, SimulationError};
pub use fibre_fault::FibreFault;
pub use fibres::{FibreId, FibreView};
pub use fields::FieldView;
pub use history::History;
pub(crate) use history::passed;
pub use id::CellId;
pub use population::NewCell;
pub(crate) use record::{Recorder, layout_of};
pub use series::{EndedPseudopod, EndedRun};
pub use snapshot::Snapshot;
pub use stepping::Simulation;

/// A small document to try things with: a cell of type `pulled` with a load `pull`, and one of type `squeezed` with fibres
/// `belt`, for ten seconds.
pub const EXAMPLE: &str = r#"
title = "One cell is pulled, one squeezes itself"
[run]
until = "10 s"
[cells.pulled]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { at = [["-10 um", "0 um", "0 um"]] }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "10 pN/um" } }
loads = [{ name = "pull", cap = { direction = [1, 0, 0], number = 3 }, direction = [1, 0, 0], force = "5 pN" }]
[cells.squeezed]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
placement = { at = [["10 um", "0 um", "0 um"]] }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "10 pN/um" } }
fibres = [{ name = "belt", pattern = "horizontal", stiffness = "1 pN/um" }]
"#;
