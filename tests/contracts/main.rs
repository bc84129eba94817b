//! What holds whatever is simulated, and for the source itself.

mod book;
mod circles;
mod layering;
mod run;
mod volume;

#[path = "../support/turns.rs"]
mod turns;
