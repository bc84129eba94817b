//! Elements of SBML to be written, with what XML wants escaped.

use std::fmt::Write as _;

/// The namespace of the core of SBML Level 3 Version 2.
pub const NAMESPACE: &str = "http://www.sbml.org/sbml/level3/version2/core";

/// Longest element of a formula that stands on one line, bytes.
const LONGEST_LINE: usize = 100;

/// An element: with elements inside, or with a text; with both on one line.
#[derive(Debug, Clone)]
pub struct Element {
    name: &'static str,
    attributes: Vec<(&'static str, String)>,
    children: Vec<Element>,
    text: String,
    /// A text behind the elements.
    tail: String,
    /// Whether it stands on one line, with all that is in it, where that is short.
    compact: bool,
}

impl Element {
    /// An element without anything in it.
    pub fn new(name: &'static str) -> Self {
        Self {
            name,
            attributes: Vec::new(),
            children: Vec::new(),
            text: String::new(),
            tail: String::new(),
            compact: false,
        }
    }

    /// An element of a formula, which stands on one line where it is short.
    pub fn compact(name: &'static str) -> Self {
        Self { compact: true, ..Self::new(name) }
    }

    /// Adds an attribute.
    pub fn with(mut self, name: &'static str, value: impl Into<String>) -> Self {
        self.attributes.push((name, value.into()));
        self
    }

    /// Adds an attribute if there is a value for it.
    pub fn with_some(self, name: &'static str, value: Option<impl Into<String>>) -> Self {
        match value {
            Some(value) => self.with(name, value),
            None => self,
        }
    }

    /// Adds an attribute that is true or false.
    pub fn with_flag(self, name: &'static str, value: bool) -> Self {
        self.with(name, if value { "true" } else { "false" })
    }

    /// Adds a text.
    pub fn text(mut self, text: impl AsRef<str>) -> Self {
        self.text.push_str(text.as_ref());
        self
    }

    /// Adds a text behind the elements inside.
    pub fn tail(mut self, text: impl AsRef<str>) -> Self {
        self.tail.push_str(text.as_ref());
        self
    }

    /// Adds an element inside.
    pub fn child(mut self, child: Self) -> Self {
        self.children.push(child);
        self
    }

    /// Adds elements inside.
    pub fn children(mut self, children: impl IntoIterator<Item = Self>) -> Self {
        self.children.extend(children);
        self
    }

    /// Adds a list of elements, which SBML names after what is in it; an empty one is left out.
    pub fn list(self, name: &'static str, items: Vec<Self>) -> Self {
        if items.is_empty() { self } else { self.child(Self::new(name).children(items)) }
    }

    /// The document that has this element as its root.
    pub fn document(&self) -> String {
        let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
        self.write(0, &mut text);
        text
    }

    /// Writes the element on lines of their own.
    fn write(&self, depth: usize, out: &mut String) {
        let start = out.len();
        // Writing to a text cannot fail.
        let _ = write!(out, "{:1$}", "", 2 * depth);
        if self.children.is_empty() || self.compact {
            let begin = out.len();
            if self.on_one_line(begin, out) {
                return out.push('\n');
            }
            out.truncate(start);
            let _ = write!(out, "{:1$}", "", 2 * depth);
        }
        self.open(out);
        out.push_str(">\n");
        for child in &self.children {
            child.write(depth + 1, out);
        }
        let _ = writeln!(out, "{:2$}</{}>", "", self.name, 2 * depth);
    }

    /// Writes the element without breaks; whether it is short enough, or has no elements inside and must stay whole.
    fn on_one_line(&self, begin: usize, out: &mut String) -> bool {
        self.open(out);
        if self.children.is_empty() && self.text.is_empty() {
            out.push_str("/>");
            return true;
        }
        out.push('>');
        escape(&self.text, out);
        for child in &self.children {
            if !child.on_one_line(begin, out) || out.len() - begin > LONGEST_LINE {
                return false;
            }
        }
        escape(&self.tail, out);
        let _ = write!(out, "</{}>", self.name);
        self.children.is_empty() || out.len() - begin <= LONGEST_LINE
    }

    /// The beginning of the first tag.
    fn open(&self, out: &mut String) {
        out.push('<');
        out.push_str(self.name);
        for (name, value) in &self.attributes {
            let _ = write!(out, " {name}=\"");
            escape(value, out);
            out.push('"');
        }
    }
}

fn escape(text: &str, out: &mut String) {
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\t' | '\r' => {
                let _ = write!(out, "&#{};", u32::from(c));
            }
            c => out.push(c),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Element;

    #[test]
    fn texts_are_escaped_and_short_formulas_stand_on_one_line() {
        let ci = |name: &str| Element::compact("ci").text(format!(" {name} "));
        let sum =
            |count: usize| Element::compact("apply").child(Element::compact("plus")).children(vec![ci("x"); count]);
        let root = Element::new("a").with("b", "<\"&\n").list("c", Vec::new()).child(sum(2)).child(sum(12));
        let text = root.document();
        assert!(
            text.contains("<a b=\"&lt;&quot;&amp;&#10;\">\n  <apply><plus/><ci> x </ci><ci> x </ci></apply>\n"),
            "{text}"
        );
        assert!(text.contains("  <apply>\n    <plus/>\n    <ci> x </ci>\n"), "{text}");
        assert_eq!(text.matches("<ci> x </ci>").count(), 14);
    }
}
