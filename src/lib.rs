//! Pseudopod simulates populations of deformable 3-D cells: closed, exactly incompressible elastic shells that
//! crawl, carry loads and are recorded in one HDF5 file.
//!
//! A program begins with a [`Simulation`]: made from a document or from an [`experiment::Experiment`] built in Rust, it is
//! stepped, looked at, driven and saved in memory. What is behind it goes the course of a run: the experiment says what the
//! user wants, [`experiment::compile()`] turns it into a [`sim::Model`] (what it means) and a [`sim::State`] (where it
//! starts), [`sim::step()`] moves the state. [`run`] records a simulation in a file, which [`analysis`] and [`picture`] read;
//! [`study`] makes many such runs of one experiment, and [`verify`] holds a run to what is claimed of it.
#![warn(missing_docs)]

#[cfg(test)]
extern crate self as pseudopod; // So that tests in here share examples with the test programs.

pub mod analysis;
pub mod cell;
#[cfg(feature = "cli")]
pub mod cli;
pub mod contact;
pub mod elementary;
pub mod equations;
pub mod error;
pub mod experiment;
pub mod field;
pub mod files;
pub mod geometry;
pub mod mechanics;
pub mod membrane;
pub mod ode;
pub mod output;
pub mod physical_model;
#[cfg(feature = "pictures")]
pub mod picture;
pub mod random;
pub mod recorded;
pub mod run;
pub mod sim;
pub mod simulation;
pub mod study;
pub mod units;
pub mod values;
pub mod verify;
#[cfg(feature = "view")]
pub mod view;
pub mod xml;

pub use simulation::{CancelToken, Simulation, SimulationError};

/// A point or a vector in space, µm unless said otherwise.
pub type Vec3 = nalgebra::Vector3<f64>;
