//! How forces move atoms: elasticity, loads, integration in time, constraints.
//!
//! Every force is one file: its parameters, `add_forces` (which returns the energy) written over
//! [`lanes::Real`], and `add_stiffness`, its constant linear part for the implicit step.

pub mod angles;
pub mod barrier;
pub mod bending;
pub mod course;
pub mod elasticity;
pub mod fibres;
mod hinge;
pub mod implicit;
pub mod integrator;
pub mod lanes;
pub mod membrane;
pub mod ordering;
pub mod rigid;
pub mod shape_memory;
pub mod shape_modulus;
pub mod springs;
pub mod stability;
pub mod stiffness;
pub mod tension;
pub mod volume;
