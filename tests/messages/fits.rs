//! Every message about bad fits is kept beside the fit.

use crate::kept;
use crate::turns::take_turn;
use pseudopod::error::{Error, Paint, render};
use pseudopod::simulation::CancelToken;
use pseudopod::study::Replaces;
use pseudopod::study::fit::{EvaluateOptions, FitDocument, Prepared, fit};
use std::path::Path;

/// What `fit` does; most is told before anything runs.
fn fitted(path: &Path) -> Result<(), Error> {
    let folder = tempfile::tempdir().expect("a folder");
    let prepared = Prepared::new(FitDocument::read(path)?, folder.path(), None)?;
    prepared.plan.write(Replaces::Nothing)?;
    let options = EvaluateOptions { jobs: 1, threads: 1, cancel: CancelToken::new(), memory: None, tell: &|_| () };
    fit(&prepared, &options).map(drop)
}

#[test]
fn every_bad_fit_gets_the_message_beside_it() {
    let _turn = take_turn();
    let fits = kept::documents("fits", |path| !path.ends_with("experiment.toml"));
    kept::every_message_is_that_beside(&fits, 20, fitted);
}

#[test]
fn a_fit_that_is_not_there_is_told_with_what_to_name() {
    let error = FitDocument::read(Path::new("tests/messages/fits/nowhere.toml")).expect_err("there is nothing to read");
    assert!(render(&error, Paint::Plain).contains("help: name a fit document"));
}
