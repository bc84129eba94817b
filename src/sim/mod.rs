//! The simulator: model, state, workspace and the step. It knows no files, formats or clocks.

pub mod chemistry;
pub mod constraints;
pub mod contact;
pub mod controls;
mod finite;
pub mod forces;
mod gain;
pub mod implicit;
pub mod inertial;
pub mod model;
mod motility;
mod motion;
pub mod observe;
mod plan;
pub mod planes;
mod pressure;
pub mod projection;
mod refresh;
mod rooms;
mod solver;
pub mod state;
mod step;
mod targets;
pub mod trouble;
mod velocity;
pub mod workspace;

pub use chemistry::Chemistry;
pub use model::{Kind, Model, Plane, VolumeRule};
pub use plan::StepReport;
pub use state::{Inertia, KindState, State};
pub use step::{begin_chemistry, step};
pub use trouble::Trouble;
pub use workspace::Workspace;
