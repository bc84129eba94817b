//! Which cells there are in every frame of a file, and where their numbers lie.

use std::collections::BTreeMap;
use std::ops::Range;

use hdf5::File;

use super::whole::cells_of;
use super::{Cell, Known, Layout};

/// The cells of all frames, and where their numbers are.
pub(super) struct Census {
    /// All cells that were ever recorded, by ascending id.
    pub known: Vec<Known>,
    /// For each population its cells, by their numbers in `known`.
    populations: Vec<Vec<u32>>,
    /// For each population the number of its atoms.
    atoms: Vec<usize>,
    frames: Vec<OfFrame>,
}

/// What is to be known of a frame.
#[derive(Clone, Copy)]
struct OfFrame {
    population: usize,
    /// Its first row among the cells and among the atoms of all frames.
    first_cell: usize,
    first_atom: usize,
}

impl Census {
    /// Reads the cells of the first frames: once for each population.
    pub fn read(file: &File, layout: &Layout, frames: usize) -> hdf5::Result<Self> {
        let column = |path: &str| -> hdf5::Result<Vec<usize>> {
            if frames == 0 {
                return Ok(Vec::new());
            }
            let numbers = file.dataset(path)?.read_slice_1d::<i64, _>(0..frames)?;
            numbers
                .iter()
                .map(|n| usize::try_from(*n).map_err(|_| format!("{path} holds {n}").as_str().into()))
                .collect()
        };
        let (parts, first_cells) = (column("/VTKHDF/Steps/PartOffsets")?, column("/cells/first")?);
        let first_atoms = column("/VTKHDF/Steps/PointOffsets")?;
        let of_frame = |frame: usize| OfFrame {
            population: parts[frame],
            first_cell: first_cells[frame],
            first_atom: first_atoms[frame],
        };
        let mut cells: Vec<Vec<Cell>> = Vec::new();
        let mut known: BTreeMap<u64, Known> = BTreeMap::new();
        let mut first = 0;
        for alike in parts.chunk_by(|one, other| one == other) {
            // Populations are numbered as they come.
            if alike[0] >= cells.len() {
                if alike[0] > cells.len() {
                    return Err(format!("population {} of a frame is not there", alike[0]).as_str().into());
                }
                cells.push(cells_of(file, layout, first)?);
            }
            let end = first + alike.len();
            for cell in &cells[alike[0]] {
                let seen = known.entry(cell.id).or_insert(Known { cell: *cell, frames: first..end });
                seen.frames.end = end;
            }
            first = end;
        }
        let ids: Vec<u64> = known.keys().copied().collect();
        let number = |cell: &Cell| ids.binary_search(&cell.id).map_or(u32::MAX, |number| number as u32);
        Ok(Self {
            known: known.into_values().collect(),
            atoms: cells.iter().map(|cells| layout.atoms(cells)).collect(),
            populations: cells.iter().map(|cells| cells.iter().map(number).collect()).collect(),
            frames: (0..frames).map(of_frame).collect(),
        })
    }

    /// Number of populations.
    pub fn populations(&self) -> usize {
        self.populations.len()
    }

    /// The cells of a frame, by their numbers in `known`.
    pub fn columns(&self, frame: usize) -> &[u32] {
        &self.populations[self.frames[frame].population]
    }

    /// The rows of the atoms of a frame.
    pub fn atoms(&self, frame: usize) -> Range<usize> {
        let known = self.frames[frame];
        known.first_atom..known.first_atom + self.atoms[known.population]
    }

    /// The rows of the cells of a frame.
    pub fn rows(&self, frame: usize) -> Range<usize> {
        let known = self.frames[frame];
        known.first_cell..known.first_cell + self.populations[known.population].len()
    }
}
