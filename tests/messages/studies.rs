//! Every message about bad studies is kept beside the study.

use crate::turns::take_turn;
use pseudopod::error::{Error, Paint, render};
use pseudopod::study::{StudyDocument, look_over, points};
use std::path::{Path, PathBuf};

const FOLDER: &str = "tests/messages/studies";

/// The documents of the folder but for the experiment.
fn studies() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(FOLDER).expect("the folder of bad studies");
    let paths = entries.map(|entry| Path::new(FOLDER).join(entry.expect("an entry of the folder").file_name()));
    let is_study = |path: &PathBuf| path.extension().is_some_and(|end| end == "toml") && !path.ends_with("cells.toml");
    let mut paths: Vec<PathBuf> = paths.filter(is_study).collect();
    paths.sort();
    paths
}

/// What `sweep plan` does before it writes anything.
fn looked_over(path: &Path) -> Result<(), Error> {
    let study = StudyDocument::read(path)?;
    look_over(&study, &points(&study)?, None).map(drop)
}

#[test]
fn every_bad_study_gets_the_message_beside_it() {
    let _turn = take_turn();
    let mut differences = Vec::new();
    let studies = studies();
    assert!(studies.len() >= 18, "bad studies are missing: {studies:?}");
    for path in studies {
        let Err(error) = looked_over(&path) else {
            differences.push(format!("{} is taken for a good study", path.display()));
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
fn a_study_that_is_not_there_is_told_with_what_to_name() {
    let error = StudyDocument::read(&Path::new(FOLDER).join("nowhere.toml")).expect_err("there is nothing to read");
    assert!(render(&error, Paint::Plain).contains("help: name a study document"));
}
