//! The attributes of a tag.

use super::blank::is_blank;
use super::characters::value;
use super::malformed::*;
use super::names::{Namespace, Namespaces, parts};
use super::trouble::{Trouble, What};
use quick_xml::events::attributes::Attributes;
use std::borrow::Cow;
use std::collections::HashMap;
use std::ops::Range;

/// An attribute of an element; declarations of namespaces are none.
#[derive(Debug, Clone)]
pub struct Attribute<'a> {
    /// Its name without a prefix.
    pub name: &'a str,
    /// Its namespace: without a prefix it has none.
    pub namespace: Option<Namespace>,
    /// Its value, references replaced and blanks made spaces.
    pub value: Cow<'a, str>,
    // Bytes of name and value as 32-bit numbers: a tree keeps many of these.
    name_start: u32,
    value_start: u32,
    value_end: u32,
}

impl Attribute<'_> {
    /// The bytes of its name, with the prefix.
    pub fn name_at(&self, text: &str) -> Range<usize> {
        let start = self.name_start as usize;
        let end = text[start..].find(|c| c == '=' || is_blank(c)).map_or(text.len(), |length| start + length);
        start..end
    }

    /// The bytes of its value, without the quotes.
    pub fn value_at(&self) -> Range<usize> {
        self.value_start as usize..self.value_end as usize
    }
}

/// The duplicates among so few attributes are looked for pair by pair.
const FEW: usize = 12;

/// Reads the attributes of one tag after the other.
pub(super) struct TagReader<'a> {
    pub(super) text: &'a str,
    /// Most attributes of a tag.
    pub(super) most: usize,
}

impl<'a> TagReader<'a> {
    /// Reads what follows the name in a tag: `content` are the bytes between its angle brackets, `name_length` the length
    /// of its name. Declarations take effect for the depth; the other attributes are put into `found`.
    pub(super) fn read(
        &self,
        content: Range<usize>,
        name_length: usize,
        depth: usize,
        namespaces: &mut Namespaces<'a>,
        found: &mut Vec<Attribute<'a>>,
    ) -> Result<(), Trouble> {
        found.clear();
        let mut with_prefix = false;
        let mut list = Attributes::new(&self.text[content.clone()], name_length);
        list.with_checks(false);
        for (number, attribute) in list.enumerate() {
            if number == self.most {
                let tag = content.start - 1;
                return Err(Trouble::new(self.text, tag..tag + 1, What::TooManyAttributes));
            }
            let attribute = attribute.map_err(|error| no_attribute(self.text, content.start, &error))?;
            let (name, at) = (attribute.key.0, self.position(attribute.key.0));
            let (prefix, local) = self.name_parts(name, at)?;
            let start = self.position(&attribute.value);
            let value_at = start..start + attribute.value.len();
            let value = value(self.text, value_at.clone())?;
            if prefix == "xmlns" || name == "xmlns" {
                let declared = if prefix.is_empty() { "" } else { local };
                let declaration = namespaces.declare(depth, declared, value);
                declaration.map_err(|message| bad_declaration(self.text, at..at + name.len(), message))?;
                continue;
            }
            with_prefix |= !prefix.is_empty();
            let (value_start, value_end) = (value_at.start as u32, value_at.end as u32);
            let (name_start, namespace) = (at as u32, None);
            found.push(Attribute { name: local, namespace, value, name_start, value_start, value_end });
        }
        // Declarations hold for the whole tag, also for what stands before them.
        if with_prefix {
            for attribute in found.iter_mut() {
                attribute.namespace = self.namespace(attribute, namespaces)?;
            }
        }
        match duplicate(found) {
            None => Ok(()),
            Some((first, second)) => {
                Err(twice(self.text, found[first].name_at(self.text), found[second].name_at(self.text)))
            }
        }
    }

    /// Where a part of the text stands in it.
    fn position(&self, part: &str) -> usize {
        part.as_ptr().addr() - self.text.as_ptr().addr()
    }

    fn name_parts(&self, name: &'a str, at: usize) -> Result<(&'a str, &'a str), Trouble> {
        if !self.text[..at].ends_with(is_blank) {
            return Err(no_blank(self.text, at..at + name.len()));
        }
        parts(name).ok_or_else(|| no_name(self.text, at..at + name.len()))
    }

    fn namespace(&self, attribute: &Attribute, namespaces: &Namespaces) -> Result<Option<Namespace>, Trouble> {
        let at = attribute.name_at(self.text);
        match self.text[at.clone()].split_once(':') {
            None => Ok(None),
            Some((prefix, _)) => match namespaces.of(prefix) {
                Some(namespace) => Ok(Some(namespace)),
                None => Err(unknown_prefix(self.text, at.start..at.start + prefix.len())),
            },
        }
    }
}

/// The first two attributes of the same name.
fn duplicate(attributes: &[Attribute]) -> Option<(usize, usize)> {
    let key = |index: usize| (attributes[index].name, attributes[index].namespace);
    if attributes.len() <= FEW {
        return (1..attributes.len()).find_map(|second| Some(((0..second).find(|i| key(*i) == key(second))?, second)));
    }
    let mut seen = HashMap::with_capacity(attributes.len());
    (0..attributes.len()).find_map(|second| Some((seen.insert(key(second), second)?, second)))
}
