//! Every message about contacts that do not fit the cells of their experiment is kept beside the experiment.
//!
//! `PSEUDOPOD_BLESS=1 cargo test --test messages_contact` writes the texts anew; read the difference before committing it.

use pseudopod::error::{Error, Paint, render};
use pseudopod::experiment::{Document, check_start, compile};
use std::path::{Path, PathBuf};

fn experiments() -> Vec<PathBuf> {
    let folder = std::fs::read_dir("tests/messages/contact").expect("the folder of bad experiments");
    let paths = folder.map(|entry| entry.expect("an entry of the folder").path());
    let mut paths: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    paths.sort();
    paths
}

fn compiled(path: &Path) -> Result<(), Error> {
    let document = Document::read(path, &[])?;
    check_start(&document, &compile(&document)?)
}

#[test]
fn every_bad_experiment_gets_the_message_beside_it() {
    let mut differences = Vec::new();
    assert!(experiments().len() >= 4, "bad experiments are missing");
    for path in experiments() {
        let Err(error) = compiled(&path) else {
            differences.push(format!("{} is taken for a good experiment", path.display()));
            continue;
        };
        assert_eq!(error.exit_code(), 2, "bad input ends with 2");
        if let Error::Input(faults) = &error {
            let is_whole = |fault: &pseudopod::error::Fault| fault.help.is_some() && fault.place.is_some();
            assert!(faults.iter().all(is_whole), "{}: a fault without help or place", path.display());
        }
        let (message, kept) = (render(&error, Paint::Plain), path.with_extension("txt"));
        if std::env::var_os("PSEUDOPOD_BLESS").is_some() {
            std::fs::write(&kept, message).expect("the text can be kept");
        } else if message != std::fs::read_to_string(&kept).unwrap_or_default() {
            differences.push(format!("{}:\n{message}", kept.display()));
        }
    }
    assert!(differences.is_empty(), "messages that changed:\n\n{}", differences.join("\n\n"));
}
