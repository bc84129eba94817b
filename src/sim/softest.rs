//! The shape of a cell for which the constant stiffness K of the implicit step is the farthest above the true one, J.

use nalgebra::{DMatrix, SymmetricEigen};

use super::kind::Kind;
use super::solver::Solver;
use crate::Vec3;
use crate::mechanics::sum::measure_elastic;
use crate::mechanics::{rigid, volume};

/// What is taken of the least ratio that was found, so that it is one below all.
pub const COVERED: f64 = 0.8;

/// Rounds at most.
const ROUNDS: usize = 150;

/// Rounds between two looks at what has been found.
const ROUNDS_A_LOOK: usize = 10;

/// The iteration ends where an eigenvalue is known to be within this part of what was found.
const ENOUGH: f64 = 0.05;

/// The least eigenvalue of K⁻¹ J at rest over all that is no rigid motion, a fifth less, by the iteration of Lanczos for the symmetric J
/// in the metric of K: power iteration stands still where many shapes are nearly as soft, as they are on fine meshes. None is above `largest`, which K
/// has been scaled to, and which is told where nothing is elastic.
pub fn measure_softest_ratio(kind: &Kind, largest: f64) -> f64 {
    let rest = &kind.rest.positions;
    // A little of the identity makes K invertible; J does not resist what K does not resist.
    let little = 1e-5 * kind.stiffness.largest().max(f64::MIN_POSITIVE);
    let solver = Solver::new(kind, &kind.stiffness, kind.drag / little, 1.0);
    let x: Vec<f64> = rest.iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    let (mut scratch, mut removed) = (vec![0.0; x.len()], vec![0.0; x.len()]);
    let mut keep = |values: &mut [f64]| {
        volume::hold(1, &kind.held, values);
        if !kind.is_held() {
            rigid::split_block(1, kind.atoms(), &x, values, &mut removed, rigid::Whole::free(1.0));
        }
    };
    // `w` is K⁻¹ `r`, and each pair of them is scaled so that w·r = 1, which is the square of w in the metric of K.
    let mut r = any_direction(x.len());
    let (mut w, mut before) = (Vec::new(), vec![0.0; x.len()]);
    let (mut diagonal, mut beside): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    keep(&mut r);
    for round in 0..ROUNDS.min(x.len()) {
        w.clone_from(&r);
        solver.solve_elastic(&mut w, &mut scratch);
        keep(&mut w);
        let size = dot(&w, &r).max(0.0).sqrt();
        if size <= 1e-9 * largest || is_enough(round, &diagonal, &beside, size) {
            break;
        }
        w.iter_mut().chain(&mut r).for_each(|value| *value /= size);
        // A difference of forces is the most exact where the atoms go as far as in all others.
        let length = dot(&w, &w).sqrt();
        w.iter_mut().for_each(|w| *w /= length);
        let mut next = stiffness_along(kind, rest, &w);
        next.iter_mut().for_each(|next| *next *= length);
        keep(&mut next);
        let (along, back) = (length * dot(&w, &next), if round > 0 { size } else { 0.0 });
        if round == 0 && along == 0.0 {
            // Nothing is elastic.
            break;
        }
        diagonal.push(along);
        beside.push(back);
        for (next, (r, before)) in next.iter_mut().zip(r.iter().zip(&before)) {
            *next -= along * r + back * before;
        }
        before = std::mem::replace(&mut r, next);
    }
    let found = softest(&diagonal, &beside).map_or(largest, |(found, _)| found);
    COVERED * found.clamp(0.0, largest)
}

/// What an iteration begins with: any vector will do that is not an eigenvector of a smaller value, and this one has no symmetry.
pub fn any_direction(size: usize) -> Vec<f64> {
    (0..size).map(|i| ((i * 7919 + 13) % 101) as f64 / 50.5 - 1.0).collect()
}

/// J v, of elastic forces in the shape `x` (µm): a difference of forces. The atoms go a millionth of an edge times v.
pub fn stiffness_along(kind: &Kind, x: &[Vec3], v: &[f64]) -> Vec<f64> {
    let epsilon = 1e-6 * kind.edge;
    let force = |sign: f64| {
        let x = x.iter().flat_map(|p| [p.x, p.y, p.z]);
        let moved: Vec<f64> = x.zip(v).map(|(x, v)| x + sign * epsilon * v).collect();
        let mut f = vec![0.0; moved.len()];
        measure_elastic(&kind.forces, 1, &moved, &mut f, &mut [0.0]);
        f
    };
    let (plus, minus) = (force(1.0), force(-1.0));
    minus.iter().zip(&plus).map(|(m, p)| (m - p) / (2.0 * epsilon)).collect()
}

/// Whether what was found is good enough: the next direction has this size.
fn is_enough(round: usize, diagonal: &[f64], beside: &[f64], size: f64) -> bool {
    let looks = round > 0 && round.is_multiple_of(ROUNDS_A_LOOK);
    looks && softest(diagonal, beside).is_some_and(|(found, share)| share * size < ENOUGH * found)
}

/// The least eigenvalue of the symmetric matrix with this diagonal and, from the second on, these numbers beside it, and how large the
/// last number of its vector is.
fn softest(diagonal: &[f64], beside: &[f64]) -> Option<(f64, f64)> {
    let size = diagonal.len();
    if size == 0 {
        return None;
    }
    let matrix = DMatrix::from_fn(size, size, |i, j| match i.abs_diff(j) {
        0 => diagonal[i],
        1 => beside[i.max(j)],
        _ => 0.0,
    });
    let all = SymmetricEigen::new(matrix);
    let least = (0..size).min_by(|i, j| all.eigenvalues[*i].total_cmp(&all.eigenvalues[*j]))?;
    Some((all.eigenvalues[least], all.eigenvectors[(size - 1, least)].abs()))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
