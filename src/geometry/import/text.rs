//! Words of a text file with their locations, so that a fault can point at them.

use crate::Vec3;
use crate::error::{Fault, Location, Source};
use std::sync::Arc;

/// A word and the byte where it starts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Word<'a> {
    pub text: &'a str,
    pub start: usize,
}

/// The text of a file, ready to be pointed into.
#[derive(Debug)]
pub(super) struct Text {
    source: Arc<Source>,
}

impl Text {
    /// The text in `bytes`; what is not UTF-8 becomes a replacement character.
    pub fn new(name: &str, bytes: &[u8]) -> Self {
        let text = String::from_utf8_lossy(bytes).into_owned();
        Self { source: Arc::new(Source { name: name.into(), text }) }
    }

    /// The words of every line that has any.
    pub fn lines(&self) -> impl Iterator<Item = Vec<Word<'_>>> {
        let mut start = 0;
        self.source.text.split_inclusive('\n').filter_map(move |line| {
            let words = words(line, start);
            start += line.len();
            (!words.is_empty()).then_some(words)
        })
    }

    /// All words from byte `start` on.
    pub fn words_from(&self, start: usize) -> impl Iterator<Item = Word<'_>> {
        let mut offset = start;
        self.source.text[start..].split_inclusive(char::is_whitespace).filter_map(move |piece| {
            let word = Word { text: piece.trim(), start: offset };
            offset += piece.len();
            (!word.text.is_empty()).then_some(word)
        })
    }

    /// A fault that points at a word.
    pub fn fault(&self, at: Word, message: impl Into<String>, label: &str, help: &str) -> Fault {
        let position =
            Location { source: self.source.clone(), start: at.start, length: at.text.len(), label: label.into() };
        Fault::new(message).at(position).help(help)
    }

    /// A fault at the end of the text.
    pub fn fault_at_end(&self, message: impl Into<String>, help: &str) -> Fault {
        let end = Word { text: "", start: self.source.text.trim_end().len() };
        self.fault(end, message, "the file ends here", help)
    }

    /// Reads a coordinate.
    pub fn coordinate(&self, word: Word) -> Result<f64, Fault> {
        match word.text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(self.fault(
                word,
                format!("`{}` is not a coordinate", word.text),
                "expected a finite number",
                "write coordinates like 1.5 or -2e-3",
            )),
        }
    }

    /// Reads the three coordinates behind the keyword of a line; what follows them is passed over.
    pub fn point(&self, line: &[Word]) -> Result<Vec3, Fault> {
        let [_, x, y, z, ..] = line else {
            return Err(self.fault(
                line[0],
                format!("`{}` has {} coordinates", line[0].text, line.len() - 1),
                "expected x, y and z",
                "write three numbers",
            ));
        };
        Ok(Vec3::new(self.coordinate(*x)?, self.coordinate(*y)?, self.coordinate(*z)?))
    }
}

/// The words of a line that starts at byte `start` of the text.
fn words(line: &str, start: usize) -> Vec<Word<'_>> {
    line.split_whitespace()
        .map(|text| Word { text, start: start + (text.as_ptr() as usize - line.as_ptr() as usize) })
        .collect()
}
