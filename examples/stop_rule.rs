//! Ends a simulation by a rule of its own: when a cell that is pressed against a floor has come to rest.
//!
//! `cargo run --release --example stop_rule`

use std::ops::ControlFlow;

use pseudopod::{Simulation, SimulationError};

/// A heavy cell on a floor, for at most ten minutes.
const EXPERIMENT: &str = r#"
title = "A heavy cell settles on a floor"
[run]
until = "10 min"
[environment]
gravity = ["0 um/s^2", "0 um/s^2", "-1 um/s^2"]
[[planes]]
name = "floor"
point = ["0 um", "0 um", "-5 um"]
normal = [0, 0, 1]
[cells.white]
mesh = { shape = "icosphere", radius = "5 um", level = 2 }
mechanics = { drag = "20 pN s/um", mass = "10 pN s^2/um", shape_memory = { shape_modulus = "10 pN/um" } }
"#;

/// Speed below which the cell counts as at rest, um/s.
const AT_REST: f64 = 1e-4;

/// What `cargo run --example stop_rule` does.
pub fn main() -> Result<(), SimulationError> {
    let mut simulation = Simulation::from_text("settling.toml", EXPERIMENT)?;
    // Keep what will be looked at afterwards: the height, every two seconds.
    simulation.keep(&["size_z"], 2.0)?;

    // Called after every step. `Break` ends the simulation with a reason of one's own, here the height at rest; progress could
    // be shown in the same place.
    let end = simulation.end();
    let stopped = simulation.run_with(end, |simulation, _| {
        let now = simulation.snapshot();
        match (now.series("speed"), now.series("size_z")) {
            (Ok(speed), Ok(height)) if speed[0] < AT_REST => ControlFlow::Break(height[0]),
            _ => ControlFlow::Continue(()),
        }
    })?;

    let history = simulation.history();
    for (time, height) in history.times().iter().zip(history.values("size_z").unwrap_or_default()) {
        println!("{time:>7.2} s  {:.4} um", height[0]);
    }
    match stopped {
        ControlFlow::Break(height) => println!("at rest at {:.1} s, {height:.4} um high", simulation.time()),
        ControlFlow::Continue(()) => println!("not yet at rest at {end} s"),
    }
    Ok(())
}
