//! One axis of the grid as positions see it: which boxes lie around a position.

use super::grid::{Grid, Wall};
use super::species::Species;

/// Positions that are worked on side by side.
pub const SIDE: usize = 4;

/// One axis of the grid as positions need it.
#[derive(Clone, Copy)]
pub struct Axis {
    pub n: usize,
    pub origin: f64,
    pub inverse: f64,
    pub half: f64,
    pub size: f64,
    pub walls: [Wall; 2],
}

impl Axis {
    /// The axes of a grid with the walls of a species.
    pub fn all(grid: &Grid, species: &Species) -> [Self; 3] {
        std::array::from_fn(|axis| Self {
            n: grid.cells[axis],
            origin: grid.origin[axis],
            inverse: 1.0 / grid.spacing[axis],
            half: 0.5 * grid.spacing[axis],
            size: grid.cells[axis] as f64,
            walls: species.walls[axis],
        })
    }

    /// Whether the axis is a ring.
    pub fn periodic(&self) -> bool {
        self.walls[0] == Wall::Periodic
    }

    /// Distance from the low wall in boxes. Beyond a wall counts as at the wall; a ring is gone round.
    #[inline(always)]
    pub fn coordinate(&self, position: f64) -> f64 {
        let (coordinate, n) = ((position - self.origin) * self.inverse, self.n as f64);
        if coordinate >= 0.0 && coordinate <= n {
            return coordinate;
        }
        if self.periodic() { coordinate.rem_euclid(n).min(n) } else { coordinate.clamp(0.0, n) }
    }

    /// The boxes that hold positions and the parts of them below the positions. Notes in `inside` which positions have
    /// a box before and `above` boxes after theirs; of the others nothing is said.
    #[inline(always)]
    pub fn boxes(&self, positions: &[f64; SIDE], above: f64, inside: &mut [bool; SIDE]) -> ([i32; SIDE], [f64; SIDE]) {
        // Boxes are counted in 32 bits, which every processor does side by side.
        let limit = (self.size - above).min(f64::from(i32::MAX));
        let (mut boxes, mut parts) = ([0; SIDE], [0.0; SIDE]);
        for l in 0..SIDE {
            let coordinate = (positions[l] - self.origin) * self.inverse;
            // Not written as its contrary, so that a position that is not a number is not inside.
            let fine = (coordinate >= 1.0) & (coordinate < limit);
            inside[l] &= fine;
            let coordinate = if coordinate >= 1.0 { coordinate } else { 1.0 };
            let coordinate = if coordinate < limit { coordinate } else { 1.0 };
            // SAFETY: at least 1, even if it was not a number, and at most the largest number of 32 bits.
            boxes[l] = unsafe { coordinate.to_int_unchecked() };
            parts[l] = coordinate - f64::from(boxes[l]);
        }
        (boxes, parts)
    }

    /// The two boxes that share what is released, and the part of the second.
    #[inline(always)]
    pub fn pair(&self, position: f64) -> ([usize; 2], f64) {
        if self.n == 1 {
            return ([0, 0], 0.0);
        }
        let (shifted, n) = ((position + self.half - self.origin) * self.inverse, self.n as f64);
        let shifted = match self.periodic() {
            _ if shifted >= 0.5 && shifted <= n + 0.5 => shifted,
            true => (shifted - 0.5).rem_euclid(n).min(n) + 0.5,
            false => shifted.clamp(0.5, n + 0.5),
        };
        let high = shifted as usize;
        let part = shifted - high as f64;
        let (first, last) = if self.periodic() { (self.n - 1, 0) } else { (0, self.n - 1) };
        // What would lie beyond a wall is folded back into the box at the wall.
        ([if high == 0 { first } else { high - 1 }, if high >= self.n { last } else { high }], part)
    }
}
