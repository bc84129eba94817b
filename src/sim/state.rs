//! Where a run is. A checkpoint is exactly this.

use serde::{Deserialize, Serialize};

use super::chemistry::ChemistryState;
use super::contact::ContactState;
use super::model::{Kind, Model};
use crate::Vec3;
use crate::cell::{Behaviour, BehaviourState};

/// Everything that changes and is needed to go on.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct State {
    /// Simulated time, s.
    pub time: f64,
    /// Steps made.
    pub step: u64,
    /// The step that the error estimate proposes next, s.
    pub next_step: f64,
    /// One entry a kind.
    pub kinds: Vec<KindState>,
    /// Motility runs that ended and are not recorded yet: (cell, end s, duration s).
    pub ended_runs: Vec<(u32, f64, f64)>,
    /// Systems and fields; empty in a model without chemistry.
    pub chemistry: ChemistryState,
    /// What contacts carry; empty in a model without contacts.
    pub contact: ContactState,
}

/// The cells of a kind, in blocks of lanes.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct KindState {
    /// Positions, µm: `[block][atom][axis][lane]`. Lanes beyond the last cell repeat it and are never read.
    pub positions: Vec<f64>,
    /// Velocities, µm/s, the same shape; empty in over-damped runs.
    pub velocities: Vec<f64>,
    /// Rest volume of every cell, µm³, padded to whole blocks.
    pub rest_volumes: Vec<f64>,
    /// Positions of the cell when the stiffness of the implicit step was last made, µm; empty where it is that of the
    /// rest shape.
    pub stiffness_shape: Vec<f64>,
    /// Mean velocity of the atoms of every cell over the last step, µm/s; zero before the first.
    pub mean_velocities: Vec<[f64; 3]>,
    /// What every cell remembers of each behaviour of the kind: `[behaviour][cell]`.
    pub behaviours: Vec<Vec<BehaviourState>>,
}

/// What every cell of a kind remembers of a behaviour where it begins.
pub fn start_of(kind: &Kind, behaviour: Behaviour, seed: u64) -> Vec<BehaviourState> {
    (0..kind.cells).map(|cell| behaviour.start(seed, (kind.first_cell + cell) as u64)).collect()
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
    /// Places cells; `places[cell]` are the positions of a cell's atoms. Behaviours begin as the seed says.
    pub fn new(kind: &Kind, places: &[Vec<Vec3>], inertial: Inertia, seed: u64) -> Self {
        let mut positions = vec![0.0; kind.blocks() * kind.block_len()];
        for slot in 0..kind.blocks() * kind.lanes {
            let place = &places[slot.min(places.len() - 1)];
            for (atom, x) in place.iter().enumerate() {
                for axis in 0..3 {
                    positions[index(kind, slot, atom, axis)] = x[axis];
                }
            }
        }
        let velocities = match inertial {
            Inertia::Inertial => vec![0.0; positions.len()],
            Inertia::OverDamped => Vec::new(),
        };
        let volume = if kind.closed { crate::geometry::volume(&kind.rest) } else { 0.0 };
        Self {
            positions,
            velocities,
            rest_volumes: vec![volume; kind.blocks() * kind.lanes],
            stiffness_shape: Vec::new(),
            mean_velocities: vec![[0.0; 3]; kind.cells],
            behaviours: kind.behaviours.iter().map(|behaviour| start_of(kind, *behaviour, seed)).collect(),
        }
    }

    /// As [`State::begin_from`].
    fn begin_from(&mut self, from: &Self) {
        self.positions.resize(from.positions.len(), 0.0);
        self.velocities.resize(from.velocities.len(), 0.0);
        self.rest_volumes.clone_from(&from.rest_volumes);
        self.stiffness_shape.clone_from(&from.stiffness_shape);
        self.mean_velocities.resize(from.mean_velocities.len(), [0.0; 3]);
    }

    fn poison(&mut self) {
        for array in [&mut self.positions, &mut self.velocities, &mut self.rest_volumes, &mut self.stiffness_shape] {
            array.fill(f64::NAN);
        }
        self.mean_velocities.fill([f64::NAN; 3]);
        self.behaviours.iter_mut().for_each(Vec::clear);
    }

    /// Moves a cell as a whole, µm.
    pub fn shift(&mut self, kind: &Kind, cell: usize, way: &Vec3) {
        // Lanes beyond the last cell repeat it.
        let end = if cell + 1 == kind.cells { kind.blocks() * kind.lanes } else { cell + 1 };
        for slot in cell..end {
            for atom in 0..kind.atoms() {
                (0..3).for_each(|axis| self.positions[index(kind, slot, atom, axis)] += way[axis]);
            }
        }
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
    /// The start of a run with every cell at rest, `places[kind][cell][atom]`, and no fields; see
    /// [`ChemistryState::new`] for a model that has some.
    pub fn new(model: &Model, places: &[Vec<Vec<Vec3>>]) -> Self {
        let inertia = if model.integrator.method.is_inertial() { Inertia::Inertial } else { Inertia::OverDamped };
        let state = |(kind, cells): (&Kind, &Vec<_>)| KindState::new(kind, cells, inertia, model.seed);
        let kinds = model.kinds.iter().zip(places).map(state).collect();
        let chemistry = ChemistryState::new(model, &[]);
        let contact = ContactState::default();
        Self { time: 0.0, step: 0, next_step: 0.0, kinds, ended_runs: Vec::new(), chemistry, contact }
    }

    /// Makes this state, which may hold anything, the one that a step from another leads to, as far as that is known before it: where
    /// the step begins, and room for what its stages write. Positions, velocities, contacts and chemistry are written by the stages.
    /// Nothing is allocated where both are as large.
    pub fn begin_from(&mut self, from: &Self) {
        (self.time, self.step, self.next_step) = (from.time, from.step, from.next_step);
        self.kinds.resize_with(from.kinds.len(), KindState::default);
        self.kinds.iter_mut().zip(&from.kinds).for_each(|(kind, from)| kind.begin_from(from));
    }

    /// Writes NaN over all numbers and forgets what is held in lists.
    pub fn poison(&mut self) {
        (self.time, self.step, self.next_step) = (f64::NAN, u64::MAX, f64::NAN);
        self.kinds.iter_mut().for_each(KindState::poison);
        self.ended_runs.clear();
        self.chemistry.poison();
        self.contact = ContactState::default();
    }
}
