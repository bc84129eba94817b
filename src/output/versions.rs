//! Versions of a file, each made beside the one before and put in its place as a whole.
//!
//! HDF5 changes a file in many small writes, and a file of which a kill left only some can be beyond repair. So no file is
//! ever written to that others see: what is to be changed is changed in a copy. Others read the file at any moment, and keep
//! the version that they have opened.

use std::fs;
use std::io;
use std::path::Path;

use hdf5::File;

use super::container::{self, Access, failed, machine_error};
use super::replacement::Replacement;
use crate::error::{Error, Result};

/// Makes a new file with what `fill` writes into it; what was at the path is replaced.
///
/// # Errors
/// [`Error::Machine`] if the disk refuses; what was there then stays.
pub(super) fn make(path: &Path, fill: impl FnOnce(&File) -> hdf5::Result<()>) -> Result<()> {
    let new = prepare(path, fill)?;
    new.put().map_err(|error| refused(path, "could not be made", &error))
}

/// Makes a new file beside the path, to be put there.
///
/// # Errors
/// As [`make`].
pub(super) fn prepare(path: &Path, fill: impl FnOnce(&File) -> hdf5::Result<()>) -> Result<Replacement> {
    let new = Replacement::of(path).map_err(|error| refused(path, "could not be made", &error))?;
    let file = container::create(new.temporary())?;
    let made = fill(&file).and_then(|()| file.close());
    made.map_err(|error| failed(path, "could not be made", &error))?;
    Ok(new)
}

/// Changes a file: `change` is done to a copy, which then takes its place.
///
/// # Errors
/// [`Error::Machine`] if the file has gone or the disk refuses, and what `change` returns; nothing is changed then.
pub(super) fn renew<T>(path: &Path, change: impl FnOnce(&File) -> Result<T>) -> Result<T> {
    let new = Replacement::of(path).map_err(|error| refused(path, "could not be written", &error))?;
    copy(path, &new)?;
    let file = container::open(new.temporary(), Access::Append)?;
    let changed = change(&file)?;
    file.close().map_err(|error| failed(path, "could not be written", &error))?;
    new.put().map_err(|error| refused(path, "could not be written", &error))?;
    Ok(changed)
}

fn copy(path: &Path, new: &Replacement) -> Result<()> {
    let mut old = fs::File::open(path).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => Error::Machine {
            message: format!("{} is gone: it was removed or moved while it was being written", path.display()),
            help: "put it back; frames that it does not hold are in the file beside it that ends in .frames".into(),
        },
        _ => refused(path, "could not be read", &error),
    })?;
    let copied = new.create().and_then(|mut file| io::copy(&mut old, &mut file));
    copied.map(|_| ()).map_err(|error| refused(path, "could not be written", &error))
}

fn refused(path: &Path, what: &str, error: &io::Error) -> Error {
    machine_error(path, what, &error.to_string())
}
