//! Names, and the namespaces that their prefixes stand for.

use std::borrow::Cow;
use std::collections::HashMap;

/// The namespace of the prefix `xml`, which needs no declaration.
pub const XML: &str = "http://www.w3.org/XML/1998/namespace";
/// The namespace of the declarations themselves, to which nothing may be bound.
const XMLNS: &str = "http://www.w3.org/2000/xmlns/";

/// Prefix and local name of a qualified name; the prefix is empty where there is none. Nothing when it is no name.
pub(super) fn parts(name: &str) -> Option<(&str, &str)> {
    match name.bytes().position(|byte| byte == b':') {
        None => is_name(name).then_some(("", name)),
        Some(colon) => {
            let (prefix, local) = (&name[..colon], &name[colon + 1..]);
            (is_name(prefix) && is_name(local)).then_some((prefix, local))
        }
    }
}

/// Which bytes names may begin with (2) and go on with (1), those of ASCII.
const PLAIN: [u8; 256] = {
    let mut table = [0; 256];
    let mut byte = 0_u8;
    while byte < 128 {
        table[byte as usize] = match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'_' => 2,
            b'0'..=b'9' | b'-' | b'.' => 1,
            _ => 0,
        };
        byte += 1;
    }
    table
};

/// Whether a text is a name without a colon.
pub(super) fn is_name(text: &str) -> bool {
    let kind = |byte: &u8| PLAIN[usize::from(*byte)];
    // Almost all names are of these.
    if text.as_bytes().first().is_some_and(|byte| kind(byte) == 2) && text.as_bytes().iter().all(|byte| kind(byte) > 0)
    {
        return true;
    }
    let mut signs = text.chars();
    signs.next().is_some_and(begins_name) && signs.all(|c| begins_name(c) || continues_name(c))
}

fn begins_name(c: char) -> bool {
    matches!(c, 'a'..='z' | 'A'..='Z' | '_' | '\u{c0}'..='\u{d6}' | '\u{d8}'..='\u{f6}' | '\u{f8}'..='\u{2ff}'
        | '\u{370}'..='\u{37d}' | '\u{37f}'..='\u{1fff}' | '\u{200c}'..='\u{200d}' | '\u{2070}'..='\u{218f}'
        | '\u{2c00}'..='\u{2fef}' | '\u{3001}'..='\u{d7ff}' | '\u{f900}'..='\u{fdcf}' | '\u{fdf0}'..='\u{fffd}'
        | '\u{10000}'..='\u{effff}')
}

fn continues_name(c: char) -> bool {
    matches!(c, '0'..='9' | '-' | '.' | '\u{b7}' | '\u{300}'..='\u{36f}' | '\u{203f}'..='\u{2040}')
}

/// A namespace that a document names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Namespace(u32);

impl Namespace {
    /// Its number, from 0, in the order of their first declarations.
    pub(super) fn index(self) -> usize {
        self.0 as usize
    }
}

/// What a prefix stands for from some depth of elements on; nothing where a declaration took it back.
type Binding = (usize, Option<Namespace>);

/// What prefixes stand for, at the element that is read.
pub(super) struct Namespaces<'a> {
    /// The names of all namespaces that were declared; the first is that of the prefix `xml`.
    pub(super) names: Vec<Cow<'a, str>>,
    known: HashMap<Cow<'a, str>, Namespace>,
    default: Vec<Binding>,
    prefixes: HashMap<&'a str, Vec<Binding>>,
    /// The prefixes declared by the elements that are open, in order, with their depths.
    declared: Vec<(usize, &'a str)>,
}

impl<'a> Namespaces<'a> {
    pub(super) fn new() -> Self {
        let xml = Namespace(0);
        Self {
            names: vec![Cow::Borrowed(XML)],
            known: HashMap::from([(Cow::Borrowed(XML), xml)]),
            default: Vec::new(),
            prefixes: HashMap::from([("xml", vec![(0, Some(xml))])]),
            declared: Vec::new(),
        }
    }

    /// Binds a prefix for an element at a depth from 1 on, and for what is in it; an empty name takes a binding back.
    ///
    /// # Errors
    /// Why the declaration cannot stand.
    pub(super) fn declare(&mut self, depth: usize, prefix: &'a str, name: Cow<'a, str>) -> Result<(), &'static str> {
        if (prefix == "xml") != (name == XML) || prefix == "xmlns" || name == XMLNS {
            return Err("the prefixes `xml` and `xmlns` and their namespaces are reserved");
        }
        let bound = if prefix.is_empty() { &mut self.default } else { self.prefixes.entry(prefix).or_default() };
        if bound.last().is_some_and(|(other, _)| *other == depth) {
            return Err("the element declares this prefix twice");
        }
        let namespace = (!name.is_empty()).then(|| {
            *self.known.entry(name).or_insert_with_key(|name| {
                self.names.push(name.clone());
                Namespace(self.names.len() as u32 - 1)
            })
        });
        bound.push((depth, namespace));
        self.declared.push((depth, prefix));
        Ok(())
    }

    /// Takes back what elements deeper than a depth declared.
    pub(super) fn leave(&mut self, depth: usize) {
        while let Some((_, prefix)) = self.declared.pop_if(|(own, _)| *own > depth) {
            match self.prefixes.get_mut(prefix) {
                Some(bound) => bound.pop(),
                None => self.default.pop(),
            };
        }
    }

    /// The prefixes that the open element at a depth declares, with the names that they stand for.
    pub(super) fn declared_at(&self, depth: usize) -> impl Iterator<Item = (&'a str, &str)> {
        let first = self.declared.partition_point(|(own, _)| *own < depth);
        let own = self.declared[first..].iter().take_while(move |(own, _)| *own == depth);
        own.map(|(_, prefix)| {
            let bound = if prefix.is_empty() { self.default() } else { self.of(prefix) };
            (*prefix, bound.map_or("", |namespace| self.names[namespace.index()].as_ref()))
        })
    }

    /// The namespace of elements without a prefix.
    pub(super) fn default(&self) -> Option<Namespace> {
        self.default.last().and_then(|(_, namespace)| *namespace)
    }

    /// The namespace that a prefix stands for.
    pub(super) fn of(&self, prefix: &str) -> Option<Namespace> {
        self.prefixes.get(prefix)?.last().and_then(|(_, namespace)| *namespace)
    }
}
