//! What chemistry sets for mechanics.

use serde::{Deserialize, Serialize};

use super::atom_controls::AtomControls;
use super::chemistry::Control;
use crate::Vec3;
use crate::cell::pseudopods::Told;
use crate::mechanics::CONTROLLED;

/// What links set for mechanics, one number a cell in the order of all cells. A list that no link writes is empty.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Controls {
    /// Speed of the walk, µm/s; NaN where the type's own speed stands.
    pub speed: Vec<f64>,
    /// Velocity added to the walk, µm/s.
    pub bias: Vec<[f64; 3]>,
    /// Factor of elastic forces.
    pub stiffness: Vec<f64>,
    /// Factor of the strength with which a cell sticks; empty without a link to one.
    pub adhesion: Vec<f64>,
    /// Factor of the strength with which each atom of all cells sticks, in their order; empty where none is set. Behaviours set it where a
    /// step ends.
    pub adhesion_of_atoms: Vec<f64>,
    /// Factor of the moduli of the membrane at each atom of all cells, in their order; empty where none is set. Gathered from what is set
    /// of atoms where a step ends, and before the first.
    pub elasticity_of_atoms: Vec<f64>,
    /// What links set of atoms, one entry a kind; empty without such a link.
    pub of_atoms: Vec<AtomControls>,
    /// What pseudopods are told, one a cell; empty without a link to one.
    pub pseudopods: Vec<Told>,
    /// What is set of forces: for each handle of [`CONTROLLED`] one list for each such force of a kind, in its order.
    pub forces: Vec<Vec<Vec<f64>>>,
    /// Amount released per second, one list for each species secreted: those of the model first, then those of `secreted`.
    pub secretion: Vec<Vec<f64>>,
    /// Fields and species that a program lets cells secrete into and the model does not.
    pub secreted: Vec<(usize, usize)>,
    /// Force that a program exerts on each atom of all cells, pN, in their order; empty where it exerts none.
    pub atom_forces: Vec<Vec3>,
}

impl Controls {
    /// Makes the list that a control is written to, with one number for each of `cells`, where there is none: numbers that
    /// change nothing until they are set.
    pub fn admit(&mut self, control: Control, cells: usize) {
        let lists = |lists: &mut Vec<Vec<f64>>, number: usize, value: f64| {
            lists.resize(lists.len().max(number + 1), vec![value; cells]);
        };
        let list = |list: &mut Vec<f64>, value: f64| list.resize(cells, value);
        match control {
            Control::MotilitySpeed => list(&mut self.speed, f64::NAN),
            Control::Bias(_) => self.bias.resize(cells, [0.0; 3]),
            Control::Stiffness => list(&mut self.stiffness, 1.0),
            Control::Adhesion => list(&mut self.adhesion, 1.0),
            Control::Pseudopods(_) => self.pseudopods.resize(cells, Told::NOTHING),
            Control::Force(handle, number) => {
                self.forces.resize(CONTROLLED.len(), Vec::new());
                lists(&mut self.forces[handle], number, CONTROLLED[handle].unset);
            }
            Control::Secretion(channel) => lists(&mut self.secretion, channel, 0.0),
            // What is set of atoms is admitted kind by kind.
            Control::RestVolume | Control::RestVolumeRatio | Control::Atom(..) | Control::Atoms(_) => {}
        }
    }

    /// Copies another without allocating where it is as large.
    pub fn copy_from(&mut self, other: &Self) {
        self.speed.clone_from(&other.speed);
        self.bias.clone_from(&other.bias);
        self.stiffness.clone_from(&other.stiffness);
        self.adhesion.clone_from(&other.adhesion);
        self.adhesion_of_atoms.clone_from(&other.adhesion_of_atoms);
        self.elasticity_of_atoms.clone_from(&other.elasticity_of_atoms);
        self.of_atoms.truncate(other.of_atoms.len());
        self.of_atoms.iter_mut().zip(&other.of_atoms).for_each(|(to, from)| to.copy_from(from));
        self.of_atoms.extend_from_slice(&other.of_atoms[self.of_atoms.len()..]);
        self.pseudopods.clone_from(&other.pseudopods);
        self.forces.clone_from(&other.forces);
        self.secretion.clone_from(&other.secretion);
        self.secreted.clone_from(&other.secreted);
        self.atom_forces.clone_from(&other.atom_forces);
    }

    /// The velocity added to a cell's walk, µm/s.
    pub fn bias_of(&self, cell: usize) -> [f64; 3] {
        self.bias.get(cell).copied().unwrap_or_default()
    }

    /// The speed that a link asks of a cell, µm/s.
    pub fn speed_of(&self, cell: usize) -> Option<f64> {
        self.speed.get(cell).copied().filter(|speed| !speed.is_nan())
    }

    /// Factor of a cell's elastic forces.
    pub fn stiffness_of(&self, cell: usize) -> f64 {
        self.stiffness.get(cell).copied().unwrap_or(1.0)
    }

    /// What the pseudopods of a cell are told.
    pub fn told_pseudopods(&self, cell: usize) -> Told {
        self.pseudopods.get(cell).copied().unwrap_or(Told::NOTHING)
    }

    /// Factor of the strength with which an atom sticks, beside that of its cell.
    pub fn adhesion_of_atom(&self, atom: u32) -> f64 {
        self.adhesion_of_atoms.get(atom as usize).copied().unwrap_or(1.0)
    }

    /// The same at a point between atoms, whose weights sum to 1 but for round-off: one that is a little below 0 for that reason counts
    /// nothing, so that where all atoms let go nothing is held with less than nothing.
    pub fn adhesion_between(&self, atoms: [u32; 3], weights: [f64; 3]) -> f64 {
        if self.adhesion_of_atoms.is_empty() {
            return 1.0;
        }
        atoms.iter().zip(weights).map(|(atom, weight)| weight.max(0.0) * self.adhesion_of_atom(*atom)).sum()
    }

    /// Factor of the strength with which a cell sticks.
    pub fn adhesion_of(&self, cell: usize) -> f64 {
        self.adhesion.get(cell).copied().unwrap_or(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_with_round_off_never_hold_with_less_than_nothing() {
        // As a contact keeps them: to seven digits, which here sum to 1 + 4e-8.
        let [second, third] = [0.438_151_1_f32, 0.561_848_94].map(f64::from);
        let weights = [1.0 - second - third, second, third];
        assert!(weights[0] < 0.0);
        let controls = Controls { adhesion_of_atoms: vec![1.0, 0.0, 0.0, 0.5], ..Controls::default() };
        assert_eq!(controls.adhesion_between([0, 1, 2], weights), 0.0);
        assert_eq!(controls.adhesion_between([0, 3, 3], weights), 0.5 * (second + third));
    }
}
