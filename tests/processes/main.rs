//! The program as others start it, kill it and read its files.

mod commands;
#[cfg(target_os = "linux")]
mod every_write;
mod kill;
mod killed_runs;
mod python;

#[path = "../pictures/example.rs"]
mod fields_example;
#[path = "../result_file/example.rs"]
#[allow(dead_code)]
mod result_example;
#[path = "../support/turns.rs"]
mod turns;
