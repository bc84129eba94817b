//! Substances on the surfaces of cells: they spread along the surface, react, and are exchanged with pools inside.
//!
//! A [`MembraneSystem`] is the compiled document, a [`SurfaceMesh`] the neighbourhoods of a kind's atoms, [`MembraneState`] what
//! changes. [`MembraneSystem::advance`] moves blocks of cells, eight abreast where there are many, eq. (surface.1) to (surface.6).

mod cells;
mod evaluate;
mod failure;
mod kick;
mod mesh;
mod scratch;
mod shape;
#[cfg(test)]
mod shape_tests;
mod solve;
mod start;
mod state;
mod step;
mod system;
mod tableau;
mod window;

pub use cells::Shapes;
pub use failure::MembraneTrouble;
pub use kick::Course;
pub use mesh::SurfaceMesh;
pub use scratch::MembraneScratch;
pub use state::{MembraneCells, MembraneState};
pub use system::{MembraneStepping, MembraneSystem};
