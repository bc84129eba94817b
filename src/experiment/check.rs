//! Walks a document along the schema and finds every fault: keys, types, units, ranges.

use super::tree::{Node, Value};
use crate::error::Fault;
use crate::error::words;
use crate::units::{self, Dimension, UnitError};
use crate::values::{Colour, LengthUnit};
use indexmap::IndexMap;
use serde_json::{Map, Value as Json};
use std::borrow::Cow;

mod asked;
mod bounds;
mod keys;

use asked::{dimension_of, expectation, inherit, json_kind, kinds_of, rewrite, with_purpose, words_of};

/// A text that means something elsewhere: a file, a series, the name of a cell type.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reference {
    /// What the text means, as the schema's `x-text` says.
    pub(super) kind: String,
    /// The path of its key.
    pub(super) path: String,
    /// The text.
    pub(super) text: String,
}

/// What a walk finds.
pub(super) struct Findings {
    pub(super) faults: Vec<Fault>,
    pub(super) references: Vec<Reference>,
}

/// Checks a whole document against its schema.
pub(super) fn check(root: &Node, schema: &Json) -> Findings {
    let mut walk = Walk { definitions: &schema["$defs"], faults: Vec::new(), references: Vec::new() };
    walk.node(root, schema, "");
    Findings { faults: walk.faults, references: walk.references }
}

struct Walk<'a> {
    definitions: &'a Json,
    faults: Vec<Fault>,
    references: Vec<Reference>,
}

/// The keys that the schema allows in one table.
struct Keys {
    /// Keys and the schemas of their values.
    known: IndexMap<String, Json>,
    required: Vec<String>,
    /// Keys of alternatives that were not chosen.
    elsewhere: Vec<String>,
    /// What was chosen, e.g. `shape = "box"`.
    chosen: Option<String>,
    /// The schema of values under names that the user chooses.
    named: Option<Json>,
    /// Keys that there were once, with what to do instead.
    gone: Map<String, Json>,
}

impl Keys {
    /// The names of the keys that are known.
    fn known(&self) -> impl Iterator<Item = &str> {
        self.known.keys().map(String::as_str)
    }
}

impl<'a> Walk<'a> {
    /// Follows `$ref`; what stands beside it comes first.
    fn resolve<'s>(&self, schema: &'s Json) -> Cow<'s, Map<String, Json>>
    where
        'a: 's,
    {
        if let Some(own) = schema.as_object().filter(|own| !own.contains_key("$ref")) {
            return Cow::Borrowed(own);
        }
        let definition =
            |reference: &str| self.definitions[reference.rsplit('/').next().unwrap_or_default()].as_object();
        let mut own = schema.as_object().cloned().unwrap_or_default();
        while let Some(Json::String(reference)) = own.remove("$ref") {
            for (key, value) in definition(&reference).into_iter().flatten() {
                if !own.contains_key(key) {
                    own.insert(key.clone(), value.clone());
                }
            }
        }
        Cow::Owned(own)
    }

    fn node(&mut self, node: &Node, schema: &Json, path: &str) {
        let schema = self.resolve(schema);
        if let Some(words) = words_of(&schema) {
            return self.word(node, &words, path);
        }
        if let Some(dimension) = dimension_of(&schema) {
            return self.quantity(node, &schema, dimension, path);
        }
        let is_table = schema.get("type").is_some_and(|kind| kind == "object") || schema.contains_key("properties");
        let alternatives = schema.get("anyOf").or(schema.get("oneOf")).and_then(Json::as_array);
        if let Some(alternatives) = alternatives.filter(|_| !is_table) {
            let all_tables = alternatives.iter().all(|one| kinds_of(&self.resolve(one)) == ["object"]);
            if !all_tables {
                return self.alternatives(node, &schema, alternatives, path);
            }
        } else if !is_table {
            return self.scalar_or_list(node, &schema, path);
        }
        match &node.value {
            Value::Table(table) => self.table(node, table, &schema, path),
            _ => self.wrong_kind(node, "a table", path, &schema),
        }
    }

    /// A value that may be of several kinds, such as a force or a list of points: chosen by what is written.
    fn alternatives(&mut self, node: &Node, schema: &Map<String, Json>, alternatives: &[Json], path: &str) {
        let kind = json_kind(node);
        let resolved: Vec<_> = alternatives.iter().map(|one| inherit(schema, &self.resolve(one))).collect();
        let fits = |one: &&Map<String, Json>| {
            kinds_of(one).iter().any(|have| *have == kind || have == "number" && kind == "integer")
        };
        let a_number_lacks_its_unit = kind == "integer" || kind == "number";
        let quantity = || resolved.iter().find(|one| a_number_lacks_its_unit && dimension_of(one).is_some());
        match resolved.iter().find(fits).or_else(quantity) {
            Some(one) => self.node(node, &Json::Object(one.clone()), path),
            None => {
                let wanted = resolved.iter().map(expectation).collect::<Vec<_>>().join(" or ");
                self.wrong_kind(node, &wanted, path, schema);
            }
        }
    }

    fn scalar_or_list(&mut self, node: &Node, schema: &Map<String, Json>, path: &str) {
        let Some(kind) = kinds_of(schema).first().cloned() else { return };
        match (kind.as_str(), &node.value) {
            ("array", Value::List(list)) => self.list(node, list, schema, path),
            ("boolean", Value::Truth(truth)) => {
                if schema.get("const").and_then(Json::as_bool).is_some_and(|only| only != *truth) {
                    let fault = Fault::new(format!("`{path}` can only be {}", !truth));
                    self.faults.push(fault.at(node.location("has no meaning")).help("leave the key out instead"));
                }
            }
            ("string", Value::Text(text)) => self.text(node, text, schema, path),
            ("integer", Value::Integer(number)) => self.number_bounds(node, *number as f64, schema, path),
            ("number", Value::Integer(number)) => self.number_bounds(node, *number as f64, schema, path),
            ("number", Value::Number(number)) => self.number_bounds(node, *number, schema, path),
            _ => self.wrong_kind(node, &expectation(schema), path, schema),
        }
    }

    fn list(&mut self, node: &Node, list: &[Node], schema: &Map<String, Json>, path: &str) {
        let size = |key: &str| schema.get(key).and_then(Json::as_u64).map(|size| size as usize);
        let (least, most) = (size("minItems").unwrap_or(0), size("maxItems").unwrap_or(usize::MAX));
        if list.len() < least || list.len() > most {
            let wanted = if least == most { format!("{least}") } else { format!("at least {least}") };
            let entries = if list.len() == 1 { "entry" } else { "entries" };
            let fault = Fault::new(format!("`{path}` has {} {entries}; {wanted} expected", list.len()));
            let label = if least == most { format!("{least} entries expected") } else { "too few".to_owned() };
            self.faults.push(with_purpose(fault.at(node.location(label)), schema));
        }
        let prefix = schema.get("prefixItems").and_then(Json::as_array);
        for (index, entry) in list.iter().enumerate() {
            let path = format!("{path}[{index}]");
            match (prefix.and_then(|prefix| prefix.get(index)), schema.get("items")) {
                (Some(one), _) => self.node(entry, one, &path),
                (None, Some(items)) => {
                    let items = inherit(schema, &self.resolve(items));
                    self.node(entry, &Json::Object(items), &path);
                }
                (None, None) => {}
            }
        }
    }

    /// A text that is one of a few words.
    fn word(&mut self, node: &Node, known: &[String], path: &str) {
        let list = || words::any_of(known.iter().map(String::as_str));
        match &node.value {
            Value::Text(text) if known.contains(text) => {}
            Value::Text(text) => {
                let meant = words::meant(text, known.iter().map(String::as_str));
                let label = meant.map_or("unknown word".to_owned(), |word| format!("did you mean \"{word}\"?"));
                let fault = Fault::new(format!("`{path}` cannot be \"{text}\"")).at(node.location(label));
                self.faults.push(fault.help(format!("it is {}", list())));
            }
            _ => {
                let fault = Fault::new(format!("`{path}` is {}; a word was expected", node.kind()));
                self.faults.push(fault.at(node.location("a word was expected")).help(format!("it is {}", list())));
            }
        }
    }

    /// A text with a meaning of its own.
    fn text(&mut self, node: &Node, text: &str, schema: &Map<String, Json>, path: &str) {
        let kind = schema.get("x-text").and_then(Json::as_str).unwrap_or_default();
        let fault = match kind {
            "colour" => text.parse::<Colour>().err(),
            "length unit" => text.parse::<LengthUnit>().err(),
            "name" => name_error(text),
            "" => None,
            _ => {
                self.references.push(Reference { kind: kind.into(), path: path.into(), text: text.into() });
                None
            }
        };
        if let Some(error) = fault {
            let location = node.location_in_text(error.at, format!("a {kind} was expected"));
            self.faults.push(Fault::new(format!("`{path}`: {}", error.message)).at(location).help(error.help));
        }
    }

    /// A text that is a quantity, or a word that stands for one.
    fn quantity(&mut self, node: &Node, schema: &Map<String, Json>, dimension: Dimension, path: &str) {
        let words = schema.get("x-words").and_then(Json::as_array);
        let words: Vec<&str> = words.into_iter().flatten().filter_map(Json::as_str).collect();
        let expected = format!("{} was expected", expectation(schema));
        match &node.value {
            Value::Text(text) if words.contains(&text.as_str()) => {}
            Value::Text(text) if !words.is_empty() && text.starts_with(|c: char| c.is_alphabetic()) => {
                let words: Vec<String> = words.into_iter().map(str::to_owned).collect();
                let meant = words::meant(text, words.iter().map(String::as_str));
                let label = meant.map_or(expected.clone(), |word| format!("did you mean \"{word}\"?"));
                let list = words::all_of(words.iter().map(String::as_str));
                let help = format!(
                    "words here are {list}; or write {}, such as \"{}\"",
                    dimension.with_article(),
                    dimension.example()
                );
                self.faults
                    .push(Fault::new(format!("`{path}` cannot be \"{text}\"")).at(node.location(label)).help(help));
            }
            Value::Text(text) => match units::parse_as(text, dimension) {
                Ok(value) => self.quantity_bounds(node, value, dimension, schema, path),
                Err(error) => {
                    let location = node.location_in_text(error.at, expected);
                    self.faults.push(Fault::new(format!("`{path}`: {}", error.message)).at(location).help(error.help));
                }
            },
            // Nothing is nothing in every unit.
            Value::Integer(0) => self.quantity_bounds(node, 0.0, dimension, schema, path),
            Value::Number(0.0) => self.quantity_bounds(node, 0.0, dimension, schema, path),
            Value::Integer(_) | Value::Number(_) => {
                let article = dimension.with_article();
                let example = dimension.example();
                let unit = example.split_once(' ').map_or("", |(_, unit)| unit);
                let fault = Fault::new(format!("`{path}` is a bare number; {article} was expected"));
                let help = format!("{article} needs a unit, such as \"{} {unit}\"", node.written());
                self.faults.push(fault.at(node.location("a unit is missing")).help(help));
            }
            _ => self.wrong_kind(node, &expectation(schema), path, schema),
        }
    }

    fn wrong_kind(&mut self, node: &Node, wanted: &str, path: &str, schema: &Map<String, Json>) {
        let path = if path.is_empty() { "the document" } else { path };
        let fault = Fault::new(format!("`{path}` is {}; {wanted} was expected", node.kind()));
        let fault = fault.at(node.location(format!("{wanted} was expected")));
        self.faults.push(match rewrite(node, wanted) {
            Some(advice) => fault.help(advice),
            None => with_purpose(fault, schema),
        });
    }
}

/// Why a text cannot name something that becomes part of a file or of the result.
pub(super) fn name_error(text: &str) -> Option<UnitError> {
    let good = text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    let message = format!("\"{text}\" cannot be a name");
    let help = "a name begins with a letter and has letters, digits, _ and - only".to_owned();
    (!good).then_some(UnitError { message, help, at: 0..text.len() })
}
