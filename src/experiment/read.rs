//! Reads documents and checks them as a whole.

use super::document::{Document, near_file};
use super::schema::schema_of_experiments;
use super::semantics::Files;
use super::tree::{Node, Value};
use super::{Experiment, check, semantics};
use crate::error::{Error, Fault, Location, Result, Source};
use crate::units::Time;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

impl Document {
    /// Reads and checks a file. Each of `sets` is a change `key=value` made before checking.
    ///
    /// # Errors
    /// [`Error::Input`] with all faults of the text in its order, or with the reason why there is no text.
    pub fn read(path: &Path, sets: &[String]) -> Result<Self> {
        let name = path.display().to_string();
        let bytes = crate::files::read(path).map_err(|error| Error::input(unreadable(path, &error)))?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let offset = error.utf8_error().valid_up_to();
            let line = 1 + error.as_bytes()[..offset].iter().filter(|byte| **byte == b'\n').count();
            let fault = Fault::new(format!("{name}:{line}: byte {offset} is not UTF-8 text"));
            Error::input(fault.help("save the document as UTF-8; a result file is opened by `pseudopod info`"))
        })?;
        let base_dir = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Self::parse(&name, &text, base_dir, sets)
    }

    /// Checks a text. `name` stands in messages; paths in the text start from `base_dir`.
    ///
    /// # Errors
    /// [`Error::Input`] with all faults, in the order of the text.
    pub fn parse(name: &str, text: &str, base_dir: &Path, sets: &[String]) -> Result<Self> {
        Self::parse_beside(name, text, base_dir, sets, BTreeMap::new())
    }

    /// As [`Document::parse`], with [`equations`](Self::equations) that stand in place of files.
    ///
    /// # Errors
    /// As [`Document::parse`].
    pub fn parse_beside(
        name: &str,
        text: &str,
        base_dir: &Path,
        sets: &[String],
        equations: BTreeMap<String, String>,
    ) -> Result<Self> {
        Self::parse_with(Files::Needed, name, text, base_dir, sets, equations)
    }

    /// As [`Document::parse_beside`] of what has been run already, to look at its result: meshes and tables that it names may be gone since.
    ///
    /// # Errors
    /// As [`Document::parse`], but for files that are not there.
    pub fn parse_recorded(
        name: &str,
        text: &str,
        base_dir: &Path,
        sets: &[String],
        equations: BTreeMap<String, String>,
    ) -> Result<Self> {
        Self::parse_with(Files::MayBeGone, name, text, base_dir, sets, equations)
    }

    fn parse_with(
        files: Files,
        name: &str,
        text: &str,
        base_dir: &Path,
        sets: &[String],
        equations: BTreeMap<String, String>,
    ) -> Result<Self> {
        let source = Arc::new(Source { name: name.to_owned(), text: text.to_owned() });
        let mut tree = Node::parse(&source).map_err(Error::Input)?;
        let written_end = end_of(&tree);
        let mut sources = vec![source.clone()];
        let mut faults = Vec::new();
        for set in sets {
            let key = set.split('=').next().unwrap_or_default();
            sources.push(Arc::new(Source { name: format!("--set {key}=…"), text: set.clone() }));
            faults.extend(sources.last().and_then(|source| tree.set(source).err()));
        }
        if let Some(fault) = not_an_experiment(&tree) {
            return Err(Error::input(fault));
        }
        let found = check::check(&tree, schema_of_experiments());
        faults.extend(found.faults);
        if faults.is_empty() {
            let experiment = experiment_of(&tree)?;
            let (sets, base_dir) = (sets.to_vec(), base_dir.to_owned());
            let references = found.references;
            let (memory, left_out) = (None, Vec::new());
            let is_cut_short = written_end.is_some_and(|end| experiment.run.until.value() < end);
            let mut document = Self {
                source,
                sets,
                base_dir,
                experiment,
                equations,
                memory,
                is_cut_short,
                left_out,
                references,
                tree,
            };
            let late;
            (faults, late) = semantics::check(&document, files);
            if faults.is_empty() {
                document.leave_out(&late);
                return Ok(document);
            }
        }
        let order = |fault: &Fault| match &fault.location {
            Some(location) => (sources.iter().position(|source| Arc::ptr_eq(source, &location.source)), location.start),
            None => (None, 0),
        };
        faults.sort_by_key(order);
        Err(Error::Input(faults))
    }

    /// Checks an experiment built in Rust, as if its text had been read. Relative paths start from the working folder.
    ///
    /// # Errors
    /// As [`Document::parse`]; the locations are in the text that the experiment is written as.
    pub fn from_experiment(experiment: Experiment) -> Result<Self> {
        let text = toml::to_string(&experiment).map_err(|error| {
            let fault = Fault::new(format!("the experiment cannot be written as a document: {error}"));
            Error::input(fault.help("numbers must be finite and the seed below 2^63"))
        })?;
        Self::parse("experiment built by a program", &text, Path::new("."), &[])
    }
}

/// The end of the run as the text has it, s; none where there is none that can be read.
fn end_of(tree: &Node) -> Option<f64> {
    match &tree.follow("run.until") {
        (Node { value: Value::Text(text), .. }, true) => text.parse::<Time>().ok().map(Time::value),
        _ => None,
    }
}

/// A document that is not an experiment but what one is expected to measure.
fn not_an_experiment(tree: &Node) -> Option<Fault> {
    let Value::Table(keys) = &tree.value else { return None };
    let claim = keys.get("claim").filter(|_| !keys.contains_key("cells") && !keys.contains_key("run"))?;
    let fault = Fault::new("this is not an experiment but what one is expected to measure");
    let help = "name the experiment itself, usually experiment.toml in the same folder";
    Some(fault.at(claim.key_location("a claim")).help(help))
}

/// What a tree without faults says. The checker has seen everything that `serde` could refuse; should it refuse
/// something all the same, the reader is told what.
fn experiment_of(tree: &Node) -> Result<Experiment> {
    Experiment::deserialize(tree.plain()).map_err(|error| {
        let span = toml::from_str::<Experiment>(&tree.source.text).err().and_then(|error| error.span()).unwrap_or(0..0);
        let location =
            Location { source: tree.source.clone(), start: span.start, length: span.len(), label: "here".into() };
        let message = format!("the document cannot be understood: {}", error.message().trim());
        Error::input(Fault::new(message).at(location).help("compare the key with the schema: `pseudopod schema`"))
    })
}

/// Why a document cannot be read, and what to do.
fn unreadable(path: &Path, error: &std::io::Error) -> Fault {
    let name = path.display();
    if path.is_dir() {
        let fault = Fault::new(format!("{name} is a folder; an experiment document was expected"));
        let inside = path.join("experiment.toml");
        return match inside.is_file() {
            true => fault.help(format!("did you mean {}?", inside.display())),
            false => fault.help("name the document, usually experiment.toml"),
        };
    }
    match error.kind() {
        std::io::ErrorKind::NotFound => {
            let fault = Fault::new(format!("there is no file {name}"));
            match near_file(path) {
                Some(near) => fault.help(format!("did you mean {}?", near.display())),
                None => fault.help("name an experiment document, such as experiments/random_walk/experiment.toml"),
            }
        }
        std::io::ErrorKind::PermissionDenied => {
            Fault::new(format!("{name} may not be read")).help("change its permissions, such as with chmod u+r")
        }
        std::io::ErrorKind::InvalidInput => {
            Fault::new(format!("{name} cannot be read: {error}")).help("save the document to a file first")
        }
        _ => Fault::new(format!("{name} cannot be read: {error}")).help("check the file and the disk it is on"),
    }
}
