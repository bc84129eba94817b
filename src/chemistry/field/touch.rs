//! What cells do to a field: release amounts into it, and sense its value and gradient.

use pulp::{Arch, Simd, WithSimd};

use super::grid::{Grid, Wall};
use super::species::{Range, Species};
use super::state::Fields;
use crate::Vec3;

/// What is sensed at a position.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sensed {
    /// Value there.
    pub value: f64,
    /// Gradient there, per µm.
    pub gradient: Vec3,
}

/// One axis of the grid as positions need it.
#[derive(Clone, Copy)]
struct Axis {
    n: usize,
    origin: f64,
    inverse: f64,
    half: f64,
    size: f64,
    walls: [Wall; 2],
}

impl Axis {
    fn all(grid: &Grid, species: &Species) -> [Self; 3] {
        std::array::from_fn(|axis| Self {
            n: grid.cells[axis],
            origin: grid.origin[axis],
            inverse: 1.0 / grid.spacing[axis],
            half: 0.5 * grid.spacing[axis],
            size: grid.cells[axis] as f64,
            walls: species.walls[axis],
        })
    }

    fn periodic(&self) -> bool {
        self.walls[0] == Wall::Periodic
    }

    /// Distance from the low wall in boxes. Beyond a wall counts as at the wall; a ring is gone round.
    #[inline(always)]
    fn place(&self, position: f64) -> f64 {
        let (place, n) = ((position - self.origin) * self.inverse, self.n as f64);
        if place >= 0.0 && place <= n {
            return place;
        }
        if self.periodic() { place.rem_euclid(n).min(n) } else { place.clamp(0.0, n) }
    }

    /// The box that holds a position and the part of it below the position, if `below` boxes lie before it and `above`
    /// after it on the grid.
    #[inline(always)]
    fn inside(&self, position: f64, below: f64, above: f64) -> Option<(usize, f64)> {
        let place = (position - self.origin) * self.inverse;
        if !(place >= below && place < self.size - above) {
            return None;
        }
        // SAFETY: not negative and less than a number of boxes, which memory can count.
        let box_at: i64 = unsafe { place.to_int_unchecked() };
        Some((box_at as usize, place - box_at as f64))
    }

    /// The two boxes that share what is released, and the part of the second.
    #[inline(always)]
    fn pair(&self, position: f64) -> ([usize; 2], f64) {
        if self.n == 1 {
            return ([0, 0], 0.0);
        }
        let shifted = self.place(position) + 0.5;
        let high = shifted as usize;
        let part = shifted - high as f64;
        let (first, last) = if self.periodic() { (self.n - 1, 0) } else { (0, self.n - 1) };
        // What would lie beyond a wall is folded back into the box at the wall.
        ([if high == 0 { first } else { high - 1 }, if high >= self.n { last } else { high }], part)
    }
}

/// The boxes along one axis that a sensed value depends on: Σ weights·u + constant, and the same for the slope.
#[derive(Clone, Copy)]
struct Stencil<const N: usize> {
    at: [usize; N],
    weights: [f64; N],
    slopes: [f64; N],
    constant: [f64; 2],
}

impl<const N: usize> Stencil<N> {
    /// The quadratic B-spline around the box that holds the position, eq. (field.9).
    #[inline(always)]
    fn of(axis: &Axis, position: f64) -> Self {
        let n = axis.n;
        if n == 1 {
            let mut weights = [0.0; N];
            weights[0] = 1.0;
            return Self { at: [0; N], weights, slopes: [0.0; N], constant: [0.0; 2] };
        }
        let place = axis.place(position);
        let i = (place as usize).min(n - 1);
        let (t, inverse) = (place - i as f64 - 0.5, axis.inverse);
        let weights = [0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)];
        let slopes = [(t - 0.5) * inverse, -2.0 * t * inverse, (t + 0.5) * inverse];
        if i > 0 && i + N < n + 2 {
            let mut inside = Self { at: [0; N], weights: [0.0; N], slopes: [0.0; N], constant: [0.0; 2] };
            for k in 0..N {
                inside.at[k] = i - 1 + k;
            }
            inside.weights[..3].copy_from_slice(&weights);
            inside.slopes[..3].copy_from_slice(&slopes);
            return inside;
        }
        Self::at_wall(axis, i, weights, slopes)
    }

    /// Near a wall: the box beyond it takes the value that the wall asks for, eq. (field.10).
    #[inline(never)]
    fn at_wall(axis: &Axis, i: usize, mut weights: [f64; 3], mut slopes: [f64; 3]) -> Self {
        let (n, mut constant) = (axis.n, [0.0; 2]);
        let outside = if i == 0 { Some((0, 2)) } else { (i + 1 == n).then_some((2, 0)) };
        if let Some((beyond, inner)) = outside {
            match axis.walls[usize::from(i != 0)] {
                Wall::Periodic => {}
                Wall::NoFlux => {
                    for w in [&mut weights, &mut slopes] {
                        w[1] += w[beyond];
                        w[beyond] = 0.0;
                    }
                }
                Wall::Fixed(value) => {
                    for (w, constant) in [&mut weights, &mut slopes].into_iter().zip(&mut constant) {
                        w[1] -= 2.0 * w[beyond];
                        w[inner] += w[beyond] / 3.0;
                        *constant += 8.0 / 3.0 * value * w[beyond];
                        w[beyond] = 0.0;
                    }
                }
            }
        }
        let mut at = [i; N];
        let (mut w, mut s) = ([0.0; N], [0.0; N]);
        for k in 0..3 {
            at[k] = if axis.periodic() { (i + n + k - 1) % n } else { (i + k).max(1).min(n) - 1 };
            (w[k], s[k]) = (weights[k], slopes[k]);
        }
        Self { at, weights: w, slopes: s, constant }
    }
}

/// The quadratic B-spline and its slope at part `t` of a box, counted from its low side, eq. (field.9).
#[inline(always)]
fn spline(t: f64, inverse: f64) -> ([f64; 3], [f64; 3]) {
    let (low, high) = (1.0 - t, t - 0.5);
    let weights = [0.5 * low * low, 0.75 - high * high, 0.5 * t * t];
    (weights, [-low * inverse, -2.0 * high * inverse, t * inverse])
}

/// Four boxes side by side along x.
#[inline(always)]
fn four(rows: &[f64], first: usize) -> &[f64; 4] {
    rows[first..].first_chunk().expect("four boxes")
}

/// A weighted sum of three runs of four numbers.
#[inline(always)]
fn sum(weights: &[f64; 3], of: [&[f64; 4]; 3]) -> [f64; 4] {
    let mut sum = [0.0; 4];
    for l in 0..4 {
        sum[l] = (weights[0] * of[0][l] + weights[1] * of[1][l]) + weights[2] * of[2][l];
    }
    sum
}

/// A weighted sum of three of four numbers.
#[inline(always)]
fn dot(weights: &[f64; 3], of: &[f64; 4]) -> f64 {
    (weights[0] * of[0] + weights[1] * of[1]) + weights[2] * of[2]
}

/// Three rows of four boxes, added up with weights across the rows, and with the weights of the slope across them.
#[inline(always)]
fn plane(values: &[f64], first: usize, nx: usize, (weights, slopes): &([f64; 3], [f64; 3])) -> [[f64; 4]; 2] {
    let rows = &values[first..first + 2 * nx + 4];
    let (a, b, c) = (four(rows, 0), four(rows, nx), four(rows, 2 * nx));
    [sum(weights, [a, b, c]), sum(slopes, [a, b, c])]
}

/// The value and gradient at a position; four boxes along x at a time where no wall is near.
#[inline(always)]
fn sense(axes: &[Axis; 3], values: &[f64], position: Vec3, floor: f64) -> Sensed {
    let flat = axes[2].n == 1;
    let place = |axis: usize| (position[axis] - axes[axis].origin) * axes[axis].inverse;
    let (x, y, z) = (place(0), place(1), if flat { 1.5 } else { place(2) });
    // Not written as its contrary, so that a position that is not a number is near a wall too.
    let within = |place: f64, axis: usize, above: f64| (place >= 1.0) & (place < axes[axis].size - above);
    if !(within(x, 0, 2.0) & within(y, 1, 1.0) & (flat | within(z, 2, 1.0))) {
        return sense_at_wall(axes, values, position, floor);
    }
    // SAFETY: the places are not negative and less than numbers of boxes, which memory can count.
    let (i, j, k): (i64, i64, i64) = unsafe { (x.to_int_unchecked(), y.to_int_unchecked(), z.to_int_unchecked()) };
    let (x, y, z) = ((i as usize, x - i as f64), (j as usize, y - j as f64), (k as usize, z - k as f64));
    let (nx, across) = (axes[0].n, axes[0].n * axes[1].n);
    let ((wx, sx), across_y) = (spline(x.1, axes[0].inverse), spline(y.1, axes[1].inverse));
    let first = (z.0 - 1) * across + (y.0 - 1) * nx + x.0 - 1;
    let (value, along_y, along_z) = if flat {
        let [level, slope] = plane(values, first, nx, &across_y);
        (level, slope, [0.0; 4])
    } else {
        let (wz, sz) = spline(z.1, axes[2].inverse);
        let a = plane(values, first, nx, &across_y);
        let b = plane(values, first + across, nx, &across_y);
        let c = plane(values, first + 2 * across, nx, &across_y);
        let level = [&a[0], &b[0], &c[0]];
        (sum(&wz, level), sum(&wz, [&a[1], &b[1], &c[1]]), sum(&sz, level))
    };
    let value_here = dot(&wx, &value);
    Sensed {
        value: if value_here < floor { floor } else { value_here },
        gradient: Vec3::new(dot(&sx, &value), dot(&wx, &along_y), dot(&wx, &along_z)),
    }
}

/// The same where a wall is near, or the grid is narrow, or the position lies beyond it.
#[inline(never)]
fn sense_at_wall(axes: &[Axis; 3], values: &[f64], position: Vec3, floor: f64) -> Sensed {
    let (x, y) = (Stencil::<4>::of(&axes[0], position.x), Stencil::<3>::of(&axes[1], position.y));
    let z = Stencil::<3>::of(&axes[2], position.z);
    let (nx, ny, deep) = (axes[0].n, axes[1].n, if axes[2].n == 1 { 1 } else { 3 });
    let (mut value, mut along_y, mut along_z) = ([0.0; 4], [0.0; 4], [0.0; 4]);
    let together = x.at[3] == x.at[0] + 3;
    for k in 0..deep {
        let (mut plane, mut slope) = ([0.0; 4], [0.0; 4]);
        for j in 0..3 {
            let first = (z.at[k] * ny + y.at[j]) * nx;
            let row: [f64; 4] = match values[first + x.at[0]..].first_chunk::<4>() {
                Some(row) if together => *row,
                _ => x.at.map(|at| values[first + at]),
            };
            for l in 0..4 {
                plane[l] += y.weights[j] * row[l];
                slope[l] += y.slopes[j] * row[l];
            }
        }
        for l in 0..4 {
            value[l] += z.weights[k] * plane[l];
            along_y[l] += z.weights[k] * slope[l];
            along_z[l] += z.slopes[k] * plane[l];
        }
    }
    let dot = |a: &[f64; 4], b: &[f64; 4]| (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]);
    let mut sensed = Sensed {
        value: dot(&x.weights, &value),
        gradient: Vec3::new(dot(&x.slopes, &value), dot(&x.weights, &along_y), dot(&x.weights, &along_z)),
    };
    if x.constant != [0.0; 2] || y.constant != [0.0; 2] || z.constant != [0.0; 2] {
        let sum = |of: &[f64; 3]| of[0] + of[1] + of[2];
        let (wy, wz, sy, sz) = (sum(&y.weights), sum(&z.weights), sum(&y.slopes), sum(&z.slopes));
        sensed.value += (x.constant[0] * wy + y.constant[0]) * wz + z.constant[0];
        sensed.gradient.x += x.constant[1] * wy * wz;
        sensed.gradient.y += (x.constant[0] * sy + y.constant[1]) * wz;
        sensed.gradient.z += (x.constant[0] * wy + y.constant[0]) * sz + z.constant[1];
    }
    if sensed.value < floor {
        sensed.value = floor;
    }
    sensed
}

impl Fields {
    /// Releases an amount of a species at a position, into the boxes around it, eq. (field.8). A position beyond a
    /// wall counts as at the wall. A negative amount is taken up, of a concentration at most what is there. Returns
    /// the amount that the field gained; 0 if the position or the amount is not finite.
    ///
    /// # Panics
    /// If there is no such species.
    pub fn deposit(&mut self, species: usize, position: Vec3, amount: f64) -> f64 {
        self.deposit_all(species, &[position], &[amount])
    }

    /// Releases amounts at positions, one after the other; see [`Fields::deposit`]. Returns the sum of what the field
    /// gained. Allocates nothing.
    ///
    /// # Panics
    /// If there is no such species, or not one amount for each position.
    pub fn deposit_all(&mut self, species: usize, positions: &[Vec3], amounts: &[f64]) -> f64 {
        assert_eq!(positions.len(), amounts.len(), "an amount for each position");
        let axes = Axis::all(&self.grid, &self.species[species]);
        let limited = self.species[species].range == Range::NonNegative;
        let (measure, len) = (self.grid.measure(), self.grid.len());
        let inverse = 1.0 / measure;
        let values = &mut self.values[species * len..(species + 1) * len];
        let mut gained = 0.0;
        for (position, amount) in positions.iter().zip(amounts) {
            if !(position.iter().all(|p| p.is_finite()) && amount.is_finite()) {
                continue;
            }
            let density = amount * inverse;
            if density >= 0.0 || !limited {
                release(&axes, values, position, |value, weight| *value += weight * density);
                gained += amount;
            } else {
                release(&axes, values, position, |value, weight| {
                    let taken = (weight * density).max(-*value);
                    *value = (*value + taken).max(0.0);
                    gained += taken * measure;
                });
            }
        }
        gained
    }

    /// Value and gradient of a species at a position, second order. Beyond a wall they are those at the wall.
    ///
    /// # Panics
    /// If there is no such species.
    pub fn sense(&self, species: usize, position: Vec3) -> Sensed {
        let mut out = [Sensed::default()];
        self.sense_all(species, &[position], &mut out);
        out[0]
    }

    /// Values and gradients of a species at positions; see [`Fields::sense`]. Allocates nothing.
    ///
    /// # Panics
    /// If there is no such species, or not one place for each position.
    pub fn sense_all(&self, species: usize, positions: &[Vec3], out: &mut [Sensed]) {
        assert_eq!(positions.len(), out.len(), "a place for each position");
        let axes = Axis::all(&self.grid, &self.species[species]);
        let values = self.values(species);
        let floor = if self.species[species].range == Range::NonNegative { 0.0 } else { f64::NEG_INFINITY };
        Arch::new().dispatch(SenseAll { axes, values, floor, positions, out });
    }
}

/// Sensing at many positions, so that it is compiled for the processor's lanes.
struct SenseAll<'a> {
    axes: [Axis; 3],
    values: &'a [f64],
    floor: f64,
    positions: &'a [Vec3],
    out: &'a mut [Sensed],
}

impl WithSimd for SenseAll<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (position, out) in self.positions.iter().zip(self.out) {
            *out = sense(&self.axes, self.values, *position, self.floor);
        }
    }
}

/// Calls back for each box around a position with its weight; the weights sum to one.
#[inline(always)]
fn release(axes: &[Axis; 3], values: &mut [f64], position: &Vec3, mut change: impl FnMut(&mut f64, f64)) {
    let pair = |axis: usize| match axes[axis].inside(position[axis] + axes[axis].half, 1.0, 0.0) {
        Some((high, part)) => ([high - 1, high], part),
        None => axes[axis].pair(position[axis]),
    };
    let ((xs, wx), (ys, wy), (zs, wz)) = (pair(0), pair(1), if axes[2].n == 1 { ([0, 0], 0.0) } else { pair(2) });
    let (nx, ny, deep) = (axes[0].n, axes[1].n, if axes[2].n == 1 { 1 } else { 2 });
    for (z, wz) in zs.into_iter().zip([1.0 - wz, wz]).take(deep) {
        for (y, wy) in ys.into_iter().zip([1.0 - wy, wy]) {
            let row = (z * ny + y) * nx;
            change(&mut values[row + xs[0]], (1.0 - wx) * (wy * wz));
            change(&mut values[row + xs[1]], wx * (wy * wz));
        }
    }
}
