//! Plain penalty contact, to compare with: a spring against the depth and a pull within the proximity, and no solver.

use super::law::Penalty;
use super::rows::Row;
use crate::Vec3;

/// Adds the forces of contacts that were found at `start` where the atoms are now, and returns their energy, pN·µm. Normals and
/// weights stay those of the start.
pub fn press(penalty: &Penalty, rows: &[Row], start: &[Vec3], positions: &[Vec3], force: &mut [Vec3]) -> f64 {
    let mut energy = 0.0;
    for row in rows {
        let sides = || row.atoms.map(|atom| atom as usize).into_iter().zip(row.weights());
        let apart: Vec3 = sides().map(|(atom, weight)| weight * (positions[atom] - start[atom])).sum();
        let normal = row.normal();
        let (push, stored) = penalty.at(row.gap() + normal.dot(&apart), -f64::from(row.least));
        sides().for_each(|(atom, weight)| force[atom] += weight * push * normal);
        energy += stored;
    }
    energy
}
