//! Scratch paper of chemistry: sized once, never saved, never read before it is written.

use super::super::model::Model;
use super::measure::CellNumbers;
use super::model::Whose;
use super::state::ChemistryState;
use crate::Vec3;
use crate::field::{Fields, Sensed};

/// What the stages of chemistry need beside the state.
#[derive(Debug, Clone, Default)]
pub struct ChemistryScratch {
    /// Solvers of the fields; their values are the state's while a stage works on them.
    pub(super) fields: Vec<Fields>,
    /// Measures of all cells, where links read them.
    pub(super) cells: Vec<CellNumbers>,
    /// Means over the atoms of each cell, one list for each species sensed.
    pub(super) sensed: Vec<Vec<Sensed>>,
    /// Values of the quantities that a link uses: `[quantity][member]`.
    pub(super) observed: Vec<Vec<f64>>,
    /// Positions of atoms, what is sensed at them, and amounts released at them.
    pub(super) places: Vec<Vec3>,
    pub(super) senses: Vec<Sensed>,
    pub(super) amounts: Vec<f64>,
}

impl ChemistryScratch {
    /// Scratch for a model.
    pub fn new(model: &Model) -> Self {
        let chemistry = &model.chemistry;
        if chemistry.is_empty() {
            return Self::default();
        }
        let fields = chemistry.fields.iter().map(|field| field.system.empty());
        Self {
            fields: fields.collect(),
            cells: vec![CellNumbers::default(); if chemistry.measures_cells { model.cells() } else { 0 }],
            sensed: vec![vec![Sensed::default(); model.cells()]; chemistry.sensed.len()],
            ..Self::default()
        }
    }

    /// Writes NaN over all scratch numbers: a step must not notice.
    pub fn poison(&mut self, model: &Model) {
        *self = Self::new(model);
        self.cells.fill(CellNumbers::poisoned());
        let nothing = Sensed { value: f64::NAN, gradient: Vec3::repeat(f64::NAN) };
        self.sensed.iter_mut().for_each(|cells| cells.fill(nothing));
    }

    /// Lends the values of all fields to their solvers, or takes them back.
    pub(super) fn exchange_values(&mut self, state: &mut ChemistryState, time: f64) {
        for (fields, field) in self.fields.iter_mut().zip(&mut state.fields) {
            fields.exchange_values(&mut field.values);
            fields.set_time(time);
        }
    }
}

/// The cells that an end names: one or a range of them.
pub(super) fn cells_of(model: &Model, whose: Whose, own: Option<usize>) -> std::ops::Range<usize> {
    match whose {
        Whose::Own => own.map_or(0..0, |cell| cell..cell + 1),
        Whose::Cell(cell) => cell..cell + 1,
        Whose::Kind(kind) => {
            let kind = &model.kinds[kind];
            kind.first_cell..kind.first_cell + kind.cells
        }
    }
}
