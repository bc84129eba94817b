//! The program as others start it, kill it and read its files.

mod commands;
mod kill;
mod python;

#[path = "../pictures/example.rs"]
mod fields_example;
#[path = "../result_file/example.rs"]
#[allow(dead_code)]
mod result_example;
#[path = "../support/turns.rs"]
mod turns;
