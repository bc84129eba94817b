//! A document: its text, what it says, and where in the text it says so.

use super::tree::Node;
use super::{Experiment, check};
use crate::equations::{self, Files, NamedFile};
use crate::error::{Location, Source};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A checked experiment with the text that it came from.
#[derive(Debug, Clone)]
pub struct Document {
    /// The text as the user wrote it, without `--set`.
    pub source: Arc<Source>,
    /// The changes that `--set` made, in order.
    pub sets: Vec<String>,
    /// The folder that paths in the document start from.
    pub base_dir: PathBuf,
    /// What the text says, changes included.
    pub experiment: Experiment,
    /// Texts of documents of equations and of what they name, by paths as the experiment writes them; they stand in place of the files.
    pub equations: BTreeMap<String, String>,
    /// Bytes of memory that the experiment may take, by an estimate; [`compile`](super::compile()) refuses more. Any number when absent.
    pub memory: Option<u64>,
    /// Whether `--until` or `--set` makes the run end before the end in the text. What lies beyond is left out then, and not a fault.
    pub(crate) is_cut_short: bool,
    /// What was left out because the run is cut short, in words.
    pub(super) left_out: Vec<String>,
    /// The texts in it that mean something elsewhere.
    pub(super) references: Vec<check::Reference>,
    pub(super) tree: Node,
}

impl Document {
    /// The document with the texts of all documents of equations that can be read now, and of those and the tables that they
    /// name, so that it means the same whatever becomes of the files. Those that cannot are left for [`compile`](super::compile) to tell of.
    pub fn with_equations(&self) -> Self {
        let mut document = self.clone();
        for entry in self.experiment.chemistry.values() {
            let Ok(Ok(text)) = self.equations_at(&entry.document).map(String::from_utf8) else { continue };
            for NamedFile { path, text } in self.named_by(&entry.document, text.clone()) {
                let path = path.strip_prefix(&self.base_dir).unwrap_or(&path);
                if let Some(text) = text {
                    document.equations.entry(written(path)).or_insert(text);
                }
            }
            document.equations.entry(written(&entry.document)).or_insert(text);
        }
        document
    }

    /// The bytes of a document of equations: those kept, or those of the file.
    ///
    /// # Errors
    /// As [`std::fs::read`], and [`std::io::ErrorKind::FileTooLarge`] for more than
    /// [`LARGEST_DOCUMENT`](crate::equations::eml::LARGEST_DOCUMENT) bytes.
    pub fn equations_at(&self, path: &Path) -> std::io::Result<Vec<u8>> {
        if let Some(text) = self.equations.get(&written(path)) {
            return Ok(text.clone().into_bytes());
        }
        let (file, largest) = (self.resolve(path), crate::equations::eml::LARGEST_DOCUMENT);
        let size = std::fs::metadata(&file)?.len();
        if size > largest as u64 {
            let words = format!("it has {size} bytes, and at most {largest} are read");
            return Err(std::io::Error::new(std::io::ErrorKind::FileTooLarge, words));
        }
        crate::files::read(&file)
    }

    /// Where the files are that one of its documents of equations names.
    pub fn files_beside(&self, document: &Path) -> Files {
        let folder = self.resolve(document).parent().map(Path::to_path_buf);
        let kept = self.equations.iter().map(|(path, text)| (self.resolve(Path::new(path)), text.clone()));
        Files { folder, kept: kept.collect() }
    }

    /// The files that one of its documents of equations names.
    fn named_by(&self, document: &Path, text: String) -> Vec<NamedFile> {
        let name = self.resolve(document).display().to_string();
        equations::named_files(Arc::new(Source { name, text }), self.files_beside(document))
    }

    /// The files that the document reads and those that its documents of equations name, itself included where it came from
    /// one, as the system can open them.
    pub fn files(&self) -> Vec<PathBuf> {
        let named = self.references.iter().filter(|reference| reference.kind == "file");
        let named = named.map(|reference| self.resolve(Path::new(&reference.text)));
        let mut files: Vec<PathBuf> = std::iter::once(PathBuf::from(&self.source.name)).chain(named).collect();
        for entry in self.experiment.chemistry.values() {
            if let Ok(Ok(text)) = self.equations_at(&entry.document).map(String::from_utf8) {
                files.extend(self.named_by(&entry.document, text).into_iter().map(|file| file.path));
            }
        }
        files
    }

    /// A path of the document as the system can open it.
    pub fn resolve(&self, path: &Path) -> PathBuf {
        self.base_dir.join(path)
    }

    /// Where the value of a key stands, for a fault: `document.location("cells.red.fixed[0].atoms", "label")`. A key that
    /// is not written (its default holds) is placed at the nearest table around it; `None` only if that is the document.
    pub fn location(&self, path: &str, label: impl Into<String>) -> Option<Location> {
        let (node, _) = self.tree.follow(path);
        node.key.as_ref().or((!node.span.is_empty()).then_some(&node.span))?;
        Some(node.location(label))
    }

    /// Where a key itself stands, with the same rules as [`Document::location`].
    pub fn key_location(&self, path: &str, label: impl Into<String>) -> Option<Location> {
        let (node, _) = self.tree.follow(path);
        node.key.as_ref().or((!node.span.is_empty()).then_some(&node.span))?;
        Some(node.key_location(label))
    }

    /// The unit in which the document says when its run ends: `min` of `until = "8 min"`; none where it is not a number and a unit.
    pub fn clock_unit(&self) -> Option<&str> {
        let (node, is_written) = self.tree.follow("run.until");
        let text = node.written().trim_matches(['"', '\'', ' ']);
        let unit = text.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.eE ".contains(c));
        (is_written && !unit.is_empty()).then_some(unit)
    }

    /// Whether a key is written in the document or set, rather than left at its default.
    pub fn says(&self, path: &str) -> bool {
        self.tree.follow(path).1
    }
}

/// A path as the experiment writes it.
fn written(path: &Path) -> String {
    path.display().to_string()
}

/// A file beside a missing one whose name is like it.
pub(crate) fn near_file(path: &Path) -> Option<PathBuf> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let wanted = path.file_name()?.to_str()?;
    let entries = std::fs::read_dir(folder).ok()?.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let mut names: Vec<String> = entries.collect();
    names.sort();
    let near = crate::error::words::meant(wanted, names.iter().map(String::as_str))?;
    Some(path.with_file_name(near))
}
