//! A fault with its location in a document of equations.

use crate::error::{Fault, Location, Source};
use std::ops::Range;
use std::sync::Arc;

/// The longest line, in bytes, that is shown with a fault: documents that a program wrote may be one line.
const LONGEST_LINE: usize = 2000;

/// A fault at bytes of a text: what was found, a few words beside the location, what to do. Where the line is too long to
/// be shown the message says its number and the column.
pub fn at_location(source: &Arc<Source>, at: Range<usize>, message: String, label: &str, help: &str) -> Fault {
    let text = &source.text;
    let start = text[..at.start].rfind('\n').map_or(0, |end| end + 1);
    let end = text[at.start..].find('\n').map_or(text.len(), |end| at.start + end);
    if end - start > LONGEST_LINE {
        let line = 1 + text.as_bytes()[..start].iter().filter(|byte| **byte == b'\n').count();
        let column = 1 + text[start..at.start].chars().count();
        return Fault::new(format!("{}:{line}:{column}: {message}", source.name)).help(help);
    }
    let location = Location { source: source.clone(), start: at.start, length: at.len(), label: label.to_owned() };
    Fault::new(message).at(location).help(help)
}
