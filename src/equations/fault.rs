//! A fault with its location in a document of equations.

use crate::error::{Fault, Location, Source};
use std::ops::Range;
use std::sync::Arc;

/// A fault at bytes of a text: what was found, a few words beside the location, what to do.
pub fn at_location(source: &Arc<Source>, at: Range<usize>, message: String, label: &str, help: &str) -> Fault {
    let location = Location { source: source.clone(), start: at.start, length: at.len(), label: label.to_owned() };
    Fault::new(message).at(location).help(help)
}
