//! The plan of a study: a table with a row for each run, `runs.csv`, and what else a run needs, `plan.json`, in one folder.

use super::design::{Points, run_seed};
use super::document::StudyDocument;
use super::facts::{Facts, Measured, Run};
use super::paths::{absolute, fingerprint, refused, relative, tidy};
use super::runs_table::{parse, table};
use crate::error::{Error, Fault, Result};
use crate::experiment::Document;
use std::collections::BTreeMap;
use std::fs::{File, TryLockError};
use std::path::{Path, PathBuf};

/// The table of runs in the folder of a study.
pub const RUNS_FILE: &str = "runs.csv";
/// What else is known of them.
pub const PLAN_FILE: &str = "plan.json";

/// A plan in its folder.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The folder.
    pub folder: PathBuf,
    /// What all runs share.
    pub facts: Facts,
    /// The runs, by number.
    pub runs: Vec<Run>,
}

impl Plan {
    /// The plan of a study whose points are known, for a folder. `document` is its experiment, `read` are all files that its runs read.
    pub fn new(study: &StudyDocument, points: Points, document: &Document, read: &[PathBuf], folder: &Path) -> Self {
        let base = absolute(folder);
        let mut files = BTreeMap::new();
        for path in read {
            // What cannot be read, no run needs: the points were built without it.
            let Ok(bytes) = crate::files::read(path) else { continue };
            files.insert(relative(&absolute(path), &base), fingerprint(&bytes));
        }
        let said = &study.study;
        let number = points.rows.len() as u32;
        // All points once, then all of them again: so the first runs show the whole study, and more replicates leave all numbers as they are.
        let runs: Vec<Run> = (0..said.replicates)
            .flat_map(|replicate| (0..number).map(move |point| (replicate, point)))
            .map(|(replicate, point)| {
                let run = replicate * number + point + 1;
                Run {
                    number: run,
                    point: point + 1,
                    replicate: replicate + 1,
                    seed: run_seed(said.seed, point, replicate),
                    cells: points.rows[point as usize].clone(),
                    output: Path::new("runs").join(format!("{run:05}.vtkhdf")),
                }
            })
            .collect();
        let measures = document.experiment.measure.iter().map(|(name, measure)| Measured {
            name: name.clone(),
            unit: if measure.unit.is_empty() { "1".into() } else { measure.unit.clone() },
            description: measure.description.clone().unwrap_or_default(),
        });
        let facts = Facts {
            version: env!("CARGO_PKG_VERSION").into(),
            title: said.title.clone(),
            experiment: relative(&absolute(&study.experiment()), &base),
            sets: said.set.clone(),
            seed: said.seed,
            design: said.design,
            points: number,
            replicates: said.replicates,
            measures: measures.collect(),
            files,
            runs: fingerprint(table(&points.columns, &runs).as_bytes()),
            parameters: points.columns,
            study: study.source.text.clone(),
        };
        Self { folder: folder.to_path_buf(), facts, runs }
    }

    /// Writes the plan into its folder. One that is there already is left alone.
    ///
    /// # Errors
    /// [`Error::Input`] if another plan is there and is not to be replaced; [`Error::Machine`] when the disk refuses.
    pub fn write(&self, replaces: Replaces) -> Result<()> {
        let path = self.folder.join(PLAN_FILE);
        if path.exists() && replaces == Replaces::Nothing {
            let known = Self::read(&self.folder)?;
            if known.facts != (Facts { version: known.facts.version.clone(), ..self.facts.clone() }) {
                let message = format!(
                    "{} holds the plan of another study, or of this one before it changed",
                    self.folder.display()
                );
                let help = "name another folder with -o; or replace the plan with --force, if the runs of the other are not needed";
                return Err(Error::input(Fault::new(message).help(help)));
            }
            return Ok(());
        }
        let runs = self.folder.join("runs");
        std::fs::create_dir_all(&runs).map_err(|error| refused(&runs, &error))?;
        let facts = format!("{:#}\n", serde_json::to_value(&self.facts).unwrap_or_default());
        // The plan comes last: without it there is no study in the folder.
        for (name, text) in [(RUNS_FILE, table(&self.facts.parameters, &self.runs)), (PLAN_FILE, facts)] {
            let path = self.folder.join(name);
            std::fs::write(&path, text).map_err(|error| refused(&path, &error))?;
        }
        Ok(())
    }

    /// Reads the plan in a folder, and makes sure that its table is as it was written.
    ///
    /// # Errors
    /// [`Error::Input`] if there is none, or it was changed.
    pub fn read(folder: &Path) -> Result<Self> {
        let path = folder.join(PLAN_FILE);
        let text = crate::files::read_text(&path).map_err(|error| {
            let fault = Fault::new(format!(
                "there is no study in {}: {} cannot be read: {error}",
                folder.display(),
                path.display()
            ));
            Error::input(fault.help("make one with: pseudopod sweep plan STUDY -o FOLDER"))
        })?;
        let facts: Facts = serde_json::from_str(&text).map_err(|error| {
            let fault = Fault::new(format!("{} is not the plan of a study: {error}", path.display()));
            Error::input(fault.help("plan the study again, with --force"))
        })?;
        let path = folder.join(RUNS_FILE);
        let text = crate::files::read_text(&path).map_err(|error| {
            let fault = Fault::new(format!("{} cannot be read: {error}", path.display()));
            Error::input(fault.help("plan the study again, with --force"))
        })?;
        if fingerprint(text.as_bytes()) != facts.runs {
            let fault = Fault::new(format!("{} is not as it was planned", path.display()));
            return Err(Error::input(
                fault.help("change the study and plan it again; runs are made as they were planned only"),
            ));
        }
        let runs = parse(&text, &facts, &path)?;
        Ok(Self { folder: folder.to_path_buf(), facts, runs })
    }

    /// Makes sure that all files that runs read are as they were when the study was planned.
    ///
    /// # Errors
    /// [`Error::Input`] with a fault for each that is not.
    pub fn check_files(&self) -> Result<()> {
        let mut faults = Vec::new();
        for (name, known) in &self.facts.files {
            let path = tidy(&self.folder.join(name));
            let changed = match crate::files::read(&path) {
                Ok(bytes) if fingerprint(&bytes) == *known => continue,
                Ok(_) => "changed since the study was planned".to_owned(),
                Err(error) => format!("cannot be read: {error}"),
            };
            let fault = Fault::new(format!("{} {changed}", path.display()));
            faults.push(fault.help("put it back as it was, or plan the study again in another folder"));
        }
        if faults.is_empty() { Ok(()) } else { Err(Error::Input(faults)) }
    }

    /// Makes sure that nobody else makes the runs of the folder, for as long as the file is open. `command` is who does.
    ///
    /// # Errors
    /// [`Error::Input`] while somebody else does; [`Error::Machine`] when the disk refuses.
    pub fn claim(&self, command: &str) -> Result<File> {
        let path = self.folder.join(PLAN_FILE);
        let file = File::open(&path).map_err(|error| refused(&path, &error))?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => {
                let name = self.folder.display();
                let fault = Fault::new(format!("the runs of {name} are being made by another `{command}`"));
                Err(Error::input(
                    fault
                        .help("wait until it has ended, or stop it with Ctrl-C: its runs go on from their checkpoints"),
                ))
            }
            // A file system without locks is trusted.
            Ok(()) | Err(TryLockError::Error(_)) => Ok(file),
        }
    }

    /// The experiment document as the system can open it from anywhere.
    pub fn experiment(&self) -> PathBuf {
        absolute(&self.folder.join(&self.facts.experiment))
    }

    /// A run by its number.
    ///
    /// # Errors
    /// [`Error::Input`] if there is none with that number.
    pub fn run(&self, number: u32) -> Result<&Run> {
        let found = (number as usize).checked_sub(1).and_then(|index| self.runs.get(index));
        found.ok_or_else(|| {
            let table = self.folder.join(RUNS_FILE);
            let fault = Fault::new(format!("{} has no run {number}", table.display()));
            Error::input(fault.help(format!("runs are numbered from 1 to {}", self.runs.len())))
        })
    }
}

/// What a plan may replace.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Replaces {
    /// Nothing: another plan is an error.
    Nothing,
    /// The plan that is there.
    Plan,
}
