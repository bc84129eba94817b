//! The files that a document of equations names: documents that it includes, tables, images and datasets.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

/// Where the files are that a document names.
#[derive(Debug, Clone, Default)]
pub struct Files {
    /// The folder that the paths of the document start from; none: it stands in no folder and can name no file.
    pub folder: Option<PathBuf>,
    /// Texts that stand in place of files, by the paths at which the system would find these.
    pub kept: BTreeMap<PathBuf, String>,
}

impl Files {
    /// Those of a document in a folder.
    pub fn of_folder(folder: Option<&Path>) -> Self {
        Self { folder: folder.map(Path::to_owned), ..Self::default() }
    }

    /// A text of at most so many bytes.
    ///
    /// # Errors
    /// As [`crate::files::read_text`], and [`io::ErrorKind::FileTooLarge`].
    pub fn text(&self, path: &Path, largest: u64) -> io::Result<String> {
        if let Some(text) = self.kept.get(path) {
            return Ok(text.clone());
        }
        let length = std::fs::metadata(path)?.len();
        if length > largest {
            let words = format!("it has {length} bytes, and at most {largest} are read");
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, words));
        }
        crate::files::read_text(path)
    }
}

/// A file that a document names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedFile {
    /// Where the system finds it.
    pub path: PathBuf,
    /// What it says, of documents and tables that can be read.
    pub text: Option<String>,
}
