//! Why a text is not read.

use std::ops::Range;

/// Why a document is not read, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Trouble {
    /// The bytes at fault, within one line; they begin and end between characters.
    pub at: Range<usize>,
    /// What is wrong there.
    pub what: What,
}

/// What is wrong with a text. Each language tells the first ones in its own words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum What {
    /// It has more bytes than [`Limits::bytes`](super::Limits::bytes).
    TooLong,
    /// It does not begin with `<`.
    NotXml,
    /// A document type is declared, the only source of entities of its own.
    DocumentType,
    /// More elements are open than [`Limits::depth`](super::Limits::depth).
    TooDeep,
    /// It has more elements and texts than [`Limits::nodes`](super::Limits::nodes).
    TooManyNodes,
    /// An element has more attributes than [`Limits::attributes`](super::Limits::attributes).
    TooManyAttributes,
    /// It is not well-formed XML.
    Malformed {
        /// What was found, in one sentence.
        message: String,
        /// A few words to set beside the location.
        label: &'static str,
        /// What was expected and what to do.
        help: String,
    },
}

impl Trouble {
    /// At bytes of a text, of which the first line is marked.
    pub(super) fn new(text: &str, at: Range<usize>, what: What) -> Self {
        let marked = text.get(at.clone()).unwrap_or_default();
        let line = marked.find(['\n', '\r']).unwrap_or(marked.len());
        Self { at: at.start..at.start + line, what }
    }

    /// Of a text that is not well-formed.
    pub(super) fn malformed(
        text: &str,
        at: Range<usize>,
        message: impl Into<String>,
        label: &'static str,
        help: impl Into<String>,
    ) -> Self {
        Self::new(text, at, What::Malformed { message: message.into(), label, help: help.into() })
    }
}

/// Line and column of a byte, both counted from 1, the column in characters.
pub(super) fn line_and_column(text: &str, position: usize) -> (usize, usize) {
    let before = &text[..position];
    let line = before.rfind('\n').map_or(0, |end| end + 1);
    (1 + before.bytes().filter(|byte| *byte == b'\n').count(), 1 + before[line..].chars().count())
}

/// A piece of the text as a message shows it: not more than a few words of it.
pub(super) fn shown(piece: &str) -> String {
    const MOST: usize = 60;
    let mut start: String = piece.chars().take(MOST).map(|c| if c.is_whitespace() { ' ' } else { c }).collect();
    if piece.chars().nth(MOST).is_some() {
        start.push('…');
    }
    start
}
