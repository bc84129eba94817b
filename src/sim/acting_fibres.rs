//! The fibres of all cells side by side, as forces are added up.

use super::model::Model;
use super::state::KindState;
use crate::mechanics::fibres::Fibre;

/// The fibres that act in a step, cell after cell in the order of all cells.
#[derive(Debug, Clone, Default)]
pub struct ActingFibres {
    fibres: Vec<Fibre>,
    /// Where those of each cell end; empty where no cell may have any.
    ends: Vec<usize>,
}

impl ActingFibres {
    /// Those of a cell, by its number among all.
    pub fn of(&self, cell: usize) -> &[Fibre] {
        let Some(&end) = self.ends.get(cell) else { return &[] };
        &self.fibres[if cell == 0 { 0 } else { self.ends[cell - 1] }..end]
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.fibres.is_empty()
    }

    /// Takes the fibres of all cells.
    pub fn gather(&mut self, model: &Model, cells: &[KindState]) {
        self.fibres.clear();
        self.ends.clear();
        if model.kinds.iter().all(|kind| kind.fibre_budget == 0) {
            return;
        }
        self.fibres.reserve(cells.iter().map(|now| now.fibres.slots.len()).sum());
        for (kind, now) in model.kinds.iter().zip(cells) {
            for cell in 0..now.cells() {
                self.fibres.extend(now.fibres.of_cell(kind, cell).map(|made| made.fibre));
                self.ends.push(self.fibres.len());
            }
        }
    }

    /// Writes NaN over all numbers.
    pub fn poison(&mut self) {
        self.fibres.iter_mut().for_each(|fibre| (fibre.stiffness, fibre.activation) = (f64::NAN, f64::NAN));
    }
}
