//! The linear system of the implicit step, (ζ/dt + γK) Y = F, factored once and shared by all cells of a mesh.
//!
//! K is the constant [`StiffnessMatrix`], the same along x, y and z, so that one N × N factor serves three axes and
//! eight cells at a time: a solve works on rows of 24 numbers. Small meshes keep the dense inverse (one product, no
//! chains of dependent operations); larger ones an envelope Cholesky factor after a reverse Cuthill–McKee ordering.

use super::lanes::{BlockWork, LANES, Real, dispatch};
use super::stiffness::StiffnessMatrix;

/// Meshes up to this size keep the dense inverse; at 64 atoms the envelope's two passes cost as much as the product.
const DENSE_UP_TO: usize = 64;

/// The factored matrix ζ/dt + γK with held atoms taken out.
#[derive(Debug, Clone)]
pub struct Factor {
    atoms: usize,
    method: Method,
}

#[derive(Debug, Clone)]
enum Method {
    /// Row-major inverse; rows and columns of held atoms are zero.
    Dense(Vec<f64>),
    Envelope(Envelope),
}

/// L of A = L Lᵀ in rows that start at their first non-zero column, in the order `order`.
#[derive(Debug, Clone)]
struct Envelope {
    order: Vec<u32>,
    first: Vec<u32>,
    start: Vec<u32>,
    /// Row i: columns first[i]..i, then one over the diagonal.
    values: Vec<f64>,
    held: Vec<u32>,
}

impl Factor {
    /// Factors `diagonal + scale·stiffness`; `held` tells the atoms that do not move along this axis.
    pub fn new(stiffness: &StiffnessMatrix, diagonal: f64, scale: f64, held: &[bool]) -> Self {
        let atoms = stiffness.atoms();
        let envelope = Envelope::new(stiffness, diagonal, scale, held);
        if atoms > DENSE_UP_TO {
            return Self { atoms, method: Method::Envelope(envelope) };
        }
        let mut inverse = vec![0.0; atoms * atoms];
        for (atom, row) in inverse.chunks_exact_mut(atoms).enumerate() {
            row[atom] = 1.0;
            envelope.solve(1, row, &mut vec![0.0; atoms]);
        }
        Self { atoms, method: Method::Dense(inverse) }
    }

    /// Solves in place for rows of `width` numbers an atom (`values[atom][width]`); `scratch` is as long as `values`.
    pub fn solve(&self, width: usize, values: &mut [f64], scratch: &mut [f64]) {
        debug_assert_eq!(values.len(), width * self.atoms);
        match &self.method {
            Method::Envelope(envelope) if width == 3 * LANES => {
                dispatch(LANES, WideEnvelope { envelope, values, scratch });
            }
            Method::Envelope(envelope) => envelope.solve(width, values, scratch),
            Method::Dense(inverse) if width == 3 * LANES => {
                scratch.copy_from_slice(values);
                dispatch(LANES, WideProduct { atoms: self.atoms, inverse, from: scratch, to: values });
            }
            Method::Dense(inverse) => {
                scratch.copy_from_slice(values);
                for (row, to) in inverse.chunks_exact(self.atoms).zip(values.chunks_exact_mut(width)) {
                    to.fill(0.0);
                    for (entry, from) in row.iter().zip(scratch.chunks_exact(width)) {
                        to.iter_mut().zip(from).for_each(|(t, s)| *t += entry * s);
                    }
                }
            }
        }
    }
}

struct WideProduct<'a> {
    atoms: usize,
    inverse: &'a [f64],
    from: &'a [f64],
    to: &'a mut [f64],
}

impl BlockWork for WideProduct<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, token: T::Token, stride: usize) {
        let (from, to) = (T::view(token, self.from), T::view_mut(token, self.to));
        let (width, zero) = (3 * stride, T::constant(token, 0.0));
        // Two atoms and three registers at a time: six sums in flight hide the latency of the additions.
        for pair in 0..self.atoms.div_ceil(2) {
            let (i, k) = (2 * pair, (2 * pair + 1).min(self.atoms - 1));
            let row_i = &self.inverse[i * self.atoms..(i + 1) * self.atoms];
            let row_k = &self.inverse[k * self.atoms..(k + 1) * self.atoms];
            for at in (0..width).step_by(3) {
                let (mut a, mut b) = ([zero; 3], [zero; 3]);
                for ((p, q), value) in row_i.iter().zip(row_k).zip(from.chunks_exact(width)) {
                    for c in 0..3 {
                        let v = T::load(token, value[at + c]);
                        a[c] += v * *p;
                        b[c] += v * *q;
                    }
                }
                for c in 0..3 {
                    to[i * width + at + c] = a[c].raw();
                    to[k * width + at + c] = b[c].raw();
                }
            }
        }
    }
}

struct WideEnvelope<'a> {
    envelope: &'a Envelope,
    values: &'a mut [f64],
    scratch: &'a mut [f64],
}

impl BlockWork for WideEnvelope<'_> {
    type Output = ();
    #[inline(always)]
    fn run<T: Real>(self, token: T::Token, stride: usize) {
        let width = 3 * stride;
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

impl Envelope {
    fn new(stiffness: &StiffnessMatrix, diagonal: f64, scale: f64, held: &[bool]) -> Self {
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
        let held = (0..stiffness.atoms() as u32).filter(|&atom| held[atom as usize]).collect();
        let mut envelope = Self { order, first, start, values, held };
        envelope.factor();
        envelope
    }

    /// Row i without its diagonal, and one over the diagonal.
    #[inline(always)]
    fn row(&self, i: usize) -> (&[f64], f64) {
        let row = &self.values[self.start[i] as usize..self.start[i + 1] as usize];
        (&row[..row.len() - 1], row[row.len() - 1])
    }

    /// Cholesky in place, the diagonal kept as its inverse.
    fn factor(&mut self) {
        for i in 0..self.order.len() {
            let (done, rest) = self.values.split_at_mut(self.start[i] as usize);
            let row = &mut rest[..(self.start[i + 1] - self.start[i]) as usize];
            let low = self.first[i] as usize;
            for j in low..i {
                let other = &done[self.start[j] as usize..self.start[j + 1] as usize];
                let from = low.max(self.first[j] as usize);
                let mine = &row[from - low..j - low];
                let theirs = &other[from - self.first[j] as usize..j - self.first[j] as usize];
                let dot: f64 = mine.iter().zip(theirs).map(|(a, b)| a * b).sum();
                row[j - low] = (row[j - low] - dot) * other[other.len() - 1];
            }
            let last = row.len() - 1;
            let rest: f64 = row[..last].iter().map(|l| l * l).sum();
            row[last] = 1.0 / (row[last] - rest).sqrt();
        }
    }

    fn solve(&self, width: usize, values: &mut [f64], scratch: &mut [f64]) {
        for (row, &atom) in self.order.iter().enumerate() {
            let from = atom as usize * width;
            scratch[row * width..(row + 1) * width].copy_from_slice(&values[from..from + width]);
        }
        for i in 0..self.order.len() {
            let (row, inverse) = self.row(i);
            let first = self.first[i] as usize;
            let (before, rest) = scratch.split_at_mut(i * width);
            let mine = &mut rest[..width];
            for (l, theirs) in row.iter().zip(before[first * width..].chunks_exact(width)) {
                mine.iter_mut().zip(theirs).for_each(|(a, b)| *a -= l * b);
            }
            mine.iter_mut().for_each(|a| *a *= inverse);
        }
        for i in (0..self.order.len()).rev() {
            let (row, inverse) = self.row(i);
            let first = self.first[i] as usize;
            let (before, rest) = scratch.split_at_mut(i * width);
            let mine = &mut rest[..width];
            mine.iter_mut().for_each(|a| *a *= inverse);
            for (l, theirs) in row.iter().zip(before[first * width..].chunks_exact_mut(width)) {
                theirs.iter_mut().zip(mine.iter()).for_each(|(a, b)| *a -= l * b);
            }
        }
        for (row, &atom) in self.order.iter().enumerate() {
            let to = atom as usize * width;
            values[to..to + width].copy_from_slice(&scratch[row * width..(row + 1) * width]);
        }
        for &atom in &self.held {
            values[atom as usize * width..(atom as usize + 1) * width].fill(0.0);
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn chain(atoms: usize) -> StiffnessMatrix {
        let mut matrix = StiffnessMatrix::new(atoms);
        for i in 1..atoms {
            matrix.add_spring(i - 1, i, 1.0 + i as f64);
            matrix.add_spring(0, i, 0.5);
        }
        matrix
    }

    #[test]
    fn both_factors_invert_the_matrix_at_every_width_with_held_atoms() {
        for atoms in [5, 64, 65, 130] {
            for width in [1, 3, 24] {
                let stiffness = chain(atoms);
                let held: Vec<bool> = (0..atoms).map(|i| i == 3).collect();
                let factor = Factor::new(&stiffness, 2.0, 0.7, &held);
                let right: Vec<f64> = (0..atoms * width).map(|i| ((i * 7919) % 101) as f64 - 50.0).collect();
                let mut y = right.clone();
                factor.solve(width, &mut y, &mut vec![0.0; atoms * width]);
                for i in (0..atoms).filter(|&i| !held[i]) {
                    for c in 0..width {
                        let product: f64 = 2.0 * y[i * width + c]
                            + stiffness.row(i).map(|(j, k)| 0.7 * k * y[j * width + c]).sum::<f64>();
                        // Round-off of sums of at most 130 terms of size up to about 1e4.
                        assert!((product - right[i * width + c]).abs() < 1e-8, "{atoms} {width} {i}");
                    }
                }
                assert!((0..width).all(|c| y[3 * width + c] == 0.0));
            }
        }
    }
}
