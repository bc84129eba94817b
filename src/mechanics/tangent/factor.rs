//! Cholesky's factor of a matrix of 3 × 3 blocks, in the pattern's order, of several cells side by side.

use super::matrix::{Block, BlockSource, Blocks};
use super::pattern::Pattern;
use crate::mechanics::lanes::{Real, V3, VectorsMut};

/// The least that a pivot may be, over the diagonal that it began with: a matrix that is not positive by round-off alone has one below.
pub const LEAST_PIVOT: f64 = 1e-12;

/// Replaces a positive matrix by its factor L, A = L Lᵀ. Diagonals of L are kept as their inverse. Returns whether it was positive in all lanes; if not, there is no
/// factor.
#[inline(always)]
pub fn factor<T: Real>(pattern: &Pattern, blocks: &mut Blocks<T>) -> bool {
    let mut is_positive = true;
    let mut targets = pattern.targets().iter();
    for column in pattern.columns() {
        let own = blocks.get(column.atom);
        let diagonal = root(blocks.token, own);
        is_positive &= !own[0].x.any_less(0.0) && !sank(own[1].y, diagonal[1].y) && !sank(own[2].z, diagonal[2].z);
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
                blocks.set(target, [p - products(&right, a), q - products(&right, b), r - products(&right, c)]);
            }
        }
    }
    is_positive
}

/// Whether a pivot that began as this came to the least that it may be, from one over its root.
#[inline(always)]
fn sank<T: Real>(began: T, inverse: T) -> bool {
    began.any_less(0.0) || (-(began * inverse * inverse) + 0.5 / LEAST_PIVOT).any_less(0.0)
}

/// Solves A Y = F in place with the factor.
#[inline(always)]
pub fn solve<T: Real>(pattern: &Pattern, factor: &impl BlockSource<T>, values: &mut VectorsMut<T>) {
    for column in pattern.columns() {
        let y = forward(&factor.get(column.atom), values.get(column.atom));
        values.set(column.atom, y);
        for (&row, number) in column.rows.iter().zip(column.first..) {
            let [a, b, c] = factor.get(number);
            values.sub(row as usize, V3 { x: a.dot(y), y: b.dot(y), z: c.dot(y) });
        }
    }
    for column in pattern.columns().rev() {
        let mut y = values.get(column.atom);
        for (&row, number) in column.rows.iter().zip(column.first..) {
            let [a, b, c] = factor.get(number);
            let v = values.get(row as usize);
            y -= a.times(v.x) + b.times(v.y) + c.times(v.z);
        }
        values.set(column.atom, backward(&factor.get(column.atom), y));
    }
}

/// The factor of a block on the diagonal: its lower triangle, with one over the diagonal.
#[inline(always)]
fn root<T: Real>(token: T::Token, [a, b, c]: Block<T>) -> Block<T> {
    let (zero, one) = (T::constant(token, 0.0), T::constant(token, 1.0));
    let xx = pivot(one, a.x, a.x);
    let yx = b.x * xx;
    let zx = c.x * xx;
    let yy = pivot(one, b.y - yx * yx, b.y);
    let zy = (c.y - zx * yx) * yy;
    let zz = pivot(one, c.z - zx * zx - zy * zy, c.z);
    [V3 { x: xx, y: zero, z: zero }, V3 { x: yx, y: yy, z: zero }, V3 { x: zx, y: zy, z: zz }]
}

/// The scalar products of a vector with the rows of a block. (A closure in its place is not compiled for wide registers.)
#[inline(always)]
fn products<T: Real>(rows: &Block<T>, v: V3<T>) -> V3<T> {
    V3 { x: v.dot(rows[0]), y: v.dot(rows[1]), z: v.dot(rows[2]) }
}

/// One over the root of a pivot that began as this.
#[inline(always)]
fn pivot<T: Real>(one: T, value: T, began: T) -> T {
    one / value.max(began * LEAST_PIVOT).sqrt()
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
