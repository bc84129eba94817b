//! One element of a drawing with its attributes.

use crate::error::Error;
use crate::picture::colour::Colour;
use crate::xml::Attribute;

/// Name and attributes of an element.
pub(super) struct Element<'a> {
    pub name: &'a str,
    pub attributes: &'a [Attribute<'a>],
}

impl Element<'_> {
    /// An attribute that is there.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.attributes.iter().find(|attribute| attribute.name == key).map(|attribute| &*attribute.value)
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
