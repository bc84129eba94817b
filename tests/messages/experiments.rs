//! Every message about chemistry, contacts or mechanics that do not fit their experiment is kept beside the experiment.

use crate::kept;
use pseudopod::error::Error;
use pseudopod::experiment::{Document, compile, settle_start};
use std::path::Path;

fn compiled(path: &Path) -> Result<(), Error> {
    let document = Document::read(path, &[])?;
    settle_start(&document, &mut compile(&document)?).map(drop)
}

/// Holds the messages of the experiments of a folder, of which there are so many at least.
fn every_message_is_that_beside(folder: &str, least: usize) {
    kept::every_message_is_that_beside(&kept::documents(folder, |_| true), least, compiled);
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
