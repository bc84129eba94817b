//! XML as the rest needs it: elements and attributes of the vocabulary, each text with the way back to its place.

use super::desk::Desk;
use super::guard::{MOST_NODES, tag_end};
use super::vocabulary::{Kind, kind_of};
use crate::error::words::{any_of, meant};
use std::ops::Range;

/// A text of the document, with escapes and comments taken out, and where each of its bytes came from.
#[derive(Debug, Clone, Default)]
pub(super) struct Text {
    pub(super) text: String,
    /// For each byte, where the character that it belongs to begins and ends in the source.
    origin: Vec<(usize, usize)>,
    /// Where the whole text begins in the source.
    start: usize,
}

impl Text {
    /// The bytes of the source behind a part of the text.
    pub(super) fn place(&self, at: &Range<usize>) -> Range<usize> {
        let end_of =
            |position: usize| position.checked_sub(1).and_then(|last| self.origin.get(last)).map(|last| last.1);
        let end = end_of(at.end.min(self.origin.len())).unwrap_or(self.start);
        let start = self.origin.get(at.start).map_or(end, |first| first.0);
        if at.is_empty() { start..start } else { start..end.max(start) }
    }

    /// The bytes of the source behind the whole text, blanks around it left out.
    pub(super) fn whole(&self) -> Range<usize> {
        let trimmed = self.text.trim();
        let start = self.text.len() - self.text.trim_start().len();
        self.place(&(start..start + trimmed.len()))
    }

    fn push(&mut self, c: char, start: usize, length: usize) {
        self.text.push(c);
        self.origin.extend(std::iter::repeat_n((start, start + length), c.len_utf8()));
    }

    /// Takes a raw piece of XML that begins at `start` in the source.
    fn decode(raw: &str, start: usize) -> Self {
        let mut found = Self { start, ..Self::default() };
        let mut position = 0;
        while let Some(c) = raw[position..].chars().next() {
            let rest = &raw[position..];
            let here = start + position;
            if rest.starts_with("<!--") {
                position += rest.find("-->").map_or(rest.len(), |end| end + 3);
            } else if let Some(inner) = rest.strip_prefix("<![CDATA[") {
                let end = inner.find("]]>").unwrap_or(inner.len());
                for (at, c) in inner[..end].char_indices() {
                    found.push(c, here + 9 + at, c.len_utf8());
                }
                position += (9 + end + 3).min(rest.len());
            } else if let Some((c, length)) = escape(rest) {
                found.push(c, here, length);
                position += length;
            } else {
                found.push(c, here, c.len_utf8());
                position += c.len_utf8();
            }
        }
        found
    }
}

/// The character that an escape at the start of a text stands for, and the bytes it takes.
fn escape(rest: &str) -> Option<(char, usize)> {
    let inner = rest.strip_prefix('&')?;
    let end = inner.find(';').filter(|end| *end <= 10)?;
    let name = &inner[..end];
    let c = match name {
        "lt" => '<',
        "gt" => '>',
        "amp" => '&',
        "quot" => '"',
        "apos" => '\'',
        _ => {
            let number = name.strip_prefix('#')?;
            let code = match number.strip_prefix('x') {
                Some(hex) => u32::from_str_radix(hex, 16).ok()?,
                None => number.parse().ok()?,
            };
            char::from_u32(code)?
        }
    };
    Some((c, end + 2))
}

/// An element that the vocabulary knows.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) kind: &'static Kind,
    /// Bytes of the name in its first tag.
    pub(super) at: Range<usize>,
    attributes: Vec<(&'static str, Text)>,
    /// What stands inside, without child elements.
    pub(super) text: Text,
    pub(super) children: Vec<Element>,
}

impl Element {
    pub(super) fn attribute(&self, name: &str) -> Option<&Text> {
        self.attributes.iter().find(|(known, _)| *known == name).map(|(_, text)| text)
    }

    /// The trimmed text of an attribute, or an empty one.
    pub(super) fn word(&self, name: &str) -> String {
        self.attribute(name).map_or(String::new(), |text| text.text.trim().to_owned())
    }

    /// Where an attribute's value stands, or else the element's name.
    pub(super) fn place(&self, name: &str) -> Range<usize> {
        self.attribute(name).map_or(self.at.clone(), Text::whole)
    }

    pub(super) fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Element> {
        self.children.iter().filter(move |child| child.kind.name == name)
    }
}

/// The root element; faults are told to the desk. Nothing when there is no tree.
pub(super) fn tree(desk: &mut Desk) -> Option<Element> {
    let source = desk.source.clone();
    let options = roxmltree::ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..Default::default() };
    let tree = match roxmltree::Document::parse_with_options(&source.text, options) {
        Ok(tree) => tree,
        Err(error) => {
            broken(desk, &error);
            return None;
        }
    };
    let root = tree.root_element();
    let name = root.tag_name().name();
    if name != "eml" {
        let help = match name {
            "sbml" => {
                "this is an SBML model: give it where SBML is read, or translate it with `pseudopod eml from-sbml`"
            }
            _ => "an EML document is <eml name=\"…\"> … </eml>",
        };
        desk.fault(name_place(&root), &format!("the document is a <{name}> and not an <eml>"), "not EML", help);
        return None;
    }
    kind_of(name).map(|kind| element(desk, &root, kind))
}

fn name_place(node: &roxmltree::Node) -> Range<usize> {
    let start = node.range().start + 1;
    start..start + node.tag_name().name().len()
}

/// Tells what makes the text no XML.
fn broken(desk: &mut Desk, error: &roxmltree::Error) {
    let position = error.pos();
    let source = desk.source.clone();
    let before: usize = source.text.split_inclusive('\n').take(position.row.max(1) as usize - 1).map(str::len).sum();
    let line = source.text[before..].lines().next().unwrap_or_default();
    let column = line.char_indices().nth(position.col.max(1) as usize - 1).map_or(line.len(), |(at, _)| at);
    let at = before + column;
    let told = error.to_string();
    let told = told.rsplit_once(" at ").map_or(told.as_str(), |(told, _)| told);
    let length = source.text[at..].chars().next().filter(|c| *c != '\n').map_or(0, char::len_utf8);
    if !source.text.trim_start_matches('\u{feff}').trim_start().starts_with('<') {
        let help = "an EML document is <eml name=\"…\"> … </eml>, an SBML model begins with <sbml; an experiment (TOML) is checked by `pseudopod check`";
        desk.fault(at..at + length, "this is not XML", "XML begins with <", help);
        return;
    }
    let help = "close every element, quote every attribute, write &lt; for < and &amp; for & (or `lt` and `and`)";
    desk.fault(at..at + length, &format!("this is not well-formed XML: {told}"), "here", help);
}

fn element(desk: &mut Desk, node: &roxmltree::Node, kind: &'static Kind) -> Element {
    let at = name_place(node);
    let attributes = attributes(desk, node, kind, &at);
    let mut children = Vec::new();
    for child in node.children().filter(roxmltree::Node::is_element) {
        let name = child.tag_name().name();
        match kind_of(name).filter(|child| kind.children.contains(&child.name)) {
            Some(child_kind) => children.push(element(desk, &child, child_kind)),
            None => unknown_child(desk, kind, name, name_place(&child)),
        }
    }
    let text = inner_text(desk, node, kind);
    Element { kind, at, attributes, text, children }
}

fn attributes(
    desk: &mut Desk,
    node: &roxmltree::Node,
    kind: &'static Kind,
    at: &Range<usize>,
) -> Vec<(&'static str, Text)> {
    let known = || kind.required.iter().chain(kind.optional).copied();
    let mut found = Vec::new();
    for attribute in node.attributes().filter(|attribute| attribute.namespace().is_none()) {
        let range = attribute.range_value();
        match known().find(|name| *name == attribute.name()) {
            Some(name) => found.push((name, Text::decode(&desk.source.text[range.clone()], range.start))),
            None => {
                let name = attribute.name();
                let message = format!("<{}> has no attribute `{name}`", kind.name);
                let help = match meant(name, known()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => format!("it has {}", any_of(known())),
                };
                desk.fault(attribute.range_qname(), &message, "unknown attribute", &help);
            }
        }
    }
    for name in kind.required.iter().filter(|name| found.iter().all(|(known, _)| known != *name)) {
        let message = match (kind.name, *name) {
            ("variable", "initial") => "the variable has no initial value".to_owned(),
            ("input", "default") => "the input has no default: the value that stands until one is given".to_owned(),
            (element, name) => format!("<{element}> has no `{name}`"),
        };
        desk.fault(
            at.clone(),
            &message,
            &format!("`{name}` is missing"),
            &format!("write <{} {name}=\"…\">", kind.name),
        );
    }
    found
}

fn unknown_child(desk: &mut Desk, kind: &Kind, name: &str, at: Range<usize>) {
    let message = format!("<{name}> cannot stand in <{}>", kind.name);
    let help = match meant(name, kind.children.iter().copied()) {
        Some(near) => format!("did you mean <{near}>?"),
        None if kind.children.is_empty() => format!("<{}> holds no elements", kind.name),
        None => format!("it holds {}", any_of(kind.children.iter().copied())),
    };
    let label = if kind_of(name).is_some() { "not here" } else { "unknown element" };
    desk.fault(at, &message, label, &help);
}

/// The text inside an element; text where none belongs is told.
fn inner_text(desk: &mut Desk, node: &roxmltree::Node, kind: &Kind) -> Text {
    let range = node.range();
    let raw = &desk.source.text[range.clone()];
    let first = tag_end(raw);
    if kind.text {
        let last = raw.rfind("</").unwrap_or(first).max(first);
        // Without children: a child element has been told already.
        if node.children().any(|child| child.is_element()) {
            return Text::default();
        }
        return Text::decode(&raw[first.min(last)..last], range.start + first.min(last));
    }
    let stray =
        node.children().find(|child| child.is_text() && child.text().is_some_and(|text| !text.trim().is_empty()));
    if let Some(stray) = stray {
        let range = stray.range();
        let text = &desk.source.text[range.clone()];
        let start = range.start + text.len() - text.trim_start().len();
        let at = start..start + text.trim().len().min(40).min(text.trim().lines().next().map_or(0, str::len));
        let help = "remove it, or make it a comment: <!-- … -->";
        desk.fault(at, &format!("text in <{}>, which holds none", kind.name), "this text", help);
    }
    Text::default()
}
