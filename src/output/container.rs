//! The few things that the result file needs of HDF5: how files are opened, and errors people understand.

use std::path::Path;

use hdf5::file::FileBuilder;
use hdf5::{File, H5Type, Location};
#[cfg(unix)]
use hdf5_sys::{h5f::H5Fget_vfd_handle, h5p::H5P_DEFAULT};

use super::vetting::vet;
use crate::error::{Error, Fault, Result};

/// The first bytes of every HDF5 file.
const SIGNATURE: &[u8; 8] = b"\x89HDF\r\n\x1a\n";

/// Version of the arrangement of the file; grows when an old reader would misunderstand a new file.
pub(super) const FORMAT: i64 = 2;

/// Attribute of the root that says whose file it is.
pub(super) const FORMAT_ATTRIBUTE: &str = "pseudopod_format";

/// How a file is opened for writing. Nobody else sees it before it is whole, so that HDF5 may keep and write what it likes.
/// Space is taken as it is needed: blocks ahead would be lost each time the file is closed.
fn for_writing() -> FileBuilder {
    let mut builder = FileBuilder::new();
    builder.with_fapl(|access| access.libver_earliest().meta_block_size(0).small_data_block_size(0));
    builder
}

/// Makes a file where there is none.
pub(super) fn create(path: &Path) -> Result<File> {
    let file = for_writing().create_excl(path).map_err(|error| failed(path, "could not be made", &error))?;
    let_go_of_the_lock(&file);
    Ok(file)
}

/// Lets go of the lock that HDF5 takes on a file that is opened for writing. What is written here is nobody else's until it is whole and has
/// its name. Programs that this process starts meanwhile inherit the open file, as HDF5 does not close it to them, and with it the lock: they would
/// keep the result from being read until they end.
fn let_go_of_the_lock(file: &File) {
    #[cfg(unix)]
    {
        use std::os::fd::FromRawFd as _;
        let mut handle = std::ptr::null_mut();
        // SAFETY: the file is open, `handle` is valid for writing, and the call holds the lock of the library.
        let found = hdf5::sync::sync(|| unsafe { H5Fget_vfd_handle(file.id(), H5P_DEFAULT, &raw mut handle) });
        if found < 0 || handle.is_null() {
            return;
        }
        // SAFETY: the driver by which files are opened here keeps a file descriptor, which stays open as long as `file`; it is not closed here.
        let descriptor = std::mem::ManuallyDrop::new(unsafe { std::fs::File::from_raw_fd(*handle.cast()) });
        // Where locks are unknown there was none.
        let _ = descriptor.unlock();
    }
    #[cfg(not(unix))]
    let _ = file;
}

/// What an open file is wanted for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Access {
    Read,
    Append,
}

/// What HDF5 says of a file that another program has locked.
const LOCKED: &str = "unable to lock file";

/// Opens a result file of ours.
///
/// # Errors
/// A missing file, one that is not HDF5, not ours, cut short, or still being written.
pub(super) fn open(path: &Path, access: Access) -> Result<File> {
    check_signature(path)?;
    let opened = match access {
        Access::Read => FileBuilder::new().open(path),
        Access::Append => for_writing().open_rw(path),
    };
    let file = opened.map_err(|error| refused(path, access, &error))?;
    if access == Access::Append {
        let_go_of_the_lock(&file);
    }
    let format = file.attr(FORMAT_ATTRIBUTE).and_then(|attribute| attribute.read_scalar::<i64>());
    match format {
        // What is opened for writing is a copy of a file that was looked over.
        Ok(FORMAT) if access == Access::Append => Ok(file),
        Ok(FORMAT) => match vet(&file) {
            Ok(()) => Ok(file),
            Err(error) => Err(damaged(path, &error.to_string())),
        },
        Ok(other) => Err(Error::input(
            Fault::new(format!("{} has format {other}, this program knows format {FORMAT}", path.display())).help(
                match other < FORMAT {
                    true => "run its experiment again, or read it with the version of pseudopod that wrote it",
                    false => "open it with the version of pseudopod that wrote it, or a newer one",
                },
            ),
        )),
        Err(_) => Err(not_ours(path)),
    }
}

/// The fault of an HDF5 file that another program wrote.
fn not_ours(path: &Path) -> Error {
    Error::input(
        Fault::new(format!("{} is an HDF5 file, but not a result of pseudopod", path.display()))
            .help("give the file that `pseudopod run` wrote"),
    )
}

/// Looks at the first bytes before HDF5 does: its own words for these cases help nobody.
pub(super) fn check_signature(path: &Path) -> Result<()> {
    use std::io::Read as _;
    let name = path.display();
    if path.is_dir() {
        return Err(Error::input(Fault::new(format!("{name} is a folder")).help("give the result file inside it")));
    }
    let mut start = Vec::new();
    let read = crate::files::check_plain(path).and_then(|()| std::fs::File::open(path));
    let read = read.and_then(|file| file.take(8).read_to_end(&mut start));
    match read {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Err(Error::input(
            Fault::new(format!("there is no file {name}")).help("check the path; `pseudopod run` says where it writes"),
        )),
        Err(error) if error.kind() == std::io::ErrorKind::InvalidInput => Err(Error::input(
            Fault::new(format!("{name} cannot be read: {error}")).help("give the file that `pseudopod run` wrote"),
        )),
        Err(error) => Err(Error::Machine {
            message: format!("{name} could not be read: {error}"),
            help: "check its permissions and the disk it lies on".into(),
        }),
        Ok(_) if start.iter().all(|byte| *byte == 0) => Err(Error::input(
            Fault::new(format!("{name} is empty: its run ended before the first frame"))
                .help("run the experiment again with --force"),
        )),
        Ok(_) if start != SIGNATURE => Err(Error::input(
            Fault::new(format!("{name} is not an HDF5 file")).help("give the file that `pseudopod run` wrote"),
        )),
        Ok(_) => Ok(()),
    }
}

/// Why HDF5 would not open a file that begins like one.
fn refused(path: &Path, access: Access, error: &hdf5::Error) -> Error {
    let (name, text) = (path.display(), whole_text(error));
    if text.contains(LOCKED) || text.contains("already open") {
        let help = "close it there first; pseudopod itself never keeps a result open for writing";
        return Error::input(Fault::new(format!("{name} is open for writing in another program")).help(help));
    }
    if access == Access::Append && text.contains("Permission denied") {
        return Error::input(
            Fault::new(format!("{name} may not be written")).help("change its permissions, or copy it first"),
        );
    }
    damaged(path, &text)
}

/// The fault of a file that is cut short or holds wrong bytes.
pub(super) fn damaged(path: &Path, text: &str) -> Error {
    let found = match text.contains("truncated file") {
        true => format!("{} is truncated: its end is missing", path.display()),
        false => format!("{} is damaged ({text})", path.display()),
    };
    let help = "copy it again if it was copied; otherwise run the experiment again with --force";
    Error::input(Fault::new(found).help(help))
}

/// The words of all levels of an HDF5 error, outermost first.
fn whole_text(error: &hdf5::Error) -> String {
    match error.stack() {
        Some(stack) => stack.iter().map(|frame| frame.desc().to_string()).collect::<Vec<_>>().join("; "),
        None => error.to_string(),
    }
}

/// A write that failed, with the words for a full disk when the disk is full.
pub(super) fn failed(path: &Path, what: &str, error: &hdf5::Error) -> Error {
    machine_error(path, what, &whole_text(error))
}

/// The machine's trouble with a file, from the text of the library or of the system.
pub(super) fn machine_error(path: &Path, what: &str, text: &str) -> Error {
    let cases = [
        ("No such file or directory", "its folder does not exist", "make the folder first, or use another -o"),
        ("No space left on device", "no space left on device", "free some space, or write to another disk with -o"),
        ("quota exceeded", "the disk quota is exceeded", "free some space, or write to another disk with -o"),
        ("File too large", "the file would be larger than allowed here", "raise the limit, or record less often"),
        ("Permission denied", "permission denied", "write to a folder that is yours with -o"),
        ("Read-only file system", "the file system is read-only", "write to another folder with -o"),
    ];
    for (sign, words, help) in cases {
        if text.to_lowercase().contains(&sign.to_lowercase()) {
            return Error::Machine { message: format!("{} {what}: {words}", path.display()), help: help.into() };
        }
    }
    Error::Machine {
        message: format!("{} {what}: {text}", path.display()),
        help: "check the disk and that nothing else changes the file".into(),
    }
}

/// Sets an attribute that is a number, new or not.
pub(super) fn set_number<T: H5Type>(on: &Location, name: &str, value: T) -> hdf5::Result<()> {
    match on.attr(name) {
        Ok(attribute) => attribute.write_scalar(&value),
        Err(_) => on.new_attr::<T>().create(name)?.write_scalar(&value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A result of nothing but its mark.
    fn marked(path: &Path) -> File {
        let file = create(path).unwrap();
        file.new_attr::<i64>().create(FORMAT_ATTRIBUTE).unwrap().write_scalar(&FORMAT).unwrap();
        file
    }

    #[test]
    fn a_file_that_another_program_has_locked_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("r.h5");
        drop(marked(&path));
        let locked = std::fs::File::open(&path).unwrap();
        locked.lock().unwrap();
        let found = open(&path, Access::Read).err().map(|error| error.to_string());
        assert!(
            found.as_ref().is_some_and(|text| text.contains("is open for writing in another program")),
            "{found:?}"
        );
    }

    /// Programs inherit what is open here when they start.
    #[cfg(unix)]
    #[test]
    fn a_program_that_starts_while_a_result_is_written_does_not_keep_it_from_being_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("r.h5");
        let beside = || std::process::Command::new("sleep").arg("60").spawn().unwrap();
        let file = marked(&path);
        let first = beside();
        drop(file);
        let file = open(&path, Access::Append).unwrap();
        let second = beside();
        drop(file);
        let found = open(&path, Access::Read).map(drop).map_err(|error| error.to_string());
        for mut program in [first, second] {
            program.kill().unwrap();
            program.wait().unwrap();
        }
        assert_eq!(found, Ok(()));
    }

    #[test]
    fn a_full_disk_is_named_as_such() {
        let text = "file write failed: errno = 28, error message = 'No space left on device', buf = 0x55";
        let Error::Machine { message, help } = machine_error(Path::new("r.h5"), "could not be written", text) else {
            panic!("a full disk is the machine's trouble")
        };
        assert_eq!(message, "r.h5 could not be written: no space left on device");
        assert!(help.contains("free some space"), "{help}");
    }
}
