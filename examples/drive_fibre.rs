//! Drives a cell from code of its own: a controller sets the activation of contractile fibres so that the cell becomes as narrow
//! as it is told to be.
//!
//! `cargo run --release --example drive_fibre`

use pseudopod::{Simulation, SimulationError};

/// A cell with a belt of fibres from side to side, relaxed unless somebody activates them.
const EXPERIMENT: &str = r#"
title = "A cell with a belt"
[run]
until = "60 s"
[cells.squeezed]
mesh = { shape = "icosphere", radius = "5 um", level = 1 }
mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "10 pN/um" } }
fibres = [{ name = "belt", pattern = "horizontal", stiffness = "3 pN/um" }]
"#;

/// Time between two decisions of the controller, s.
const INTERVAL: f64 = 0.1;
/// Activation for each um that the cell is too wide, and for each um s.
const GAINS: [f64; 2] = [0.3, 0.3];

/// What `cargo run --example drive_fibre` does.
pub fn main() -> Result<(), SimulationError> {
    let mut simulation = Simulation::from_text("belt.toml", EXPERIMENT)?;
    let cell = simulation.cells().next().expect("one cell");
    let (mut sum, mut width) = (0.0, 0.0);
    println!("{:>6} {:>10} {:>10} {:>11}", "t/s", "wanted/um", "width/um", "activation");
    for decision in 0..600 {
        // Wide, then narrow: any code may stand here, a model of signalling or another simulator.
        let wanted = if simulation.time() < 30.0 { 9.5 } else { 9.0 };
        let now = simulation.snapshot();
        width = 0.5 * (now.series("size_x")?[0] + now.series("size_y")?[0]);
        sum += INTERVAL * (width - wanted);
        let activation = (GAINS[0] * (width - wanted) + GAINS[1] * sum).clamp(0.0, 1.0);
        // It stays so until it is set again. The words are those of links in documents of equations.
        simulation.set(cell, "fibre[belt]", activation)?;
        simulation.run_until(INTERVAL * f64::from(decision + 1))?;
        if decision % 50 == 49 {
            println!("{:>6.1} {wanted:>10.2} {width:>10.3} {activation:>11.3}", simulation.time());
        }
    }
    assert!((width - 9.0).abs() < 0.05, "the cell is as narrow as it was told to be: {width} um");
    Ok(())
}
