//! What the result file promises: what was recorded is read back, whatever happened to the run.

mod crafted;
mod example;
mod exported;
mod faults;
mod fields;
mod populations;
mod resume;
mod round_trip;
mod tables;
