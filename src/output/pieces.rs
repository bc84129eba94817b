//! How large the pieces of the growing datasets are. The first frame decides, and later frames of other sizes fit in.

use hdf5::File;

use super::catalogue::{CATALOGUE, Filled};
use super::column::{LARGE_PIECE, SMALL_ROWS, piece_of_frame};
use super::population::{OfShared, Part, Population, Shared};

/// From this many cells on in the first frame, a frame of a quantity of cells takes compressed pieces of its own.
const MANY_CELLS: usize = 1024;

/// Rows in the pieces of the datasets whose frames differ in size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pieces {
    /// Of vectors of atoms.
    pub atoms: usize,
    /// Of quantities of cells.
    pub cells: CellPieces,
    /// Of the blocks of populations.
    pub blocks: OfShared,
}

/// The pieces of quantities of cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CellPieces {
    /// Small datasets, in which a piece gathers several frames.
    Few(usize),
    /// Large ones, in which a frame begins with a piece.
    Many(usize),
}

impl Pieces {
    /// For a run that begins with this population.
    pub fn of(population: &Population) -> Self {
        let (atoms, cells) = (population.count(Part::Atoms), population.cells());
        // A run that begins without cells may get any number of them.
        let rows = |count: usize| if count == 0 { LARGE_PIECE / 16 } else { piece_of_frame(count, &[3]) };
        Self {
            atoms: rows(atoms),
            cells: match cells {
                0..MANY_CELLS => CellPieces::Few(SMALL_ROWS * cells.max(1)),
                _ => CellPieces::Many(rows(cells)),
            },
            blocks: Shared::ALL.map(|shared| shared.length(population).clamp(1, LARGE_PIECE)),
        }
    }

    /// As a file has them; none if no frame has come to it.
    pub fn found(file: &File) -> hdf5::Result<Option<Self>> {
        let piece = |path: &str| -> hdf5::Result<usize> { Ok(file.dataset(path)?.chunk().map_or(1, |piece| piece[0])) };
        if !has_frames(file) {
            return Ok(None);
        }
        let mut blocks = [1; Shared::ALL.len()];
        for entry in CATALOGUE {
            if let Filled::Shared(shared) = entry.filled {
                blocks[shared as usize] = piece(entry.path)?;
            }
        }
        let rows = piece("/cells/id")?;
        let packed = !file.dataset("/cells/id")?.filters().is_empty();
        let cells = if packed { CellPieces::Many(rows) } else { CellPieces::Few(rows) };
        Ok(Some(Self { atoms: piece("/VTKHDF/Points")?, cells, blocks }))
    }
}

/// Whether a file has the datasets that come with the first frame.
pub(super) fn has_frames(file: &File) -> bool {
    file.dataset("/VTKHDF/Points").is_ok()
}
