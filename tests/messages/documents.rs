//! Every message about bad input is kept beside the input that causes it.

use crate::turns::take_turn;
use pseudopod::error::{Error, Paint, render};
use pseudopod::experiment::Document;
use pseudopod::output::{
    Cell, CellRecord, CellType, FieldLayout, Frame, Header, Layout, Overwrite, ResultFile, ResultWriter, SystemLayout,
    SystemScope, Tractions,
};
use std::path::{Path, PathBuf};

/// Changes that a document asks for in lines `#! --set key=value`.
fn sets(text: &str) -> Vec<String> {
    text.lines().filter_map(|line| line.strip_prefix("#! --set ")).map(str::to_owned).collect()
}

/// Compares a message with the kept text, or keeps it.
fn compare(error: &Error, kept: &Path) -> Result<(), String> {
    compare_text(&render(error, Paint::Plain), kept)
}

fn compare_text(message: &str, kept: &Path) -> Result<(), String> {
    if std::env::var_os("PSEUDOPOD_BLESS").is_some() {
        return std::fs::write(kept, message).map_err(|error| format!("{}: {error}", kept.display()));
    }
    let expected = std::fs::read_to_string(kept).unwrap_or_default();
    if message == expected { Ok(()) } else { Err(format!("{}:\n{message}", kept.display())) }
}

fn documents() -> Vec<PathBuf> {
    let folder = std::fs::read_dir("tests/messages/documents").expect("the folder of bad documents");
    let paths = folder.map(|entry| entry.expect("an entry of the folder").path());
    let mut paths: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    paths.sort();
    paths
}

#[test]
fn every_bad_document_gets_the_message_beside_it() {
    let documents = documents();
    assert!(documents.len() >= 14, "bad documents are missing: {documents:?}");
    let mut differences = Vec::new();
    for path in documents {
        let text = std::fs::read_to_string(&path).expect("a text");
        match Document::read(&path, &sets(&text)) {
            Ok(_) => differences.push(format!("{} is taken for a good document", path.display())),
            Err(error) => {
                assert_eq!(error.exit_code(), 2, "bad input ends with 2");
                differences.extend(compare(&error, &path.with_extension("txt")).err());
            }
        }
    }
    assert!(differences.is_empty(), "messages that changed:\n\n{}", differences.join("\n\n"));
}

#[test]
fn a_document_that_is_not_there_is_looked_for_nearby() {
    let folder = Path::new("tests/messages/documents");
    let mut differences = Vec::new();
    for (missing, kept) in [
        (folder.join("empy.toml"), "missing_file.txt"),
        (folder.join("nowhere/experiment.toml"), "missing_folder.txt"),
        (folder.to_owned(), "folder.txt"),
    ] {
        let error = Document::read(&missing, &[]).expect_err("there is nothing to read");
        differences.extend(compare(&error, &folder.join(kept)).err());
    }
    assert!(differences.is_empty(), "messages that changed:\n\n{}", differences.join("\n\n"));
}

#[test]
fn every_fault_of_a_document_has_a_location() {
    for path in documents() {
        let text = std::fs::read_to_string(&path).expect("a text");
        if let Err(Error::Input(faults)) = Document::read(&path, &sets(&text)) {
            for fault in faults {
                let location = fault.location.unwrap_or_else(|| panic!("{}: {}", path.display(), fault.message));
                assert!(
                    location.source.text.get(location.start..location.start + location.length).is_some(),
                    "inside the text"
                );
                assert!(fault.help.is_some(), "{}: {} says what to do", path.display(), fault.message);
            }
        }
    }
}

/// Three frames of two amoebae, one of which moves, a rock, two systems and two fields that stay as they are, and, if they are wanted,
/// tractions of cells that do not pull.
fn recorded(path: &Path, tractions: bool) -> ResultFile {
    let cell = |number: u32| Cell { id: u64::from(number), kind: number / 2, parent: None };
    let kind = |name: &str| CellType { name: name.into(), atoms: 1, ..CellType::default() };
    let unit = |name: &str| vec![(name.to_owned(), "uM".to_owned())];
    let field = |name: &str, cells| FieldLayout {
        name: name.into(),
        species: unit("cAMP"),
        cells,
        spacing: [1.0; 3],
        origin: [0.0; 3],
    };
    let system = |name: &str, scope, quantity| SystemLayout { name: name.into(), scope, quantities: unit(quantity) };
    let layout = Layout {
        types: vec![kind("amoeba"), kind("rock")],
        fields: vec![field("attractant", [4, 3, 1]), field("medium", [2, 2, 2])],
        systems: vec![system("oscillator", SystemScope::Cells, "cAMP"), system("clock", SystemScope::Scene, "tick")],
        tractions,
        ..Layout::default()
    };
    let none = || vec![[0.0; 3]; if tractions { 3 } else { 0 }];
    let header = Header::now("chemistry.toml", "Made up", "", &[], 0);
    let mut writer = ResultWriter::create(path, &header, &layout, Overwrite::Refuse).expect("a new file");
    for step in 0..3_u32 {
        let time = f64::from(step);
        let frame = Frame {
            time,
            step: u64::from(step),
            positions: vec![[0.0; 3]; 3],
            cells: (0..3).map(cell).collect(),
            records: [time, 0.0, 0.0].map(|x| CellRecord { position: [x, 0.0, 0.0], ..CellRecord::default() }).to_vec(),
            fields: vec![vec![vec![3.0; 12]], vec![vec![3.0; 8]]],
            systems: vec![vec![vec![time, 2.0, f64::NAN]], vec![vec![time]]],
            tractions: Tractions {
                traction: none(),
                of_cells: none(),
                drag: none(),
                outer: none(),
                inertia: none(),
                held: none(),
            },
            ..Frame::default()
        };
        writer.append(&frame).expect("a frame");
    }
    writer.finish(1.0).expect("an end");
    ResultFile::open(path).expect("a result")
}

#[test]
fn every_measure_that_cannot_be_taken_says_why() {
    let _turn = take_turn();
    for (document, tractions, kept) in [
        ("chemistry.toml", false, "chemistry.txt"),
        ("traction.toml", false, "traction_not_recorded.txt"),
        ("traction.toml", true, "traction_of_nobody.txt"),
    ] {
        cannot_be_taken(document, tractions, kept);
    }
}

fn cannot_be_taken(document: &str, tractions: bool, kept: &str) {
    let folder = tempfile::tempdir().expect("a folder");
    let result = recorded(&folder.path().join("result.h5"), tractions);
    let path = &Path::new("tests/messages/measures").join(document);
    let document = Document::read(path, &[]).unwrap_or_else(|error| panic!("{}", render(&error, Paint::Plain)));
    let (measures, faults) = pseudopod::run::measure_result(&result, &document).expect("a whole file");
    let taken: Vec<&str> = measures.iter().map(|measure| measure.name.as_str()).collect();
    assert!(taken.is_empty(), "can be taken: {taken:?}");
    assert!(
        faults.iter().all(|fault| fault.help.is_some() && fault.location.is_some()),
        "each says what to do, and where"
    );
    let message = render(&Error::Input(faults), Paint::Plain).replace(&folder.path().display().to_string(), "FOLDER");
    compare_text(&message, &path.with_file_name(kept)).expect("the message that is kept");
}
