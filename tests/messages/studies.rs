//! Every message about bad studies is kept beside the study.

use crate::kept;
use crate::turns::take_turn;
use pseudopod::error::{Error, Paint, render};
use pseudopod::study::{StudyDocument, look_over, points};
use std::path::Path;

/// What `sweep plan` does before it writes anything.
fn looked_over(path: &Path) -> Result<(), Error> {
    let study = StudyDocument::read(path)?;
    look_over(&study, &points(&study)?, None).map(drop)
}

#[test]
fn every_bad_study_gets_the_message_beside_it() {
    let _turn = take_turn();
    let studies = kept::documents("studies", |path| !path.ends_with("cells.toml"));
    kept::every_message_is_that_beside(&studies, 20, looked_over);
}

#[test]
fn a_study_that_is_not_there_is_told_with_what_to_name() {
    let error =
        StudyDocument::read(Path::new("tests/messages/studies/nowhere.toml")).expect_err("there is nothing to read");
    assert!(render(&error, Paint::Plain).contains("help: name a study document"));
}
