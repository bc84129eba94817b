//! The plan of a study: a table with a row for each run, `runs.csv`, and what else a run needs, `plan.json`, in one folder.

use super::design::{Points, run_seed};
use super::document::{Design, StudyDocument};
use super::variation::Column;
use crate::error::{Error, Fault, Result};
use crate::experiment::Document;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
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
        let refused = |path: &Path, error: std::io::Error| Error::Machine {
            message: format!("{} could not be written: {error}", path.display()),
            help: "name a folder that you may write to with -o".into(),
        };
        let runs = self.folder.join("runs");
        std::fs::create_dir_all(&runs).map_err(|error| refused(&runs, error))?;
        let facts = format!("{:#}\n", serde_json::to_value(&self.facts).unwrap_or_default());
        // The plan comes last: without it there is no study in the folder.
        for (name, text) in [(RUNS_FILE, table(&self.facts.parameters, &self.runs)), (PLAN_FILE, facts)] {
            let path = self.folder.join(name);
            std::fs::write(&path, text).map_err(|error| refused(&path, error))?;
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
            let path = self.folder.join(name);
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

/// The table of runs.
fn table(columns: &[Column], runs: &[Run]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let titles = columns.iter().map(Column::title);
    let titles = ["run".to_owned()].into_iter().chain(titles).chain(["replicate", "seed", "output"].map(String::from));
    // Writing to memory cannot fail, and all rows have as many fields.
    let _ = writer.write_record(titles);
    for run in runs {
        let output = run.output.to_string_lossy().replace('\\', "/");
        let ends = [run.replicate.to_string(), run.seed.to_string(), output];
        let _ = writer.write_record([run.number.to_string()].iter().chain(&run.cells).chain(&ends));
    }
    String::from_utf8_lossy(&writer.into_inner().unwrap_or_default()).into_owned()
}

/// Reads the table of runs, whose bytes are known to be those that were written.
fn parse(text: &str, facts: &Facts, path: &Path) -> Result<Vec<Run>> {
    let damaged = || {
        let fault = Fault::new(format!("{} does not fit {PLAN_FILE} beside it", path.display()));
        Error::input(fault.help("plan the study again, with --force"))
    };
    let width = facts.parameters.len();
    let mut runs = Vec::new();
    for (index, record) in (0..).zip(csv::Reader::from_reader(text.as_bytes()).into_records()) {
        let record = record.map_err(|_| damaged())?;
        let field = |number: usize| record.get(number).ok_or_else(damaged);
        let number: u32 = field(0)?.parse().map_err(|_| damaged())?;
        if number != index + 1 || record.len() != width + 4 {
            return Err(damaged());
        }
        runs.push(Run {
            number,
            point: index % facts.points.max(1) + 1,
            replicate: field(width + 1)?.parse().map_err(|_| damaged())?,
            seed: field(width + 2)?.parse().map_err(|_| damaged())?,
            cells: (1..=width).map(|cell| field(cell).map(str::to_owned)).collect::<Result<_>>()?,
            output: PathBuf::from(field(width + 3)?),
        });
    }
    if runs.is_empty() { Err(damaged()) } else { Ok(runs) }
}

/// A number by which contents are told apart: FNV-1a in 64 bits, in hexadecimal.
pub fn fingerprint(bytes: &[u8]) -> String {
    let hash = bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3));
    format!("{hash:016x}")
}

/// A path from the root, without links where it leads somewhere.
fn absolute(path: &Path) -> PathBuf {
    if let Ok(whole) = path.canonicalize() {
        return whole;
    }
    // A folder that is still to be made lies in one that is there, or in one to be made, too.
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    match (path.parent(), path.file_name()) {
        (Some(parent), Some(name)) => absolute(parent).join(name),
        _ => path,
    }
}

/// A path from a folder, both from the root. Where the two have no folder in common it stays as it is.
fn relative(path: &Path, folder: &Path) -> PathBuf {
    let (path_parts, folder_parts): (Vec<_>, Vec<_>) = (path.components().collect(), folder.components().collect());
    let shared = path_parts.iter().zip(&folder_parts).take_while(|(one, other)| one == other).count();
    if shared <= 1 {
        return path.to_path_buf();
    }
    let up = (shared..folder_parts.len()).map(|_| std::path::Component::ParentDir);
    up.chain(path_parts[shared..].iter().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::value::Kind;

    #[test]
    fn paths_lead_from_one_folder_to_another() {
        let from = |path: &str, folder: &str| relative(Path::new(path), Path::new(folder)).display().to_string();
        assert_eq!(from("/a/b/c.toml", "/a/b"), "c.toml");
        assert_eq!(from("/a/b/c.toml", "/a/b/study/one"), "../../c.toml");
        assert_eq!(from("/a/x/c.toml", "/a/b"), "../x/c.toml");
        assert_eq!(from("/x/c.toml", "/a/b"), "/x/c.toml");
    }

    #[test]
    fn a_table_is_read_as_it_was_written() {
        let column = |name: &str, kind| Column { name: name.into(), key: name.into(), kind, log: false };
        let parameters =
            vec![column("strength, of all", Kind::Quantity { unit: "pN/um^2".into() }), column("word", Kind::Text)];
        let run = |number: u32, point, replicate| Run {
            number,
            point,
            replicate,
            seed: u64::from(number) << 40,
            cells: vec!["0.1".into(), format!("a \"b\", {point}")],
            output: format!("runs/{number:05}.vtkhdf").into(),
        };
        let runs = vec![run(1, 1, 1), run(2, 2, 1), run(3, 1, 2), run(4, 2, 2)];
        let text = table(&parameters, &runs);
        assert!(text.starts_with("run,\"strength, of all (pN/um^2)\",word,replicate,seed,output\n1,0.1,"), "{text}");
        let facts = Facts {
            version: String::new(),
            title: String::new(),
            experiment: PathBuf::new(),
            sets: vec!["run.until=1 s".into()],
            seed: 0,
            design: Design::Grid,
            points: 2,
            replicates: 2,
            parameters,
            measures: Vec::new(),
            files: BTreeMap::new(),
            runs: fingerprint(text.as_bytes()),
            study: String::new(),
        };
        assert_eq!(parse(&text, &facts, Path::new("runs.csv")).unwrap(), runs);
        let wanted = ["run.until=1 s", "strength, of all=\"0.1 pN/um^2\"", "word='a \"b\", 1'", "seed=1099511627776"];
        assert_eq!(facts.sets_of(&runs[0]), wanted);
    }
}
