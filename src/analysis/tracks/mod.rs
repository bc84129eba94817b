//! Tracks of cells, simulated or measured: what they are read from, and what each is like.

mod assemble;
mod head;
pub mod motion;
pub mod package;
pub mod read;
mod set;
pub mod summary;
pub mod velocity;

pub use set::Tracks;
