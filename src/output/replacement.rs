//! Files that take the place of others as a whole.

use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

/// The path of a file beside another: its name with something behind it.
pub(super) fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(ending);
    name.into()
}

/// A file that is made beside another and takes its place once it is whole and on the disk: at every moment there is the
/// old one or the new one. Dropped before that, it leaves the old one as it was.
///
/// What stands at the path itself is replaced, not written to: a link goes, what it leads to stays.
pub(super) struct Replacement {
    path: PathBuf,
    temporary: PathBuf,
    is_put: bool,
}

impl Replacement {
    /// One for this path. What an earlier one left that never came to its end is removed.
    ///
    /// # Errors
    /// If the disk refuses.
    pub fn of(path: &Path) -> io::Result<Self> {
        let temporary = beside(path, ".new");
        match fs::remove_file(&temporary) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => Ok(Self { path: path.to_path_buf(), temporary, is_put: false }),
        }
    }

    /// Where the new file is made.
    pub fn temporary(&self) -> &Path {
        &self.temporary
    }

    /// Makes the new file, empty.
    ///
    /// # Errors
    /// If something has come to be there meanwhile, a link say, or the disk refuses.
    pub fn create(&self) -> io::Result<File> {
        OpenOptions::new().write(true).create_new(true).open(&self.temporary)
    }

    /// Puts the new file in the place of the old one, once the disk itself has it.
    ///
    /// # Errors
    /// If the disk refuses; the old file is then still there.
    pub fn put(mut self) -> io::Result<()> {
        File::open(&self.temporary)?.sync_all()?;
        fs::rename(&self.temporary, &self.path)?;
        self.is_put = true;
        sync_folder(&self.path)
    }
}

impl Drop for Replacement {
    fn drop(&mut self) {
        if !self.is_put {
            // What cannot be removed is removed by the next one.
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

/// Waits until the disk has the names of the files in the folder of a path.
pub(super) fn sync_folder(path: &Path) -> io::Result<()> {
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        // Some systems open no folders, and some file systems (of networks) do not wait for them.
        Err(error) if matches!(error.kind(), io::ErrorKind::PermissionDenied | io::ErrorKind::InvalidInput) => Ok(()),
        Err(error) if error.kind() == io::ErrorKind::Unsupported => Ok(()),
        outcome => outcome,
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    #[test]
    fn until_it_is_put_the_old_file_stays() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        fs::write(&path, "old").unwrap();
        let new = Replacement::of(&path).unwrap();
        new.create().unwrap().write_all(b"half").unwrap();
        drop(new);
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "what was not put leaves nothing");
        let new = Replacement::of(&path).unwrap();
        new.create().unwrap().write_all(b"new").unwrap();
        new.put().unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
    }

    #[cfg(unix)]
    #[test]
    fn links_are_replaced_and_never_written_through() {
        let folder = tempfile::tempdir().unwrap();
        let (path, other) = (folder.path().join("a.txt"), folder.path().join("other.txt"));
        fs::write(&other, "somebody's").unwrap();
        for planted in [path.clone(), beside(&path, ".new")] {
            std::os::unix::fs::symlink(&other, planted).unwrap();
        }
        let new = Replacement::of(&path).unwrap();
        new.create().unwrap().write_all(b"new").unwrap();
        new.put().unwrap();
        assert_eq!(fs::read_to_string(&other).unwrap(), "somebody's");
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        assert!(!fs::symlink_metadata(&path).unwrap().is_symlink());
    }
}
