//! Identifiers of an included document with a prefix before them: `k` becomes `a_k` wherever it stands.

use super::xml::{Element, Text};
use std::collections::HashSet;

/// Attributes that hold identifiers and expressions, whatever the element.
const ATTRIBUTES: [&str; 26] = [
    "id",
    "of",
    "towards",
    "value",
    "initial",
    "rate",
    "reverse",
    "diffusion",
    "decay",
    "history",
    "noise",
    "default",
    "start",
    "when",
    "every",
    "first",
    "until",
    "delay",
    "priority",
    "sensitivity",
    "strength",
    "transfer",
    "x",
    "y",
    "z",
    "",
];

/// Sets a prefix before all that the children of an element declare. What they use of others stays as it is.
pub(super) fn with_prefix(root: &mut Element, prefix: &str) {
    let declared: HashSet<String> =
        root.children.iter().filter(|child| child.attribute("id").is_some()).map(|child| child.word("id")).collect();
    root.children.iter_mut().for_each(|child| rename(child, &declared, prefix));
}

fn rename(element: &mut Element, declared: &HashSet<String>, prefix: &str) {
    let kind = element.kind.name;
    // The arguments of a function hide what has the same names outside of it.
    let arguments = element.word("args");
    let arguments: Vec<&str> = arguments.split(',').map(str::trim).collect();
    element.each_own_text(&mut |attribute, text| {
        // The name of a column, and what a link carries.
        let is_own = |name: &str| arguments.contains(&name) || (attribute == "transfer" && name == "value");
        let from = match (kind, attribute) {
            ("table", "value" | "") => return,
            ("link", "from" | "to") => match text.text.find("system.") {
                Some(at) if text.text[..at].trim().is_empty() => at + "system.".len(),
                _ => return,
            },
            ("reaction", "equation") => 0,
            (_, attribute) if ATTRIBUTES.contains(&attribute) => 0,
            _ => return,
        };
        *text = renamed(text, from, attribute == "equation", &|name| declared.contains(name) && !is_own(name), prefix);
    });
    element.children.iter_mut().for_each(|child| rename(child, declared, prefix));
}

/// A text with a prefix before some names behind a byte.
fn renamed(text: &Text, from: usize, is_equation: bool, is_meant: &dyn Fn(&str) -> bool, prefix: &str) -> Text {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    let mut found = text.part(&(0..from));
    let (mut at, mut copied) = (from, from);
    while let Some(c) = text.text[at..].chars().next() {
        let rest = &text.text[at..];
        let length = match c {
            // Units of numbers.
            '[' => rest.find(']').map_or(rest.len(), |end| end + 1),
            // `2 A` may be written `2A`, and `2e3` has no name in it.
            c if c.is_ascii_digit() && is_equation => 1,
            c if c.is_ascii_digit() => rest.find(|c| !is_part(c) && c != '.').unwrap_or(rest.len()),
            c if c.is_alphabetic() || c == '_' => rest.find(|c| !is_part(c)).unwrap_or(rest.len()),
            c => c.len_utf8(),
        };
        if (c.is_alphabetic() || c == '_') && is_meant(&rest[..length]) {
            found.append(&text.part(&(copied..at)));
            found.write(&format!("{prefix}_"), &text.location(&(at..at + length)));
            copied = at;
        }
        at += length;
    }
    found.append(&text.part(&(copied..text.text.len())));
    found
}
