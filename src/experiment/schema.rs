//! The JSON schema of the experiment document, for editors and for the checker, made from the types.

use super::Experiment;
use schemars::generate::SchemaSettings;
use schemars::transform::{Transform, transform_subschemas};
use schemars::{JsonSchema, Schema};
use serde_json::Value;
use std::sync::OnceLock;

/// The JSON schema (draft 2020-12) of the experiment document.
///
/// Keys that begin with `x-` are ours and tell what JSON Schema has no word for: `x-dimension` (the text is a quantity
/// of this dimension), `x-minimum`, `x-exclusive-minimum`, `x-maximum` (bounds in base units of the quantities below),
/// `x-words` (words that stand beside the quantity), `x-text` (what else a text is: a file, a name, a colour).
pub fn schema() -> Value {
    schema_of::<Experiment>()
}

/// The same, made once.
pub(super) fn schema_of_experiments() -> &'static Value {
    static SCHEMA: OnceLock<Value> = OnceLock::new();
    SCHEMA.get_or_init(schema)
}

/// The same of another kind of document.
pub fn schema_of<T: JsonSchema>() -> Value {
    let settings = SchemaSettings::draft2020_12().with_transform(without_null as fn(&mut Schema));
    settings.into_generator().into_root_schema_for::<T>().to_value()
}

/// TOML has no null: an absent key says the same, so `null` is taken out of the types and alternatives.
fn without_null(schema: &mut Schema) {
    transform_subschemas(&mut without_null as &mut dyn Transform, schema);
    let Some(object) = schema.as_object_mut() else { return };
    if let Some(Value::Array(types)) = object.get_mut("type") {
        types.retain(|kind| kind != "null");
        if let [only] = types.as_slice() {
            let only = only.clone();
            object.insert("type".into(), only);
        }
    }
    for key in ["anyOf", "enum"] {
        let Some(Value::Array(variants)) = object.get_mut(key) else { continue };
        variants.retain(|variant| !variant.is_null() && variant.get("type").is_none_or(|kind| kind != "null"));
        if let [Value::Object(only)] = variants.as_slice() {
            let only = only.clone();
            object.remove(key);
            for (key, value) in only {
                object.entry(key).or_insert(value);
            }
        }
    }
    if object.get("default").is_some_and(Value::is_null) {
        object.remove("default");
    }
}
