//! The adhesives of a step, from those before and what touches; and which of their atoms they keep.

use super::recruit::{Glue, reset, root};
use super::rigid::Rigid;
use super::scratch::{AdhesiveScratch, NONE, Role};
use super::table::AdhesiveTable;
use crate::Vec3;
use crate::contact::{Contacts, Scene};
use crate::sim::contact::rows::{Pairing, Pull, Row};
use crate::sim::contact::state::{AdhesiveAtom, ContactState};
use crate::sim::controls::Controls;
use crate::sim::kind::Kind;

impl AdhesiveScratch {
    /// No adhesives.
    pub(in crate::sim::contact) fn clear(&mut self) {
        self.atoms.clear();
        self.bodies.clear();
    }

    /// Finds the adhesives of a step: those before, with what touches now.
    pub(in crate::sim::contact) fn find(
        &mut self,
        table: &AdhesiveTable,
        scene: &Scene,
        kinds: &[Kind],
        controls: &Controls,
        before: &ContactState,
        found: &Contacts,
        positions: &[Vec3],
        time: f64,
    ) {
        self.clear();
        let glue = Glue { scene, table, controls };
        self.clone_atoms(&glue, before, found);
        self.join(&glue, before, found);
        self.list(before, time);
        self.make_bodies(scene, kinds, positions);
    }

    /// Lists adhesives of two atoms and more; one on an obstacle may have a single one.
    fn list(&mut self, before: &ContactState, time: f64) {
        reset(&mut self.number, self.roles.len(), NONE);
        for (number, old) in (0..).zip(&before.adhesives) {
            self.number[old.atom as usize] = number;
        }
        for atom in 0..self.roles.len() as u32 {
            if self.roles[atom as usize] == Role::Cloned {
                let adhesive = root(&mut self.parent, atom);
                let old = before.adhesives.get(self.number[atom as usize] as usize);
                let (since, force) = old.map_or((time, [0.0; 3]), |old| (old.since, old.force));
                self.atoms.push(AdhesiveAtom { adhesive, atom, since, force });
            }
        }
        self.atoms.sort_unstable_by_key(|one| (one.adhesive, one.atom));
        keep_living(&mut self.atoms, |atom| self.grounded[atom as usize]);
        self.number.fill(NONE);
        for (number, one) in (0..).zip(&self.atoms) {
            self.number[one.atom as usize] = number;
        }
    }

    /// The adhesives as rigid bodies that resist as the drag of their atoms does, and carried forces without sum and torque.
    fn make_bodies(&mut self, scene: &Scene, kinds: &[Kind], positions: &[Vec3]) {
        self.drags.clear();
        for one in &self.atoms {
            let body = scene.bodies[scene.body_of_atom(one.atom) as usize];
            let (kind, atom) = (&kinds[body.shape as usize], (one.atom - body.first_atom) as usize);
            let held = kind.held.get(3 * atom..3 * atom + 3).is_some_and(|axes| axes == [0.0; 3]);
            self.drags.push(if held { f64::INFINITY } else { kind.drag });
        }
        let mut first = 0;
        for adhesive in self.atoms.chunk_by(|one, other| one.adhesive == other.adhesive) {
            let range = first..first + adhesive.len();
            let grounded = adhesive.iter().any(|one| self.grounded[one.atom as usize]);
            let own = adhesive.iter().map(|one| positions[one.atom as usize]);
            self.bodies.push(Rigid::of(range.clone(), &mut self.drags[range.clone()], own, grounded));
            first = range.end;
        }
    }

    /// Hands what contacts between atoms of one adhesive carried over to it, and takes these contacts out of the sweeps: where
    /// nothing moves against each other there is nothing to keep apart.
    pub(in crate::sim::contact) fn take_over(&mut self, rows: &mut [Row], pulls: &mut [Pull], positions: &[Vec3]) {
        if self.atoms.is_empty() {
            return;
        }
        for (row, pull) in rows.iter_mut().zip(pulls) {
            let numbers = row.atoms.map(|atom| self.number[atom as usize]);
            let adhesive = |number: u32| self.atoms.get(number as usize).map(|one| one.adhesive);
            let first = adhesive(numbers[0]);
            let weights = row.weights();
            let real = |i: usize| weights[i] != 0.0;
            let on_obstacle = row.pairing == Pairing::AtomOnObstacle;
            let grounded = !on_obstacle || self.grounded[row.atoms[0] as usize];
            if first.is_none() || !grounded || (0..4).any(|i| real(i) && adhesive(numbers[i]) != first) {
                continue;
            }
            for i in (0..4).filter(|i| real(*i)) {
                let force = &mut self.atoms[numbers[i] as usize].force;
                let carried = weights[i] * pull.carried();
                (0..3).for_each(|axis| force[axis] += carried[axis]);
            }
            row.pairing = Pairing::Rigid;
            *pull = Pull::default();
        }
        for body in &self.bodies {
            body.balance(&mut self.atoms[body.range()], &self.drags[body.range()], positions);
        }
    }

    /// Keeps the adhesives for the next step without the atoms that they lose, eq. (adhesion.15); `moved` has displacement over
    /// force of all atoms as its fourth number.
    pub(in crate::sim::contact) fn keep(
        &mut self,
        table: &AdhesiveTable,
        scene: &Scene,
        controls: &Controls,
        found: &Contacts,
        moved: &[[f64; 4]],
        kept: &mut ContactState,
    ) {
        let glue = Glue { scene, table, controls };
        for (one, force) in self.atoms.iter_mut().zip(&self.forces) {
            one.force = (*force).into();
        }
        let mut part = |atom: u32, out: Vec3| {
            let Some(one) = self.atoms.get(self.number[atom as usize] as usize) else { return };
            // What it would have moved alone, less what it moved.
            let free = -moved[atom as usize][3] * Vec3::from(one.force);
            if free.dot(&out) > 0.0 && free.norm() > self.kappa[atom as usize] {
                self.roles[atom as usize] = Role::Released;
            }
        };
        for near in found.atoms.iter().filter(|near| glue.kappa_of(near).1 > 0.0) {
            let [atom, facet @ ..] = glue.corners(near);
            part(atom, near.normal.wide());
            facet.into_iter().for_each(|atom| part(atom, -near.normal.wide()));
        }
        for near in &found.obstacles {
            if glue.kappa_on(near) > 0.0 {
                part(near.atom, near.normal.wide());
            }
        }
        let roles = &self.roles;
        kept.released.extend((0..).zip(roles).filter(|(_, role)| **role == Role::Released).map(|(atom, _)| atom));
        kept.adhesives.extend(self.atoms.iter().filter(|one| roles[one.atom as usize] == Role::Cloned));
        keep_living(&mut kept.adhesives, |atom| self.grounded[atom as usize]);
    }
}

/// Takes out adhesives of fewer than two atoms, but for those on an obstacle, and names the others by their least atom.
fn keep_living(atoms: &mut Vec<AdhesiveAtom>, grounded: impl Fn(u32) -> bool) {
    let (mut from, mut to) = (0, 0);
    while from < atoms.len() {
        let count = atoms[from..].iter().take_while(|one| one.adhesive == atoms[from].adhesive).count();
        if count > 1 || grounded(atoms[from].atom) {
            let adhesive = atoms[from].atom;
            for one in from..from + count {
                atoms[to] = AdhesiveAtom { adhesive, ..atoms[one] };
                to += 1;
            }
        }
        from += count;
    }
    atoms.truncate(to);
    atoms.sort_unstable_by_key(|one| (one.adhesive, one.atom));
}
