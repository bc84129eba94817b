//! Solves sixteen lines of boxes side by side with the widest registers of the processor.
//!
//! No fused multiply-add is used, so that a result is the same to the last bit on every processor.

use pulp::{Arch, Simd, WithSimd};

use super::factors::{Line, Ring};

/// Lines that are solved side by side.
pub const WIDTH: usize = 16;

/// Numbers from one section of scratch, each `[box][line]`, to the next, for lines of `n` boxes. An odd number of rows,
/// because sections a power of two apart would compete for the same places of the cache.
pub const fn section(n: usize) -> usize {
    (n | 1) * WIDTH
}

struct Sweep<'a> {
    line: &'a Line,
    factor: f64,
    scratch: &'a mut [f64],
}

impl WithSimd for Sweep<'_> {
    /// The least value of the result.
    type Output = f64;
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        match WIDTH / S::F64_LANES {
            1 => all_lines::<S, 1>(simd, self),
            2 => all_lines::<S, 2>(simd, self),
            _ => all_lines::<S, 4>(simd, self),
        }
    }
}

/// One step of diffusion along the lines in the first [`section`] of scratch, times a factor. Leaves Y in the second
/// section, uses the third, and returns the least value.
pub fn sweep(line: &Line, factor: f64, scratch: &mut [f64]) -> f64 {
    Arch::new().dispatch(Sweep { line, factor, scratch })
}

/// Values, real part (later Y) and imaginary part as registers: `[box × row + part]`.
struct Thirds<'a, T> {
    values: &'a mut [T],
    re: &'a mut [T],
    im: &'a mut [T],
    row: usize,
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
fn all_lines<S: Simd, const K: usize>(simd: S, work: Sweep) -> f64 {
    let n = work.line.complex.len();
    let row = WIDTH / S::F64_LANES;
    let (values, rest) = work.scratch.split_at_mut(section(n));
    let (re, im) = rest.split_at_mut(section(n));
    let [values, re, im] = [values, re, im].map(|part| S::as_mut_simd_f64s(&mut part[..n * WIDTH]).0);
    let mut thirds = Thirds { values, re, im, row };
    let mut least = simd.splat_f64s(f64::INFINITY);
    for part in (0..row).step_by(K) {
        forward::<S, K>(simd, work.line, &mut thirds, part);
        let ends = backward::<S, K>(simd, work.line, &mut thirds, part);
        if let Some(ring) = &work.line.ring {
            close::<S, K>(simd, ring, &mut thirds, part, ends);
        }
        let low = flow::<S, K>(simd, work.line, work.factor, &mut thirds, part);
        least = simd.min_f64s(least, low);
    }
    simd.reduce_min_f64s(least)
}

/// Elimination from the first box to the last: G ← (b + G) c.
#[inline(always)]
fn forward<S: Simd, const K: usize>(simd: S, line: &Line, t: &mut Thirds<S::f64s>, part: usize) {
    let zero = simd.splat_f64s(0.0);
    let (mut gr, mut gi) = ([zero; K], [zero; K]);
    let rows = t.values.chunks_exact(t.row).zip(t.re.chunks_exact_mut(t.row).zip(t.im.chunks_exact_mut(t.row)));
    for (c, (b, (re, im))) in line.complex.iter().zip(rows) {
        let b = part_of::<_, K>(b, part);
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

/// What flows between the boxes and through the walls changes the values. Returns the least of them.
#[inline(always)]
fn flow<S: Simd, const K: usize>(simd: S, line: &Line, factor: f64, t: &mut Thirds<S::f64s>, part: usize) -> S::f64s {
    let factor = simd.splat_f64s(factor);
    let first = *part_of::<_, K>(t.re, part);
    let last = *part_of::<_, K>(&t.re[t.re.len() - t.row..], part);
    let (mut below, mut top) = (first, last);
    for k in 0..K {
        if line.ring.is_some() {
            below[k] = simd.sub_f64s(first[k], last[k]);
            top[k] = below[k];
        } else {
            below[k] = simd.mul_f64s(simd.splat_f64s(line.walls[0]), first[k]);
            top[k] = simd.mul_f64s(simd.splat_f64s(-line.walls[1]), last[k]);
        }
    }
    let mut least = [simd.splat_f64s(f64::INFINITY); K];
    let mut change = |values: &mut [S::f64s; K], above: &[S::f64s; K], below: &[S::f64s; K]| {
        for k in 0..K {
            let sum = simd.add_f64s(values[k], simd.sub_f64s(above[k], below[k]));
            values[k] = simd.mul_f64s(sum, factor);
            least[k] = simd.min_f64s(least[k], values[k]);
        }
    };
    let mut here = first;
    let rows = t.values.chunks_exact_mut(t.row).zip(t.re.chunks_exact(t.row).skip(1));
    for (values, next) in rows {
        let next = *part_of::<_, K>(next, part);
        let mut above = next;
        for k in 0..K {
            above[k] = simd.sub_f64s(next[k], here[k]);
        }
        change(part_of_mut::<_, K>(values, part), &above, &below);
        (here, below) = (next, above);
    }
    let values = t.values.len() - t.row;
    change(part_of_mut::<_, K>(&mut t.values[values..], part), &top, &below);
    least.into_iter().fold(simd.splat_f64s(f64::INFINITY), |a, b| simd.min_f64s(a, b))
}
