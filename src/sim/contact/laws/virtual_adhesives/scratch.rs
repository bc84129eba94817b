//! Virtual adhesives as the sweeps move them: atoms that go as one.

use super::rigid::{Rigid, vector};
use crate::Vec3;
use crate::sim::contact::change::Change;
use crate::sim::contact::state::AdhesiveAtom;
use crate::sim::contact::tractions::ContactTractions;
use crate::sim::contact::vectors::V4;
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
    /// Forces on each that gave adhesives their shapes back, pN: they are not carried on.
    aligning: Vec<Vec3>,
    /// What the last sweep changed of it.
    pub(super) changes: Vec<Vec3>,
    /// The direction that speeds the sweeps up.
    pub(super) directions: Vec<Vec3>,
    /// For all atoms: their number in `atoms`, or `NONE`.
    pub(super) number: Vec<u32>,
    pub(super) roles: Vec<Role>,
    pub(super) kappa: Vec<f64>,
    /// An atom of the same adhesive; the least one in the end.
    pub(super) parent: Vec<u32>,
    /// The nearest two objects, and how near.
    pub(super) pair: Vec<([u32; 2], f64)>,
    /// Atoms that touch an obstacle that sticks.
    pub(super) grounded: Vec<bool>,
}

impl AdhesiveScratch {
    /// Begins sweeps with the forces that the adhesives carry.
    pub(in crate::sim) fn begin(&mut self) {
        self.forces.clear();
        self.forces.extend(self.atoms.iter().map(|one| Vec3::from(one.force)));
        for list in [&mut self.changes, &mut self.directions, &mut self.aligning] {
            list.clear();
            list.resize(self.atoms.len(), Vec3::zeros());
        }
    }

    /// One sweep: every adhesive moves as one, to first order; forces first go on along their last direction by `share`, as the
    /// displacements did.
    pub(in crate::sim::contact) fn sweep(
        &mut self,
        positions: &[Vec3],
        moved: &mut [V4],
        share: f64,
        change: &mut Change,
    ) {
        for body in &self.bodies {
            let (atoms, drags) = (&self.atoms[body.range()], &self.drags[body.range()]);
            let arm = |one: &AdhesiveAtom| positions[one.atom as usize] - body.centre;
            let now = atoms.iter().map(|one| (arm(one), vector(&moved[one.atom as usize])));
            let (shift, turn) = body.fit(&Rotation3::identity(), drags, now);
            for (number, one) in body.range().zip(atoms) {
                let moved = &mut moved[one.atom as usize];
                if moved[3] == 0.0 {
                    continue;
                }
                let further = shift + turn.cross(&arm(one)) - vector(moved);
                (0..3).for_each(|axis| moved[axis] += further[axis]);
                let step = further / moved[3];
                self.forces[number] += share * self.directions[number] + step;
                self.directions[number] = share * self.directions[number] + self.changes[number];
                self.changes[number] = step;
                change.largest = change.largest.max(further.norm());
                change.work += further.dot(&step);
            }
        }
    }

    /// Moves every adhesive as one without a change of its shape; returns the farthest that this took an atom, µm.
    pub(in crate::sim::contact) fn align(&mut self, positions: &[Vec3], moved: &mut [V4]) -> f64 {
        let Self { atoms, drags, bodies, aligning, .. } = self;
        let align = |body: &Rigid| {
            let own = body.range();
            body.align((&atoms[own.clone()], &drags[own.clone()]), positions, moved, &mut aligning[own])
        };
        bodies.iter().map(align).fold(0.0, f64::max)
    }

    /// Notes what cells do to adhesives in the attempt: to obstacles, where one holds the adhesive, else to the cells that are in it.
    pub(in crate::sim::contact) fn note(&self, noted: &mut ContactTractions) {
        for body in &self.bodies {
            for number in body.range() {
                let (atom, force) = (self.atoms[number].atom, self.forces[number] + self.aligning[number]);
                match body.is_grounded() {
                    true => noted.by_obstacle(atom, force),
                    false => noted.by_cell(atom, force),
                }
            }
        }
    }

    /// Forgets everything.
    pub(in crate::sim::contact) fn poison(&mut self) {
        *self = Self::default();
    }
}
