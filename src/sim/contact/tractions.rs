//! What cells do to obstacles and to each other in a step, atom by atom: noted where contacts find it, if somebody asks.

use super::rows::{Pairing, Row};
use crate::Vec3;
use crate::contact::Scene;

/// Forces of cells on what they touch, in the mean over a step, pN, in the order of atoms; empty where nobody asks.
#[derive(Debug, Clone, Default)]
pub struct ContactTractions {
    /// On obstacles.
    pub on_obstacles: Vec<Vec3>,
    /// On other cells.
    pub on_cells: Vec<Vec3>,
    /// What of the step the stage counts for which forces are noted now.
    share: f64,
}

impl ContactTractions {
    /// Begins an attempt in which nothing was noted.
    pub fn begin(&mut self, atoms: usize) {
        for list in [&mut self.on_obstacles, &mut self.on_cells] {
            list.clear();
            list.resize(atoms, Vec3::zeros());
        }
    }

    /// Nobody asks.
    pub fn end(&mut self) {
        self.on_obstacles.clear();
        self.on_cells.clear();
    }

    /// Notes from now on what counts so much of the step. Returns itself if there is something to note.
    pub(super) fn counting(&mut self, share: f64) -> Option<&mut Self> {
        self.share = share;
        (share > 0.0 && !self.on_obstacles.is_empty()).then_some(self)
    }

    /// Notes a force of an obstacle on an atom, pN.
    pub(super) fn by_obstacle(&mut self, atom: u32, force: Vec3) {
        self.on_obstacles[atom as usize] -= self.share * force;
    }

    /// Notes a force of another cell on an atom, pN.
    pub(super) fn by_cell(&mut self, atom: u32, force: Vec3) {
        self.on_cells[atom as usize] -= self.share * force;
    }

    /// Notes what a row does with a force on its first side, pN. What a cell does to itself is not noted.
    pub(super) fn by_row(&mut self, scene: &Scene, row: &Row, force: Vec3) {
        if force == Vec3::zeros() {
            return;
        }
        match row.pairing {
            Pairing::AtomOnObstacle => self.by_obstacle(row.atoms[0], force),
            Pairing::AtomOnFacet | Pairing::Edges => {
                if scene.body_of_atom(row.atoms[0]) != scene.body_of_atom(row.atoms[3]) {
                    row.atoms.iter().zip(row.weights()).for_each(|(atom, weight)| self.by_cell(*atom, weight * force));
                }
            }
            Pairing::Rigid => {}
        }
    }

    /// Writes NaN over all numbers.
    pub(super) fn poison(&mut self) {
        for list in [&mut self.on_obstacles, &mut self.on_cells] {
            list.fill(Vec3::repeat(f64::NAN));
        }
    }
}
