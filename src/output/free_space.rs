//! The space that a result file takes on the disk, made ready before HDF5 writes what it knows of the file.

use std::fs::{File, OpenOptions};
use std::io::{Read as _, Seek as _, SeekFrom, Write as _};
use std::path::Path;

/// The superblock of version 0, the oldest, with addresses and lengths of 8 bytes: signature, versions, sizes, the
/// degrees of its trees, flags, address of the first byte (HDF5 File Format Specification 3.0, II.A).
const SUPERBLOCK: &[u8; 16] = b"\x89HDF\r\n\x1a\n\0\0\0\0\0\x08\x08\0";
/// Where the superblock says how long the file is.
const LENGTH_AT: u64 = 40;

/// Makes the file as long as HDF5 is going to say it is, with space for all of it on the disk, and says so.
///
/// HDF5 writes the length before it makes the file that long, and a kill in between would leave a file that is too
/// short to open. It writes the length after all that lies there, and a kill in between would leave a file that tells
/// of pieces beyond its end. And a disk that becomes full while HDF5 writes out what it knows of the file would leave
/// half of it.
pub(super) fn reserve(path: &Path, length: u64) -> hdf5::Result<()> {
    let reserved = || -> std::io::Result<()> {
        let mut file = OpenOptions::new().read(true).write(true).open(path)?;
        let longer = length.max(file.metadata()?.len());
        allocate(&file, longer)?;
        file.set_len(longer)?;
        tell_length(&mut file, length)
    };
    reserved().map_err(|error| error.to_string().as_str().into())
}

/// Writes the length where HDF5 is about to write it: into the superblock, unless that is not on the disk yet.
fn tell_length(file: &mut File, length: u64) -> std::io::Result<()> {
    let mut start = [0; SUPERBLOCK.len()];
    file.read_exact(&mut start)?;
    if start != *SUPERBLOCK {
        return Ok(());
    }
    file.seek(SeekFrom::Start(LENGTH_AT))?;
    file.write_all(&length.to_le_bytes())
}

/// Reserves space for the whole file on the disk; what is in the file stays.
#[cfg(target_os = "linux")]
fn allocate(file: &File, size: u64) -> std::io::Result<()> {
    use rustix::io::Errno;
    match rustix::fs::fallocate(file, rustix::fs::FallocateFlags::empty(), 0, size) {
        // Some file systems cannot promise space.
        Ok(()) | Err(Errno::OPNOTSUPP | Errno::INVAL | Errno::NOSYS) => Ok(()),
        Err(error) => Err(error.into()),
    }
}

/// Other systems have no common call that reserves space.
#[cfg(not(target_os = "linux"))]
fn allocate(_: &File, _: u64) -> std::io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::container;

    #[test]
    fn a_file_tells_the_length_that_it_is_going_to_have() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.h5");
        let file = container::create(&path).unwrap();
        file.new_dataset_builder().with_data(&[1_i64, 2, 3]).create("numbers").unwrap();
        file.flush().unwrap();
        let length = file.size() + 5000;
        // What a kill leaves that comes before HDF5 has written the length itself.
        reserve(&path, length).unwrap();
        let killed = folder.path().join("killed.h5");
        std::fs::copy(&path, &killed).unwrap();
        let bytes = std::fs::read(&killed).unwrap();
        assert_eq!(bytes.len() as u64, length);
        assert_eq!(bytes[40..48], length.to_le_bytes());
        let found = hdf5::File::open(&killed).unwrap();
        assert_eq!(found.dataset("numbers").unwrap().read_raw::<i64>().unwrap(), [1, 2, 3]);
    }

    #[test]
    fn nothing_is_written_into_a_file_without_a_superblock() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.h5");
        std::fs::write(&path, [1; 10]).unwrap();
        reserve(&path, 100).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!((&bytes[..10], &bytes[10..]), (&[1; 10][..], &[0; 90][..]));
    }
}
