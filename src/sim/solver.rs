//! The linear system of the implicit step: A = ζ/dt + γK, factored, with rigid motion taken out, eq. (step.4).

use super::kind::Kind;
use crate::mechanics::implicit::Factor;
use crate::mechanics::stiffness::StiffnessMatrix;
use crate::mechanics::{rigid, volume};

/// Which stage of a step a solve belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The first, or the only one.
    First,
    /// The second of [`Order::Second`].
    Second,
}

/// The factored matrix along each axis.
#[derive(Debug, Clone)]
pub struct Solver {
    /// Step over drag, µm/pN: the free mobility.
    pub mobility: f64,
    /// One factor, or three where atoms are held along some axes only.
    factors: Vec<Factor>,
    /// The same with the least that K may overestimate; none where it tells nothing.
    filters: Vec<Factor>,
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
        let of = |scale: f64| -> Vec<Factor> {
            masks[..axes].iter().map(|mask| Factor::new(stiffness, kind.drag / dt, scale, mask)).collect()
        };
        let filters = if kind.is_told() { of(gamma * kind.softest_ratio) } else { Vec::new() };
        Self { mobility: dt / kind.drag, factors: of(gamma), filters }
    }

    /// Takes out of an error what the stiff shapes of a cell have by being stiff, eq. (step.9); scratch has the same size.
    pub fn filter(&self, kind: &Kind, x: &[f64], error: &mut [f64], rigid: &mut [f64], scratch: &mut [f64]) {
        if self.filters.is_empty() {
            return;
        }
        error.iter_mut().for_each(|error| *error /= self.mobility);
        solve_with(&self.filters, kind, (kind.lanes, self.mobility), x, error, rigid, scratch);
    }

    /// Solves in place for the vectors of a block of `lanes` cells; `scratch` has the same size.
    pub fn solve(&self, lanes: usize, values: &mut [f64], scratch: &mut [f64]) {
        solve_axes(&self.factors, lanes, values, scratch);
    }
}

fn solve_axes(factors: &[Factor], lanes: usize, values: &mut [f64], scratch: &mut [f64]) {
    if let [factor] = factors {
        factor.solve(3 * lanes, values, scratch);
        return;
    }
    let (one, scratch) = scratch.split_at_mut(values.len() / 3);
    for (axis, factor) in factors.iter().enumerate() {
        for (to, from) in one.chunks_exact_mut(lanes).zip(values.chunks_exact(3 * lanes)) {
            to.copy_from_slice(&from[axis * lanes..(axis + 1) * lanes]);
        }
        factor.solve(lanes, one, &mut scratch[..values.len() / 3]);
        for (from, to) in one.chunks_exact(lanes).zip(values.chunks_exact_mut(3 * lanes)) {
            to[axis * lanes..(axis + 1) * lanes].copy_from_slice(from);
        }
    }
}

/// Solves A Y = F for a block of `lanes` cells with rigid motion taken out, eq. (step.4); F is replaced by Y.
pub fn solve_block(
    kind: &Kind,
    lanes: usize,
    solver: &Solver,
    x: &[f64],
    y: &mut [f64],
    spare: &mut [f64],
    spare2: &mut [f64],
) {
    solve_with(&solver.factors, kind, (lanes, solver.mobility), x, y, spare, spare2);
}

fn solve_with(
    factors: &[Factor],
    kind: &Kind,
    (lanes, mobility): (usize, f64),
    x: &[f64],
    y: &mut [f64],
    spare: &mut [f64],
    spare2: &mut [f64],
) {
    if kind.is_held() {
        volume::hold(lanes, &kind.held, y);
        solve_axes(factors, lanes, y, spare);
    } else {
        rigid::split_block(lanes, kind.atoms(), x, y, spare, mobility);
        solve_axes(factors, lanes, y, spare2);
        rigid::join_block(lanes, kind.atoms(), x, y, spare);
    }
}
