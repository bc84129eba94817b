//! The constant linear part of the elastic forces of a mesh, the same along x, y and z, as a sparse matrix.

use std::collections::BTreeMap;

/// A symmetric N × N matrix in pN/µm; every force adds its share, positive where it resists.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StiffnessMatrix {
    rows: Vec<BTreeMap<u32, f64>>,
}

impl StiffnessMatrix {
    /// The null matrix for `atoms` atoms.
    pub fn new(atoms: usize) -> Self {
        Self { rows: vec![BTreeMap::new(); atoms] }
    }
    /// Number of atoms.
    pub fn atoms(&self) -> usize {
        self.rows.len()
    }
    /// Adds to the entry (i, j).
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        *self.rows[i].entry(j as u32).or_insert(0.0) += value;
    }
    /// Adds a spring between two atoms that resists their relative motion in every direction.
    pub fn add_spring(&mut self, i: usize, j: usize, stiffness: f64) {
        self.add(i, i, stiffness);
        self.add(j, j, stiffness);
        self.add(i, j, -stiffness);
        self.add(j, i, -stiffness);
    }
    /// The entry on the diagonal.
    pub fn diagonal(&self, i: usize) -> f64 {
        self.rows[i].get(&(i as u32)).copied().unwrap_or(0.0)
    }
    /// Multiplies all entries.
    pub fn scale(&mut self, factor: f64) {
        self.rows.iter_mut().flat_map(BTreeMap::values_mut).for_each(|value| *value *= factor);
    }
    /// The entries of a row, by column.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.rows[i].iter().map(|(&j, &value)| (j as usize, value))
    }
    /// An upper bound of the largest eigenvalue, pN/µm (Gershgorin).
    pub fn largest(&self) -> f64 {
        self.rows.iter().map(|row| row.values().map(|v| v.abs()).sum::<f64>()).fold(0.0, f64::max)
    }
}
