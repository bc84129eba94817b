//! Solves with a factor that fronts made.

use super::dense::{self, TILE, WIDTH};
use super::fronts::{Front, Fronts, NOTHING};
use crate::mechanics::lanes::{BlockWork, Real};

/// Solves for one right side.
pub struct SolveOne<'a> {
    pub fronts: &'a Fronts,
    pub factor: &'a [f64],
    pub values: &'a mut [f64],
}

impl BlockWork for SolveOne<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, token: T::Token, _: usize) {
        let Self { fronts, factor, values } = self;
        for front in &fronts.fronts {
            let panel = &factor[front.panel..][..front.panel_len()];
            for strip in 0..front.strips[0] + front.strips[1] {
                let tiles = strip.min(front.strips[0]);
                let mut sums = [0.0; WIDTH];
                for (tile, number) in panel[front.strip(strip)..][..tiles * TILE].chunks_exact(TILE).zip(0..) {
                    dense::along::<T>(token, tile, &gathered(front, number, values), &mut sums);
                }
                let mut own = gathered(front, strip, values);
                (0..WIDTH).for_each(|row| own[row] -= sums[row]);
                if strip < front.strips[0] {
                    dense::forward(&panel[front.strip(strip) + tiles * TILE..][..TILE], &mut own);
                }
                scatter(front, strip, &own, values);
            }
        }
        for front in fronts.fronts.iter().rev() {
            let panel = &factor[front.panel..][..front.panel_len()];
            for column in (0..front.strips[0]).rev() {
                let mut sums = [0.0; TILE];
                for strip in column + 1..front.strips[0] + front.strips[1] {
                    let tile = &panel[front.strip(strip) + column * TILE..][..TILE];
                    dense::across::<T>(token, tile, &gathered(front, strip, values), &mut sums);
                }
                let mut own = gathered(front, column, values);
                for (own, sums) in own.iter_mut().zip(sums.as_chunks::<WIDTH>().0) {
                    let [a, b, c, d, e, f, g, h] = *sums;
                    *own -= ((a + b) + (c + d)) + ((e + f) + (g + h));
                }
                dense::backward(&panel[front.strip(column) + column * TILE..][..TILE], &mut own);
                scatter(front, column, &own, values);
            }
        }
    }
}

/// The values of a strip's rows.
#[inline(always)]
fn gathered(front: &Front, strip: usize, values: &[f64]) -> [f64; WIDTH] {
    let numbers = &front.numbers.as_chunks::<WIDTH>().0[strip];
    let mut own = [0.0; WIDTH];
    for row in 0..WIDTH {
        own[row] = values.get(numbers[row] as usize).copied().unwrap_or(0.0);
    }
    own
}

/// Sets the values of a strip's rows.
#[inline(always)]
fn scatter(front: &Front, strip: usize, own: &[f64; WIDTH], values: &mut [f64]) {
    let numbers = &front.numbers.as_chunks::<WIDTH>().0[strip];
    for row in 0..WIDTH {
        if let Some(slot) = values.get_mut(numbers[row] as usize) {
            *slot = own[row];
        }
    }
}

/// Solves for as many right sides as there are lanes, or several times as many, one set after the other, `values[set][number][lane]`. Each group of rows is
/// read once for all of them: a large factor does not fit into the caches, and its way from memory takes longer than what is done with it.
pub struct SolveMany<'a> {
    pub fronts: &'a Fronts,
    pub factor: &'a [f64],
    /// The numbers of a set, over those of a register.
    pub rows: usize,
    pub values: &'a mut [f64],
}

impl BlockWork for SolveMany<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, token: T::Token, stride: usize) {
        let Self { fronts, factor, rows, values } = self;
        let values = T::view_mut(token, values);
        for front in &fronts.fronts {
            let panel = &factor[front.panel..][..front.panel_len()];
            for values in values.chunks_exact_mut(rows * stride) {
                for part in 0..stride {
                    let mut sides = Sides::<T> { token, values: &mut *values, stride, part };
                    // A force on a few atoms has nothing to say to most groups on the way up.
                    if !sides.are_zero(front) {
                        forward(front, panel, &mut sides);
                    }
                }
            }
        }
        for front in fronts.fronts.iter().rev() {
            let panel = &factor[front.panel..][..front.panel_len()];
            for values in values.chunks_exact_mut(rows * stride) {
                for part in 0..stride {
                    backward(front, panel, &mut Sides::<T> { token, values: &mut *values, stride, part });
                }
            }
        }
    }
}

/// What the own rows of a front tell all its rows.
#[inline(always)]
fn forward<T: Real>(front: &Front, panel: &[f64], sides: &mut Sides<T>) {
    for strip in 0..front.strips[0] + front.strips[1] {
        let tiles = strip.min(front.strips[0]);
        let mut own = sides.get(front, strip);
        let (before, rest) = panel[front.strip(strip)..].split_at(tiles * TILE);
        for (tile, number) in before.chunks_exact(TILE).zip(0..) {
            let known = sides.get(front, number);
            for c in 0..WIDTH {
                for row in 0..WIDTH {
                    own[row] -= known[c] * tile[c * WIDTH + row];
                }
            }
        }
        if strip < front.strips[0] {
            for c in 0..WIDTH {
                own[c] = own[c] * rest[c * WIDTH + c];
                for row in c + 1..WIDTH {
                    own[row] -= own[c] * rest[c * WIDTH + row];
                }
            }
        }
        sides.set(front, strip, own);
    }
}

/// What all rows of a front tell its own.
#[inline(always)]
fn backward<T: Real>(front: &Front, panel: &[f64], sides: &mut Sides<T>) {
    for column in (0..front.strips[0]).rev() {
        let mut own = sides.get(front, column);
        for strip in column + 1..front.strips[0] + front.strips[1] {
            let tile = &panel[front.strip(strip) + column * TILE..][..TILE];
            let known = sides.get(front, strip);
            for c in 0..WIDTH {
                for row in 0..WIDTH {
                    own[c] -= known[row] * tile[c * WIDTH + row];
                }
            }
        }
        let tile = &panel[front.strip(column) + column * TILE..][..TILE];
        for c in (0..WIDTH).rev() {
            for row in c + 1..WIDTH {
                own[c] -= own[row] * tile[c * WIDTH + row];
            }
            own[c] = own[c] * tile[c * WIDTH + c];
        }
        sides.set(front, column, own);
    }
}

/// Right sides that fill a register.
struct Sides<'a, T: Real> {
    token: T::Token,
    values: &'a mut [T::Raw],
    stride: usize,
    part: usize,
}

impl<T: Real> Sides<'_, T> {
    /// Whether the own rows of a front are zero in all of them.
    #[inline(always)]
    fn are_zero(&self, front: &Front) -> bool {
        let mut largest = T::constant(self.token, 0.0);
        for &number in front.numbers[..front.strips[0] * WIDTH].iter().filter(|number| **number != NOTHING) {
            let value = T::load(self.token, self.values[number as usize * self.stride + self.part]);
            largest = largest.max(value.max(-value));
        }
        !(-largest).any_less(0.0)
    }

    #[inline(always)]
    fn get(&self, front: &Front, strip: usize) -> [T; WIDTH] {
        let numbers = &front.numbers.as_chunks::<WIDTH>().0[strip];
        let mut own = [T::constant(self.token, 0.0); WIDTH];
        for row in 0..WIDTH {
            if numbers[row] != NOTHING {
                own[row] = T::load(self.token, self.values[numbers[row] as usize * self.stride + self.part]);
            }
        }
        own
    }

    #[inline(always)]
    fn set(&mut self, front: &Front, strip: usize, own: [T; WIDTH]) {
        let numbers = &front.numbers.as_chunks::<WIDTH>().0[strip];
        for row in 0..WIDTH {
            if numbers[row] != NOTHING {
                self.values[numbers[row] as usize * self.stride + self.part] = own[row].raw();
            }
        }
    }
}
