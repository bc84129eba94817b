//! The text of a document, and the faults that point into it.

use super::warning::{Warning, Warnings};
use crate::error::{Error, Fault, Location, Result, Source};
use crate::xml::{Limits, Trouble, What};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// How a language is called, and what its documents are.
#[derive(Debug)]
pub(super) struct Language {
    /// "PML".
    pub name: &'static str,
    /// The root elements that its documents can have.
    pub roots: &'static [&'static str],
}

impl Language {
    /// The name and the bytes of a file of the language.
    ///
    /// # Errors
    /// [`Error::Input`] for a file that cannot be read.
    pub fn open(&self, path: &Path) -> Result<(String, Vec<u8>)> {
        let name = path.display().to_string();
        let bytes = crate::files::read(path).map_err(|failure| {
            let fault = Fault::new(format!("{} file `{name}` cannot be read: {failure}", self.name));
            Error::input(fault.help("give a file that exists and that you may read"))
        })?;
        Ok((name, bytes))
    }
}

/// Most bytes that are read of a document: ten times what a large model takes.
const MOST_BYTES: usize = 1 << 30;
/// How deep elements may stand in each other: models have four levels, and groups of groups a few more.
const DEEPEST: usize = 200;
/// Most attributes of an element: they are custom properties, of which a model has a few.
const MOST_ATTRIBUTES: usize = 1000;

pub(super) const LIMITS: Limits =
    Limits { bytes: MOST_BYTES, depth: DEEPEST, nodes: usize::MAX, attributes: MOST_ATTRIBUTES };

/// A text that is read.
#[derive(Debug)]
pub(super) struct Page {
    pub source: Arc<Source>,
    pub language: &'static Language,
}

impl Page {
    /// The text in some bytes. What is neither UTF-8 nor UTF-16 is taken for Latin-1, which older programs wrote.
    pub fn new(name: &str, bytes: Vec<u8>, language: &'static Language, warnings: &mut Warnings) -> Self {
        let text = match bytes.as_slice() {
            [0xff, 0xfe, rest @ ..] => utf_16(rest, u16::from_le_bytes),
            [0xfe, 0xff, rest @ ..] => utf_16(rest, u16::from_be_bytes),
            _ => String::from_utf8(bytes).unwrap_or_else(|error| {
                let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
                let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
                let found = "the text is not UTF-8".to_owned();
                warnings.add(|| Warning { line, found, done: "it was read as Latin-1" });
                error.as_bytes().iter().map(|byte| char::from(*byte)).collect()
            }),
        };
        Self { source: Arc::new(Source { name: name.into(), text }), language }
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.source.text
    }

    /// A fault at some bytes of the text.
    pub fn fault(&self, at: Range<usize>, message: impl Into<String>, label: &str, help: impl Into<String>) -> Error {
        Error::input(self.told(at, message, label, help))
    }

    /// The same, for who tells several at once.
    pub fn told(&self, at: Range<usize>, message: impl Into<String>, label: &str, help: impl Into<String>) -> Fault {
        let source = self.source.clone();
        let location = Location { source, start: at.start, length: at.len(), label: label.into() };
        Fault::new(message).at(location).help(help)
    }

    /// Why the text is no XML that is read.
    pub fn broken(&self, trouble: Trouble) -> Error {
        let Language { name, roots } = self.language;
        let example = format!("a document of {name} is <{0}> … </{0}>", roots[0]);
        let (message, label, help) = match trouble.what {
            What::TooLong => {
                let message =
                    format!("`{}` has {} bytes; at most {MOST_BYTES} are read", self.source.name, self.text().len());
                // The location would carry the whole text into the message: there is none.
                return Error::input(
                    Fault::new(message).help("split the model into several, or leave out what is only shown"),
                );
            }
            What::NotXml => ("this is not XML".to_owned(), "XML begins with <", example),
            What::DocumentType => {
                let message = "a document type and entities of its own are not read".to_owned();
                (message, "begins here", format!("remove the <!DOCTYPE …>; {name} needs none"))
            }
            What::TooDeep => {
                let message = format!("elements are nested more than {DEEPEST} deep");
                (message, "too deep", "close elements with </…> or />, or group components in fewer levels".to_owned())
            }
            What::TooManyNodes => ("the document has too many elements".to_owned(), "too many", example),
            What::TooManyAttributes => {
                let message = format!("an element has more than {MOST_ATTRIBUTES} attributes");
                (message, "this element", "keep fewer properties on it".to_owned())
            }
            What::Malformed { message, label, help } => {
                (format!("this is not well-formed XML: {message}"), label, help)
            }
        };
        self.fault(trouble.at, message, label, help)
    }
}

/// The text of units of UTF-16 in bytes.
fn utf_16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> String {
    let (pairs, _) = bytes.as_chunks::<2>();
    char::decode_utf16(pairs.iter().map(|pair| unit(*pair))).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
}

/// The line of a position, for positions that are asked for in rising order mostly: it counts on from the last one.
#[derive(Debug, Default)]
pub(super) struct Lines {
    position: usize,
    line: usize,
}

impl Lines {
    pub fn at(&mut self, text: &str, position: usize) -> usize {
        if position < self.position {
            *self = Self::default();
        }
        let passed = &text.as_bytes()[self.position..position];
        self.line += passed.iter().filter(|byte| **byte == b'\n').count();
        self.position = position;
        self.line + 1
    }
}
