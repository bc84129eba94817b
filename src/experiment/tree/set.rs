//! `--set`, which changes the value at the path of a key.

use super::steps::{Name, Step, steps};
use super::{Node, Value, node_of};
use crate::error::{Fault, Location, Source};
use indexmap::IndexMap;
use std::sync::Arc;
use toml::de::DeValue;

impl Node {
    /// Changes one key as `--set a.b[0].c=value` asks, making the tables that lack. The value is TOML if it can be read
    /// as such, else a text.
    ///
    /// # Errors
    /// No `=`, a path that leads through something that has no keys, an entry that a list does not have.
    pub(in crate::experiment) fn set(&mut self, source: &Arc<Source>) -> Result<(), Fault> {
        let text = &source.text;
        let whole =
            |label: &str| Location { source: source.clone(), start: 0, length: text.len(), label: label.to_owned() };
        let Some((path, raw)) = text.split_once('=') else {
            let fault = Fault::new(format!("`--set {text}` gives no value")).at(whole("no `=` here"));
            return Err(fault.help(format!("write --set {text}=VALUE, with quotes if your shell needs them")));
        };
        let steps = steps(path).map_err(|at| {
            let location = Location { source: source.clone(), start: at.start, length: at.len(), label: "here".into() };
            let help = "name a key as in `cells.red.loads[0].force`";
            Fault::new(format!("`{path}` is not the name of a key")).at(location).help(help)
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
        let location =
            Location { source: source.clone(), start: step.at.start, length: step.at.len(), label: "here".into() };
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
                        0 => "it is empty; entry 0 can be added".to_owned(),
                        1 => "its only entry is 0; entry 1 can be added".to_owned(),
                        _ => format!("entries count from 0 to {}; entry {length} can be added", length - 1),
                    };
                    Fault::new(format!("`{walked}` has no entry {index}")).at(location).help(help)
                })
            }
            (Value::List(_), Name::Key(key)) => {
                let help = format!("name the entry, from 0: `{walked}[0].{key}`");
                Err(Fault::new(format!("`{walked}` is a list and has no key `{key}`")).at(location).help(help))
            }
            (_, Name::Key(key)) => {
                let help = format!("set `{walked}` itself");
                Err(Fault::new(format!("`{walked}` is {kind} and has no key `{key}`")).at(location).help(help))
            }
            (_, Name::Entry(_)) => {
                let help = format!("write `{walked}` without brackets");
                Err(Fault::new(format!("`{walked}` is {kind}, not a list")).at(location).help(help))
            }
        }
    }
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
            ("b[7]=1", "`b` has no entry 7"),
            ("b[x]=1", "`b[x]` is not the name of a key"),
            ("b..c=1", "`b..c` is not the name of a key"),
        ] {
            assert_eq!(set(&mut root, text).expect_err(text).message, message);
        }
    }
}
