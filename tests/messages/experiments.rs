//! Every message about chemistry, contacts or mechanics that do not fit their experiment is kept beside the experiment.

use pseudopod::error::{Error, Paint, render};
use pseudopod::experiment::{Document, compile, settle_start};
use std::path::{Path, PathBuf};

fn experiments(folder: &str) -> Vec<PathBuf> {
    let folder = std::fs::read_dir(Path::new("tests/messages").join(folder)).expect("the folder of bad experiments");
    let paths = folder.map(|entry| entry.expect("an entry of the folder").path());
    let mut paths: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    paths.sort();
    paths
}

fn compiled(path: &Path) -> Result<(), Error> {
    let document = Document::read(path, &[])?;
    settle_start(&document, &mut compile(&document)?).map(drop)
}

/// Holds the messages of the experiments of a folder, of which there are so many at least.
fn every_message_is_that_beside(folder: &str, least: usize) {
    let mut differences = Vec::new();
    assert!(experiments(folder).len() >= least, "bad experiments are missing");
    for path in experiments(folder) {
        let Err(error) = compiled(&path) else {
            differences.push(format!("{} is taken for a good experiment", path.display()));
            continue;
        };
        assert_eq!(error.exit_code(), 2, "bad input ends with 2");
        if let Error::Input(faults) = &error {
            assert!(faults.iter().all(|fault| fault.help.is_some()), "{}: a fault without help", path.display());
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

#[test]
fn every_bad_experiment_with_chemistry_gets_the_message_beside_it() {
    every_message_is_that_beside("chemistry", 10);
}

#[test]
fn every_bad_experiment_with_contacts_gets_the_message_beside_it() {
    every_message_is_that_beside("contact", 8);
}

#[test]
fn every_bad_experiment_with_mechanics_gets_the_message_beside_it() {
    every_message_is_that_beside("mechanics", 1);
}
