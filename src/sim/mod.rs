//! The simulator: model, state, workspace and the step. It knows no files, formats or clocks.

pub mod chemistry;
pub mod constraints;
pub mod contact;
pub mod forces;
mod gain;
pub mod implicit;
pub mod inertial;
pub mod model;
mod motility;
pub mod observe;
mod pace;
pub mod planes;
mod pressure;
pub mod projection;
mod refresh;
mod rooms;
pub mod state;
mod step;
mod targets;
pub mod trouble;
pub mod workspace;

pub use chemistry::{Chemistry, begin_chemistry};
pub use model::{Kind, Model, Plane, VolumeRule};
pub use state::{Inertia, KindState, State};
pub use step::{StepReport, step};
pub use trouble::Trouble;
pub use workspace::Workspace;
