//! What chemistry sets of single atoms, for mechanics.

use serde::{Deserialize, Serialize};

use super::chemistry::AtomControl;

/// What links set of the atoms of the cells of a kind, cell after cell. A list that no link writes is empty.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct AtomControls {
    /// Pressure along the outward normal, pN/µm².
    pub protrusion: Vec<f64>,
    /// Tension of the surface, beside that of the type, pN/µm.
    pub tension: Vec<f64>,
    /// Factor of the moduli of the membrane.
    pub elasticity: Vec<f64>,
    /// Factor of the strength with which an atom sticks.
    pub adhesion: Vec<f64>,
    /// Amount released per second and µm², one list for each species that the model secretes.
    pub secretion: Vec<Vec<f64>>,
}

impl AtomControls {
    /// Makes the list that a control is written to as long as so many atoms need: numbers that change nothing until they are set.
    pub fn admit(&mut self, control: AtomControl, atoms: usize) {
        let is_factor = matches!(control, AtomControl::Elasticity | AtomControl::Adhesion);
        let nothing = if is_factor { 1.0 } else { 0.0 };
        self.list(control).resize(atoms, nothing);
    }

    /// The list that a control is written to.
    pub fn list(&mut self, control: AtomControl) -> &mut Vec<f64> {
        match control {
            AtomControl::Protrusion => &mut self.protrusion,
            AtomControl::Tension => &mut self.tension,
            AtomControl::Elasticity => &mut self.elasticity,
            AtomControl::Adhesion => &mut self.adhesion,
            AtomControl::Secretion(channel) => {
                self.secretion.resize_with(self.secretion.len().max(channel + 1), Vec::new);
                &mut self.secretion[channel]
            }
        }
    }

    /// Whether atoms push themselves.
    pub fn push(&self) -> bool {
        !self.protrusion.is_empty() || !self.tension.is_empty()
    }

    /// All lists, each with what changes nothing.
    pub fn lists(&mut self) -> impl Iterator<Item = (&mut Vec<f64>, f64)> {
        let factors = [(&mut self.elasticity, 1.0), (&mut self.adhesion, 1.0)];
        let own = [(&mut self.protrusion, 0.0), (&mut self.tension, 0.0)].into_iter().chain(factors);
        own.chain(self.secretion.iter_mut().map(|list| (list, 0.0)))
    }

    /// Whether every list is empty or has so many numbers.
    pub fn fits(&self, atoms: usize) -> bool {
        let own = [&self.protrusion, &self.tension, &self.elasticity, &self.adhesion];
        own.into_iter().chain(&self.secretion).all(|list| [0, atoms].contains(&list.len()))
    }

    /// Adds a cell of so many atoms before the one with this number to all lists that are there.
    pub fn insert_cell(&mut self, atoms: usize, at: usize) {
        for (list, nothing) in self.lists().filter(|(list, _)| !list.is_empty()) {
            list.splice(at * atoms..at * atoms, std::iter::repeat_n(nothing, atoms));
        }
    }

    /// Keeps the cells of so many atoms of which `keep` says yes.
    pub fn retain_cells(&mut self, atoms: usize, keep: impl Fn(usize) -> bool) {
        for (list, _) in self.lists() {
            let mut at = 0..;
            list.retain(|_| at.next().is_some_and(|number| keep(number / atoms)));
        }
    }

    /// Becomes another; where its numbers fit into what this one holds, nothing is allocated.
    pub fn copy_from(&mut self, other: &Self) {
        self.protrusion.clone_from(&other.protrusion);
        self.tension.clone_from(&other.tension);
        self.elasticity.clone_from(&other.elasticity);
        self.adhesion.clone_from(&other.adhesion);
        self.secretion.clone_from(&other.secretion);
    }
}
