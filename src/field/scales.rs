//! Units and names of a document of fields, and its program.

use crate::equations::eml;
use crate::equations::program::Program;
use crate::error::{Error, Fault, Result};

/// The document's units, eq. (field.11).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// Seconds in its unit of time.
    pub seconds: f64,
    /// Micrometres in its unit of length.
    pub micrometres: f64,
}

/// The position in expressions of a document of fields.
pub const POSITION: [&str; 3] = ["x", "y", "z"];

/// The error of a document whose definitions or initial values go in a circle.
pub fn in_circle(document: &eml::Document, circle: &[String]) -> Error {
    let first = circle.first().and_then(|id| document.system.find(id));
    let fault = Fault::new(format!("a circle of {}", circle.join(", "))).help("let one of them be a number");
    let location = first.and_then(|number| document.locations.get(number as usize));
    Error::input(match location {
        Some(location) => fault.at(location.clone()),
        None => fault,
    })
}

/// The program of a document.
///
/// # Errors
/// Definitions in a circle.
pub fn compile(document: &eml::Document) -> Result<Program> {
    Program::new(&document.system).map_err(|circle| in_circle(document, &circle))
}
