//! Scratch paper of the step: sized once, never saved, never read before it is written.

use std::sync::Arc;

use super::chemistry::ChemistryScratch;
use super::contact::ContactScratch;
use super::model::{Kind, Model};
use super::planes::TouchScratch;
use super::projection::ProjectScratch;
use super::rooms::Rooms;
use crate::cell::motility::Walk;
use crate::mechanics::implicit::Factor;
use crate::mechanics::stiffness::StiffnessMatrix;

/// Scratch for all kinds.
#[derive(Debug, Clone)]
pub struct Workspace {
    /// One entry a kind.
    pub kinds: Vec<KindScratch>,
    /// Walks at the end of the step being tried.
    pub walks: Vec<Walk>,
    /// Runs that ended in the step being tried.
    pub ended_runs: Vec<(u32, f64, f64)>,
    /// Mean velocity that motility asks of every cell over the step, µm/s.
    pub drive: Vec<[f64; 3]>,
    /// Scratch of chemistry.
    pub chemistry: ChemistryScratch,
    /// Scratch of contacts.
    pub contact: ContactScratch,
    /// Scratch of blocks.
    pub rooms: Rooms,
}

/// Scratch of a kind; arrays have the shape of the positions unless said otherwise.
#[derive(Debug, Clone)]
pub struct KindScratch {
    /// Positions at the start of the step.
    pub start: Vec<f64>,
    /// Velocities at the start of the step (inertial schemes).
    pub start_velocity: Vec<f64>,
    /// Forces, pN, where they are asked for; the stages of the implicit step hold no more than those of a block.
    pub force: Vec<f64>,
    /// Increments of the first stage, µm, where the second is made after it and not block by block, or the sum of the velocities of
    /// all stages, µm/s (RK4); else empty.
    pub first: Vec<f64>,
    /// Sum of the accelerations of all stages, µm/s² (RK4); else empty.
    pub accelerations: Vec<f64>,
    /// Energy of each cell, padded, pN·µm.
    pub energy: Vec<f64>,
    /// Volume of each cell, padded, µm³.
    pub volume: Vec<f64>,
    /// What the cubic left of the volume error, padded, µm³.
    pub left: Vec<f64>,
    /// Pressure multiplier of each cell in the stage solved last, padded, pN/µm².
    pub pressure: Vec<f64>,
    /// Target volume of each cell, padded, µm³.
    pub target: Vec<f64>,
    /// One entry a block: contact with planes.
    pub touch: Vec<TouchScratch>,
    /// One entry a block: the thorough projection.
    pub project: Vec<ProjectScratch>,
    /// The shape that `stiffness` was made for, as in the state.
    pub stiffness_shape: Vec<f64>,
    /// Factor of K that covers what chemistry makes of the stiffness of the cells.
    pub stiffening: f64,
    /// The stiffness K of the implicit step where it is not that of the rest shape.
    stiffness: Option<StiffnessMatrix>,
    /// Factors of the steps used last, most recent first.
    factors: Vec<((u64, u64), Arc<Solver>)>,
}

/// Factors kept: the ladder of steps is coarse, so few are in use at a time.
const FACTORS_KEPT: usize = 6;

/// The factored matrix along each axis.
#[derive(Debug, Clone)]
pub struct Solver {
    /// Step over drag, µm/pN: the free mobility.
    pub mobility: f64,
    /// One factor, or three where atoms are held along some axes only.
    factors: Vec<Factor>,
}

impl Solver {
    /// Factors ζ/dt + γK for a kind.
    pub fn new(kind: &Kind, stiffness: &StiffnessMatrix, dt: f64, gamma: f64) -> Self {
        let held = |axis: usize| -> Vec<bool> {
            (0..kind.atoms()).map(|atom| kind.is_held() && kind.held[3 * atom + axis] == 0.0).collect()
        };
        let masks = [held(0), held(1), held(2)];
        let same = masks[0] == masks[1] && masks[1] == masks[2];
        let axes = if same { 1 } else { 3 };
        let factors = masks[..axes].iter().map(|mask| Factor::new(stiffness, kind.drag / dt, gamma, mask)).collect();
        Self { mobility: dt / kind.drag, factors }
    }

    /// Solves in place for the vectors of a block of `lanes` cells; `scratch` has the same size.
    pub fn solve(&self, lanes: usize, values: &mut [f64], scratch: &mut [f64]) {
        if let [factor] = &self.factors[..] {
            factor.solve(3 * lanes, values, scratch);
            return;
        }
        let (one, scratch) = scratch.split_at_mut(values.len() / 3);
        for (axis, factor) in self.factors.iter().enumerate() {
            for (to, from) in one.chunks_exact_mut(lanes).zip(values.chunks_exact(3 * lanes)) {
                to.copy_from_slice(&from[axis * lanes..(axis + 1) * lanes]);
            }
            factor.solve(lanes, one, &mut scratch[..values.len() / 3]);
            for (from, to) in one.chunks_exact(lanes).zip(values.chunks_exact_mut(3 * lanes)) {
                to[axis * lanes..(axis + 1) * lanes].copy_from_slice(from);
            }
        }
    }
}

impl KindScratch {
    fn new(kind: &Kind, inertial: bool) -> Self {
        let size = kind.blocks() * kind.block_len();
        let padded = kind.blocks() * kind.lanes;
        Self {
            start: vec![0.0; size],
            start_velocity: vec![0.0; if inertial { size } else { 0 }],
            force: Vec::new(),
            first: Vec::new(),
            accelerations: Vec::new(),
            energy: vec![0.0; padded],
            volume: vec![0.0; padded],
            left: vec![0.0; padded],
            pressure: vec![0.0; padded],
            target: vec![0.0; padded],
            touch: vec![TouchScratch::default(); kind.blocks()],
            project: vec![ProjectScratch::default(); kind.blocks()],
            stiffness_shape: Vec::new(),
            stiffening: 1.0,
            stiffness: None,
            factors: Vec::new(),
        }
    }

    /// The solver for a step, factored when it is new.
    pub fn solver(&mut self, kind: &Kind, dt: f64, gamma: f64) -> Arc<Solver> {
        let gamma = gamma * self.stiffening;
        let key = (dt.to_bits(), gamma.to_bits());
        if let Some(at) = self.factors.iter().position(|(known, _)| *known == key) {
            self.factors[..=at].rotate_right(1);
        } else {
            let stiffness = self.stiffness.as_ref().unwrap_or(&kind.stiffness);
            let solver = Arc::new(Solver::new(kind, stiffness, dt, gamma));
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
    }

    /// Writes NaN over all scratch numbers: a step must not notice.
    pub fn poison(&mut self) {
        self.set_stiffness(None, &[]);
        self.stiffening = f64::NAN;
        for array in [
            &mut self.start,
            &mut self.start_velocity,
            &mut self.force,
            &mut self.first,
            &mut self.accelerations,
            &mut self.energy,
            &mut self.volume,
            &mut self.left,
            &mut self.pressure,
            &mut self.target,
        ] {
            array.fill(f64::NAN);
        }
        self.touch.iter_mut().for_each(TouchScratch::poison);
        self.project.iter_mut().for_each(ProjectScratch::poison);
    }
}

impl Workspace {
    /// Scratch for a model.
    pub fn new(model: &Model) -> Self {
        let inertial = model.integrator.method.is_inertial();
        Self {
            kinds: model.kinds.iter().map(|kind| KindScratch::new(kind, inertial)).collect(),
            walks: Vec::new(),
            ended_runs: Vec::new(),
            drive: vec![[0.0; 3]; model.cells()],
            chemistry: ChemistryScratch::new(model),
            contact: ContactScratch::default(),
            rooms: Rooms::default(),
        }
    }

    /// Writes NaN over all scratch numbers: a step must not notice.
    pub fn poison(&mut self, model: &Model) {
        self.chemistry.poison(model);
        self.contact.poison();
        self.rooms.poison();
        self.kinds.iter_mut().for_each(KindScratch::poison);
        self.drive.fill([f64::NAN; 3]);
        self.walks.clear();
    }
}
