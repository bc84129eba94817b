//! The keys of a table: unknown, missing, excluding each other.

use super::{Keys, Walk, dimension_of, kinds_of, name_error, words_of};
use crate::error::Fault;
use crate::error::words;
use crate::experiment::tree::{Node, Value};
use indexmap::IndexMap;
use serde_json::{Map, Value as Json};

/// One alternative of a table.
struct Variant {
    properties: Map<String, Json>,
    required: Vec<String>,
}

impl Walk<'_> {
    /// Checks the keys of a table, then their values.
    pub(super) fn table(
        &mut self,
        node: &Node,
        table: &IndexMap<String, Node>,
        schema: &Map<String, Json>,
        path: &str,
    ) {
        let keys = self.keys(node, table, schema, path);
        if let Some(named) = &keys.named {
            self.named(node, table, schema, named, path);
        }
        // A key that is only misspelt is told once, where it is misspelt.
        let strangers = || table.keys().filter(|key| !keys.known.contains_key(*key));
        let misspelt = |key: &str| strangers().any(|stranger| words::meant(stranger, keys.known()) == Some(key));
        for key in keys.required.iter().filter(|key| !table.contains_key(*key) && !misspelt(key)) {
            let property = keys.known.get(key).map(|property| self.resolve(property)).unwrap_or_default();
            self.faults.push(missing(node, key, &property, path));
        }
        for (key, value) in table {
            match keys.known.get(key) {
                Some(property) => self.node(value, property, &join(path, key)),
                None if keys.named.is_some() => {}
                None => self.faults.push(unknown(value, key, &keys, path)),
            }
        }
    }

    /// Values under names that the user chose.
    fn named(
        &mut self,
        node: &Node,
        table: &IndexMap<String, Node>,
        schema: &Map<String, Json>,
        named: &Json,
        path: &str,
    ) {
        if schema.get("minProperties").is_some() && table.is_empty() {
            let fault = Fault::new(format!("`{path}` is empty; at least one was expected"));
            self.faults.push(super::with_purpose(fault.at(node.key_location("nothing here")), schema));
        }
        for (name, value) in table {
            if let Some(error) = name_error(name) {
                let fault = Fault::new(format!("in `{path}`: {}", error.message));
                self.faults.push(fault.at(value.key_location("a name was expected")).help(error.help));
            }
            match self.meant_for_another(value, name, table, named, path) {
                Some(fault) => self.faults.push(fault),
                None => self.node(value, named, &join(path, name)),
            }
        }
    }

    /// That a table lacks what it needs where there is a whole one of a similar name: `cells.walkers` beside `cells.walker`.
    fn meant_for_another(
        &self,
        value: &Node,
        name: &str,
        table: &IndexMap<String, Node>,
        named: &Json,
        path: &str,
    ) -> Option<Fault> {
        let schema = self.resolve(named);
        let mut required = variant(&schema).required;
        let alternatives = schema.get("oneOf").or(schema.get("anyOf")).and_then(Json::as_array).into_iter().flatten();
        required.extend(tag(&alternatives.map(|one| variant(&self.resolve(one))).collect::<Vec<_>>()));
        let lacks = |node: &Node| match &node.value {
            Value::Table(keys) => required.iter().filter(|key| !keys.contains_key(*key)).collect(),
            _ => Vec::new(),
        };
        let lacking = lacks(value);
        if lacking.is_empty() {
            return None;
        }
        let others = table.iter().filter(|(other, node)| *other != name && lacks(node).is_empty());
        let meant = words::meant(name, others.map(|(other, _)| other.as_str()))?;
        let lacking = words::all_of(lacking.into_iter().map(String::as_str));
        let fault = Fault::new(format!("`{}` lacks {lacking}", join(path, name)));
        let fault = fault.at(value.key_location(format!("did you mean `{meant}`?")));
        Some(fault.help(format!(
            "what is meant for `{0}` is written under its name; another one needs {lacking} too",
            join(path, meant)
        )))
    }

    /// The keys that belong here, alternatives chosen.
    fn keys(&mut self, node: &Node, table: &IndexMap<String, Node>, schema: &Map<String, Json>, path: &str) -> Keys {
        let own = variant(schema);
        let mut keys = Keys {
            known: own.properties.into_iter().collect(),
            required: own.required,
            elsewhere: Vec::new(),
            chosen: None,
            named: schema.get("additionalProperties").filter(|one| one.is_object()).cloned(),
            gone: schema.get("x-gone").and_then(Json::as_object).cloned().unwrap_or_default(),
        };
        let alternatives = schema.get("oneOf").or(schema.get("anyOf")).and_then(Json::as_array);
        let variants: Vec<Variant> =
            alternatives.into_iter().flatten().map(|one| described(variant(&self.resolve(one)), one)).collect();
        if variants.is_empty() {
            return keys;
        }
        let choice = match tag(&variants) {
            Some(tag) => self.choose_by_tag(node, table, &variants, &tag, path, &mut keys),
            None => self.choose_by_key(node, table, &variants, path),
        };
        for (index, variant) in variants.into_iter().enumerate() {
            if choice == Some(index) {
                keys.known.extend(variant.properties);
                keys.required.extend(variant.required);
            } else if choice.is_some() {
                keys.elsewhere.extend(variant.properties.into_iter().map(|(key, _)| key));
            } else {
                // Without a choice nothing is known of the values; only the names can be checked.
                keys.known.extend(variant.properties.into_iter().map(|(key, _)| (key, Json::Bool(true))));
            }
        }
        keys
    }

    /// Alternatives told apart by a key with a fixed word, such as `shape`.
    fn choose_by_tag(
        &mut self,
        node: &Node,
        table: &IndexMap<String, Node>,
        variants: &[Variant],
        tag: &str,
        path: &str,
        keys: &mut Keys,
    ) -> Option<usize> {
        let words: Vec<String> =
            variants.iter().filter_map(|one| one.properties[tag]["const"].as_str().map(str::to_owned)).collect();
        let Some(value) = table.get(tag) else {
            let list = words::any_of(words.iter().map(String::as_str));
            let fault = Fault::new(format!("{} lacks `{tag}`", named(path)));
            let location = node.location(format!("`{tag}` is missing here"));
            self.faults.push(fault.at(location).help(format!("add `{tag}`: it is {list}")));
            return None;
        };
        self.word(value, &words, &join(path, tag));
        let Value::Text(text) = &value.value else { return None };
        let choice = words.iter().position(|word| word == text);
        keys.chosen = choice.map(|_| format!("`{tag} = \"{text}\"`"));
        choice
    }

    /// Alternatives told apart by the keys that they have, such as `atoms` or `cap`.
    fn choose_by_key(
        &mut self,
        node: &Node,
        table: &IndexMap<String, Node>,
        variants: &[Variant],
        path: &str,
    ) -> Option<usize> {
        let present = |one: &Variant| one.properties.keys().find_map(|key| table.get_key_value(key));
        let found: Vec<_> =
            variants.iter().enumerate().filter_map(|(index, one)| present(one).map(|key| (index, key))).collect();
        let firsts = || variants.iter().filter_map(|one| one.required.first().map(String::as_str));
        match found.as_slice() {
            [(only, _)] => Some(*only),
            [] => {
                let list = words::any_of(firsts());
                let fault = Fault::new(format!("{} lacks one of {list}", named(path)));
                self.faults.push(fault.at(node.location("missing here")).help(format!("add exactly one: {list}")));
                None
            }
            [(_, (first, _)), .., (_, (last, value))] => {
                let fault = Fault::new(format!("{} has both `{first}` and `{last}`", named(path)));
                let help = format!("give exactly one of {}", words::any_of(firsts()));
                self.faults.push(fault.at(value.key_location("only one of them may be given")).help(help));
                None
            }
        }
    }
}

/// Own keys of a schema.
fn variant(schema: &Map<String, Json>) -> Variant {
    let properties = schema.get("properties").and_then(Json::as_object).cloned().unwrap_or_default();
    let required = schema.get("required").and_then(Json::as_array).into_iter().flatten();
    Variant { properties, required: required.filter_map(Json::as_str).map(str::to_owned).collect() }
}

/// An alternative of a single key without a description of its own: the alternative's is the key's.
fn described(mut variant: Variant, schema: &Json) -> Variant {
    let single = variant.properties.len() == 1;
    if let (Some(description), Some(Json::Object(property))) =
        (schema.get("description").filter(|_| single), variant.properties.values_mut().next())
    {
        property.entry("description").or_insert(description.clone());
    }
    variant
}

/// The key that has a fixed word in every alternative.
fn tag(variants: &[Variant]) -> Option<String> {
    let fixed = |one: &Variant, key: &str| one.properties.get(key).is_some_and(|value| value["const"].is_string());
    let candidates = variants.first()?.properties.keys();
    candidates.into_iter().find(|key| variants.iter().all(|one| fixed(one, key))).cloned()
}

fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}

fn named(path: &str) -> String {
    if path.is_empty() { "the document".to_owned() } else { format!("`{path}`") }
}

fn missing(node: &Node, key: &str, property: &Map<String, Json>, path: &str) -> Fault {
    let fault = Fault::new(format!("{} lacks `{key}`", named(path)));
    let example = match (dimension_of(property), words_of(property), kinds_of(property).first().map(String::as_str)) {
        (Some(dimension), ..) => format!("`{key} = \"{}\"`", dimension.example()),
        (_, Some(words), _) => format!("`{key}`, one of {}", words::any_of(words.iter().map(String::as_str))),
        (_, _, Some("object")) if path.is_empty() => {
            let names_are_chosen = property.get("additionalProperties").is_some_and(Json::is_object);
            format!("a table `[{key}{}]`", if names_are_chosen { ".NAME" } else { "" })
        }
        (_, _, Some("string")) => format!("`{key} = \"…\"`"),
        _ => format!("`{key}`"),
    };
    let purpose = property.get("description").and_then(Json::as_str).map(|text| format!(": {text}"));
    let help = format!("add {example}{}", purpose.unwrap_or_default());
    fault.at(node.location(format!("`{key}` is missing here"))).help(help)
}

fn unknown(value: &Node, key: &str, keys: &Keys, path: &str) -> Fault {
    let list = words::all_of(keys.known());
    let here = keys.chosen.as_ref().map_or("here".to_owned(), |chosen| format!("with {chosen}"));
    let help = format!("keys {here} are {list}");
    if let Some(chosen) = keys.chosen.as_ref().filter(|_| keys.elsewhere.iter().any(|other| other == key)) {
        let fault = Fault::new(format!("`{key}` in {} does not go with {chosen}", named(path)));
        return fault.at(value.key_location("not with this one")).help(help);
    }
    if let Some(instead) = keys.gone.get(key).and_then(Json::as_str) {
        let fault = Fault::new(format!("`{key}` in {} is no key any more", named(path)));
        return fault.at(value.key_location("without meaning")).help(instead);
    }
    let meant = words::meant(key, keys.known());
    let label = meant.map_or("unknown key".to_owned(), |meant| format!("did you mean `{meant}`?"));
    Fault::new(format!("unknown key `{key}` in {}", named(path))).at(value.key_location(label)).help(help)
}
