//! Goes through a document element by element.

use super::kept::{Attributes, Foreign};
use super::number::finite;
use super::page::{LIMITS, Lines, Page};
use super::warning::{Warning, Warnings};
use crate::error::{Error, Result};
use crate::xml::{Attribute, Event, Reader};
use std::borrow::Cow;
use std::ops::Range;

/// The namespace of the attribute `type` that tells kinds of elements apart.
pub(super) const INSTANCE: &str = "http://www.w3.org/2001/XMLSchema-instance";

/// So many prefixes are looked after: each costs time at every element, and no document has a tenth of them.
const MOST_LOST: usize = 50;

/// The beginning of an element.
#[derive(Debug, Clone)]
pub(super) struct Tag<'a> {
    /// Its name without a prefix.
    pub name: &'a str,
    /// Bytes of its name.
    pub name_at: Range<usize>,
    /// First byte of its tag.
    pub start: usize,
}

/// A value of an attribute, and its bytes.
#[derive(Debug)]
pub(super) struct Value<'a> {
    pub text: Cow<'a, str>,
    pub at: Range<usize>,
}

/// Goes through a document. The attributes of the element that began last are taken one by one; what is left of them is
/// kept.
pub(super) struct Cursor<'a> {
    pub page: &'a Page,
    reader: Reader<'a>,
    attributes: Vec<Attribute<'a>>,
    lines: Lines,
    pub warnings: Warnings,
    /// Prefixes that were declared by elements whose attributes are not kept.
    lost: Vec<&'a str>,
}

impl<'a> Cursor<'a> {
    /// At the root of a document, which is the element that began last.
    pub fn at_root(page: &'a Page, warnings: Warnings) -> Result<(Self, Tag<'a>)> {
        let mut reader = Reader::new(page.text(), LIMITS).map_err(|trouble| page.broken(trouble))?;
        let first = reader.event().map_err(|trouble| page.broken(trouble))?;
        let Some(Event::Start(root)) = first else {
            return Err(page.fault(0..0, "there is no element in the document", "ends here", "write one"));
        };
        let tag = Tag { name: root.name, name_at: root.name_at, start: root.at.start };
        let language = page.language;
        if !language.roots.contains(&tag.name) {
            let message = format!("the document is a <{}> and not a <{}>", tag.name, language.roots.join("> or <"));
            let help = format!("give a document of {}", language.name);
            return Err(page.fault(tag.name_at, message, &format!("not {}", language.name), help));
        }
        let attributes = reader.attributes().to_vec();
        Ok((Self { page, reader, attributes, lines: Lines::default(), warnings, lost: Vec::new() }, tag))
    }

    /// Goes through the elements in the one that began last, to its end. Whoever is called with the beginning of one goes
    /// to its end. Texts between them mean nothing.
    pub fn each(&mut self, mut visit: impl FnMut(&mut Self, Tag<'a>) -> Result<()>) -> Result<()> {
        loop {
            match self.event()? {
                Some(Event::Start(start)) => {
                    let tag = Tag { name: start.name, name_at: start.name_at, start: start.at.start };
                    self.attributes.clear();
                    self.attributes.extend_from_slice(self.reader.attributes());
                    visit(self, tag)?;
                }
                Some(Event::Text { text, at }) => {
                    if !text.trim().is_empty() {
                        self.warn(at.start, || ("a text stands between elements".into(), "it was left out"));
                    }
                }
                Some(Event::End { .. }) | None => return Ok(()),
            }
        }
    }

    /// Goes to the end of the element that began last, in which nothing is expected.
    pub fn skip(&mut self, tag: &Tag) -> Result<()> {
        self.each(|cursor, child| {
            let (name, parent) = (child.name, tag.name);
            cursor.warn(child.start, || (format!("<{name}> stands in <{parent}>"), "it was left out"));
            cursor.foreign(child).map(|_| ())
        })
    }

    /// The text in the element that began last, which has no elements, and the bytes of it.
    pub fn text(&mut self, tag: &Tag) -> Result<(String, Range<usize>)> {
        let mut text = String::new();
        let mut at: Option<Range<usize>> = None;
        loop {
            match self.event()? {
                Some(Event::Text { text: piece, at: bytes }) => {
                    text.push_str(&piece);
                    at = Some(at.map_or(bytes.clone(), |at| at.start..bytes.end));
                }
                Some(Event::Start(start)) => {
                    let message = format!("<{}> stands in <{}>, which is a text", start.name, tag.name);
                    return Err(self.page.fault(start.name_at, message, "not a text", "write the text only"));
                }
                Some(Event::End { .. }) | None => {
                    let at = at.unwrap_or(tag.name_at.clone());
                    let raw = &self.page.text()[at.clone()];
                    let start = at.start + raw.len() - raw.trim_start().len();
                    return Ok((text, start..start + raw.trim().lines().next().unwrap_or_default().trim_end().len()));
                }
            }
        }
    }

    /// Keeps the element that began last, to its end.
    pub fn foreign(&mut self, tag: Tag) -> Result<Foreign> {
        let declared = self.lost_declarations();
        let mut depth = 1;
        let mut end = self.page.text().len();
        while depth > 0 {
            match self.event()? {
                Some(Event::Start(_)) => depth += 1,
                Some(Event::Text { .. }) => {}
                Some(Event::End { at }) => (depth, end) = (depth - 1, at.end),
                None => break,
            }
        }
        let text = &self.page.text()[tag.start..end];
        let (name, rest) = text.split_at(tag.name_at.end - tag.start);
        let used = declared.iter().filter(|(prefix, _)| text.contains(&format!("{prefix}:")));
        let added: String = used.map(|(prefix, name)| format!(" xmlns:{prefix}=\"{name}\"")).collect();
        Ok(Foreign([name, &added, rest].concat().into()))
    }

    /// What the prefixes stand for that are declared where it is not kept; the element that began last has not declared them.
    fn lost_declarations(&self) -> Vec<(&'a str, String)> {
        let own = |prefix: &&str| self.reader.declarations().any(|(declared, _)| declared == *prefix);
        let lost = self.lost.iter().copied().filter(|prefix| !own(prefix));
        let quoted = |name: &str| name.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
        lost.filter_map(|prefix| Some((prefix, quoted(self.reader.bound(prefix)?)))).collect()
    }

    /// Keeps the element that began last, which does not belong into another.
    pub fn unknown(&mut self, tag: Tag, parent: &'static str) -> Result<Foreign> {
        let name = tag.name;
        self.warn(tag.start, || (format!("<{name}> is not known in <{parent}>"), "it is kept as it is"));
        self.foreign(tag)
    }

    /// Takes an attribute of the element that began last.
    pub fn take(&mut self, name: &str) -> Option<Value<'a>> {
        self.take_if(|attribute| attribute.name == name && attribute.namespace.is_none())
    }

    /// Takes the attribute `type` of XML Schema; without a namespace, or of another one, where it has none.
    pub fn take_type(&mut self) -> Option<Value<'a>> {
        let named = |attribute: &&Attribute| attribute.name == "type";
        let all = || self.attributes.iter().filter(named);
        let right = all().find(|own| own.namespace.is_some_and(|name| self.reader.namespace(name) == INSTANCE));
        let start = right.or_else(|| all().find(|own| own.namespace.is_some())).or_else(|| all().next())?.value_at();
        self.take_if(|attribute| attribute.value_at() == start)
    }

    fn take_if(&mut self, wanted: impl Fn(&Attribute) -> bool) -> Option<Value<'a>> {
        let index = self.attributes.iter().position(wanted)?;
        let attribute = self.attributes.remove(index);
        let at = attribute.value_at();
        Some(Value { text: attribute.value, at })
    }

    /// Takes an attribute as a text.
    pub fn take_text(&mut self, name: &str) -> Option<Box<str>> {
        self.take(name).map(|value| value.text.into())
    }

    /// Takes an attribute that the element must have.
    pub fn required(&mut self, tag: &Tag, name: &str) -> Result<Value<'a>> {
        self.take(name).ok_or_else(|| {
            let message = format!("<{}> has no `{name}`", tag.name);
            self.page.fault(tag.name_at.clone(), message, "incomplete", format!("add {name}=\"…\""))
        })
    }

    /// Takes a number that the element must have.
    pub fn number(&mut self, tag: &Tag, name: &str) -> Result<f64> {
        let value = self.required(tag, name)?;
        self.finite(&value, name)
    }

    /// Takes a number that the element may have.
    pub fn optional_number(&mut self, name: &str) -> Result<Option<f64>> {
        self.take(name).map(|value| self.finite(&value, name)).transpose()
    }

    /// Reads a value as a finite number.
    pub fn finite(&self, value: &Value, name: &str) -> Result<f64> {
        finite(&value.text).ok_or_else(|| {
            let message = format!("`{name}` is \"{}\", which is no finite number", shown(&value.text));
            self.page.fault(value.at.clone(), message, "expected a number", "write numbers like 1.5 or -2e-3")
        })
    }

    /// Takes the index that the element must have, from 0 on.
    pub fn index(&mut self, tag: &Tag, name: &str) -> Result<(u32, Range<usize>)> {
        let value = self.required(tag, name)?;
        let at = value.at.clone();
        value.text.trim().parse().map(|index| (index, at)).map_err(|_| {
            let message = format!("`{name}` is \"{}\", which is no index", shown(&value.text));
            let help = format!("indices are whole numbers from 0 to {}", u32::MAX);
            self.page.fault(value.at, message, "expected an index", help)
        })
    }

    /// Takes what a document says of how many things it has, which is a hint.
    pub fn count(&mut self, name: &str) -> Option<u64> {
        let value = self.take(name)?;
        let count = value.text.trim().parse().ok();
        if count.is_none() {
            let found = || format!("`{name}` is \"{}\", which is no number of things", shown(&value.text));
            self.warn(value.at.start, || (found(), "they were counted"));
        }
        count
    }

    /// The attributes that were not taken.
    pub fn rest(&mut self) -> Attributes {
        let text = self.page.text();
        let declared = self.reader.declarations().map(|(prefix, name)| {
            let key = if prefix.is_empty() { "xmlns".to_owned() } else { format!("xmlns:{prefix}") };
            (Box::<str>::from(key), Box::<str>::from(name))
        });
        let declared: Vec<(Box<str>, Box<str>)> = declared.collect();
        let lost = match self.lost.is_empty() {
            true => Vec::new(),
            false => self.lost_declarations(),
        };
        let left = self.attributes.drain(..).map(|own| (Box::<str>::from(&text[own.name_at(text)]), own.value.into()));
        let left: Vec<(Box<str>, Box<str>)> = left.collect();
        let used = |prefix: &str| left.iter().any(|(name, _)| name.split_once(':').is_some_and(|own| own.0 == prefix));
        let lost = lost.iter().filter(|(prefix, _)| used(prefix));
        let lost: Vec<(Box<str>, Box<str>)> = lost
            .map(|(prefix, _)| {
                let name = self.reader.bound(prefix).unwrap_or_default();
                (format!("xmlns:{prefix}").into(), name.into())
            })
            .collect();
        declared.into_iter().chain(lost).chain(left).collect()
    }

    /// Tells of attributes that have nowhere to be kept.
    pub fn no_more(&mut self, tag: &Tag) {
        for (prefix, _) in self.reader.declarations().filter(|(prefix, _)| !prefix.is_empty()) {
            if self.lost.len() < MOST_LOST && !self.lost.contains(&prefix) {
                self.lost.push(prefix);
            }
        }
        if let Some(first) = self.attributes.first().map(|attribute| attribute.name) {
            let name = tag.name;
            self.warn(tag.start, || (format!("<{name}> has an attribute `{first}`"), "it was left out"));
        }
    }

    /// Warns of what stands at a position.
    pub fn warn(&mut self, position: usize, told: impl FnOnce() -> (String, &'static str)) {
        let (lines, text) = (&mut self.lines, self.page.text());
        self.warnings.add(|| {
            let (found, done) = told();
            Warning { line: lines.at(text, position), found, done }
        });
    }

    /// The line of a position, from 1.
    pub fn line(&mut self, position: usize) -> usize {
        self.lines.at(self.page.text(), position)
    }

    /// Makes sure that nothing follows the root, and yields the warnings.
    pub fn finish(mut self) -> Result<Warnings> {
        while self.event()?.is_some() {}
        Ok(self.warnings)
    }

    fn event(&mut self) -> Result<Option<Event<'a>>> {
        self.reader.event().map_err(|trouble| self.page.broken(trouble))
    }
}

/// A value as a message shows it.
pub(super) fn shown(text: &str) -> String {
    const MOST: usize = 60;
    let start: String = text.chars().take(MOST).map(|c| if c.is_whitespace() { ' ' } else { c }).collect();
    if text.chars().nth(MOST).is_some() { start + "…" } else { start }
}

/// A fault among others, for who collects them.
pub(super) fn faults_of(error: Error) -> Vec<crate::error::Fault> {
    match error {
        Error::Input(faults) => faults,
        other => vec![crate::error::Fault::new(other.to_string())],
    }
}
