//! The text of a document as a tree that remembers where everything stands; `--set` changes it.

use super::words;
use crate::error::{Fault, Place, Source};
use indexmap::IndexMap;
use std::ops::Range;
use std::sync::Arc;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

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

/// One step of a path: the name of a key or the number of an entry, with its bytes in the path.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Step {
    name: Name,
    at: Range<usize>,
}

#[derive(Debug, Clone, PartialEq)]
enum Name {
    Key(String),
    Entry(usize),
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
    pub(super) fn place(&self, label: impl Into<String>) -> Place {
        let written = self.written();
        let span = match &self.key {
            Some(key) if written.contains('\n') => key.clone(),
            _ => self.span.start..self.span.start + written.find('\n').unwrap_or(written.len()),
        };
        Place { source: self.source.clone(), start: span.start, length: span.len(), label: label.into() }
    }

    /// Where the key stands; the value if it has none.
    pub(super) fn key_place(&self, label: impl Into<String>) -> Place {
        let Some(key) = &self.key else { return self.place(label) };
        Place { source: self.source.clone(), start: key.start, length: key.len(), label: label.into() }
    }

    /// Where some bytes of a text stand; the whole text when its escapes hide them.
    pub(super) fn place_in_text(&self, at: Range<usize>, label: impl Into<String>) -> Place {
        let (written, mut place) = (self.written(), self.place(label));
        let Value::Text(text) = &self.value else { return place };
        let quoted = written.len() == text.len() + 2 && written.get(1..=text.len()) == Some(text.as_str());
        if (quoted || written == text) && at.end <= text.len() {
            place.start = self.span.start + at.start + usize::from(quoted);
            place.length = at.len();
        }
        place
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

    /// Changes one key as `--set a.b[0].c=value` asks, making the tables that lack. The value is TOML if it can be read
    /// as such, else a text.
    ///
    /// # Errors
    /// No `=`, a path that leads through something that has no keys, an entry that a list does not have.
    pub(super) fn set(&mut self, source: &Arc<Source>) -> Result<(), Fault> {
        let text = &source.text;
        let whole =
            |label: &str| Place { source: source.clone(), start: 0, length: text.len(), label: label.to_owned() };
        let Some((path, raw)) = text.split_once('=') else {
            let fault = Fault::new(format!("`--set {text}` gives no value")).at(whole("no `=` here"));
            return Err(fault.help(format!("write --set {text}=VALUE, with quotes if your shell needs them")));
        };
        let steps = steps(path).map_err(|at| {
            let place = Place { source: source.clone(), start: at.start, length: at.len(), label: "here".into() };
            let help = "name a key as in `cells.red.loads[0].force`";
            Fault::new(format!("`{path}` is not the name of a key")).at(place).help(help)
        })?;
        let mut node = self;
        let mut walked = String::new();
        for step in &steps {
            node = node.enter(step, source, &walked)?;
            walked = path[..step.at.end].trim().trim_end_matches(']').to_owned();
            if matches!(step.name, Name::Entry(_)) {
                walked.push(']');
            }
        }
        let start = path.len() + 1 + (raw.len() - raw.trim_start().len());
        let value = match DeValue::parse(raw.trim()) {
            Ok(value) => node_of(source, start, &value, &mut Vec::new()).value,
            Err(_) => Value::Text(raw.trim().to_owned()),
        };
        let key = steps.last().map(|step| step.at.clone());
        *node = Self { source: source.clone(), key, span: start..start + raw.trim().len(), value };
        Ok(())
    }

    /// The node one step further, made if it lacks.
    fn enter(&mut self, step: &Step, source: &Arc<Source>, walked: &str) -> Result<&mut Self, Fault> {
        let place = Place { source: source.clone(), start: step.at.start, length: step.at.len(), label: "here".into() };
        let kind = self.kind();
        let empty = || {
            let value = Value::Table(IndexMap::new());
            Self { source: source.clone(), key: Some(step.at.clone()), span: step.at.clone(), value }
        };
        // A list that is not there yet begins with its entry 0.
        let begins = step.name == Name::Entry(0) && matches!(&self.value, Value::Table(table) if table.is_empty());
        if begins {
            self.value = Value::List(Vec::new());
        }
        match (&mut self.value, &step.name) {
            (Value::Table(table), Name::Key(key)) => Ok(table.entry(key.clone()).or_insert_with(empty)),
            (Value::List(list), Name::Entry(index)) => {
                let length = list.len();
                if *index == length {
                    list.push(empty());
                }
                let entry = list.get_mut(*index);
                entry.ok_or_else(|| {
                    let help = match length {
                        0 => "entries count from 0; entry 0 can be added".to_owned(),
                        _ => format!("entries count from 0 to {}; entry {length} can be added", length - 1),
                    };
                    Fault::new(format!("`{walked}` has {length} entries and no entry {index}")).at(place).help(help)
                })
            }
            (Value::List(_), Name::Key(key)) => {
                let help = format!("name the entry, from 0: `{walked}[0].{key}`");
                Err(Fault::new(format!("`{walked}` is a list and has no key `{key}`")).at(place).help(help))
            }
            (_, Name::Key(key)) => {
                let help = format!("set `{walked}` itself");
                Err(Fault::new(format!("`{walked}` is {kind} and has no key `{key}`")).at(place).help(help))
            }
            (_, Name::Entry(_)) => {
                let help = format!("write `{walked}` without brackets");
                Err(Fault::new(format!("`{walked}` is {kind}, not a list")).at(place).help(help))
            }
        }
    }
}

/// The steps of a path such as `cells.red.loads[0].force`; the bytes at fault if it is not one.
fn steps(path: &str) -> Result<Vec<Step>, Range<usize>> {
    let mut steps = Vec::new();
    let mut start = 0;
    for part in path.split('.') {
        let whole = start..start + part.len();
        let (name, mut brackets) = part.split_at(part.find('[').unwrap_or(part.len()));
        let left = start + name.len() - name.trim_start().len();
        let name_span = left..left + name.trim().len();
        if name_span.is_empty() || name.contains([']', '"', '\'']) {
            return Err(whole);
        }
        steps.push(Step { name: Name::Key(name.trim().to_owned()), at: name_span });
        let mut bracket_start = start + name.len();
        while let Some((index, rest)) = brackets.strip_prefix('[').and_then(|inside| inside.split_once(']')) {
            let end = bracket_start + index.len() + 2;
            let index = index.trim().parse().map_err(|_| bracket_start..end)?;
            steps.push(Step { name: Name::Entry(index), at: bracket_start..end });
            (brackets, bracket_start) = (rest, end);
        }
        if !brackets.trim().is_empty() {
            return Err(whole);
        }
        start = whole.end + 1;
    }
    Ok(steps)
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
                let place = Place { source: source.clone(), start: span.start, length, label };
                let fault = Fault::new(format!("{} is too large a whole number", integer.as_str())).at(place);
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
    let mut last_line = None;
    for error in errors {
        let span = error.span().unwrap_or(0..0);
        let start = span.start.min(source.text.len());
        let line = source.text[..start].matches('\n').count();
        if last_line.replace(line) == Some(line) {
            continue;
        }
        let inside = source.text.get(start..span.end.min(source.text.len())).unwrap_or("");
        let length = inside.find('\n').unwrap_or(inside.len());
        let message = error.message().lines().collect::<Vec<_>>().join("; ");
        let place = Place { source: source.clone(), start, length, label: "here".into() };
        let fault = Fault::new(format!("this is not TOML: {message}")).at(place);
        faults.push(fault.help(syntax_help(source, line, &message)));
    }
    faults
}

/// What to do about a fault of syntax, guessed from its line.
fn syntax_help(source: &Source, line: usize, message: &str) -> String {
    let text = source.text.lines().nth(line).unwrap_or("").trim();
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
    let known = ["[table]", "key = value"];
    let wanted = words::any_of(known);
    format!("a line is {wanted}; a comment begins with #")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree(text: &str) -> Node {
        Node::parse(&Arc::new(Source { name: "test.toml".into(), text: text.into() })).expect("TOML")
    }

    fn set(root: &mut Node, text: &str) -> Result<(), Fault> {
        root.set(&Arc::new(Source { name: "--set".into(), text: text.into() }))
    }

    fn reread(text: &str) -> String {
        text.parse::<toml::Table>().map(|table| toml::Value::Table(table).to_string()).expect("TOML")
    }

    #[test]
    fn set_replaces_adds_and_falls_back_to_text() {
        let mut root = tree("[run]\nuntil = \"1 s\"\n[[loads]]\nforce = 1\n");
        for text in ["run.until=10 s", "run.integrator.step = \"2 s\"", "loads[0].force=[1, 2]", "loads[1].force=3"] {
            set(&mut root, text).expect(text);
        }
        assert_eq!(
            root.plain().to_string(),
            reread(
                "[run]\nuntil = \"10 s\"\nintegrator.step = \"2 s\"\n[[loads]]\nforce = [1, 2]\n[[loads]]\nforce = 3\n"
            )
        );
        let (node, whole) = root.follow("run.integrator.step");
        assert!(whole && node.written() == "\"2 s\"");
    }

    #[test]
    fn set_refuses_what_leads_nowhere() {
        let mut root = tree("a = 1\nb = [1, 2]\n");
        for (text, message) in [
            ("a", "`--set a` gives no value"),
            ("a.c=1", "`a` is a whole number and has no key `c`"),
            ("a[0]=1", "`a` is a whole number, not a list"),
            ("b.c=1", "`b` is a list and has no key `c`"),
            ("b[7]=1", "`b` has 2 entries and no entry 7"),
            ("b[x]=1", "`b[x]` is not the name of a key"),
            ("b..c=1", "`b..c` is not the name of a key"),
        ] {
            assert_eq!(set(&mut root, text).expect_err(text).message, message);
        }
    }
}
