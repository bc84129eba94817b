//! One species of a field, as a dataset `[frame, z, y, x]` that grows by a frame at a time, in compressed pieces.
//!
//! Values take four bytes: seven digits are more than a picture shows, and a field is the largest thing in a file.

use hdf5::{Dataset, Extent, Group, SimpleExtents};
use rayon::prelude::*;

use super::column::{LARGE_PIECE, PACKED_TOGETHER, write_piece_at};
use super::container::set_number;
use super::field_layout::FieldLayout;
use super::packing::{LEVEL, pack_bytes, packer};
use super::texts::set_text;

/// Where a species lies and how its frames are cut into pieces.
pub(super) struct FieldColumn {
    dataset: Dataset,
    /// Boxes along z, y and x.
    boxes: [usize; 3],
    piece: Piece,
    frames: usize,
}

/// Boxes of a piece along z and y; along x it is as long as the field. The boxes of a piece follow each other in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Piece {
    z: usize,
    y: usize,
}

impl Piece {
    /// Whole layers if one is small enough, else a part of a layer.
    fn of([nz, ny, nx]: [usize; 3]) -> Self {
        // Numbers of half the size: twice as many.
        let most = 2 * LARGE_PIECE;
        let layer = ny * nx;
        if layer <= most {
            Self { z: (most / layer.max(1)).clamp(1, nz.max(1)), y: ny }
        } else {
            Self { z: 1, y: (most / nx).clamp(1, ny) }
        }
    }
}

impl FieldColumn {
    /// Makes the dataset in the group of the field.
    pub fn create(group: &Group, field: &FieldLayout, name: &str, unit: &str, order: i64) -> hdf5::Result<Self> {
        let boxes = boxes_of(field);
        let piece = Piece::of(boxes);
        let extents = [Extent::resizable(0)].into_iter().chain(boxes.map(Extent::fixed));
        let builder = group.new_dataset_builder().empty::<f32>().fill_value(f32::NAN).obj_track_times(false);
        let builder = builder.chunk([1, piece.z, piece.y, boxes[2]]).shuffle().deflate(LEVEL as u8);
        let dataset = builder.shape(SimpleExtents::from_vec(extents.collect())).create(&*format!("CellData/{name}"))?;
        set_text(&dataset, "unit", unit)?;
        let description = format!("Values of {name} in the boxes of the field, [frame, z, y, x].");
        set_text(&dataset, "description", &description)?;
        set_number(&dataset, "order", order)?;
        Ok(Self { dataset, boxes, piece, frames: 0 })
    }

    /// Opens the dataset and cuts it to its first frames.
    pub fn reopen(group: &Group, field: &FieldLayout, name: &str, frames: usize) -> hdf5::Result<Self> {
        let dataset = group.dataset(&format!("CellData/{name}"))?;
        let boxes = boxes_of(field);
        let piece = match dataset.chunk().as_deref() {
            Some([1, z, y, x]) if *x == boxes[2] && *z > 0 && *y > 0 => Piece { z: *z, y: *y },
            _ => return Err(format!("{} is not cut into frames", dataset.name()).as_str().into()),
        };
        let column = Self { dataset, boxes, piece, frames };
        column.resize(frames)?;
        Ok(column)
    }

    fn resize(&self, frames: usize) -> hdf5::Result<()> {
        let [nz, ny, nx] = self.boxes;
        self.dataset.resize([frames, nz, ny, nx])
    }

    /// Appends the values of a frame, x fastest.
    ///
    /// # Panics
    /// If there is not one for each box.
    pub fn push(&mut self, values: &[f64]) -> hdf5::Result<()> {
        let [nz, ny, nx] = self.boxes;
        assert_eq!(values.len(), nz * ny * nx, "values and boxes of {}", self.dataset.name());
        // The new size comes first: a piece outside the dataset is refused.
        self.resize(self.frames + 1)?;
        let starts: Vec<[usize; 2]> =
            (0..nz).step_by(self.piece.z).flat_map(|z| (0..ny).step_by(self.piece.y).map(move |y| [z, y])).collect();
        let length = self.piece.z * self.piece.y * nx;
        for together in starts.chunks(PACKED_TOGETHER) {
            let packed: Vec<Vec<u8>> = together
                .par_iter()
                .map_init(packer, |packer, [z, y]| {
                    let first = (z * ny + y) * nx;
                    // A piece is always whole; what sticks out of the field is never read.
                    let row_end = if self.piece.y == ny { values.len() } else { (z + 1) * ny * nx };
                    let inside = &values[first..row_end.min(first + length)];
                    let number = |k: usize| inside.get(k).map_or(f32::NAN, |value| *value as f32);
                    pack_bytes(packer, (0..length).map(|k| number(k).to_ne_bytes()))
                })
                .collect();
            for ([z, y], bytes) in together.iter().zip(&packed) {
                let first = [self.frames, *z, *y, 0].map(|n| n as u64);
                write_piece_at(&self.dataset, &first, bytes.as_ptr().cast(), bytes.len())?;
            }
        }
        self.frames += 1;
        Ok(())
    }
}

fn boxes_of(field: &FieldLayout) -> [usize; 3] {
    let [nx, ny, nz] = field.cells;
    [nz, ny, nx]
}

#[cfg(test)]
mod tests {
    use super::Piece;

    #[test]
    fn pieces_are_whole_layers_until_a_layer_is_too_large() {
        assert_eq!(Piece::of([1, 100, 100]), Piece { z: 1, y: 100 });
        assert_eq!(Piece::of([100, 100, 100]), Piece { z: 19, y: 100 });
        assert_eq!(Piece::of([1, 1000, 1000]), Piece { z: 1, y: 196 });
    }
}
