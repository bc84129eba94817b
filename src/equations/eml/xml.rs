//! XML as the rest needs it: elements and attributes of the vocabulary, each text with its places in the source.

use super::context::Context;
use super::vocabulary::{Kind, child_of, kind_of};
use crate::error::words::{any_of, meant};
use crate::xml::{Characters, Document, Limits, Node, Trouble, What};
use std::ops::Range;

/// The largest document that is read, bytes. A caller that reads a file looks at its length first.
pub const LARGEST_DOCUMENT: usize = 4 << 20;
/// The most levels of elements.
pub const DEEPEST_ELEMENT: usize = 16;
/// The most elements and texts.
pub const MOST_NODES: usize = 100_000;
/// The most attributes of an element.
pub const MOST_ATTRIBUTES: usize = 1000;

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
    pub(super) fn location(&self, at: &Range<usize>) -> Range<usize> {
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
        self.location(&(start..start + trimmed.len()))
    }

    /// A part of the text.
    pub(super) fn part(&self, range: &Range<usize>) -> Self {
        let start = self.origin.get(range.start).map_or(self.start, |first| first.0);
        Self { text: self.text[range.clone()].to_owned(), origin: self.origin[range.clone()].to_vec(), start }
    }

    /// Another text behind this one.
    pub(super) fn append(&mut self, other: &Self) {
        self.text.push_str(&other.text);
        self.origin.extend(&other.origin);
    }

    /// What stands for some bytes of the source.
    pub(super) fn write(&mut self, text: &str, at: &Range<usize>) {
        self.text.push_str(text);
        self.origin.extend(std::iter::repeat_n((at.start, at.end), text.len()));
    }

    fn push(&mut self, c: char, at: Range<usize>) {
        self.text.push(c);
        self.origin.extend(std::iter::repeat_n((at.start, at.end), c.len_utf8()));
    }

    /// Takes pieces of a page; where there are none the text is empty and stands at `start`.
    fn decode(page: &Page, start: usize, pieces: impl Iterator<Item = Range<usize>>) -> Self {
        let mut found = Self { start: page.first + start, ..Self::default() };
        for (c, at) in pieces.flat_map(|piece| Characters::new(page.text, piece)) {
            found.push(c, page.numbered(at));
        }
        found
    }
}

/// The text that a tree is made of.
struct Page<'a> {
    text: &'a str,
    /// The number of its first byte among those of all texts.
    first: usize,
}

impl Page<'_> {
    /// Bytes of the text as they are numbered in all texts.
    fn numbered(&self, at: Range<usize>) -> Range<usize> {
        self.first + at.start..self.first + at.end
    }
}

/// An element that the vocabulary knows.
#[derive(Debug, Clone)]
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
    pub(super) fn location(&self, name: &str) -> Range<usize> {
        self.attribute(name).map_or(self.at.clone(), Text::whole)
    }

    /// Bytes of all its texts and of those in it.
    pub(super) fn length(&self) -> usize {
        let own = self.attributes.iter().map(|(_, text)| text.text.len()).sum::<usize>() + self.text.text.len();
        own + self.children.iter().map(Self::length).sum::<usize>()
    }

    /// Visits all texts of the element and of those in it, with the names of element and attribute (none: what stands inside).
    pub(super) fn each_text(&mut self, visit: &mut impl FnMut(&str, &str, &mut Text)) {
        self.attributes.iter_mut().for_each(|(name, text)| visit(self.kind.name, name, text));
        visit(self.kind.name, "", &mut self.text);
        self.children.iter_mut().for_each(|child| child.each_text(visit));
    }

    /// Visits the texts of the element with the names of their attributes (none: what stands inside).
    pub(super) fn each_own_text(&mut self, visit: &mut impl FnMut(&str, &mut Text)) {
        self.attributes.iter_mut().for_each(|(name, text)| visit(name, text));
        visit("", &mut self.text);
    }

    /// Puts a text in the place of an attribute's, if the element has that.
    pub(super) fn put(&mut self, name: &str, text: Text) {
        self.attributes.iter_mut().filter(|(known, _)| *known == name).for_each(|(_, old)| *old = text.clone());
    }

    pub(super) fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Element> {
        self.children.iter().filter(move |child| child.kind.name == name)
    }
}

/// The root element of the text that begins at a byte; faults are told to the context. Nothing when there is no tree.
pub(super) fn tree(context: &mut Context, first: usize) -> Option<Element> {
    let source = context.source(first).0.clone();
    let page = Page { text: &source.text, first };
    let limits =
        Limits { bytes: LARGEST_DOCUMENT, depth: DEEPEST_ELEMENT, nodes: MOST_NODES, attributes: MOST_ATTRIBUTES };
    let tree = Document::read(page.text, limits).map_err(|trouble| broken(context, &page, trouble)).ok()?;
    let root = tree.root();
    if root.name() != "eml" {
        let help = match root.name() {
            "sbml" => {
                "this is an SBML model: give it where SBML is read, or translate it with `pseudopod eml from-sbml`"
            }
            _ => EXAMPLE,
        };
        let message = format!("the document is a <{}> and not an <eml>", root.name());
        context.fault(page.numbered(root.name_at()), &message, "not EML", help);
        return None;
    }
    kind_of("eml").map(|kind| element(context, &page, root, kind))
}

const EXAMPLE: &str = "an EML document is <eml name=\"…\"> … </eml>";

/// Tells why there is no tree.
fn broken(context: &mut Context, page: &Page, trouble: Trouble) {
    let at = page.numbered(trouble.at.clone());
    match trouble.what {
        What::TooLong => {
            let message = format!("the document has {} bytes; at most {LARGEST_DOCUMENT} are read", page.text.len());
            // The location would carry the whole text into the message: there is none.
            context.lost(message, "equations need far less: keep data in files of their own");
        }
        What::NotXml => {
            let others = "an SBML model begins with <sbml; an experiment (TOML) is checked by `pseudopod check`";
            context.fault(at, "this is not XML", "XML begins with <", &format!("{EXAMPLE}, {others}"));
        }
        What::DocumentType => {
            let message = "a document type and entities of its own are not read";
            context.fault(at, message, "begins here", "remove the <!DOCTYPE …>; EML needs none");
        }
        What::TooDeep => {
            let message = format!("elements are nested more than {DEEPEST_ELEMENT} deep");
            context.fault(at, &message, "too deep", "EML has three levels; close elements with </…> or />");
        }
        What::TooManyNodes => {
            let message = format!("the document has more than {MOST_NODES} elements and texts");
            context.fault(at, &message, "too many", "equations need far less: write what spreads in space as a field");
        }
        What::TooManyAttributes => {
            let message = format!("an element has more than {MOST_ATTRIBUTES} attributes");
            context.fault(at, &message, "this element", "the chapter on EML lists the few that each element has");
        }
        What::Malformed { message, label, help } => {
            // A sign that expressions have and XML keeps for itself.
            let words = match &page.text[trouble.at.clone()] {
                "<" if in_equation(page.text, trouble.at.start) => " (a reaction that goes both ways takes `=`)",
                "<" => " (expressions take `lt` and `le` for < and <=)",
                sign if sign.starts_with('&') => " (expressions take `and` for &&)",
                _ => "",
            };
            let message = format!("this is not well-formed XML: {message}");
            context.fault(at, &message, label, &format!("{help}{words}"));
        }
    }
}

/// Whether a position stands in the equation of a reaction.
fn in_equation(text: &str, at: usize) -> bool {
    let before = text[..at].rsplit_once(['"', '\'']).map_or("", |(before, _)| before);
    before.trim_end().strip_suffix('=').is_some_and(|before| before.trim_end().ends_with("equation"))
}

fn element(context: &mut Context, page: &Page, node: Node, kind: &'static Kind) -> Element {
    let at = page.numbered(node.name_at());
    let attributes = attributes(context, page, node, kind, &at);
    let mut children = Vec::new();
    for child in node.elements() {
        let name = child.name();
        match child_of(kind, name) {
            Some(child_kind) => children.push(element(context, page, child, child_kind)),
            None => unknown_child(context, kind, name, page.numbered(child.name_at())),
        }
    }
    let text = inner_text(context, page, node, kind);
    Element { kind, at, attributes, text, children }
}

fn attributes(
    context: &mut Context,
    page: &Page,
    node: Node,
    kind: &'static Kind,
    at: &Range<usize>,
) -> Vec<(&'static str, Text)> {
    let known = || kind.attributes();
    let mut found = Vec::new();
    for attribute in node.attributes().iter().filter(|attribute| attribute.namespace.is_none()) {
        let value = attribute.value_at();
        match known().find(|name| *name == attribute.name) {
            Some(name) => found.push((name, Text::decode(page, value.start, std::iter::once(value)))),
            None => {
                let name = attribute.name;
                let message = format!("<{}> has no attribute `{name}`", kind.name);
                let help = match meant(name, known()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => format!("it has {}", any_of(known())),
                };
                context.fault(page.numbered(attribute.name_at(page.text)), &message, "unknown attribute", &help);
            }
        }
    }
    for (name, _) in kind.required.iter().filter(|(name, _)| found.iter().all(|(known, _)| known != name)) {
        let message = match (kind.name, *name) {
            ("variable", "initial") => "the variable has no initial value".to_owned(),
            ("input", "default") => "the input has no default: the value that stands until one is given".to_owned(),
            (element, name) => format!("<{element}> has no `{name}`"),
        };
        context.fault(
            at.clone(),
            &message,
            &format!("`{name}` is missing"),
            &format!("write <{} {name}=\"…\">", kind.name),
        );
    }
    found
}

fn unknown_child(context: &mut Context, kind: &Kind, name: &str, at: Range<usize>) {
    let message = format!("<{name}> cannot stand in <{}>", kind.name);
    let help = match meant(name, kind.children.iter().copied()) {
        Some(near) => format!("did you mean <{near}>?"),
        None if kind.children.is_empty() => format!("<{}> holds no elements", kind.name),
        None => format!("it holds {}", any_of(kind.children.iter().copied())),
    };
    let label = if kind_of(name).is_some() { "not here" } else { "unknown element" };
    context.fault(at, &message, label, &help);
}

/// The text inside an element; text where none belongs is told.
fn inner_text(context: &mut Context, page: &Page, node: Node, kind: &Kind) -> Text {
    let texts = || node.children().filter(|child| !child.is_element());
    if kind.text {
        // Without children: a child element has been told already.
        if node.elements().next().is_some() {
            return Text::default();
        }
        let start = texts().next().map_or(node.tag_at().end, |text| text.at().start);
        return Text::decode(page, start, texts().map(Node::at));
    }
    if let Some(stray) = texts().find(|child| child.text().is_some_and(|text| !text.trim().is_empty())) {
        let range = stray.at();
        let text = &page.text[range.clone()];
        let start = range.start + text.len() - text.trim_start().len();
        let shown: usize = text.trim().lines().next().unwrap_or_default().chars().take(40).map(char::len_utf8).sum();
        let (at, help) = (page.numbered(start..start + shown), "remove it, or make it a comment: <!-- … -->");
        context.fault(at, &format!("text in <{}>, which holds none", kind.name), "this text", help);
    }
    Text::default()
}
