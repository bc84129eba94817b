//! Bad mesh files and what is said about them: each file of `tests/messages/meshes` stands beside the expected text.

use pseudopod::error::{Error, Fault};
use pseudopod::geometry::{SurfaceRules, read_checked_surface};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

const FOLDER: &str = "tests/messages/meshes";

/// What is said about a mesh file that must be refused: message, line and column, help.
fn refusal(path: &Path) -> String {
    let Err(Error::Input(faults)) = read_checked_surface(path, 1.0, &SurfaceRules::CELL) else {
        panic!("{} is not refused as bad input", path.display())
    };
    faults.iter().map(describe).collect()
}

fn describe(fault: &Fault) -> String {
    let mut text = format!("{}\n", fault.message);
    if let Some(location) = &fault.location {
        let before = &location.source.text[..location.start];
        let line = before.matches('\n').count() + 1;
        let column = before.len() - before.rfind('\n').map_or(0, |end| end + 1) + 1;
        let marked = &location.source.text[location.start..location.start + location.length];
        writeln!(text, "  at {}:{line}:{column} `{marked}`: {}", location.source.name, location.label).unwrap();
    }
    if let Some(help) = &fault.help {
        writeln!(text, "  help: {help}").unwrap();
    }
    text
}

#[test]
fn every_bad_mesh_is_refused_in_the_expected_words() {
    let mut meshes: Vec<PathBuf> = std::fs::read_dir(FOLDER)
        .unwrap()
        .map(|entry| Path::new(FOLDER).join(entry.unwrap().file_name()))
        .filter(|path| path.extension().is_some_and(|extension| extension != "txt"))
        .collect();
    meshes.sort();
    assert!(meshes.len() >= 15, "the bad meshes are missing");
    let mut differences = String::new();
    for mesh in meshes {
        let said = refusal(&mesh);
        let mut expected_at = mesh.clone().into_os_string();
        expected_at.push(".txt");
        if std::env::var_os("PSEUDOPOD_BLESS").is_some() {
            std::fs::write(&expected_at, &said).unwrap();
        }
        let expected = std::fs::read_to_string(&expected_at).unwrap_or_default();
        if said != expected {
            writeln!(differences, "{}:\nexpected:\n{expected}\nsaid:\n{said}", mesh.display()).unwrap();
        }
    }
    assert!(differences.is_empty(), "{differences}");
}

#[test]
fn a_missing_file_is_refused_with_the_folder_and_what_it_holds() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("red_cell.obj"), "").unwrap();
    std::fs::write(folder.path().join("notes.txt"), "").unwrap();
    let at = folder.path().display().to_string();
    let said = refusal(&folder.path().join("redcell.obj")).replace(&at, "FOLDER");
    assert_eq!(
        said,
        "mesh file `FOLDER/redcell.obj` does not exist\n  help: looked in folder `FOLDER`, which holds `red_cell.obj`\n"
    );
    let said = refusal(&folder.path().join("nowhere/cell.obj")).replace(&at, "FOLDER");
    assert_eq!(
        said,
        "mesh file `FOLDER/nowhere/cell.obj` does not exist\n  \
         help: looked in folder `FOLDER/nowhere`, which does not exist either\n"
    );
}
