//! Other documents than experiments, checked in the same manner: along the schema of their type, with every fault where it stands.

use super::check;
use super::tree::Node;
use crate::error::{Error, Fault, Location, Result, Source};
use serde::de::DeserializeOwned;
use serde_json::Value as Json;
use std::sync::Arc;

/// A text that was checked along a schema, and where everything stands in it.
#[derive(Debug, Clone)]
pub struct Checked {
    tree: Node,
}

impl Checked {
    /// Reads a text as TOML and checks it along a schema.
    ///
    /// # Errors
    /// [`Error::Input`] with all faults, in the order of the text.
    pub fn read(source: &Arc<Source>, schema: &Json) -> Result<Self> {
        let tree = Node::parse(source).map_err(Error::Input)?;
        let mut faults = check::check(&tree, schema).faults;
        faults.sort_by_key(|fault| fault.location.as_ref().map_or(0, |location| location.start));
        if faults.is_empty() { Ok(Self { tree }) } else { Err(Error::Input(faults)) }
    }

    /// What the text says.
    ///
    /// # Errors
    /// [`Error::Input`] where the schema allows what the type does not.
    pub fn to<T: DeserializeOwned>(&self) -> Result<T> {
        T::deserialize(self.tree.plain()).map_err(|error| {
            let fault = Fault::new(format!("the document cannot be understood: {}", error.message().trim()));
            let start =
                Location { source: self.tree.source.clone(), start: 0, length: 0, label: "in this text".into() };
            Error::input(fault.at(start).help("compare it with the example in the book"))
        })
    }

    /// Where the value of a key stands, as in `parameter[0].values[1]`; the nearest table around one that is not written.
    pub fn location(&self, path: &str, label: &str) -> Location {
        self.tree.follow(path).0.location(label)
    }

    /// Where a key itself stands, with the same rules.
    pub fn key_location(&self, path: &str, label: &str) -> Location {
        self.tree.follow(path).0.key_location(label)
    }
}
