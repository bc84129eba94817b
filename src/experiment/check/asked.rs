//! What a schema asks for, read and told in words.

use crate::error::Fault;
use crate::experiment::tree::{Node, Value};
use crate::units::Dimension;
use serde_json::{Map, Value as Json};

/// How a value of the wrong kind is written right, if that can be told from the value.
pub(super) fn rewrite(node: &Node, wanted: &str) -> Option<String> {
    let written = node.written();
    match (&node.value, wanted) {
        (Value::Text(text), "a number" | "a whole number") if text.trim().parse::<f64>().is_ok() => {
            Some(format!("write the number without quotes: {}", text.trim()))
        }
        (Value::Text(text), "true or false") if text == "true" || text == "false" => {
            Some(format!("write it without quotes: {text}"))
        }
        (Value::Integer(_) | Value::Truth(_) | Value::Number(_), "a text") => {
            Some(format!("write it in quotes: \"{written}\""))
        }
        (Value::Number(number), "a whole number") if number.fract() == 0.0 => {
            Some(format!("write it without a decimal point: {number}"))
        }
        (Value::Table(_), "a list") if written.starts_with('[') => {
            let name = written.trim_matches(['[', ']']);
            Some(format!("begin every entry with two brackets: [[{name}]]"))
        }
        (Value::Integer(_) | Value::Text(_) | Value::Number(_), "a list") if !written.contains('\n') => {
            Some(format!("write a list, in brackets: [{written}]"))
        }
        _ => None,
    }
}

/// Adds what a key is for, in the words of its type.
pub(super) fn with_purpose(fault: Fault, schema: &Map<String, Json>) -> Fault {
    match schema.get("description").and_then(Json::as_str) {
        // Where the lines of the schema's text end means nothing in a message.
        Some(purpose) => fault.help(format!("the key is for: {}", purpose.replace('\n', " "))),
        None => fault.help("write another value; `pseudopod schema` tells what is allowed"),
    }
}

/// The dimension of a schema that asks for a quantity.
pub(super) fn dimension_of(schema: &Map<String, Json>) -> Option<Dimension> {
    schema.get("x-dimension").and_then(Json::as_str).and_then(Dimension::by_name)
}

/// The words that a schema allows, if it asks for one of a few.
pub(super) fn words_of(schema: &Map<String, Json>) -> Option<Vec<String>> {
    let word = |one: &Json| one.as_str().map(str::to_owned);
    if let Some(words) = schema.get("enum").and_then(Json::as_array) {
        return words.iter().map(word).collect();
    }
    if let Some(only) = schema.get("const") {
        return word(only).map(|only| vec![only]);
    }
    let words = schema.get("oneOf").and_then(Json::as_array)?.iter();
    words.map(|one| one.get("const").and_then(word)).collect()
}

/// What `type` allows.
pub(super) fn kinds_of(schema: &Map<String, Json>) -> Vec<String> {
    match schema.get("type") {
        Some(Json::String(kind)) => vec![kind.clone()],
        Some(Json::Array(kinds)) => kinds.iter().filter_map(Json::as_str).map(str::to_owned).collect(),
        _ => Vec::new(),
    }
}

/// The kind of a value in the words of JSON Schema.
pub(super) fn json_kind(node: &Node) -> &'static str {
    match node.value {
        Value::Table(_) => "object",
        Value::List(_) => "array",
        Value::Text(_) | Value::Date(_) => "string",
        Value::Integer(_) => "integer",
        Value::Number(_) => "number",
        Value::Truth(_) => "boolean",
    }
}

/// What a schema asks for, in words: "a length", "a list of 3".
pub(super) fn expectation(schema: &Map<String, Json>) -> String {
    if let Some(dimension) = dimension_of(schema) {
        return dimension.with_article();
    }
    let kind = kinds_of(schema).into_iter().next().unwrap_or_default();
    let name = match kind.as_str() {
        "object" => "a table",
        "array" => "a list",
        "integer" => "a whole number",
        "number" => "a number",
        "boolean" => "true or false",
        _ => "a text",
    };
    name.to_owned()
}

/// Bounds and meaning of a key hold for the entries of its list and for its alternatives.
pub(super) fn inherit(parent: &Map<String, Json>, child: &Map<String, Json>) -> Map<String, Json> {
    let mut child = child.clone();
    for (key, value) in parent {
        let bound_or_meaning = key.starts_with("x-") && key != "x-dimension" && key != "x-words";
        if bound_or_meaning || key == "description" {
            child.entry(key.clone()).or_insert(value.clone());
        }
    }
    child
}
