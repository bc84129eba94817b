//! The mark that a flush is under way: a number in the file, by which a resumed run knows that it was killed in one.

use std::fs::OpenOptions;
use std::io::{Seek as _, SeekFrom, Write as _};
use std::path::Path;

use hdf5::File;
use hdf5::plist::dataset_create::AllocTime;

use super::catalogue::entry;
use super::container::set_text;

/// Where the mark stands.
const MARK: &str = "/provenance/flushing";

/// The mark in a file that is being written. HDF5 itself writes when it likes; the mark goes past it, so that it is on
/// the disk before the first byte of the flush and leaves after the last.
pub(super) struct FlushMark {
    /// Where it lies in the file; files of older versions have none.
    at: Option<u64>,
}

impl FlushMark {
    /// Makes the dataset, with space in the file from the beginning.
    pub fn create(file: &File) -> hdf5::Result<()> {
        let builder = file.new_dataset::<i64>().obj_track_times(false).alloc_time(Some(AllocTime::Early));
        let dataset = builder.create(MARK)?;
        dataset.write_scalar(&0_i64)?;
        set_text(&dataset, "unit", entry(MARK).unit)?;
        set_text(&dataset, "description", entry(MARK).description)
    }

    /// Finds the mark.
    pub fn of(file: &File) -> Self {
        Self { at: file.dataset(MARK).ok().and_then(|dataset| dataset.offset()) }
    }

    /// Whether the run was killed in a flush.
    pub fn is_set(file: &File) -> bool {
        file.dataset(MARK).and_then(|mark| mark.read_scalar::<i64>()).is_ok_and(|mark| mark != 0)
    }

    /// Says that a flush begins, or that it has ended.
    pub fn set(&self, path: &Path, flushing: bool) -> hdf5::Result<()> {
        let Some(at) = self.at else { return Ok(()) };
        let written = || -> std::io::Result<()> {
            let mut file = OpenOptions::new().write(true).open(path)?;
            file.seek(SeekFrom::Start(at))?;
            file.write_all(&i64::from(flushing).to_ne_bytes())
        };
        written().map_err(|error| error.to_string().as_str().into())
    }
}
