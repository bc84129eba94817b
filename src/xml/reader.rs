//! The stream of events.

use super::Limits;
use super::attributes::{Attribute, TagReader};
use super::blank::is_blank;
use super::characters::{foreign, referred, with_plain_lines, word_length};
use super::malformed::*;
use super::names::{Namespace, Namespaces, is_name, parts};
use super::trouble::{Trouble, What};
use quick_xml::events::Event as Token;
use std::borrow::Cow;
use std::ops::Range;

/// What stands next in a document.
#[derive(Debug)]
pub enum Event<'a> {
    /// An element begins; [`Reader::attributes`] has its attributes.
    Start(Start<'a>),
    /// A text within an element. A text with references or CDATA sections comes in several pieces.
    Text {
        /// What it says.
        text: Cow<'a, str>,
        /// Its bytes.
        at: Range<usize>,
    },
    /// The element that began last and has not ended yet ends.
    End {
        /// Bytes of its last tag.
        at: Range<usize>,
    },
}

/// The beginning of an element.
#[derive(Debug)]
pub struct Start<'a> {
    /// Its name without a prefix.
    pub name: &'a str,
    /// Its namespace.
    pub namespace: Option<Namespace>,
    /// Bytes of its name, with the prefix.
    pub name_at: Range<usize>,
    /// Bytes of the tag.
    pub at: Range<usize>,
}

/// Reads a document from its beginning to its end.
pub struct Reader<'a> {
    text: &'a str,
    tokens: quick_xml::Reader<&'a [u8]>,
    /// Bytes that the tokens do not have: byte order marks in front.
    skipped: usize,
    depth_limit: usize,
    tags: TagReader<'a>,
    namespaces: Namespaces<'a>,
    attributes: Vec<Attribute<'a>>,
    /// Names of the elements that are open.
    open: Vec<Range<usize>>,
    /// The tag that was beginning and end of an element of which the end is not told yet.
    empty: Option<Range<usize>>,
    /// Whether the root element has begun.
    begun: bool,
}

impl<'a> Reader<'a> {
    /// A reader at the beginning of a text.
    ///
    /// # Errors
    /// The text is too long, is no XML at all, or has characters that XML has not.
    pub fn new(text: &'a str, limits: Limits) -> Result<Self, Trouble> {
        // Positions are kept as 32-bit numbers.
        if text.len() > limits.bytes.min(u32::MAX as usize) {
            return Err(Trouble::new(text, 0..0, What::TooLong));
        }
        let body = text.trim_start_matches('\u{feff}');
        let visible = body.trim_start();
        if !visible.starts_with('<') {
            let start = text.len() - visible.len();
            let length = visible.chars().next().map_or(0, char::len_utf8);
            return Err(Trouble::new(text, start..start + length, What::NotXml));
        }
        if let Some((at, c)) = foreign(text) {
            return Err(foreign_character(text, at, c));
        }
        let mut tokens = quick_xml::Reader::from_str(body);
        // Told here, with locations.
        tokens.config_mut().check_end_names = false;
        tokens.config_mut().allow_unmatched_ends = true;
        Ok(Self {
            text,
            tokens,
            skipped: text.len() - body.len(),
            depth_limit: limits.depth,
            tags: TagReader { text, most: limits.attributes },
            namespaces: Namespaces::new(),
            attributes: Vec::new(),
            open: Vec::new(),
            empty: None,
            begun: false,
        })
    }

    /// The attributes of the element that began last.
    pub fn attributes(&self) -> &[Attribute<'a>] {
        &self.attributes
    }

    /// The namespaces that the element that began last declares: prefixes, empty for elements without one, and names.
    pub fn declarations(&self) -> impl Iterator<Item = (&'a str, &str)> {
        let depth = self.open.len();
        self.namespaces.declared_at(depth)
    }

    /// The name of the namespace that a prefix stands for in the element that began last.
    pub fn bound(&self, prefix: &str) -> Option<&str> {
        self.namespaces.of(prefix).map(|namespace| self.namespace(namespace))
    }

    /// The name of a namespace.
    pub fn namespace(&self, namespace: Namespace) -> &str {
        &self.namespaces.names[namespace.index()]
    }

    /// The attributes of the element that began last, moved to the end of a list.
    pub(super) fn move_attributes(&mut self, list: &mut Vec<Attribute<'a>>) {
        list.append(&mut self.attributes);
    }

    /// The names of all namespaces met.
    pub(super) fn into_namespaces(self) -> Vec<Cow<'a, str>> {
        self.namespaces.names
    }

    /// The next event; none at the end of the document. After an error nothing more is to be read.
    ///
    /// # Errors
    /// The document is not well-formed, declares a document type, or goes beyond the limits.
    pub fn event(&mut self) -> Result<Option<Event<'a>>, Trouble> {
        if let Some(at) = self.empty.take() {
            return Ok(Some(self.leave(at)));
        }
        loop {
            let start = self.position();
            let Ok(token) = self.tokens.read_event() else { return Err(cut_off(self.text, start)) };
            let at = start..self.position();
            match token {
                Token::Start(_) => return self.start(at, 1).map(Some),
                Token::Empty(_) => return self.start(at, 2).map(Some),
                Token::End(_) => return self.end(at).map(Some),
                Token::Text(_) | Token::CData(_) | Token::GeneralRef(_) => {
                    if let Some(event) = self.piece(at, &token)? {
                        return Ok(Some(event));
                    }
                }
                Token::Comment(words) => comment(self.text, at, &words)?,
                Token::PI(instruction) => {
                    let name = start + 2..start + 2 + instruction.target().len();
                    if !is_name(&self.text[name.clone()]) {
                        return Err(no_name(self.text, name));
                    }
                }
                Token::Decl(declaration) => {
                    if start != self.skipped || declaration.version().is_err() {
                        return Err(declaration_elsewhere(self.text, at));
                    }
                }
                Token::DocType(_) => return Err(document_type(self.text, start)),
                Token::Eof => return self.finish(),
            }
        }
    }

    #[inline]
    fn position(&self) -> usize {
        self.skipped + self.tokens.buffer_position() as usize
    }

    /// The start of an element; `closing` is the length of what ends its tag.
    #[inline]
    fn start(&mut self, at: Range<usize>, closing: usize) -> Result<Event<'a>, Trouble> {
        if closing == 1 && self.open.len() == self.depth_limit {
            return Err(Trouble::new(self.text, at.start..at.start + 1, What::TooDeep));
        }
        let content = at.start + 1..at.end - closing;
        let words = &self.text[content.clone()];
        let name_length = word_length(words);
        let name_at = content.start..content.start + name_length;
        if name_length == 0 {
            return Err(no_element(self.text, at.start));
        }
        let (prefix, name) = parts(&words[..name_length]).ok_or_else(|| no_name(self.text, name_at.clone()))?;
        if self.open.is_empty() && self.begun {
            return Err(second_root(self.text, name_at));
        }
        self.begun = true;
        self.open.push(name_at.clone());
        let depth = self.open.len();
        self.tags.read(content, name_length, depth, &mut self.namespaces, &mut self.attributes)?;
        let namespace = match prefix {
            "" => self.namespaces.default(),
            prefix => match self.namespaces.of(prefix) {
                Some(namespace) => Some(namespace),
                None => return Err(unknown_prefix(self.text, name_at.start..name_at.start + prefix.len())),
            },
        };
        if closing == 2 {
            self.empty = Some(at.clone());
        }
        Ok(Event::Start(Start { name, namespace, name_at, at }))
    }

    /// The last tag of an element.
    #[inline]
    fn end(&mut self, at: Range<usize>) -> Result<Event<'a>, Trouble> {
        let name = self.text[at.start + 2..at.end - 1].trim_end_matches(is_blank);
        match self.open.last() {
            Some(open) if self.text[open.clone()] == *name => Ok(self.leave(at)),
            Some(open) => Err(wrong_end(self.text, at, name, open.clone())),
            None => Err(closes_nothing(self.text, at, name)),
        }
    }

    /// Leaves the element that is open.
    #[inline]
    fn leave(&mut self, at: Range<usize>) -> Event<'a> {
        self.open.pop();
        self.namespaces.leave(self.open.len());
        Event::End { at }
    }

    /// A text, a CDATA section or a reference; nothing for blanks outside of the root element.
    #[inline]
    fn piece(&self, at: Range<usize>, token: &Token) -> Result<Option<Event<'a>>, Trouble> {
        let raw = &self.text[at.clone()];
        let text = match token {
            Token::GeneralRef(_) => {
                let c = referred(&raw[1..raw.len() - 1]).ok_or_else(|| unknown_reference(self.text, at.clone()))?;
                Cow::Owned(c.to_string())
            }
            Token::CData(_) => with_plain_lines(&raw[9..raw.len() - 3]),
            _ => {
                if let Some(end) = raw.find('>').and_then(|_| raw.find("]]>")) {
                    return Err(section_end(self.text, at.start + end));
                }
                with_plain_lines(raw)
            }
        };
        if !self.open.is_empty() {
            Ok(Some(Event::Text { text, at }))
        } else if matches!(token, Token::Text(_)) && raw.chars().all(is_blank) {
            Ok(None)
        } else {
            Err(outside(self.text, at))
        }
    }

    /// The end of the text.
    fn finish(&self) -> Result<Option<Event<'a>>, Trouble> {
        match self.open.last() {
            Some(open) => Err(not_closed(self.text, open.clone())),
            None if !self.begun => Err(no_root(self.text)),
            None => Ok(None),
        }
    }
}
