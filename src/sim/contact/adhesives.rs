//! Virtual adhesives as the sweeps move them: atoms that go as one.

use super::rigid::{Rigid, vector};
use super::state::AdhesiveAtom;
use super::sweep::{Change, V4};
use crate::Vec3;
use nalgebra::Rotation3;

/// No number.
pub(super) const NONE: u32 = u32::MAX;

/// What an atom is in a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// It touches nothing that sticks.
    Far,
    /// It touches, but was released and not pressed since.
    Released,
    /// It has a clone.
    Cloned,
}

/// The adhesives of a step, and what is needed to find them; empty under other laws.
#[derive(Debug, Clone, Default)]
pub struct AdhesiveScratch {
    /// Their atoms, adhesive by adhesive, with the forces that they carried where the step began.
    pub atoms: Vec<AdhesiveAtom>,
    /// The adhesives as rigid bodies.
    pub(super) bodies: Vec<Rigid>,
    /// Drag of each of their atoms, pN·s/µm.
    pub(super) drags: Vec<f64>,
    /// Force on each now, pN.
    pub(super) forces: Vec<Vec3>,
    /// What the last sweep changed of it.
    pub(super) changes: Vec<Vec3>,
    /// The direction that speeds the sweeps up.
    pub(super) ways: Vec<Vec3>,
    /// For all atoms: where they stand in `atoms`, or `NONE`.
    pub(super) place: Vec<u32>,
    pub(super) roles: Vec<Role>,
    pub(super) kappa: Vec<f64>,
    /// An atom of the same adhesive; the least one in the end.
    pub(super) parent: Vec<u32>,
    /// The nearest two objects, and how near.
    pub(super) pair: Vec<([u32; 2], f64)>,
    /// Atoms that touch a plane that sticks.
    pub(super) grounded: Vec<bool>,
}

impl AdhesiveScratch {
    /// Begins sweeps with the forces that the adhesives carry.
    pub(super) fn begin(&mut self) {
        self.forces.clear();
        self.forces.extend(self.atoms.iter().map(|one| Vec3::from(one.force)));
        for list in [&mut self.changes, &mut self.ways] {
            list.clear();
            list.resize(self.atoms.len(), Vec3::zeros());
        }
    }

    /// One sweep: every adhesive moves as one, to first order; forces first go on along their last direction by `share`, as the
    /// displacements did.
    pub(super) fn sweep(&mut self, positions: &[Vec3], moved: &mut [V4], share: f64, change: &mut Change) {
        for body in &self.bodies {
            let (atoms, drags) = (&self.atoms[body.range()], &self.drags[body.range()]);
            let arm = |one: &AdhesiveAtom| positions[one.atom as usize] - body.centre;
            let now = atoms.iter().map(|one| (arm(one), vector(&moved[one.atom as usize])));
            let (shift, turn) = body.fit(&Rotation3::identity(), drags, now);
            for (number, one) in body.range().zip(atoms) {
                let slot = &mut moved[one.atom as usize];
                if slot[3] == 0.0 {
                    continue;
                }
                let way = shift + turn.cross(&arm(one)) - vector(slot);
                (0..3).for_each(|axis| slot[axis] += way[axis]);
                let step = way / slot[3];
                self.forces[number] += share * self.ways[number] + step;
                self.ways[number] = share * self.ways[number] + self.changes[number];
                self.changes[number] = step;
                change.largest = change.largest.max(way.norm());
                change.work += way.dot(&step);
            }
        }
    }

    /// Moves every adhesive as one without a change of its shape; returns the farthest that this took an atom, µm.
    pub(super) fn place_all(&self, positions: &[Vec3], moved: &mut [V4]) -> f64 {
        let place = |body: &Rigid| body.place(&self.atoms[body.range()], &self.drags[body.range()], positions, moved);
        self.bodies.iter().map(place).fold(0.0, f64::max)
    }

    /// Forgets everything.
    pub(super) fn poison(&mut self) {
        *self = Self::default();
    }
}
