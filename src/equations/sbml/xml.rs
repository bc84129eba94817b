//! The XML under an SBML text: hostile texts are refused before anything is built, and every fault gets its place.

use crate::error::{Error, Fault, Place, Result, Source};
use std::cell::RefCell;
use std::sync::Arc;

/// An element of the text.
pub type Node<'a> = roxmltree::Node<'a, 'a>;

/// The namespace of MathML.
pub const MATHML: &str = "http://www.w3.org/1998/Math/MathML";
/// What the namespaces of the SBML core begin with.
const CORE: &str = "http://www.sbml.org/sbml/level";
/// Largest text taken, bytes: the largest published models have about half of it.
pub const LARGEST_DOCUMENT: usize = 64 << 20;
/// Deepest nesting taken: far deeper than any formula written by hand or by a tool, far shallower than our stack.
const DEPTH_LIMIT: usize = 256;
/// Most elements and texts taken.
const NODE_LIMIT: u32 = 8_000_000;
/// Most attributes of one element taken: XML wants them compared pairwise.
const ATTRIBUTE_LIMIT: usize = 1_000;
/// Most faults told at once.
const FAULT_LIMIT: usize = 50;

/// The text being read, and what was found wrong or worth telling so far.
pub struct Page<'a> {
    source: Arc<Source>,
    faults: RefCell<Vec<Fault>>,
    notices: RefCell<Vec<String>>,
    /// The namespace of the root element.
    pub namespace: &'a str,
    /// SBML level.
    pub level: u32,
    /// SBML version within the level.
    pub version: u32,
}

/// Reads the XML, refusing what only a hostile text has.
///
/// # Errors
/// [`Error::Input`] with a place: too large, a document type, nested too deeply, not well formed.
pub fn parse(source: &Arc<Source>) -> Result<roxmltree::Document<'_>> {
    let text = source.text.as_str();
    let whole = |start, length, label: &str| Place { source: source.clone(), start, length, label: label.to_owned() };
    if text.len() > LARGEST_DOCUMENT {
        let found = format!("the text has {} MiB; at most {} MiB are read", text.len() >> 20, LARGEST_DOCUMENT >> 20);
        return Err(Error::input(Fault::new(found).help("give a smaller model, or cut out its annotations")));
    }
    if let Some((start, what)) = hostile(text) {
        let help = match what {
            Hostile::Type => "delete the `<!DOCTYPE …>`: SBML needs none, and entities are not expanded",
            Hostile::Depth => "SBML does not nest so deeply; write long sums with one <plus/> for all terms",
            Hostile::Attributes => "no element of SBML has so many attributes",
        };
        let message = match what {
            Hostile::Type => "a document type is declared".to_owned(),
            Hostile::Depth => format!("elements are nested more than {DEPTH_LIMIT} deep"),
            Hostile::Attributes => format!("an element has more than {ATTRIBUTE_LIMIT} attributes"),
        };
        return Err(Error::input(Fault::new(message).at(whole(start, 1, "here")).help(help)));
    }
    let options = roxmltree::ParsingOptions { nodes_limit: NODE_LIMIT, ..Default::default() };
    roxmltree::Document::parse_with_options(text, options).map_err(|error| {
        let start = offset(text, error.pos());
        let length = text[start..].chars().next().map_or(0, char::len_utf8);
        let message = format!("the text is not well-formed XML: {}", without_position(&error.to_string()));
        let help = "correct the XML at this place; an XML editor or `xmllint` shows more";
        Error::input(Fault::new(message).at(whole(start, length, "here")).help(help))
    })
}

enum Hostile {
    Type,
    Depth,
    Attributes,
}

/// The first place that only a hostile text has: found in one pass over the bytes, before the XML is read.
fn hostile(text: &str) -> Option<(usize, Hostile)> {
    let bytes = text.as_bytes();
    let (mut depth, mut at) = (0_usize, 0_usize);
    while let Some(step) = bytes[at..].iter().position(|&byte| byte == b'<') {
        let start = at + step;
        let rest = &text[start..];
        let end = |mark: &str| rest.find(mark).map_or(text.len(), |found| start + found + mark.len());
        at = if rest.starts_with("<!--") {
            end("-->")
        } else if rest.starts_with("<![CDATA[") {
            end("]]>")
        } else if rest.starts_with("<?") {
            end("?>")
        } else if rest.starts_with("<!") {
            return Some((start, Hostile::Type));
        } else {
            let (end, equals) = tag(bytes, start);
            if equals > ATTRIBUTE_LIMIT {
                return Some((start, Hostile::Attributes));
            }
            if rest.starts_with("</") {
                depth = depth.saturating_sub(1);
            } else if end < 2 || bytes[end - 2] != b'/' {
                depth += 1;
            }
            if depth > DEPTH_LIMIT {
                return Some((start, Hostile::Depth));
            }
            end
        };
    }
    None
}

/// The end of the tag that begins here, and how many attributes it has.
fn tag(bytes: &[u8], start: usize) -> (usize, usize) {
    let (mut quote, mut equals) = (None, 0);
    for (offset, &byte) in bytes[start..].iter().enumerate() {
        match (quote, byte) {
            (None, b'>') => return (start + offset + 1, equals),
            (None, b'"' | b'\'') => quote = Some(byte),
            (None, b'=') => equals += 1,
            (Some(open), _) if byte == open => quote = None,
            _ => {}
        }
    }
    (bytes.len(), equals)
}

/// Byte offset of a row and column, both counted from 1, the column in characters.
fn offset(text: &str, position: roxmltree::TextPos) -> usize {
    let line: usize = text.split_inclusive('\n').take(position.row.saturating_sub(1) as usize).map(str::len).sum();
    let column = text[line..].char_indices().nth(position.col.saturating_sub(1) as usize);
    column.map_or(text.len(), |(step, _)| line + step)
}

/// The message of the XML reader without its " at 1:2", which the place tells.
fn without_position(message: &str) -> &str {
    match message.rfind(" at ") {
        Some(end) if message[end + 4..].chars().all(|c| c.is_ascii_digit() || c == ':') => &message[..end],
        _ => message,
    }
}

impl<'a> Page<'a> {
    /// The page of a document whose root is SBML of a level that is read.
    ///
    /// # Errors
    /// [`Error::Input`]: not SBML, or a level or version that is not read.
    pub fn new(source: &Arc<Source>, root: Node<'a>) -> Result<Self> {
        let mut page = Self {
            source: source.clone(),
            faults: RefCell::default(),
            notices: RefCell::default(),
            namespace: root.tag_name().namespace().unwrap_or_default(),
            level: 0,
            version: 0,
        };
        if root.tag_name().name() != "sbml" || !page.namespace.starts_with(CORE) {
            let found = format!("the root element is <{}>, not an <sbml> of {CORE}…", root.tag_name().name());
            page.fault(root, found, "give an SBML document of Level 2 or Level 3");
            return Err(page.finish().expect_err("a fault was noted"));
        }
        let number = |name| root.attribute(name).and_then(|text| text.trim().parse::<u32>().ok()).unwrap_or_default();
        (page.level, page.version) = (number("level"), number("version"));
        if !matches!((page.level, page.version), (2, 1..=5) | (3, 1..=2)) {
            let given = |name| root.attribute(name).unwrap_or("?");
            let found = format!("this is SBML Level {} Version {}", given("level"), given("version"));
            let help =
                "Level 2 Versions 1 to 5 and Level 3 Versions 1 and 2 are read; convert the model, with libSBML say";
            page.fault(root, found, help);
            return Err(page.finish().expect_err("a fault was noted"));
        }
        Ok(page)
    }

    /// Notes a fault at an element.
    pub fn fault(&self, node: Node<'_>, message: impl Into<String>, help: impl Into<String>) {
        let range = node.range();
        let text = &self.source.text[range.clone()];
        let shown = text.find(['>', '\n']).map_or(text.len(), |end| end + usize::from(text[end..].starts_with('>')));
        self.note(range.start, shown.min(text.len()), message.into(), help.into());
    }

    /// Notes a fault at the value of an attribute, or at the element if it has no such attribute.
    pub fn fault_in(&self, node: Node<'_>, attribute: &str, message: impl Into<String>, help: impl Into<String>) {
        match node.attribute_node(attribute) {
            Some(found) => {
                let range = found.range_value();
                self.note(range.start, range.len(), message.into(), help.into());
            }
            None => self.fault(node, message, help),
        }
    }

    fn note(&self, start: usize, length: usize, message: String, help: String) {
        let place = Place { source: self.source.clone(), start, length, label: "here".to_owned() };
        self.faults.borrow_mut().push(Fault::new(message).at(place).help(help));
    }

    /// Notes something that the reader of the model should know, once.
    pub fn notice(&self, text: impl Into<String>) {
        let text = text.into();
        let mut notices = self.notices.borrow_mut();
        if !notices.contains(&text) {
            notices.push(text);
        }
    }

    /// The notices, when nothing was wrong.
    ///
    /// # Errors
    /// All faults noted, in the order of the text.
    pub fn finish(&self) -> Result<Vec<String>> {
        let mut faults = self.faults.take();
        if faults.is_empty() {
            return Ok(self.notices.take());
        }
        faults.sort_by_key(|fault| fault.place.as_ref().map_or(0, |place| place.start));
        faults.dedup();
        faults.truncate(FAULT_LIMIT);
        Err(Error::Input(faults))
    }

    /// The children of an element that belong to the SBML core.
    pub fn children(&self, node: Node<'a>) -> impl Iterator<Item = Node<'a>> + use<'a> {
        let namespace = self.namespace;
        node.children().filter(move |child| child.is_element() && child.tag_name().namespace() == Some(namespace))
    }

    /// The first child of the SBML core with a name.
    pub fn child(&self, node: Node<'a>, name: &str) -> Option<Node<'a>> {
        self.children(node).find(|child| child.tag_name().name() == name)
    }

    /// The first element of the formula in an element's `<math>`, if there is one.
    pub fn math(&self, node: Node<'a>) -> Option<Node<'a>> {
        let is_math =
            |child: &Node<'a>| child.tag_name().name() == "math" && child.tag_name().namespace() == Some(MATHML);
        node.children().find(is_math)?.first_element_child()
    }

    /// The text of an attribute that must be there.
    pub fn required(&self, node: Node<'a>, attribute: &str) -> &'a str {
        node.attribute(attribute).map(str::trim).unwrap_or_else(|| {
            let found = format!("<{}> has no attribute `{attribute}`", node.tag_name().name());
            self.fault(node, found, format!("add `{attribute}=\"…\"`"));
            ""
        })
    }

    /// The number in an attribute.
    pub fn number(&self, node: Node<'a>, attribute: &str) -> Option<f64> {
        let text = node.attribute(attribute)?;
        let number = number(text);
        if number.is_none() {
            let help = "write a number such as `1.5e-3`, or INF, -INF or NaN";
            self.fault_in(node, attribute, format!("`{text}` is not a number"), help);
        }
        number
    }

    /// Yes or no in an attribute, or what holds without it.
    pub fn flag(&self, node: Node<'a>, attribute: &str, otherwise: bool) -> bool {
        match node.attribute(attribute).map(str::trim) {
            None => otherwise,
            Some("true" | "1") => true,
            Some("false" | "0") => false,
            Some(text) => {
                self.fault_in(
                    node,
                    attribute,
                    format!("`{text}` is neither true nor false"),
                    "write `true` or `false`",
                );
                otherwise
            }
        }
    }
}

/// A number as XML writes it.
pub fn number(text: &str) -> Option<f64> {
    match text.trim() {
        "INF" | "+INF" => Some(f64::INFINITY),
        "-INF" => Some(f64::NEG_INFINITY),
        "NaN" => Some(f64::NAN),
        text if text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte)) => text.parse().ok(),
        _ => None,
    }
}
