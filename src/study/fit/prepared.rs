//! A fit that was tried with its experiment, and its plan.

use super::document::FitDocument;
use super::observed::{Observed, observed};
use super::space::Space;
use crate::error::{Error, Result};
use crate::study::check::look_over;
use crate::study::plan::Plan;
use std::path::Path;

/// A fit whose experiment takes its values and has what its data stand beside.
#[derive(Debug, Clone)]
pub struct Prepared {
    /// What was asked.
    pub document: FitDocument,
    /// Its parameters.
    pub space: Space,
    /// Its data.
    pub observed: Vec<Observed>,
    /// Where the search starts.
    pub starts: Vec<Vec<f64>>,
    /// The plan in its folder, whose runs are those of the starts; it is not written yet.
    pub plan: Plan,
}

impl Prepared {
    /// Tries the experiment at the starts and at the bounds, and reads the data.
    ///
    /// * `folder` – where evaluations and tables are to lie
    /// * `memory` – bytes that a run may take, by an estimate; any number when absent
    ///
    /// # Errors
    /// [`Error::Input`](crate::error::Error::Input) with all faults of the parameters, then of the experiment with them, then of the data.
    pub fn new(document: FitDocument, folder: &Path, memory: Option<u64>) -> Result<Self> {
        let space = Space::of(&document)?;
        let starts = space.starts(document.fit.starts, document.fit.seed);
        let looked = look_over(&document.study, &space.points(&space.to_be_tried(&starts)), memory);
        let looked = looked.map_err(told_once)?;
        let observed = observed(&document, &looked.some[0])?;
        let plan = Plan::new(&document.study, space.points(&starts), &looked.some[0], &looked.files, folder);
        Ok(Self { document, space, observed, starts, plan })
    }
}

/// What both bounds of a parameter are refused for alike is told at the first.
fn told_once(error: Error) -> Error {
    let Error::Input(mut faults) = error else { return error };
    faults.dedup_by(|next, last| next.message == last.message);
    Error::Input(faults)
}
