//! Every message about bad PML, LML and MML, and every warning, is kept beside the text that causes it.

use pseudopod::error::{Error, Paint, Result, render};
use pseudopod::physical_model::lml::Loads;
use pseudopod::physical_model::mml::Monitoring;
use pseudopod::physical_model::pml::{PhysicalModel, Wanted};
use pseudopod::physical_model::{Read, Warnings};
use std::path::{Path, PathBuf};

fn texts() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/messages/models");
    let paths = std::fs::read_dir(folder).expect("the folder of bad models").map(|entry| entry.expect("a file").path());
    let mut paths: Vec<PathBuf> = paths.filter(|path| path.extension().is_none_or(|end| end != "txt")).collect();
    paths.sort();
    assert!(paths.len() >= 30, "bad models are missing: {paths:?}");
    paths
}

fn read<T>(read: Result<Read<T>>, told: &mut String) -> Result<T> {
    let Read { document, warnings: Warnings { list, left_out } } = read?;
    list.iter().for_each(|warning| *told += &format!("warning: {warning}\n"));
    assert_eq!(left_out, 0);
    Ok(document)
}

/// All that is said about a file: warnings, and why it cannot be read or no surface be made of it.
fn said(path: &Path) -> String {
    let name = path.file_name().expect("a name").to_string_lossy().into_owned();
    let bytes = std::fs::read(path).expect("a file");
    let mut told = String::new();
    let outcome = match path.extension().and_then(|end| end.to_str()) {
        Some("pml") => read(PhysicalModel::read(&name, bytes), &mut told).and_then(|model| {
            let surface = model.surface(&name, Wanted::TheOnly).map_err(Error::input)?.surface;
            told += &format!("a surface of {} facets\n", surface.facets.len());
            Ok(())
        }),
        Some("lml") => read(Loads::read(&name, bytes), &mut told).map(|_| ()),
        _ => read(Monitoring::read(&name, bytes), &mut told).map(|_| ()),
    };
    if let Err(error) = outcome {
        assert_eq!(error.exit_code(), 2, "bad input ends with 2");
        told += &render(&error, Paint::Plain);
    }
    assert!(!told.is_empty(), "{name} is good");
    told
}

#[test]
fn every_bad_physical_model_gets_the_message_beside_it() {
    let mut differences = Vec::new();
    for path in texts() {
        let (said, mut kept) = (said(&path), path.clone().into_os_string());
        kept.push(".txt");
        if std::env::var_os("PSEUDOPOD_BLESS").is_some() {
            std::fs::write(&kept, said).expect("a text is written");
        } else if said != std::fs::read_to_string(&kept).unwrap_or_default() {
            differences.push(format!("{}:\n{said}", path.display()));
        }
    }
    assert!(differences.is_empty(), "messages that changed:\n\n{}", differences.join("\n\n"));
}
