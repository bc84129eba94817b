//! Edits of what is in an HDF5 file, done by HDF5: the file stays whole, and says what no run has written.

use hdf5::types::{TypeDescriptor, VarLenUnicode};
use hdf5::{Dataset, File, Group, H5Type, Result};

use crate::edits::Edit;

/// Texts that no run writes.
const TEXTS: [&str; 8] = ["", "µ", "a/b", "../..", "title = ", "[run]\nuntil = 3", "<eml/>", "9999999999999999999999"];

/// Where the datasets of a file stand.
fn datasets(group: &Group, found: &mut Vec<String>) -> Result<()> {
    found.extend(group.datasets()?.iter().map(|dataset| dataset.name()));
    group.groups()?.iter().try_for_each(|group| datasets(group, found))
}

/// Edits one dataset or attribute of a file.
///
/// # Errors
/// What HDF5 refuses; the file may be changed half.
pub fn apply(file: &File, edit: Edit) -> Result<()> {
    let mut paths = Vec::new();
    datasets(file, &mut paths)?;
    // Edits before may have taken all.
    let Some(path) = paths.get(usize::from(edit.part) % paths.len().max(1)) else { return Ok(()) };
    let dataset = file.dataset(path)?;
    match edit.kind % 8 {
        0..=3 => number(&dataset, edit),
        4 => rows(file, path, &dataset, edit),
        5 => {
            let rows: Vec<usize> = dataset.shape();
            drop(dataset);
            file.unlink(path)?;
            let rows = rows.first().copied().unwrap_or(1);
            match edit.extent % 4 {
                0 => Ok(()),
                1 => fresh(file, path, &vec![0_i32; rows]),
                2 => fresh(file, path, &vec![0.5_f32; rows]),
                _ => fresh(file, path, &vec![edit.number() as i64; rows]),
            }
        }
        6 => attribute(file, &dataset, edit),
        _ => text(&dataset, edit),
    }
}

/// One number of a dataset.
fn number(dataset: &Dataset, edit: Edit) -> Result<()> {
    match dataset.dtype()?.to_descriptor()? {
        TypeDescriptor::Integer(_) => set_one(dataset, edit, |found: i64| near(found, edit)),
        TypeDescriptor::Float(hdf5::types::FloatSize::U8) => set_one(dataset, edit, |_| f64::from_bits(edit.number())),
        TypeDescriptor::Float(_) => set_one(dataset, edit, |_| f32::from_bits(edit.number() as u32)),
        TypeDescriptor::Unsigned(_) => set_one(dataset, edit, |_| edit.value as u8),
        _ => text(dataset, edit),
    }
}

/// A number near the one that was there, or any: what counts and points is wrong by one more often than by all.
fn near(found: i64, edit: Edit) -> i64 {
    match edit.kind % 4 {
        0 => found.wrapping_add(1),
        1 => found.wrapping_sub(1),
        _ => edit.number() as i64,
    }
}

fn set_one<T: H5Type + Copy>(dataset: &Dataset, edit: Edit, new: impl Fn(T) -> T) -> Result<()> {
    let mut all = dataset.read_dyn::<T>()?;
    let index = edit.at as usize % all.len().max(1);
    if let Some(number) = all.iter_mut().nth(index) {
        *number = new(*number);
    }
    dataset.write(&all)
}

/// Fewer or more rows, with the numbers that were there.
fn rows(file: &File, path: &str, dataset: &Dataset, edit: Edit) -> Result<()> {
    match dataset.dtype()?.to_descriptor()? {
        TypeDescriptor::Integer(_) => again::<i64>(file, path, dataset, edit),
        TypeDescriptor::Float(hdf5::types::FloatSize::U8) => again::<f64>(file, path, dataset, edit),
        TypeDescriptor::Float(_) => again::<f32>(file, path, dataset, edit),
        TypeDescriptor::Unsigned(_) => again::<u8>(file, path, dataset, edit),
        _ => Ok(()),
    }
}

fn again<T: H5Type + Copy>(file: &File, path: &str, dataset: &Dataset, edit: Edit) -> Result<()> {
    let (found, mut shape) = (dataset.read_raw::<T>()?, dataset.shape());
    let Some(rows) = shape.first_mut() else { return Ok(()) };
    let now =
        [0, 1, *rows + 1, rows.saturating_sub(1), 2 * *rows, edit.at as usize % 100][usize::from(edit.extent) % 6];
    *rows = now;
    let number = shape.iter().product();
    let numbers: Vec<T> = found.iter().copied().cycle().take(number).collect();
    if numbers.len() < number {
        return Ok(());
    }
    let all = ndarray::ArrayD::from_shape_vec(shape, numbers).map_err(|error| hdf5::Error::from(error.to_string()))?;
    file.unlink(path)?;
    file.new_dataset_builder().with_data(&all).create(path).map(drop)
}

fn fresh<T: H5Type>(file: &File, path: &str, numbers: &[T]) -> Result<()> {
    file.new_dataset_builder().with_data(numbers).create(path).map(drop)
}

/// A number that stands with a group or a dataset.
fn attribute(file: &File, dataset: &Dataset, edit: Edit) -> Result<()> {
    let groups: Vec<Group> = file.groups()?;
    let inner: Vec<Group> = groups.iter().flat_map(|group| group.groups().unwrap_or_default()).collect();
    let mut all = Vec::new();
    for group in groups.iter().chain(&inner) {
        all.extend(group.attr_names()?.into_iter().filter_map(|name| group.attr(&name).ok()));
    }
    all.extend(dataset.attr_names()?.into_iter().filter_map(|name| dataset.attr(&name).ok()));
    let Some(attribute) = all.get(edit.at as usize % all.len().max(1)) else { return Ok(()) };
    match attribute.dtype()?.to_descriptor()? {
        TypeDescriptor::Integer(_) => attribute.as_writer().write_scalar(&(edit.number() as i64)),
        TypeDescriptor::Float(_) => attribute.as_writer().write_scalar(&f64::from_bits(edit.number())),
        _ => Ok(()),
    }
}

/// A text, alone or in a list.
fn text(dataset: &Dataset, edit: Edit) -> Result<()> {
    if dataset.dtype()?.to_descriptor()? != TypeDescriptor::VarLenUnicode {
        return Ok(());
    }
    let mut all = dataset.read_dyn::<VarLenUnicode>()?;
    let index = edit.at as usize % all.len().max(1);
    let found: Vec<VarLenUnicode> = all.iter().cloned().collect();
    if let Some(text) = all.iter_mut().nth(index) {
        let choice = edit.value as usize;
        *text = match TEXTS.get(choice % (TEXTS.len() + 2)) {
            Some(other) => other.parse().unwrap_or_default(),
            None => found[choice / 16 % found.len()].clone(),
        };
    }
    dataset.write(&all)
}
