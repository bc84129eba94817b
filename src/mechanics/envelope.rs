//! An envelope Cholesky factor after a reverse Cuthill–McKee ordering: rows from their first entry to the diagonal.
//!
//! Solved for many right sides that stand side by side (blocks of cells), registers hold right sides; for the few of one cell each right
//! side becomes a column, and registers hold what stands in a row of the factor.

use super::lanes::{BlockWork, LANES, Real, dispatch};
use super::stiffness::StiffnessMatrix;

/// Rows of a matrix of so many atoms are summed one number after the other.
const SMALL: usize = 64;

/// L of A = L Lᵀ in rows that start at their first non-zero column, in the order `order`.
#[derive(Debug, Clone)]
pub(super) struct Envelope {
    order: Vec<u32>,
    first: Vec<u32>,
    start: Vec<u32>,
    /// Row i: columns first[i]..i, then one over the diagonal.
    values: Vec<f64>,
}

impl Envelope {
    /// Factors `diagonal + scale·stiffness` without the atoms that are held.
    pub fn new(stiffness: &StiffnessMatrix, diagonal: f64, scale: f64, held: &[bool]) -> Self {
        let order = reverse_cuthill_mckee(stiffness, held);
        let mut row_of = vec![u32::MAX; stiffness.atoms()];
        for (row, &atom) in order.iter().enumerate() {
            row_of[atom as usize] = row as u32;
        }
        let (mut first, mut start, mut values) = (Vec::new(), vec![0u32], Vec::new());
        for (i, &atom) in order.iter().enumerate() {
            let entries: Vec<(usize, f64)> = stiffness
                .row(atom as usize)
                .filter(|&(j, _)| row_of[j] != u32::MAX && row_of[j] as usize <= i)
                .map(|(j, value)| (row_of[j] as usize, scale * value))
                .collect();
            let low = entries.iter().map(|&(j, _)| j).min().unwrap_or(i).min(i);
            let at = values.len();
            values.resize(at + i - low + 1, 0.0);
            entries.iter().for_each(|&(j, value)| values[at + j - low] += value);
            *values.last_mut().expect("a row has its diagonal") += diagonal;
            first.push(low as u32);
            start.push(values.len() as u32);
        }
        let mut envelope = Self { order, first, start, values };
        dispatch(LANES, Factoring(&mut envelope));
        envelope
    }

    /// Row i without its diagonal, and one over the diagonal.
    #[inline(always)]
    fn row(&self, i: usize) -> (&[f64], f64) {
        let row = &self.values[self.start[i] as usize..self.start[i + 1] as usize];
        (&row[..row.len() - 1], row[row.len() - 1])
    }

    /// Whether rows are too short for sums in parts to pay.
    #[inline(always)]
    fn is_small(&self) -> bool {
        self.order.len() <= SMALL
    }

    /// Solves in place for rows of `width` numbers an atom; `scratch` is as long as `values`.
    pub fn solve(&self, width: usize, values: &mut [f64], scratch: &mut [f64]) {
        if width.is_multiple_of(LANES) {
            dispatch(LANES, Wide { envelope: self, blocks: width / LANES, values, scratch });
        } else {
            dispatch(LANES, Narrow { envelope: self, width, values, scratch });
        }
    }
}

/// Cholesky in place, the diagonal kept as its inverse.
struct Factoring<'a>(&'a mut Envelope);

impl BlockWork for Factoring<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, _: T::Token, _: usize) {
        let is_small = self.0.is_small();
        let Envelope { order, first, start, values } = self.0;
        for i in 0..order.len() {
            let (done, rest) = values.split_at_mut(start[i] as usize);
            let row = &mut rest[..(start[i + 1] - start[i]) as usize];
            let low = first[i] as usize;
            for j in low..i {
                let other = &done[start[j] as usize..start[j + 1] as usize];
                let from = low.max(first[j] as usize);
                let mine = &row[from - low..j - low];
                let theirs = &other[from - first[j] as usize..j - first[j] as usize];
                let [dot] = if is_small { [plainly(mine, theirs)] } else { products(mine, [theirs]) };
                row[j - low] = (row[j - low] - dot) * other[other.len() - 1];
            }
            let last = row.len() - 1;
            let all = &row[..last];
            let [squares] = if is_small { [plainly(all, all)] } else { products(all, [all]) };
            row[last] = 1.0 / (row[last] - squares).sqrt();
        }
    }
}

/// Right sides of whole blocks of cells.
struct Wide<'a> {
    envelope: &'a Envelope,
    /// Numbers an atom over [`LANES`].
    blocks: usize,
    values: &'a mut [f64],
    scratch: &'a mut [f64],
}

impl BlockWork for Wide<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, token: T::Token, stride: usize) {
        let width = self.blocks * stride;
        let (values, scratch) = (T::view_mut(token, self.values), T::view_mut(token, self.scratch));
        let e = self.envelope;
        for (row, &atom) in e.order.iter().enumerate() {
            let from = atom as usize * width;
            scratch[row * width..(row + 1) * width].copy_from_slice(&values[from..from + width]);
        }
        for i in 0..e.order.len() {
            let (row, inverse) = e.row(i);
            let first = e.first[i] as usize;
            for c in 0..width {
                let mut sum = T::load(token, scratch[i * width + c]);
                for (k, &l) in row.iter().enumerate() {
                    sum -= T::load(token, scratch[(first + k) * width + c]) * l;
                }
                scratch[i * width + c] = (sum * inverse).raw();
            }
        }
        for i in (0..e.order.len()).rev() {
            let (row, inverse) = e.row(i);
            let first = e.first[i] as usize;
            for c in 0..width {
                let value = T::load(token, scratch[i * width + c]) * inverse;
                scratch[i * width + c] = value.raw();
                for (k, &l) in row.iter().enumerate() {
                    let at = (first + k) * width + c;
                    scratch[at] = (T::load(token, scratch[at]) - value * l).raw();
                }
            }
        }
        values.fill(T::constant(token, 0.0).raw());
        for (row, &atom) in e.order.iter().enumerate() {
            let to = atom as usize * width;
            values[to..to + width].copy_from_slice(&scratch[row * width..(row + 1) * width]);
        }
    }
}

/// A few right sides, each made a column.
struct Narrow<'a> {
    envelope: &'a Envelope,
    width: usize,
    values: &'a mut [f64],
    scratch: &'a mut [f64],
}

impl BlockWork for Narrow<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, _: T::Token, _: usize) {
        let Self { envelope, width, values, scratch } = self;
        let rows = envelope.order.len();
        let columns = &mut scratch[..rows * width];
        for (row, &atom) in envelope.order.iter().enumerate() {
            for c in 0..width {
                columns[c * rows + row] = values[atom as usize * width + c];
            }
        }
        let mut left = &mut *columns;
        while left.len() >= 3 * rows && rows > 0 {
            let (these, others) = left.split_at_mut(3 * rows);
            let (x, yz) = these.split_at_mut(rows);
            let (y, z) = yz.split_at_mut(rows);
            solve_columns(envelope, [x, y, z]);
            left = others;
        }
        left.chunks_exact_mut(rows.max(1)).for_each(|column| solve_columns(envelope, [column]));
        values.fill(0.0);
        for (row, &atom) in envelope.order.iter().enumerate() {
            for c in 0..width {
                values[atom as usize * width + c] = columns[c * rows + row];
            }
        }
    }
}

#[inline(always)]
fn solve_columns<const W: usize>(envelope: &Envelope, mut columns: [&mut [f64]; W]) {
    for i in 0..envelope.order.len() {
        let (row, inverse) = envelope.row(i);
        let first = envelope.first[i] as usize;
        if envelope.is_small() {
            for column in &mut columns {
                let rest = row.iter().zip(&column[first..i]).fold(column[i], |rest, (l, b)| rest - l * b);
                column[i] = rest * inverse;
            }
            continue;
        }
        let sums = products(row, columns.each_ref().map(|column| &column[first..i]));
        for (column, sum) in columns.iter_mut().zip(sums) {
            column[i] = (column[i] - sum) * inverse;
        }
    }
    for i in (0..envelope.order.len()).rev() {
        let (row, inverse) = envelope.row(i);
        let first = envelope.first[i] as usize;
        for column in &mut columns {
            let value = column[i] * inverse;
            column[i] = value;
            column[first..i].iter_mut().zip(row).for_each(|(a, l)| *a -= l * value);
        }
    }
}

/// The sum of products of a few numbers, one after the other.
#[inline(always)]
fn plainly(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

/// Sums of products of a row with each of several columns as long, in a fixed order of [`LANES`] partial sums: compilers may take
/// registers of any width for them.
#[inline(always)]
pub(super) fn products<const W: usize>(row: &[f64], columns: [&[f64]; W]) -> [f64; W] {
    let mut sums = [[0.0; LANES]; W];
    let (parts, rest) = row.as_chunks::<LANES>();
    for (number, part) in parts.iter().enumerate() {
        for (sums, column) in sums.iter_mut().zip(&columns) {
            let of_column: &[f64; LANES] = column[LANES * number..][..LANES].try_into().expect("a whole part");
            for k in 0..LANES {
                sums[k] += part[k] * of_column[k];
            }
        }
    }
    for (sums, column) in sums.iter_mut().zip(&columns) {
        let of_column = &column[LANES * parts.len()..];
        sums.iter_mut().zip(rest.iter().zip(of_column)).for_each(|(sum, (a, b))| *sum += a * b);
    }
    sums.map(|s| ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7])))
}

/// An order of the free atoms that keeps neighbours close, so that the factor's rows are short.
fn reverse_cuthill_mckee(stiffness: &StiffnessMatrix, held: &[bool]) -> Vec<u32> {
    let atoms = stiffness.atoms();
    let degree: Vec<usize> = (0..atoms).map(|i| stiffness.row(i).count()).collect();
    let mut order: Vec<u32> = Vec::with_capacity(atoms);
    let mut seen: Vec<bool> = held.to_vec();
    while let Some(seed) = (0..atoms).filter(|&i| !seen[i]).min_by_key(|&i| (degree[i], i)) {
        let start = farthest(stiffness, &seen, farthest(stiffness, &seen, seed));
        let mut next = order.len();
        order.push(start as u32);
        seen[start] = true;
        while next < order.len() {
            let mut around: Vec<usize> =
                stiffness.row(order[next] as usize).map(|(j, _)| j).filter(|&j| !seen[j]).collect();
            around.sort_by_key(|&j| (degree[j], j));
            for j in around {
                seen[j] = true;
                order.push(j as u32);
            }
            next += 1;
        }
    }
    order.reverse();
    order
}

/// The atom reached last by a breadth-first walk from `from`.
fn farthest(stiffness: &StiffnessMatrix, barred: &[bool], from: usize) -> usize {
    let mut seen = barred.to_vec();
    let mut queue = std::collections::VecDeque::from([from]);
    seen[from] = true;
    let mut last = from;
    while let Some(atom) = queue.pop_front() {
        last = atom;
        for (j, _) in stiffness.row(atom) {
            if !seen[j] {
                seen[j] = true;
                queue.push_back(j);
            }
        }
    }
    last
}
