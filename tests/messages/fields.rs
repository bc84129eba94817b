//! Every message about fields that cannot be placed, started or moved is kept beside its document.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use pseudopod::equations::eml;
use pseudopod::error::{Error, Paint, Result, Source, render};
use pseudopod::field::{FieldSystem, Grid, Stepping};

fn documents() -> Vec<(PathBuf, eml::Document)> {
    let folder = std::fs::read_dir("tests/messages/fields").expect("the folder of bad documents");
    let paths = folder.map(|entry| entry.expect("an entry of the folder").path());
    let mut paths: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|end| end == "eml")).collect();
    paths.sort();
    let read = |path: &Path| {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        let text = std::fs::read_to_string(path).expect("a text");
        eml::read(Arc::new(Source { name, text })).expect("no fault that the reader knows")
    };
    paths.into_iter().map(|path| (path.clone(), read(&path))).collect()
}

/// Whatever goes wrong on the way to t = 20 s.
fn run(document: &eml::Document, stepping: Stepping) -> Result<()> {
    let too_few = |_: &eml::Profile, grid: &Grid| Ok(vec![0.5; grid.len() - 1]);
    let system = FieldSystem::new(document, None)?;
    let mut fields = system.start(&too_few)?;
    for window in 0..20 {
        let before = fields.clone();
        if let Err(error) = system.advance(&mut fields, 1.0, &[], stepping) {
            assert_eq!(fields.time(), f64::from(window), "the last good state is kept");
            assert!((0..system.species().len()).all(|s| fields.values(s) == before.values(s)), "and its values");
            return Err(error);
        }
    }
    Ok(())
}

#[test]
fn every_bad_document_gets_the_message_beside_it() {
    let documents = documents();
    assert!(documents.len() >= 10, "bad documents are missing: {}", documents.len());
    let mut differences = Vec::new();
    for (path, document) in documents {
        let mut message = String::new();
        for stepping in [Stepping::Fixed(10), Stepping::Adaptive { relative: 1e-3, absolute: 1e-6 }] {
            let Err(error) = run(&document, stepping) else {
                differences.push(format!("{} is taken for a good document", path.display()));
                continue;
            };
            let code = if matches!(error, Error::Numbers { .. }) { 3 } else { 2 };
            assert_eq!(error.exit_code(), code, "bad input ends with 2, numbers that fail with 3");
            let text = render(&error, Paint::Plain);
            if !message.contains(&text) {
                message.push_str(&text);
            }
        }
        let kept = path.with_extension("txt");
        if std::env::var_os("PSEUDOPOD_BLESS").is_some() {
            std::fs::write(&kept, message).expect("the text is kept");
        } else if std::fs::read_to_string(&kept).unwrap_or_default() != message {
            differences.push(format!("{}:\n{message}", kept.display()));
        }
    }
    assert!(differences.is_empty(), "messages that changed:\n\n{}", differences.join("\n\n"));
}
