//! Makes a factor by fronts.

use super::dense::{self, TILE, WIDTH};
use super::factor::LEAST_PIVOT;
use super::fronts::{Front, Fronts, NOTHING, packed};
use super::pattern::Pattern;
use crate::mechanics::lanes::{BlockWork, Real};

/// Factors a matrix whose blocks of `pattern` these are.
pub struct Factorise<'a> {
    pub fronts: &'a Fronts,
    pub pattern: &'a Pattern,
    /// Numbers of the blocks, of which the lower triangle counts.
    pub blocks: &'a [f64],
    /// Room for [`Fronts::len`] numbers.
    pub factor: &'a mut [f64],
}

impl BlockWork for Factorise<'_> {
    /// Whether the matrix is positive; where it is not, pivots were raised and the factor is of another matrix.
    type Output = bool;
    #[inline(always)]
    fn run<T: Real>(self, token: T::Token, _: usize) -> bool {
        let Self { fronts, pattern, blocks, factor } = self;
        let (panels, stacks) = factor.split_at_mut(fronts.panels());
        let (even, odd) = stacks.split_at_mut(fronts.stacks[0]);
        let (mut entries, mut columns, mut is_positive) = (fronts.entries.iter(), pattern.columns(), true);
        for front in &fronts.fronts {
            let (own, other) = if front.update.0 == 0 { (&mut *even, &*odd) } else { (&mut *odd, &*even) };
            let mut parts = Parts {
                front,
                panel: &mut panels[front.panel..][..front.panel_len()],
                update: &mut own[front.update.1..][..front.update_len()],
            };
            parts.clear();
            for (number, column) in columns.by_ref().take(front.columns[1] - front.columns[0]).enumerate() {
                parts.enter(3 * number, 3 * number, &blocks[9 * column.atom..][..9]);
                for (block, &row) in (column.first..).zip(entries.by_ref().take(column.rows.len())) {
                    parts.enter(row as usize, 3 * number, &blocks[9 * block..][..9]);
                }
            }
            for &child in &front.children {
                let child = &fronts.fronts[child];
                parts.add(child, &other[child.update.1..][..child.update_len()]);
            }
            is_positive &= eliminate::<T>(token, parts, blocks);
        }
        is_positive
    }
}

/// The numbers of a front.
struct Parts<'a> {
    front: &'a Front,
    panel: &'a mut [f64],
    update: &'a mut [f64],
}

impl Parts<'_> {
    /// Sets all to zero, and the diagonal of padding to one.
    fn clear(&mut self) {
        self.panel.fill(0.0);
        self.update.fill(0.0);
        let own = self.front.strips[0] * WIDTH;
        for row in (0..own).filter(|&row| self.front.numbers[row] == NOTHING) {
            *self.at(row, row) = 1.0;
        }
    }

    /// A number of the lower triangle.
    fn at(&mut self, row: usize, column: usize) -> &mut f64 {
        let [own, _] = self.front.strips;
        let (strip, within) = (row / WIDTH, row % WIDTH);
        if column < own * WIDTH {
            &mut self.panel[self.front.strip(strip) + column * WIDTH + within]
        } else {
            &mut self.update[packed(strip - own) + (column - own * WIDTH) * WIDTH + within]
        }
    }

    /// Adds a block of the matrix.
    fn enter(&mut self, row: usize, column: usize, block: &[f64]) {
        for (k, value) in block.iter().enumerate() {
            let (row, column) = (row + k / 3, column + k % 3);
            if row >= column {
                *self.at(row, column) += value;
            }
        }
    }

    /// Adds the update of a front whose parent this one is.
    fn add(&mut self, child: &Front, update: &[f64]) {
        let own = self.front.strips[0];
        let end = child.lifts.iter().rposition(|to| *to != NOTHING).map_or(0, |last| last + 1);
        let (lifts, inside) = (&child.lifts[..end], child.lifts.partition_point(|to| (*to as usize) < own * WIDTH));
        for (row, &to) in lifts.iter().enumerate() {
            let (strip, within) = (to as usize / WIDTH, to as usize % WIDTH);
            let values = update[packed(row / WIDTH) + row % WIDTH..].iter().step_by(WIDTH);
            let mut known = lifts.iter().zip(values).take(row + 1);
            let panel = &mut self.panel[self.front.strip(strip) + within..];
            for (&column, value) in known.by_ref().take(inside) {
                panel[column as usize * WIDTH] += value;
            }
            if strip >= own {
                let update = &mut self.update[packed(strip - own) + within..];
                for (&column, value) in known {
                    update[(column as usize - own * WIDTH) * WIDTH] += value;
                }
            }
        }
    }
}

/// Eliminates the columns of a front: its panel becomes that of the factor, its update what is left for those after.
#[inline(always)]
fn eliminate<T: Real>(token: T::Token, Parts { front, panel, update }: Parts, blocks: &[f64]) -> bool {
    let [own, later] = front.strips;
    let mut is_positive = true;
    for j in 0..own {
        let before = j * TILE;
        for i in j..own + later {
            let (first, rest) = panel.split_at_mut(front.strip(i));
            let (done, tile) = rest.split_at_mut(before);
            let tile = &mut tile[..TILE];
            if i == j {
                dense::subtract::<T>(token, done, done, tile);
                is_positive &= dense::root(tile, least(front, j, blocks));
            } else {
                let columns = &first[front.strip(j)..];
                dense::subtract::<T>(token, done, &columns[..before], tile);
                dense::divide::<T>(token, &columns[before..before + TILE], tile);
            }
        }
    }
    for j in 0..later {
        let columns = &panel[front.strip(own + j)..][..own * TILE];
        for i in j..later {
            let rows = &panel[front.strip(own + i)..][..own * TILE];
            dense::subtract::<T>(token, rows, columns, &mut update[packed(i) + j * TILE..][..TILE]);
        }
    }
    is_positive
}

/// The least that the pivots of a strip may be.
fn least(front: &Front, strip: usize, blocks: &[f64]) -> [f64; WIDTH] {
    std::array::from_fn(|row| match front.numbers[strip * WIDTH + row] {
        NOTHING => 0.5,
        number => {
            let (atom, axis) = (number as usize / 3, number as usize % 3);
            (LEAST_PIVOT * blocks[9 * atom + 4 * axis].abs()).max(f64::MIN_POSITIVE)
        }
    })
}
