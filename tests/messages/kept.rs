//! Messages that are kept beside the bad input that causes them.

use pseudopod::error::{Error, Paint, render};
use std::path::{Path, PathBuf};

/// The TOML documents of a folder of `tests/messages` that `are_bad`, in order.
pub fn documents(folder: &str, are_bad: impl Fn(&Path) -> bool) -> Vec<PathBuf> {
    let folder = std::fs::read_dir(Path::new("tests/messages").join(folder)).expect("a folder of bad documents");
    let paths = folder.map(|entry| entry.expect("an entry of the folder").path());
    let is_document = |path: &PathBuf| path.extension().is_some_and(|end| end == "toml") && are_bad(path);
    let mut paths: Vec<PathBuf> = paths.filter(is_document).collect();
    paths.sort();
    paths
}

/// Holds what is said about documents, of which there are so many at least, against the texts beside them, or writes these anew.
pub fn every_message_is_that_beside(paths: &[PathBuf], least: usize, read: impl Fn(&Path) -> Result<(), Error>) {
    let mut differences = Vec::new();
    assert!(paths.len() >= least, "bad documents are missing: {paths:?}");
    for path in paths {
        let Err(error) = read(path) else {
            differences.push(format!("{} is taken for a good document", path.display()));
            continue;
        };
        assert_eq!(error.exit_code(), 2, "bad input ends with 2");
        if let Error::Input(faults) = &error {
            assert!(faults.iter().all(|fault| fault.help.is_some()), "{}: a fault without help", path.display());
        }
        let (message, kept) = (render(&error, Paint::Plain), path.with_extension("txt"));
        if std::env::var_os("PSEUDOPOD_BLESS").is_some() {
            std::fs::write(&kept, message).expect("the text can be kept");
        } else if message != std::fs::read_to_string(&kept).unwrap_or_default() {
            differences.push(format!("{}:\n{message}", kept.display()));
        }
    }
    assert!(differences.is_empty(), "messages that changed:\n\n{}", differences.join("\n\n"));
}
