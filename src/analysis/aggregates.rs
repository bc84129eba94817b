//! The table of what becomes of aggregates from frame to frame.

use crate::error::Result;
use crate::output::ResultFile;
pub use crate::output::{Change, Event, changes};
use std::fmt::Write;

/// The changes in a result as comma-separated text, a line of names with units first; aggregates by their ids, with
/// spaces between several.
///
/// # Errors
/// A result without contacts, or a damaged file.
pub fn table_of_changes(result: &ResultFile) -> Result<String> {
    // A run in which cells pass through each other has no aggregates, and says so.
    result.pairs(0)?;
    let times = result.times()?;
    let mut text = String::from("frame,time (s),event,before,after,cells\n");
    let list = |ids: &[u64]| ids.iter().map(u64::to_string).collect::<Vec<_>>().join(" ");
    for Event { frame, change, before, after, cells } in changes(result.cell_series("aggregate")?.view()) {
        // Writing to a text cannot fail.
        let _ = writeln!(text, "{frame},{},{change},{},{},{cells}", times[frame], list(&before), list(&after));
    }
    Ok(text)
}
