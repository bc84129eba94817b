//! Cells that loads hold in a direction turn back within a step, not after it: what the implicit step answers to torques, eq. (step.13).

use nalgebra::Matrix3;

use super::forces::Forces;
use super::model::Model;
use crate::Vec3;
use crate::mechanics::lanes::LANES;

/// What becomes of the rotation that torques cause of cells that nothing holds, for the cells of a block: nine numbers of each, row by row.
pub struct Turning {
    rows: [f64; 9 * LANES],
    lanes: usize,
}

impl Turning {
    /// That of the cells of a block at `x`, µm, whose loads are those of a time, s; `mobility` is step over drag, µm/pN, and `gamma` that of the
    /// scheme. Without loads, and where contacts or obstacles find out by themselves how cells give way, they turn as if nothing held them.
    pub fn of(
        model: &Model,
        (forces, block): (&Forces, usize),
        time: f64,
        x: &[f64],
        (mobility, gamma): (f64, f64),
    ) -> Self {
        let kind = forces.kind;
        let mut turning = Self { rows: [0.0; 9 * LANES], lanes: 0 };
        let may_turn = model.contact.is_none() && model.obstacles.is_empty() && kind.may_turn();
        if !may_turn || kind.loads().next().is_none() {
            return turning;
        }
        for lane in 0..kind.lanes {
            let restoring = gamma * mobility * forces.restoring(block, lane, time, x);
            let inertia = inertia(kind.lanes, lane, x);
            let held = inertia + restoring;
            if restoring == Matrix3::zeros() {
                turning.set(kind.lanes, lane, &Matrix3::identity());
            } else {
                turning.lanes = kind.lanes;
                let share = held.try_inverse().map_or_else(Matrix3::identity, |inverse| inverse * inertia);
                turning.set(kind.lanes, lane, &share);
            }
        }
        turning
    }

    /// The numbers as a block has those of three atoms; none where all cells turn freely.
    pub fn rows(&self) -> &[f64] {
        &self.rows[..9 * self.lanes]
    }

    fn set(&mut self, lanes: usize, lane: usize, share: &Matrix3<f64>) {
        (0..9).for_each(|number| self.rows[number * lanes + lane] = share[(number / 3, number % 3)]);
    }
}

/// Σ r² − r rᵀ about the centre of the cell of a lane, µm².
fn inertia(lanes: usize, lane: usize, x: &[f64]) -> Matrix3<f64> {
    let atoms = x.len() / (3 * lanes);
    let at = |atom: usize| Vec3::from_fn(|axis, _| x[(3 * atom + axis) * lanes + lane]);
    let centre = (0..atoms).map(at).sum::<Vec3>() / atoms as f64;
    let of = |r: Vec3| Matrix3::from_diagonal_element(r.norm_squared()) - r * r.transpose();
    (0..atoms).map(|atom| of(at(atom) - centre)).sum()
}
