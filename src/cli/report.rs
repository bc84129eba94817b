//! What a command has to tell when it ends: a page for people, or one JSON object for scripts.

use crate::error::{Error, Fault, Result};
use serde_json::{Map, Value, json};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// How a command tells what it did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Lines for people.
    Words,
    /// One JSON object.
    Json,
}

/// What a command did.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    /// Lines for people, each ended.
    pub words: String,
    /// What the JSON object says besides `command` and `ok`.
    pub facts: Map<String, Value>,
}

impl Report {
    /// A report of files that were written: one line each for people, `result` and `files` for scripts.
    pub fn of_files(result: &Path, files: &[PathBuf]) -> Self {
        let words = files.iter().map(|path| format!("{}\n", path.display())).collect();
        Self { words, ..Self::default() }.fact("result", path_text(result)).fact("files", paths(files))
    }

    /// Adds a fact.
    pub fn fact(mut self, name: &str, value: impl Into<Value>) -> Self {
        self.facts.insert(name.to_owned(), value.into());
        self
    }

    /// Prints the report of a command to standard output.
    ///
    /// # Errors
    /// [`Error::Machine`] if standard output refuses; a reader that has gone away (`| head`) is no error.
    pub fn print(self, command: &str, form: Form) -> Result<()> {
        match form {
            Form::Words => print(&self.words),
            Form::Json => print_object(command, true, self.facts),
        }
    }
}

/// Prints the JSON object of a command that failed: `exit`, then what is known of why.
///
/// # Errors
/// As [`Report::print`].
pub fn print_failure(command: &str, error: &Error) -> Result<()> {
    print(&failure_text(command, error))
}

/// The same as a text.
pub fn failure_text(command: &str, error: &Error) -> String {
    let mut facts = Map::new();
    facts.insert("exit".to_owned(), error.exit_code().into());
    let faults = match error {
        Error::Input(faults) => faults.iter().map(fault_object).collect(),
        Error::Numbers { message, help, kept } => {
            facts.insert("kept".to_owned(), kept.as_deref().map(path_text).into());
            vec![json!({ "message": message, "help": help })]
        }
        Error::Interrupted { time, result } => {
            facts.insert("time_s".to_owned(), json!(time));
            facts.insert("result".to_owned(), path_text(result).into());
            vec![json!({ "message": error.to_string(), "help": "pseudopod resume goes on" })]
        }
        Error::Machine { message, help } => vec![json!({ "message": message, "help": help })],
    };
    facts.insert("faults".to_owned(), faults.into());
    object_text(command, false, facts)
}

/// A fault with its location: line and column from 1, in characters.
fn fault_object(fault: &Fault) -> Value {
    let mut object = json!({ "message": fault.message, "help": fault.help });
    if let Some(location) = &fault.location {
        let text = &location.source.text;
        let before = text.get(..location.start).unwrap_or(text);
        object["file"] = location.source.name.clone().into();
        object["line"] = (1 + before.matches('\n').count()).into();
        object["column"] = (1 + before.rsplit('\n').next().unwrap_or_default().chars().count()).into();
    }
    object
}

fn print_object(command: &str, ok: bool, facts: Map<String, Value>) -> Result<()> {
    print(&object_text(command, ok, facts))
}

fn object_text(command: &str, ok: bool, facts: Map<String, Value>) -> String {
    let mut object = Map::new();
    object.insert("command".to_owned(), command.into());
    object.insert("ok".to_owned(), ok.into());
    object.extend(facts);
    format!("{:#}\n", Value::Object(object))
}

fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Error::Machine {
            message: format!("standard output cannot be written: {error}"),
            help: "free some space, or send the output elsewhere".into(),
        }),
        _ => Ok(()),
    }
}

/// Paths as JSON texts.
pub fn paths(files: &[PathBuf]) -> Vec<String> {
    files.iter().map(|path| path_text(path)).collect()
}

/// A path as a JSON text.
pub fn path_text(path: &Path) -> String {
    path.display().to_string()
}
