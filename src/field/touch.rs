//! What cells do to a field: release amounts into it, and sense its value and gradient.

use pulp::Arch;

use super::axis::Axis;
use super::release::ReleaseAll;
use super::sense::SenseAll;
use super::sensed::Sensed;
use super::state::Fields;
use super::turn::Turner;
use crate::Vec3;
use crate::equations::Range;

impl Fields {
    /// Releases an amount of a species at a position, into the boxes around it, eq. (field.8). A position beyond a
    /// wall counts as at the wall. A negative amount is taken up, of a concentration at most what is there. Returns
    /// the amount that the field gained; 0 if the position or the amount is not finite.
    ///
    /// # Panics
    /// If there is no such species.
    pub fn deposit(&mut self, species: usize, position: Vec3, amount: f64) -> f64 {
        self.deposit_all(species, &[position], &[amount])
    }

    /// Releases amounts at positions, one after the other; see [`Fields::deposit`]. Returns the sum of what the field
    /// gained. Allocates nothing.
    ///
    /// # Panics
    /// If there is no such species, or not one amount for each position.
    pub fn deposit_all(&mut self, species: usize, positions: &[Vec3], amounts: &[f64]) -> f64 {
        assert_eq!(positions.len(), amounts.len(), "an amount for each position");
        let (len, measure) = (self.grid.len(), self.grid.measure());
        let axes = Axis::all(&self.grid, &self.species[species]);
        let limited = self.species[species].range == Range::NonNegative;
        let values = &mut self.values[species * len..(species + 1) * len];
        Arch::new().dispatch(ReleaseAll { axes, values, limited, measure, positions, amounts })
    }

    /// Value and gradient of a species at a position, second order. Beyond a wall they are those at the wall.
    ///
    /// # Panics
    /// If there is no such species.
    pub fn sense(&self, species: usize, position: Vec3) -> Sensed {
        let mut out = [Sensed::default()];
        self.sense_all(species, &[position], &mut out);
        out[0]
    }

    /// Values and gradients of a species at positions; see [`Fields::sense`]. Allocates nothing.
    ///
    /// # Panics
    /// If there is no such species, or not one slot for each position.
    pub fn sense_all(&self, species: usize, positions: &[Vec3], out: &mut [Sensed]) {
        assert_eq!(positions.len(), out.len(), "a slot for each position");
        let axes = Axis::all(&self.grid, &self.species[species]);
        let values = self.values(species);
        let floor = if self.species[species].range == Range::NonNegative { 0.0 } else { f64::NEG_INFINITY };
        Arch::new().dispatch(SenseAll { axes, values, floor, positions, out, turner: Turner::new() });
    }
}
