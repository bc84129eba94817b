//! The reference page of EML, from the words that its reader knows.

use crate::equations::eml::{Attribute, ELEMENTS, Kind, SCHEMES};
use crate::equations::expression;
use std::fmt::Write as _;

/// The page: a section for each element, then functions and schemes.
pub(super) fn page(introduction: &str) -> String {
    let mut text = format!("# Words of EML\n\n{introduction}\n");
    for kind in &ELEMENTS {
        write_element(&mut text, kind);
    }
    text.push_str("\n## Functions\n\n| function | value |\n|---|---|\n");
    for (example, about) in expression::functions_in_words() {
        let _ = writeln!(text, "| `{example}` | {about} |");
    }
    text.push_str("\n## Schemes\n\n| scheme | |\n|---|---|\n");
    for (name, scheme) in SCHEMES {
        let _ = writeln!(text, "| `{name}` | {} |", scheme.meaning());
    }
    text
}

fn write_element(text: &mut String, kind: &Kind) {
    let within = kind.inside.map_or_else(String::new, |parent| format!(" in `<{parent}>`"));
    let _ = write!(text, "\n## `<{}>`{within}\n\n{}", kind.name, kind.meaning);
    if kind.text {
        text.push_str(if kind.name == "table" {
            " It may hold rows of two numbers."
        } else {
            " It holds an expression."
        });
    }
    text.push('\n');
    if !kind.children.is_empty() {
        let children: Vec<String> = kind.children.iter().map(|name| format!("`<{name}>`")).collect();
        let _ = write!(text, "\nIn it: {}.\n", children.join(", "));
    }
    if kind.attributes().next().is_some() {
        text.push_str("\n| attribute | must be there | meaning |\n|---|---|---|\n");
        let rows = |list: &'static [Attribute], needed| list.iter().map(move |(name, meaning)| (name, needed, meaning));
        for (name, needed, meaning) in rows(kind.required, "yes").chain(rows(kind.optional, "")) {
            let _ = writeln!(text, "| `{name}` | {needed} | {meaning} |");
        }
    }
}
