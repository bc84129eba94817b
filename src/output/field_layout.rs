//! The grid of a field and its species: how the values of a frame are to be read.

use serde::{Deserialize, Serialize};

/// A grid of equal boxes and the species that have a value in each.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FieldLayout {
    /// Name of the field's document, and of its group in the file.
    pub name: String,
    /// Names and units of the species.
    pub species: Vec<(String, String)>,
    /// Number of boxes along x, y and z; one along z for a field of the substrate.
    pub cells: [usize; 3],
    /// Size of a box along each axis, µm.
    pub spacing: [f64; 3],
    /// The corner of the first box, µm.
    pub origin: [f64; 3],
}

/// An axis of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// The first axis.
    X,
    /// The second axis.
    Y,
    /// The third axis.
    Z,
}

impl Along {
    /// Its number: 0, 1 or 2.
    pub fn number(self) -> usize {
        self as usize
    }

    /// Its letter.
    pub fn letter(self) -> &'static str {
        ["x", "y", "z"][self.number()]
    }
}

impl FieldLayout {
    /// Number of boxes.
    pub fn len(&self) -> usize {
        self.cells.iter().product()
    }

    /// Whether there is no box.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether the field lies on the substrate: one box along z.
    pub fn is_flat(&self) -> bool {
        self.cells[2] == 1
    }

    /// Centre of a row of boxes along an axis, µm.
    pub fn centre(&self, along: Along, index: usize) -> f64 {
        let axis = along.number();
        self.origin[axis] + (index as f64 + 0.5) * self.spacing[axis]
    }

    /// The row of boxes along an axis that a position (µm) falls into; the first or last for positions outside.
    pub fn nearest(&self, along: Along, position: f64) -> usize {
        let axis = along.number();
        let box_of = ((position - self.origin[axis]) / self.spacing[axis]).floor();
        // Saturates: positions below the first box give 0.
        (box_of as usize).min(self.cells[axis].saturating_sub(1))
    }

    /// The number of a species.
    pub fn species_number(&self, name: &str) -> Option<usize> {
        self.species.iter().position(|(known, _)| known == name)
    }

    /// The values of a frame along an axis: through a point (µm), or the mean over all other boxes if there is none.
    ///
    /// # Panics
    /// If there is not one value for each box.
    pub fn profile(&self, values: &[f64], along: Along, through: Option<[f64; 3]>) -> Vec<f64> {
        assert_eq!(values.len(), self.len(), "one value for each box of {}", self.name);
        let (axis, [nx, ny, _]) = (along.number(), self.cells);
        let index = |at: usize| [at % nx, at / nx % ny, at / (nx * ny)];
        let fixed = through
            .map(|position| [Along::X, Along::Y, Along::Z].map(|other| self.nearest(other, position[other.number()])));
        let (mut sums, mut counts) = (vec![0.0; self.cells[axis]], vec![0_u32; self.cells[axis]]);
        for (at, value) in values.iter().enumerate() {
            let position = index(at);
            if fixed.is_none_or(|fixed| (0..3).all(|other| other == axis || position[other] == fixed[other])) {
                sums[position[axis]] += value;
                counts[position[axis]] += 1;
            }
        }
        sums.iter().zip(&counts).map(|(sum, count)| sum / f64::from(*count)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> FieldLayout {
        FieldLayout { cells: [3, 2, 1], spacing: [2.0, 5.0, 1.0], origin: [-1.0, 0.0, 0.0], ..FieldLayout::default() }
    }

    #[test]
    fn a_profile_goes_through_a_point_or_is_the_mean() {
        let values = [1.0, 2.0, 3.0, 5.0, 6.0, 10.0];
        assert_eq!(grid().profile(&values, Along::X, Some([0.0, 7.0, 0.0])), [5.0, 6.0, 10.0]);
        assert_eq!(grid().profile(&values, Along::X, None), [3.0, 4.0, 6.5]);
        assert_eq!(grid().profile(&values, Along::Y, Some([100.0, 0.0, 0.0])), [3.0, 10.0]);
        assert_eq!(grid().centre(Along::X, 1), 2.0);
    }
}
