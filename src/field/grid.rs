//! The grid of a field: a plane of squares under the cells, or boxes that fill the medium, and what its walls do.

use crate::Vec3;
use crate::error::{Error, Fault, Result, short};

/// Boxes of one size, on which all species of a field have one value each, that of the box's centre. The boxes lie
/// in memory with x running fastest, then y, then z.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Number of boxes along x, y and z. One box along z makes a field of the substrate, an amount per area.
    pub cells: [usize; 3],
    /// Size of a box along each axis, µm. On a line the boxes are 1 µm wide and high, so that their measure is their length.
    pub spacing: [f64; 3],
    /// The corner of the first box, µm.
    pub origin: Vec3,
}

/// What a wall of the field does to a species.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wall {
    /// Nothing passes.
    NoFlux,
    /// The value at the wall is held, as by a large stirred bath behind it.
    Fixed(f64),
    /// What leaves here enters at the opposite wall.
    Periodic,
}

/// The walls of the two sides, low and high, of each axis.
pub type Walls = [[Wall; 2]; 3];

/// Fewest boxes along an axis that has more than one: sensing interpolates over four.
pub const FEWEST: usize = 4;

impl Grid {
    /// A grid of equal boxes.
    ///
    /// # Errors
    /// An axis without boxes or with 2 or 3 of them, more boxes than memory can count, a spacing that is not positive
    /// and finite, an origin that is not finite.
    pub fn new(cells: [usize; 3], spacing: [f64; 3], origin: Vec3) -> Result<Self> {
        let mut faults = Vec::new();
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let (n, h) = (cells[axis], spacing[axis]);
            if n == 0 || (n > 1 && n < FEWEST) {
                let help = format!("give 1 box, for a field that does not vary along {name}, or at least {FEWEST}");
                faults.push(Fault::new(format!("the grid has {n} boxes along {name}")).help(help));
            }
            if !(h.is_finite() && h > 0.0) {
                let help = "give a positive length, µm";
                faults.push(Fault::new(format!("the grid's spacing along {name} is {h}")).help(help));
            }
            if !origin[axis].is_finite() {
                let help = "give a finite position, µm";
                faults.push(Fault::new(format!("the grid's origin along {name} is {}", origin[axis])).help(help));
            }
        }
        let count = cells.iter().try_fold(1_usize, |product, n| product.checked_mul(*n));
        if count.is_none_or(|count| count > (isize::MAX as usize) / 64) {
            let help = "choose a wider spacing or a smaller region";
            faults.push(Fault::new(format!("a grid of {cells:?} boxes is larger than any memory")).help(help));
        }
        if faults.is_empty() { Ok(Self { cells, spacing, origin }) } else { Err(Error::Input(faults)) }
    }

    /// Number of boxes.
    pub fn len(&self) -> usize {
        self.cells.iter().product()
    }

    /// Whether there is no box, which no grid made by [`Grid::new`] is.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether the field lies on the substrate: it has one box along z, and its values are amounts per area.
    pub fn is_flat(&self) -> bool {
        self.cells[2] == 1
    }

    /// The axes along which there are several boxes, from x on: 1 (a line), 2 or 3.
    pub fn dimension(&self) -> usize {
        self.cells.iter().rposition(|n| *n > 1).map_or(1, |axis| axis + 1)
    }

    /// What an amount is divided by to be a value: the area of a box, µm², of a flat field, else its volume, µm³.
    pub fn measure(&self) -> f64 {
        let area = self.spacing[0] * self.spacing[1];
        if self.is_flat() { area } else { area * self.spacing[2] }
    }

    /// Index in memory of box (x, y, z).
    pub fn at(&self, x: usize, y: usize, z: usize) -> usize {
        (z * self.cells[1] + y) * self.cells[0] + x
    }

    /// The centre of a box, µm, as messages tell it: `(1.5, 2.5)`.
    pub(super) fn told(&self, at: usize) -> String {
        let centre = self.centre(at);
        let numbers: Vec<String> = centre.iter().take(self.dimension()).map(|n| short(*n).to_string()).collect();
        format!("({})", numbers.join(", "))
    }

    /// Centre of the box at an index in memory, µm.
    pub fn centre(&self, at: usize) -> Vec3 {
        let [nx, ny, _] = self.cells;
        let index = [at % nx, at / nx % ny, at / (nx * ny)];
        self.origin + Vec3::from_fn(|axis, _| (index[axis] as f64 + 0.5) * self.spacing[axis])
    }
}
