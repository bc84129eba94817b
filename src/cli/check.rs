//! `pseudopod check`: finds all faults of experiment documents without running them.

use super::memory;
use super::progress::Progress;
use super::report::{Report, path_text};
use crate::error::{Error, Result, say};
use crate::experiment::{Document, Prepared, PushedApart, Size, notices, prepare, settle_start_told};
use crate::run::Report as _;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Checks experiment documents and reports all their faults.
#[derive(Debug, Clone, clap::Args)]
pub struct CheckArgs {
    /// The documents.
    #[arg(required = true, value_name = "EXPERIMENT")]
    pub documents: Vec<PathBuf>,
    /// Changes a key before checking, as in --set run.until="10 s".
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
    /// The most memory that they may take by an estimate, as in "8 GB"; by default what the machine has.
    #[arg(long, value_name = "SIZE")]
    pub memory: Option<String>,
    /// Prints what was found as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Runs the command: reads every document, compiles it, and looks over the start of its cells. A line for every good document; the faults of all
/// others together.
///
/// # Errors
/// [`Error::Input`] with the faults of all documents.
pub fn run(args: &CheckArgs) -> Result<Report> {
    let (mut words, mut good, mut faults) = (String::new(), Vec::<Value>::new(), Vec::new());
    let memory = memory::allowed(args.memory.as_deref())?;
    for path in &args.documents {
        // Faults of meshes and steps show only once the cells are built.
        let checked = Document::read(path, &args.sets).and_then(|mut document| {
            document.memory = memory;
            tell_of_fine_meshes(path, &document);
            let prepared = prepare(&document)?;
            let size = prepared.size;
            let mut said = notices(&document, &prepared);
            let pushed = settled(&document, prepared)?;
            said.extend(pushed.notice());
            Ok((document, size, pushed, said))
        });
        match checked {
            Ok((document, size, pushed, said)) => {
                let cells: usize = document.experiment.cells.values().map(|cell| cell.count()).sum();
                let (types, title) = (document.experiment.cells.len(), &document.experiment.title);
                // Writing to a text cannot fail.
                let _ = writeln!(words, "{}: good: \"{title}\", {}", path.display(), counted(cells, types));
                for notice in &said {
                    let _ = writeln!(words, "{}: {notice}", path.display());
                }
                good.push(json!({
                    "path": path_text(path),
                    "title": title,
                    "cells": cells,
                    "types": types,
                    "atoms": size.atoms as u64,
                    "memory_bytes": size.memory as u64,
                    "result_bytes": size.result as u64,
                    "cells_pushed_apart": pushed.cells,
                    "notices": said,
                }));
            }
            Err(Error::Input(found)) => faults.extend(found),
            Err(other) => return Err(other),
        }
    }
    let report = Report { words, ..Report::default() }.fact("documents", good);
    if faults.is_empty() {
        return Ok(report);
    }
    if !args.json {
        report.print("check", super::report::Form::Words)?;
    }
    Err(Error::Input(faults))
}

/// Atoms of a mesh above which it takes long to work out how stiff it is: half a minute for 40 000.
const FINE: f64 = 20_000.0;

/// Says what is waited for where a mesh is so fine that to check it takes long.
fn tell_of_fine_meshes(path: &Path, document: &Document) {
    let finest = Size::of_cells(document).finest;
    if finest > FINE && document.memory.is_none_or(|most| Size::of_cells(document).memory <= most as f64) {
        say(&format!("{}: working out how stiff a mesh of {finest:.0} atoms is, which takes its time", path.display()));
    }
}

/// Looks whether cells overlap at the start, where they touch, or tools: only then they have to be built.
fn settled(document: &Document, prepared: Prepared) -> Result<PushedApart> {
    if prepared.model.contact.is_none() && prepared.model.obstacles.iter().all(|obstacle| obstacle.is_flat()) {
        return Ok(PushedApart::default());
    }
    let progress = Mutex::new(Progress::default());
    let tell = |what| progress.lock().unwrap_or_else(PoisonError::into_inner).settle(what);
    let settled = settle_start_told(document, &mut prepared.build(), &tell);
    progress.into_inner().unwrap_or_else(PoisonError::into_inner).end();
    settled
}

/// "1 cell", "12 cells of 2 types".
fn counted(cells: usize, types: usize) -> String {
    let cells = if cells == 1 { "1 cell".to_owned() } else { format!("{cells} cells") };
    if types == 1 { cells } else { format!("{cells} of {types} types") }
}
