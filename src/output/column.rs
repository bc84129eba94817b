//! Datasets that grow with the run, in two kinds: small ones that gather many frames in a piece of the file, and
//! large ones that take whole compressed pieces per frame.
//!
//! Large ones begin every frame with a piece, the last of which is filled up: so a piece belongs to one frame alone.
//! Neither ever gives space of the file back while it grows: a piece of a small dataset is rewritten where it lies, a piece
//! of a large one is written once.

use std::borrow::Cow;

use hdf5::{Dataset, Extent, Group, SimpleExtents, SliceOrIndex};
use hdf5_sys::h5d::H5Dwrite_chunk;
use ndarray::IxDyn;
use rayon::prelude::*;

use super::packing::{LEVEL, pack, packer};
use super::texts::set_text;

/// Most numbers in a piece of a small dataset: 8 kB.
pub(super) const SMALL_PIECE: usize = 1024;
/// Rows in a piece of a small dataset that gets a row per frame.
pub(super) const SMALL_ROWS: usize = 256;
/// Most numbers in a piece of a large dataset: 786 kB, less than the 1 MB that HDF5 readers keep unpacked.
pub(super) const LARGE_PIECE: usize = 98_304;
/// Pieces that are packed together, to bound the memory they take.
pub(super) const PACKED_TOGETHER: usize = 64;
/// What stands where nothing was written.
const NO_INTEGER: i64 = -1;

/// The type of the numbers of a dataset.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Number {
    Float,
    Integer,
}

impl Number {
    /// The bits that stand for "not written".
    fn nothing(self) -> u64 {
        match self {
            Self::Float => f64::NAN.to_bits(),
            Self::Integer => NO_INTEGER.cast_unsigned(),
        }
    }
}

/// What a new dataset is.
pub(super) struct Plan<'a> {
    pub path: &'a str,
    pub number: Number,
    pub unit: &'a str,
    pub description: &'a str,
}

impl Plan<'_> {
    /// Makes the dataset: rows that grow (`None`) or a fixed number, each of the shape `row`, in pieces of
    /// `piece_rows`, plain or packed.
    fn make(
        &self,
        file: &Group,
        rows: Option<usize>,
        row: &[usize],
        piece_rows: usize,
        packing: Packing,
    ) -> hdf5::Result<Dataset> {
        let first = rows.map_or(Extent::resizable(0), Extent::fixed);
        // A dimension of nothing (a scene without cells) has no fixed size that a piece could fill.
        let across = |n: &usize| if *n == 0 { Extent::resizable(0) } else { Extent::fixed(*n) };
        let extents: Vec<Extent> = [first].into_iter().chain(row.iter().map(across)).collect();
        let least = usize::from(rows.is_none());
        let piece: Vec<usize> = [piece_rows].into_iter().chain(row.iter().copied()).map(|n| n.max(least)).collect();
        let builder = file.new_dataset_builder();
        let mut builder = match self.number {
            Number::Float => builder.empty::<f64>().fill_value(f64::NAN),
            Number::Integer => builder.empty::<i64>().fill_value(NO_INTEGER),
        };
        builder.lcpl().create_intermediate_group(true);
        builder = builder.obj_track_times(false);
        // What neither grows nor is packed needs no pieces, which take 2 kB to be found.
        let in_pieces = rows.is_none() || packing == Packing::Packed;
        if in_pieces && piece.iter().all(|n| *n > 0) {
            builder = builder.chunk(piece);
        }
        if packing == Packing::Packed {
            builder = builder.shuffle().deflate(LEVEL as u8);
        }
        let dataset = builder.shape(SimpleExtents::from_vec(extents)).create(self.path)?;
        set_text(&dataset, "unit", self.unit)?;
        set_text(&dataset, "description", self.description)?;
        Ok(dataset)
    }
}

/// Whether pieces are compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Packing {
    Plain,
    Packed,
}

/// A small dataset that grows by a row at a time. The rows of its last piece are kept in memory and written when the
/// piece is full or all frames have come.
pub(super) struct Column {
    dataset: Dataset,
    row: Vec<usize>,
    number: Number,
    piece_rows: usize,
    rows: usize,
    /// The last piece, whole; what has no row yet holds [`Number::nothing`].
    tail: Vec<u64>,
    tail_rows: usize,
}

impl Column {
    /// Makes the dataset with rows of the shape `row`, at most `piece_rows` of them in a piece.
    pub fn create(file: &Group, plan: &Plan, row: &[usize], piece_rows: usize) -> hdf5::Result<Self> {
        let most = SMALL_PIECE / row.iter().product::<usize>().max(1);
        let piece_rows = piece_rows.min(most).max(1);
        let dataset = plan.make(file, None, row, piece_rows, Packing::Plain)?;
        Ok(Self::around(dataset, plan.number, row, piece_rows))
    }

    /// Opens the dataset and cuts it to its first rows.
    pub fn reopen(file: &Group, path: &str, number: Number, row: &[usize], rows: usize) -> hdf5::Result<Self> {
        let dataset = file.dataset(path)?;
        let piece_rows = dataset.chunk().map_or(1, |piece| piece[0]);
        let mut column = Self::around(dataset, number, row, piece_rows);
        column.resize(rows)?;
        column.tail_rows = rows % piece_rows;
        let selection: Vec<SliceOrIndex> =
            std::iter::once((rows - column.tail_rows..rows).into()).chain(row.iter().map(|n| (0..*n).into())).collect();
        let known: Vec<u64> = match number {
            _ if column.tail_rows == 0 || column.tail.is_empty() => Vec::new(),
            Number::Float => column
                .dataset
                .read_slice::<f64, _, IxDyn>(selection_of(selection))?
                .iter()
                .map(|x| x.to_bits())
                .collect(),
            Number::Integer => column
                .dataset
                .read_slice::<i64, _, IxDyn>(selection_of(selection))?
                .iter()
                .map(|x| x.cast_unsigned())
                .collect(),
        };
        column.tail[..known.len()].copy_from_slice(&known);
        Ok(column)
    }

    fn around(dataset: Dataset, number: Number, row: &[usize], piece_rows: usize) -> Self {
        let tail = vec![number.nothing(); piece_rows * row.iter().product::<usize>()];
        Self { dataset, row: row.to_vec(), number, piece_rows, rows: 0, tail, tail_rows: 0 }
    }

    /// Rows so far.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Appends a row, given as the bits of its numbers.
    pub fn push(&mut self, values: impl IntoIterator<Item = u64>) -> hdf5::Result<()> {
        let width: usize = self.row.iter().product();
        let row = &mut self.tail[self.tail_rows * width..(self.tail_rows + 1) * width];
        for (to, from) in row.iter_mut().zip(values) {
            *to = from;
        }
        self.tail_rows += 1;
        self.rows += 1;
        if self.tail_rows == self.piece_rows {
            self.write()?;
            self.tail.fill(self.number.nothing());
            self.tail_rows = 0;
        }
        Ok(())
    }

    /// Hands the rows so far to the file.
    pub fn write(&mut self) -> hdf5::Result<()> {
        if self.tail_rows == 0 {
            return Ok(());
        }
        self.resize(self.rows)?;
        if self.tail.is_empty() {
            return Ok(());
        }
        let bytes = std::mem::size_of_val(self.tail.as_slice());
        // Plain pieces are the numbers themselves, in the byte order of the machine, which is the dataset's.
        let pointer = self.tail.as_ptr().cast();
        write_piece(&self.dataset, self.rows - self.tail_rows, self.row.len(), pointer, bytes)
    }

    /// Sets the number of rows in the file.
    pub fn resize(&mut self, rows: usize) -> hdf5::Result<()> {
        self.rows = rows;
        self.dataset.resize([&[rows], self.row.as_slice()].concat())
    }
}

/// A large dataset that grows by a block of rows at a time, in compressed pieces: a frame, or what several frames share.
/// Every block begins with a piece.
pub(super) struct PackedColumn {
    dataset: Dataset,
    row: Vec<usize>,
    number: Number,
    piece_rows: usize,
    /// Rows of all pieces so far.
    rows: usize,
}

impl PackedColumn {
    /// Makes the dataset with this many rows of the shape `row` in a piece.
    pub fn create(file: &Group, plan: &Plan, row: &[usize], piece_rows: usize) -> hdf5::Result<Self> {
        let dataset = plan.make(file, None, row, piece_rows, Packing::Packed)?;
        Ok(Self { dataset, row: row.to_vec(), number: plan.number, piece_rows: piece_rows.max(1), rows: 0 })
    }

    /// Opens the dataset and cuts it to the piece that its first rows end in.
    pub fn reopen(file: &Group, path: &str, number: Number, row: &[usize], rows: usize) -> hdf5::Result<Self> {
        let dataset = file.dataset(path)?;
        let piece_rows = dataset.chunk().map_or(1, |piece| piece[0]);
        let rows = rows.next_multiple_of(piece_rows);
        dataset.resize([&[rows], row].concat())?;
        Ok(Self { dataset, row: row.to_vec(), number, piece_rows, rows })
    }

    /// Where the next block begins.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Makes the dataset longer by a block of this many rows. The new size comes first: a piece outside the dataset is
    /// refused.
    fn grow(&mut self, rows: usize) -> hdf5::Result<()> {
        self.rows += rows.next_multiple_of(self.piece_rows);
        self.dataset.resize([&[self.rows], self.row.as_slice()].concat())
    }

    /// Appends a block of integers; `fill` fills in those from an index on.
    pub fn push_integers(&mut self, rows: usize, fill: impl Fn(usize, &mut [i64]) + Sync) -> hdf5::Result<()> {
        let first = self.rows;
        self.grow(rows)?;
        let starts: Vec<usize> = (0..rows).step_by(self.piece_rows).collect();
        for together in starts.chunks(PACKED_TOGETHER) {
            let packed: Vec<Vec<u8>> = together
                .par_iter()
                .map_init(packer, |packer, start| {
                    let mut numbers = vec![NO_INTEGER; self.piece_rows];
                    let inside = (rows - start).min(self.piece_rows);
                    fill(*start, &mut numbers[..inside]);
                    pack(packer, numbers.into_iter().map(i64::cast_unsigned))
                })
                .collect();
            for (start, bytes) in together.iter().zip(&packed) {
                write_piece(&self.dataset, first + start, self.row.len(), bytes.as_ptr().cast(), bytes.len())?;
            }
        }
        Ok(())
    }
}

/// The numbers of a block.
pub(super) enum Numbers<'a> {
    Floats(Cow<'a, [f64]>),
    Integers(Vec<i64>),
}

impl Numbers<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Floats(numbers) => numbers.len(),
            Self::Integers(numbers) => numbers.len(),
        }
    }

    /// The bits of a number.
    pub fn bits(&self, index: usize) -> u64 {
        match self {
            Self::Floats(numbers) => numbers[index].to_bits(),
            Self::Integers(numbers) => numbers[index].cast_unsigned(),
        }
    }
}

/// Appends one frame to several large datasets: packs the pieces on all cores, then hands them to the file.
pub(super) fn push_frames(frames: &mut [(&mut PackedColumn, Numbers)]) -> hdf5::Result<()> {
    // For each piece: which dataset, its first row there, and its first number in the frame.
    let mut pieces: Vec<(usize, usize, usize)> = Vec::new();
    for (number, (column, values)) in frames.iter_mut().enumerate() {
        let (first, width) = (column.rows, column.row.iter().product::<usize>().max(1));
        let starts = (0..values.len()).step_by(column.piece_rows * width);
        pieces.extend(starts.map(|start| (number, first + start / width, start)));
        column.grow(values.len() / width)?;
    }
    for together in pieces.chunks(PACKED_TOGETHER) {
        let packed: Vec<Vec<u8>> = together
            .par_iter()
            .map_init(packer, |packer, (number, _, start)| {
                let (column, values) = &frames[*number];
                let length = column.piece_rows * column.row.iter().product::<usize>();
                let (nothing, end) = (column.number.nothing(), values.len());
                let bits = |index: usize| if index < end { values.bits(index) } else { nothing };
                pack(packer, (*start..start + length).map(bits))
            })
            .collect();
        for ((number, row, _), bytes) in together.iter().zip(&packed) {
            let column = &frames[*number].0;
            write_piece(&column.dataset, *row, column.row.len(), bytes.as_ptr().cast(), bytes.len())?;
        }
    }
    Ok(())
}

/// Writes a dataset of integers that never changes; `value` returns the number of a row.
pub(super) fn write_integers(
    file: &Group,
    plan: &Plan,
    count: usize,
    value: impl Fn(usize) -> i64 + Sync,
) -> hdf5::Result<Dataset> {
    let piece = count.min(LARGE_PIECE);
    let packing = if count > SMALL_PIECE { Packing::Packed } else { Packing::Plain };
    let dataset = plan.make(file, Some(count), &[], piece, packing)?;
    if packing == Packing::Plain {
        if count > 0 {
            dataset.write_raw(&(0..count).map(value).collect::<Vec<i64>>())?;
        }
        return Ok(dataset);
    }
    let starts: Vec<usize> = (0..count).step_by(piece).collect();
    for together in starts.chunks(PACKED_TOGETHER) {
        let number = |row: usize| if row < count { value(row) } else { NO_INTEGER };
        let packed: Vec<Vec<u8>> = together
            .par_iter()
            .map_init(packer, |packer, start| {
                pack(packer, (*start..start + piece).map(|row| number(row).cast_unsigned()))
            })
            .collect();
        for (start, bytes) in together.iter().zip(&packed) {
            write_piece(&dataset, *start, 0, bytes.as_ptr().cast(), bytes.len())?;
        }
    }
    Ok(dataset)
}

/// Writes a dataset of vectors that never changes.
pub(super) fn write_vectors(file: &Group, plan: &Plan, values: &[[f64; 3]]) -> hdf5::Result<Dataset> {
    let dataset = plan.make(file, Some(values.len()), &[3], values.len(), Packing::Plain)?;
    if !values.is_empty() {
        dataset.write_raw(values.as_flattened())?;
    }
    Ok(dataset)
}

/// Rows in a piece, so that whole pieces make a frame: the largest divisor of the frame that is not too large, and
/// the frame itself if its divisors are all small.
pub(super) fn piece_of_frame(frame_rows: usize, row: &[usize]) -> usize {
    let most = (LARGE_PIECE / row.iter().product::<usize>().max(1)).max(1);
    if frame_rows <= most {
        return frame_rows;
    }
    (most / 16..=most).rev().find(|rows| *rows > 0 && frame_rows.is_multiple_of(*rows)).unwrap_or(frame_rows)
}

fn selection_of(dimensions: Vec<SliceOrIndex>) -> hdf5::Hyperslab {
    dimensions.into()
}

/// Hands a finished piece to the file, past HDF5's own filters and caches.
fn write_piece(
    dataset: &Dataset,
    first_row: usize,
    more_dimensions: usize,
    bytes: *const std::ffi::c_void,
    length: usize,
) -> hdf5::Result<()> {
    let mut first = vec![0_u64; 1 + more_dimensions];
    first[0] = first_row as u64;
    write_piece_at(dataset, &first, bytes, length)
}

/// The same for a piece whose first number is anywhere; `first` has one number per dimension of the dataset.
pub(super) fn write_piece_at(
    dataset: &Dataset,
    first: &[u64],
    bytes: *const std::ffi::c_void,
    length: usize,
) -> hdf5::Result<()> {
    assert_eq!(first.len(), dataset.ndim(), "dimensions of {}", dataset.name());
    let default = hdf5_sys::h5p::H5P_DEFAULT;
    // SAFETY: `first` has one number per dimension of the dataset, `bytes` is valid for `length` bytes, and the
    // call holds the lock of the library.
    hdf5::sync::sync(|| unsafe {
        hdf5::h5check(H5Dwrite_chunk(dataset.id(), default, 0, first.as_ptr(), length, bytes))
    })?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_is_made_of_whole_pieces() {
        for rows in [1, 42, 32_768, 42_000, 420_000, 42_000_000, 65_537] {
            let piece = piece_of_frame(rows, &[3]);
            assert_eq!(rows % piece, 0, "{rows} rows in pieces of {piece}");
        }
        assert_eq!(piece_of_frame(420_000, &[3]), 30_000);
        assert_eq!(piece_of_frame(65_537, &[3]), 65_537, "a prime has one piece");
    }
}
