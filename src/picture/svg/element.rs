//! One element of a drawing with its attributes.

use quick_xml::XmlVersion;
use quick_xml::events::BytesStart;

use crate::error::{Error, Result};
use crate::picture::colour::Colour;

/// Name and attributes of an element.
pub(super) struct Element {
    pub name: String,
    attributes: Vec<(String, String)>,
}

impl Element {
    /// The element that a tag begins.
    ///
    /// # Errors
    /// When its attributes are malformed.
    pub fn of(tag: &BytesStart) -> Result<Self> {
        let mut attributes = Vec::new();
        for attribute in tag.attributes() {
            let attribute = attribute.map_err(|error| undrawable(&error.to_string()))?;
            let value = attribute.normalized_value(XmlVersion::Implicit1_0);
            let value = value.map_err(|error| undrawable(&error.to_string()))?;
            attributes.push((attribute.key.as_ref().to_owned(), value.into_owned()));
        }
        Ok(Self { name: tag.name().as_ref().to_owned(), attributes })
    }

    /// An attribute that is there.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.attributes.iter().find(|(name, _)| name == key).map(|(_, value)| value.as_str())
    }

    /// An attribute, empty where it is missing.
    pub fn text(&self, key: &str) -> &str {
        self.get(key).unwrap_or_default()
    }

    /// A number, `usual` where it is missing or none.
    pub fn number(&self, key: &str, usual: f32) -> f32 {
        self.get(key).and_then(|text| text.trim().parse().ok()).unwrap_or(usual)
    }

    /// A colour `#rrggbb`.
    pub fn colour(&self, key: &str) -> Option<Colour> {
        self.get(key).and_then(Colour::from_hex)
    }

    /// The name in `url(#name)`.
    pub fn reference(&self, key: &str) -> Option<&str> {
        self.get(key)?.strip_prefix("url(#")?.strip_suffix(')')
    }
}

/// The error for a drawing that is none.
pub(super) fn undrawable(what: &str) -> Error {
    Error::Machine {
        message: format!("a drawing could not be turned into pixels: {what}"),
        help: "choose a positive size below 30 000 pixels a side; otherwise please report this drawing".into(),
    }
}
