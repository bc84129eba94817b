//! Mends the file of a run that was killed in a flush.
//!
//! A flush is many small writes. A kill between them leaves trees of which some nodes are of this flush and some of the
//! one before. Nearly always every frame can still be read, but nothing may be appended or cut off any more. So what is
//! whole is copied, piece by piece, into a new file, which takes the place of the old one.

use std::fs;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};

use hdf5::{Dataset, File};
use hdf5_sys::h5d::H5Dget_chunk_info_by_coord;

use super::Layout;
use super::catalogue::{CATALOGUE, CONTACT, FORCE, Filled, TRACTION};
use super::column::write_piece_at;
use super::columns::Columns;
use super::container::{self, Access, damaged, failed, machine_error, set_number};
use super::header::Header;
use super::layout_io::{write_header, write_layout};
use super::pieces::Pieces;
use super::whole::whole_frames;
use crate::error::{Error, Fault, Result};

/// Puts a whole file with the same frames in the place of a torn one. The torn one stays until the new one is on the
/// disk.
///
/// # Errors
/// [`Error::Input`] if frames up to the step `needed`, from where the run goes on, were lost; [`Error::Machine`] if the
/// disk refuses.
pub(super) fn mend(path: &Path, header: &Header, layout: &Layout, needed: u64) -> Result<()> {
    let new_path = mended_path(path);
    let mended = copy_whole(path, &new_path, header, layout, needed).and_then(|()| {
        fs::File::open(&new_path)
            .and_then(|file| file.sync_all())
            .and_then(|()| fs::rename(&new_path, path))
            .map_err(|error| machine_error(path, "could not be mended", &error.to_string()))
    });
    mended.inspect_err(|_| drop(fs::remove_file(&new_path)))
}

/// `<result>.mended`, the new file while it is being made.
fn mended_path(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".mended");
    name.into()
}

fn copy_whole(path: &Path, new_path: &Path, header: &Header, layout: &Layout, needed: u64) -> Result<()> {
    let old = container::open(path, Access::Read)?;
    let new = container::create(new_path)?;
    let copied = || -> hdf5::Result<()> {
        write_header(&new, header)?;
        write_layout(&new, layout)?;
        let pieces = Pieces::found(&old)?.ok_or("it holds no frame")?;
        Columns::create_all(&new, layout, &pieces, old.dataset(FORCE[0].path).is_ok())?;
        let (from, to) = (old.group("provenance")?, new.group("provenance")?);
        set_number(&to, "resumed", from.attr("resumed")?.read_scalar::<i64>()?)?;
        let mut bytes = fs::File::open(path).map_err(|error| hdf5::Error::from(error.to_string().as_str()))?;
        for path in growing(&new, "")? {
            copy_pieces(&old.dataset(&path)?, &mut bytes, &new.dataset(&path)?)?;
        }
        new.flush()
    };
    copied().map_err(|error| failed(path, "could not be mended", &error))?;
    match lost_frames(&old, &new, layout, needed).map_err(|error| damaged(path, &error.to_string()))? {
        0 => Ok(()),
        lost => Err(Error::input(
            Fault::new(format!(
                "{} is damaged: the run was killed in a flush, and {lost} of the frames before its checkpoint cannot be read",
                path.display()
            ))
            .help("the others can be read; run the experiment again with --force"),
        )),
    }
}

/// The paths of all datasets that grow with the run, each under one name.
///
/// HDF5 calls a dataset by the name under which it was opened last, whoever opened it; so paths are made here.
fn growing(file: &File, folder: &str) -> hdf5::Result<Vec<String>> {
    let mut found = Vec::new();
    for name in file.group(if folder.is_empty() { "/" } else { folder })?.member_names()? {
        let path = format!("{folder}/{name}");
        match file.dataset(&path) {
            Ok(dataset) if dataset.is_resizable() && !is_second_name(&path) => found.push(path),
            Ok(_) => {}
            Err(_) => found.extend(growing(file, &path)?),
        }
    }
    Ok(found)
}

fn is_second_name(path: &str) -> bool {
    if super::membranes::is_offsets(path) {
        return true;
    }
    let mut entries = CATALOGUE.iter().chain(CONTACT).chain(FORCE).chain(TRACTION);
    entries.any(|entry| entry.path == path && matches!(entry.filled, Filled::Link(_)))
}

/// Copies the rows before the first piece that is not there.
fn copy_pieces(old: &Dataset, bytes: &mut fs::File, new: &Dataset) -> hdf5::Result<()> {
    let shape = old.shape();
    let Some(piece) = new.chunk().filter(|_| shape.iter().all(|n| *n > 0)) else { return new.resize(shape) };
    if old.chunk().as_ref() != Some(&piece) || new.shape()[1..] != shape[1..] {
        return Err(format!("{} has pieces of another size", old.name()).as_str().into());
    }
    new.resize(shape.as_slice())?;
    for first in first_elements(&shape, &piece) {
        match read_piece(old, bytes, &first) {
            Some(piece) => write_piece_at(new, &first, piece.as_ptr().cast(), piece.len())?,
            None => return new.resize([&[first[0] as usize], &shape[1..]].concat()),
        }
    }
    Ok(())
}

/// The first number of every piece of a dataset, the last dimension fastest.
fn first_elements(shape: &[usize], piece: &[usize]) -> impl Iterator<Item = Vec<u64>> {
    let counts: Vec<usize> = shape.iter().zip(piece).map(|(rows, piece)| rows.div_ceil(*piece)).collect();
    let piece = piece.to_vec();
    (0..counts.iter().product()).map(move |number| {
        let mut rest: usize = number;
        let mut first: Vec<u64> = (0..counts.len())
            .rev()
            .map(|axis| {
                let along = rest % counts[axis];
                rest /= counts[axis];
                (along * piece[axis]) as u64
            })
            .collect();
        first.reverse();
        first
    })
}

/// The bytes of a piece as they lie in the file, unless the path to them or they themselves are missing.
fn read_piece(dataset: &Dataset, bytes: &mut fs::File, first: &[u64]) -> Option<Vec<u8>> {
    let (mut filters, mut at, mut length) = (0, 0, 0);
    // SAFETY: `first` has one number per dimension of the dataset, the others are variables for one number each, and the
    // call holds the lock of the library.
    let found = hdf5::sync::sync(|| unsafe {
        hdf5::h5check(H5Dget_chunk_info_by_coord(dataset.id(), first.as_ptr(), &mut filters, &mut at, &mut length))
    });
    // A piece that was never written lies at the last address there could be, and has no length in a torn tree.
    if found.is_err() || at == u64::MAX || length == 0 || filters != 0 {
        return None;
    }
    let mut piece = vec![0; usize::try_from(length).ok()?];
    bytes.seek(SeekFrom::Start(at)).ok()?;
    bytes.read_exact(&mut piece).ok()?;
    Some(piece)
}

/// How many frames up to a step the old file tells of and the new one does not hold.
fn lost_frames(old: &File, new: &File, layout: &Layout, needed: u64) -> hdf5::Result<usize> {
    let needed = i64::try_from(needed).unwrap_or(i64::MAX);
    let steps = new.dataset("/step")?.read_raw::<i64>()?;
    let count = |steps: &[i64]| steps.iter().filter(|step| **step <= needed).count();
    let (kept, mut told) = (count(&steps[..whole_frames(new, layout)?]), count(&steps));
    // Where the list of steps is torn itself nobody knows the steps of the frames after it.
    if steps.last().is_none_or(|step| *step < needed) {
        told = told.max(old.dataset("/step")?.shape()[0]);
    }
    Ok(told - kept)
}

#[cfg(test)]
#[path = "mend_tests.rs"]
mod tests;
