//! What membranes are worked on in: kept from step to step so that nothing is allocated meanwhile, and never saved.

use std::sync::{Mutex, PoisonError};

use super::evaluate::Registers;
use super::failure::Failure;
use super::mesh::SurfaceMesh;
use super::solve::Gradients;
use super::system::MembraneSystem;
use super::tableau::STAGES;
use crate::ode::{Piece, PopulationScratch};

/// Scratch of the membranes of a system. No result depends on what is in it.
#[derive(Debug, Default)]
pub struct MembraneScratch {
    pub(super) threads: Vec<Mutex<ThreadWork>>,
    /// Pools, then what is open of the inside: `[block][number][lane]`.
    pub(super) inside: Vec<f64>,
    /// What is shown of atoms: `[block][atom][lane]`.
    pub(super) shown: Vec<f64>,
    /// The pieces of a window between which the clock switches something; empty where it does not.
    pub(super) pieces: Vec<Piece>,
    pub(super) clock: PopulationScratch,
    /// What went wrong in each block.
    pub(super) failures: Vec<Option<Failure>>,
}

impl Clone for MembraneScratch {
    /// Empty scratch: nothing in it outlasts a step.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl MembraneScratch {
    /// Writes NaN over all numbers: a step must not notice.
    pub fn poison(&mut self) {
        self.inside.fill(f64::NAN);
        self.shown.fill(f64::NAN);
        self.pieces.clear();
        self.clock.poison();
        for own in &mut self.threads {
            let own = own.get_mut().unwrap_or_else(PoisonError::into_inner);
            own.one.iter_mut().for_each(|work| work.poison());
            own.eight.iter_mut().for_each(|work| work.poison());
        }
    }
}

/// What one thread works in, for single cells and for eight.
#[derive(Debug, Default)]
pub(super) struct ThreadWork {
    pub one: Option<Box<Work<1>>>,
    pub eight: Option<Box<Work<8>>>,
}

/// A block of `L` cells while it is moved. Arrays are `[variable][atom]`, one lane a cell.
#[derive(Debug, Default)]
pub(super) struct Work<const L: usize> {
    /// Positions in the middle of the step, `[atom][axis]`.
    pub x: Vec<[f64; L]>,
    /// The same from the centre of the surface, `[axis][atom]`.
    pub coordinates: Vec<[f64; L]>,
    /// What is set of atoms from outside.
    pub given: Vec<[f64; L]>,
    /// Areas of atoms, and weights of edges.
    pub areas: Vec<[f64; L]>,
    pub weights: Vec<[f64; L]>,
    /// Densities: where a step begins, where it ends, and at a stage.
    pub y: Vec<[f64; L]>,
    pub next: Vec<[f64; L]>,
    pub stage: Vec<[f64; L]>,
    /// Rates of all stages: of reactions, and of diffusion.
    pub explicit: Vec<[f64; L]>,
    pub implicit: Vec<[f64; L]>,
    /// Right side of a linear system.
    pub right: Vec<[f64; L]>,
    pub gradients: Gradients<L>,
    /// Pools: where a step begins, where it ends, at a stage, and their rates.
    pub pools: Vec<[f64; L]>,
    pub pools_next: Vec<[f64; L]>,
    pub pools_stage: Vec<[f64; L]>,
    pub pool_rates: Vec<[f64; L]>,
    /// What is open of the inside.
    pub open: Vec<[f64; L]>,
    /// Area and volume of the cells, one row each.
    pub area: Vec<[f64; L]>,
    pub volume: Vec<[f64; L]>,
    pub registers: Registers,
}

impl<const L: usize> Work<L> {
    /// Makes the arrays large enough; nothing is allocated where they are.
    pub fn suit(&mut self, system: &MembraneSystem, mesh: &SurfaceMesh) {
        let (atoms, variables, pools) = (mesh.atoms, system.variables(), system.inside.size());
        let suit = |array: &mut Vec<[f64; L]>, length: usize| array.resize(length, [0.0; L]);
        suit(&mut self.x, 3 * atoms);
        suit(&mut self.coordinates, 3 * atoms);
        suit(&mut self.given, system.given.len() * atoms);
        suit(&mut self.areas, atoms);
        suit(&mut self.weights, mesh.edges);
        for array in [&mut self.y, &mut self.next, &mut self.stage] {
            suit(array, variables * atoms);
        }
        suit(&mut self.explicit, STAGES * variables * atoms);
        suit(&mut self.implicit, STAGES * variables * atoms);
        suit(&mut self.right, atoms);
        self.gradients.suit(atoms);
        for array in [&mut self.pools, &mut self.pools_next, &mut self.pools_stage] {
            suit(array, pools);
        }
        suit(&mut self.pool_rates, STAGES * pools);
        suit(&mut self.open, system.inside.open.len());
        suit(&mut self.area, 1);
        suit(&mut self.volume, 1);
        self.registers.suit(system);
    }

    fn poison(&mut self) {
        for array in [
            &mut self.x,
            &mut self.coordinates,
            &mut self.given,
            &mut self.areas,
            &mut self.weights,
            &mut self.y,
            &mut self.next,
            &mut self.stage,
            &mut self.explicit,
            &mut self.implicit,
            &mut self.right,
            &mut self.pools,
            &mut self.pools_next,
            &mut self.pools_stage,
            &mut self.pool_rates,
            &mut self.open,
            &mut self.area,
            &mut self.volume,
        ] {
            array.fill([f64::NAN; L]);
        }
        self.gradients.poison();
        self.registers.poison();
    }
}
