//! Lines along x, whose boxes lie one after the other, become lanes side by side, and back.

use pulp::{Arch, Simd, WithSimd};

use super::sweep::WIDTH;

/// Copies lines of `n` boxes, `count` of them, to `[box][line]`, and zeros into lanes without a line.
pub fn transpose_in(from: &[f64], size: [usize; 2], rows: &mut [[f64; WIDTH]]) {
    Arch::new().dispatch(In { from, size, rows });
}

/// Copies the lines back.
pub fn transpose_out(rows: &[[f64; WIDTH]], size: [usize; 2], to: &mut [f64]) {
    Arch::new().dispatch(Out { rows, size, to });
}

struct In<'a> {
    from: &'a [f64],
    size: [usize; 2],
    rows: &'a mut [[f64; WIDTH]],
}

impl WithSimd for In<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        turn_in(self.from, self.size, self.rows);
    }
}

struct Out<'a> {
    rows: &'a [[f64; WIDTH]],
    size: [usize; 2],
    to: &'a mut [f64],
}

impl WithSimd for Out<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        turn_out(self.rows, self.size, self.to);
    }
}

/// Four lines of four boxes each become four boxes of four lines each.
#[inline(always)]
fn turn(from: [[f64; 4]; 4]) -> [[f64; 4]; 4] {
    std::array::from_fn(|i| from.map(|line| line[i]))
}

#[inline(always)]
fn four(from: &[f64]) -> [f64; 4] {
    *from.first_chunk().expect("four numbers")
}

#[inline(always)]
fn turn_in(from: &[f64], [n, count]: [usize; 2], rows: &mut [[f64; WIDTH]]) {
    let (wide, long) = (count / 4 * 4, n / 4 * 4);
    for lane in (0..wide).step_by(4) {
        let lines: [&[f64]; 4] = std::array::from_fn(|k| &from[(lane + k) * n..(lane + k + 1) * n]);
        for i in (0..long).step_by(4) {
            let turned = turn(lines.map(|line| four(&line[i..])));
            for (row, values) in rows[i..i + 4].iter_mut().zip(turned) {
                row[lane..lane + 4].copy_from_slice(&values);
            }
        }
        for i in long..n {
            rows[i][lane..lane + 4].copy_from_slice(&lines.map(|line| line[i]));
        }
    }
    for (i, row) in rows[..n].iter_mut().enumerate() {
        for lane in wide..count {
            row[lane] = from[lane * n + i];
        }
        row[count..].fill(0.0);
    }
}

#[inline(always)]
fn turn_out(rows: &[[f64; WIDTH]], [n, count]: [usize; 2], to: &mut [f64]) {
    let (wide, long) = (count / 4 * 4, n / 4 * 4);
    for lane in (0..wide).step_by(4) {
        for i in (0..long).step_by(4) {
            let turned = turn(std::array::from_fn(|k| four(&rows[i + k][lane..])));
            for (k, values) in turned.into_iter().enumerate() {
                let at = (lane + k) * n + i;
                to[at..at + 4].copy_from_slice(&values);
            }
        }
    }
    for (i, row) in rows[..n].iter().enumerate() {
        let first = if i < long { wide } else { 0 };
        for lane in first..count {
            to[lane * n + i] = row[lane];
        }
    }
}
