//! The text of a document as a tree that remembers where everything stands; `--set` changes it.

use crate::error::{Fault, Location, Source};
use indexmap::IndexMap;
use std::ops::Range;
use std::sync::Arc;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

mod set;
mod steps;

use steps::{Name, steps};

/// A value and where it stands.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) source: Arc<Source>,
    /// Bytes of the key, if the value has one.
    pub(super) key: Option<Range<usize>>,
    /// Bytes of the value; of the header for a table that has one.
    pub(super) span: Range<usize>,
    pub(super) value: Value,
}

/// What TOML can say.
#[derive(Debug, Clone)]
pub(super) enum Value {
    Table(IndexMap<String, Node>),
    List(Vec<Node>),
    Text(String),
    Integer(i64),
    Number(f64),
    Truth(bool),
    Date(String),
}

impl Node {
    /// Reads a text.
    ///
    /// # Errors
    /// All faults of syntax.
    pub(super) fn parse(source: &Arc<Source>) -> Result<Self, Vec<Fault>> {
        let (table, errors) = DeTable::parse_recoverable(&source.text);
        if !errors.is_empty() {
            return Err(syntax_faults(source, &errors));
        }
        let mut faults = Vec::new();
        let value = table_value(source, 0, table.get_ref(), &mut faults);
        let root = Self { source: source.clone(), key: None, span: 0..0, value };
        if faults.is_empty() { Ok(root) } else { Err(faults) }
    }

    /// "a text", "a list" …
    pub(super) fn kind(&self) -> &'static str {
        match self.value {
            Value::Table(_) => "a table",
            Value::List(_) => "a list",
            Value::Text(_) => "a text",
            Value::Integer(_) => "a whole number",
            Value::Number(_) => "a number",
            Value::Truth(_) => "true or false",
            Value::Date(_) => "a date",
        }
    }

    /// The value as it is written.
    pub(super) fn written(&self) -> &str {
        &self.source.text[self.span.clone()]
    }

    /// Where the value stands; its key when the value goes over several lines.
    pub(super) fn location(&self, label: impl Into<String>) -> Location {
        let written = self.written();
        let span = match &self.key {
            Some(key) if written.contains('\n') => key.clone(),
            _ => self.span.start..self.span.start + written.find('\n').unwrap_or(written.len()),
        };
        Location { source: self.source.clone(), start: span.start, length: span.len(), label: label.into() }
    }

    /// Where the key stands; the value if it has none.
    pub(super) fn key_location(&self, label: impl Into<String>) -> Location {
        let Some(key) = &self.key else { return self.location(label) };
        Location { source: self.source.clone(), start: key.start, length: key.len(), label: label.into() }
    }

    /// Where some bytes of a text stand; the whole text when its escapes hide them.
    pub(super) fn location_in_text(&self, at: Range<usize>, label: impl Into<String>) -> Location {
        let (written, mut location) = (self.written(), self.location(label));
        let Value::Text(text) = &self.value else { return location };
        let quoted = written.len() == text.len() + 2 && written.get(1..=text.len()) == Some(text.as_str());
        if (quoted || written == text) && at.end <= text.len() {
            location.start = self.span.start + at.start + usize::from(quoted);
            location.length = at.len();
        }
        location
    }

    /// Goes along a path as far as the tree does: the last node reached and whether that is the end of the path.
    pub(super) fn follow(&self, path: &str) -> (&Self, bool) {
        let Ok(steps) = steps(path) else { return (self, false) };
        let mut node = self;
        for step in steps {
            let next = match (&node.value, &step.name) {
                (Value::Table(table), Name::Key(key)) => table.get(key),
                (Value::List(list), Name::Entry(index)) => list.get(*index),
                _ => None,
            };
            match next {
                Some(next) => node = next,
                None => return (node, false),
            }
        }
        (node, true)
    }

    /// The same as a plain value, for `serde`.
    pub(super) fn plain(&self) -> toml::Value {
        match &self.value {
            Value::Table(table) => {
                toml::Value::Table(table.iter().map(|(key, node)| (key.clone(), node.plain())).collect())
            }
            Value::List(list) => toml::Value::Array(list.iter().map(Self::plain).collect()),
            Value::Text(text) => toml::Value::String(text.clone()),
            Value::Integer(number) => toml::Value::Integer(*number),
            Value::Number(number) => toml::Value::Float(*number),
            Value::Truth(truth) => toml::Value::Boolean(*truth),
            Value::Date(date) => toml::Value::String(date.clone()),
        }
    }
}

fn node_of(source: &Arc<Source>, shift: usize, spanned: &Spanned<DeValue>, faults: &mut Vec<Fault>) -> Node {
    let span = spanned.span().start + shift..spanned.span().end + shift;
    let value = match spanned.get_ref() {
        DeValue::Table(table) => table_value(source, shift, table, faults),
        DeValue::Array(list) => Value::List(list.iter().map(|entry| node_of(source, shift, entry, faults)).collect()),
        DeValue::String(text) => Value::Text(text.clone().into_owned()),
        DeValue::Boolean(truth) => Value::Truth(*truth),
        DeValue::Datetime(date) => Value::Date(date.to_string()),
        DeValue::Float(float) => Value::Number(float.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(number) => Value::Integer(number),
            Err(_) => {
                let (length, label) = (span.len(), "too large".to_owned());
                let location = Location { source: source.clone(), start: span.start, length, label };
                let fault = Fault::new(format!("{} is too large a whole number", integer.as_str())).at(location);
                faults.push(fault.help("whole numbers go to 9223372036854775807; write a decimal point for a number"));
                Value::Integer(0)
            }
        },
    };
    Node { source: source.clone(), key: None, span, value }
}

fn table_value(source: &Arc<Source>, shift: usize, table: &DeTable, faults: &mut Vec<Fault>) -> Value {
    let entries = table.iter().map(|(key, value)| {
        let mut node = node_of(source, shift, value, faults);
        node.key = Some(key.span().start + shift..key.span().end + shift);
        (key.get_ref().clone().into_owned(), node)
    });
    Value::Table(entries.collect())
}

/// Faults of syntax, one for each line: what follows on the same line is mostly an echo.
fn syntax_faults(source: &Arc<Source>, errors: &[toml::de::Error]) -> Vec<Fault> {
    let mut faults = Vec::new();
    let (mut last_line, mut line, mut counted) = (None, 0, 0);
    let mut errors: Vec<_> = errors.iter().collect();
    errors.sort_by_key(|error| error.span().map(|span| span.start));
    for error in errors {
        let span = error.span().unwrap_or(0..0);
        let start =
            (0..=span.start.min(source.text.len())).rev().find(|at| source.text.is_char_boundary(*at)).unwrap_or(0);
        line += source.text[counted..start].matches('\n').count();
        counted = start;
        if last_line.replace(line) == Some(line) {
            continue;
        }
        let inside = source.text.get(start..span.end.min(source.text.len())).unwrap_or("");
        let length = inside.find('\n').unwrap_or(inside.len());
        let message = error.message().lines().collect::<Vec<_>>().join("; ");
        let location = Location { source: source.clone(), start, length, label: "here".into() };
        let fault = Fault::new(format!("this is not TOML: {message}")).at(location);
        faults.push(fault.help(syntax_help(line_at(&source.text, start), &message)));
    }
    faults
}

/// The line of a text that has a position between characters.
fn line_at(text: &str, at: usize) -> &str {
    let start = text[..at].rfind('\n').map_or(0, |end| end + 1);
    &text[start..text[at..].find('\n').map_or(text.len(), |length| at + length)]
}

/// What to do about a fault of syntax, guessed from its line.
fn syntax_help(line: &str, message: &str) -> String {
    let text = line.trim();
    if message.contains("duplicate key") {
        return "a key and a [table] may be given once only: keep one of them, or merge the two".to_owned();
    }
    if let Some((key, value)) = text.split_once('=') {
        let value = value.split('#').next().unwrap_or("").trim();
        let bare = !value.is_empty() && !value.contains(['"', '\'', '[', '{', ',']);
        if bare {
            return format!("texts and quantities stand in quotes: {} = \"{value}\"", key.trim());
        }
        if value.is_empty() {
            return format!("give `{}` a value, or remove the line", key.trim());
        }
        return "check quotes, brackets and commas of this line".to_owned();
    }
    "a line is [table] or key = value; a comment begins with #".to_owned()
}
