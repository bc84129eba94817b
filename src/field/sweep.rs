//! Solves sixteen lines of boxes side by side with the widest registers of the processor.
//!
//! No fused multiply-add is used, so that a result is the same to the last bit on every processor.

use pulp::Simd;

use super::factors::{Line, Ring};
pub use super::shared::WIDTH;
use super::shared::{Columns, Next};

/// Numbers from one section of scratch, each `[box][line]`, to the next, for lines of `n` boxes. Eleven rows more than a
/// multiple of 4096 bytes: where sections are a multiple or nearly one apart, the processor takes what it loads from one
/// for what it has just stored to another, and waits.
pub const fn section(n: usize) -> usize {
    (n + (ROWS + 11 - n % ROWS) % ROWS) * WIDTH
}

/// Rows of columns that the memory is asked for in advance.
const AHEAD: usize = 6;

/// Rows in 4096 bytes.
const ROWS: usize = 4096 / (8 * WIDTH);

/// Values, real part (later Y) and imaginary part (later the result) as registers: `[box × row + part]`.
struct Thirds<'a, T> {
    values: &'a mut [T],
    re: &'a mut [T],
    im: &'a mut [T],
    row: usize,
}

/// One step of diffusion along the lines in the first [`section`] of scratch, times a factor. Leaves Y in the second
/// section and the result in the third, and returns the least value of the result. If columns are given the lines are
/// first taken from there, and unless they are rings the result is left there and not in the third section. The memory is
/// asked for the lines that come next.
#[inline(always)]
pub fn sweep<S: Simd>(
    simd: S,
    line: &Line,
    factor: f64,
    scratch: &mut [f64],
    (columns, next): (Option<Columns>, Option<Next>),
) -> f64 {
    match WIDTH / S::F64_LANES {
        1 => all_lines::<S, 1>(simd, line, factor, scratch, (columns, next)),
        2 => all_lines::<S, 2>(simd, line, factor, scratch, (columns, next)),
        _ => all_lines::<S, 4>(simd, line, factor, scratch, (columns, next)),
    }
}

/// The registers of a row that are worked on together.
#[inline(always)]
fn part_of<T, const K: usize>(row: &[T], part: usize) -> &[T; K] {
    row[part..].first_chunk().expect("K divides the registers of a row")
}

#[inline(always)]
fn part_of_mut<T, const K: usize>(row: &mut [T], part: usize) -> &mut [T; K] {
    row[part..].first_chunk_mut().expect("K divides the registers of a row")
}

#[inline(always)]
fn all_lines<S: Simd, const K: usize>(
    simd: S,
    line: &Line,
    factor: f64,
    scratch: &mut [f64],
    (columns, next): (Option<Columns>, Option<Next>),
) -> f64 {
    let n = line.complex.len();
    let row = WIDTH / S::F64_LANES;
    let (values, rest) = scratch.split_at_mut(section(n));
    let (re, im) = rest.split_at_mut(section(n));
    let [values, re, im] = [values, re, im].map(|part| S::as_mut_simd_f64s(&mut part[..n * WIDTH]).0);
    let mut thirds = Thirds { values, re, im, row };
    let mut least = simd.splat_f64s(f64::INFINITY);
    for part in (0..row).step_by(K) {
        forward::<S, K>(simd, line, &mut thirds, part, (columns, next.filter(|_| part == 0)));
    }
    for part in (0..row).step_by(K) {
        let low = if let Some(ring) = &line.ring {
            let ends = backward::<S, K>(simd, line, &mut thirds, part);
            close::<S, K>(simd, ring, &mut thirds, part, ends);
            flow_round::<S, K>(simd, factor, &mut thirds, part)
        } else {
            backward_and_flow::<S, K>(simd, line, factor, &mut thirds, part, columns)
        };
        least = simd.min_f64s(least, low);
    }
    simd.reduce_min_f64s(least)
}

/// Elimination from the first box to the last: G ← (b + G) c.
#[inline(always)]
fn forward<S: Simd, const K: usize>(
    simd: S,
    line: &Line,
    t: &mut Thirds<S::f64s>,
    part: usize,
    (columns, next): (Option<Columns>, Option<Next>),
) {
    let zero = simd.splat_f64s(0.0);
    let (mut gr, mut gi) = ([zero; K], [zero; K]);
    let rows = t.re.chunks_exact_mut(t.row).zip(t.im.chunks_exact_mut(t.row));
    let rows = t.values.chunks_exact_mut(t.row).zip(rows);
    for (i, (c, (values, (re, im)))) in line.complex.iter().zip(rows).enumerate() {
        let b = part_of_mut::<_, K>(values, part);
        if let Some(columns) = columns {
            *b = *part_of::<_, K>(columns.row::<S>(i), part);
            columns.ask(i + AHEAD);
        }
        if let Some(next) = next {
            next.ask(i);
        }
        let (re, im) = (part_of_mut::<_, K>(re, part), part_of_mut::<_, K>(im, part));
        let (cr, ci) = (simd.splat_f64s(c[0]), simd.splat_f64s(c[1]));
        for k in 0..K {
            let sum = simd.add_f64s(b[k], gr[k]);
            let next = simd.sub_f64s(simd.mul_f64s(sum, cr), simd.mul_f64s(gi[k], ci));
            gi[k] = simd.add_f64s(simd.mul_f64s(sum, ci), simd.mul_f64s(gi[k], cr));
            gr[k] = next;
        }
        (*re, *im) = (gr, gi);
    }
}

/// From the last box to the first: X ← G + c X, and Y = Re X − Im X. Returns the sum of X in the first and last box.
#[inline(always)]
fn backward<S: Simd, const K: usize>(simd: S, line: &Line, t: &mut Thirds<S::f64s>, part: usize) -> [[S::f64s; K]; 2] {
    let zero = simd.splat_f64s(0.0);
    let (mut xr, mut xi) = ([zero; K], [zero; K]);
    let last = t.re.len() - t.row;
    let last = [*part_of::<_, K>(&t.re[last..], part), *part_of::<_, K>(&t.im[last..], part)];
    let rows = t.re.chunks_exact_mut(t.row).zip(t.im.chunks_exact(t.row));
    for (c, (re, im)) in line.complex.iter().zip(rows).rev() {
        let (re, im) = (part_of_mut::<_, K>(re, part), part_of::<_, K>(im, part));
        let (cr, ci) = (simd.splat_f64s(c[0]), simd.splat_f64s(c[1]));
        for k in 0..K {
            let next = simd.add_f64s(re[k], simd.sub_f64s(simd.mul_f64s(xr[k], cr), simd.mul_f64s(xi[k], ci)));
            xi[k] = simd.add_f64s(im[k], simd.add_f64s(simd.mul_f64s(xr[k], ci), simd.mul_f64s(xi[k], cr)));
            xr[k] = next;
            re[k] = simd.sub_f64s(xr[k], xi[k]);
        }
    }
    let mut ends = last;
    for k in 0..K {
        ends[0][k] = simd.add_f64s(ends[0][k], xr[k]);
        ends[1][k] = simd.add_f64s(ends[1][k], xi[k]);
    }
    ends
}

/// Adds to Y what the meeting of the ends of the lines asks for.
#[inline(always)]
fn close<S: Simd, const K: usize>(
    simd: S,
    ring: &Ring,
    t: &mut Thirds<S::f64s>,
    part: usize,
    [re, im]: [[S::f64s; K]; 2],
) {
    let (cr, ci) = (simd.splat_f64s(ring.close[0]), simd.splat_f64s(ring.close[1]));
    let (mut dr, mut di) = (re, im);
    for k in 0..K {
        dr[k] = simd.sub_f64s(simd.mul_f64s(re[k], cr), simd.mul_f64s(im[k], ci));
        di[k] = simd.add_f64s(simd.mul_f64s(re[k], ci), simd.mul_f64s(im[k], cr));
    }
    for (share, y) in ring.share.iter().zip(t.re.chunks_exact_mut(t.row)) {
        let y = part_of_mut::<_, K>(y, part);
        let (sr, si) = (simd.splat_f64s(share[0]), simd.splat_f64s(share[1]));
        for k in 0..K {
            y[k] = simd.add_f64s(y[k], simd.add_f64s(simd.mul_f64s(sr, dr[k]), simd.mul_f64s(si, di[k])));
        }
    }
}

/// From the last box to the first between two walls: Y as [`backward`], and the values changed by what flows between the
/// boxes and through the walls. Returns the least of them.
#[inline(always)]
fn backward_and_flow<S: Simd, const K: usize>(
    simd: S,
    line: &Line,
    factor: f64,
    t: &mut Thirds<S::f64s>,
    part: usize,
    columns: Option<Columns>,
) -> S::f64s {
    let factor = simd.splat_f64s(factor);
    let mut least = simd.splat_f64s(f64::INFINITY);
    let rows = t.re.chunks_exact_mut(t.row).zip(t.im.chunks_exact_mut(t.row));
    let rows = t.values.chunks_exact(t.row).zip(rows);
    let mut rows = line.complex.iter().zip(rows).enumerate().rev();
    let Some((n, (_, (values, (re, im))))) = rows.next() else { return least };
    let (y, im) = (part_of_mut::<_, K>(re, part), part_of_mut::<_, K>(im, part));
    let (mut xr, mut xi) = (*y, *im);
    // Beyond the wall Y is such that the difference is the flow.
    let mut ghost = xr;
    for k in 0..K {
        y[k] = simd.sub_f64s(xr[k], xi[k]);
        ghost[k] = simd.mul_f64s(simd.splat_f64s(1.0 - line.walls[1]), y[k]);
    }
    // The box after the present one, whose flow through the low face is still to come: its values, its result, its Y and
    // the Y after it. These are read again in each round, because the registers are needed for X.
    let mut result = result_at::<S, K>(columns, n, im, part);
    let (mut values, mut above, mut here): (_, &[S::f64s; K], &[S::f64s; K]) =
        (part_of::<_, K>(values, part), &ghost, y);
    for (i, (c, (next_values, (re, im)))) in rows {
        let (y, im) = (part_of_mut::<_, K>(re, part), part_of_mut::<_, K>(im, part));
        let (cr, ci) = (simd.splat_f64s(c[0]), simd.splat_f64s(c[1]));
        for k in 0..K {
            let next = simd.add_f64s(y[k], simd.sub_f64s(simd.mul_f64s(xr[k], cr), simd.mul_f64s(xi[k], ci)));
            xi[k] = simd.add_f64s(im[k], simd.add_f64s(simd.mul_f64s(xr[k], ci), simd.mul_f64s(xi[k], cr)));
            xr[k] = next;
            y[k] = simd.sub_f64s(xr[k], xi[k]);
            let flows = simd.sub_f64s(simd.sub_f64s(above[k], here[k]), simd.sub_f64s(here[k], y[k]));
            let changed = simd.mul_f64s(simd.add_f64s(values[k], flows), factor);
            least = simd.min_f64s(least, changed);
            result[k] = changed;
        }
        result = result_at::<S, K>(columns, i, im, part);
        (values, above, here) = (part_of::<_, K>(next_values, part), here, y);
    }
    for k in 0..K {
        let below = simd.mul_f64s(simd.splat_f64s(line.walls[0]), here[k]);
        let flows = simd.sub_f64s(simd.sub_f64s(above[k], here[k]), below);
        let changed = simd.mul_f64s(simd.add_f64s(values[k], flows), factor);
        least = simd.min_f64s(least, changed);
        result[k] = changed;
    }
    least
}

/// Where the result of box `i` is left.
#[inline(always)]
fn result_at<'a, S: Simd, const K: usize>(
    columns: Option<Columns<'a>>,
    i: usize,
    scratch: &'a mut [S::f64s; K],
    part: usize,
) -> &'a mut [S::f64s; K] {
    let Some(columns) = columns else { return scratch };
    columns.ask(i.saturating_sub(AHEAD));
    part_of_mut(columns.row::<S>(i), part)
}

/// The values of a box changed by what flows through its two faces. Returns the least of them and of others.
#[inline(always)]
fn change<S: Simd, const K: usize>(
    simd: S,
    factor: S::f64s,
    (values, result): (&[S::f64s; K], &mut [S::f64s; K]),
    above: &[S::f64s; K],
    below: &[S::f64s; K],
    mut least: S::f64s,
) -> S::f64s {
    for k in 0..K {
        let sum = simd.add_f64s(values[k], simd.sub_f64s(above[k], below[k]));
        result[k] = simd.mul_f64s(sum, factor);
        least = simd.min_f64s(least, result[k]);
    }
    least
}

/// What flows between the boxes of a ring changes the values. Returns the least of them.
#[inline(always)]
fn flow_round<S: Simd, const K: usize>(simd: S, factor: f64, t: &mut Thirds<S::f64s>, part: usize) -> S::f64s {
    let factor = simd.splat_f64s(factor);
    let mut least = simd.splat_f64s(f64::INFINITY);
    let end = t.re.len() - t.row;
    let (first, mut here) = (*part_of::<_, K>(t.re, part), *part_of::<_, K>(t.re, part));
    let mut below = *part_of::<_, K>(t.re, end + part);
    for k in 0..K {
        below[k] = simd.sub_f64s(first[k], below[k]);
    }
    for at in (0..=end).step_by(t.row) {
        let next = if at == end { first } else { *part_of::<_, K>(t.re, at + t.row + part) };
        let mut above = next;
        for k in 0..K {
            above[k] = simd.sub_f64s(next[k], here[k]);
        }
        let rows = (part_of::<_, K>(t.values, at + part), part_of_mut::<_, K>(t.im, at + part));
        least = change::<S, K>(simd, factor, rows, &above, &below, least);
        (here, below) = (next, above);
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Wall;
    use crate::field::shared::Shared;
    use pulp::{Arch, WithSimd};

    struct Both<'a>(&'a Line, &'a [f64]);

    impl WithSimd for Both<'_> {
        type Output = ([f64; 2], [Vec<f64>; 2]);

        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let Self(line, start) = self;
            let (n, stride) = (line.real.len(), WIDTH + 3);
            let mut scratch = vec![0.0; 3 * section(n)];
            scratch[..n * WIDTH].copy_from_slice(start);
            let least = sweep(simd, line, 0.9, &mut scratch, (None, None));
            let apart = scratch[2 * section(n)..][..n * WIDTH].to_vec();
            let mut grid: Vec<f64> = start.chunks(WIDTH).flat_map(|row| [row, &[7.0; 3]].concat()).collect();
            let shared = Shared::new(&mut grid);
            // SAFETY: nobody else looks at the grid.
            let columns = unsafe { Columns::new(&shared, 0, stride) };
            let least_in_place = sweep(simd, line, 0.9, &mut scratch, (Some(columns), None));
            let ring = line.ring.is_some();
            let in_place = if ring { scratch[2 * section(n)..][..n * WIDTH].to_vec() } else { Vec::new() };
            let rows = grid.chunks(stride).inspect(|row| assert_eq!(row[WIDTH..], [7.0; 3]));
            let rows: Vec<f64> = rows.flat_map(|row| row[..WIDTH].to_vec()).collect();
            ([least, least_in_place], [apart, if ring { in_place } else { rows }])
        }
    }

    #[test]
    fn columns_in_place_have_the_bits_of_lines_in_scratch_and_the_equation_holds() {
        for walls in [[Wall::NoFlux; 2], [Wall::Fixed(0.0), Wall::NoFlux], [Wall::Periodic; 2]] {
            for n in [4, 5, 40] {
                let mut line = Line::new(n, walls);
                line.fill(1.7);
                let start: Vec<f64> = (0..n * WIDTH).map(|at| 2.0 + (0.9 * at as f64).sin()).collect();
                let (least, [apart, in_place]) = Arch::new().dispatch(Both(&line, &start));
                assert!(apart == in_place && least[0] == least[1], "{walls:?} {n}");
                // 1 − z + z²/2 times the result is what was there: eq. (field.3).
                let z = |u: &dyn Fn(usize) -> f64, i: usize| {
                    let beyond = |at: usize| match walls[usize::from(at > 0)] {
                        Wall::Periodic => u(n - 1 - at),
                        Wall::Fixed(_) => -u(at),
                        Wall::NoFlux => u(at),
                    };
                    let low = if i == 0 { beyond(0) } else { u(i - 1) };
                    let high = if i + 1 == n { beyond(n - 1) } else { u(i + 1) };
                    1.7 * (low - 2.0 * u(i) + high)
                };
                for lane in 0..WIDTH {
                    let u = |i: usize| apart[i * WIDTH + lane] / 0.9;
                    let zu = |i: usize| z(&u, i);
                    for i in 0..n {
                        let back = u(i) - zu(i) + 0.5 * z(&zu, i);
                        assert!((back - start[i * WIDTH + lane]).abs() < 1e-13, "{walls:?} {n} {i}");
                    }
                }
            }
        }
    }
}
