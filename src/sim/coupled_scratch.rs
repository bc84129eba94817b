//! Scratch of the coupled step.

use std::sync::Arc;

use super::solver::Solver;

/// What the solution needs of the cells of a kind: arrays in the shape of their positions, empty where nothing couples them.
#[derive(Debug, Clone, Default)]
pub struct Coupled {
    /// The gradients of the volumes where the step begins, µm².
    pub gradient: Vec<f64>,
    /// What a unit of pressure moves, µm³/pN.
    pub swell: Vec<f64>,
    /// Increments of the second stage, and then the error estimate, µm.
    pub second: Vec<f64>,
    /// How each cell answers by itself.
    pub solver: Option<Arc<Solver>>,
    /// Forces that are not answered yet, pN.
    pub residual: Vec<f64>,
    /// What these would move of each cell by itself, µm; then what the direction is answered by, pN.
    pub spare: Vec<f64>,
    /// The direction of the search, µm, and the forces that would move each cell by itself so, pN.
    pub direction: Vec<f64>,
    pub pushed: Vec<f64>,
    /// What the increments become more, µm.
    pub change: Vec<f64>,
    /// What moves so that slopes make of it what is not answered yet, and what pushes in that direction, µm; empty where tractions are not kept.
    pub left: Vec<f64>,
    pub pushes: Vec<f64>,
    /// Sums over each block.
    pub sums: Vec<f64>,
}

impl Coupled {
    /// Whether anything couples the cells in the step that is being made.
    pub fn couples(&self) -> bool {
        !self.change.is_empty()
    }

    /// Makes arrays of so many numbers, and sums of so many blocks; none where nothing couples the cells. Those are left out that only
    /// tractions need if they are not kept.
    pub fn suit(&mut self, size: usize, blocks: usize, keeps_tractions: bool) {
        self.arrays().into_iter().for_each(|array| array.resize(size, 0.0));
        let size = if keeps_tractions { size } else { 0 };
        [&mut self.left, &mut self.pushes].into_iter().for_each(|array| array.resize(size, 0.0));
        self.sums.resize(blocks, 0.0);
    }

    fn arrays(&mut self) -> [&mut Vec<f64>; 8] {
        let Self { gradient, swell, second, residual, spare, direction, pushed, change, .. } = self;
        [gradient, swell, second, residual, spare, direction, pushed, change]
    }

    /// Writes NaN over all numbers.
    pub fn poison(&mut self) {
        self.arrays().into_iter().for_each(|array| array.fill(f64::NAN));
        [&mut self.left, &mut self.pushes].into_iter().for_each(|array| array.fill(f64::NAN));
        self.sums.fill(f64::NAN);
        self.solver = None;
    }
}
