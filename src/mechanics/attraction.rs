//! A linear pull of every atom to a point, a stand-in for a diffusing attractant: `F = k (c − X)`, eq. (attraction.1).

use super::lanes::{Real, V3, Vectors, VectorsMut};
use super::stiffness::StiffnessMatrix;
use crate::Vec3;

/// The attraction of a cell's atoms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attraction {
    /// The point c, µm.
    pub to: Vec3,
    /// Stiffness k an atom, pN/µm.
    pub stiffness: f64,
}

impl Attraction {
    /// Adds the force on every atom and returns the energy, pN·µm.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let mut energy = T::constant(x.token, 0.0);
        let to = V3::constant(x.token, self.to.into());
        for atom in 0..x.atoms() {
            let away = x.get(atom) - to;
            let pull = away.scaled(self.stiffness);
            f.sub(atom, pull);
            energy += pull.dot(away) * 0.5;
        }
        energy
    }

    /// Adds the stiffness of every atom.
    pub fn add_stiffness(&self, matrix: &mut StiffnessMatrix) {
        (0..matrix.atoms()).for_each(|atom| matrix.add(atom, atom, self.stiffness));
    }
}
