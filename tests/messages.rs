//! Every message about bad input is kept beside the input that causes it.
//!
//! `PSEUDOPOD_BLESS=1 cargo test --test messages` writes the texts anew; read the difference before committing it.

use pseudopod::error::{Error, Paint, render};
use pseudopod::experiment::Document;
use std::path::{Path, PathBuf};

/// Changes that a document asks for in lines `#! --set key=value`.
fn sets(text: &str) -> Vec<String> {
    text.lines().filter_map(|line| line.strip_prefix("#! --set ")).map(str::to_owned).collect()
}

/// Compares a message with the kept text, or keeps it.
fn compare(error: &Error, kept: &Path) -> Result<(), String> {
    let message = render(error, Paint::Plain);
    if std::env::var_os("PSEUDOPOD_BLESS").is_some() {
        return std::fs::write(kept, message).map_err(|error| format!("{}: {error}", kept.display()));
    }
    let expected = std::fs::read_to_string(kept).unwrap_or_default();
    if message == expected { Ok(()) } else { Err(format!("{}:\n{message}", kept.display())) }
}

fn documents() -> Vec<PathBuf> {
    let folder = std::fs::read_dir("tests/messages/documents").expect("the folder of bad documents");
    let paths = folder.map(|entry| entry.expect("an entry of the folder").path());
    let mut paths: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    paths.sort();
    paths
}

#[test]
fn every_bad_document_gets_the_message_beside_it() {
    let documents = documents();
    assert!(documents.len() >= 14, "bad documents are missing: {documents:?}");
    let mut differences = Vec::new();
    for path in documents {
        let text = std::fs::read_to_string(&path).expect("a text");
        match Document::read(&path, &sets(&text)) {
            Ok(_) => differences.push(format!("{} is taken for a good document", path.display())),
            Err(error) => {
                assert_eq!(error.exit_code(), 2, "bad input ends with 2");
                differences.extend(compare(&error, &path.with_extension("txt")).err());
            }
        }
    }
    assert!(differences.is_empty(), "messages that changed:\n\n{}", differences.join("\n\n"));
}

#[test]
fn a_document_that_is_not_there_is_looked_for_nearby() {
    let folder = Path::new("tests/messages/documents");
    let mut differences = Vec::new();
    for (missing, kept) in [
        (folder.join("empy.toml"), "missing_file.txt"),
        (folder.join("nowhere/experiment.toml"), "missing_folder.txt"),
        (folder.to_owned(), "folder.txt"),
    ] {
        let error = Document::read(&missing, &[]).expect_err("there is nothing to read");
        differences.extend(compare(&error, &folder.join(kept)).err());
    }
    assert!(differences.is_empty(), "messages that changed:\n\n{}", differences.join("\n\n"));
}

#[test]
fn every_fault_of_a_document_has_a_place() {
    for path in documents() {
        let text = std::fs::read_to_string(&path).expect("a text");
        if let Err(Error::Input(faults)) = Document::read(&path, &sets(&text)) {
            for fault in faults {
                let place = fault.place.unwrap_or_else(|| panic!("{}: {}", path.display(), fault.message));
                assert!(place.source.text.get(place.start..place.start + place.length).is_some(), "inside the text");
                assert!(fault.help.is_some(), "{}: {} says what to do", path.display(), fault.message);
            }
        }
    }
}
