//! Puts cells where they start.

use super::super::{CellType, Experiment, Placement};
use super::numbers::vector;
use crate::Vec3;
use crate::geometry::{Surface, point_in_box};
use crate::random::{Purpose, Stream};
use crate::sim::Kind;

/// Distance of neighbours on the default grid over the cell's largest extent.
const GRID_SPACING: f64 = 1.5;

/// Cells of a kind at these centres: `[cell][atom]`.
pub fn atoms_at(kind: &Kind, centres: &[Vec3]) -> Vec<Vec<Vec3>> {
    let at = |centre: &Vec3| kind.rest.positions.iter().map(|p| p + centre).collect();
    centres.iter().map(at).collect()
}

/// The number of the first cell of each type in the order of all cells.
pub fn first_cells(experiment: &Experiment) -> impl Iterator<Item = usize> {
    experiment.cells.values().scan(0, |next, cell| {
        *next += cell.count();
        Some(*next - cell.count())
    })
}

/// The centres of all cells of a kind at the start, of which the first has this number among all cells.
pub fn centres(experiment: &Experiment, cell: &CellType, kind: &Kind, first_cell: usize) -> Vec<Vec3> {
    let number = cell.count();
    let Some(Placement::Random { random_from, random_to }) = &cell.placement else {
        return positions_of(cell.placement.as_ref(), number, kind);
    };
    let (low, high) = (vector(random_from.map(|x| x.value())), vector(random_to.map(|x| x.value())));
    (0..number).map(|i| random_position(experiment.seed, (first_cell + i) as u32, low, high)).collect()
}

/// The first positions that a document gives cells of a kind, or a grid that it need not give; none where they are drawn.
pub fn positions_of(placement: Option<&Placement>, number: usize, kind: &Kind) -> Vec<Vec3> {
    let mut positions: Vec<Vec3> = match placement {
        Some(Placement::At { at }) => at.iter().map(|x| vector(x.map(|x| x.value()))).collect(),
        Some(Placement::Grid { grid, spacing, origin }) => {
            grid_positions(*grid, spacing.value(), vector(origin.map(|x| x.value()))).take(number).collect()
        }
        Some(Placement::Random { .. }) => Vec::new(),
        None => {
            let (side, spacing) = default_grid(number, &kind.rest);
            grid_positions([side, side, 1], spacing, Vec3::zeros()).take(number).collect()
        }
    };
    positions.truncate(number);
    positions
}

/// Cells along each side of the grid where a document gives no positions, and their distance, µm.
pub fn default_grid(number: usize, rest: &Surface) -> (u32, f64) {
    let extent = crate::geometry::bounding_box(&rest.positions).map_or(1.0, |(a, b)| (b - a).max());
    ((number as f64).sqrt().ceil() as u32, GRID_SPACING * extent)
}

/// The positions of a grid one after the other: it may have many more of them than there are cells.
fn grid_positions(grid: [u32; 3], spacing: f64, origin: Vec3) -> impl Iterator<Item = Vec3> {
    let middle = Vec3::from(grid.map(|n| 0.5 * (f64::from(n) - 1.0)));
    let along_y_and_z = (0..grid[2]).flat_map(move |z| (0..grid[1]).map(move |y| (y, z)));
    let indices = along_y_and_z.flat_map(move |(y, z)| (0..grid[0]).map(move |x| [x, y, z]));
    indices.map(move |index| origin + spacing * (Vec3::from(index.map(f64::from)) - middle))
}

fn random_position(seed: u64, cell: u32, low: Vec3, high: Vec3) -> Vec3 {
    point_in_box(&mut Stream::new(seed, Purpose::Placement, cell, 0), low, high)
}
