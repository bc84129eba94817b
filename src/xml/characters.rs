//! Characters: which XML has, and which ones texts and values stand for.

use super::blank::is_blank;
use super::malformed::{unescaped, unknown_reference};
use super::trouble::Trouble;
use std::borrow::Cow;
use std::ops::Range;

/// The first character that XML has not, with its position.
pub(super) fn foreign(text: &str) -> Option<(usize, char)> {
    // Control characters, and the first byte of what may be U+FFFE or U+FFFF.
    let suspect = |byte: u8| byte < 0x20 && !matches!(byte, b'\t' | b'\n' | b'\r') || byte == 0xEF;
    let clean = text.as_bytes().chunks(128).all(|chunk| !chunk.iter().fold(false, |found, &b| found | suspect(b)));
    if clean { None } else { text.char_indices().find(|(_, c)| !is_xml(*c)) }
}

fn is_xml(c: char) -> bool {
    !matches!(c, '\0'..='\u{8}' | '\u{b}' | '\u{c}' | '\u{e}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}')
}

/// The character that `&name;` stands for.
pub fn referred(name: &str) -> Option<char> {
    let number = match name {
        "lt" => return Some('<'),
        "gt" => return Some('>'),
        "amp" => return Some('&'),
        "quot" => return Some('"'),
        "apos" => return Some('\''),
        _ => name.strip_prefix('#')?,
    };
    let (digits, radix) = number.strip_prefix('x').map_or((number, 10), |digits| (digits, 16));
    let good = digits.chars().all(|c| c.is_digit(radix));
    let code = u32::from_str_radix(digits, radix).ok().filter(|_| good)?;
    char::from_u32(code).filter(|c| is_xml(*c))
}

/// Bytes before the first blank.
pub(super) fn word_length(text: &str) -> usize {
    text.bytes().position(|byte| is_blank(byte.into())).unwrap_or(text.len())
}

/// The value of an attribute that stands at some bytes of a text.
pub(super) fn value(text: &str, at: Range<usize>) -> Result<Cow<'_, str>, Trouble> {
    let raw = &text[at.clone()];
    let special = |byte: u8| matches!(byte, b'&' | b'<' | b'\t' | b'\n' | b'\r');
    let Some(first) = raw.bytes().position(special) else { return Ok(Cow::Borrowed(raw)) };
    let mut value = String::with_capacity(raw.len());
    value.push_str(&raw[..first]);
    let mut rest = &raw[first..];
    while let Some(sign) = rest.chars().next() {
        let position = at.end - rest.len();
        let taken = match sign {
            '<' => return Err(unescaped(text, position)),
            '&' => {
                let end = rest.find(';').map(|end| end + 1);
                let length = end.unwrap_or(1);
                let referred = end.and_then(|end| referred(&rest[1..end - 1]));
                value.push(referred.ok_or_else(|| unknown_reference(text, position..position + length))?);
                length
            }
            '\r' if rest[1..].starts_with('\n') => {
                value.push(' ');
                2
            }
            c => {
                value.push(if is_blank(c) { ' ' } else { c });
                c.len_utf8()
            }
        };
        rest = &rest[taken..];
    }
    Ok(Cow::Owned(value))
}

/// A text without references: ends of lines are `\n`.
pub(super) fn with_plain_lines(raw: &str) -> Cow<'_, str> {
    if raw.contains('\r') { Cow::Owned(raw.replace("\r\n", "\n").replace('\r', "\n")) } else { Cow::Borrowed(raw) }
}

/// The characters that a text or a value stands for, each with its bytes in the document: references are replaced,
/// the marks of CDATA sections left out, blanks and ends of lines kept as they are.
#[derive(Debug, Clone)]
pub struct Characters<'a> {
    text: &'a str,
    position: usize,
    end: usize,
    /// Where the CDATA section ends that the position is in.
    literal: Option<usize>,
}

impl<'a> Characters<'a> {
    /// Of a part of a well-formed document, which begins and ends between characters.
    pub fn new(text: &'a str, at: Range<usize>) -> Self {
        Self { text, position: at.start, end: at.end, literal: None }
    }
}

impl Iterator for Characters<'_> {
    type Item = (char, Range<usize>);

    fn next(&mut self) -> Option<Self::Item> {
        const OPEN: &str = "<![CDATA[";
        const CLOSE: &str = "]]>";
        loop {
            let rest = &self.text[self.position..self.end];
            if self.literal == Some(self.position) {
                self.position += CLOSE.len().min(rest.len());
                self.literal = None;
            } else if self.literal.is_none() && rest.starts_with(OPEN) {
                self.position += OPEN.len();
                let inside = &self.text[self.position..self.end];
                self.literal = Some(self.position + inside.find(CLOSE).unwrap_or(inside.len()));
            } else {
                let sign = rest.chars().next()?;
                let end = if sign == '&' && self.literal.is_none() { rest.find(';') } else { None };
                let reference = end.and_then(|end| Some((referred(&rest[1..end])?, end + 1)));
                let (c, length) = reference.unwrap_or((sign, sign.len_utf8()));
                let start = self.position;
                self.position += length;
                return Some((c, start..self.position));
            }
        }
    }
}
