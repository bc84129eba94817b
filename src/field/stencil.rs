//! The plain reference that senses a field at one position, wherever it is: also beside a wall, beyond it, in a narrow grid.

use super::axis::Axis;
use super::grid::Wall;
use super::sensed::Sensed;
use crate::Vec3;

/// The boxes along one axis that a sensed value depends on: Σ weights·u + constant, and the same for the slope.
struct Stencil {
    at: [usize; 3],
    weights: [f64; 3],
    slopes: [f64; 3],
    constant: [f64; 2],
}

impl Stencil {
    /// The quadratic B-spline around the box that holds the position, eq. (field.9); the box beyond a wall takes the value
    /// that the wall asks for, eq. (field.10).
    #[inline(always)]
    fn of(axis: &Axis, position: f64) -> Self {
        let n = axis.n;
        if n == 1 {
            return Self { at: [0; 3], weights: [1.0, 0.0, 0.0], slopes: [0.0; 3], constant: [0.0; 2] };
        }
        let coordinate = axis.coordinate(position);
        let i = (coordinate as usize).min(n - 1);
        let (mut weights, mut slopes) = spline(coordinate - i as f64, axis.inverse);
        let (mut at, mut constant) = ([i.wrapping_sub(1), i, i + 1], [0.0; 2]);
        if i > 0 && i + 1 < n {
            return Self { at, weights, slopes, constant };
        }
        let (beyond, inner) = if i == 0 { (0, 2) } else { (2, 0) };
        at[beyond] = i;
        match axis.walls[usize::from(i != 0)] {
            Wall::Periodic => at[beyond] = if i == 0 { n - 1 } else { 0 },
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
        Self { at, weights, slopes, constant }
    }
}

/// The quadratic B-spline and its slope at part `t` of a box, counted from its low side, eq. (field.9).
#[inline(always)]
pub fn spline(t: f64, inverse: f64) -> ([f64; 3], [f64; 3]) {
    let (low, high) = (1.0 - t, t - 0.5);
    let weights = [0.5 * low * low, 0.75 - high * high, 0.5 * t * t];
    (weights, [-low * inverse, -2.0 * high * inverse, t * inverse])
}

/// A weighted sum of three numbers.
#[inline(always)]
pub fn dot(weights: &[f64; 3], of: [f64; 3]) -> f64 {
    (weights[0] * of[0] + weights[1] * of[1]) + weights[2] * of[2]
}

/// The value and gradient at a position.
#[inline(never)]
pub fn sense_plainly(axes: &[Axis; 3], values: &[f64], position: Vec3, floor: f64) -> Sensed {
    let (x, y) = (Stencil::of(&axes[0], position.x), Stencil::of(&axes[1], position.y));
    let z = Stencil::of(&axes[2], position.z);
    let (nx, ny, deep) = (axes[0].n, axes[1].n, if axes[2].n == 1 { 1 } else { 3 });
    // Of each plane the value, the slope along x and that along y.
    let mut planes = [[0.0; 3]; 3];
    for k in 0..deep {
        let mut rows = [[0.0; 3]; 2];
        for j in 0..3 {
            let row = &values[(z.at[k] * ny + y.at[j]) * nx..][..nx];
            let near = [row[x.at[0]], row[x.at[1]], row[x.at[2]]];
            (rows[0][j], rows[1][j]) = (dot(&x.weights, near), dot(&x.slopes, near));
        }
        planes[k] = [dot(&y.weights, rows[0]), dot(&y.weights, rows[1]), dot(&y.slopes, rows[0])];
    }
    let along_z = |weights: &[f64; 3], what: usize| dot(weights, [planes[0][what], planes[1][what], planes[2][what]]);
    let mut sensed = Sensed {
        value: along_z(&z.weights, 0),
        gradient: Vec3::new(along_z(&z.weights, 1), along_z(&z.weights, 2), along_z(&z.slopes, 0)),
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
