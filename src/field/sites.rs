//! Where expressions of a document are worked out on a grid: in boxes, on faces between them, at walls.

use super::grid::Grid;

/// Points of a grid, x running fastest, then y, then z.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sites {
    /// The centres of the boxes.
    Boxes,
    /// The faces across an axis: one more than boxes along it, the first and last at the walls.
    Faces(usize),
    /// The faces at the wall of an axis: at its low (0) or high (1) side.
    Wall(usize, usize),
    /// One point, for what is the same everywhere.
    Once,
}

impl Sites {
    /// How many there are along each axis.
    pub fn counts(self, grid: &Grid) -> [usize; 3] {
        let mut counts = grid.cells;
        match self {
            Self::Boxes => {}
            Self::Faces(axis) => counts[axis] += 1,
            Self::Wall(axis, _) => counts[axis] = 1,
            Self::Once => counts = [1; 3],
        }
        counts
    }

    /// How many there are.
    pub fn len(self, grid: &Grid) -> usize {
        self.counts(grid).iter().product()
    }

    /// The index along each axis of one of them.
    pub fn index(self, grid: &Grid, at: usize) -> [usize; 3] {
        let [nx, ny, _] = self.counts(grid);
        [at % nx, at / nx % ny, at / (nx * ny)]
    }

    /// The position of one of them, µm. On the substrate z is its height.
    pub fn position(self, grid: &Grid, index: [usize; 3]) -> [f64; 3] {
        let flat = if grid.is_flat() { 0.0 } else { 0.5 };
        let mut boxes = [index[0] as f64 + 0.5, index[1] as f64 + 0.5, index[2] as f64 + flat];
        match self {
            Self::Boxes | Self::Once => {}
            Self::Faces(axis) => boxes[axis] = index[axis] as f64,
            Self::Wall(axis, side) => boxes[axis] = if side == 0 { 0.0 } else { grid.cells[axis] as f64 },
        }
        std::array::from_fn(|axis| grid.origin[axis] + boxes[axis] * grid.spacing[axis])
    }

    /// The boxes at the wall and behind it, for one of the faces at a wall.
    pub fn behind(self, grid: &Grid, index: [usize; 3]) -> Option<[usize; 2]> {
        let Self::Wall(axis, side) = self else { return None };
        let n = grid.cells[axis];
        let at = |along: usize| {
            let mut index = index;
            index[axis] = along;
            grid.at(index[0], index[1], index[2])
        };
        Some(if side == 0 { [at(0), at(1.min(n - 1))] } else { [at(n - 1), at(n.saturating_sub(2))] })
    }
}
