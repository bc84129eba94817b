//! What holds whatever is simulated, and for the source itself.

mod book;
mod circles;
mod examples;
mod layering;
mod run;
mod simulation;
mod volume;

#[path = "../support/turns.rs"]
mod turns;
