//! Fields: substances that diffuse, decay and react on the substrate or in the medium, that cells release and sense.
//!
//! [`Fields`] holds the values of all species on one [`Grid`]. [`Fields::advance`] moves them in time, second order in
//! time and space; [`Fields::deposit`] and [`Fields::sense`] are what cells do to them.

mod axis;
mod beside;
mod broken;
mod bundle;
mod carry;
mod clock;
mod course;
mod error;
mod factors;
mod fluxes;
pub mod grid;
mod joint;
mod joint_error;
mod joint_events;
mod layout;
mod limit;
mod lines;
mod noise;
mod pieces;
mod positions;
mod profiles;
mod react;
mod reactor;
mod reactor_scratch;
mod release;
mod rows;
mod scales;
mod scene;
mod scene_course;
mod sense;
mod sensed;
mod shared;
mod sites;
mod species;
mod state;
mod steady;
mod stencil;
mod step;
mod sweep;
mod sweeps;
mod system;
mod tables;
mod touch;
mod transport;
mod transpose;
mod turn;

pub use crate::equations::Range;
pub use beside::Beside;
pub use grid::{Grid, Wall, Walls};
pub use layout::{ARRAYS, CARRYING, Placing};
pub use react::{Chunk, POINTS, React};
pub use scene::{Scene, ScenePace, SceneScratch};
pub use scene_course::SceneCourse;
pub use sensed::Sensed;
pub use species::Species;
pub use state::Fields;
pub use step::{Report, Stepping};
pub use system::{FieldSystem, LoadProfile};
