//! Cells come and go between steps: what chemistry knows of each comes and goes with it, and stands in the order of the cells.

use super::super::controls::Controls;
use super::super::kind::Kind;
use super::super::model::Model;
use super::model::Members;
use super::state::{ChemistryState, admit_atoms, draw_start};
use crate::Vec3;
use crate::cell::pseudopods::Told;
use crate::mechanics::CONTROLLED;

impl ChemistryState {
    /// A cell comes: every system of its kind gets a member at the system's start, and no link has set anything of it. It stands before
    /// the cell with the number `local` among those of its kind, and has an id, by which starts are drawn; `cells` says how many each kind has without it.
    ///
    /// # Panics
    /// When there is no such kind, or it has fewer cells.
    pub fn insert_cell(&mut self, model: &Model, cells: &[usize], (kind, local): (usize, usize), id: u64) {
        let chemistry = &model.chemistry;
        assert!(local <= cells[kind], "before cell {local} of {}", cells[kind]);
        for (number, reactor) in chemistry.reactors.iter().enumerate() {
            let Members::Kinds(kinds) = &reactor.members else { continue };
            let Some(at) = kinds.iter().position(|&other| other == kind) else { continue };
            let member = kinds[..at].iter().map(|&kind| cells[kind]).sum::<usize>() + local;
            self.populations[number].insert_default(&reactor.program, member);
            draw_start(model.seed, reactor, &mut self.populations[number], member, id);
            if reactor.membrane.is_some() {
                self.membranes[number].kinds[at].insert(local);
            }
            if !reactor.events.is_empty() {
                self.events[number].insert(member, reactor.events.before_start(self.times[number] / reactor.seconds));
            }
        }
        self.controls.insert_cell(cells[..kind].iter().sum::<usize>() + local);
        self.controls
            .insert_forces(first_atom(model, cells, kind) + local * model.kinds[kind].atoms(), &model.kinds[kind]);
        // Where there was no cell before, lists that links write were as empty as those that none does.
        let all = cells.iter().sum::<usize>() + 1;
        chemistry
            .links
            .iter()
            .filter_map(|link| link.to.control())
            .for_each(|control| self.controls.admit(control, all));
        if let Some(of_atoms) = self.controls.of_atoms.get_mut(kind) {
            of_atoms.insert_cell(model.kinds[kind].atoms(), local);
            let counts: Vec<usize> = cells.iter().enumerate().map(|(at, &n)| n + usize::from(at == kind)).collect();
            admit_atoms(model, &counts, &mut self.controls);
        }
    }

    /// Cells go: those of which `keep` (of a kind, and a number among its cells) says no. `cells` says how many each kind has before.
    pub fn retain_cells(&mut self, model: &Model, cells: &[usize], keep: impl Fn(usize, usize) -> bool) {
        let all = |kind: usize| (0..cells[kind]).map(move |local| (kind, local));
        for (number, reactor) in model.chemistry.reactors.iter().enumerate() {
            let Members::Kinds(kinds) = &reactor.members else { continue };
            let stays: Vec<bool> = kinds.iter().flat_map(|&kind| all(kind)).map(|(kind, at)| keep(kind, at)).collect();
            self.populations[number].retain(|member| stays[member]);
            retain(&mut self.events[number], &stays);
            for (surfaces, &kind) in self.membranes[number].kinds.iter_mut().zip(kinds) {
                surfaces.retain(|local| keep(kind, local));
            }
        }
        let stays: Vec<bool> = (0..cells.len()).flat_map(all).map(|(kind, at)| keep(kind, at)).collect();
        self.controls.retain_cells(&stays);
        let of_cells = (0..cells.len()).flat_map(|kind| std::iter::repeat_n(model.kinds[kind].atoms(), cells[kind]));
        let atoms: Vec<bool> =
            of_cells.zip(&stays).flat_map(|(atoms, stays)| std::iter::repeat_n(*stays, atoms)).collect();
        let forces = &mut self.controls.atom_forces;
        retain(forces, &atoms);
        if forces.iter().all(|force| *force == Vec3::zeros()) {
            forces.clear();
        }
        for (number, (of_atoms, kind)) in self.controls.of_atoms.iter_mut().zip(&model.kinds).enumerate() {
            of_atoms.retain_cells(kind.atoms(), |local| keep(number, local));
        }
    }
}

impl Controls {
    /// Adds a cell to all lists that are there, with numbers that change nothing.
    fn insert_cell(&mut self, at: usize) {
        for (list, nothing) in [(&mut self.speed, f64::NAN), (&mut self.stiffness, 1.0), (&mut self.adhesion, 1.0)] {
            if !list.is_empty() {
                list.insert(at, nothing);
            }
        }
        if !self.bias.is_empty() {
            self.bias.insert(at, [0.0; 3]);
        }
        if !self.pseudopods.is_empty() {
            self.pseudopods.insert(at, Told::NOTHING);
        }
        for (lists, handle) in self.forces.iter_mut().zip(CONTROLLED) {
            lists.iter_mut().for_each(|list| list.insert(at, handle.unset));
        }
        self.secretion.iter_mut().for_each(|list| list.insert(at, 0.0));
    }

    /// Adds the atoms of a cell of a kind before the one with this number, on which a program exerts nothing.
    fn insert_forces(&mut self, at: usize, kind: &Kind) {
        if !self.atom_forces.is_empty() {
            self.atom_forces.splice(at..at, std::iter::repeat_n(Vec3::zeros(), kind.atoms()));
        }
    }

    fn retain_cells(&mut self, stays: &[bool]) {
        let single = [&mut self.speed, &mut self.stiffness, &mut self.adhesion];
        let many = self.forces.iter_mut().flatten().chain(&mut self.secretion);
        single.into_iter().chain(many).for_each(|list| retain(list, stays));
        retain(&mut self.bias, stays);
        retain(&mut self.pseudopods, stays);
    }
}

/// The number of the first atom of a kind, with so many cells of each.
fn first_atom(model: &Model, cells: &[usize], kind: usize) -> usize {
    model.kinds.iter().zip(cells).take(kind).map(|(kind, cells)| cells * kind.atoms()).sum()
}

/// Keeps what stays of a list with one thing a cell, or an atom; an empty one stays so.
fn retain<T>(list: &mut Vec<T>, stays: &[bool]) {
    let mut stays = stays.iter();
    list.retain(|_| stays.next().copied().unwrap_or(false));
}
