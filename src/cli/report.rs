//! What a command has to tell when it ends: a page for people, or one JSON object for scripts.

use crate::error::{Error, Fault, Location, Result, Source};
use serde_json::{Map, Value, json};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How a command tells what it did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Lines for people.
    Words,
    /// One JSON object.
    Json,
}

/// What a command did.
#[derive(Debug, Default)]
pub struct Report {
    /// Lines for people, each ended.
    pub words: String,
    /// What the JSON object says besides `command` and `ok`.
    pub facts: Map<String, Value>,
    /// What failed though the command did its work: it is told after the words, and decides the exit status.
    pub failure: Option<Error>,
    /// What goes on after all is told.
    pub after: After,
}

/// Work that is done once a report is printed.
#[derive(Default)]
pub struct After(Option<Box<dyn FnOnce()>>);

impl After {
    /// That work.
    pub fn new(work: impl FnOnce() + 'static) -> Self {
        Self(Some(Box::new(work)))
    }
}

impl std::fmt::Debug for After {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.debug_tuple("After").field(&self.0.is_some()).finish()
    }
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

    /// Prints the report of a command to standard output; what failed is left to be told in words.
    ///
    /// # Errors
    /// [`Error::Machine`] if standard output refuses; a reader that has gone away (`| head`) is no error.
    pub fn print(self, command: &str, form: Form) -> Result<Option<Error>> {
        let Self { words, facts, failure, after } = self;
        match (form, &failure) {
            (Form::Words, _) => print(&words)?,
            (Form::Json, None) => print(&object_text(command, true, facts))?,
            (Form::Json, Some(error)) => {
                let mut all = failure_facts(error);
                all.extend(facts);
                print(&object_text(command, false, all))?;
            }
        }
        if let Some(work) = after.0 {
            work();
        }
        Ok(failure)
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
    object_text(command, false, failure_facts(error))
}

fn failure_facts(error: &Error) -> Map<String, Value> {
    let mut facts = Map::new();
    facts.insert("exit".to_owned(), error.exit_code().into());
    let faults = match error {
        Error::Input(faults) => {
            let mut counter = Counter::default();
            faults.iter().map(|fault| fault_object(fault, &mut counter)).collect()
        }
        Error::Numbers { message, help, kept } => {
            facts.insert("kept".to_owned(), kept.as_deref().map(path_text).into());
            vec![json!({ "message": message, "help": help })]
        }
        Error::Interrupted { time, result } => {
            facts.insert("time_s".to_owned(), json!(time));
            facts.insert("result".to_owned(), path_text(result).into());
            vec![json!({ "message": error.to_string(), "help": "pseudopod resume goes on" })]
        }
        Error::Stopped { message, help } | Error::Machine { message, help } => {
            vec![json!({ "message": message, "help": help })]
        }
    };
    facts.insert("faults".to_owned(), faults.into());
    facts
}

/// Counts lines and columns, from the last location on: faults come in the order of the text, and a hundred thousand of them in one
/// line take no longer than the line.
#[derive(Default)]
struct Counter {
    source: Option<Arc<Source>>,
    at: usize,
    line: usize,
    column: usize,
}

impl Counter {
    /// Line and column of a location, from 1, in characters; those of the end of the text where the location is beyond it.
    fn line_and_column(&mut self, location: &Location) -> (usize, usize) {
        let text = location.source.text.as_str();
        let is_behind = location.start >= self.at;
        if !is_behind || !self.source.as_ref().is_some_and(|source| Arc::ptr_eq(source, &location.source)) {
            *self = Self { source: Some(location.source.clone()), ..Self::default() };
        }
        let end = (self.at..=location.start.min(text.len())).rev().find(|at| text.is_char_boundary(*at));
        for c in text[self.at..end.unwrap_or(self.at)].chars() {
            (self.line, self.column) = if c == '\n' { (self.line + 1, 0) } else { (self.line, self.column + 1) };
            self.at += c.len_utf8();
        }
        (self.line + 1, self.column + 1)
    }
}

/// A fault with its location: line and column from 1, in characters.
fn fault_object(fault: &Fault, counter: &mut Counter) -> Value {
    let mut object = json!({ "message": fault.message, "help": fault.help });
    if let Some(location) = &fault.location {
        let (line, column) = counter.line_and_column(location);
        object["file"] = location.source.name.clone().into();
        object["line"] = line.into();
        object["column"] = column.into();
    }
    object
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn locations_are_counted_on_and_anew() {
        let source = Arc::new(Source { name: "a".into(), text: "aß\nbc\nd".into() });
        let other = Arc::new(Source { name: "b".into(), text: "x\ny".into() });
        let mut counter = Counter::default();
        let mut found = |source: &Arc<Source>, start: usize| {
            counter.line_and_column(&Location { source: source.clone(), start, length: 0, label: String::new() })
        };
        assert_eq!([1, 2, 5, 5, 0].map(|start| found(&source, start)), [(1, 2), (1, 2), (2, 2), (2, 2), (1, 1)]);
        assert_eq!([(&other, 2), (&source, 7)].map(|(source, start)| found(source, start)), [(2, 1), (3, 1)]);
        assert_eq!(found(&source, usize::MAX), (3, 2));
    }
}
