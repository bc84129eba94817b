//! Damaged documents, models, meshes and tables: every reader ends soon, with what is wrong and where, and never in a panic.
//!
//! Which damage a text gets depends on its number alone, so that what is found is found again.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use pseudopod::analysis::claims;
use pseudopod::analysis::table::Table;
use pseudopod::analysis::tracks::{package, read as tracks};
use pseudopod::equations;
use pseudopod::error::{Error, Paint, Source, render};
use pseudopod::experiment::Document;
use pseudopod::geometry::read_surface;
use pseudopod::physical_model::Read;
use pseudopod::physical_model::lml::Loads;
use pseudopod::physical_model::mml::Monitoring;
use pseudopod::physical_model::pml::{PhysicalModel, Wanted};
use pseudopod::study::{
    PLAN_FILE, Plan, RUNS_FILE, Replaces, StudyDocument, charts, collect, look_over, points, sensitivities,
};

use crate::chance::Chance;
use crate::damage::{damaged, files, parts};

/// Longest time for a text: minutes would be a way to stop a server, and seconds are a user's patience. Programs without optimisation are
/// given more.
const LONGEST: Duration = Duration::from_secs(if cfg!(debug_assertions) { 60 } else { 10 });

/// What reads a kind of text.
type Reader = fn(&str, &Path) -> Result<(), Error>;

/// Damages texts of a kind so many times and reads them.
fn read_damaged(kind: &str, corpus: &[PathBuf], times: u32, reader: Reader) {
    let texts: Vec<String> = corpus
        .iter()
        .filter_map(|path| std::fs::read_to_string(path).ok())
        .filter(|text| text.len() < 60_000)
        .collect();
    assert!(!texts.is_empty(), "no {kind} to damage");
    let words: Vec<&str> = texts.iter().flat_map(|text| parts(text)).filter(|part| part.len() > 1).collect();
    for number in 0..times {
        let mut chance = Chance::new(number, 1);
        let which = chance.below(texts.len());
        let text = damaged(&texts[which], &words, &mut chance);
        let began = Instant::now();
        let outcome = std::panic::catch_unwind(|| {
            if let Err(error) = reader(&text, &corpus[which]) {
                assert!(!render(&error, Paint::Plain).is_empty());
            }
        });
        let told = format!("{kind} {number}, made from {}", corpus[which].display());
        assert!(outcome.is_ok(), "{told}: it panics\n{text}");
        assert!(began.elapsed() < LONGEST, "{told}: it takes {:?}", began.elapsed());
    }
}

fn read_experiment(text: &str, path: &Path) -> Result<(), Error> {
    Document::parse("damaged.toml", text, path.parent().unwrap(), &[]).map(|_| ())
}

/// Studies are read and their points worked out; what these mean to the experiment is tried with a few.
fn read_study(text: &str, path: &Path) -> Result<(), Error> {
    let study = StudyDocument::parse("damaged.toml", text, path.parent().unwrap())?;
    let points = points(&study)?;
    if points.rows.len() < 10 { look_over(&study, &points, Some(20_000_000)).map(|_| ()) } else { Ok(()) }
}

fn read_equations(text: &str, _: &Path) -> Result<(), Error> {
    equations::read(Arc::new(Source { name: "damaged".into(), text: text.to_owned() })).map(|_| ())
}

fn read_mesh(text: &str, path: &Path) -> Result<(), Error> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(path.file_name().unwrap());
    std::fs::write(&file, text).unwrap();
    read_surface(&file, 1.0).map(|_| ())
}

/// Physical models, loads and monitoring: what is still read is written and reads as the same.
fn read_physical_model(text: &str, path: &Path) -> Result<(), Error> {
    fn again<T: PartialEq>(
        text: &str,
        read: fn(&str, Vec<u8>) -> Result<Read<T>, Error>,
        write: fn(&T, &mut Vec<u8>) -> std::io::Result<()>,
    ) -> Result<T, Error> {
        let first = read("damaged", text.into())?.document;
        let mut written = Vec::new();
        write(&first, &mut written).unwrap();
        let second = read("written", written.clone()).unwrap_or_else(|error| panic!("{error} in {written:?}"));
        assert!(first == second.document, "{}", String::from_utf8_lossy(&written));
        Ok(first)
    }
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("pml") => {
            let model = again(text, PhysicalModel::read, |model, out| model.write(out))?;
            model.surface("damaged", Wanted::TheOnly).map(|_| ()).map_err(Error::input)
        }
        Some("lml") => again(text, Loads::read, |loads, out| loads.write(out)).map(|_| ()),
        _ => again(text, Monitoring::read, |monitoring, out| monitoring.write(out)).map(|_| ()),
    }
}

fn read_table(text: &str, _: &Path) -> Result<(), Error> {
    let as_tracks = tracks::parse("damaged.csv", text, &tracks::Options::default()).map(|_| ());
    let as_table = Table::parse("damaged.csv", text).map(|_| ());
    as_tracks.and(as_table)
}

fn read_claims(text: &str, _: &Path) -> Result<(), Error> {
    claims::parse("damaged.toml", text).map(|_| ())
}

/// The plan of a study in a folder of its own, without any run.
fn write_plan(folder: &Path) -> PathBuf {
    let study = StudyDocument::read(Path::new("tests/messages/sweeps/variance.toml")).unwrap();
    let points = points(&study).unwrap();
    let looked = look_over(&study, &points, None).unwrap();
    Plan::new(&study, points, &looked.some[0], &looked.files, folder).write(Replaces::Nothing).unwrap();
    folder.join(PLAN_FILE)
}

/// Plans are read and what there is of their runs is collected.
fn read_plan(text: &str, path: &Path) -> Result<(), Error> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(path.with_file_name(RUNS_FILE), folder.path().join(RUNS_FILE)).unwrap();
    std::fs::write(folder.path().join(PLAN_FILE), text).unwrap();
    let collected = collect(Plan::read(folder.path())?);
    let found = sensitivities(&collected);
    found.iter().for_each(|one| drop(one.notes(&collected)));
    charts::charts(&collected);
    Ok(())
}

const DESCRIPTION: &str = "dp.json";
/// Tracks in the layout of biotracks: the description of a package, and its tables.
const PACKAGE: [(&str, &str); 3] = [
    (
        DESCRIPTION,
        r#"{"name": "tracks", "cmso_space_unit": "micron", "cmso_time_unit": "second", "resources": [
            {"name": "cmso_objects_table", "path": "objects.csv"}, {"name": "cmso_links_table", "path": "links.csv"}]}"#,
    ),
    (
        "objects.csv",
        "cmso_object_id,cmso_frame_id,time,cmso_x_coord,cmso_y_coord\n1,0,0,1.5,2\n2,1,10,2,2.5\n3,0,0,5,5\n4,1,10,6,5\n",
    ),
    ("links.csv", "cmso_link_id,cmso_object_id\n1,1\n1,2\n2,3\n2,4\n"),
];

/// A package with one file damaged.
fn read_package(text: &str, path: &Path) -> Result<(), Error> {
    let folder = tempfile::tempdir().unwrap();
    for (name, whole) in PACKAGE {
        std::fs::write(folder.path().join(name), if path.ends_with(name) { text } else { whole }).unwrap();
    }
    package::read(&folder.path().join(DESCRIPTION), &tracks::Options::default()).map(|_| ())
}

/// All kinds, each so many times.
fn all(times: u32) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let experiments: Vec<PathBuf> = files(root, "toml", &["experiments", "tests/messages", "tests/documents"]);
    let (claimed, experiments): (Vec<PathBuf>, Vec<PathBuf>) =
        experiments.into_iter().partition(|path| path.ends_with("expected.toml"));
    read_damaged("claims", &claimed, times / 4, read_claims);
    read_damaged("experiment", &experiments, times, read_experiment);
    let studies: Vec<PathBuf> = files(root, "toml", &["tests/messages/studies", "tests/messages/sweeps"]);
    read_damaged("study", &studies, times / 4, read_study);
    read_damaged("EML", &files(root, "eml", &["eml", "experiments", "tests/messages"]), times, read_equations);
    read_damaged("SBML", &files(root, "xml", &["tests/messages"]), times, read_equations);
    for ending in ["obj", "ply", "stl"] {
        read_damaged(ending, &files(root, ending, &["tests/messages/meshes"]), times / 4, read_mesh);
    }
    let folder = tempfile::tempdir().unwrap();
    read_damaged("plan", &[write_plan(folder.path())], times / 4, read_plan);
    let parts = PACKAGE.map(|(name, text)| {
        std::fs::write(folder.path().join(name), text).unwrap();
        folder.path().join(name)
    });
    for (path, (_, text)) in parts.iter().zip(PACKAGE) {
        read_package(text, path).expect("a good package");
    }
    read_damaged("package", &parts, times / 4, read_package);
    read_damaged("table", &files(root, "csv", &["experiments", "tests"]), times / 2, read_table);
}

#[test]
fn damaged_physical_models_that_are_read_are_written_so_that_they_read_as_the_same() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for ending in ["pml", "lml", "mml"] {
        let models = files(root, ending, &["fuzz/corpus/models", "tests/messages/models"]);
        read_damaged("physical model", &models, 1000, read_physical_model);
    }
}

#[test]
fn readers_bear_damaged_texts() {
    all(400);
}

#[test]
#[ignore = "slow: reads 500 000 damaged texts (7 min)"]
fn readers_bear_many_damaged_texts() {
    all(100_000);
}
