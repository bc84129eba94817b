//! Cholesky's factor of a matrix of 3 × 3 blocks, in the pattern's order, of several cells side by side.

use super::matrix::{Block, Blocks};
use super::pattern::Pattern;
use crate::mechanics::lanes::{Real, V3, VectorsMut};

/// The least that a pivot may be, over the diagonal that it began with: a matrix that is not positive by round-off alone has one below.
const LEAST_PIVOT: f64 = 1e-12;

/// Replaces a positive matrix by its factor L, A = L Lᵀ. Diagonals of L are kept as their inverse.
#[inline(always)]
pub fn factor<T: Real>(pattern: &Pattern, blocks: &mut Blocks<T>) {
    let mut targets = pattern.targets().iter();
    for column in pattern.columns() {
        let diagonal = root(blocks.token, blocks.get(column.atom));
        blocks.set(column.atom, diagonal);
        for k in 0..column.rows.len() {
            let [a, b, c] = blocks.get(column.first + k);
            let below = [forward(&diagonal, a), forward(&diagonal, b), forward(&diagonal, c)];
            blocks.set(column.first + k, below);
        }
        for (j, &atom) in column.rows.iter().enumerate() {
            let right = blocks.get(column.first + j);
            for i in j..column.rows.len() {
                let target = *targets.next().expect("a target for each pair") as usize;
                debug_assert!(i > j || target == atom as usize);
                let [a, b, c] = blocks.get(column.first + i);
                let [p, q, r] = blocks.get(target);
                let product = |row: V3<T>| V3 { x: row.dot(right[0]), y: row.dot(right[1]), z: row.dot(right[2]) };
                blocks.set(target, [p - product(a), q - product(b), r - product(c)]);
            }
        }
    }
}

/// Solves A Y = F in place with the factor, whose blocks `factor` tells.
#[inline(always)]
pub fn solve<T: Real>(pattern: &Pattern, factor: impl Fn(usize) -> Block<T>, values: &mut VectorsMut<T>) {
    for column in pattern.columns() {
        let y = forward(&factor(column.atom), values.get(column.atom));
        values.set(column.atom, y);
        for (&row, number) in column.rows.iter().zip(column.first..) {
            let [a, b, c] = factor(number);
            values.sub(row as usize, V3 { x: a.dot(y), y: b.dot(y), z: c.dot(y) });
        }
    }
    for column in pattern.columns().rev() {
        let mut y = values.get(column.atom);
        for (&row, number) in column.rows.iter().zip(column.first..) {
            let [a, b, c] = factor(number);
            let v = values.get(row as usize);
            y -= a.times(v.x) + b.times(v.y) + c.times(v.z);
        }
        values.set(column.atom, backward(&factor(column.atom), y));
    }
}

/// The factor of a block on the diagonal: its lower triangle, with one over the diagonal.
#[inline(always)]
fn root<T: Real>(token: T::Token, [a, b, c]: Block<T>) -> Block<T> {
    let (zero, one) = (T::constant(token, 0.0), T::constant(token, 1.0));
    let pivot = |value: T, began: T| one / value.max(began * LEAST_PIVOT).sqrt();
    let xx = pivot(a.x, a.x);
    let yx = b.x * xx;
    let zx = c.x * xx;
    let yy = pivot(b.y - yx * yx, b.y);
    let zy = (c.y - zx * yx) * yy;
    let zz = pivot(c.z - zx * zx - zy * zy, c.z);
    [V3 { x: xx, y: zero, z: zero }, V3 { x: yx, y: yy, z: zero }, V3 { x: zx, y: zy, z: zz }]
}

/// L⁻¹ v for the factor of a block on the diagonal.
#[inline(always)]
fn forward<T: Real>(l: &Block<T>, v: V3<T>) -> V3<T> {
    let x = v.x * l[0].x;
    let y = (v.y - l[1].x * x) * l[1].y;
    V3 { x, y, z: (v.z - l[2].x * x - l[2].y * y) * l[2].z }
}

/// L⁻ᵀ v for the factor of a block on the diagonal.
#[inline(always)]
fn backward<T: Real>(l: &Block<T>, v: V3<T>) -> V3<T> {
    let z = v.z * l[2].z;
    let y = (v.y - l[2].y * z) * l[1].y;
    V3 { x: (v.x - l[1].x * y - l[2].x * z) * l[0].x, y, z }
}
