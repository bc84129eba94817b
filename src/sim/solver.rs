//! The linear system of the implicit step: A = ζ/dt + γK, factored, with rigid motion taken out, eq. (step.4). K is the constant one
//! of a kind or, where that tells nothing of some shapes, the tangent stiffness of each cell.

use super::kind::Kind;
use crate::mechanics::implicit::Factor;
use crate::mechanics::rigid::Whole;
use crate::mechanics::stiffness::StiffnessMatrix;
use crate::mechanics::tangent::{Scales, Tangent};
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
    /// What is left of the mean of forces on a cell as traps answer within the step, eq. (rigid.4).
    going: f64,
    /// One factor, or three where atoms are held along some axes only.
    factors: Vec<Factor>,
    /// The same with the least that K may overestimate; none where it tells nothing.
    filters: Vec<Factor>,
    /// The factor of the tangent stiffness of a cell that stands alone, and nothing of the above; else empty.
    pub own: Vec<f64>,
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
        let mobility = dt / kind.drag;
        let going = 1.0 / (1.0 + gamma * mobility * kind.drawn() / kind.atoms() as f64);
        if kind.rigid.is_some() {
            return Self { mobility, going, factors: Vec::new(), filters: Vec::new(), own: Vec::new() };
        }
        let of = |scale: f64| -> Vec<Factor> {
            masks[..axes].iter().map(|mask| Factor::new(stiffness, kind.drag / dt, scale, mask)).collect()
        };
        let filters = if kind.is_told() { of(gamma * kind.softest_ratio) } else { Vec::new() };
        Self { mobility, going, factors: of(gamma), filters, own: Vec::new() }
    }

    /// Solves A y = f for one cell in place, whatever moves it as a whole; scratch has the same size.
    pub fn solve_elastic(&self, y: &mut [f64], scratch: &mut [f64]) {
        solve_axes(&self.factors, 1, y, scratch);
    }

    /// Factors ζ/dt + γJ for the cell of a kind that stands alone, with its tangent stiffness J in this shape (µm), elastic forces so
    /// many times as strong. Without a shape each block of cells has its own system, and nothing is factored.
    pub fn of_one(kind: &Kind, tangent: &Tangent, shape: &[f64], dt: f64, (gamma, elastic): (f64, f64)) -> Self {
        let mut own = Vec::new();
        if !shape.is_empty() {
            own.resize(tangent.len(1), 0.0);
            let (diagonal, held) = (kind.drag / dt, &kind.held[..]);
            let scales = Scales { diagonal, gamma, elastic: &[elastic], held, viscous: None };
            tangent.factor(&kind.forces, 1, shape, scales, &mut own);
        }
        Self { mobility: dt / kind.drag, going: 1.0, factors: Vec::new(), filters: Vec::new(), own }
    }
}

/// The linear system of the cells of a block.
#[derive(Debug, Clone, Copy)]
pub enum System<'a> {
    /// That of all cells of the kind.
    Shared(&'a Solver),
    /// That of each cell by itself.
    Own {
        /// Step over drag, µm/pN: the free mobility.
        mobility: f64,
        /// How it is solved.
        tangent: &'a Tangent,
        /// The factor of the block.
        factor: &'a [f64],
        /// Lanes of the block.
        lanes: usize,
    },
}

impl<'a> System<'a> {
    /// Step over drag, µm/pN: the free mobility.
    pub fn mobility(&self) -> f64 {
        match *self {
            Self::Shared(solver) => solver.mobility,
            Self::Own { mobility, .. } => mobility,
        }
    }

    /// How the cells give way as a whole; `turned` as in [`solve_turning`].
    fn whole<'b>(&self, kind: &Kind, turned: &'b [f64]) -> Whole<'b> {
        let going = if let Self::Shared(solver) = *self { solver.going } else { 1.0 };
        let turning = if kind.rigid.is_none_or(|rigid| rigid.turns) { 1.0 } else { 0.0 };
        Whole { mobility: self.mobility(), going, turning, turned }
    }

    /// The same for one cell of the block alone, whose factor is gathered into `kept`: a lane is solved as fast as a cell that stands alone
    /// then, and several right sides at a time.
    pub fn of_lane<'b>(self, lane: usize, kept: &'b mut Vec<f64>) -> System<'b>
    where
        'a: 'b,
    {
        match self {
            System::Own { mobility, tangent, factor, lanes } if lanes > 1 => {
                kept.clear();
                kept.extend(factor.iter().skip(lane).step_by(lanes));
                System::Own { mobility, tangent, factor: kept, lanes: 1 }
            }
            system => system,
        }
    }

    /// Takes out of an error what the stiff shapes of a cell have by being stiff, eq. (step.9); scratch has the same size.
    /// `turning` as in [`solve_turning`].
    pub fn filter(
        &self,
        kind: &Kind,
        (x, turning): (&[f64], &[f64]),
        error: &mut [f64],
        rigid: &mut [f64],
        scratch: &mut [f64],
    ) {
        let mobility = self.mobility();
        match *self {
            Self::Shared(solver) if solver.filters.is_empty() => {}
            Self::Shared(solver) => {
                error.iter_mut().for_each(|error| *error /= mobility);
                let solve = |y: &mut [f64], scratch: &mut [f64]| solve_axes(&solver.filters, kind.lanes, y, scratch);
                solve_with(solve, kind, kind.lanes, (x, self.whole(kind, turning)), error, rigid, scratch);
            }
            Self::Own { .. } => {
                scratch.copy_from_slice(error);
                error.iter_mut().for_each(|error| *error /= mobility);
                kind.add_resistance(kind.lanes, 1.0 / (kind.drag * mobility), [x, scratch], error);
                solve_turning(kind, kind.lanes, self, (x, turning), error, rigid, scratch);
            }
        }
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

/// Solves A Y = F for a block of `lanes` cells, or of as many right sides of one cell that has a stiffness of its own, with rigid motion
/// taken out, eq. (step.4); F is replaced by Y. Of such a cell there may be several sets of right sides, one after the other.
pub fn solve_block(
    kind: &Kind,
    lanes: usize,
    system: &System,
    x: &[f64],
    y: &mut [f64],
    spare: &mut [f64],
    spare2: &mut [f64],
) {
    solve_turning(kind, lanes, system, (x, &[]), y, spare, spare2);
}

/// The same for cells that loads hold in a direction: `turning` is what [`Turning`](super::turning::Turning) makes of rotations, empty where
/// cells turn freely.
pub fn solve_turning(
    kind: &Kind,
    lanes: usize,
    system: &System,
    (x, turning): (&[f64], &[f64]),
    y: &mut [f64],
    spare: &mut [f64],
    spare2: &mut [f64],
) {
    let solve = |y: &mut [f64], scratch: &mut [f64]| match *system {
        System::Shared(solver) => solve_axes(&solver.factors, lanes, y, scratch),
        // Several right sides of a cell that stands alone.
        System::Own { tangent, factor, lanes: 1, .. } if lanes > 1 => tangent.solve_columns(factor, y),
        System::Own { tangent, factor, lanes: all, .. } => tangent.solve(all, factor, y),
    };
    solve_with(solve, kind, lanes, (x, system.whole(kind, turning)), y, spare, spare2);
}

fn solve_with(
    solve: impl Fn(&mut [f64], &mut [f64]),
    kind: &Kind,
    lanes: usize,
    (x, whole): (&[f64], Whole),
    y: &mut [f64],
    spare: &mut [f64],
    spare2: &mut [f64],
) {
    let set = 3 * kind.atoms() * lanes;
    if kind.is_held() {
        y.chunks_exact_mut(set).for_each(|y| volume::hold(lanes, &kind.held, y));
        solve(y, spare);
    } else {
        for (y, spare) in y.chunks_exact_mut(set).zip(spare.chunks_exact_mut(set)) {
            rigid::split_block(lanes, kind.atoms(), x, y, spare, whole);
        }
        if kind.rigid.is_some() {
            return y.copy_from_slice(spare);
        }
        solve(y, spare2);
        for (y, spare) in y.chunks_exact_mut(set).zip(spare.chunks_exact(set)) {
            rigid::join_block(lanes, kind.atoms(), x, y, spare);
        }
    }
}
