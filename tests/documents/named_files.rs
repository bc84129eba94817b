//! Files that documents of equations name are inputs of the experiment: kept in its result, and nothing is written onto them.

use pseudopod::error::Error;
use pseudopod::experiment::Document;
use pseudopod::output::ResultFile;
use pseudopod::run::{Quiet, RunOptions, document_of, run};
use pseudopod::simulation::Simulation;
use std::path::{Path, PathBuf};

const EXPERIMENT: &str = "title = \"T\"\n[run]\nuntil = \"2 s\"\n[output]\nevery = \"1 s\"\n[chemistry.clock]\ndocument = \"eml/clock.eml\"\n";
const CLOCK: &str = r#"<eml name="clock" level="scene"><include document="../parts/rate.eml"/>
    <variable id="x" initial="1" rate="-k*f(time)*x"/></eml>"#;
const RATE: &str = r#"<eml name="rate"><parameter id="k" value="0.5"/><table id="f" file="f.csv"/></eml>"#;
const TABLE: &str = "t,v\n0,1\n2,3\n";

fn written(folder: &Path) -> PathBuf {
    for inner in ["eml", "parts"] {
        std::fs::create_dir(folder.join(inner)).unwrap();
    }
    let files = [("t.toml", EXPERIMENT), ("eml/clock.eml", CLOCK), ("parts/rate.eml", RATE), ("parts/f.csv", TABLE)];
    for (name, text) in files {
        std::fs::write(folder.join(name), text).unwrap();
    }
    folder.join("t.toml")
}

#[test]
fn results_keep_them_and_mean_the_same_without_them() {
    let folder = tempfile::tempdir().unwrap();
    let document = Document::read(&written(folder.path()), &[]).unwrap();
    let result = folder.path().join("r.vtkhdf");
    run(&document, &RunOptions::new(&result), &mut Quiet).unwrap();
    let header = ResultFile::open(&result).unwrap().header().clone();
    let kept: Vec<(&str, &str)> = header.equations.iter().map(|(path, text)| (path.as_str(), text.as_str())).collect();
    let named = [("eml/../parts/f.csv", TABLE), ("eml/../parts/rate.eml", RATE), ("eml/clock.eml", CLOCK)];
    assert_eq!(kept, named);
    // Other files in their places: the document of the result stands for what was there.
    let simulation = |document: &Document| Simulation::from_document(document).unwrap();
    let checkpoint = simulation(&document).checkpoint();
    let is_the_same = |document: &Document| simulation(document).restore(&checkpoint).is_ok();
    std::fs::write(folder.path().join("parts/rate.eml"), RATE.replace("0.5", "0.7")).unwrap();
    std::fs::remove_file(folder.path().join("parts/f.csv")).unwrap();
    assert!(is_the_same(&document_of(&header, &result).unwrap()));
    std::fs::write(folder.path().join("parts/f.csv"), TABLE).unwrap();
    assert!(!is_the_same(&document), "without what is kept the files are read, and a checkpoint is of another model");
}

#[test]
fn nothing_is_written_onto_them() {
    let folder = tempfile::tempdir().unwrap();
    let document = Document::read(&written(folder.path()), &[]).unwrap();
    let files: Vec<PathBuf> = document.files().iter().map(|path| path.canonicalize().unwrap()).collect();
    for name in ["t.toml", "eml/clock.eml", "parts/rate.eml", "parts/f.csv"] {
        let path = folder.path().join(name);
        assert!(files.contains(&path.canonicalize().unwrap()), "{name} is an input");
        let before = std::fs::read(&path).unwrap();
        let options = RunOptions { overwrite: pseudopod::output::Overwrite::Replace, ..RunOptions::new(&path) };
        let Err(Error::Input(faults)) = run(&document, &options, &mut Quiet) else { panic!("{name} is written onto") };
        assert!(faults[0].message.contains("is what the run reads"), "{}", faults[0].message);
        assert_eq!(std::fs::read(&path).unwrap(), before);
    }
    assert_eq!(files.len(), 4);
}
