//! Reference pages of the documents, from the schemas that their types make.

use crate::units::{Dimension, pretty};
use serde_json::{Map, Value as Json};
use std::collections::BTreeMap;
use std::fmt::Write as _;

type Object = Map<String, Json>;

/// The page of a document: a section for each table, in the order in which a document is read, with its keys, what they hold, what is so
/// when they are absent, and what they mean.
pub(super) fn page(title: &str, introduction: &str, schema: &Json) -> String {
    let pages = Pages::of(schema);
    let mut text = format!("# {title}\n\n{introduction}\n");
    for section in &pages.sections {
        pages.write(&mut text, section);
    }
    text
}

/// A table of the document.
struct Section<'a> {
    /// Where it stands first: `cells.NAME.loads[]`; empty for the document itself.
    path: String,
    /// Where else it stands.
    also: Vec<String>,
    schema: &'a Object,
}

struct Pages<'a> {
    root: &'a Json,
    sections: Vec<Section<'a>>,
    /// The number of the section of each definition.
    found: BTreeMap<&'a str, usize>,
}

impl<'a> Pages<'a> {
    fn of(schema: &'a Json) -> Self {
        let mut pages = Self { root: schema, sections: Vec::new(), found: BTreeMap::new() };
        pages.add("", schema.as_object().expect("a schema is an object"), None);
        pages
    }

    /// Adds the section of a table, and of all that stand in it; one that is there already is told to stand here, too.
    fn add(&mut self, path: &str, schema: &'a Object, name: Option<&'a str>) {
        if let Some(number) = name.and_then(|name| self.found.get(name)) {
            self.sections[*number].also.push(path.to_owned());
            return;
        }
        if let Some(name) = name {
            self.found.insert(name, self.sections.len());
        }
        self.sections.push(Section { path: path.to_owned(), also: Vec::new(), schema });
        for (key, value) in keys_of(schema) {
            let path = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
            self.enter(&path, value, None);
        }
    }

    /// Adds the tables that a value holds, itself, in a list or by names.
    fn enter(&mut self, path: &str, schema: &'a Object, name: Option<&'a str>) {
        if let Some((name, definition)) = self.definition(schema) {
            return self.enter(path, definition, Some(name));
        }
        if is_table(schema) {
            return self.add(path, schema, name);
        }
        if let Some(held) = schema.get("additionalProperties").and_then(Json::as_object) {
            self.enter(&format!("{path}.NAME"), held, None);
        }
        if let Some(held) = schema.get("items").and_then(Json::as_object) {
            self.enter(&format!("{path}[]"), held, None);
        }
        // One of something, or a list of them: the list alone is told.
        for held in variants_of(schema).filter(|held| held.contains_key("items")) {
            self.enter(path, held, None);
        }
    }

    /// The definition that a schema refers to.
    fn definition(&self, schema: &Object) -> Option<(&'a str, &'a Object)> {
        let name = schema.get("$ref")?.as_str()?.strip_prefix("#/$defs/")?;
        let (name, definition) = self.root["$defs"].as_object()?.get_key_value(name)?;
        Some((name, definition.as_object()?))
    }

    fn write(&self, text: &mut String, section: &Section) {
        if !section.path.is_empty() {
            let _ = write!(text, "\n## `{}`\n\n{}\n", section.path, words_of(section.schema));
        }
        if !section.also.is_empty() {
            let also: Vec<String> = section.also.iter().map(|path| format!("`{path}`")).collect();
            let _ = write!(text, "\nStands also in {}.\n", also.join(", "));
        }
        let own = properties_of(section.schema);
        if own.clone().next().is_some() {
            self.write_keys(text, section, section.schema, None);
        }
        for variant in variants_of(section.schema) {
            let chosen = properties_of(variant).find_map(|(key, value)| value.get("const").map(|only| (key, only)));
            let title = match chosen {
                Some((key, only)) => format!("`{key} = {only}`"),
                None => {
                    let needed: Vec<String> = required_of(variant).map(|key| format!("`{key}`")).collect();
                    format!("With {}", needed.join(" and "))
                }
            };
            let _ = write!(text, "\n**{title}**: {}\n", words_of(variant));
            let chosen = chosen.map(|(key, _)| key);
            if properties_of(variant).any(|(key, _)| Some(key) != chosen) {
                self.write_keys(text, section, variant, chosen);
            }
        }
    }

    /// The keys of a table, or of one of its variants, without the one that tells the variant.
    fn write_keys(&self, text: &mut String, section: &Section, schema: &Object, but: Option<&str>) {
        text.push_str("\n| key | value | when absent | meaning |\n|---|---|---|---|\n");
        for (key, value) in properties_of(schema).filter(|(key, _)| Some(*key) != but) {
            let needed = required_of(schema).any(|needed| needed == key);
            let absent = match value.get("default") {
                _ if needed => "must be there".to_owned(),
                Some(default) if is_short(default) => format!("`{}`", toml_of(default)),
                _ => String::new(),
            };
            let path = if section.path.is_empty() { key.to_owned() } else { format!("{}.{key}", section.path) };
            let (held, mut meaning) = (self.value(&path, value), words_of(value));
            let words: Vec<String> = choices_of(value)
                .filter(|choice| choice.contains_key("description"))
                .map(|choice| format!("`{}`: {}", word_of(choice), words_of(choice)))
                .collect();
            if !words.is_empty() {
                meaning = format!("{meaning} {}", words.join(" "));
            }
            let _ = writeln!(text, "| `{key}` | {} | {absent} | {} |", cell(&held), cell(&meaning));
        }
    }

    /// What a key holds, in words.
    fn value(&self, path: &str, schema: &Object) -> String {
        if let Some((name, definition)) = self.definition(schema) {
            if let Some(number) = self.found.get(name) {
                return format!(
                    "a table, [`{0}`](#{1})",
                    self.sections[*number].path,
                    anchor(&self.sections[*number].path)
                );
            }
            return self.value(path, definition);
        }
        if is_table(schema) {
            return format!("a table, [`{path}`](#{})", anchor(path));
        }
        if let Some(held) = schema.get("additionalProperties").and_then(Json::as_object) {
            return format!("tables by name, {}", self.value(&format!("{path}.NAME"), held).replace("a table, ", ""));
        }
        if choices_of(schema).next().is_some() {
            return choices_of(schema).map(|choice| format!("`{}`", word_of(choice))).collect::<Vec<_>>().join(", ");
        }
        let variants: Vec<&Object> = variants_of(schema).collect();
        if let [one, list] = variants[..] {
            return match list.get("items").and_then(|items| items.get("prefixItems")) {
                Some(_) => format!("{}; or a course of it", self.value(path, one)),
                None => format!("{}; or a list of them", self.value(path, one)),
            };
        }
        if let Some(held) = schema.get("items").and_then(Json::as_object) {
            return self.list(path, schema, held);
        }
        scalar(schema)
    }

    /// What a list holds: how many, and of what, whose bounds may stand at the list.
    fn list(&self, path: &str, schema: &Object, held: &Object) -> String {
        let mut held = held.clone();
        for bound in ["x-minimum", "x-exclusive-minimum", "x-maximum"] {
            if let Some(value) = schema.get(bound) {
                held.entry(bound).or_insert(value.clone());
            }
        }
        let each = self.value(&format!("{path}[]"), &held);
        let count = |key: &str| schema.get(key).and_then(Json::as_u64);
        match (count("minItems"), count("maxItems")) {
            (Some(least), Some(most)) if least == most => format!("a list of {most}: {each}"),
            (Some(least), Some(most)) => format!("a list of {least} to {most}: {each}"),
            (Some(least), None) if least > 1 => format!("a list of at least {least}: {each}"),
            _ => format!("a list: {each}"),
        }
    }
}

/// What a value is that is neither a table nor a list.
fn scalar(schema: &Object) -> String {
    let texts = |key: &str| {
        let list = schema.get(key).and_then(Json::as_array);
        list.into_iter().flatten().filter_map(Json::as_str).map(|word| format!("`{word}`")).collect::<Vec<_>>()
    };
    if let Some(name) = schema.get("x-dimension").and_then(Json::as_str) {
        let dimension = Dimension::by_name(name);
        let words = texts("x-words");
        let quantity = dimension.map_or_else(|| format!("a {name}"), Dimension::with_article);
        let like =
            texts("examples").pop().map_or_else(String::new, |example| format!(", `{}`", example.trim_matches('`')));
        let shown = |bound: f64| match dimension {
            Some(dimension) if bound != 0.0 => pretty(bound, dimension),
            _ => format!("{bound}"),
        };
        let either = if words.is_empty() { String::new() } else { format!("{} or ", words.join(", ")) };
        return format!(
            "{either}{quantity}{like}{}",
            bounds(schema, ["x-exclusive-minimum", "x-minimum", "x-maximum"], shown)
        );
    }
    let number = |bound: f64| if bound.abs() >= 1e15 { format!("{bound:e}") } else { format!("{bound}") };
    let within = |words: &str| format!("{words}{}", bounds(schema, ["exclusiveMinimum", "minimum", "maximum"], number));
    if let Some(only) = schema.get("const") {
        return format!("`{only}`");
    }
    match schema.get("type").and_then(Json::as_str) {
        Some("integer") => within("a whole number"),
        Some("number") => within("a number"),
        Some("boolean") => "`true` or `false`".to_owned(),
        Some("string") => match schema.get("x-text").and_then(Json::as_str) {
            Some("file") => "a path from the folder of the document".to_owned(),
            Some(kind) => format!("a text: {kind}"),
            None => "a text".to_owned(),
        },
        _ => "a number, a text or a quantity".to_owned(),
    }
}

/// The range of a number in words, behind a comma.
fn bounds(schema: &Object, [above, least, most]: [&str; 3], shown: impl Fn(f64) -> String) -> String {
    // That no number of 32 or 64 bits is larger is of no use to anyone.
    let bound = |key: &str| schema.get(key).and_then(Json::as_f64).filter(|bound| bound.abs() < 4e9);
    let low = match (bound(above), bound(least)) {
        (Some(above), _) => Some(format!("more than {}", shown(above))),
        (None, least) => least.map(|least| format!("at least {}", shown(least))),
    };
    match (low, bound(most)) {
        (Some(low), Some(most)) => format!(", {low}, at most {}", shown(most)),
        (Some(low), None) => format!(", {low}"),
        (None, Some(most)) => format!(", at most {}", shown(most)),
        (None, None) => String::new(),
    }
}

/// The keys of a table and of its variants.
fn keys_of(schema: &Object) -> impl Iterator<Item = (&str, &Object)> {
    properties_of(schema).chain(variants_of(schema).flat_map(properties_of))
}

fn properties_of(schema: &Object) -> impl Iterator<Item = (&str, &Object)> + Clone {
    let properties = schema.get("properties").and_then(Json::as_object);
    properties.into_iter().flatten().filter_map(|(key, value)| Some((key.as_str(), value.as_object()?)))
}

fn variants_of(schema: &Object) -> impl Iterator<Item = &Object> {
    let list = |key: &str| schema.get(key).and_then(Json::as_array).into_iter().flatten().filter_map(Json::as_object);
    list("oneOf").chain(list("anyOf"))
}

fn required_of(schema: &Object) -> impl Iterator<Item = &str> {
    schema.get("required").and_then(Json::as_array).into_iter().flatten().filter_map(Json::as_str)
}

/// The words that a value may be, if it is one of some.
fn choices_of(schema: &Object) -> impl Iterator<Item = &Object> {
    variants_of(schema).filter(|one| one.get("const").is_some_and(Json::is_string))
}

fn word_of(choice: &Object) -> &str {
    choice.get("const").and_then(Json::as_str).unwrap_or_default()
}

fn is_table(schema: &Object) -> bool {
    schema.contains_key("properties") || variants_of(schema).any(|variant| variant.contains_key("properties"))
}

fn words_of(schema: &Object) -> String {
    schema
        .get("description")
        .and_then(Json::as_str)
        .unwrap_or_default()
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
}

/// Whether a value that is there when a key is absent can be read in a column: whole tables are told key by key.
fn is_short(value: &Json) -> bool {
    !value.is_object() && !value.is_null() && *value != Json::Array(Vec::new())
}

/// A value as a document has it.
fn toml_of(value: &Json) -> String {
    match value {
        Json::Array(list) => format!("[{}]", list.iter().map(toml_of).collect::<Vec<_>>().join(", ")),
        _ => value.to_string(),
    }
}

/// What leads to a heading with this path, on GitHub and in the book.
fn anchor(path: &str) -> String {
    path.chars().filter(|letter| letter.is_alphanumeric() || *letter == '_').flat_map(char::to_lowercase).collect()
}

/// A text that may stand in a column.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_has_a_section_and_every_key_a_row() {
        let schema = crate::experiment::schema();
        let page = page("Experiments", "", &schema);
        for heading in ["cells.NAME", "cells.NAME.loads[]", "contact.bonds.catch", "measure.NAME", "plot[].table[]"] {
            assert!(page.contains(&format!("\n## `{heading}`\n")), "{heading} has no section");
        }
        assert!(page.contains("| `until` | a time, `10 s`, more than 0 | must be there |"), "{page}");
        assert!(page.contains("`implicit`: Linearly implicit"), "words are told one by one");
        assert!(page.contains("**`kind = \"slope\"`**"), "each kind of measure is told");
        let pages = Pages::of(&schema);
        for (name, definition) in schema["$defs"].as_object().expect("definitions") {
            let is_told = pages.found.contains_key(name.as_str());
            assert!(is_told || !is_table(definition.as_object().expect("an object")), "{name} has no section");
        }
        for section in &pages.sections {
            let mut text = String::new();
            pages.write(&mut text, section);
            for (key, value) in keys_of(section.schema) {
                // What tells a variant stands above its rows.
                let chosen = value.get("const").is_some_and(|only| text.contains(&format!("**`{key} = {only}`**")));
                assert!(chosen || text.contains(&format!("\n| `{key}` | ")), "{}.{key} has no row", section.path);
            }
        }
    }
}
