//! How documents of equations are read: by themselves, and as the chemistry of an experiment.

use std::sync::Arc;

use pseudopod::equations::eml::Level;
use pseudopod::equations::{Read, read};
use pseudopod::error::Source;
use pseudopod::simulation::{Simulation, SimulationError};

use crate::commands::told;

/// An experiment with a small cell and the document.
const EXPERIMENT: &str = r#"
title = "A cell with equations"
run = { until = "1 s" }
cells.white.mesh = { shape = "icosphere", radius = "5 um", level = 0 }
cells.white.mechanics = { drag = "20 pN s/um", shape_memory = { shape_modulus = "5 pN/um" } }
chemistry.model = { document = "model.eml" }
"#;

/// Reads a document and begins an experiment with it; what was read.
pub fn read_and_begin(text: &str) -> Option<Read> {
    let source = Source { name: "fuzzed".into(), text: text.to_owned() };
    let found = read(Arc::new(source)).map_err(|error| told(&error)).ok()?;
    let of_cells = matches!(found.document.level, Level::Cell | Level::Membrane);
    let experiment = format!("{EXPERIMENT}{}", if of_cells { "cells.white.chemistry = [\"model\"]\n" } else { "" });
    let builder = Simulation::builder().equations("model.eml", text);
    match builder.text("fuzzed.toml", &experiment) {
        Err(SimulationError::Input(error)) => told(&error),
        Err(error) => assert!(!error.to_string().is_empty()),
        Ok(_) => {}
    }
    Some(found)
}
