//! Plain penalty contact, to compare with: a spring against the depth and a pull within the proximity, and no solver.

use crate::Vec3;
use crate::sim::contact::rows::Row;

/// What a contact pushes and pulls with, eq. (adhesion.12).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Penalty {
    /// Push over depth, pN/µm.
    pub stiffness: f64,
    /// Gap up to which contacts pull, µm.
    pub range: f64,
}

impl Penalty {
    /// Force of a contact that pulls `most` (pN) at most, positive where it pushes, and its energy (pN·µm), at a gap (µm).
    pub fn at(&self, gap: f64, most: f64) -> (f64, f64) {
        let deepest = -2.0 / 3.0 * most * self.range;
        let share = gap / self.range;
        if gap < 0.0 {
            (-self.stiffness * gap, 0.5 * self.stiffness * gap * gap + deepest)
        } else if share < 1.0 {
            let energy = 4.0 * most * self.range * share * share * (0.5 - share / 3.0);
            (-4.0 * most * share * (1.0 - share), energy + deepest)
        } else {
            (0.0, 0.0)
        }
    }

    /// Adds the forces of contacts that were found at `start` where the atoms are now, and returns their energy, pN·µm. Normals and
    /// weights stay those of the start.
    pub fn add_forces(&self, rows: &[Row], start: &[Vec3], positions: &[Vec3], force: &mut [Vec3]) -> f64 {
        self.act(rows, (start, positions), force, |_, _| {})
    }

    /// As [`add_forces`](Self::add_forces), telling each row and the force on its first side.
    pub(in crate::sim::contact) fn act(
        &self,
        rows: &[Row],
        (start, positions): (&[Vec3], &[Vec3]),
        force: &mut [Vec3],
        mut tell: impl FnMut(&Row, Vec3),
    ) -> f64 {
        let mut energy = 0.0;
        for row in rows {
            let sides = || row.atoms.map(|atom| atom as usize).into_iter().zip(row.weights());
            let apart: Vec3 = sides().map(|(atom, weight)| weight * (positions[atom] - start[atom])).sum();
            let normal = row.normal();
            let (push, stored) = self.at(row.gap() + normal.dot(&apart), -f64::from(row.least));
            sides().for_each(|(atom, weight)| force[atom] += weight * push * normal);
            tell(row, push * normal);
            energy += stored;
        }
        energy
    }
}
