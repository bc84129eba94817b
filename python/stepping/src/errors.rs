//! What went wrong, as an exception of Python.

use pseudopod::SimulationError;
use pseudopod::error::{Error, Fault};
use pyo3::prelude::*;

/// A fault as Python is told it: message, help, file, line, column.
type Told = (String, Option<String>, Option<String>, Option<usize>, Option<usize>);

/// The exception for an error: `pseudopod_stepping.SimulationError`, with the same words.
pub fn exception(py: Python, error: &SimulationError) -> PyErr {
    let faults: Vec<Told> = match error {
        SimulationError::Input(Error::Input(faults)) => faults.iter().map(told).collect(),
        _ => Vec::new(),
    };
    let made = py
        .import("pseudopod_stepping._errors")
        .and_then(|module| module.getattr("made"))
        .and_then(|made| made.call1((kind(error), error.to_string(), error.help(), faults)));
    match made {
        Ok(exception) => PyErr::from_value(exception),
        Err(failed) => failed,
    }
}

/// A word by which programs tell errors apart.
fn kind(error: &SimulationError) -> &'static str {
    match error {
        SimulationError::Input(Error::Input(_)) => "input",
        SimulationError::Input(_) => "machine",
        SimulationError::Trouble(_) => "trouble",
        SimulationError::Cancelled { .. } => "cancelled",
        SimulationError::NoSuchCell { .. } => "no_such_cell",
        SimulationError::Unknown { .. } => "unknown",
        SimulationError::Value { .. } => "value",
        SimulationError::NotSettable { .. } => "not_settable",
        SimulationError::Length { .. } | SimulationError::Forces { .. } => "length",
        SimulationError::Population(_) => "population",
        SimulationError::Fibre(_) => "fibre",
        SimulationError::Checkpoint(_) => "checkpoint",
        _ => "other",
    }
}

fn told(fault: &Fault) -> Told {
    let position = fault.location.as_ref().map(|location| {
        let before = location.source.text.get(..location.start).unwrap_or_default();
        let line = before.bytes().filter(|byte| *byte == b'\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
        (location.source.name.clone(), line, column)
    });
    let (file, line, column) = match position {
        Some((file, line, column)) => (Some(file), Some(line), Some(column)),
        None => (None, None, None),
    };
    (fault.message.clone(), fault.help.clone(), file, line, column)
}
