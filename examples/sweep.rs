//! A parameter sweep in memory: how far cells of several stiffnesses are stretched by the same force. No file is written.
//!
//! `cargo run --release --example sweep`

use pseudopod::{Simulation, SimulationError};
use rayon::prelude::*;

const EXPERIMENT: &str = r#"
title = "A stretched cell"
[run]
until = "20 s"
[cells.white]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "5 pN/um" } }
loads = [
    { name = "right", cap = { direction = [1, 0, 0], number = 3 }, direction = [1, 0, 0], force = "20 pN" },
    { name = "left", cap = { direction = [-1, 0, 0], number = 3 }, direction = [-1, 0, 0], force = "20 pN" },
]
"#;

/// The length of a cell of this modulus (pN/um) after 20 s, and its energy: um, pN um.
fn stretched(modulus: f64) -> Result<(f64, f64), SimulationError> {
    // `set` changes a key of the document as `--set` does on the command line; what it says is checked in the same way.
    let mut simulation = Simulation::builder()
        .set("cells.white.mechanics.shape_memory.shape_modulus", format!("{modulus} pN/um"))
        .text("stretched.toml", EXPERIMENT)?;
    simulation.run_until(simulation.end())?;
    let now = simulation.snapshot();
    Ok((now.series("size_x")?[0], now.series("energy")?[0]))
}

/// What `cargo run --example sweep` does.
pub fn main() -> Result<(), SimulationError> {
    let moduli = [5.0, 10.0, 20.0, 40.0, 80.0];
    // Simulations know nothing of each other, so that they may run side by side; the numbers do not depend on it.
    let rows: Vec<(f64, f64)> = moduli.par_iter().map(|modulus| stretched(*modulus)).collect::<Result<_, _>>()?;
    println!("{:>14} {:>10} {:>14}", "modulus/pN/um", "length/um", "energy/pN um");
    for (modulus, (length, energy)) in moduli.iter().zip(&rows) {
        println!("{modulus:>14} {length:>10.3} {energy:>14.3}");
    }
    assert!(rows.windows(2).all(|pair| pair[1].0 < pair[0].0), "the stiffer the shorter");
    Ok(())
}
