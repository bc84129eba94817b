//! A document as a tree of elements and texts.

use super::attributes::Attribute;
use super::names::Namespace;
use super::reader::{Event, Reader};
use super::trouble::{Trouble, What};
use super::{Limits, Start};
use std::borrow::Cow;
use std::ops::Range;

/// A document that was read as a whole.
#[derive(Debug)]
pub struct Document<'a> {
    /// Elements and texts, each before what is in it.
    nodes: Vec<Data<'a>>,
    attributes: Vec<Attribute<'a>>,
    namespaces: Vec<Cow<'a, str>>,
}

/// An element or a text. Indices and bytes are 32-bit numbers: there are many of these.
#[derive(Debug)]
struct Data<'a> {
    content: Content<'a>,
    /// The element that it is in; that of the root is itself.
    parent: u32,
    /// The first node behind all that is in it.
    next: u32,
    start: u32,
    end: u32,
}

#[derive(Debug)]
enum Content<'a> {
    Element {
        name: &'a str,
        namespace: Option<Namespace>,
        attributes: Range<u32>,
        /// End of the name in the first tag.
        name_end: u32,
        /// End of the first tag.
        tag_end: u32,
    },
    Text(Cow<'a, str>),
}

impl<'a> Document<'a> {
    /// Reads a text.
    ///
    /// # Errors
    /// As [`Reader::new`] and [`Reader::event`], and where there are more nodes than allowed.
    pub fn read(text: &'a str, limits: Limits) -> Result<Self, Trouble> {
        let mut reader = Reader::new(text, limits)?;
        // About as many nodes as tags, and never more than the limit.
        let tags = text.bytes().filter(|byte| *byte == b'<').count().min(limits.nodes);
        let mut document = Self { nodes: Vec::with_capacity(tags), attributes: Vec::new(), namespaces: Vec::new() };
        let mut open: Vec<u32> = Vec::new();
        while let Some(event) = reader.event()? {
            let parent = open.last().copied().unwrap_or_default();
            let start = match event {
                Event::Start(start) => {
                    open.push(document.nodes.len() as u32);
                    let at = start.at.start;
                    document.element(parent, start, &mut reader);
                    at
                }
                Event::Text { text, at } => {
                    let start = at.start;
                    document.text(parent, text, at);
                    start
                }
                Event::End { at } => {
                    let next = document.nodes.len() as u32;
                    let element = &mut document.nodes[open.pop().unwrap_or_default() as usize];
                    (element.next, element.end) = (next, at.end as u32);
                    continue;
                }
            };
            if document.nodes.len() > limits.nodes {
                return Err(Trouble::new(text, start..start + 1, What::TooManyNodes));
            }
        }
        document.namespaces = reader.into_namespaces();
        Ok(document)
    }

    fn element(&mut self, parent: u32, start: Start<'a>, reader: &mut Reader<'a>) {
        let first = self.attributes.len() as u32;
        reader.move_attributes(&mut self.attributes);
        let content = Content::Element {
            name: start.name,
            namespace: start.namespace,
            attributes: first..self.attributes.len() as u32,
            name_end: start.name_at.end as u32,
            tag_end: start.at.end as u32,
        };
        self.push(content, parent, start.at);
    }

    /// A text, or the next piece of one.
    fn text(&mut self, parent: u32, piece: Cow<'a, str>, at: Range<usize>) {
        match self.nodes.last_mut() {
            Some(Data { content: Content::Text(text), end, .. }) if *end as usize == at.start => {
                text.to_mut().push_str(&piece);
                *end = at.end as u32;
            }
            _ => self.push(Content::Text(piece), parent, at),
        }
    }

    fn push(&mut self, content: Content<'a>, parent: u32, at: Range<usize>) {
        let next = self.nodes.len() as u32 + 1;
        self.nodes.push(Data { content, parent, next, start: at.start as u32, end: at.end as u32 });
    }

    /// The element around all others.
    pub fn root(&self) -> Node<'_> {
        Node { document: self, index: 0 }
    }

    /// The names of all namespaces that the document declares, each once.
    pub fn namespaces(&self) -> impl Iterator<Item = &str> {
        self.namespaces.iter().skip(1).map(|name| &**name)
    }
}

/// An element or a text of a document.
#[derive(Debug, Clone, Copy)]
pub struct Node<'d> {
    document: &'d Document<'d>,
    index: u32,
}

impl<'d> Node<'d> {
    fn data(self) -> &'d Data<'d> {
        &self.document.nodes[self.index as usize]
    }

    fn other(self, index: u32) -> Self {
        Self { index, ..self }
    }

    /// Its number in the document, from 0 for the root, in the order of the text.
    pub fn index(self) -> usize {
        self.index as usize
    }

    /// Whether it is an element.
    pub fn is_element(self) -> bool {
        matches!(self.data().content, Content::Element { .. })
    }

    /// The name of an element, without a prefix; empty for a text.
    pub fn name(self) -> &'d str {
        match &self.data().content {
            Content::Element { name, .. } => name,
            Content::Text(_) => "",
        }
    }

    /// The namespace of an element.
    pub fn namespace(self) -> Option<&'d str> {
        match &self.data().content {
            Content::Element { namespace, .. } => namespace.map(|namespace| self.name_of(namespace)),
            Content::Text(_) => None,
        }
    }

    /// The name of a namespace that one of its attributes has.
    pub fn name_of(self, namespace: Namespace) -> &'d str {
        &self.document.namespaces[namespace.index()]
    }

    /// The text of a text; none for an element.
    pub fn text(self) -> Option<&'d str> {
        match &self.data().content {
            Content::Element { .. } => None,
            Content::Text(text) => Some(text),
        }
    }

    /// Its attributes, in the order of the text.
    pub fn attributes(self) -> &'d [Attribute<'d>] {
        match &self.data().content {
            Content::Element { attributes, .. } => {
                &self.document.attributes[attributes.start as usize..attributes.end as usize]
            }
            Content::Text(_) => &[],
        }
    }

    /// The value of an attribute without a namespace.
    pub fn attribute(self, name: &str) -> Option<&'d str> {
        let found = self.attributes().iter().find(|one| one.name == name && one.namespace.is_none());
        found.map(|one| &*one.value)
    }

    /// The value of an attribute of a namespace.
    pub fn attribute_of(self, namespace: &str, name: &str) -> Option<&'d str> {
        let is_of = |one: &Attribute<'d>| one.namespace.is_some_and(|own| self.name_of(own) == namespace);
        self.attributes().iter().find(|one| one.name == name && is_of(one)).map(|one| &*one.value)
    }

    /// The bytes of the value of an attribute without a namespace.
    pub fn attribute_at(self, name: &str) -> Option<Range<usize>> {
        let found = self.attributes().iter().find(|one| one.name == name && one.namespace.is_none());
        found.map(Attribute::value_at)
    }

    /// The element that it is in.
    pub fn parent(self) -> Option<Self> {
        (self.index > 0).then(|| self.other(self.data().parent))
    }

    /// The elements and texts in it, not those in its children.
    pub fn children(self) -> impl Iterator<Item = Self> + use<'d> {
        let (mut index, end) = (self.index + 1, self.data().next);
        std::iter::from_fn(move || {
            let child = (index < end).then(|| self.other(index))?;
            index = child.data().next;
            Some(child)
        })
    }

    /// The elements in it, not those in its children.
    pub fn elements(self) -> impl Iterator<Item = Self> + use<'d> {
        self.children().filter(|child| child.is_element())
    }

    /// Itself and all elements and texts in it at any depth, in the order of the text.
    pub fn descendants(self) -> impl Iterator<Item = Self> + use<'d> {
        (self.index..self.data().next).map(move |index| self.other(index))
    }

    /// Its bytes: from the first tag to the last, or those of the text.
    pub fn at(self) -> Range<usize> {
        self.data().start as usize..self.data().end as usize
    }

    /// The bytes of its name in its first tag, with the prefix; none of a text.
    pub fn name_at(self) -> Range<usize> {
        match &self.data().content {
            Content::Element { name_end, .. } => self.data().start as usize + 1..*name_end as usize,
            Content::Text(_) => self.at().start..self.at().start,
        }
    }

    /// The bytes of its first tag; none of a text.
    pub fn tag_at(self) -> Range<usize> {
        match &self.data().content {
            Content::Element { tag_end, .. } => self.data().start as usize..*tag_end as usize,
            Content::Text(_) => self.at().start..self.at().start,
        }
    }
}
