//! What holds whatever is simulated, and for the source itself.

mod book;
mod circles;
mod layering;
mod run;
mod transaction;
mod volume;

#[path = "../support/everything.rs"]
mod everything;
#[path = "../support/turns.rs"]
mod turns;
