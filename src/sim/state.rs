//! Where a run is. A checkpoint is exactly this.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::balance::AtomBalance;
use super::chemistry::ChemistryState;
use super::contact::ContactState;
use super::fibre_state::FibreState;
use super::kind::Kind;
use super::model::Model;
use crate::Vec3;
use crate::cell::pseudopods::EndedPseudopod;
use crate::cell::{Behaviour, BehaviourState};

/// Everything that changes and is needed to go on.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct State {
    /// Simulated time, s.
    pub time: f64,
    /// Steps made.
    pub step: u64,
    /// The id that the next cell gets.
    pub next_id: u64,
    /// Changes of the model's population that were made.
    pub changes: usize,
    /// The step that the error estimate proposes next, s.
    pub next_step: f64,
    /// The largest force on an atom that was out of balance in the last step, pN, where somebody asks.
    pub out_of_balance: Option<f64>,
    /// One entry a kind.
    pub kinds: Vec<KindState>,
    /// Motility runs that ended and are not recorded yet: (id of the cell, end s, duration s).
    pub ended_runs: Vec<(u64, f64, f64)>,
    /// Pseudopods whose protrusion ended and that are not recorded yet: id of the cell, end (s), what it was.
    pub ended_pseudopods: Vec<(u64, f64, EndedPseudopod)>,
    /// Systems and fields; empty in a model without chemistry.
    pub chemistry: ChemistryState,
    /// What contacts carry; empty in a model without contacts.
    pub contact: ContactState,
}

/// A cell that comes.
#[derive(Debug, Clone, PartialEq)]
pub struct NewCell {
    /// Positions of its atoms, µm.
    pub positions: Vec<Vec3>,
    /// Id of the cell that it was born from; none of one that is placed.
    pub parent: Option<u64>,
}

/// The cells of a kind, in blocks of lanes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct KindState {
    /// Id of each cell, rising: given once, and never to another cell.
    pub ids: Vec<u64>,
    /// Id of the cell that each was born from; none of those that were placed.
    pub parents: Vec<Option<u64>>,
    /// Number of the first cell in the order of all cells.
    pub first_cell: usize,
    /// Number of its first atom among all atoms, in the order of all cells.
    pub first_atom: usize,
    /// Positions, µm: `[block][atom][axis][lane]`. Lanes beyond the last cell repeat it and are never read.
    pub positions: Vec<f64>,
    /// Velocities, µm/s, the same shape; empty in over-damped runs.
    pub velocities: Vec<f64>,
    /// Rest volume of every cell, µm³, padded to whole blocks.
    pub rest_volumes: Vec<f64>,
    /// Positions of a single cell when the stiffness of the implicit step was last made, µm, `[atom][axis]`; empty where it is that
    /// of the rest shape.
    pub stiffness_shape: Vec<f64>,
    /// Mean velocity of the atoms of every cell over the last step, µm/s; zero before the first.
    pub mean_velocities: Vec<[f64; 3]>,
    /// What every cell remembers of each behaviour of the kind: `[behaviour][cell]`.
    pub behaviours: Vec<Vec<BehaviourState>>,
    /// Fibres that were made at run time.
    pub fibres: FibreState,
    /// Whether a program has set a velocity of any of them, which is then added to what behaviours ask for.
    pub is_biased: bool,
    /// What viscosity has taken of each cell since it is there, pN·µm; empty where nothing is viscous.
    pub dissipated: Vec<f64>,
    /// What the atoms of each cell did to what is around them in the last step, cell after cell; empty where that is not kept.
    pub balance: Vec<AtomBalance>,
}

/// What cells with these ids remember of a behaviour where it begins.
fn start_of(ids: &[u64], behaviour: Behaviour, seed: u64) -> Vec<BehaviourState> {
    ids.iter().map(|id| behaviour.start(seed, *id)).collect()
}

/// Index of a number in a block array.
pub fn index(kind: &Kind, cell: usize, atom: usize, axis: usize) -> usize {
    let (block, lane) = (cell / kind.lanes, cell % kind.lanes);
    block * kind.block_len() + (3 * atom + axis) * kind.lanes + lane
}

/// The vector of an atom of a cell of a kind in a block array.
pub fn vector(kind: &Kind, values: &[f64], cell: usize, atom: usize) -> Vec3 {
    Vec3::from_fn(|axis, _| values[index(kind, cell, atom, axis)])
}

impl KindState {
    /// Cells at rest, `positions[cell]` those of a cell's atoms, µm; their ids count from `first`. Behaviours begin as the seed
    /// says.
    pub fn new(kind: &Kind, positions: &[Vec<Vec3>], first: u64, inertial: Inertia, seed: u64) -> Self {
        let cells = positions.len();
        let mut blocks = vec![0.0; cells.div_ceil(kind.lanes) * kind.block_len()];
        for slot in 0..cells.next_multiple_of(kind.lanes) {
            for (atom, x) in positions[slot.min(cells - 1)].iter().enumerate() {
                for axis in 0..3 {
                    blocks[index(kind, slot, atom, axis)] = x[axis];
                }
            }
        }
        let ids: Vec<u64> = (first..first + cells as u64).collect();
        let velocities = match inertial {
            Inertia::Inertial => vec![0.0; blocks.len()],
            Inertia::OverDamped => Vec::new(),
        };
        Self {
            parents: vec![None; cells],
            first_cell: 0,
            first_atom: 0,
            positions: blocks,
            velocities,
            rest_volumes: vec![kind.rest_volume(); cells.next_multiple_of(kind.lanes)],
            stiffness_shape: Vec::new(),
            mean_velocities: vec![[0.0; 3]; cells],
            behaviours: kind.behaviours.iter().map(|behaviour| start_of(&ids, *behaviour, seed)).collect(),
            fibres: FibreState::new(kind, cells),
            is_biased: false,
            dissipated: vec![0.0; if kind.viscosity.is_some() { cells } else { 0 }],
            balance: Vec::new(),
            ids,
        }
    }

    /// How many cells there are.
    pub fn cells(&self) -> usize {
        self.ids.len()
    }

    /// Their numbers in the order of all cells.
    pub fn numbers(&self) -> Range<usize> {
        self.first_cell..self.first_cell + self.cells()
    }

    /// The numbers of their atoms, in the order of all cells.
    pub fn atoms(&self, kind: &Kind) -> Range<usize> {
        self.first_atom..self.first_atom + self.cells() * kind.atoms()
    }

    /// The numbers of the cells of a block in the order of all cells.
    pub fn numbers_of_block(&self, kind: &Kind, block: usize) -> Range<usize> {
        let first = self.first_cell + block * kind.lanes;
        first..(first + kind.lanes).min(self.first_cell + self.cells())
    }

    /// Whether anything asks for a velocity of them.
    pub fn is_driven(&self, kind: &Kind) -> bool {
        self.is_biased || !kind.behaviours.is_empty()
    }

    /// How many blocks of lanes they fill.
    pub fn blocks(&self, kind: &Kind) -> usize {
        self.cells().div_ceil(kind.lanes)
    }

    /// As [`State::begin_from`].
    fn begin_from(&mut self, from: &Self) {
        self.ids.clone_from(&from.ids);
        self.parents.clone_from(&from.parents);
        (self.first_cell, self.first_atom) = (from.first_cell, from.first_atom);
        self.positions.resize(from.positions.len(), 0.0);
        self.velocities.resize(from.velocities.len(), 0.0);
        self.rest_volumes.clone_from(&from.rest_volumes);
        self.stiffness_shape.clone_from(&from.stiffness_shape);
        self.is_biased = from.is_biased;
        self.mean_velocities.resize(from.mean_velocities.len(), [0.0; 3]);
        self.dissipated.clone_from(&from.dissipated);
        self.balance.clear();
    }

    fn poison(&mut self) {
        self.ids.clear();
        self.parents.clear();
        (self.first_cell, self.first_atom) = (usize::MAX, usize::MAX);
        for array in [&mut self.positions, &mut self.velocities, &mut self.rest_volumes, &mut self.stiffness_shape] {
            array.fill(f64::NAN);
        }
        self.dissipated.fill(f64::NAN);
        self.mean_velocities.fill([f64::NAN; 3]);
        self.balance.fill(AtomBalance::UNKNOWN);
        self.behaviours.iter_mut().for_each(Vec::clear);
        self.fibres.poison();
    }

    /// Adds a cell at rest behind the others; whoever adds it counts the cells of all kinds anew.
    pub(super) fn push(&mut self, model: &Model, kind: &Kind, id: u64, new: &NewCell) {
        let (cell, positions) = (self.cells(), &new.positions);
        let inertial = model.integrator.method.is_inertial();
        self.ids.push(id);
        self.parents.push(new.parent);
        // There are lists of a kind without cells, too.
        for (states, behaviour) in self.behaviours.iter_mut().zip(&kind.behaviours) {
            states.push(behaviour.start(model.seed, id));
        }
        self.fibres.push_cell(kind);
        self.dissipated.resize(if kind.viscosity.is_some() { self.cells() } else { 0 }, 0.0);
        self.mean_velocities.push([0.0; 3]);
        let kept = if model.keeps_tractions { self.cells() * kind.atoms() } else { 0 };
        self.balance.resize(kept, AtomBalance::NONE);
        self.stiffness_shape.clear();
        let blocks = self.blocks(kind);
        self.positions.resize(blocks * kind.block_len(), 0.0);
        self.velocities.resize(if inertial { self.positions.len() } else { 0 }, 0.0);
        self.rest_volumes.resize(blocks * kind.lanes, 0.0);
        // Lanes beyond the last cell repeat it.
        for slot in cell..blocks * kind.lanes {
            self.rest_volumes[slot] = kind.rest_volume();
            for (atom, x) in positions.iter().enumerate() {
                for axis in 0..3 {
                    let at = index(kind, slot, atom, axis);
                    self.positions[at] = x[axis];
                    self.velocities.get_mut(at).into_iter().for_each(|v| *v = 0.0);
                }
            }
        }
    }

    /// Keeps some cells, in their order; whoever removes the others counts the cells of all kinds anew.
    pub(super) fn retain(&mut self, kind: &Kind, keep: impl Fn(usize) -> bool) {
        let kept: Vec<usize> = (0..self.cells()).filter(|cell| keep(*cell)).collect();
        let blocks = kept.len().div_ceil(kind.lanes);
        // Lanes beyond the last cell repeat it.
        let slots: Vec<usize> =
            kept.iter().chain(kept.last().into_iter().cycle()).take(blocks * kind.lanes).copied().collect();
        let take = |values: &[f64], of_atoms: usize| -> Vec<f64> {
            let row = |block: usize, number: usize| {
                let cells = &slots[block * kind.lanes..(block + 1) * kind.lanes];
                cells
                    .iter()
                    .map(move |cell| values[(cell / kind.lanes * of_atoms + number) * kind.lanes + cell % kind.lanes])
            };
            (0..blocks).flat_map(|block| (0..of_atoms).flat_map(move |number| row(block, number))).collect()
        };
        let numbers = 3 * kind.atoms();
        self.positions = take(&self.positions, numbers);
        self.velocities = if self.velocities.is_empty() { Vec::new() } else { take(&self.velocities, numbers) };
        self.rest_volumes = take(&self.rest_volumes, 1);
        self.stiffness_shape.clear();
        if !self.balance.is_empty() {
            let of_cell = |cell: &usize| self.balance[cell * kind.atoms()..(cell + 1) * kind.atoms()].iter().copied();
            self.balance = kept.iter().flat_map(of_cell).collect();
        }
        self.dissipated = kept.iter().filter_map(|cell| self.dissipated.get(*cell).copied()).collect();
        self.ids = kept.iter().map(|cell| self.ids[*cell]).collect();
        self.parents = kept.iter().map(|cell| self.parents[*cell]).collect();
        for states in &mut self.behaviours {
            *states = kept.iter().map(|cell| states[*cell]).collect();
        }
        self.fibres.retain_cells(kind, &kept);
        self.mean_velocities = kept.iter().map(|cell| self.mean_velocities[*cell]).collect();
    }

    /// Moves a cell as a whole, µm.
    pub fn shift(&mut self, kind: &Kind, cell: usize, by: &Vec3) {
        // Lanes beyond the last cell repeat it.
        let end = if cell + 1 == self.cells() { self.blocks(kind) * kind.lanes } else { cell + 1 };
        for slot in cell..end {
            for atom in 0..kind.atoms() {
                (0..3).for_each(|axis| self.positions[index(kind, slot, atom, axis)] += by[axis]);
            }
        }
    }

    /// Position of an atom of a cell, µm.
    pub fn position(&self, kind: &Kind, cell: usize, atom: usize) -> Vec3 {
        vector(kind, &self.positions, cell, atom)
    }

    /// Positions of the atoms of a cell, µm.
    pub fn cell(&self, kind: &Kind, cell: usize) -> Vec<Vec3> {
        (0..kind.atoms()).map(|atom| vector(kind, &self.positions, cell, atom)).collect()
    }
}

/// Whether atoms keep velocities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Inertia {
    /// Drag balances force at every instant.
    OverDamped,
    /// Atoms have mass and velocity.
    Inertial,
}

impl State {
    /// The start of a run with every cell at rest, `positions[kind][cell][atom]`, and no fields; see
    /// [`ChemistryState::new`] for a model that has some. Ids count through all cells in their order.
    pub fn new(model: &Model, positions: &[Vec<Vec<Vec3>>]) -> Self {
        let inertia = if model.integrator.method.is_inertial() { Inertia::Inertial } else { Inertia::OverDamped };
        let mut state = Self::default();
        for (kind, cells) in model.kinds.iter().zip(positions) {
            state.kinds.push(KindState::new(kind, cells, state.next_id, inertia, model.seed));
            state.next_id += cells.len() as u64;
        }
        state.number_cells(model);
        state.chemistry = ChemistryState::new(model, &state.counts(), &[]);
        state
    }

    /// Counts cells and atoms through all kinds.
    pub(super) fn number_cells(&mut self, model: &Model) {
        let (mut cell, mut atom) = (0, 0);
        for (kind, now) in model.kinds.iter().zip(&mut self.kinds) {
            (now.first_cell, now.first_atom) = (cell, atom);
            cell += now.cells();
            atom += now.cells() * kind.atoms();
        }
    }

    /// How many cells there are.
    pub fn cells(&self) -> usize {
        self.kinds.iter().map(KindState::cells).sum()
    }

    /// How many cells of each kind there are.
    pub fn counts(&self) -> Vec<usize> {
        self.kinds.iter().map(KindState::cells).collect()
    }

    /// How many atoms all cells have.
    pub fn atoms(&self, model: &Model) -> usize {
        model.kinds.iter().zip(&self.kinds).map(|(kind, now)| now.cells() * kind.atoms()).sum()
    }

    /// The kind of a cell, by its number in the order of all cells, and its number within the kind.
    pub fn kind_of(&self, cell: usize) -> (usize, usize) {
        let kind = self.kinds.partition_point(|kind| kind.numbers().end <= cell);
        (kind, cell - self.kinds[kind].first_cell)
    }

    /// The kind of the cell with an id, and its number within the kind; none where there is no such cell.
    pub fn find(&self, id: u64) -> Option<(usize, usize)> {
        let cell = |(kind, now): (usize, &KindState)| now.ids.binary_search(&id).ok().map(|cell| (kind, cell));
        self.kinds.iter().enumerate().find_map(cell)
    }

    /// Makes this state, which may hold anything, the one that a step from another leads to, as far as that is known before it: where
    /// the step begins, and memory for what its stages write. Positions, velocities, contacts and chemistry are written by the stages.
    /// Nothing is allocated where both are as large.
    pub fn begin_from(&mut self, from: &Self) {
        (self.time, self.step, self.next_step) = (from.time, from.step, from.next_step);
        (self.next_id, self.changes, self.out_of_balance) = (from.next_id, from.changes, None);
        self.kinds.resize_with(from.kinds.len(), KindState::default);
        self.kinds.iter_mut().zip(&from.kinds).for_each(|(kind, from)| kind.begin_from(from));
    }

    /// Writes NaN over all numbers and forgets what is held in lists.
    pub fn poison(&mut self) {
        (self.time, self.step, self.next_step) = (f64::NAN, u64::MAX, f64::NAN);
        (self.next_id, self.changes, self.out_of_balance) = (u64::MAX, usize::MAX, Some(f64::NAN));
        self.kinds.iter_mut().for_each(KindState::poison);
        self.ended_runs.clear();
        self.ended_pseudopods.clear();
        self.chemistry.poison();
        self.contact = ContactState::default();
    }
}
