//! Solves sixteen lines of boxes side by side with the widest registers of the processor.
//!
//! No fused multiply-add is used, so that a result is the same to the last bit on every processor.

use pulp::{Arch, Simd, WithSimd};

use super::factors::{Line, Ring};

/// Lines that are solved side by side.
pub const WIDTH: usize = 16;

/// Numbers of scratch that lines of `n` boxes need: values, real part (later Y), imaginary part, each `[box][line]`.
pub const fn scratch(n: usize) -> usize {
    3 * n * WIDTH
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

/// One step of diffusion along the lines in scratch, times a factor. Leaves the values and Y in their thirds of
/// scratch and returns the least value.
pub fn sweep(line: &Line, factor: f64, scratch: &mut [f64]) -> f64 {
    Arch::new().dispatch(Sweep { line, factor, scratch })
}

/// The thirds of scratch as registers: `[box × row + part]`.
struct Thirds<'a, T> {
    values: &'a mut [T],
    re: &'a mut [T],
    im: &'a mut [T],
    row: usize,
}

#[inline(always)]
fn all_lines<S: Simd, const K: usize>(simd: S, work: Sweep) -> f64 {
    let n = work.line.complex.len();
    let row = WIDTH / S::F64_LANES;
    let (values, rest) = S::as_mut_simd_f64s(&mut work.scratch[..scratch(n)]).0.split_at_mut(n * row);
    let (re, im) = rest.split_at_mut(n * row);
    let mut thirds = Thirds { values, re, im, row };
    let mut least = simd.splat_f64s(f64::INFINITY);
    for part in (0..row).step_by(K) {
        forward::<S, K>(simd, work.line, &mut thirds, part);
        let low = match &work.line.ring {
            None => backward::<S, K>(simd, work.line, work.factor, &mut thirds, part),
            Some(ring) => backward_ring::<S, K>(simd, work.line, ring, work.factor, &mut thirds, part),
        };
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
        let (b, re, im) = (&b[part..part + K], &mut re[part..part + K], &mut im[part..part + K]);
        let (cr, ci) = (simd.splat_f64s(c[0]), simd.splat_f64s(c[1]));
        for k in 0..K {
            let sum = simd.add_f64s(b[k], gr[k]);
            let next = simd.sub_f64s(simd.mul_f64s(sum, cr), simd.mul_f64s(gi[k], ci));
            gi[k] = simd.add_f64s(simd.mul_f64s(sum, ci), simd.mul_f64s(gi[k], cr));
            gr[k] = next;
            re[k] = gr[k];
            im[k] = gi[k];
        }
    }
}

/// X ← G + c X for one box.
#[inline(always)]
fn back<S: Simd>(simd: S, c: [f64; 2], g: (S::f64s, S::f64s), x: (S::f64s, S::f64s)) -> (S::f64s, S::f64s) {
    let (cr, ci) = (simd.splat_f64s(c[0]), simd.splat_f64s(c[1]));
    let re = simd.add_f64s(g.0, simd.sub_f64s(simd.mul_f64s(x.0, cr), simd.mul_f64s(x.1, ci)));
    let im = simd.add_f64s(g.1, simd.add_f64s(simd.mul_f64s(x.0, ci), simd.mul_f64s(x.1, cr)));
    (re, im)
}

/// From the last box to the first: X, the flows between the boxes, and what they change.
#[inline(always)]
fn backward<S: Simd, const K: usize>(
    simd: S,
    line: &Line,
    factor: f64,
    t: &mut Thirds<S::f64s>,
    part: usize,
) -> S::f64s {
    let (zero, factor) = (simd.splat_f64s(0.0), simd.splat_f64s(factor));
    let (low, high) = (simd.splat_f64s(line.walls[0]), simd.splat_f64s(-line.walls[1]));
    let mut least = simd.splat_f64s(f64::INFINITY);
    let (mut x, mut y, mut flow) = ([(zero, zero); K], [zero; K], [zero; K]);
    let n = line.complex.len();
    let mut above: Option<usize> = None;
    for i in (0..n).rev() {
        let at = i * t.row + part;
        let (re, im) = (&mut t.re[at..at + K], &t.im[at..at + K]);
        for k in 0..K {
            x[k] = back(simd, line.complex[i], (re[k], im[k]), x[k]);
            let here = simd.sub_f64s(x[k].0, x[k].1);
            re[k] = here;
            if let Some(above) = above {
                let next = simd.sub_f64s(y[k], here);
                let value = &mut t.values[above + k];
                *value = simd.mul_f64s(simd.add_f64s(*value, simd.sub_f64s(flow[k], next)), factor);
                least = simd.min_f64s(least, *value);
                flow[k] = next;
            } else {
                flow[k] = simd.mul_f64s(high, here);
            }
            y[k] = here;
        }
        above = Some(at);
    }
    for k in 0..K {
        let value = &mut t.values[part + k];
        let next = simd.mul_f64s(low, y[k]);
        *value = simd.mul_f64s(simd.add_f64s(*value, simd.sub_f64s(flow[k], next)), factor);
        least = simd.min_f64s(least, *value);
    }
    least
}

/// The same where the ends of the lines meet.
#[inline(always)]
fn backward_ring<S: Simd, const K: usize>(
    simd: S,
    line: &Line,
    ring: &Ring,
    factor: f64,
    t: &mut Thirds<S::f64s>,
    part: usize,
) -> S::f64s {
    let (zero, factor) = (simd.splat_f64s(0.0), simd.splat_f64s(factor));
    let n = line.complex.len();
    let (mut x, mut ends) = ([(zero, zero); K], [(zero, zero); K]);
    for i in (0..n).rev() {
        let at = i * t.row + part;
        for k in 0..K {
            x[k] = back(simd, line.complex[i], (t.re[at + k], t.im[at + k]), x[k]);
            t.re[at + k] = simd.sub_f64s(x[k].0, x[k].1);
            if i + 1 == n || i == 0 {
                ends[k] = (simd.add_f64s(ends[k].0, x[k].0), simd.add_f64s(ends[k].1, x[k].1));
            }
        }
    }
    let (cr, ci) = (simd.splat_f64s(ring.close[0]), simd.splat_f64s(ring.close[1]));
    for end in &mut ends {
        let re = simd.sub_f64s(simd.mul_f64s(end.0, cr), simd.mul_f64s(end.1, ci));
        *end = (re, simd.add_f64s(simd.mul_f64s(end.0, ci), simd.mul_f64s(end.1, cr)));
    }
    for i in 0..n {
        let at = i * t.row + part;
        let (sr, si) = (simd.splat_f64s(ring.share[i][0]), simd.splat_f64s(ring.share[i][1]));
        for k in 0..K {
            let more = simd.add_f64s(simd.mul_f64s(sr, ends[k].0), simd.mul_f64s(si, ends[k].1));
            t.re[at + k] = simd.add_f64s(t.re[at + k], more);
        }
    }
    let mut least = simd.splat_f64s(f64::INFINITY);
    for k in 0..K {
        let first_flow = simd.sub_f64s(t.re[part + k], t.re[(n - 1) * t.row + part + k]);
        let mut flow = first_flow;
        for i in 0..n {
            let at = i * t.row + part + k;
            let next = if i + 1 == n { first_flow } else { simd.sub_f64s(t.re[at + t.row], t.re[at]) };
            t.values[at] = simd.mul_f64s(simd.add_f64s(t.values[at], simd.sub_f64s(next, flow)), factor);
            least = simd.min_f64s(least, t.values[at]);
            flow = next;
        }
    }
    least
}
