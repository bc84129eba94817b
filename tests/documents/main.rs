//! The experiment document: what is understood, and where it makes a run start.

mod contact;
mod damaged;
mod equilibrium;
mod fits;
mod frame_times;
mod kept_state;
mod meaning;
mod named_files;
mod physical_models;
mod population;
mod random_scenes;
mod reference;
mod shipped;
mod start;
mod studies;

#[path = "../support/chance.rs"]
mod chance;

#[path = "../support/damage.rs"]
mod damage;
