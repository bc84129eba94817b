//! The profile that a species takes between walls that are held, and would keep for ever if nothing reacted.
//!
//! Values are moved as their distance from this profile. The distance feels walls that hold zero, for which the sweeps
//! along the axes and the decay commute; so no step size disturbs the steady state, eq. (field.5).

use super::grid::{Grid, Wall};
use super::species::Species;

/// The profile of a species, or none where it is zero everywhere.
pub fn steady(grid: &Grid, species: &Species) -> Option<Vec<f64>> {
    let held = |axis: usize| species.walls[axis].iter().any(|wall| matches!(wall, Wall::Fixed(_)));
    let driven = species.walls.iter().flatten().any(|wall| matches!(wall, Wall::Fixed(value) if *value != 0.0));
    if !driven || species.diffusion == 0.0 || species.carried {
        return None;
    }
    let axes: Vec<usize> = (0..3).filter(|axis| held(*axis)).collect();
    Some(match axes[..] {
        [axis] => along_one_axis(grid, species, axis),
        _ => conjugate_gradients(grid, species),
    })
}

/// Diffusion coefficient / spacing² along an axis.
fn rate(grid: &Grid, species: &Species, axis: usize) -> f64 {
    species.diffusion / grid.spacing[axis].powi(2)
}

/// The weight on the diagonal of the two sides of box `i` of an axis, and what flows in from the walls.
fn sides(grid: &Grid, species: &Species, axis: usize, i: usize) -> (f64, f64) {
    let (n, rate, pair) = (grid.cells[axis], rate(grid, species, axis), species.walls[axis]);
    let side = |end: bool, wall: Wall| match wall {
        _ if !end => (rate, 0.0),
        Wall::NoFlux => (0.0, 0.0),
        Wall::Fixed(value) => (2.0 * rate, 2.0 * rate * value),
        Wall::Periodic => (rate, 0.0),
    };
    let (low, high) = (side(i == 0, pair[0]), side(i + 1 == n, pair[1]));
    (low.0 + high.0, low.1 + high.1)
}

/// Nothing varies across the one axis that has held walls: a tridiagonal system gives the profile.
fn along_one_axis(grid: &Grid, species: &Species, axis: usize) -> Vec<f64> {
    let (n, rate) = (grid.cells[axis], rate(grid, species, axis));
    let (mut factors, mut profile) = (vec![0.0; n], vec![0.0; n]);
    let mut before = (0.0, 0.0);
    for i in 0..n {
        let (weight, inflow) = sides(grid, species, axis, i);
        let pivot = weight + species.decay - rate * before.0;
        before = (rate / pivot, (inflow + rate * before.1) / pivot);
        (factors[i], profile[i]) = before;
    }
    for i in (0..n - 1).rev() {
        profile[i] += factors[i] * profile[i + 1];
    }
    let [nx, ny, _] = grid.cells;
    let index = |at: usize| [at % nx, at / nx % ny, at / (nx * ny)][axis];
    (0..grid.len()).map(|at| profile[index(at)]).collect()
}

/// Decay − diffusion of a field between walls that hold zero.
fn apply(grid: &Grid, species: &Species, field: &[f64], out: &mut [f64]) {
    let [nx, ny, nz] = grid.cells;
    let strides = [1, nx, nx * ny];
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                let at = grid.at(x, y, z);
                let mut sum = species.decay * field[at];
                for (axis, i) in [x, y, z].into_iter().enumerate() {
                    let (n, stride, rate) = (grid.cells[axis], strides[axis], rate(grid, species, axis));
                    let periodic = species.walls[axis][0] == Wall::Periodic;
                    sum += sides(grid, species, axis, i).0 * field[at];
                    if i > 0 || periodic {
                        sum -= rate * field[if i > 0 { at - stride } else { at + (n - 1) * stride }];
                    }
                    if i + 1 < n || periodic {
                        sum -= rate * field[if i + 1 < n { at + stride } else { at - (n - 1) * stride }];
                    }
                }
                out[at] = sum;
            }
        }
    }
}

/// Walls are held along several axes: the method of conjugate gradients, once for the whole run.
fn conjugate_gradients(grid: &Grid, species: &Species) -> Vec<f64> {
    let [nx, ny, _] = grid.cells;
    let inflow = |at: usize| -> f64 {
        let index = [at % nx, at / nx % ny, at / (nx * ny)];
        (0..3).map(|axis| sides(grid, species, axis, index[axis]).1).sum()
    };
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let mut profile = vec![0.0; grid.len()];
    let mut residual: Vec<f64> = (0..grid.len()).map(inflow).collect();
    let mut direction = residual.clone();
    let mut image = vec![0.0; grid.len()];
    let first = dot(&residual, &residual);
    let mut squared = first;
    // Enough for any grid: the rounds needed grow with the boxes along the longest axis.
    for _ in 0..20 * grid.cells.iter().sum::<usize>() {
        if squared <= 1e-28 * first {
            break;
        }
        apply(grid, species, &direction, &mut image);
        let length = squared / dot(&direction, &image);
        for at in 0..profile.len() {
            profile[at] += length * direction[at];
            residual[at] -= length * image[at];
        }
        let next = dot(&residual, &residual);
        for at in 0..profile.len() {
            direction[at] = residual[at] + next / squared * direction[at];
        }
        squared = next;
    }
    // The profile is a concentration between concentrations; round-off must not say otherwise.
    let held = || species.walls.iter().flatten().filter_map(|w| if let Wall::Fixed(v) = w { Some(*v) } else { None });
    let (least, most) = (held().fold(0.0, f64::min), held().fold(0.0, f64::max));
    profile.iter_mut().for_each(|value| *value = value.clamp(least, most));
    profile
}
