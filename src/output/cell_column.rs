//! Quantities of cells in the file: a row for each cell of each frame.

use std::borrow::Cow;

use hdf5::File;

use super::column::{Column, Number, Numbers, PackedColumn, Plan};
use super::pieces::CellPieces;
use super::{Cell, Frame};
use crate::recorded::Values;

/// Where a quantity of cells comes from.
pub(super) enum CellSource {
    Integer(fn(&Cell) -> i64),
    Recorded(Values),
    /// A quantity of a system, by both their numbers.
    System(usize, usize),
}

impl CellSource {
    /// The shape of a cell's row.
    pub fn row(&self) -> &'static [usize] {
        match self {
            Self::Recorded(Values::Vector(..)) => &[3],
            _ => &[],
        }
    }

    /// The numbers of a frame, cell after cell.
    pub fn values<'a>(&self, frame: &'a Frame) -> Numbers<'a> {
        match self {
            Self::Integer(value) => Numbers::Integers(frame.cells.iter().map(value).collect()),
            Self::Recorded(Values::Number(value, _)) => Numbers::Floats(frame.records.iter().map(value).collect()),
            Self::Recorded(Values::Vector(value, _)) => Numbers::Floats(frame.records.iter().flat_map(value).collect()),
            Self::System(system, quantity) => Numbers::Floats(Cow::from(&frame.systems[*system][*quantity])),
        }
    }
}

/// The dataset of a quantity of cells.
pub(super) enum CellColumn {
    Few(Column),
    Many(PackedColumn),
}

impl CellColumn {
    /// Makes the dataset.
    pub fn create(file: &File, plan: &Plan, row: &[usize], pieces: CellPieces) -> hdf5::Result<Self> {
        Ok(match pieces {
            CellPieces::Few(rows) => Self::Few(Column::create(file, plan, row, rows)?),
            CellPieces::Many(rows) => Self::Many(PackedColumn::create(file, plan, row, rows)?),
        })
    }

    /// Opens the dataset and cuts it to its first rows.
    pub fn reopen(file: &File, plan: &Plan, row: &[usize], rows: usize) -> hdf5::Result<Self> {
        let (path, number): (&str, Number) = (plan.path, plan.number);
        Ok(match file.dataset(path)?.filters().is_empty() {
            true => Self::Few(Column::reopen(file, path, number, row, rows)?),
            false => Self::Many(PackedColumn::reopen(file, path, number, row, rows)?),
        })
    }

    /// Where the next frame begins.
    pub fn rows(&self) -> usize {
        match self {
            Self::Few(column) => column.rows(),
            Self::Many(column) => column.rows(),
        }
    }
}
