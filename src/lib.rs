//! Pseudopod simulates populations of deformable 3-D cells: closed, exactly incompressible elastic shells that
//! crawl, carry loads and are recorded in one HDF5 file.
//!
//! The way through the library is the way of a run: an [`experiment::Experiment`] says what the user wants,
//! [`experiment::compile()`] turns it into a [`sim::Model`] (what it means) and a [`sim::State`] (where it starts),
//! [`sim::step()`] moves the state, [`run`] loops and records, [`analysis`] and [`picture`] read the finished file.
#![warn(missing_docs)]

#[cfg(test)]
extern crate self as pseudopod; // So that tests in here share examples with the test programs.

pub mod analysis;
pub mod cell;
pub mod cli;
pub mod contact;
pub mod equations;
pub mod error;
pub mod experiment;
pub mod field;
pub mod geometry;
pub mod mechanics;
pub mod ode;
pub mod output;
pub mod picture;
pub mod random;
pub mod run;
pub mod sim;
pub mod units;
pub mod xml;

/// A point or a vector in space, µm unless said otherwise.
pub type Vec3 = nalgebra::Vector3<f64>;
