//! Dense Cholesky in strips of rows, as many as a register of lanes has numbers: the arithmetic of a front (`fronts.rs`).
//!
//! A strip holds its columns one after the other, `strip[column][row]`. Sums are taken in the same order by every processor.

use crate::mechanics::lanes::{LANES, Real};

/// Rows of a strip, and columns of a tile.
pub const WIDTH: usize = LANES;
/// Numbers of a tile.
pub const TILE: usize = WIDTH * WIDTH;

/// Takes the product of rows and columns, both with the same columns eliminated before, from a tile.
#[inline(always)]
pub fn subtract<T: Real>(token: T::Token, rows: &[f64], columns: &[f64], tile: &mut [f64]) {
    let (rows, tile) = (T::view(token, rows), T::view_mut(token, tile));
    // Eight sums in flight hide the latency of additions; of two registers of rows each column is looked up once for both.
    if tile.len() == WIDTH {
        subtract_part::<T, 1, 8>(token, rows, columns, tile, 0, 0);
    } else {
        for part in (0..tile.len() / WIDTH).step_by(2) {
            subtract_part::<T, 2, 4>(token, rows, columns, tile, part, 0);
            subtract_part::<T, 2, 4>(token, rows, columns, tile, part, 4);
        }
    }
}

/// The same for some registers of rows and some columns of the tile.
#[inline(always)]
fn subtract_part<T: Real, const PARTS: usize, const COLUMNS: usize>(
    token: T::Token,
    rows: &[T::Raw],
    columns: &[f64],
    tile: &mut [T::Raw],
    part: usize,
    first: usize,
) {
    let stride = tile.len() / WIDTH;
    let mut sums = [[T::constant(token, 0.0); COLUMNS]; PARTS];
    for (row, column) in rows.chunks_exact(stride).zip(columns.as_chunks::<WIDTH>().0) {
        let row = &row[part..part + PARTS];
        let column = &column[first..first + COLUMNS];
        for p in 0..PARTS {
            for c in 0..COLUMNS {
                sums[p][c] += T::load(token, row[p]) * column[c];
            }
        }
    }
    for p in 0..PARTS {
        for c in 0..COLUMNS {
            let at = (first + c) * stride + part + p;
            tile[at] = (T::load(token, tile[at]) - sums[p][c]).raw();
        }
    }
}

/// Factors a tile on the diagonal in place; diagonals are kept as their inverse. A pivot is at least what `least` says of it. Returns
/// whether none was less.
#[inline(always)]
pub fn root(tile: &mut [f64], least: [f64; WIDTH]) -> bool {
    let mut is_positive = true;
    for c in 0..WIDTH {
        let pivot = tile[c * WIDTH + c];
        is_positive &= pivot > least[c];
        let inverse = 1.0 / if pivot > least[c] { pivot } else { least[c] }.sqrt();
        tile[c * WIDTH + c] = inverse;
        for row in c + 1..WIDTH {
            tile[c * WIDTH + row] *= inverse;
        }
        for other in c + 1..WIDTH {
            let factor = tile[c * WIDTH + other];
            for row in other..WIDTH {
                tile[other * WIDTH + row] -= factor * tile[c * WIDTH + row];
            }
        }
    }
    is_positive
}

/// Multiplies a tile from the right by the inverse of the transposed factor on the diagonal.
#[inline(always)]
pub fn divide<T: Real>(token: T::Token, diagonal: &[f64], tile: &mut [f64]) {
    let tile = T::view_mut(token, tile);
    let stride = tile.len() / WIDTH;
    for part in 0..stride {
        let mut x = [T::constant(token, 0.0); WIDTH];
        for c in 0..WIDTH {
            x[c] = T::load(token, tile[c * stride + part]);
        }
        for c in 0..WIDTH {
            x[c] = x[c] * diagonal[c * WIDTH + c];
            for other in c + 1..WIDTH {
                x[other] -= x[c] * diagonal[c * WIDTH + other];
            }
            tile[c * stride + part] = x[c].raw();
        }
    }
}

/// Adds what the columns of a tile make of values, by rows.
#[inline(always)]
pub fn along<T: Real>(token: T::Token, tile: &[f64], values: &[f64; WIDTH], sums: &mut [f64; WIDTH]) {
    let (tile, sums) = (T::view(token, tile), T::view_mut(token, sums));
    let stride = sums.len();
    for part in 0..stride {
        let mut products = [T::load(token, sums[part]); WIDTH];
        for c in 0..WIDTH {
            products[c] = T::load(token, tile[c * stride + part]) * values[c];
        }
        let [a, b, c, d, e, f, g, h] = products;
        sums[part] = (T::load(token, sums[part]) + (((a + b) + (c + d)) + ((e + f) + (g + h)))).raw();
    }
}

/// Adds what the rows of strips make of values, for a tile of their columns.
#[inline(always)]
pub fn across<T: Real>(token: T::Token, tile: &[f64], values: &[f64; WIDTH], sums: &mut [f64; TILE]) {
    let (tile, values, sums) = (T::view(token, tile), T::view(token, values), T::view_mut(token, sums));
    let stride = values.len();
    for part in 0..stride {
        let value = T::load(token, values[part]);
        for c in 0..WIDTH {
            let at = c * stride + part;
            sums[at] = (T::load(token, sums[at]) + T::load(token, tile[at]) * value).raw();
        }
    }
}

/// Solves with the factor on the diagonal.
pub fn forward(tile: &[f64], values: &mut [f64; WIDTH]) {
    for c in 0..WIDTH {
        values[c] *= tile[c * WIDTH + c];
        for row in c + 1..WIDTH {
            values[row] -= values[c] * tile[c * WIDTH + row];
        }
    }
}

/// Solves with the transposed factor on the diagonal.
pub fn backward(tile: &[f64], values: &mut [f64; WIDTH]) {
    for c in (0..WIDTH).rev() {
        for row in c + 1..WIDTH {
            values[c] -= values[row] * tile[c * WIDTH + row];
        }
        values[c] *= tile[c * WIDTH + c];
    }
}
