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
    /// Sums over each block.
    pub sums: Vec<f64>,
}

impl Coupled {
    /// Whether anything couples the cells in the step that is being made.
    pub fn couples(&self) -> bool {
        !self.change.is_empty()
    }

    /// Makes arrays of so many numbers, and sums of so many blocks; none where nothing couples the cells.
    pub fn suit(&mut self, size: usize, blocks: usize) {
        self.arrays().into_iter().for_each(|array| array.resize(size, 0.0));
        self.sums.resize(blocks, 0.0);
    }

    fn arrays(&mut self) -> [&mut Vec<f64>; 8] {
        let Self { gradient, swell, second, residual, spare, direction, pushed, change, .. } = self;
        [gradient, swell, second, residual, spare, direction, pushed, change]
    }

    /// Writes NaN over all numbers.
    pub fn poison(&mut self) {
        self.arrays().into_iter().for_each(|array| array.fill(f64::NAN));
        self.sums.fill(f64::NAN);
        self.solver = None;
    }
}
