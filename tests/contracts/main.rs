//! What holds whatever is simulated, and for the source itself.

mod book;
mod circles;
mod examples;
mod layering;
mod own_forces;
mod run;
mod simulation;
mod transaction;
mod volume;
mod words;

#[path = "../support/everything.rs"]
mod everything;
#[path = "../support/turns.rs"]
mod turns;
