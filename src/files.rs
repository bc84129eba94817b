//! Files that are read: plain ones only, and whether two paths lead to the same.

use std::io;
use std::path::{Component, Path, PathBuf};

/// The bytes of a plain file. Pipes and devices are not read: they may have no end, or never begin.
///
/// # Errors
/// As [`std::fs::read`], and [`io::ErrorKind::InvalidInput`] for what is no plain file.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    check_plain(path)?;
    std::fs::read(path)
}

/// As [`read`], as text.
///
/// # Errors
/// As [`read`], and [`io::ErrorKind::InvalidData`] for bytes that are not UTF-8.
pub fn read_text(path: &Path) -> io::Result<String> {
    check_plain(path)?;
    std::fs::read_to_string(path)
}

/// Makes sure that a path leads to a plain file, or a folder, whose reading fails by itself.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] for pipes, sockets and devices; those of the system if nothing is there.
pub fn check_plain(path: &Path) -> io::Result<()> {
    let kind = std::fs::metadata(path)?.file_type();
    match kind.is_file() || kind.is_dir() {
        true => Ok(()),
        false => Err(io::Error::new(io::ErrorKind::InvalidInput, "it is a pipe or a device, and a file was expected")),
    }
}

/// Whether two paths lead to the same file, whether it is there or not.
pub fn are_same(one: &Path, other: &Path) -> bool {
    #[cfg(unix)]
    if let (Ok(one), Ok(other)) = (std::fs::metadata(one), std::fs::metadata(other)) {
        use std::os::unix::fs::MetadataExt as _;
        // By what they are, since a file can have several names.
        return (one.dev(), one.ino()) == (other.dev(), other.ino());
    }
    resolved(one) == resolved(other)
}

fn resolved(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let whole = std::fs::canonicalize(path);
    whole.unwrap_or_else(|_| {
        std::fs::canonicalize(folder).unwrap_or_default().join(path.file_name().unwrap_or_default())
    })
}

/// A path without steps into folders that it leaves again.
pub fn tidy(path: &Path) -> PathBuf {
    let mut short = PathBuf::new();
    for part in path.components() {
        let leaves =
            part == Component::ParentDir && matches!(short.components().next_back(), Some(Component::Normal(_)));
        if leaves {
            short.pop();
        } else {
            short.push(part);
        }
    }
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn devices_are_not_read_and_names_of_one_file_are_known() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::write(path("a"), "text").unwrap();
        std::fs::hard_link(path("a"), path("b")).unwrap();
        std::os::unix::fs::symlink(path("a"), path("c")).unwrap();
        assert_eq!(read(&path("c")).unwrap(), b"text");
        assert_eq!(read(Path::new("/dev/null")).unwrap_err().kind(), io::ErrorKind::InvalidInput);
        assert!(are_same(&path("a"), &path("b")) && are_same(&path("b"), &path("c")));
        assert!(are_same(&path("new"), &folder.path().join("./new")));
        assert!(!are_same(&path("a"), &path("new")));
    }

    #[test]
    fn steps_into_a_folder_and_out_again_are_left_out() {
        let short = |path: &str| tidy(Path::new(path)).display().to_string();
        assert_eq!(short("out/../cells.toml"), "cells.toml");
        assert_eq!(short("a/b/../../../cells.toml"), "../cells.toml");
        assert_eq!(short("../out/./cells.toml"), "../out/cells.toml");
    }
}
