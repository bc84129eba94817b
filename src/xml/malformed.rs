//! What makes a text no well-formed XML: what was found, what was expected, what to do.

use super::blank::is_blank;
use super::trouble::{Trouble, What, line_and_column, shown};
use quick_xml::events::attributes::AttrError;
use std::ops::Range;

/// A document type begins.
pub(super) fn document_type(text: &str, start: usize) -> Trouble {
    Trouble::new(text, start..start + 2, What::DocumentType)
}

pub(super) fn foreign_character(text: &str, at: usize, c: char) -> Trouble {
    let message = format!("the character U+{:04X} cannot stand in XML", u32::from(c));
    let help = "delete it, or save the document as text in UTF-8";
    Trouble::malformed(text, at..at + c.len_utf8(), message, "this character", help)
}

pub(super) fn declaration_elsewhere(text: &str, at: Range<usize>) -> Trouble {
    let help = "write it once, as the very first: <?xml version=\"1.0\" encoding=\"UTF-8\"?>";
    Trouble::malformed(text, at, "this is not where or how XML is declared", "here", help)
}

/// What begins at a position is not brought to an end.
pub(super) fn cut_off(text: &str, start: usize) -> Trouble {
    let rest = &text[start..];
    let (message, help, length) = if rest.starts_with("<!--") {
        ("a comment is not closed", "write --> where it ends", 4)
    } else if rest.starts_with("<![CDATA[") {
        ("a CDATA section is not closed", "write ]]> where it ends", 9)
    } else if rest.starts_with("<!") {
        return document_type(text, start);
    } else if rest.starts_with("<?") {
        ("a processing instruction is not closed", "write ?> where it ends", 2)
    } else if rest.starts_with('&') {
        return unknown_reference(text, start..start + 1);
    } else if rest.len() == 1 || rest[1..].starts_with(is_blank) {
        return no_element(text, start);
    } else {
        let length = 1 + rest[1..].find(|c| is_blank(c) || c == '<').unwrap_or(rest.len() - 1);
        let help = "write > where it ends, and quotes around each value: <name attribute=\"value\">";
        ("a tag is not closed", help, length)
    };
    Trouble::malformed(text, start..start + length, message, "begins here", help)
}

/// `<` stands before what is no name.
pub(super) fn no_element(text: &str, start: usize) -> Trouble {
    let help = "write &lt; for <, or the name of an element directly behind it";
    Trouble::malformed(text, start..start + 1, "`<` begins no element here", "no name follows", help)
}

/// What stands where a name should.
pub(super) fn no_name(text: &str, at: Range<usize>) -> Trouble {
    if let Some(begin) = text[at.clone()].find('<') {
        return tag_within(text, at.start + begin);
    }
    let message = format!("`{}` is not a name", shown(&text[at.clone()]));
    let help = "names begin with a letter or _ and go on with letters, digits, - . and _; one : may follow a prefix";
    Trouble::malformed(text, at, message, "not a name", help)
}

/// `<` stands between the parts of a tag.
fn tag_within(text: &str, at: usize) -> Trouble {
    let help = "write > or /> where the tag before ends";
    Trouble::malformed(text, at..at + 1, "`<` stands within a tag", "expected > before this", help)
}

/// No declaration binds a prefix.
pub(super) fn unknown_prefix(text: &str, at: Range<usize>) -> Trouble {
    let prefix = shown(&text[at.clone()]);
    let help = format!("add xmlns:{prefix}=\"…\" to this element or to one around it, or leave the prefix out");
    Trouble::malformed(text, at, format!("the prefix `{prefix}` stands for no namespace"), "not declared", help)
}

/// What the tokenizer found no attribute in; its positions count from the start of the tag's content.
pub(super) fn no_attribute(text: &str, start: usize, error: &AttrError) -> Trouble {
    let (position, message, label) = match error {
        AttrError::ExpectedEq(position) => (position, "an attribute has no value", "expected = before this"),
        AttrError::ExpectedValue(position) => (position, "an attribute has no value", "expected a value"),
        AttrError::UnquotedValue(position) => (position, "the value of an attribute has no quotes", "expected \""),
        AttrError::ExpectedQuote(position, _) => (position, "the quotes around a value are not closed", "not closed"),
        AttrError::Duplicated(position, _) => (position, "an attribute stands twice in one element", "again"),
    };
    let position = start + position;
    let length = text[position..].chars().next().map_or(0, char::len_utf8);
    // Names and values before this are good, so it is in this one.
    if let Some(begin) = text[start..position + length].find('<') {
        return tag_within(text, start + begin);
    }
    Trouble::malformed(text, position..position + length, message, label, "write each attribute as name=\"value\"")
}

pub(super) fn no_blank(text: &str, at: Range<usize>) -> Trouble {
    let help = "put a blank between a value and the attribute after it";
    Trouble::malformed(text, at, "a blank is missing", "before this", help)
}

pub(super) fn bad_declaration(text: &str, at: Range<usize>, message: &str) -> Trouble {
    let help = "give each prefix one namespace, and leave `xml` and `xmlns` alone";
    Trouble::malformed(text, at, message, "here", help)
}

/// Two attributes of an element have the same name; the bytes are those of their names.
pub(super) fn twice(text: &str, first: Range<usize>, second: Range<usize>) -> Trouble {
    let (line, column) = line_and_column(text, first.start);
    let name = shown(&text[second.clone()]);
    let message = format!("the attribute `{name}` stands twice in one element, first at line {line}, column {column}");
    Trouble::malformed(text, second, message, "again", "delete one of the two")
}

/// A reference stands for nothing.
pub(super) fn unknown_reference(text: &str, at: Range<usize>) -> Trouble {
    let (found, label) = match text[at.clone()].strip_suffix(';') {
        Some(_) => (format!("`{}` stands for nothing", shown(&text[at.clone()])), "not known"),
        None => ("`&` begins a reference that no `;` ends".to_owned(), "write &amp;"),
    };
    let help = "write &amp; for &; known are &lt; &gt; &amp; &quot; &apos; and numbers of characters such as &#181;";
    Trouble::malformed(text, at, found, label, help)
}

/// `<` stands in a value.
pub(super) fn unescaped(text: &str, at: usize) -> Trouble {
    let help = "write &lt; for <; if the value ends before, its quote is missing there";
    Trouble::malformed(text, at..at + 1, "`<` stands in the value of an attribute", "write &lt;", help)
}

pub(super) fn second_root(text: &str, at: Range<usize>) -> Trouble {
    let message = "a document has one element around all others";
    Trouble::malformed(text, at, message, "a second one", "put all elements into one")
}

/// An end tag closes something else than what is open, whose name stands at `open`.
pub(super) fn wrong_end(text: &str, at: Range<usize>, name: &str, open: Range<usize>) -> Trouble {
    let (line, column) = line_and_column(text, open.start - 1);
    let expected = shown(&text[open]);
    let found = shown(name);
    let message = format!("found </{found}>, expected </{expected}> (opened at line {line}, column {column})");
    let help = format!("write </{expected}> before it, or in its place; <{expected} …/> needs no second tag");
    Trouble::malformed(text, at, message, "the wrong end", help)
}

pub(super) fn closes_nothing(text: &str, at: Range<usize>, name: &str) -> Trouble {
    let message = format!("</{}> closes no element", shown(name));
    Trouble::malformed(text, at, message, "nothing is open", "delete it, or write the tag that begins the element")
}

/// `]]>` stands in a text.
pub(super) fn section_end(text: &str, start: usize) -> Trouble {
    let help = "write &gt; for its >";
    Trouble::malformed(text, start..start + 3, "`]]>` stands in a text", "write ]]&gt;", help)
}

pub(super) fn outside(text: &str, at: Range<usize>) -> Trouble {
    let raw = &text[at.clone()];
    let start = at.start + raw.len() - raw.trim_start_matches(is_blank).len();
    let at = start..start + raw.trim_matches(is_blank).len();
    let help = "delete it, put it into the element, or make it a comment: <!-- … -->";
    Trouble::malformed(text, at, "a text stands outside of the root element", "this text", help)
}

/// Whether a comment may say what it says.
pub(super) fn comment(text: &str, at: Range<usize>, words: &str) -> Result<(), Trouble> {
    let Some(found) = words.find("--").or_else(|| words.ends_with('-').then(|| words.len() - 1)) else { return Ok(()) };
    let start = at.start + 4 + found;
    let help = "write a single hyphen, or end the comment with -->";
    Err(Trouble::malformed(text, start..start + 2, "`--` stands in a comment", "two hyphens", help))
}

/// The text ends before an element, whose name stands at some bytes.
pub(super) fn not_closed(text: &str, name_at: Range<usize>) -> Trouble {
    let name = shown(&text[name_at.clone()]);
    let help = format!("write </{name}> where it ends, or /> in place of its > if nothing is in it");
    Trouble::malformed(text, name_at, format!("<{name}> is not closed"), "begins here", help)
}

pub(super) fn no_root(text: &str) -> Trouble {
    let end = text.len();
    Trouble::malformed(text, end..end, "there is no element in the document", "ends here", "write one")
}
