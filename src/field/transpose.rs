//! Lines along x, whose boxes lie one after the other, become lanes side by side, and back.

use super::sweep::WIDTH;
use super::turn::{Four, Turner};

#[inline(always)]
fn four(from: &[f64]) -> &Four {
    from.first_chunk().expect("four numbers")
}

#[inline(always)]
fn four_mut(to: &mut [f64]) -> &mut Four {
    to.first_chunk_mut().expect("four numbers")
}

/// Copies lines of `n` boxes, `count` of them, to `[box][line]`, and zeros into lanes without a line.
#[inline(always)]
pub fn transpose_in(from: &[f64], [n, count]: [usize; 2], rows: &mut [[f64; WIDTH]]) {
    let (wide, long, turner) = (count / 4 * 4, n / 4 * 4, Turner::new());
    for lane in (0..wide).step_by(4) {
        let line = |k: usize| &from[(lane + k) * n..(lane + k + 1) * n];
        let [a, b, c, d] = [line(0), line(1), line(2), line(3)];
        for i in (0..long).step_by(4) {
            let [to_a, to_b, to_c, to_d] = rows[i..].first_chunk_mut().expect("four rows");
            let to = [
                four_mut(&mut to_a[lane..]),
                four_mut(&mut to_b[lane..]),
                four_mut(&mut to_c[lane..]),
                four_mut(&mut to_d[lane..]),
            ];
            turner.turn([four(&a[i..]), four(&b[i..]), four(&c[i..]), four(&d[i..])], to);
        }
        for i in long..n {
            rows[i][lane..lane + 4].copy_from_slice(&[a[i], b[i], c[i], d[i]]);
        }
    }
    for (i, row) in rows[..n].iter_mut().enumerate() {
        for lane in wide..count {
            row[lane] = from[lane * n + i];
        }
        row[count..].fill(0.0);
    }
}

/// Copies the lines back.
#[inline(always)]
pub fn transpose_out(rows: &[[f64; WIDTH]], [n, count]: [usize; 2], to: &mut [f64]) {
    let (wide, long, turner) = (count / 4 * 4, n / 4 * 4, Turner::new());
    for lane in (0..wide).step_by(4) {
        let (line_a, rest) = to[lane * n..(lane + 4) * n].split_at_mut(n);
        let (line_b, rest) = rest.split_at_mut(n);
        let (line_c, line_d) = rest.split_at_mut(n);
        for i in (0..long).step_by(4) {
            let [a, b, c, d] = rows[i..].first_chunk().expect("four rows");
            let to = [
                four_mut(&mut line_a[i..]),
                four_mut(&mut line_b[i..]),
                four_mut(&mut line_c[i..]),
                four_mut(&mut line_d[i..]),
            ];
            turner.turn([four(&a[lane..]), four(&b[lane..]), four(&c[lane..]), four(&d[lane..])], to);
        }
    }
    for (i, row) in rows[..n].iter().enumerate() {
        let first = if i < long { wide } else { 0 };
        for lane in first..count {
            to[lane * n + i] = row[lane];
        }
    }
}
