//! Senses a field at many positions, four side by side; those near a wall are left to the reference.

use pulp::{Simd, WithSimd};

use super::axis::{Axis, SIDE};
use super::sensed::Sensed;
use super::stencil::{dot, sense_plainly, spline};
use super::turn::Turner;
use crate::Vec3;

/// Four numbers: of four boxes along x, or of four positions.
type Four = [f64; SIDE];

/// Sensing at many positions, so that it is compiled for the processor's lanes.
pub struct SenseAll<'a> {
    pub axes: [Axis; 3],
    pub values: &'a [f64],
    /// Least value that is sensed.
    pub floor: f64,
    pub positions: &'a [Vec3],
    pub out: &'a mut [Sensed],
    pub turner: Turner,
}

impl WithSimd for SenseAll<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        if self.axes[2].n == 1 { all::<true>(self) } else { all::<false>(self) }
    }
}

#[inline(always)]
fn all<const FLAT: bool>(mut work: SenseAll) {
    let (positions, rest) = work.positions.as_chunks::<SIDE>();
    let (out, last) = std::mem::take(&mut work.out).as_chunks_mut::<SIDE>();
    for (positions, out) in positions.iter().zip(out) {
        four_positions::<FLAT>(&work, positions, out);
    }
    if let Some(first) = rest.first() {
        let padded = std::array::from_fn(|l| *rest.get(l).unwrap_or(first));
        let mut found = [Sensed::default(); SIDE];
        four_positions::<FLAT>(&work, &padded, &mut found);
        last.copy_from_slice(&found[..rest.len()]);
    }
}

/// Four positions side by side, and those of them that are near a wall again by the reference. What is found at one does
/// not depend on the others.
#[inline(always)]
fn four_positions<const FLAT: bool>(work: &SenseAll, positions: &[Vec3; SIDE], out: &mut [Sensed; SIDE]) {
    let axes = &work.axes;
    // A row of a grid is read four boxes at a time, one more than the spline takes.
    let narrow = axes[0].n < 4 || axes[1].n < 3 || (!FLAT && axes[2].n < 3);
    let inside = if narrow { [false; SIDE] } else { side_by_side::<FLAT>(work, positions, out) };
    if inside != [true; SIDE] {
        for l in 0..SIDE {
            if !inside[l] {
                out[l] = sense_plainly(axes, work.values, positions[l], work.floor);
            }
        }
    }
}

/// The values and gradients at four positions; returns at which of them they are right because no wall is near.
#[inline(always)]
fn side_by_side<const FLAT: bool>(work: &SenseAll, positions: &[Vec3; SIDE], out: &mut [Sensed; SIDE]) -> [bool; SIDE] {
    let (axes, turner) = (&work.axes, work.turner);
    let mut inside = [true; SIDE];
    let along = |axis: usize| [positions[0][axis], positions[1][axis], positions[2][axis], positions[3][axis]];
    let x = axes[0].boxes(&along(0), 2.0, &mut inside);
    let y = axes[1].boxes(&along(1), 1.0, &mut inside);
    let z = if FLAT { ([1; SIDE], [0.0; SIDE]) } else { axes[2].boxes(&along(2), 1.0, &mut inside) };
    let (wx, sx) = splines(&x.1, axes[0].inverse);
    let (wy, sy) = splines(&y.1, axes[1].inverse);
    let (wz, sz) = splines(&z.1, axes[2].inverse);
    let (nx, across) = (axes[0].n, axes[0].n * axes[1].n);
    let (mut level, mut along_y, mut along_z) = ([[0.0; SIDE]; SIDE], [[0.0; SIDE]; SIDE], [[0.0; SIDE]; SIDE]);
    for l in 0..SIDE {
        let (x, y, z) = (x.0[l] as usize - 1, y.0[l] as usize - 1, z.0[l] as usize - 1);
        let first = z * across + y * nx + x;
        let (wy, sy) = ([wy[0][l], wy[1][l], wy[2][l]], [sy[0][l], sy[1][l], sy[2][l]]);
        if FLAT {
            [level[l], along_y[l]] = plane(work.values, first, nx, &wy, &sy);
        } else {
            let (wz, sz) = ([wz[0][l], wz[1][l], wz[2][l]], [sz[0][l], sz[1][l], sz[2][l]]);
            let a = plane(work.values, first, nx, &wy, &sy);
            let b = plane(work.values, first + across, nx, &wy, &sy);
            let c = plane(work.values, first + 2 * across, nx, &wy, &sy);
            level[l] = sum(&wz, [&a[0], &b[0], &c[0]]);
            along_y[l] = sum(&wz, [&a[1], &b[1], &c[1]]);
            along_z[l] = sum(&sz, [&a[0], &b[0], &c[0]]);
        }
    }
    let (level, along_y) = (turned(turner, &level), turned(turner, &along_y));
    let mut found = [across_x(&wx, &level), across_x(&sx, &level), across_x(&wx, &along_y), [0.0; SIDE]];
    if !FLAT {
        found[3] = across_x(&wx, &turned(turner, &along_z));
    }
    for l in 0..SIDE {
        found[0][l] = if found[0][l] < work.floor { work.floor } else { found[0][l] };
    }
    let found = turned(turner, &found);
    for l in 0..SIDE {
        let [value, x, y, z] = found[l];
        out[l] = Sensed { value, gradient: Vec3::new(x, y, z) };
    }
    inside
}

/// Rows become columns.
#[inline(always)]
fn turned(turner: Turner, rows: &[Four; SIDE]) -> [Four; SIDE] {
    let mut columns = [[0.0; SIDE]; SIDE];
    turner.turn(rows.each_ref(), columns.each_mut());
    columns
}

/// The splines of four positions: weights and slopes, `[box][position]`.
#[inline(always)]
fn splines(parts: &Four, inverse: f64) -> ([Four; 3], [Four; 3]) {
    let (mut weights, mut slopes) = ([[0.0; SIDE]; 3], [[0.0; SIDE]; 3]);
    for l in 0..SIDE {
        let (w, s) = spline(parts[l], inverse);
        for k in 0..3 {
            (weights[k][l], slopes[k][l]) = (w[k], s[k]);
        }
    }
    (weights, slopes)
}

/// A weighted sum of three runs of four numbers.
#[inline(always)]
fn sum(weights: &[f64; 3], of: [&Four; 3]) -> Four {
    let mut sum = [0.0; SIDE];
    for l in 0..SIDE {
        sum[l] = dot(weights, [of[0][l], of[1][l], of[2][l]]);
    }
    sum
}

/// For four positions the weighted sums of three boxes along x each.
#[inline(always)]
fn across_x(weights: &[Four; 3], boxes: &[Four; SIDE]) -> Four {
    let mut sum = [0.0; SIDE];
    for l in 0..SIDE {
        sum[l] = dot(&[weights[0][l], weights[1][l], weights[2][l]], [boxes[0][l], boxes[1][l], boxes[2][l]]);
    }
    sum
}

/// Four boxes side by side along x.
#[inline(always)]
fn four(row: &[f64]) -> &Four {
    row.first_chunk().expect("four boxes")
}

/// Three rows of four boxes, added up with weights across the rows, and with the weights of the slope across them.
#[inline(always)]
fn plane(values: &[f64], first: usize, nx: usize, weights: &[f64; 3], slopes: &[f64; 3]) -> [Four; 2] {
    let rows = &values[first..first + 2 * nx + SIDE];
    let (a, b, c) = (four(rows), four(&rows[nx..]), four(&rows[2 * nx..]));
    [sum(weights, [a, b, c]), sum(slopes, [a, b, c])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::{Fields, Grid, Species};

    #[test]
    fn positions_side_by_side_agree_with_the_reference_and_do_not_see_each_other() {
        for cells in [[9, 7, 1], [9, 7, 5], [4, 4, 4], [300, 1, 1], [5, 1, 6]] {
            let grid = Grid::new(cells, [0.5; 3], Vec3::new(1.0, -2.0, 0.5)).expect("a grid");
            let species = vec![Species::new("s", 1.0, 0.0)];
            let mut fields = Fields::new(grid.clone(), species.clone()).expect("a species");
            fields.set(0, |p| 3.0 + (3.0 * p.x).sin() + (5.0 * p.y - 2.0 * p.z).cos()).expect("positive values");
            let axes = Axis::all(&grid, &species[0]);
            let size = Vec3::from_fn(|axis, _| 0.5 * cells[axis] as f64 + 1.0);
            let part = |i: usize| Vec3::new(0.819_172_5, 0.671_043_6, 0.549_700_4).map(|by| (by * i as f64).fract());
            let mut points: Vec<Vec3> =
                (0..999).map(|i| grid.origin - Vec3::repeat(0.5) + part(i).component_mul(&size)).collect();
            points[77] = Vec3::new(f64::NAN, 0.0, f64::INFINITY);
            let mut found = vec![Sensed::default(); points.len()];
            fields.sense_all(0, &points, &mut found);
            for (at, (point, found)) in points.iter().zip(&found).enumerate() {
                if at == 77 {
                    continue;
                }
                let plain = sense_plainly(&axes, fields.values(0), *point, 0.0);
                // Other sums of numbers as large as 5, the gradient's over half a µm.
                assert!((found.value - plain.value).abs() < 1e-14 && (found.gradient - plain.gradient).norm() < 1e-13);
                assert_eq!(*found, fields.sense(0, *point), "{cells:?} {at}");
            }
        }
    }
}
