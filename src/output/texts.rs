//! Texts in the result file, of which every length is looked at before HDF5 believes it: for a damaged one it takes up to four
//! gigabytes.

use std::ffi::c_void;
use std::sync::LazyLock;

use hdf5::types::{TypeDescriptor, VarLenUnicode};
use hdf5::{Container, Dataset, Datatype, Group, Location};
use hdf5_sys::h5a::H5Aread;
use hdf5_sys::h5d::H5Dread;
use hdf5_sys::h5i::hid_t;
use hdf5_sys::h5p::H5P_DEFAULT;
use hdf5_sys::h5s::H5S_ALL;
use hdf5_sys::h5t::{H5T_bkg_t, H5T_cdata_t, H5T_class_t, H5T_cmd_t, H5T_pers_t, H5Tcreate, H5Tget_size, H5Tregister};
use ndarray::Array1;

/// Bytes of a text where the file has a dataset or an attribute of texts: its length (4), and where in the file it lies (8 and 4).
const ENTRY: usize = 16;

/// A text as HDF5 stores it. HDF5 ends texts at a zero byte, so that one is replaced.
pub(super) fn stored(text: &str) -> VarLenUnicode {
    text.replace('\0', "\u{fffd}").parse().unwrap_or_default()
}

/// Sets an attribute that is a text.
pub(super) fn set_text(on: &Location, name: &str, text: &str) -> hdf5::Result<()> {
    on.new_attr::<VarLenUnicode>().create(name)?.write_scalar(&stored(text))
}

/// Writes a list of texts.
pub(super) fn write_texts(file: &Group, path: &str, texts: &[&str]) -> hdf5::Result<Dataset> {
    let texts: Array1<VarLenUnicode> = texts.iter().map(|text| stored(text)).collect();
    let mut builder = file.new_dataset_builder().with_data(&texts).obj_track_times(false);
    builder.lcpl().create_intermediate_group(true);
    builder.create(path)
}

/// Reads an attribute that is a text.
pub(super) fn text(on: &Location, name: &str) -> hdf5::Result<String> {
    let attribute = on.attr(name)?;
    // SAFETY: `check_lengths` has room for what is read, and holds the lock.
    check_lengths(&attribute, |entries, buffer| unsafe { H5Aread(attribute.id(), entries, buffer) })?;
    checked(&attribute.read_scalar()?)
}

/// Reads a dataset that is one text.
pub(super) fn read_text(file: &Group, path: &str) -> hdf5::Result<String> {
    let dataset = file.dataset(path)?;
    check_dataset(&dataset)?;
    checked(&dataset.read_scalar()?)
}

/// Reads a list of texts.
pub(super) fn read_texts(file: &Group, path: &str) -> hdf5::Result<Vec<String>> {
    let dataset = file.dataset(path)?;
    check_dataset(&dataset)?;
    dataset.read_raw()?.iter().map(checked).collect()
}

/// A text of a file: its bytes need not be what they claim to be.
fn checked(text: &VarLenUnicode) -> hdf5::Result<String> {
    String::from_utf8(text.as_bytes().to_vec()).map_err(|_| "a text in it is not UTF-8".into())
}

fn check_dataset(dataset: &Dataset) -> hdf5::Result<()> {
    check_lengths(dataset, |entries, buffer| {
        // SAFETY: `check_lengths` has room for what is read, and holds the lock.
        unsafe { H5Dread(dataset.id(), entries, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer) }
    })
}

/// Refuses texts that are longer, together, than the file in which they lie. What is no text HDF5 refuses by itself.
///
/// `read` reads all of `texts` as the type that it is given.
fn check_lengths(texts: &Container, read: impl FnOnce(hid_t, *mut c_void) -> i32) -> hdf5::Result<()> {
    if texts.dtype()?.to_descriptor()? != TypeDescriptor::VarLenUnicode {
        return Ok(());
    }
    let mut entries = vec![[0_u8; ENTRY]; texts.size()];
    hdf5::sync::sync(|| hdf5::h5check(read(*ENTRIES, entries.as_mut_ptr().cast())))?;
    let length = |entry: &[u8; ENTRY]| u64::from(u32::from_le_bytes([entry[0], entry[1], entry[2], entry[3]]));
    match entries.iter().map(length).sum::<u64>() > texts.file()?.size() {
        true => Err("a text in it is longer than the file".into()),
        false => Ok(()),
    }
}

/// A type as which texts are read without following where they lie. HDF5 has no conversion to it, until it is told of [`keep_entries`].
static ENTRIES: LazyLock<hid_t> = LazyLock::new(|| {
    let text = Datatype::from_type::<VarLenUnicode>().expect("HDF5 knows texts");
    // SAFETY: who asks holds the lock of the library; the type lives as long as the program, the one of texts longer than the call.
    unsafe {
        let entries = H5Tcreate(H5T_class_t::H5T_OPAQUE, ENTRY);
        H5Tregister(H5T_pers_t::H5T_PERS_SOFT, c"entries of texts".as_ptr(), text.id(), entries, Some(keep_entries));
        entries
    }
});

/// The conversion that leaves every byte as it is.
extern "C" fn keep_entries(
    from: hid_t,
    to: hid_t,
    about: *mut H5T_cdata_t,
    _: usize,
    _: usize,
    _: usize,
    _: *mut c_void,
    _: *mut c_void,
    _: hid_t,
) -> i32 {
    // SAFETY: HDF5 gives types that live and a valid pointer, and calls with its lock held.
    unsafe {
        (*about).need_bkg = H5T_bkg_t::H5T_BKG_NO;
        let fits = (*about).command != H5T_cmd_t::H5T_CONV_INIT || H5Tget_size(from) == H5Tget_size(to);
        if fits { 0 } else { -1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Damages the length of the text of 77 letters that an attribute, a dataset and a list hold.
    #[test]
    fn a_text_that_claims_to_be_longer_than_its_file_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("texts.h5");
        let long = "x".repeat(77);
        let make = || -> hdf5::Result<()> {
            let file = hdf5::File::create(&path)?;
            set_text(&file, "attribute", &long)?;
            file.new_dataset::<VarLenUnicode>().create("one")?.write_scalar(&stored(&long))?;
            write_texts(&file, "list", &["y", &long]).map(drop)
        };
        make().expect("a file is made");
        let read = || {
            let file = hdf5::File::open(&path).expect("the file opens");
            let list = read_texts(&file, "list").map(|texts| texts.concat());
            [text(&file, "attribute"), read_text(&file, "one"), list]
        };
        let found = read().map(|text| text.expect("all is well"));
        assert_eq!(found, [long.clone(), long.clone(), format!("y{long}")]);

        let mut bytes = std::fs::read(&path).expect("a file");
        let mut damaged = 0;
        for at in 0..=bytes.len() - ENTRY {
            // The text's own entry in the heap has its length in eight bytes.
            if bytes[at..at + 4] == [77, 0, 0, 0] && bytes[at + 4..at + 8] != [0; 4] {
                bytes[at + 3] = 0xff;
                damaged += 1;
            }
        }
        assert_eq!(damaged, 3);
        std::fs::write(&path, bytes).expect("a file is written");
        for text in read() {
            let error = text.expect_err("a length of four gigabytes is refused").to_string();
            assert_eq!(error, "a text in it is longer than the file");
        }
    }
}
