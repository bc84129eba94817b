//! Steps a simulation and reads where the atoms of its cells are, as a viewer or an analysis of one's own would.
//!
//! `cargo run --release --example positions`

use pseudopod::{Simulation, SimulationError};

/// A cell that is pulled at its right end; every quantity has its unit.
const EXPERIMENT: &str = r#"
title = "A pulled cell"
[run]
until = "8 s"
[cells.white]
mesh = { shape = "icosphere", radius = "5 um", level = 2 }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "10 pN/um" } }
loads = [{ name = "pull", cap = { direction = [1, 0, 0], number = 7 }, direction = [1, 0, 0], force = "20 pN" }]
"#;

/// What `cargo run --example positions` does.
pub fn main() -> Result<(), SimulationError> {
    let mut simulation = Simulation::from_text("pulled.toml", EXPERIMENT)?;

    // What does not change: the facets, three atoms each, are those of the type.
    let white = simulation.types().next().expect("one type of cells");
    println!("type {}: {} atoms, {} facets", white.name(), white.atom_count(), white.facets().len());

    // One buffer, filled again and again: x, y and z of every atom in um, cell after cell.
    let mut positions = vec![[0.0; 3]; simulation.atom_count()];
    println!("{:>6} {:>8} {:>10} {:>10}", "t/s", "steps", "left/um", "right/um");
    while simulation.time() < simulation.end() {
        // Ends at this very time; the steps on the way there are as long as their error allows.
        simulation.run_until(simulation.time() + 1.0)?;
        simulation.positions_into(&mut positions)?;
        let left = positions.iter().map(|p| p[0]).fold(f64::INFINITY, f64::min);
        let right = positions.iter().map(|p| p[0]).fold(f64::NEG_INFINITY, f64::max);
        println!("{:>6.1} {:>8} {left:>10.3} {right:>10.3}", simulation.time(), simulation.steps());
    }

    // Whatever a result would record can be asked for by name.
    println!("energy {:.2} pN um, volume {:.3} um^3", simulation.series("energy")?[0], simulation.series("volume")?[0]);
    Ok(())
}
