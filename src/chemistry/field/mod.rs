//! Fields: substances that diffuse, decay and react on the substrate or in the medium, that cells release and sense.
//!
//! [`Fields`] holds the values of all species on one [`Grid`]. [`Fields::advance`] moves them in time, second order in
//! time and space; [`Fields::deposit`] and [`Fields::sense`] are what cells do to them.

mod factors;
pub mod grid;
mod limit;
mod react;
mod species;
mod state;
mod steady;
mod step;
mod sweep;
mod sweeps;
mod touch;

pub use grid::{Grid, Wall, Walls};
pub use react::{Chunk, POINTS, React};
pub use species::{Range, Species};
pub use state::Fields;
pub use step::{Report, Stepping};
pub use touch::Sensed;
