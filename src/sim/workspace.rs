//! Scratch paper of the step: sized once, never saved, never read before it is written.

use std::sync::Arc;

use super::acting_fibres::ActingFibres;
use super::chemistry::ChemistryScratch;
use super::contact::ContactScratch;
use super::coupled_scratch::Coupled;
use super::kind::Kind;
use super::model::Model;
use super::obstacles::TouchScratch;
use super::projection::ProjectScratch;
use super::solver::Solver;
use super::state::State;
use super::thread_buffers::ThreadBuffers;
use crate::Vec3;
use crate::mechanics::modes::Modes;
use crate::mechanics::stiffness::StiffnessMatrix;

/// Scratch for all kinds.
#[derive(Debug, Clone)]
pub struct Workspace {
    /// One entry a kind.
    pub kinds: Vec<KindScratch>,
    /// The state that the step being made leads to; between steps the one that was left last.
    pub next: State,
    /// Mean velocity that motility asks of every cell over the step, µm/s.
    pub drive: Vec<[f64; 3]>,
    /// Forces with which pseudopods push and draw atoms, pN, in the order of cells; none in a model without them.
    pub pushes: Vec<Vec3>,
    /// Fibres made at run time that act in the step.
    pub fibres: ActingFibres,
    /// How much each atom grips what its cell touches, pN; none in a model without pseudopods.
    pub grips: Vec<f64>,
    /// Which atoms of a cell touch others; used in models with contact inhibition.
    pub touched: Vec<bool>,
    /// Scratch of chemistry.
    pub chemistry: ChemistryScratch,
    /// Scratch of contacts.
    pub contact: ContactScratch,
    /// Scratch of blocks.
    pub buffers: ThreadBuffers,
}

/// Scratch of a kind; arrays have the shape of the positions unless said otherwise.
#[derive(Debug, Clone)]
pub struct KindScratch {
    /// Forces, pN, where they are asked for; the stages of the implicit step hold no more than those of a block.
    pub force: Vec<f64>,
    /// Forces from outside in the mean over the attempt, pN, where tractions are kept; else empty.
    pub outer: Vec<f64>,
    /// All forces on held atoms in the mean over the attempt, pN, where tractions are kept and some are held; else empty.
    pub on_held: Vec<f64>,
    /// Increments of the first stage, µm, where the second is made after it and not block by block; else empty.
    pub increments: Vec<f64>,
    /// Positions to which the atoms went freely, µm (inertial schemes); else empty.
    pub free: Vec<f64>,
    /// Sum of the velocities of all stages, µm/s (RK4); else empty.
    pub rates: Vec<f64>,
    /// Sum of the accelerations of all stages, µm/s² (RK4); else empty.
    pub accelerations: Vec<f64>,
    /// Energy of each cell, padded, pN·µm.
    pub energy: Vec<f64>,
    /// Volume of each cell, padded, µm³.
    pub volume: Vec<f64>,
    /// Volume of each cell where its atoms went freely, padded, µm³ (contacts).
    pub free_volume: Vec<f64>,
    /// What is left of the volume error of each cell, padded, over its target.
    pub left: Vec<f64>,
    /// Pressure multiplier of each cell in the stage solved last, padded, pN/µm².
    pub pressure: Vec<f64>,
    /// Target volume of each cell, padded, µm³.
    pub target: Vec<f64>,
    /// The factors of cells that have a stiffness of their own, block by block, where contacts need them in the attempt; else empty.
    pub own_factors: Vec<f64>,
    /// What couples the cells to others by forces that the step answers; empty where none are so steep.
    pub coupled: Coupled,
    /// One entry a block: contact with obstacles.
    pub touch: Vec<TouchScratch>,
    /// One entry a block: the thorough projection.
    pub project: Vec<ProjectScratch>,
    /// The shape that `stiffness`, or that of a cell that stands alone, was made for, as in the state.
    pub stiffness_shape: Vec<f64>,
    /// Factor of K that covers what chemistry makes of the stiffness of the cells.
    pub stiffening: f64,
    /// The stiffness K of the implicit step where it is not that of the rest shape.
    stiffness: Option<StiffnessMatrix>,
    /// The softest modes of K, once they were asked for: none where atoms are held along some axes only.
    modes: Option<Option<Arc<Modes>>>,
    /// Factors of the steps used last, most recent first.
    factors: Vec<((u64, u64), Arc<Solver>)>,
}

/// Factors kept: the ladder of steps is coarse, so few are in use at a time.
const FACTORS_KEPT: usize = 3;

impl KindScratch {
    fn new() -> Self {
        Self {
            force: Vec::new(),
            outer: Vec::new(),
            on_held: Vec::new(),
            increments: Vec::new(),
            free: Vec::new(),
            rates: Vec::new(),
            accelerations: Vec::new(),
            energy: Vec::new(),
            volume: Vec::new(),
            free_volume: Vec::new(),
            left: Vec::new(),
            pressure: Vec::new(),
            target: Vec::new(),
            own_factors: Vec::new(),
            coupled: Coupled::default(),
            touch: Vec::new(),
            project: Vec::new(),
            stiffness_shape: Vec::new(),
            stiffening: 1.0,
            stiffness: None,
            modes: None,
            factors: Vec::new(),
        }
    }

    /// Makes arrays as large as so many cells need.
    fn suit(&mut self, kind: &Kind, cells: usize) {
        let blocks = cells.div_ceil(kind.lanes);
        let per_cell = [&mut self.energy, &mut self.volume, &mut self.free_volume, &mut self.left];
        for array in per_cell.into_iter().chain([&mut self.pressure, &mut self.target]) {
            array.resize(blocks * kind.lanes, 0.0);
        }
        self.touch.resize_with(blocks, TouchScratch::default);
        self.project.resize_with(blocks, ProjectScratch::default);
    }

    /// The solver for a step, factored when it is new.
    pub fn solver(&mut self, kind: &Kind, dt: f64, gamma: f64) -> Arc<Solver> {
        let raised = gamma * self.stiffening;
        let key = (dt.to_bits(), raised.to_bits());
        if let Some(at) = self.factors.iter().position(|(known, _)| *known == key) {
            self.factors[..=at].rotate_right(1);
        } else {
            let stiffness = self.stiffness.as_ref().unwrap_or(&kind.stiffness);
            let solver = match &kind.tangent {
                Some(tangent) => Solver::of_one(kind, tangent, &self.stiffness_shape, dt, (gamma, self.stiffening)),
                None => Solver::new(kind, stiffness, dt, raised),
            };
            let solver = Arc::new(solver);
            self.factors.truncate(FACTORS_KEPT - 1);
            self.factors.insert(0, (key, solver));
        }
        self.factors[0].1.clone()
    }

    /// Takes another stiffness for the implicit step, made for `shape`; none is that of the rest shape.
    pub fn set_stiffness(&mut self, stiffness: Option<StiffnessMatrix>, shape: &[f64]) {
        self.stiffness = stiffness;
        self.stiffness_shape = shape.to_vec();
        self.factors.clear();
        self.modes = None;
    }

    /// The softest modes of K; none where atoms are held along some axes only.
    pub fn modes(&mut self, kind: &Kind) -> Option<Arc<Modes>> {
        let stiffness = self.stiffness.as_ref().unwrap_or(&kind.stiffness);
        let rigid = || Arc::new(Modes::rigid(kind.atoms(), kind.drawn() / kind.atoms() as f64));
        if kind.rigid.is_some() {
            return self.modes.get_or_insert_with(|| Some(rigid())).clone();
        }
        let make = || Some(Arc::new(Modes::new(stiffness, &kind.rest.positions, &kind.held_alike()?)));
        self.modes.get_or_insert_with(make).clone()
    }

    /// Writes NaN over all scratch numbers: a step must not notice.
    pub fn poison(&mut self) {
        self.set_stiffness(None, &[]);
        self.stiffening = f64::NAN;
        for array in [
            &mut self.force,
            &mut self.outer,
            &mut self.on_held,
            &mut self.increments,
            &mut self.free,
            &mut self.rates,
            &mut self.accelerations,
            &mut self.energy,
            &mut self.volume,
            &mut self.free_volume,
            &mut self.left,
            &mut self.pressure,
            &mut self.target,
            &mut self.own_factors,
        ] {
            array.fill(f64::NAN);
        }
        self.coupled.poison();
        self.touch.iter_mut().for_each(TouchScratch::poison);
        self.project.iter_mut().for_each(ProjectScratch::poison);
    }
}

impl Workspace {
    /// Scratch for a model; it becomes as large as the cells need that there are.
    pub fn new(model: &Model) -> Self {
        Self {
            kinds: model.kinds.iter().map(|_| KindScratch::new()).collect(),
            next: State::default(),
            drive: Vec::new(),
            pushes: Vec::new(),
            fibres: ActingFibres::default(),
            grips: Vec::new(),
            touched: Vec::new(),
            chemistry: ChemistryScratch::new(model),
            contact: ContactScratch::default(),
            buffers: ThreadBuffers::default(),
        }
    }

    /// Makes scratch as large as the cells of a state need. Nothing is allocated where it is.
    pub fn suit(&mut self, model: &Model, state: &State) {
        self.buffers.suit(model);
        self.drive.resize(state.cells(), [0.0; 3]);
        self.chemistry.suit(model, state);
        for ((kind, now), w) in model.kinds.iter().zip(&state.kinds).zip(&mut self.kinds) {
            w.suit(kind, now.cells());
        }
    }

    /// Writes NaN over all scratch numbers: a step must not notice.
    pub fn poison(&mut self, model: &Model) {
        self.chemistry.poison(model);
        self.contact.poison();
        self.buffers.poison();
        self.kinds.iter_mut().for_each(KindScratch::poison);
        self.drive.fill([f64::NAN; 3]);
        self.pushes.fill(Vec3::repeat(f64::NAN));
        self.fibres.poison();
        self.grips.fill(f64::NAN);
        self.next.poison();
    }
}
