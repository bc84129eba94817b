//! The fibres that cells have made while they run.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::kind::Kind;
use crate::mechanics::fibres::Fibre;

/// A fibre that was made at run time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MadeFibre {
    /// Its number among those that its cell has made: no other of the cell ever has it.
    pub number: u64,
    /// When it was made, s.
    pub since: f64,
    /// The pseudopod that made it, by its number in the cell; none of one that a program made.
    pub pod: Option<u32>,
    /// What it joins, and how it pulls. Of a pseudopod's fibre the activation is that of the last step.
    pub fibre: Fibre,
}

/// The fibres of the cells of a kind that were made at run time.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FibreState {
    /// As many slots a cell as its kind's budget, cell after cell.
    pub slots: Vec<Option<MadeFibre>>,
    /// How many each cell has made so far; empty where the budget is none.
    pub made: Vec<u64>,
}

impl FibreState {
    /// So many cells without fibres.
    pub fn new(kind: &Kind, cells: usize) -> Self {
        let of_cells = if kind.fibre_budget > 0 { cells } else { 0 };
        Self { slots: vec![None; kind.fibre_budget * cells], made: vec![0; of_cells] }
    }

    /// Whether it is one of so many cells of a kind: all fibres join two atoms that there are.
    pub fn fits(&self, kind: &Kind, cells: usize) -> bool {
        let joins = |made: &MadeFibre| {
            let [a, b] = made.fibre.atoms;
            a != b && (a.max(b) as usize) < kind.atoms()
        };
        let fresh = Self::new(kind, cells);
        (self.slots.len(), self.made.len()) == (fresh.slots.len(), fresh.made.len())
            && self.slots.iter().flatten().all(joins)
    }

    /// The fibres of a cell, in the order in which they were made but where one took the place of another.
    pub fn of_cell(&self, kind: &Kind, cell: usize) -> impl Iterator<Item = &MadeFibre> {
        self.slots.get(slots_of(kind, cell)).unwrap_or_default().iter().flatten()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.slots.iter().all(Option::is_none)
    }

    /// Adds a fibre to a cell and returns its number; none where its budget is used up.
    pub fn add(&mut self, kind: &Kind, cell: usize, since: f64, pod: Option<u32>, fibre: Fibre) -> Option<u64> {
        let slot = self.slots.get_mut(slots_of(kind, cell))?.iter_mut().find(|slot| slot.is_none())?;
        let number = self.made[cell];
        self.made[cell] += 1;
        *slot = Some(MadeFibre { number, since, pod, fibre });
        Some(number)
    }

    /// The fibre of a cell with a number, in its slot.
    pub fn find(&mut self, kind: &Kind, cell: usize, number: u64) -> Option<&mut Option<MadeFibre>> {
        let is_it = |slot: &&mut Option<MadeFibre>| slot.is_some_and(|made| made.number == number);
        self.slots.get_mut(slots_of(kind, cell))?.iter_mut().find(is_it)
    }

    /// Adds a cell without fibres behind the others.
    pub(super) fn push_cell(&mut self, kind: &Kind) {
        let cells = if kind.fibre_budget > 0 { self.made.len() + 1 } else { 0 };
        self.slots.resize(cells * kind.fibre_budget, None);
        self.made.resize(cells, 0);
    }

    /// Keeps the fibres of these cells.
    pub(super) fn retain_cells(&mut self, kind: &Kind, kept: &[usize]) {
        if kind.fibre_budget > 0 {
            self.slots = kept.iter().flat_map(|&cell| self.slots[slots_of(kind, cell)].iter().copied()).collect();
            self.made = kept.iter().map(|&cell| self.made[cell]).collect();
        }
    }

    /// Becomes another; nothing is allocated where it is as large.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.slots.clone_from(&other.slots);
        self.made.clone_from(&other.made);
    }

    pub(super) fn poison(&mut self) {
        self.slots.clear();
        self.made.clear();
    }
}

/// The slots of a cell.
pub(super) fn slots_of(kind: &Kind, cell: usize) -> Range<usize> {
    cell * kind.fibre_budget..(cell + 1) * kind.fibre_budget
}
