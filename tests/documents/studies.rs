//! Studies: those that ship are good, and their schema is the one that is kept.

use pseudopod::study::{StudyDocument, look_over, points};
use std::path::Path;

#[test]
fn the_schema_of_studies_is_the_one_of_the_types() {
    let path = "docs/study.schema.json";
    let now = pseudopod::cli::schema::study_text();
    if std::env::var_os("PSEUDOPOD_BLESS").is_some() {
        std::fs::write(path, &now).expect("the schema can be written");
    }
    let kept = std::fs::read_to_string(path).unwrap_or_default();
    assert!(kept == now, "{path} is not current; run: pseudopod schema --study --force -o {path}");
}

#[test]
fn the_study_that_ships_has_the_points_that_its_page_says() {
    let study = StudyDocument::read(Path::new("experiments/aggregation/study.toml")).expect("a good study");
    let points = points(&study).expect("good points");
    assert_eq!((points.rows.len(), study.study.replicates), (40, 5));
    assert_eq!(points.rows[0], ["0.01", "2"]);
    assert_eq!(points.rows[39], ["1", "20"]);
    let looked = look_over(&study, &points, None).expect("an experiment that takes them");
    assert_eq!(looked.read, 40);
}

#[test]
fn the_study_that_the_book_shows_is_good() {
    let page = std::fs::read_to_string("docs/src/howto_sweep.md").expect("the page");
    let text = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("the study of the page");
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("study.toml"), text).expect("a file");
    let experiment = std::fs::read_to_string("experiments/aggregation/experiment.toml").expect("an experiment");
    // Its measures look beyond the end that the study sets.
    let experiment = experiment.split("[[plot]]").next().expect("what comes before");
    std::fs::write(folder.path().join("experiment.toml"), experiment).expect("a file");
    let study = StudyDocument::read(&folder.path().join("study.toml")).expect("a good study");
    let points = points(&study).expect("good points");
    assert_eq!(points.rows.len(), 24);
    look_over(&study, &points, None).expect("an experiment that takes them");
}
