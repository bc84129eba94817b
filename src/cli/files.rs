//! Files that commands are about to write.

use crate::error::{Error, Fault, Result};
use crate::files::are_same;
use std::path::{Path, PathBuf};

/// Refuses files that a command would read and write, or write twice.
///
/// # Errors
/// Two paths that lead to the same file, whether it is there or not.
pub fn refuse_same(files: &[&Path]) -> Result<()> {
    for (number, path) in files.iter().enumerate() {
        if files[..number].iter().any(|other| are_same(other, path)) {
            let fault = Fault::new(format!("{} is named twice", path.display()));
            return Err(Error::input(fault.help("give each file that is read or written a name of its own")));
        }
    }
    Ok(())
}

/// Refuses to write over files that are read.
///
/// # Errors
/// A file to be written that is one of those that are read.
pub fn refuse_read<'a>(read: &[PathBuf], written: impl Iterator<Item = &'a Path>) -> Result<()> {
    for path in written {
        if read.iter().any(|other| are_same(other, path)) {
            let fault = Fault::new(format!("{} is what the document names and reads", path.display()));
            return Err(Error::input(fault.help("name another file to be written")));
        }
    }
    Ok(())
}

/// Who named a file that is about to be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Named {
    /// The user, with -o.
    ByUser,
    /// The program, after the result.
    ByItself,
}

/// Nothing is overwritten unless asked for, and nothing is computed for a folder that is not there.
///
/// # Errors
/// [`Error::Input`] if the file exists and `force` is not set, or if its folder does not exist.
pub fn refuse_existing(path: &Path, force: bool, named: Named) -> Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
        let fault =
            Fault::new(format!("{} cannot be written: there is no folder {}", path.display(), folder.display()))
                .help("make the folder first, or name another file with -o");
        return Err(Error::input(fault));
    }
    if path.is_dir() && path.extension().is_some() {
        let fault = Fault::new(format!("{} is a folder", path.display())).help("name a file in it with -o");
        return Err(Error::input(fault));
    }
    if force || !path.exists() {
        return Ok(());
    }
    let help = match named {
        Named::ByUser => "name another file with -o, or use --force to replace it",
        Named::ByItself => "use --force to replace it, or move it away",
    };
    Err(Error::input(Fault::new(format!("{} exists", path.display())).help(help)))
}

/// The same for a folder that the program names after a file, and fills.
///
/// # Errors
/// [`Error::Input`] if it exists and `force` is not set, or if it is no folder.
pub fn refuse_existing_folder(path: &Path, force: bool) -> Result<()> {
    let (message, help) = match () {
        () if path.exists() && !path.is_dir() => {
            ("is a file", "the frames go into a folder of that name: name another file with -o")
        }
        () if path.exists() && !force => {
            ("exists", "name another file with -o, or use --force to replace what it holds of this kind")
        }
        () => return Ok(()),
    };
    Err(Error::input(Fault::new(format!("{} {message}", path.display())).help(help)))
}
