//! Weight: the same acceleration of every atom, `F = m g`, eq. (gravity.1).

use super::lanes::{Real, V3, Vectors, VectorsMut};
use crate::Vec3;

/// The weight of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gravity {
    /// Acceleration g, µm/s².
    pub acceleration: Vec3,
}

impl Gravity {
    /// Adds the weight of every atom of this mass (pN·s²/µm) and returns the energy, pN·µm, 0 at the origin.
    #[inline(always)]
    pub fn add_forces<T: Real>(&self, mass: T, x: &Vectors<T>, f: &mut VectorsMut<T>) -> T {
        let mut energy = T::constant(x.token, 0.0);
        let weight = V3::constant(x.token, self.acceleration.into()).times(mass);
        for atom in 0..x.atoms() {
            f.add(atom, weight);
            energy += -weight.dot(x.get(atom));
        }
        energy
    }
}
