//! What the program carries to begin with: experiments, which are copied as good as they are, and templates, which run.

use pseudopod::cli::{check, demo, new, shipped};
use pseudopod::experiment::Document;
use pseudopod::run::{Quiet, RunOptions, run};
use pseudopod::study::{StudyDocument, look_over, points};
use pseudopod::verify::subjects;
use std::path::{Path, PathBuf};

fn check(documents: Vec<PathBuf>) {
    let args = check::CheckArgs { documents, sets: Vec::new(), memory: None, json: true };
    if let Err(error) = check::run(&args) {
        panic!("{}", pseudopod::error::render(&error, pseudopod::error::Paint::Plain));
    }
}

#[test]
fn every_copied_experiment_passes_the_check() {
    let scratch = tempfile::tempdir().unwrap();
    let all = shipped::experiments();
    for experiment in &all {
        let folder = scratch.path().join(experiment.folder);
        demo::copy(experiment, &folder).unwrap();
        check(std::iter::once(&experiment.main).chain(&experiment.others).map(|name| folder.join(name)).collect());
    }
    assert!(all.len() > 30, "{}", all.len());
}

#[test]
fn every_experiment_that_ships_measures_what_is_claimed_of_it() {
    let all = subjects(Path::new("experiments"), None).unwrap();
    assert!(all.len() > 40, "{}", all.len());
}

/// Writes a template into a folder.
fn write(folder: &Path, template: &str, document: &str) -> PathBuf {
    let document = folder.join(document);
    let args =
        new::NewArgs { template: Some(template.to_owned()), output: Some(document.clone()), force: false, json: true };
    new::run(&args).unwrap();
    document
}

#[test]
fn every_template_passes_the_check_and_runs() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["dish", "aggregate", "pull", "squeeze", "chemotaxis"] {
        let path = write(folder.path(), name, &format!("{name}.toml"));
        check(vec![path.clone()]);
        // Pictures, plots and measures look beyond so short a run.
        let text = std::fs::read_to_string(&path).unwrap();
        let begun = text.split("[picture]").next().unwrap();
        let document = Document::parse(name, begun, folder.path(), &["run.until=0.2 s".to_owned()]).unwrap();
        let result = folder.path().join(format!("{name}.h5"));
        let outcome = run(&document, &RunOptions::new(&result), &mut Quiet).unwrap();
        assert!(outcome.steps > 0 && outcome.frames > 1, "{name}: {outcome:?}");
    }
}

#[test]
fn the_template_of_a_study_is_good_and_its_experiment_takes_its_values() {
    let folder = tempfile::tempdir().unwrap();
    let study = StudyDocument::read(&write(folder.path(), "sweep", "study.toml")).unwrap();
    let points = points(&study).unwrap();
    assert_eq!((points.rows.len(), study.study.replicates), (12, 3));
    look_over(&study, &points, None).unwrap();
    check(vec![folder.path().join("cells.toml")]);
}

#[test]
fn every_experiment_may_be_cut_short() {
    for subject in subjects(Path::new("experiments"), None).unwrap() {
        let document = &subject.path;
        if let Err(error) = Document::read(document, &["run.until=0.01 s".to_owned()]) {
            panic!("{}", pseudopod::error::render(&error, pseudopod::error::Paint::Plain));
        }
    }
}
