//! The program as others start it, kill it and read its files.

mod commands;
mod crowd;
mod damaged;
#[cfg(target_os = "linux")]
mod every_write;
mod fit;
mod kill;
mod killed_runs;
mod python;
mod running;
mod sbml_elsewhere;
#[cfg(target_os = "linux")]
mod shim;
#[cfg(target_os = "linux")]
mod soak;
mod sweep;

#[path = "../support/chance.rs"]
#[allow(dead_code)]
mod chance;
#[path = "../pictures/example.rs"]
mod fields_example;
#[path = "../result_file/example.rs"]
#[allow(dead_code)]
mod result_example;
#[path = "../support/shared.rs"]
mod shared;
#[path = "../support/turns.rs"]
mod turns;
