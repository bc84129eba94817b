//! Scratch paper of chemistry: sized once, never saved, never read before it is written.

use super::super::model::Model;
use super::super::state::State;
use super::measure::CellNumbers;
use super::neighbours::Neighbours;
use super::observed::Observed;
use super::released::Released;
use super::state::ChemistryState;
use super::surface::AtomShapes;
use crate::Vec3;
use crate::field::{Fields, SceneScratch, Sensed};
use crate::membrane::MembraneScratch;
use crate::ode::PopulationScratch;

/// What the stages of chemistry need beside the state.
#[derive(Debug, Clone, Default)]
pub struct ChemistryScratch {
    /// Solvers of the fields; their values are the state's while a stage works on them.
    pub(super) fields: Vec<Fields>,
    /// What they and what stands beside them work in.
    pub(super) scenes: Vec<SceneScratch>,
    /// Measures of all cells, where links read them.
    pub(super) cells: Vec<CellNumbers>,
    /// Who touches whom, where links read that.
    pub(super) neighbours: Neighbours,
    /// Means over the atoms of each cell, one list for each species sensed.
    pub(super) sensed: Vec<Vec<Sensed>>,
    /// Buffers of the systems.
    pub(super) populations: Vec<PopulationScratch>,
    /// Buffers of their membranes.
    pub(in super::super) membranes: Vec<MembraneScratch>,
    /// What links read.
    pub(super) observed: Observed,
    /// Means of what links tell in the step.
    pub(super) means: Vec<f64>,
    /// Rates at which cells release in the step.
    pub(super) released: Released,
    /// Steps of its own that each system made meanwhile, all cells together.
    pub(super) own_steps: Vec<u64>,
    /// Positions of atoms, what is sensed at them, and amounts released at them.
    pub(super) positions: Vec<Vec3>,
    pub(super) senses: Vec<Sensed>,
    pub(super) amounts: Vec<f64>,
    /// What a link carries at the atoms of a kind; the shape of a cell at its atoms, and their areas at rest, µm².
    pub(super) at_atoms: Vec<f64>,
    pub(super) shapes: AtomShapes,
    pub(super) rest_areas: Vec<f64>,
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
            scenes: chemistry.fields.iter().map(|_| SceneScratch::default()).collect(),
            own_steps: vec![0; chemistry.reactors.len()],
            populations: chemistry.reactors.iter().map(|_| PopulationScratch::default()).collect(),
            membranes: chemistry.reactors.iter().map(|_| MembraneScratch::default()).collect(),
            sensed: vec![Vec::new(); chemistry.sensed.len()],
            ..Self::default()
        }
    }

    /// Makes lists as long as the cells need that there are.
    pub fn suit(&mut self, model: &Model, state: &State) {
        let measured = if model.chemistry.measures_cells { state.cells() } else { 0 };
        self.cells.resize(measured, CellNumbers::default());
        self.sensed.iter_mut().for_each(|cells| cells.resize(state.cells(), Sensed::default()));
    }

    /// Writes NaN over all scratch numbers: a step must not notice.
    pub fn poison(&mut self, model: &Model) {
        let nothing = Sensed { value: f64::NAN, gradient: Vec3::repeat(f64::NAN) };
        self.cells.fill(CellNumbers::poisoned());
        self.sensed.iter_mut().for_each(|cells| cells.fill(nothing));
        let (cells, sensed) = (std::mem::take(&mut self.cells), std::mem::take(&mut self.sensed));
        *self = Self { cells, sensed, ..Self::new(model) };
        self.fields.iter_mut().for_each(Fields::poison);
    }

    /// How many blocks of cells have had their equations evaluated for links to read quantities of systems, ever: the cost of links.
    pub fn blocks_observed(&self) -> u64 {
        self.observed.blocks
    }

    /// Lends the values of all fields to their solvers, or takes them back.
    pub(super) fn exchange_values(&mut self, state: &mut ChemistryState, time: f64) {
        for (fields, field) in self.fields.iter_mut().zip(&mut state.fields) {
            fields.exchange_values(&mut field.values);
            fields.set_time(time);
        }
    }
}
