//! Names in the code are the field's words: those of a list that once meant something here alone are not used again.

use std::path::{Path, PathBuf};

/// What is not a name of anything in the code, and what to say instead.
const PRIVATE: [(&[&str], &str); 8] = [
    (&["place", "places"], "location (of a fault), position, point or index"),
    (&["way", "ways"], "path, direction, displacement or method"),
    (&["room", "rooms"], "module, buffer, space or margin"),
    (&["give", "gives"], "yield or return"),
    (&["seat", "seats"], "lane or index"),
    (&["care", "desk"], "tolerance factor, scratch"),
    (&["hopeless"], "the trouble by its name"),
    (&["whiff"], "concentration"),
];

/// The names in a source: without comments and texts, and with the names that texts hold in braces left out.
fn names(source: &str) -> Vec<&str> {
    let mut names = Vec::new();
    let mut rest = source;
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if let Some(text) = rest.strip_prefix("r#\"") {
            text.find("\"#").map_or(rest.len(), |end| end + 5)
        } else if first == '"' {
            let mut escaped = false;
            let end = rest[1..].find(|c| {
                let ends = c == '"' && !escaped;
                escaped = c == '\\' && !escaped;
                ends
            });
            end.map_or(rest.len(), |end| end + 2)
        } else if rest.starts_with("'\"'") || rest.starts_with("'\\\"'") {
            if rest.starts_with("'\\") { 4 } else { 3 }
        } else if first.is_ascii_alphabetic() || first == '_' {
            let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len());
            names.push(&rest[..end]);
            end
        } else {
            first.len_utf8()
        };
        rest = &rest[length..];
    }
    names
}

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder of sources").map(|entry| entry.expect("an entry").path());
    let (folders, files): (Vec<PathBuf>, Vec<PathBuf>) = entries.partition(|path| path.is_dir());
    let rust = files.into_iter().filter(|path| path.extension().is_some_and(|kind| kind == "rs"));
    rust.chain(folders.iter().flat_map(|folder| sources(folder))).collect()
}

#[test]
fn names_stand_in_code_and_not_in_texts_or_comments() {
    let source = "let a = \"room \\\" way\"; // place\nlet b = '\"'; let place = r#\"desk \"care\"\"#; give(a)";
    assert_eq!(names(source), ["let", "a", "let", "b", "let", "place", "give", "a"]);
}

#[test]
fn names_are_the_words_of_the_field() {
    let all = sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    assert!(all.len() > 300, "the sources were not found");
    let mut faults = Vec::new();
    for path in all {
        let source = std::fs::read_to_string(&path).expect("a source can be read");
        for name in names(&source) {
            let words = PRIVATE.iter().find(|(words, _)| words.contains(&name.to_ascii_lowercase().as_str()));
            faults.extend(words.map(|(_, instead)| format!("{}: `{name}`; say {instead}", path.display())));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
