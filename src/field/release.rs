//! Releases amounts into a field at many positions: the weights of four side by side, the boxes one after the other.

use pulp::{Simd, WithSimd};

use super::axis::{Axis, SIDE};
use crate::Vec3;

/// Releasing at many positions, so that it is compiled for the processor's lanes. It returns what the field gained.
pub struct ReleaseAll<'a> {
    pub axes: [Axis; 3],
    pub values: &'a mut [f64],
    /// Whether no value may go below zero.
    pub limited: bool,
    /// What an amount is divided by to be a value.
    pub measure: f64,
    pub positions: &'a [Vec3],
    pub amounts: &'a [f64],
}

impl WithSimd for ReleaseAll<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) -> f64 {
        let mut gained = 0.0;
        let (positions, last) = self.positions.as_chunks::<SIDE>();
        let (amounts, rest) = self.amounts.as_chunks::<SIDE>();
        let flat = self.axes[2].n == 1;
        for (positions, amounts) in positions.iter().zip(amounts) {
            let done = match flat {
                true => self.side_by_side::<true>(positions, amounts),
                false => self.side_by_side::<false>(positions, amounts),
            };
            if done {
                amounts.iter().for_each(|amount| gained += amount);
            } else {
                self.plainly(positions, amounts, &mut gained);
            }
        }
        self.plainly(last, rest, &mut gained);
        gained
    }
}

impl ReleaseAll<'_> {
    /// Releases at four positions, none of them near a wall, no amount below zero where that is limited; or does nothing
    /// and returns false. The same operations in the same order as [`Self::plainly`].
    #[inline(always)]
    fn side_by_side<const FLAT: bool>(&mut self, positions: &[Vec3; SIDE], amounts: &[f64; SIDE]) -> bool {
        let axes = &self.axes;
        let least = if self.limited { 0.0 } else { -f64::MAX };
        let mut fine = [true; SIDE];
        for l in 0..SIDE {
            fine[l] = (amounts[l] >= least) & (amounts[l] <= f64::MAX);
        }
        let x = pairs(&axes[0], positions.each_ref().map(|p| p.x), &mut fine);
        let y = pairs(&axes[1], positions.each_ref().map(|p| p.y), &mut fine);
        let flat = ([1; SIDE], [0.0; SIDE]);
        let z = if FLAT { flat } else { pairs(&axes[2], positions.each_ref().map(|p| p.z), &mut fine) };
        if fine != [true; SIDE] {
            return false;
        }
        let inverse = 1.0 / self.measure;
        // `[z][y][x][position]`
        let mut shares = [[[[0.0; SIDE]; 2]; 2]; 2];
        for l in 0..SIDE {
            let density = amounts[l] * inverse;
            let (wx, wy, wz) = ([1.0 - x.1[l], x.1[l]], [1.0 - y.1[l], y.1[l]], [1.0 - z.1[l], z.1[l]]);
            for k in 0..if FLAT { 1 } else { 2 } {
                for j in 0..2 {
                    for i in 0..2 {
                        shares[k][j][i][l] = wx[i] * (wy[j] * wz[k]) * density;
                    }
                }
            }
        }
        let (nx, across) = (axes[0].n, axes[0].n * axes[1].n);
        for l in 0..SIDE {
            let (x, y, z) = (x.0[l] as usize - 1, y.0[l] as usize - 1, z.0[l] as usize - 1);
            for k in 0..if FLAT { 1 } else { 2 } {
                let share = &shares[k];
                let first = (z + k) * across + y * nx + x;
                let rows = &mut self.values[first..first + nx + 2];
                rows[0] += share[0][0][l];
                rows[1] += share[0][1][l];
                rows[nx] += share[1][0][l];
                rows[nx + 1] += share[1][1][l];
            }
        }
        true
    }

    /// Releases at positions one after the other, wherever they are.
    #[inline(never)]
    pub fn plainly(&mut self, positions: &[Vec3], amounts: &[f64], gained: &mut f64) {
        let (measure, inverse) = (self.measure, 1.0 / self.measure);
        for (position, amount) in positions.iter().zip(amounts) {
            if !(position.iter().all(|p| p.is_finite()) && amount.is_finite()) {
                continue;
            }
            let density = amount * inverse;
            if density >= 0.0 || !self.limited {
                around(&self.axes, self.values, position, |value, weight| *value += weight * density);
                *gained += amount;
            } else {
                around(&self.axes, self.values, position, |value, weight| {
                    let taken = (weight * density).max(-*value);
                    *value = (*value + taken).max(0.0);
                    *gained += taken * measure;
                });
            }
        }
    }
}

/// For four positions the second of the two boxes along an axis that share what is released, and its part.
#[inline(always)]
fn pairs(axis: &Axis, mut positions: [f64; SIDE], fine: &mut [bool; SIDE]) -> ([i32; SIDE], [f64; SIDE]) {
    for position in &mut positions {
        *position += axis.half;
    }
    axis.boxes(&positions, 0.0, fine)
}

/// Calls back for each box around a position with its weight; the weights sum to one.
#[inline(always)]
fn around(axes: &[Axis; 3], values: &mut [f64], position: &Vec3, mut change: impl FnMut(&mut f64, f64)) {
    let ((xs, wx), (ys, wy), (zs, wz)) = (axes[0].pair(position.x), axes[1].pair(position.y), axes[2].pair(position.z));
    let (nx, ny, deep) = (axes[0].n, axes[1].n, if axes[2].n == 1 { 1 } else { 2 });
    for (z, wz) in zs.into_iter().zip([1.0 - wz, wz]).take(deep) {
        for (y, wy) in ys.into_iter().zip([1.0 - wy, wy]) {
            let row = (z * ny + y) * nx;
            change(&mut values[row + xs[0]], (1.0 - wx) * (wy * wz));
            change(&mut values[row + xs[1]], wx * (wy * wz));
        }
    }
}
