//! Paths and fingerprints of the files that a study reads.

use crate::elementary::{FNV_START, fnv1a};
use crate::error::{Error, Result};
use std::path::{Component, Path, PathBuf};

pub use crate::files::tidy;

/// A number by which contents are told apart: FNV-1a in 64 bits, in hexadecimal.
pub fn fingerprint(bytes: &[u8]) -> String {
    format!("{:016x}", fnv1a(FNV_START, bytes.iter().copied()))
}

/// That the machine refuses to write a file or a folder of a study.
pub fn refused(path: &Path, error: &std::io::Error) -> Error {
    Error::Machine {
        message: format!("{} could not be written: {error}", path.display()),
        help: "make the folder of the study writable, or free some space".into(),
    }
}

/// Writes files with these names into a folder; their paths.
///
/// # Errors
/// As [`refused`].
pub fn write_all<N: AsRef<Path>, B: AsRef<[u8]>>(
    files: impl IntoIterator<Item = (N, B)>,
    folder: &Path,
) -> Result<Vec<PathBuf>> {
    let write = |(name, bytes): (N, B)| {
        let path = folder.join(name);
        std::fs::write(&path, bytes).map_err(|error| refused(&path, &error))?;
        Ok(path)
    };
    files.into_iter().map(write).collect()
}

/// A path from the root, without links where it leads somewhere.
pub fn absolute(path: &Path) -> PathBuf {
    if let Ok(whole) = path.canonicalize() {
        return whole;
    }
    // A folder that is still to be made lies in one that is there, or in one to be made, too.
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    match (path.parent(), path.file_name()) {
        (Some(parent), Some(name)) => absolute(parent).join(name),
        _ => path,
    }
}

/// A path from a folder, both from the root. Where the two have no folder in common it stays as it is.
pub fn relative(path: &Path, folder: &Path) -> PathBuf {
    let (path_parts, folder_parts): (Vec<_>, Vec<_>) = (path.components().collect(), folder.components().collect());
    let shared = path_parts.iter().zip(&folder_parts).take_while(|(one, other)| one == other).count();
    if shared <= 1 {
        return path.to_path_buf();
    }
    let up = (shared..folder_parts.len()).map(|_| Component::ParentDir);
    up.chain(path_parts[shared..].iter().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_lead_from_one_folder_to_another() {
        let from = |path: &str, folder: &str| relative(Path::new(path), Path::new(folder)).display().to_string();
        assert_eq!(from("/a/b/c.toml", "/a/b"), "c.toml");
        assert_eq!(from("/a/b/c.toml", "/a/b/study/one"), "../../c.toml");
        assert_eq!(from("/a/x/c.toml", "/a/b"), "../x/c.toml");
        assert_eq!(from("/x/c.toml", "/a/b"), "/x/c.toml");
    }
}
