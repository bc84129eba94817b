//! Chemistry: systems of differential equations, described in EML or SBML, compiled once and solved for one cell or for
//! all cells of a population side by side, and fields that diffuse and react.
//!
//! A text becomes a [`tree::System`] (checked, with its units and places), the tree becomes a program over lanes of
//! cells, and the engine advances the program. Mechanics and contacts are never seen from here.

pub mod eml;
pub mod expression;
pub mod field;
pub mod ode;
pub mod program;
mod read;
pub mod sbml;
pub mod tree;
pub use read::{Read, read};
