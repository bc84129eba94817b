//! What a plan says: what all runs share, and what each is.

use super::document::Design;
use super::variation::Column;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// What all runs of a plan share.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Facts {
    /// Version of the program that planned.
    pub version: String,
    /// What the study is called.
    pub title: String,
    /// The experiment document, from the folder of the plan.
    pub experiment: PathBuf,
    /// Changes of it that hold for all runs.
    pub sets: Vec<String>,
    /// The seed of the study.
    pub seed: u64,
    /// How values were combined.
    pub design: Design,
    /// Points of the design.
    pub points: u32,
    /// Runs of each point.
    pub replicates: u32,
    /// What is varied.
    pub parameters: Vec<Column>,
    /// What the experiment measures.
    pub measures: Vec<Measured>,
    /// Fingerprints of the files that runs read, from the folder of the plan.
    pub files: BTreeMap<PathBuf, String>,
    /// Fingerprint of the table of runs.
    pub runs: String,
    /// The text of the study.
    pub study: String,
}

/// A measure that the experiment declares.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Measured {
    /// Its name.
    pub name: String,
    /// Its unit; `1` for a plain number.
    pub unit: String,
    /// What it is.
    pub description: String,
}

/// A run of a plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Run {
    /// Its number, from 1: that of its row in the table.
    pub number: u32,
    /// Its point of the design, from 1.
    pub point: u32,
    /// Which of the runs of its point, from 1.
    pub replicate: u32,
    /// Its seed.
    pub seed: u64,
    /// Values of the parameters, as tables show them.
    pub cells: Vec<String>,
    /// Its result, from the folder of the plan.
    pub output: PathBuf,
}

impl Facts {
    /// The changes by which a run differs from the experiment, as `--set` takes them.
    pub fn sets_of(&self, run: &Run) -> Vec<String> {
        let varied = sets(&self.parameters, &run.cells);
        self.sets.iter().cloned().chain(varied).chain([format!("seed={}", run.seed)]).collect()
    }
}

/// Values of parameters as `--set` takes them.
pub fn sets<'a>(columns: &'a [Column], cells: &'a [String]) -> impl Iterator<Item = String> + 'a {
    columns.iter().zip(cells).map(|(column, cell)| format!("{}={}", column.key, column.kind.set_text(cell)))
}

impl Run {
    /// What it is called in messages: `run 12 (adhesion = 0.1 pN/um^2, number = 5)`.
    pub fn told(&self, columns: &[Column]) -> String {
        format!("run {} ({})", self.number, told_cells(columns, &self.cells))
    }
}

/// Values of parameters in words.
pub fn told_cells(columns: &[Column], cells: &[String]) -> String {
    let told = columns.iter().zip(cells).map(|(column, cell)| {
        let unit = column.kind.unit().map(|unit| format!(" {unit}"));
        format!("{} = {cell}{}", column.name, unit.unwrap_or_default())
    });
    told.collect::<Vec<_>>().join(", ")
}
