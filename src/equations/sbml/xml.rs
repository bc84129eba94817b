//! The XML under an SBML text: hostile texts are refused, and every fault gets its location.

use crate::equations::fault::at_location;
use crate::error::{Error, Fault, Result, Source};
use crate::xml::{Document, Limits, Trouble, What};
use std::cell::RefCell;
use std::sync::Arc;

pub use crate::xml::Node;

/// The namespace of MathML.
pub const MATHML: &str = "http://www.w3.org/1998/Math/MathML";
/// What the namespaces of the SBML core begin with.
const CORE: &str = "http://www.sbml.org/sbml/level";
/// Largest text taken, bytes: the largest published models have about half of it.
pub const LARGEST_DOCUMENT: usize = 64 << 20;
/// Deepest nesting taken: far deeper than any formula written by hand or by a tool, far shallower than our stack.
const DEPTH_LIMIT: usize = 256;
/// Most elements and texts taken.
const NODE_LIMIT: usize = 8_000_000;
/// Most attributes of one element taken: SBML has about ten.
const ATTRIBUTE_LIMIT: usize = 1_000;
/// Most faults told at once.
const FAULT_LIMIT: usize = 50;

/// The text being read, and what was found wrong or worth telling so far.
pub struct Page<'a> {
    source: Arc<Source>,
    faults: RefCell<Vec<Noted>>,
    notices: RefCell<Vec<String>>,
    /// The namespace of the root element.
    pub namespace: &'a str,
    /// SBML level.
    pub level: u32,
    /// SBML version within the level.
    pub version: u32,
}

/// A fault at some bytes of the text: what was found, and what to do.
#[derive(PartialEq)]
struct Noted {
    start: usize,
    length: usize,
    message: String,
    help: String,
}

/// Reads the XML, refusing what only a hostile text has.
///
/// # Errors
/// [`Error::Input`] with a location: too large, a document type, nested too deeply, not well formed.
pub fn parse(source: &Arc<Source>) -> Result<Document<'_>> {
    let limits = Limits { bytes: LARGEST_DOCUMENT, depth: DEPTH_LIMIT, nodes: NODE_LIMIT, attributes: ATTRIBUTE_LIMIT };
    Document::read(&source.text, limits).map_err(|trouble| refused(source, trouble))
}

/// Why there is no tree.
fn refused(source: &Arc<Source>, trouble: Trouble) -> Error {
    let (start, length) = (trouble.at.start, trouble.at.len());
    let (message, label, help) = match trouble.what {
        What::TooLong => {
            let size = source.text.len() >> 20;
            let found = format!("the text has {size} MiB; at most {} MiB are read", LARGEST_DOCUMENT >> 20);
            return Error::input(Fault::new(found).help("give a smaller model, or cut out its annotations"));
        }
        What::NotXml => {
            let help = "give an SBML document of Level 2 or Level 3: it begins with <?xml or <sbml";
            ("the text is not XML".to_owned(), "XML begins with <", help.to_owned())
        }
        What::DocumentType => {
            let help = "delete the `<!DOCTYPE …>`: SBML needs none, and entities are not expanded";
            let at = start..start + 1;
            return Error::input(at_location(source, at, "a document type is declared".into(), "here", help));
        }
        What::TooDeep => {
            let help = "SBML does not nest so deeply; write long sums with one <plus/> for all terms";
            (format!("elements are nested more than {DEPTH_LIMIT} deep"), "here", help.to_owned())
        }
        What::TooManyNodes => {
            let help = "give a smaller model, or cut out its annotations";
            (format!("the text has more than {NODE_LIMIT} elements and texts"), "here", help.to_owned())
        }
        What::TooManyAttributes => {
            let help = "no element of SBML has so many attributes";
            (format!("an element has more than {ATTRIBUTE_LIMIT} attributes"), "here", help.to_owned())
        }
        What::Malformed { message, label, help } => {
            (format!("the text is not well-formed XML: {message}"), label, help)
        }
    };
    Error::input(at_location(source, start..start + length, message, label, &help))
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
            namespace: root.namespace().unwrap_or_default(),
            level: 0,
            version: 0,
        };
        if root.name() != "sbml" || !page.namespace.starts_with(CORE) {
            let found = format!("the root element is <{}>, not an <sbml> of {CORE}…", root.name());
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
        let range = node.at();
        let text = &self.source.text[range.clone()];
        let shown = text.find(['>', '\n']).map_or(text.len(), |end| end + usize::from(text[end..].starts_with('>')));
        self.note(range.start, shown.min(text.len()), message.into(), help.into());
    }

    /// Notes a fault at the value of an attribute, or at the element if it has no such attribute.
    pub fn fault_in(&self, node: Node<'_>, attribute: &str, message: impl Into<String>, help: impl Into<String>) {
        match node.attribute_at(attribute) {
            Some(range) => self.note(range.start, range.len(), message.into(), help.into()),
            None => self.fault(node, message, help),
        }
    }

    fn note(&self, start: usize, length: usize, message: String, help: String) {
        self.faults.borrow_mut().push(Noted { start, length, message, help });
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
        faults.sort_by_key(|fault| fault.start);
        faults.dedup();
        faults.truncate(FAULT_LIMIT);
        let told = |fault: Noted| {
            let at = fault.start..fault.start + fault.length;
            at_location(&self.source, at, fault.message, "here", &fault.help)
        };
        Err(Error::Input(faults.into_iter().map(told).collect()))
    }

    /// The children of an element that belong to the SBML core.
    pub fn children(&self, node: Node<'a>) -> impl Iterator<Item = Node<'a>> + use<'a> {
        let namespace = self.namespace;
        node.elements().filter(move |child| child.namespace() == Some(namespace))
    }

    /// The first child of the SBML core with a name.
    pub fn child(&self, node: Node<'a>, name: &str) -> Option<Node<'a>> {
        self.children(node).find(|child| child.name() == name)
    }

    /// The first element of the formula in an element's `<math>`, if there is one.
    pub fn math(&self, node: Node<'a>) -> Option<Node<'a>> {
        let is_math = |child: &Node<'a>| child.name() == "math" && child.namespace() == Some(MATHML);
        node.elements().find(is_math)?.elements().next()
    }

    /// The text of an attribute that must be there and say something.
    pub fn required(&self, node: Node<'a>, attribute: &str) -> &'a str {
        match node.attribute(attribute).map(str::trim) {
            None => {
                let found = format!("<{}> has no attribute `{attribute}`", node.name());
                self.fault(node, found, format!("add `{attribute}=\"…\"`"));
                ""
            }
            Some("") => {
                let found = format!("the attribute `{attribute}` of <{}> is empty", node.name());
                self.fault_in(node, attribute, found, "write an identifier into it");
                ""
            }
            Some(text) => text,
        }
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
