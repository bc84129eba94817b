//! The experiment document: what it says is what is understood, from a file or from Rust.

use proptest::prelude::*;
use pseudopod::Vec3;
use pseudopod::experiment::{Course, Document, Mesh, Selection, When, compile};
use pseudopod::geometry::{bounding_box, icosphere, volume};
use pseudopod::units::{Force, Length, LineStiffness, Time};
use std::path::Path;

fn everything(sets: &[&str]) -> Document {
    let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
    Document::read(Path::new("tests/documents/everything.toml"), &sets).unwrap_or_else(|error| {
        panic!("{}", pseudopod::error::render(&error, pseudopod::error::Paint::Plain));
    })
}

#[test]
fn a_document_is_understood_in_base_units() {
    let document = everything(&[]);
    let experiment = &document.experiment;
    assert_eq!(experiment.cells.keys().collect::<Vec<_>>()[..3], ["red", "ball", "eight"], "order of the document");
    let red = &experiment.cells["red"];
    assert_eq!(red.mesh, Mesh::RedCell { diameter: Length::new(7.82), level: 3 });
    assert_eq!(red.mechanics.membrane.as_ref().map(|membrane| membrane.shear), Some(LineStiffness::new(5.3)));
    assert_eq!(red.applied.fixed[0].selection, Selection::Atoms(vec![0, 1]));
    let points = [(0.0, 0.0), (1.0, 16.0)].map(|(time, force)| (Time::new(time), Force::new(force)));
    assert_eq!(red.applied.loads[0].force, Course::Points(points.to_vec()));
    assert_eq!(red.applied.loads[1].force.points(), [(0.0, 10.0)]);
    assert_eq!(experiment.cells["ball"].count(), 100, "the number follows from the grid");
    assert_eq!(experiment.picture.time, When::At(Time::new(12.0)));
    assert_eq!(experiment.environment.gravity.map(|gravity| gravity[2].value()), Some(-9.81e6));
}

#[test]
fn a_mesh_is_drawn_out_before_it_is_turned_and_is_so_at_rest() {
    let text = "title = \"Drawn out\"\n[run]\nuntil = \"1 s\"\n[cells.ball]\n\
         mesh = { shape = \"icosphere\", radius = \"5 um\", level = 2 }\nstretch = [2, 1, 0.5]\n\
         orientation = { axis = [0, 0, 1], angle = \"90 deg\" }\nmechanics = { drag = \"1 pN s/um\" }\n";
    let document = Document::parse("drawn.toml", text, Path::new("."), &[]).unwrap_or_else(|error| panic!("{error}"));
    let rest = &compile(&document).unwrap_or_else(|error| panic!("{error}")).model.kinds[0].rest;
    let (low, high) = bounding_box(&rest.positions).unwrap();
    let (ball, size) = (icosphere(5.0, 2), high - low);
    let (ball_low, ball_high) = bounding_box(&ball.positions).unwrap();
    let wanted = (ball_high - ball_low).component_mul(&Vec3::new(2.0, 1.0, 0.5));
    assert!((size - Vec3::new(wanted.y, wanted.x, wanted.z)).norm() < 1e-12, "{size} {wanted}");
    assert!((volume(rest) / volume(&ball) - 1.0).abs() < 1e-12);
}

#[test]
fn an_experiment_written_out_is_the_same_experiment() {
    let experiment = everything(&[]).experiment;
    let text = toml::to_string(&experiment).expect("a document");
    let again = Document::parse("again.toml", &text, Path::new("tests/documents"), &[]).expect("the same document");
    assert_eq!(again.experiment, experiment);
    assert!(again.experiment.cells.keys().eq(experiment.cells.keys()), "in the same order");
}

#[test]
fn set_changes_any_key_and_leaves_the_text() {
    let document = everything(&["run.until=40 s", "seed=9", "cells.red.loads[1].force=[[\"0 s\", \"2 pN\"]]"]);
    assert_eq!(document.experiment.run.until, Time::new(40.0));
    assert_eq!(document.experiment.seed, 9);
    assert_eq!(document.experiment.cells["red"].applied.loads[1].force.points(), [(0.0, 2.0)]);
    assert!(document.source.text.contains("until = \"26 s\""));
    assert_eq!(document.sets.len(), 3);
}

#[test]
fn a_bare_zero_is_nothing_in_any_unit() {
    let document = everything(&["picture.cut=0", "picture.time=0", "environment.gravity=[0, 0, 0.0]"]);
    assert_eq!(document.experiment.picture.cut, Some(Length::ZERO));
    assert_eq!(document.experiment.picture.time, When::At(Time::ZERO));
    assert!(document.experiment.environment.gravity.is_some_and(|gravity| gravity.iter().all(|g| g.value() == 0.0)));
    let sets = ["picture.cut=5".to_owned()];
    assert!(Document::read(Path::new("tests/documents/everything.toml"), &sets).is_err(), "5 of what?");
}

#[test]
fn a_key_is_located_where_it_stands_and_a_default_at_the_table_around_it() {
    let document = everything(&["cells.ball.mesh.level=3"]);
    let marked = |path: &str| {
        let location = document.location(path, "here")?;
        Some(location.source.text[location.start..location.start + location.length].to_owned())
    };
    assert_eq!(marked("cells.red.fixed[0].atoms").as_deref(), Some("[0, 1]"));
    assert_eq!(marked("cells.red.loads[0].force[1][1]").as_deref(), Some("\"16 pN\""));
    assert_eq!(marked("cells.red.mechanics.volume.nothing").as_deref().map(|text| &text[..9]), Some("{ rule = "));
    assert_eq!(marked("output.nothing").as_deref(), Some("[output]"));
    assert_eq!(marked("nothing"), None);
    let set = document.location("cells.ball.mesh.level", "here").expect("set");
    assert_eq!((set.source.name.as_str(), &set.source.text[set.start..]), ("--set cells.ball.mesh.level=…", "3"));
    assert!(document.says("output.every") && !document.says("output.nothing"));
}

#[test]
fn the_schema_in_the_documents_is_the_one_of_the_types() {
    let path = "docs/experiment.schema.json";
    let now = pseudopod::cli::schema::text();
    if std::env::var_os("PSEUDOPOD_BLESS").is_some() {
        std::fs::write(path, &now).expect("the schema can be written");
    }
    let kept = std::fs::read_to_string(path).unwrap_or_default();
    assert!(kept == now, "{path} is not current; run: pseudopod schema --force -o {path}");
}

#[test]
fn every_method_that_the_book_names_is_understood() {
    let book = std::fs::read_to_string("docs/src/documents.md").expect("the page of documents");
    let list = book.split_once("`method`: ").and_then(|(_, rest)| rest.split_once(';')).expect("the list of methods").0;
    let names: Vec<&str> = list.split(", ").filter_map(|name| name.split_whitespace().next()).collect();
    assert_eq!(names.len(), 6, "{names:?}");
    for name in names {
        let text = format!("method = \"{name}\"");
        assert!(toml::from_str::<pseudopod::experiment::Integrator>(&text).is_ok(), "{name}");
    }
}

proptest! {
    /// Whatever is cut out of a document, or written over it, is answered by faults and never by a panic.
    #[test]
    fn a_damaged_document_never_panics(start in 0usize..6000, length in 0usize..40, other in "[\\[\\]{}=\"a-z0-9., -]{0,6}") {
        let mut text = everything(&[]).source.text.clone();
        let boundary = |at: usize, text: &str| (0..=at.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0);
        let (from, to) = (boundary(start, &text), boundary(start + length, &text));
        text.replace_range(from..to, &other);
        if let Err(error) = Document::parse("damaged.toml", &text, Path::new("tests/documents"), &[]) {
            let message = pseudopod::error::render(&error, pseudopod::error::Paint::Plain);
            prop_assert!(!message.contains("cannot be understood"), "the checker missed what serde found:\n{message}");
        }
    }
}
